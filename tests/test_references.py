"""What a docstring cites by a key is on the page of references."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
SOURCES = sorted((ROOT / "lithobrake").rglob("*.py"))
PAGE = (ROOT / "docs" / "references.md").read_text(encoding="utf-8")
KEYS = re.findall(r"^(?:- )?\*\*\[([^\]]+)\]\*\*", PAGE, flags=re.MULTILINE)
CITED = re.compile(r"\[([A-Za-z-]+-(?:[0-9]{4}|PCE))\]")
SOURCE = re.compile(r"\bSources?(?: of [a-z ]+)?:\s.{,60}", flags=re.DOTALL)
# The text of the study file speaks to a user, who knows no keys.
READ_BY_USERS = "study"


def test_each_key_stands_once() -> None:
    assert len(set(KEYS)) == len(KEYS) > 0


def test_every_key_that_is_cited_is_on_the_page() -> None:
    cited = {key for path in SOURCES for key in CITED.findall(path.read_text("utf-8"))}
    assert "Landings-PCE" in cited
    assert cited <= set(KEYS)


def test_every_source_has_a_key() -> None:
    for path in SOURCES:
        for source in SOURCE.findall(path.read_text("utf-8")):
            assert CITED.search(source), f"{path.name}: {source}"


def test_the_paper_has_its_key() -> None:
    """Only the text of the study file, without references beside it, may say "the paper"; its method is so named."""
    for path in SOURCES:
        if path.parent.name != READ_BY_USERS:
            assert not re.search(r"\bthe\s+paper\b(?!\s+method)", path.read_text("utf-8")), path


def test_the_paper_is_named_where_the_software_is_cited() -> None:
    title = "Dynamical models for spacecraft landings in low-gravity environments using polynomial chaos"
    assert title in " ".join(PAGE.split())
    assert f'title: "{title}"' in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
