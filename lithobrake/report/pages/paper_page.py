"""The page of a study by the method of [Landings-PCE], with the figures in its order."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.content import Content, Plot
from lithobrake.report.figures.count_figure import Design, count_figure
from lithobrake.report.figures.error_figure import error_figure
from lithobrake.report.figures.scatter_figure import scatter_figure
from lithobrake.report.figures.sobol_figure import sobol_figure
from lithobrake.report.live.explorer import explorer_sections
from lithobrake.report.live.views import view_sections
from lithobrake.report.page_data import PaperPage
from lithobrake.report.pages import shared_plots as any_study
from lithobrake.report.tables.paper_tables import tables, tiles
from lithobrake.report.words import captions
from lithobrake.report.words.labels import PAPER_OUTPUTS, input_label
from lithobrake.results.telling_numbers import TellingNumbers
from lithobrake.vocabulary.outcomes import TouchdownOutcome

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def paper_content(data: PaperPage) -> Content:
    """All that the page shows of the study."""
    live = [*explorer_sections(data), *view_sections(data)]
    return Content(captions.answer(data), [], tiles(data), _plots(data), tables(data), live)


def _plots(data: PaperPage) -> list[Plot]:
    colour = _colour_input(data)
    return [
        Plot("bed", "The surface", captions.bed(data), lambda: any_study.draw_bed(data)),
        Plot("landing", "A landing", captions.landing(data), lambda: any_study.draw_landing(data)),
        Plot("counts", "What the designs cost", captions.counts(data), lambda: _counts(data)),
        Plot("sobol", "What matters", captions.sobol(data), lambda: _sobol(data)),
        Plot("errors", "How good the expansion is", captions.errors(data), lambda: _errors(data)),
        Plot("outputs", "What may come out", captions.scatter(data, colour), lambda: _outputs(data, colour)),
        Plot("map", "Where the lander comes down", captions.impact_map(data), lambda: any_study.draw_map(data)),
        Plot("body", "The same on the body", captions.body(data), lambda: any_study.draw_body(data)),
        Plot("rest", "Where it rests", captions.rest(data), lambda: any_study.draw_rest(data)),
    ]


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


def _colour_input(data: PaperPage) -> str:
    """The restitution of the grains, as in [Landings-PCE], or the input that decides the speed most."""
    if "grain.restitution" in data.samples:
        return "grain.restitution"
    return TellingNumbers.of(data.results).main_input.name


def _outputs(data: PaperPage, colour_name: str) -> "Figure | None":
    samples = data.samples
    leaves = samples["outcome"] == TouchdownOutcome.CLEAR
    if not leaves.any():
        return None
    colour = samples.columns[colour_name]
    return scatter_figure(samples, (input_label(colour_name, colour.units), colour.values), leaves)
