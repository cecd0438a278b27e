"""What a docstring cites by a key is on the page of references."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "references.md").read_text(encoding="utf-8")
KEYS = re.findall(r"^(?:- )?\*\*\[([^\]]+)\]\*\*", PAGE, flags=re.MULTILINE)
CITED = re.compile(r"\[([A-Za-z-]+-(?:[0-9]{4}|PCE))\]")
# Parts whose every source stands by its key.
WITH_KEYS = (
    "campaign",
    "chaos",
)


def test_each_key_stands_once() -> None:
    assert len(set(KEYS)) == len(KEYS) > 0


def test_every_key_that_is_cited_is_on_the_page() -> None:
    cited = {key for path in (ROOT / "lithobrake").rglob("*.py") for key in CITED.findall(path.read_text("utf-8"))}
    assert "Landings-PCE" in cited
    assert cited <= set(KEYS)


@pytest.mark.parametrize("part", WITH_KEYS)
def test_every_source_has_a_key(part: str) -> None:
    for path in (ROOT / "lithobrake" / part).glob("*.py"):
        for source in re.findall(r"Sources?(?: of [a-z ]+)?: .{,60}", path.read_text("utf-8"), flags=re.DOTALL):
            assert CITED.search(source), f"{path.name}: {source}"


def test_the_paper_is_named_where_the_software_is_cited() -> None:
    title = "Dynamical models for spacecraft landings in low-gravity environments using polynomial chaos"
    assert title in " ".join(PAGE.split())
    assert f'title: "{title}"' in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
