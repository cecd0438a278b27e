"""The page of a drawn study: its figures in the order of the work, and what stands beside them."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.content import Content, Plot
from lithobrake.report.figures.aim_figure import aim_figure
from lithobrake.report.figures.calibration_figure import calibration_figure
from lithobrake.report.figures.rare_figure import rare_figure
from lithobrake.report.figures.runs_figure import LandingsOfRuns, runs_figure
from lithobrake.report.figures.scatter_figure import scatter_figure
from lithobrake.report.figures.variance_figure import variance_figure
from lithobrake.report.live.explorer import explorer_sections
from lithobrake.report.live.views import view_sections
from lithobrake.report.page_data import DrawnPage, RunsPage
from lithobrake.report.pages import shared_plots as any_study
from lithobrake.report.tables.drawn_tables import colour_input, tables, tiles
from lithobrake.report.words import captions, drawn_captions
from lithobrake.report.words.drawn_captions import rare_caption
from lithobrake.report.words.drawn_warnings import warnings
from lithobrake.report.words.labels import input_label
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import OVER_RIM

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# The titles of the rows of figure 4 that are no outputs.
RETURNS_ROW = {"returns": "return fraction"}


def drawn_content(data: DrawnPage) -> Content:
    """All that the page shows of the study."""
    live = [*explorer_sections(data), *view_sections(data)]
    return Content(captions.answer(data), warnings(data), tiles(data), drawn_plots(data), tables(data), live)


def drawn_plots(data: DrawnPage) -> list[Plot]:
    """Its figures in the order of the work."""
    colour, words = colour_input(data), drawn_captions
    plots = [
        *landing_plots(data),
        Plot("calibration", "Whether to believe the emulator", words.calibration(data), lambda: _calibration(data)),
        Plot("outputs", "What may come out", words.samples(data, colour), lambda: _samples(data, colour)),
        Plot("map", "Where the lander comes down", captions.impact_map(data), lambda: any_study.draw_map(data)),
        Plot("body", "The same on the body", captions.body(data), lambda: any_study.draw_body(data)),
        Plot("rest", "Where it rests", captions.rest(data), lambda: any_study.draw_rest(data)),
    ]
    aim = data.results.aim
    if aim is not None:
        plots.append(Plot("aim", "Where to aim", words.aims(data, aim), lambda: aim_figure(aim)))
    if data.rare:
        plots.append(Plot("rare", "What is rare", rare_caption(data.rare), lambda: rare_figure(data.rare)))
    return plots


def landing_plots(data: RunsPage) -> list[Plot]:
    """The figures of the landings themselves, or of the first ones of journeys."""
    words = drawn_captions
    return [
        Plot("bed", "The surface", captions.bed(data), lambda: any_study.draw_bed(data)),
        Plot("landing", "A landing", captions.landing(data), lambda: any_study.draw_landing(data)),
        Plot("runs", "What the landings gave", words.runs(data), lambda: _runs(data)),
        Plot("variance", "What decides", words.variance(data), lambda: _variance(data)),
    ]


def _runs(data: RunsPage) -> "Figure":
    return runs_figure(landings_of_runs(data), quantiles_of_runs(data))


def landings_of_runs(data: RunsPage) -> LandingsOfRuns:
    """The landings of the study as they ended."""
    runs = data.runs
    nan = np.full(len(runs["key"]), np.nan)
    column = {name: runs.get(name, nan) for name in ("speed_out", "elevation_out", OVER_RIM, "bed")}
    return LandingsOfRuns(
        column["speed_out"],
        column["elevation_out"],
        runs["outcome"],
        column[OVER_RIM] == 1.0,
        np.nan_to_num(column["bed"]).astype(np.int64),
    )


def quantiles_of_runs(data: RunsPage) -> dict[str, dict[str, float]]:
    """Quantiles of the outputs [SI], by output and level."""
    return {
        name: {level: one.value for level, one in spread.quantiles.items()}
        for name, spread in data.results.spreads.items()
    }


def _variance(data: RunsPage) -> "Figure | None":
    shares = data.results.variance_shares
    return variance_figure(shares, RETURNS_ROW, data.level) if any(shares.values()) else None


def _calibration(data: DrawnPage) -> "Figure":
    return calibration_figure(data.emulator.scores.outputs)


def _samples(data: DrawnPage, colour: str | None) -> "Figure | None":
    samples = data.samples
    leaves = samples["outcome"] == TouchdownOutcome.CLEAR
    if colour is None or not leaves.any():
        return None
    column = samples.columns[colour]
    return scatter_figure(samples, (input_label(colour, column.units), column.values), leaves)
