"""Text of pages that scripts write: paragraphs and lists broken to lines of at most 100 characters."""

import textwrap
from collections.abc import Iterable, Sequence

WIDTH = 100


def broken(text: str) -> str:
    """Text with its paragraphs and list items filled; tables, headings and pictures stay as they are."""
    blocks = (block.strip("\n") for block in text.split("\n\n"))
    return "\n\n".join(_block(block) for block in blocks if block)


def _block(block: str) -> str:
    if block.startswith("- "):
        items = f"\n{block}".split("\n- ")[1:]
        filled = [textwrap.fill("- " + " ".join(item.split()), WIDTH, subsequent_indent="  ") for item in items]
        return "\n".join(filled)
    if block[0] in "|#!":
        return block
    return textwrap.fill(block, WIDTH, break_on_hyphens=False)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table."""
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    return "\n".join([*lines, *(f"| {' | '.join(cells)} |" for cells in rows)])


def two_digits(value: float) -> str:
    """Return a number to two digits, never in powers of ten."""
    return f"{float(f'{value:.2g}'):g}"
