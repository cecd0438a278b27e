"""What the site adds to mkdocs: equations as MathML, figures that lead to their files, and those of the showcase."""

import runpy
from types import SimpleNamespace
from typing import Any

import pytest
from blocks import PAGES, ROOT

pytest.importorskip("latex2mathml", reason="equations need latex2mathml: pip install -e .[docs]")
pytest.importorskip("pymdownx", reason="equations need pymdown-extensions: pip install -e .[docs]")


@pytest.fixture(scope="module")
def hooks() -> dict[str, Any]:
    """What docs/site_hooks.py defines."""
    return runpy.run_path(str(ROOT / "docs" / "site_hooks.py"))


def test_equations_become_mathml_with_the_stop_behind_them(hooks: dict[str, Any]) -> None:
    line = hooks["on_page_content"]('<p>of <span class="arithmatex">\\(a &lt; b\\)</span>, and</p>')
    assert line.startswith('<p>of <span class="equation"><math ')
    assert line.endswith("</math>,</span> and</p>")
    assert 'display="inline"' in line
    block = hooks["on_page_content"]('<div class="arithmatex">\n\\[\n\\frac{1}{2}\n\\]\n</div>')
    assert "<mfrac>" in block
    assert 'display="block"' in block


@pytest.mark.parametrize(
    "page", [page for page in PAGES if "```math" in page.read_text("utf-8")], ids=lambda page: page.name
)
def test_equations_of_a_page_have_no_command_that_is_left_as_it_is(page: Any, hooks: dict[str, Any]) -> None:
    equations = page.read_text("utf-8").split("```math\n")[1:]
    for equation in equations:
        latex = equation.split("```")[0]
        found = hooks["on_page_content"](f'<div class="arithmatex">\\[{latex}\\]</div>')
        assert "\\" not in found, latex
        # An environment that is not known leaves its marks of alignment in the text.
        assert "<mi>&</mi>" not in found, latex


def test_a_figure_leads_to_its_file_and_a_picture_in_a_line_does_not(hooks: dict[str, Any]) -> None:
    picture = '<img alt="a map" src="../map.png" />'
    figure = hooks["on_page_content"](f"<p>{picture}</p>")
    assert figure == f'<p class="figure"><a href="../map.png">{picture}</a></p>'
    assert hooks["on_page_content"](f"<p>see {picture}</p>") == f"<p>see {picture}</p>"


def test_pictures_of_the_showcase_are_part_of_the_site(hooks: dict[str, Any]) -> None:
    page = SimpleNamespace(file=SimpleNamespace(src_uri="gallery.md"))
    linked = hooks["on_page_markdown"]("![map](../showcase/mission/figures/figure_1_ends.png)", page=page)
    assert linked == "![map](showcase/mission/figures/figure_1_ends.png)"
    assert (ROOT / "showcase/mission/figures/figure_1_ends.png").is_file()


@pytest.mark.parametrize(("name", "is_left_out"), [("decisions/dem.md", True), ("method.md", False)])
def test_decisions_are_not_searched(name: str, is_left_out: bool, hooks: dict[str, Any]) -> None:
    page = SimpleNamespace(file=SimpleNamespace(src_uri=name), meta={})
    assert hooks["on_page_markdown"]("text", page=page) == "text"
    assert page.meta == ({"search": {"exclude": True}} if is_left_out else {})
