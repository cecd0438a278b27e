"""Pages of the documentation that scripts write: words from validation/pages, numbers and tables from kept rows.

The words of a page are a file of Markdown, in which the names of what a script works out stand in braces.
"""

import re
import textwrap
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from harness import PAGES, ROOT

WORDS = ROOT / "validation" / "pages"
WIDTH = 100


def write_page(name: str, folder: Path = PAGES, filled: bool = True, **parts: object) -> None:
    """Write the page of a name to a folder; filled: its paragraphs and lists are broken to lines."""
    text = words_of(name).format(**parts)
    (folder / f"{name}.md").write_text(broken(text) + "\n" if filled else text, encoding="utf-8")


def words_of(name: str) -> str:
    return (WORDS / f"{name}.md").read_text(encoding="utf-8")


def parts_of(name: str) -> dict[str, str]:
    """The parts of a file of words, each below a comment that names it."""
    cells = re.split(r"^<!-- (\w+) -->\n", words_of(name), flags=re.MULTILINE)[1:]
    return {key: text.strip("\n") for key, text in zip(cells[::2], cells[1::2], strict=True)}


def broken(text: str) -> str:
    """Text with its paragraphs and list items filled; tables, headings, pictures and code stay as they are."""
    blocks = (block.strip("\n") for block in text.split("\n\n"))
    return "\n\n".join(_block(block) for block in blocks if block)


def _block(block: str) -> str:
    if block.startswith("- "):
        items = f"\n{block}".split("\n- ")[1:]
        filled = [textwrap.fill("- " + " ".join(item.split()), WIDTH, subsequent_indent="  ") for item in items]
        return "\n".join(filled)
    if block.startswith(("|", "#", "!", "```", "---")) or "\n```" in block:
        return block
    return textwrap.fill(block, WIDTH, break_on_hyphens=False)


def table(heads: Sequence[str], rows: Iterable[Iterable[str]]) -> str:
    """A table of Markdown."""
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    return "\n".join([*lines, *(f"| {' | '.join(cells)} |" for cells in rows)])


def made(kept: dict[str, Any], *more: str) -> str:
    """Command, date and machine of a kept document, and more of it, in words."""
    return ", ".join((f"`{kept['command']}`", kept["date"], kept["machine"], *more))


def two_digits(value: float) -> str:
    """A number to two digits, never in powers of ten."""
    return f"{float(f'{value:.2g}'):g}"


def yes(holds: bool) -> str:
    return "yes" if holds else "no"
