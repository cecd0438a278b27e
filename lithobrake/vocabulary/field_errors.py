"""The error that the engine raises for a value, with the field that has it."""

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
