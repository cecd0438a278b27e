"""The page is whole, self-contained and safe whatever words it is given."""

import re
from html.parser import HTMLParser

import pytest

from lithobrake.report.content import (
    Content,
    PageSection,
    PageTable,
    Panel,
    Plot,
    Strip,
    StripColumn,
    Tile,
    flat,
    in_html,
    raised_units,
    show,
    unit_scales,
)
from lithobrake.report.pages.html import LONG, page
from lithobrake.statements.labels import area
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import number
from lithobrake.vocabulary.outcomes import FATE_COLOURS


def drawn(name: str, title: str, sentence: str) -> Plot:
    return Plot(name, title, sentence, lambda: None)


def example() -> str:
    errors = PageTable("Errors", ["output", "MAPE"], [["V+", "1.2 %"]], numbers=frozenset({"MAPE"}))
    versions = PageTable("Versions", ["name", "value"], [["lithobrake", "0.1.0"]])
    sections = [
        PageSection("How sure", [drawn("landing", "Landing", "No landing was kept.")], [errors]),
        PageSection("Nothing", [drawn("none", "None", "")], [PageTable("Empty", ["a"], [], "Of nothing.")]),
        PageSection("Files", tables=[versions], texts={"The study file": 'title = "<one>"'}, is_printed=False),
    ]
    tile = Tile("48.3", "%", "re-impact", "impact")
    bed = drawn("bed", "Bed", 'A "bed" of 3 grains.')
    content = Content("Half of them come back.", ["Only <two> beds."], [tile], bed, sections)
    panels = {"bed": Panel("Bed", bed.sentence, b"<svg/>"), "landing": Panel("Landing", "No landing was kept.", None)}
    return page("Study <one>", "Study of 2026-03-01.", content, panels)


def folds(tables: list[PageTable]) -> list[str]:
    """The parts of a page that can be folded, opening tag first."""
    section = PageSection("Tables", tables=tables, texts={"The study file": ""})
    text = page("Study", "", Content("", [], [], None, [section]), {})
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
    assert "data:image/svg+xml;base64,PHN2Zy8+" in text
    # What has no picture has its sentence alone, and what has neither is not there.
    assert "Figure 2" not in text
    assert '<p class="note"><b>Landing.</b> No landing was kept.</p>' in text
    assert "Nothing" not in text
    assert "Empty" not in text


def test_the_first_screen_has_the_numbers_and_the_figure_beside_the_answer() -> None:
    text = example()
    header = text[text.index("<header") : text.index("</header>")]
    order = ["Half of them come back.", "48.3", "Figure 1. Bed.", "Study of 2026-03-01."]
    assert [header.index(words) for words in order] == sorted(header.index(words) for words in order)
    assert f'<li style="border-color: {FATE_COLOURS["impact"]}">' in header


def test_contents_lead_to_each_section() -> None:
    text = example()
    assert re.findall(r'<a href="#([^"]+)">([^<]+)</a>', text) == [
        ("answer", "Answer"), ("how-sure", "How sure"), ("files", "Files"),
    ]  # fmt: skip
    assert '<section id="how-sure">' in text
    assert '<section id="files" class="screen">' in text


def test_long_tables_are_folded_short_ones_open_and_each_scrolls_in_a_box_of_its_own() -> None:
    short, long = (PageTable(name, ["a"], [["1"]] * count) for name, count in (("Short", LONG), ("Long", LONG + 1)))
    first, second, study = folds([short, long])
    assert first.startswith("<details open><summary><h3>Short</h3></summary>")
    assert second.startswith(f"<details><summary><h3>Long <small>{LONG + 1} rows</small></h3></summary>")
    assert first.count('<div class="scroll" tabindex="0"><table>') == second.count('<div class="scroll"') == 1
    assert "The study file" in study


def test_a_picture_is_enlarged_without_a_second_copy_of_it() -> None:
    text = example()
    assert text.count("data:image/svg+xml") == text.count('<label class="picture"><input type="checkbox"') == 1
    assert 'aria-label="Figure 1 in full size"' in text


def test_cells_that_are_links_lead_to_files_and_all_others_are_words() -> None:
    table = PageTable("Files", ["file", "size"], [["a.csv", "1 kB"]], links={"a.csv": "../a.csv"})
    assert '<td><a href="../a.csv">a.csv</a></td><td>1 kB</td>' in folds([table])[0]


@pytest.mark.parametrize(("value", "text"), [
    (0.0, "0"),
    (0.0123456, "0.0123"),
    (1234.5, "1234"),
    (5e-5, "5 × 10⁻⁵"),
    (-5.32e11, "-5.32 × 10¹¹"),
    (2.0, "2"),
])  # fmt: skip
def test_numbers_in_words(value: float, text: str) -> None:
    assert number(value) == text


def test_areas_have_two_digits_and_do_not_break() -> None:
    gap = "\N{NO-BREAK SPACE}"
    assert [in_html(area(value)) for value in (31637.5, 456.4, 20.46, 3.14)] == [
        f"32{gap}000{gap}m²", f"460{gap}m²", f"20{gap}m²", f"3.1{gap}m²",
    ]  # fmt: skip


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


def test_powers_of_units_are_raised_and_nothing_else_is() -> None:
    assert raised_units("1419 m2, 6 × 10⁻⁷ m2/s2, 2294 kg/m3 [m/s2]") == "1419 m², 6 × 10⁻⁷ m²/s², 2294 kg/m³ [m/s²]"
    assert raised_units("runs/s2, Q2 and m2") == "runs/s2, Q2 and m2"


def test_answers_on_each_ground_stand_on_one_scale_by_their_values() -> None:
    """Of a scale to 40: 10 (5 to 20) begins at 12.5 % and is 37.5 % wide; without bounds there is a mark alone."""
    found = [Estimate(10.0, 5.0, 20.0), Estimate(30.0, None, None), None]
    column = StripColumn("median time [min]", found, ["10 (5-20)", "30", "none"], 40.0)
    strip = Strip("By <kind>", [("gravel", "55 %"), ("rock", ""), ("ice", "")], [column], "Bars: intervals.")
    text = page("Study", "", Content("Answer.", [], [], None, [], strip), {})
    header = text[: text.index("</header>")]
    assert "By &lt;kind&gt;" in header
    rows = re.findall(r"<tr><th scope=\"row\">.*?</tr>", header)
    assert [re.findall(r"left:([\d.]+)%", row) for row in rows] == [["12.5", "25"], ["75", "75"], []]
    assert [re.findall(r"width:([\d.]+)%", row) for row in rows] == [["37.5"], ["0"], []]
    assert "<b>10</b> (5-20)" in rows[0]
    assert "<span>0</span><span>40</span>" in header
    # No box for numbers that are not there.
    assert 'class="tiles"' not in header
