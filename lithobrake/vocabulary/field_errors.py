"""The error that the engine raises for a value, with the field that has it, and the check of a number."""

import math
from numbers import Real
from typing import Any


class FieldError(ValueError):
    """A field has a value that is not allowed.

    field: as "Landing.speed", or "add_body mass" for an argument; value: what it is, in `unit` ("" for none); allowed:
    what follows the word "allowed", as "is a finite value above 0 m/s"; remedy: what to do.
    """

    def __init__(self, field: str, value: Any, allowed: str, remedy: str = "change it", unit: str = "") -> None:
        # All of them, as an error that goes to another process is made again from what stands here.
        super().__init__(field, value, allowed, remedy, unit)
        self.field, self.value, self.allowed, self.remedy, self.unit = field, value, allowed, remedy, unit

    def __str__(self) -> str:
        value = f"{self.value!r} {self.unit}".rstrip()
        return f"{self.field} is {value}; allowed {self.allowed}: {self.remedy}"


def value_within(least: float, most: float) -> str:
    """Say what is allowed where both limits are."""
    return f"is a value from {least:g} to {most:.6g}"


def field_number(field: str, value: Any, allowed: str, unit: str = "", *, above: float = -math.inf) -> float:
    """Return a finite number above a limit. Raises FieldError for another, and for text, true and false."""
    # One of NumPy is compared and shown as a plain one; a whole number beyond all floats is none.
    plain = value.item() if isinstance(value, Real) and hasattr(value, "item") else value
    is_number = isinstance(plain, Real) and not isinstance(plain, bool)
    if not is_number or not above < plain < math.inf or not plain > -math.inf:
        raise FieldError(field, value, allowed, unit=unit)
    try:
        return float(plain)
    except OverflowError as error:
        raise FieldError(field, value, allowed, unit=unit) from error


def field_numbers(field: str, values: Any, count: int, allowed: str, unit: str = "") -> list[float]:
    """Return so many finite numbers. Raises FieldError for anything else."""
    given = list(values) if hasattr(values, "__len__") and not isinstance(values, str | bytes | dict) else []
    try:
        found = [field_number(field, value, allowed, unit) for value in given]
    except FieldError as error:
        raise FieldError(field, values, allowed, unit=unit) from error
    if len(found) != count:
        raise FieldError(field, values, allowed, unit=unit)
    return found
