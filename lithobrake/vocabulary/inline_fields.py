"""Tables of results whose file has the keys of some fields among those of the table, as pydantic reads and writes them.

An INLINE field is a dataclass, an estimate, or a mapping, which has all keys that no other field has.
"""

from collections.abc import Mapping
from dataclasses import Field, fields, is_dataclass
from typing import Any, ClassVar, get_args, get_origin

INLINE = {"inline": True}


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
    """The key of a field."""
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
