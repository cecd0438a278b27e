"""Tables of a study that a program has made, as a study file would hold them."""

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from lithobrake.study.reader import StudyError
from lithobrake.vocabulary.plain_text import show

# No key takes more levels of tables and lists.
DEEPEST = 10


def plain_tables(tables: Mapping[str, Any], name: str) -> dict[str, Any]:
    """The same in dicts, lists, text and Python's own numbers; those of NumPy and paths are turned into these.

    name: that messages use. Raises StudyError that names the first key with a value of another type.
    """
    plain = _plain(tables, "", name, DEEPEST)
    assert isinstance(plain, dict)
    return plain


def _plain(value: Any, key: str, name: str, levels: int) -> Any:
    """One value, at a dotted key, in so many more levels."""
    if isinstance(value, np.ndarray | np.generic):
        # Those of long doubles give themselves.
        value = float(value) if isinstance(value, np.longdouble) else value.tolist()
    elif isinstance(value, os.PathLike):
        value = os.fspath(value)
    if levels == 0:
        raise StudyError([f"{name}: {key} is nested too deeply; no key takes more than a few levels"])
    if isinstance(value, Mapping):
        for inner in value:
            if not isinstance(inner, str):
                raise StudyError([f"{name}: {key or 'the study'} has the key {inner!r}; allowed: names in text"])
            _text(inner, f"a key of {key or 'the study'}", name)
        return {inner: _plain(entry, _dotted(key, inner), name, levels - 1) for inner, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry, _dotted(key, str(place)), name, levels - 1) for place, entry in enumerate(value)]
    if isinstance(value, str):
        return _text(value, key, name)
    if isinstance(value, bool | int | float):
        return value
    raise StudyError(
        [
            f"{name}: {key} is {show(value)}, of the type {type(value).__name__}; allowed: numbers, text, true or "
            "false, and lists and tables of these; convert it, say by float() or str()"
        ]
    )


def _text(value: str, key: str, name: str) -> str:
    """A text that a file can hold."""
    if any("\ud800" <= letter <= "\udfff" for letter in value):
        raise StudyError([f"{name}: {key} is {show(value)}, which UTF-8 cannot hold; leave out lone surrogates"])
    return value


def _dotted(key: str, inner: str) -> str:
    return f"{key}.{inner}" if key else inner
