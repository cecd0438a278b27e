"""The report of a study: figures, tables and provenance on one page, and the figures beside it as PNG files."""

import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.atomic import atomic_path
from lithobrake.report import captions
from lithobrake.report.page import Panel, Plot, page
from lithobrake.report.paper_page import paper_content
from lithobrake.report.results import SequenceResults, page_results
from lithobrake.report.sequence_page import sequence_content
from lithobrake.report.study_files import data_files, picture_files
from lithobrake.report.style import figure_style
from lithobrake.report.tables import provenance
from lithobrake.results import open_study

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def write_report(folder: Path, progress: Callable[[int, int], None]) -> Path:
    """Write report/index.html of a study's folder, and its figures as PNG files; returns the path of the page.

    Raises ValueError when a file that the report reads is missing.
    """
    data = page_results(open_study(folder))
    content = sequence_content(data) if isinstance(data, SequenceResults) else paper_content(data)
    panels = _panels(folder, content.plots, progress)
    pictures = [
        (_file(number, plot), f"Figure {number}. {plot.title}")
        for number, (plot, panel) in enumerate(zip(content.plots, panels, strict=True), start=1)
        if panel.picture is not None
    ]
    title = data.study.get("title") or folder.name
    origin = [data_files(folder), picture_files(folder, pictures), *provenance(data)]
    text = page(title, captions.facts(data), content, panels, origin, data.study_text)
    path = folder / "report" / "index.html"
    with atomic_path(path) as draft:
        draft.write_text(text, encoding="utf-8")
    return path


def _panels(folder: Path, plots: Sequence[Plot], progress: Callable[[int, int], None]) -> list[Panel]:
    """Draw all figures, and write each as a PNG file."""
    (folder / "report").mkdir(exist_ok=True)
    panels = []
    for number, plot in enumerate(plots, start=1):
        progress(number - 1, len(plots))
        with figure_style():
            figure = plot.draw()
            picture = None if figure is None else _png(figure)
        if picture is not None:
            with atomic_path(folder / "report" / _file(number, plot)) as draft:
                draft.write_bytes(picture)
        panels.append(Panel(plot.title, plot.sentence, picture))
    return panels


def _file(number: int, plot: Plot) -> str:
    return f"figure_{number}_{plot.name}.png"


def _png(figure: "Figure") -> bytes:
    memory = io.BytesIO()
    # The picture's own metadata would differ between versions of matplotlib; the page has the provenance.
    figure.savefig(memory, format="png", metadata={"Software": None})
    return memory.getvalue()
