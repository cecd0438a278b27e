"""The report of a study: figures, tables and provenance on one page, and the figures beside it as PNG and SVG files."""

import io
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.atomic import write_whole
from lithobrake.report.content import Content, PageSection, Panel, Plot
from lithobrake.report.figures.style import STYLE, figure_style
from lithobrake.report.page_data import DrawnPage, JourneyPage, PaperPage, page_results
from lithobrake.report.pages.drawn_page import drawn_content
from lithobrake.report.pages.html import data_files, page, picture_files
from lithobrake.report.pages.journey_page import journey_content
from lithobrake.report.pages.paper_page import paper_content
from lithobrake.report.tables.paper_tables import provenance
from lithobrake.report.words import captions
from lithobrake.results import open_study

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Per inch, of what is a picture inside an SVG.
SVG_DOTS = 140
# The kinds of files of a figure, and what each must not have of the moment and the program that made it.
PICTURES: dict[str, dict[str, None]] = {"png": {"Software": None}, "svg": {"Date": None, "Creator": None}}


def write_report(folder: Path, progress: Callable[[int, int], None] = lambda done, total: None) -> Path:
    """Write report/index.html of a study's folder, and its figures as PNG and SVG files; returns the path of the page.

    progress: called with the number of figures that are drawn, and that of all.
    Raises ValueError when a file that the report reads is missing.
    """
    data = page_results(open_study(folder))
    content = _content(data)
    drawn = drawn_panels(folder / "report", content.plots, progress)
    pictures = [
        (name, f"Figure {number}. {panel.title}")
        for number, (panel, names) in enumerate((one for one in drawn.values() if one[1]), start=1)
        for name in names
    ]
    origin = [data_files(folder), picture_files(folder, pictures), *provenance(data)]
    files = PageSection("Files", tables=origin, texts={"The study file": data.study_text}, is_printed=False)
    whole = replace(content, sections=[*content.sections, files])
    panels = {name: panel for name, (panel, _) in drawn.items()}
    path = folder / "report" / "index.html"
    write_whole(path, page(data.study["title"] or folder.name, captions.facts(data), whole, panels))
    return path


def _content(data: PaperPage | DrawnPage | JourneyPage) -> Content:
    """What the page of a study has, by its method."""
    if isinstance(data, JourneyPage):
        return journey_content(data)
    return drawn_content(data) if isinstance(data, DrawnPage) else paper_content(data)


def drawn_panels(
    place: Path, plots: Sequence[Plot], progress: Callable[[int, int], None]
) -> dict[str, tuple[Panel, list[str]]]:
    """Draw all figures, and write each as a PNG and an SVG file in a folder, which is made.

    Returns by name of the plot its panel and the names of its files, none where there is nothing to draw.
    """
    place.mkdir(parents=True, exist_ok=True)
    panels: dict[str, tuple[Panel, list[str]]] = {}
    number = 0
    for done, plot in enumerate(plots):
        progress(done, len(plots))
        with figure_style():
            figure = plot.draw()
            made = {} if figure is None else {kind: _saved(figure, kind) for kind in PICTURES}
        number += bool(made)
        names = {kind: f"figure_{number}_{plot.name}.{kind}" for kind in made}
        for kind, content in made.items():
            write_whole(place / names[kind], content)
        panels[plot.name] = Panel(plot.title, plot.sentence, made.get("svg")), list(names.values())
    return panels


def _saved(figure: "Figure", kind: str) -> bytes:
    """A figure as a picture of this kind, the same bytes every time."""
    memory = io.BytesIO()
    # The picture's own metadata would differ between versions of matplotlib; the page has the provenance.
    dots = SVG_DOTS if kind == "svg" else STYLE["savefig.dpi"]
    figure.savefig(memory, format=kind, metadata=PICTURES[kind], dpi=dots)
    return memory.getvalue()
