"""Units of the numbers that a study gives its runs, and of those that come back."""

from typing import get_args

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from lithobrake.study.quantity import Number
from lithobrake.study.study import Study
from lithobrake.vocabulary.quantities import PURE, TOUCHDOWN


def input_units() -> dict[str, str]:
    """The unit of each number of a study file by its dotted key, and of the attitude that a run draws.

    The inputs of the user's own program are not among them: only the program knows their units.
    """
    orientation = {f"impact.orientation.{part}": PURE for part in "wxyz"}
    return {**_units("", Study), **orientation}


def run_units() -> dict[str, str]:
    """The unit of each input and output of a run by its name; a program of the user's own is asked for the same."""
    return input_units() | {name: quantity.units or PURE for name, quantity in TOUCHDOWN.items()}


def _units(path: str, model: type[BaseModel]) -> dict[str, str]:
    units: dict[str, str] = {}
    for name, field in model.model_fields.items():
        range_of_values, inner = limits(field), table(field)
        if range_of_values is not None:
            units[f"{path}{name}"] = range_of_values.unit or PURE
        elif inner is not None:
            units |= _units(f"{path}{name}.", inner)
    return units


def table(field: FieldInfo) -> type[BaseModel] | None:
    """The table that a field takes, if it takes exactly one kind of table."""
    kinds = [field.annotation, *get_args(field.annotation)]
    models = [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)]
    return models[0] if len(models) == 1 else None


def limits(field: FieldInfo) -> Number | None:
    """The unit and the range of a field, wherever in its annotation they stand."""
    found = [entry for entry in field.metadata if isinstance(entry, Number)]
    for kind in get_args(field.annotation):
        found += [entry for entry in getattr(kind, "__metadata__", ()) if isinstance(entry, Number)]
    return found[0] if found else None
