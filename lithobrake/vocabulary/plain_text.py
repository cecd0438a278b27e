"""What messages show: words of others as plain text, and values as a study file would have them.

What a program prints may hold escape sequences that a terminal would obey.
"""

import difflib
import math
import re
import textwrap
from collections.abc import Iterable, Mapping

# A control sequence (colours, cursor), a string for the terminal itself (its title, its clipboard), any other.
_ESCAPE = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b[]PX^_].*?(?:\x07|\x1b\\|$)|\x1b[ -/]*[0-~]?", re.DOTALL)
LONGEST = 200  # characters of a value that a sentence shows


def plain(text: str) -> str:
    """Give a text without escape sequences, with a blank for each other character that is neither shown nor a newline.

    What is left can be shown by any terminal and kept by any file: it holds no lone surrogates and no marks that turn
    the direction of writing.
    """
    return "".join(letter if letter.isprintable() or letter == "\n" else " " for letter in _ESCAPE.sub("", text))


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


def closest(word: object, known: Iterable[str]) -> str:
    """Ask back with the nearest known word, all of which are of small letters, or say nothing when none is near."""
    text = word if isinstance(word, str) else show(word)
    near = difflib.get_close_matches(text.lower(), list(known), n=1, cutoff=0.5)
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
        return f'"{"".join(map(_visible, value))}"'
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) >= 1e21:
        # Python refuses to write out very long ones.
        return f"about {'-' * (value < 0)}1e{value.bit_length() * math.log10(2.0):.0f}"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _visible(character: str) -> str:
    """A character as it is, or by its escape sequence where it is a line break or shows nothing."""
    return character if character.isprintable() else character.encode("unicode_escape").decode("ascii")
