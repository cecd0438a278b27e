"""What messages and screens show: words of others as plain text, short representations, small tables."""

import difflib
import math
import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from html import escape
from typing import Any

# A control sequence (colours, cursor), a string for the terminal itself (its title, its clipboard), any other.
_ESCAPE = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b[]PX^_].*?(?:\x07|\x1b\\|$)|\x1b[ -/]*[0-~]?", re.DOTALL)
LONGEST = 200  # characters of a value that a sentence shows
# Of a terminal of 80 columns and 24 lines one line is the prompt's.
WIDTH, LINES = 79, 22
# A blank between a name and its unit, at which no line is broken.
_FIRM = "\u00a0"


def plain(text: str) -> str:
    """Give a text without escape sequences, with a blank for each other character that is neither shown nor a newline.

    What is left can be shown by any terminal and kept by any file: it holds no lone surrogates and no marks that turn
    the direction of writing.
    """
    return "".join(letter if letter.isprintable() or letter == "\n" else " " for letter in _ESCAPE.sub("", text))


def program_name(name: str) -> str:
    """A name as other programs take it: capitals, digits and underscores; BODY where a name has no letter of these."""
    found = re.sub(r"\W+", "_", name, flags=re.ASCII).upper()
    return found if found.strip("_") else "BODY"


def wrapped(text: str, width: int) -> str:
    """Give a text with line breaks at blanks alone, so that no line is longer than a width where that can be.

    Lines that go on are indented as the first is. A terminal breaks longer lines within words.
    """
    lines = []
    for line in text.split("\n"):
        indent = line[: len(line) - len(line.lstrip(" "))]
        parts = textwrap.wrap(
            line, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False,
            replace_whitespace=False, drop_whitespace=True,
        )  # fmt: skip
        lines += parts if len(line) > width else [line]
    return "\n".join(lines)


def one_line(text: str, at_most: int) -> str:
    """Give a plain text on one line, cut after so many characters; a cut is marked by three dots."""
    line = " ".join(plain(text).split())
    return line if len(line) <= at_most else f"{line[: at_most - 3]}..."


def closest(word: object, known: Iterable[str], likeness: float = 0.5) -> str:
    """Ask back with the nearest known word, all of which are of small letters, or say nothing when none is near."""
    text = word if isinstance(word, str) else show(word)
    near = difflib.get_close_matches(text.lower(), list(known), n=1, cutoff=likeness)
    return f"; did you mean {near[0]}?" if near else ""


def show(value: object) -> str:
    """A value as the study file would show it; of a long one the beginning."""
    text = _text(value)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}... ({len(text)} characters)"


def _text(value: object, levels: int = 4) -> str:
    """The text of a value; what stands deeper in brackets than so many levels is left out."""
    if isinstance(value, Mapping | list | tuple) and levels == 0:
        return "..."
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_text(entry, levels - 1)}" for key, entry in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_text(entry, levels - 1) for entry in value) + "]"
    if isinstance(value, str):
        return f'"{visible(value)}"'
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) >= 1e21:
        # Python refuses to write out very long ones.
        return f"about {'-' * (value < 0)}1e{value.bit_length() * math.log10(2.0):.0f}"
    return f"{value:g}" if isinstance(value, float) else str(value)


def visible(text: str) -> str:
    """A text in which a line break, and what shows nothing, stands by its escape sequence."""
    return "".join(one if one.isprintable() else one.encode("unicode_escape").decode("ascii") for one in text)


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


def html_table(caption: str, head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Give a table under its caption; numbers with four digits, all words escaped."""
    titles = "".join(f"<th>{escape(title)}</th>" for title in head)
    body = "".join(f"<tr>{''.join(f'<td>{escape(_shown(cell))}</td>' for cell in row)}</tr>" for row in rows)
    return f"<table><caption>{escape(caption)}</caption><thead><tr>{titles}</tr></thead><tbody>{body}</tbody></table>"


def _shown(cell: object) -> str:
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)
