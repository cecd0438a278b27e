"""Units of the numbers that a study gives its runs and gets back, and factors between units of one quantity."""

import math
from typing import get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from lithobrake.study.quantity import Number
from lithobrake.study.study import Study
from lithobrake.vocabulary.quantities import ERRORS, GROUND_KIND, GROUND_SIZE, ORIENTATION, PURE, TOUCHDOWN

_DEGREE = math.pi / 180.0
# Each row one quantity: its units, and each in the first of them. Feet and inches are the international ones; rpm is
# 2 pi rad in 60 s.
_QUANTITIES: tuple[dict[str, float], ...] = (
    {PURE: 1.0, "1": 1.0, "%": 0.01},
    {"m": 1.0, "km": 1e3, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "ft": 0.3048, "in": 0.0254},
    {"m/s": 1.0, "km/s": 1e3, "cm/s": 1e-2, "mm/s": 1e-3, "um/s": 1e-6, "km/h": 1.0 / 3.6, "ft/s": 0.3048},
    {"m/s2": 1.0, "km/s2": 1e3, "cm/s2": 1e-2, "mm/s2": 1e-3, "um/s2": 1e-6, "ft/s2": 0.3048},
    {"rad": 1.0, "mrad": 1e-3, "deg": _DEGREE},
    {"rad/s": 1.0, "mrad/s": 1e-3, "deg/s": _DEGREE, "deg/h": _DEGREE / 3600.0, "rpm": math.pi / 30.0},
    {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0},
    {"J": 1.0, "kJ": 1e3, "mJ": 1e-3, "uJ": 1e-6},
)


def input_units() -> dict[str, str]:
    """The unit of each number of a study file by its dotted key, and of the attitude that a run draws.

    The inputs of the user's own program are not among them: only the program knows their units.
    """
    return _units("", Study) | dict.fromkeys((*ORIENTATION, GROUND_KIND, ERRORS), PURE) | {GROUND_SIZE: "m"}


def run_units() -> dict[str, str]:
    """The unit of each input and output of a run by its name; a program of the user's own is asked for the same."""
    return input_units() | {name: quantity.units or PURE for name, quantity in TOUCHDOWN.items()}


def _units(path: str, model: type[BaseModel]) -> dict[str, str]:
    units: dict[str, str] = {}
    for name, field in model.model_fields.items():
        range_of_values, inner = limits(field), table(field)
        if range_of_values is not None:
            units[f"{path}{name}"] = range_of_values.unit or PURE
        # Names of the user's own are not known before a file is read, so their tables cannot be listed.
        elif inner is not None and not is_named(field):
            units |= _units(f"{path}{name}.", inner)
    return units


def table(field: FieldInfo) -> type[BaseModel] | None:
    kinds = [field.annotation, *get_args(field.annotation)]
    models = [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)]
    return models[0] if len(models) == 1 else None


def is_named(field: FieldInfo) -> bool:
    """Whether a field takes any number of tables, each with a name of the user's own."""
    return get_origin(field.annotation) is dict


def limits(field: FieldInfo) -> Number | None:
    """The unit and the range of a field, wherever in its annotation they stand."""
    found = [entry for entry in field.metadata if isinstance(entry, Number)]
    for kind in get_args(field.annotation):
        found += [entry for entry in getattr(kind, "__metadata__", ()) if isinstance(entry, Number)]
    return found[0] if found else None


def conversion(given: str, wanted: str) -> float:
    """The factor from a number in the given unit to the wanted one, as 0.01 from "cm/s" to "m/s".

    Units are written as in `known_units`; m/s^2, m/s**2 and m s-2 are m/s2, ° is deg, µ is u. Raises ValueError for
    another unit, and for one of another quantity.
    """
    table = _quantity(wanted)
    unit = _plain(given)
    if unit not in table:
        raise ValueError(f"unit [{given}]; allowed: {', '.join(table)}")
    return 1.0 if unit == wanted else table[unit] / table[wanted]


def _quantity(unit: str) -> dict[str, float]:
    """The units of the quantity that one is of; of a unit that no row has it alone."""
    return next((table for table in _QUANTITIES if unit in table), {unit: 1.0})


def _plain(unit: str) -> str:
    compact = "".join(unit.split()) or PURE
    # Micro has two code points that look alike, U+00B5 of keyboards and U+03BC of the Greek alphabet; "m s-1" has
    # become "ms-1" here.
    for written, plain in (("**", ""), ("^", ""), ("²", "2"), ("°", "deg"), ("µ", "u"), ("μ", "u"), ("s-", "/s")):
        compact = compact.replace(written, plain)
    # The exponent of "s-1" has become "/s1" by now; "s-2" is "/s2", as in the rows.
    return compact.removesuffix("1") if compact.endswith("/s1") else compact
