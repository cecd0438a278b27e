"""Representations of objects that fit a screen: lines of one width, few of them, and nothing at length."""

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

from lithobrake.vocabulary.plain_text import one_line, wrapped

# Of a terminal of 80 columns and 24 lines one line is the prompt's.
WIDTH, LINES = 79, 22
# A blank between a name and its unit, at which no line is broken.
_FIRM = "\u00a0"


def in_lines(text: str, indent: str = "") -> str:
    """A text in lines of the screen, broken at blanks, those after the first indented."""
    first, *rest = wrapped(text, WIDTH - len(indent)).split("\n")
    return "\n".join([first, *(f"{indent}{line.strip()}" for line in rest)]).replace(_FIRM, " ")


def names_in_lines(head: str, names: Iterable[str]) -> str:
    """Names after a head, in as many lines as a screen has; the number of those that find no place."""
    known = [name.replace(" ", _FIRM) for name in names]
    for left_out in range(len(known)):
        shown = known[: len(known) - left_out] + ([f"and {left_out} more"] if left_out else [])
        text = in_lines(f"{head}{', '.join(shown)}", "  ")
        if text.count("\n") < LINES:
            return text
    return head.rstrip()


def short_repr(value: Any) -> str:
    """A dataclass with a line for each field that holds something, long ones cut, and the names of the empty ones.

    To stand in a class as `__repr__ = short_repr`.
    """
    held = {one.name: getattr(value, one.name) for one in fields(value)}
    empty = [name for name, one in held.items() if _is_empty(one)]
    shown = [name for name in held if name not in empty]
    listed, left_out = (shown, []) if len(shown) < LINES - 1 else (shown[: LINES - 3], shown[LINES - 3 :])
    width = max(map(len, listed), default=0) + 2
    rows = [(f"{name:<{width}}", _brief(held[name])) for name in listed]
    rows += [(f"{head}: ", ", ".join(names)) for head, names in (("also", left_out), ("empty", empty)) if names]
    return "\n".join(
        [type(value).__name__, *(f"  {head}{one_line(text, WIDTH - 2 - len(head))}" for head, text in rows)]
    )


def _is_empty(value: Any) -> bool:
    return value is None or (isinstance(value, str | list | tuple | Mapping) and not value)


def _brief(value: Any) -> str:
    """A value on one line: numbers in six digits, names and numbers of what it holds, arrays by their shapes."""
    if hasattr(value, "shape") and value.shape:
        return f"array {list(value.shape)}"
    if is_dataclass(value) and not isinstance(value, type):
        inner = ((one.name, getattr(value, one.name)) for one in fields(value))
        return ", ".join(f"{name}={_inner(one)}" for name, one in inner if not _is_empty(one))
    if isinstance(value, Mapping):
        kinds = {type(one) for one in value.values()}
        plain_names = len(kinds) == 1 and is_dataclass(kinds.pop())
        return ", ".join(name if plain_names else f"{name}={_inner(one)}" for name, one in value.items())
    if isinstance(value, list | tuple):
        kind = type(value[0])
        return f"{len(value)} {kind.__name__}" if is_dataclass(kind) else ", ".join(map(_inner, value))
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _inner(value: Any) -> str:
    """What stands inside of another value: nothing of what holds more."""
    if is_dataclass(value):
        return type(value).__name__
    if isinstance(value, Mapping | list | tuple):
        return f"[{len(value)}]"
    return f"array {list(value.shape)}" if hasattr(value, "shape") and value.shape else _brief(value)
