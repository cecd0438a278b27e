"""Results as JSON values and back: a dataclass is an object, and each of its fields a key.

A field with a default stands in the file only where it differs from that. The keys of an INLINE field stand among those
of its table: of a mapping all keys that no other field has. A name that ends in "_" has a key without it.
"""

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from types import NoneType
from typing import Any, TypeVar, get_args, get_origin

T = TypeVar("T")
INLINE = {"inline": True}
_PLAIN: dict[type, tuple[tuple[type, ...], str]] = {
    bool: ((bool,), "true or false"), int: ((int,), "a whole number"), float: ((int, float), "a number"),
    str: ((str,), "a text"),
}  # fmt: skip


def to_json(value: Any) -> Any:
    """Results as objects, lists, numbers, words and None."""
    if is_dataclass(value) and not isinstance(value, type):
        table: dict[str, Any] = {}
        for field in fields(value):
            entry = getattr(value, field.name)
            if is_inline(field):
                table |= to_json(entry) or {}
            elif field.default is MISSING or entry != field.default:
                table[key_of(field)] = to_json(entry)
        return table
    if isinstance(value, Mapping):
        return {str(key): to_json(entry) for key, entry in value.items()}
    return [to_json(entry) for entry in value] if isinstance(value, list | tuple) else value


def from_json(kind: type[T], value: Any, place: str = "") -> T:
    """Results of a dataclass from JSON values; a key that no field has is passed over.

    place: of the value in its file, "results". Raises KeyError for a key that is not there, with its place, and
    ValueError for a value that is none of its field.
    """
    result: T = _read(kind, value, place)
    return result


def key_of(field: "Field[Any]") -> str:
    """The key of a field."""
    return field.name.removesuffix("_")


def is_inline(field: "Field[Any]") -> bool:
    """Whether the keys of a field stand among those of its table."""
    return bool(field.metadata.get("inline"))


def dataclass_in(kind: Any) -> Any:
    """The dataclass of a field that may hold one or None."""
    return next(one for one in (kind, *get_args(kind)) if is_dataclass(one))


def _read(kind: Any, value: Any, place: str) -> Any:
    origin, inner = get_origin(kind), get_args(kind)
    if is_dataclass(kind):
        return _table(kind, _object(value, place), place)
    if origin is Mapping:
        return {key: _read(inner[1], entry, f"{place}.{key}") for key, entry in _object(value, place).items()}
    if origin is tuple:
        return _row(inner, value, place)
    if inner:
        return _one_of(inner, value, place)
    types, words = _PLAIN[kind]
    if not isinstance(value, types) or (isinstance(value, bool) and kind is not bool):
        raise ValueError(f"{place} is {value!r}, and must be {words}")
    return value


def _row(inner: tuple[Any, ...], value: Any, place: str) -> tuple[Any, ...]:
    """A list of values of one kind, or of so many, each of its own kind."""
    of_any_length = inner[1] is Ellipsis
    if not isinstance(value, list) or not (of_any_length or len(value) == len(inner)):
        raise ValueError(f"{place} must be a list{'' if of_any_length else f' of {len(inner)}'}")
    kinds = inner[:1] * len(value) if of_any_length else inner
    return tuple(_read(kind, one, f"{place}.{row}") for row, (kind, one) in enumerate(zip(kinds, value, strict=True)))


def _object(value: Any, place: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise ValueError(f"{place} must be an object")
    return value


def _one_of(kinds: tuple[Any, ...], value: Any, place: str) -> Any:
    """A value of one of several kinds: None, or the first dataclass that has all it needs."""
    if value is None and NoneType in kinds:
        return None
    keys, others = set(value) if isinstance(value, dict) else set(), [kind for kind in kinds if kind is not NoneType]
    fitting = [kind for kind in others if is_dataclass(kind) and _needed(kind) <= keys]
    return _read((fitting or others)[0], value, place)


def _needed(kind: Any) -> set[str]:
    return {key_of(field) for field in fields(kind) if field.default is MISSING and not is_inline(field)}


def _own_keys(kind: Any) -> set[str]:
    """The keys that fields of a dataclass have by name, those of its INLINE dataclasses among them."""
    own: set[str] = set()
    for field in fields(kind):
        if not is_inline(field):
            own.add(key_of(field))
        elif get_origin(field.type) is not Mapping:
            own |= _own_keys(dataclass_in(field.type))
    return own


def _table(kind: Any, table: dict[str, Any], place: str) -> Any:
    return kind(**dict(_entries(kind, table, place)))


def _entries(kind: Any, table: dict[str, Any], place: str) -> Iterator[tuple[str, Any]]:
    for field in fields(kind):
        if is_inline(field) and get_origin(field.type) is Mapping:
            own = _own_keys(kind)
            yield field.name, _read(field.type, {key: entry for key, entry in table.items() if key not in own}, place)
        elif is_inline(field):
            inner = dataclass_in(field.type)
            yield field.name, _table(inner, table, place) if _needed(inner) <= set(table) else None
        elif key_of(field) in table:
            yield field.name, _read(field.type, table[key_of(field)], f"{place}.{key_of(field)}")
        elif field.default is MISSING:
            raise KeyError(f"{place}.{key_of(field)}")
