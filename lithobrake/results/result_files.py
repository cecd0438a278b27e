"""Results as JSON, which pydantic reads and writes: a dataclass is an object, and each of its fields a key.

A field with a default stands in a file only where it differs from that; a key that no field has is passed over.
"""

import json
from collections.abc import Sequence
from typing import Any, TypeVar

T = TypeVar("T")


def json_values(value: Any) -> Any:
    """Results as objects, lists, numbers, words and None. Raises ValueError for a value that is none of its field."""
    from pydantic import TypeAdapter

    form = TypeAdapter[Any](type(value))
    return form.dump_python(value, mode="json", by_alias=True, exclude_defaults=True, warnings="error")


def results_in(kind: type[T], content: Any, place: str = "") -> T:
    """Results of a dataclass in JSON values, of the kind alone that its fields have.

    place: of the value in its file, "results". Raises KeyError for a key that is not there, with its place, and
    ValueError for a value that is none of its field.
    """
    from pydantic import TypeAdapter, ValidationError

    try:
        # Of a text a list may become a tuple, and nothing else another thing than it is.
        result: T = TypeAdapter(kind).validate_json(json.dumps(content), strict=True)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        lacking = first["loc"][-1:] if first["type"] == "missing" else ()
        keys = _keys_to(content, first["loc"][: len(first["loc"]) - len(lacking)]) or []
        where = ".".join(map(str, [*([place] if place else []), *keys, *lacking]))
        if lacking:
            raise KeyError(where) from None
        raise ValueError(f"{where} is {first['input']!r}, and {first['msg'].replace('Input should', 'must')}") from None
    return result


def _keys_to(content: Any, location: Sequence[int | str]) -> list[int | str] | None:
    """The keys that lead to a place in JSON values, which pydantic names by fields besides; None where none do."""
    if not location:
        return []
    first, rest = location[0], location[1:]
    if isinstance(first, int) if isinstance(content, list) else isinstance(content, dict) and first in content:
        found = _keys_to(content[first], rest)
        if found is not None:
            return [first, *found]
    return _keys_to(content, rest) if rest else None
