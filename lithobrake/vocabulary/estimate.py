"""A number with the interval that stands for it, from the arrays of a study to its page, and its forms in files."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

from lithobrake.vocabulary.inline_fields import Form

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler
    from pydantic_core import CoreSchema

# Probability with which every interval of an estimate holds the truth; results carry it, so that no reader has to ask.
LEVEL = 0.9


@dataclass(frozen=True)
class Estimate:
    """A number with its interval, over beds and impact points that were not in the study."""

    value: float
    """the number, in the unit of its quantity; null where no run has it (in Python NaN)"""
    lower: float | None
    """lower bound; null where there is none"""
    upper: float | None
    """upper bound; null where there is none"""
    level: float = LEVEL
    """probability that the bounds of this table stand for"""
    why_missing: str | None = None
    """why a bound is missing, in a sentence"""

    @property
    def is_known(self) -> bool:
        """Whether there is such a number."""
        return not math.isnan(self.value)

    @property
    def bounds(self) -> tuple[float, float] | None:
        """Both bounds; None where one is missing."""
        return None if self.lower is None or self.upper is None else (self.lower, self.upper)

    @property
    def without_reason(self) -> "Estimate":
        """The same where the reason of a missing bound stands once for many estimates."""
        return replace(self, why_missing=None)

    @property
    def half_width(self) -> float | None:
        """Half the interval; None where a bound is missing."""
        return None if self.bounds is None else 0.5 * (self.bounds[1] - self.bounds[0])

    def on_scale(self, rising: Callable[[float], float]) -> "Estimate":
        """The number and its bounds as a rising function has them."""
        lower, upper = (None if end is None else rising(end) for end in (self.lower, self.upper))
        return replace(self, value=rising(self.value), lower=lower, upper=upper)


@dataclass(frozen=True)
class Keyed(Form):
    """The form of an estimate in a file: the key of its value, then its bounds.

    has_level: with its level; has_reason: with the reason of a missing bound, where there is one.
    """

    value: str
    has_level: bool = False
    has_reason: bool = True

    @property
    def keys(self) -> dict[str, str]:
        """The field of the estimate for each key."""
        found = {self.value: "value", "lower": "lower", "upper": "upper"}
        found |= {"level": "level"} if self.has_level else {}
        return found | ({"why": "why_missing"} if self.has_reason else {})

    def __get_pydantic_core_schema__(self, source: Any, handler: "GetCoreSchemaHandler") -> "CoreSchema":
        """How pydantic reads and writes it."""
        from pydantic_core import core_schema

        number = core_schema.nullable_schema(core_schema.float_schema())
        keys = {key: core_schema.typed_dict_field(number) for key in self.keys}
        if self.has_reason:
            keys["why"] = core_schema.typed_dict_field(core_schema.str_schema(), required=False)
        form = core_schema.typed_dict_schema(keys)
        writer = core_schema.plain_serializer_function_ser_schema(self._written)
        return core_schema.no_info_after_validator_function(self._read, form, serialization=writer)

    def _read(self, table: dict[str, Any]) -> Estimate:
        given = {name: table.get(key) for key, name in self.keys.items()}
        return Estimate(**given | {"value": math.nan if given["value"] is None else given["value"]})

    def _written(self, one: Estimate) -> dict[str, Any]:
        table = {key: getattr(one, name) for key, name in self.keys.items()}
        table |= {} if one.is_known else {self.value: None}
        return {key: entry for key, entry in table.items() if key != "why" or entry is not None}


Number = Annotated[Estimate, Keyed("value")]
Share = Annotated[Estimate, Keyed("share")]
