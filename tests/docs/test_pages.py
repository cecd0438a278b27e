"""The pages of the documentation: complete, in the navigation, and readable in an editor."""

import re
from importlib import import_module

import pytest
from blocks import PAGES, ROOT

DOCS = ROOT / "docs"
# What only the other parts use has no public names.
INTERNAL = {"files", "vocabulary", "geometry", "compilation", "statements"}
PARTS = sorted({path.parent.name for path in (ROOT / "lithobrake").glob("*/__init__.py")} - INTERNAL)
LONGEST = 100


@pytest.mark.parametrize("part", ["", *PARTS])
def test_every_public_name_is_in_the_reference(part: str) -> None:
    module = f"lithobrake.{part}".rstrip(".")
    page = DOCS / "api" / f"{part or 'package'}.md"
    shown = re.findall(rf"^::: {re.escape(module)}\.(\w+)$", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert sorted(shown) == sorted(import_module(module).__all__)


def test_every_page_is_in_the_navigation_once() -> None:
    navigation = (ROOT / "mkdocs.yml").read_text(encoding="utf-8").partition("\nnav:\n")[2]
    listed = re.findall(r"([\w/]+\.md)$", navigation, flags=re.MULTILINE)
    assert sorted(listed) == sorted(path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md"))


def test_lines_are_short_outside_tables_and_code() -> None:
    long = []
    for page in PAGES:
        in_code = False
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            in_code ^= line.startswith("```")
            # A picture or an address cannot be wrapped.
            breakable = not in_code and not line.startswith(("|", "```")) and " " in line.strip()[:LONGEST]
            if breakable and len(line) > LONGEST:
                long.append(f"{page.relative_to(ROOT)}:{number}")
    assert long == []
