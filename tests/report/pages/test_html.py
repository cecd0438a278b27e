"""The page is whole, self-contained and safe whatever words it is given."""

import re
from html.parser import HTMLParser

import pytest

from lithobrake.report.content import Content, PageTable, Panel, Tile
from lithobrake.report.pages.html import LONG, page
from lithobrake.report.words.numbers import flat, number, show, unit_scales


def example() -> str:
    errors = PageTable("Errors", ["output", "MAPE"], [["V+", "1.2 %"]], numbers=frozenset({"MAPE"}))
    return page(
        "Study <one>",
        "Study of 2026-03-01.",
        Content("Half of them come back.", ["Only <two> beds."], [Tile("48.3", "%", "re-impact")], [], [errors]),
        [Panel("Bed", 'A "bed" of 3 grains.', b"\x89PNG"), Panel("Landing", "No landing was kept.", None)],
        [PageTable("Versions", ["name", "value"], [["lithobrake", "0.1.0"]])],
        {"The study file": 'title = "<one>"'},
    )


def folds(tables: list[PageTable]) -> list[str]:
    """The parts of a page that can be folded, opening tag first."""
    text = page("Study", "", Content("", [], [], [], tables), [], [], {"The study file": ""})
    return re.findall(r"<details.*?</details>", text, flags=re.DOTALL)


def test_page_refers_to_nothing_outside_itself() -> None:
    text = example()
    assert not re.search(r"(?:src|href)\s*=\s*[\"'](?!data:|#)", text)
    assert "<script>" in text
    assert "http" not in text
    assert "@import" not in text


def test_page_is_well_formed() -> None:
    open_tags: list[str] = []

    class Checker(HTMLParser):
        def handle_starttag(self, tag: str, attrs: object) -> None:
            if tag not in {"meta", "img", "input"}:
                open_tags.append(tag)

        def handle_endtag(self, tag: str) -> None:
            assert open_tags.pop() == tag

    Checker().feed(example())
    assert open_tags == []


def test_words_are_escaped_and_figures_numbered() -> None:
    text = example()
    assert "Study &lt;one&gt;" in text
    assert '<p class="warning">Only &lt;two&gt; beds.</p>' in text
    assert "<one>" not in text
    assert "Figure 1. Bed." in text
    assert "Figure 2. Landing." in text
    assert "data:image/png;base64,iVBORw==" in text


def test_long_tables_are_folded_short_ones_open_and_each_scrolls_in_a_box_of_its_own() -> None:
    short, long = (PageTable(name, ["a"], [["1"]] * count) for name, count in (("Short", LONG), ("Long", LONG + 1)))
    first, second, study = folds([short, long])
    assert first.startswith("<details open><summary><h3>Short</h3></summary>")
    assert second.startswith(f"<details><summary><h3>Long <small>{LONG + 1} rows</small></h3></summary>")
    assert first.count('<div class="scroll" tabindex="0"><table>') == second.count('<div class="scroll"') == 1
    assert "The study file" in study


def test_a_picture_is_enlarged_without_a_second_copy_of_it() -> None:
    text = example()
    assert text.count("data:image/png") == text.count('<label class="picture"><input type="checkbox"') == 1
    assert 'aria-label="Figure 1 in full size"' in text


def test_cells_that_are_links_lead_to_files_and_all_others_are_words() -> None:
    table = PageTable("Files", ["file", "size"], [["a.csv", "1 kB"]], links={"a.csv": "../a.csv"})
    assert '<td><a href="../a.csv">a.csv</a></td><td>1 kB</td>' in folds([table])[0]


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


def test_what_is_rounding_beside_its_scale_is_zero_whatever_its_size() -> None:
    assert number(-2.2e-14, scale=0.1) == number(3e-4, scale=1e6) == "0"
    assert number(-2.2e-14) == number(-2.2e-14, scale=1e-13) == "-2.2 × 10⁻¹⁴"
    assert show([425.5, -2.2e-14]) == "425.5, 0"
    assert unit_scales([("m/s", -0.2), ("m/s", 0.1), ("deg", 45.0)]) == {"m/s": 0.2, "deg": 45.0}


def test_names_that_are_alike_share_one_scale() -> None:
    tree = {"extents_m": [851.0, 620.0], "centroid_m": [-2.2e-14, 0.0], "push": 1e-14}
    alike = (("extents_m", "centroid_m"), ("push", "absent"))
    assert flat(tree, alike=alike) == [("extents_m", "851, 620"), ("centroid_m", "0, 0"), ("push", "1 × 10⁻¹⁴")]
