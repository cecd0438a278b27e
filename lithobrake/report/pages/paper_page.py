"""The page of a study by the method of [Landings-PCE], with the figures in its order."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.content import Content, PageSection, Plot
from lithobrake.report.figures.expansion_figures import Design, count_figure, sobol_figure
from lithobrake.report.figures.model_figures import error_figure
from lithobrake.report.live.explorer import explorer_sections
from lithobrake.report.live.views import landing_views
from lithobrake.report.pages import shared_plots as any_study
from lithobrake.report.tables import paper_tables as tables
from lithobrake.report.tables.dispersion_tables import time_tables
from lithobrake.results.page_data import PaperPage
from lithobrake.statements import captions, expansion
from lithobrake.statements.answers import sample_details, sample_tiles
from lithobrake.statements.expansion import TellingNumbers
from lithobrake.statements.labels import PAPER_OUTPUTS

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def paper_content(data: PaperPage) -> Content:
    """All that the page shows of the study."""
    method = [
        Plot("counts", "Runs of the designs", expansion.counts(data), lambda: _counts(data)),
        Plot("landing", "A landing", captions.landing(data), lambda: any_study.draw_landing(data)),
        Plot("outputs", "Distribution of the rebound", expansion.samples(data), lambda: any_study.draw_outputs(data)),
    ]
    sure = [Plot("errors", "Accuracy of the expansion", expansion.errors(data), lambda: _errors(data))]
    why = [Plot("sobol", "What matters", expansion.sobol(data), lambda: _sobol(data))]
    live = [*landing_views(data), *explorer_sections(data)]
    sections = [
        any_study.where(data, sample_details(data)),
        PageSection("When", tables=time_tables(data)),
        PageSection("Why", why, tables.why_tables(data)),
        PageSection("How sure", sure, tables.sure_tables(data)),
        PageSection("Method", method, tables.method_tables(data), live),
        any_study.appendix(data),
    ]
    shown = sample_tiles(data, TellingNumbers.of(data.results))
    return Content(data.results.answer[0], [], shown, any_study.first_map(data), sections)


def _counts(data: PaperPage) -> "Figure":
    table, results, design = data.results.node_counts, data.results, data.study["design"]
    measure = "level" if design["points"] == "smolyak" else "degree"
    designs = [
        Design(name, len(expansion.inputs), design[f"{name}_{measure}"], results.designs[name].run_count, measure)
        for name, expansion in (("screening", results.screening), ("refined", results.refined))
    ]
    tensor, smolyak = np.array(table.tensor, dtype=float), np.array(table.smolyak, dtype=float)
    return count_figure(table.input_counts, table.levels, tensor, smolyak, designs)


def _sobol(data: PaperPage) -> "Figure":
    screening = data.results.screening
    names = tuple(screening.inputs)
    first = {output: np.array([screening.sobol_first[output][name] for name in names]) for output in PAPER_OUTPUTS}
    scatter = {output: screening.fits[output].noise_share for output in PAPER_OUTPUTS}
    return sobol_figure(names, first, screening.std, scatter)


def _errors(data: PaperPage) -> "Figure":
    return error_figure(data.scores["refined"], data.scores["test_kept"], data.scores["test_all"])
