"""A number with the interval that stands for it, from the arrays of a study to its page, and its forms in files."""

import math
from collections.abc import Callable, Mapping
from dataclasses import Field, dataclass, fields, is_dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, get_args, get_origin

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler
    from pydantic_core import CoreSchema

INLINE = {"inline": True}
# Probability with which every interval of an estimate holds the truth; results carry it, so that no reader has to ask.
LEVEL = 0.9


class Form:
    """What stands beside a kind in Annotated where its keys in a file are not the names of its fields."""

    @property
    def keys(self) -> Mapping[str, str]:
        """The field for each key."""
        raise NotImplementedError


class Inlined:
    """What a dataclass with INLINE fields inherits from."""

    gathered: ClassVar[Any]
    written: ClassVar[Any]

    def __init_subclass__(cls) -> None:
        """Give the dataclass the two functions of its form in a file, as pydantic finds those of a class alone."""
        from pydantic import model_serializer, model_validator

        cls.gathered = model_validator(mode="before")(classmethod(_gathered))  # type: ignore[arg-type]
        cls.written = model_serializer(mode="wrap")(_written)


def _gathered(cls: Any, table: Any) -> Any:
    """A table of a file with the keys of each inline field in a table of its own; a field without any is absent."""
    if not isinstance(table, dict):
        return table
    # What a function has had in hand counts as no text any more, and a list as none but a list.
    left, inline = _with_tuples(table), [field for field in fields(cls) if is_inline(field)]
    own = {key_of(field) for field in fields(cls) if not is_inline(field)}
    given = {key: left.pop(key) for key in own & set(left)}
    # A mapping takes what the others leave.
    for field in sorted(inline, key=lambda one: keys_within(one.type) is None):
        keys = keys_within(field.type)
        part = {key: left.pop(key) for key in list(left) if keys is None or key in keys}
        given |= {field.name: part} if part or keys is None else {}
    return given


def _written(self: Any, writer: Any) -> dict[str, Any]:
    """The table of a file."""
    inline = {field.name for field in fields(self) if is_inline(field)}
    own = {key_of(field) for field in fields(self)} - inline
    table: dict[str, Any] = {}
    for key, entry in writer(self).items():
        table |= {one: entry[one] for one in entry or {} if one not in own} if key in inline else {key: entry}
    return table


def _with_tuples(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _with_tuples(entry) for key, entry in value.items()}
    return tuple(map(_with_tuples, value)) if isinstance(value, list) else value


def is_inline(field: "Field[Any]") -> bool:
    """Whether the keys of a field stand among those of its table."""
    return bool(field.metadata.get("inline"))


def without_underscore(name: str) -> str:
    """The key of a field's name: one that is a word of Python has an underscore that its key lacks."""
    return name.removesuffix("_")


def key_of(field: "Field[Any]") -> str:
    return without_underscore(field.name)


def keys_within(kind: Any) -> set[str] | None:
    """The keys that an inline field of a kind may have; None for a mapping."""
    if get_origin(kind) is Mapping:
        return None
    parts = (kind, *get_args(kind))
    form = next((one for one in parts if isinstance(one, Form)), None)
    if form is not None:
        return set(form.keys)
    return {key_of(field) for field in fields(next(one for one in parts if is_dataclass(one)))}


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
