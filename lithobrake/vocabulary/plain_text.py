"""Words of others as plain text: what a program prints may hold escape sequences that a terminal would obey."""

import re
import textwrap

# A control sequence (colours, cursor), a string for the terminal itself (its title, its clipboard), any other.
_ESCAPE = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b[]PX^_].*?(?:\x07|\x1b\\|$)|\x1b[ -/]*[0-~]?", re.DOTALL)


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
