"""The page of a drawn study: where and when its landers come down, why, how sure that is, and the landings."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.content import Content, PageSection, Plot
from lithobrake.report.figures.model_figures import calibration_figure
from lithobrake.report.figures.option_figures import aim_figure, rare_figure
from lithobrake.report.figures.run_figures import LandingsOfRuns, runs_figure, variance_figure
from lithobrake.report.live.explorer import explorer_sections
from lithobrake.report.live.views import landing_views
from lithobrake.report.page_data import DrawnPage, RunsPage
from lithobrake.report.pages import shared_plots as any_study
from lithobrake.report.tables import drawn_tables as tables
from lithobrake.report.tables.dispersion_tables import time_tables
from lithobrake.report.words import captions, drawn_captions
from lithobrake.report.words.drawn_captions import rare_caption, warnings
from lithobrake.vocabulary.quantities import OVER_RIM

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# The titles of the rows of figure 4 that are no outputs.
RETURNS_ROW = {"returns": "return fraction"}


def drawn_content(data: DrawnPage) -> Content:
    """All that the page shows of the study."""
    landings, live = {plot.name: plot for plot in landing_plots(data)}, [*landing_views(data), *explorer_sections(data)]
    samples = Plot(
        "outputs", "Distribution of the rebound", drawn_captions.samples(data), lambda: any_study.draw_outputs(data)
    )
    sections = [
        any_study.where(data),
        PageSection("When", tables=time_tables(data)),
        PageSection("Why", [landings["variance"], *_options(data)], tables.why_tables(data)),
        PageSection("How sure", _sure(data), tables.sure_tables(data)),
        PageSection("Method", [landings["runs"], samples, landings["landing"]], tables.method_tables(data), live),
        any_study.appendix(data),
    ]
    return Content(captions.answer(data), warnings(data), tables.tiles(data), any_study.first_map(data), sections)


def _options(data: DrawnPage) -> list[Plot]:
    aim = data.results.aim
    return [Plot("aim", "Where to aim", drawn_captions.aims(data, aim), lambda: aim_figure(aim))] if aim else []


def _sure(data: DrawnPage) -> list[Plot]:
    """Whether to believe the emulator, and what is rare."""
    words = drawn_captions.calibration(data)
    plots = [Plot("calibration", "Calibration of the emulator", words, lambda: _calibration(data))]
    if data.rare:
        plots.append(Plot("rare", "Rare limit states", rare_caption(data.rare), lambda: rare_figure(data.rare)))
    return plots


def landing_plots(data: RunsPage) -> list[Plot]:
    """The figures of the landings themselves, or of the first ones of journeys."""
    words = drawn_captions
    return [
        Plot("landing", "A landing", captions.landing(data), lambda: any_study.draw_landing(data)),
        Plot("runs", "Rebounds of the landings", words.runs(data), lambda: _runs(data)),
        Plot("variance", "Sources of variance", words.variance(data), lambda: _variance(data)),
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
