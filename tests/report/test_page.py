"""The page is whole, self-contained and safe whatever words it is given."""

import re
from html.parser import HTMLParser

import pytest

from lithobrake.report.page import Panel, Table, Tile, flat, number, page


def example() -> str:
    return page(
        "Study <one>",
        "Half of them come back.",
        [Tile("48.3", "%", "re-impact")],
        [Panel("Bed", 'A "bed" of 3 grains.', b"\x89PNG"), Panel("Landing", "No landing was kept.", None)],
        [Table("Errors", ["output", "MAPE"], [["V+", "1.2 %"]], numbers=frozenset({"MAPE"}))],
        [Table("Versions", ["name", "value"], [["lithobrake", "0.1.0"]])],
        'title = "<one>"',
    )


def test_page_refers_to_nothing_outside_itself() -> None:
    text = example()
    assert not re.search(r"(?:src|href)\s*=\s*[\"'](?!data:|#)", text)
    assert "http" not in text
    assert "@import" not in text


def test_page_is_well_formed() -> None:
    open_tags: list[str] = []

    class Checker(HTMLParser):
        def handle_starttag(self, tag: str, attrs: object) -> None:
            if tag not in {"meta", "img"}:
                open_tags.append(tag)

        def handle_endtag(self, tag: str) -> None:
            assert open_tags.pop() == tag

    Checker().feed(example())
    assert open_tags == []


def test_words_are_escaped_and_figures_numbered() -> None:
    text = example()
    assert "Study &lt;one&gt;" in text
    assert "<one>" not in text
    assert "Figure 1. Bed." in text
    assert "Figure 2. Landing." in text
    assert "data:image/png;base64,iVBORw==" in text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (0.0123456, "0.0123"),
        (1234.5, "1234"),
        (5e-5, "5 × 10⁻⁵"),
        (-5.32e11, "-5.32 × 10¹¹"),
        (2.0, "2"),
    ],
)
def test_numbers_in_words(value: float, text: str) -> None:
    assert number(value) == text


def test_numbers_of_a_column_keep_their_zeros() -> None:
    assert [number(value, zeros=True) for value in (0.1, 5e-5, 100.0)] == ["0.100", "5.00 × 10⁻⁵", "100"]


def test_flat_keeps_the_order_and_joins_the_names() -> None:
    tree = {"b": {"x": 1, "y": [1.0, 2.5]}, "a": True}
    assert flat(tree) == [("b.x", "1"), ("b.y", "1, 2.5"), ("a", "yes")]
