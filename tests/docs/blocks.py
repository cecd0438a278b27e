"""The fenced code blocks of the documents, with what the line before each says of it."""

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", flags=re.MULTILINE | re.DOTALL)
REMARK = re.compile(r"<!-- (not run: \S.*?|run) -->\n\Z")


@dataclass(frozen=True)
class Block:
    """A code block: its language, its text, the line that the text begins on, and the remark before it."""

    page: Path
    language: str
    text: str
    line: int
    remark: str

    @property
    def is_left_out(self) -> bool:
        """Whether a remark says why it must not be run."""
        return self.remark.startswith("not run: ")

    def __str__(self) -> str:
        return f"{self.page.relative_to(ROOT)}:{self.line}"


def blocks(page: Path) -> list[Block]:
    """The code blocks of a page in their order."""
    text = page.read_text(encoding="utf-8")
    found = []
    for match in FENCE.finditer(text):
        remark = REMARK.search(text, 0, match.start())
        line = text.count("\n", 0, match.start()) + 2
        found.append(Block(page, match.group(1), match.group(2), line, remark.group(1) if remark else ""))
    return found


def all_blocks(language: str) -> list[Block]:
    """The blocks of a language on all pages."""
    return [block for page in PAGES for block in blocks(page) if block.language == language]
