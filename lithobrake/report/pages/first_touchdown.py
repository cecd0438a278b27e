"""Figures and tables of the first touchdown: rebounds, their variance, models fitted to them, and the next impacts."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.content import PageSection, PageTable, Plot
from lithobrake.report.figures.body_figures import body_figure
from lithobrake.report.figures.expansion_figures import Design, count_figure, scatter_figure, sobol_figure
from lithobrake.report.figures.hulls import scene
from lithobrake.report.figures.landing_figure import landing_figure
from lithobrake.report.figures.model_figures import calibration_figure, error_figure
from lithobrake.report.figures.place_map import PlaceMap, Places, Regions, outcomes_figure
from lithobrake.report.figures.run_figures import LandingsOfRuns, runs_figure, variance_figure
from lithobrake.report.figures.share_figures import ShareBar, folded
from lithobrake.report.live.explorer import explorer_sections
from lithobrake.report.tables import dispersion_tables as dispersion
from lithobrake.report.tables import expansion_tables, landing_tables
from lithobrake.results.page_data import PageData, PageExpansion, PageSamples
from lithobrake.results.run_results import CountedShare
from lithobrake.statements import captions, expansion, touchdowns
from lithobrake.statements.journeys import first_variance
from lithobrake.statements.labels import PAPER_OUTPUTS, SHORT_OUTCOME_WORDS
from lithobrake.vocabulary.number_words import time_limit
from lithobrake.vocabulary.outcomes import FATE_COLOURS, FlightStatus, TouchdownOutcome
from lithobrake.vocabulary.quantities import OVER_RIM

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# The titles of the rows of the figure of the variance that are no outputs.
RETURNS_ROW = {"returns": "return fraction"}


def first_touchdown(data: PageData) -> list[PageSection]:
    """What becomes of the landers after their first touchdown, when, why, how sure that is, and how it was found."""
    return [
        PageSection("Where", _where(data), dispersion.outcome_tables(data)),
        PageSection("When", tables=[dispersion.flight_table(data)]),
        _why(data),
        _sure(data),
        PageSection("Method", _method(data), _method_tables(data), explorer_sections(data)),
    ]


def _where(data: PageData) -> list[Plot]:
    samples = data.samples
    if samples is None and data.to_rest:
        return []
    plots = [Plot("outcomes", "After the first touchdown", captions.outcomes(data), lambda: _draw_outcomes(data))]
    if samples is not None:
        words = captions.body(samples)
        plots.append(Plot("body", "Impacts on the body", words, lambda: _draw_body(data, samples)))
    return plots


def _why(data: PageData) -> PageSection:
    """The parts of the variance, and the indices of an expansion."""
    found, plots, tables = data.expansion, [], list[PageTable]()
    if data.journeys is not None:
        tables += landing_tables.why_tables(data)
        if not data.to_rest:
            plots.append(variance_plot(data))
    if found is not None:
        words = expansion.sobol(found, data.study)
        plots.append(Plot("sobol", "What matters", words, lambda: draw_sobol(found)))
        tables.append(expansion_tables.sobol_table(found))
    return PageSection("Why", plots, tables)


def variance_plot(data: PageData) -> Plot:
    """The parts of the variance of the rebound."""
    words, shares = first_variance(data), data.results.variance_shares

    def draw() -> "Figure | None":
        return variance_figure(shares, RETURNS_ROW, data.level) if any(shares.values()) else None

    return Plot("variance", "Sources of variance at the first touchdown", words, draw)


def _sure(data: PageData) -> PageSection:
    """Whether to believe the models, and the return fraction with what is behind it."""
    found, emulator, plots, tables = data.expansion, data.results.emulator, [], list[PageTable]()
    if emulator is not None:
        words, scores = touchdowns.calibration(emulator, data.results.runs.beds), emulator.scores.outputs
        plots.append(Plot("calibration", "Calibration of the emulator", words, lambda: calibration_figure(scores)))
    if data.journeys is not None:
        tables += landing_tables.sure_tables(data)
    if found is not None:
        plots.append(Plot("errors", "Accuracy of the expansion", expansion.errors(found), lambda: _draw_errors(found)))
        tables += expansion_tables.sure_tables(found)
    return PageSection("How sure", plots, tables)


def _method(data: PageData) -> list[Plot]:
    found, samples, plots = data.expansion, data.samples, []
    if found is not None:
        words = expansion.counts(found, data.study)
        plots.append(Plot("designs", "Runs of the designs", words, lambda: _draw_counts(found, data)))
    if data.journeys is not None:
        words = touchdowns.runs(data)
        plots.append(Plot("runs", "Rebounds of the first touchdowns", words, lambda: _draw_runs(data)))
    if samples is not None:
        words = touchdowns.samples(samples.results)
        plots.append(Plot("outputs", "Distribution of the rebound", words, lambda: _draw_outputs(data, samples)))
    return plots


def landing_plot(data: PageData) -> Plot:
    """The landing that was kept."""

    def draw() -> "Figure | None":
        return None if data.landing is None else landing_figure(scene(data.landing, has_lander=True))

    return Plot("landing", "A landing", captions.landing(data), draw)


def _method_tables(data: PageData) -> list[PageTable]:
    """What was varied and run, and what came out."""
    found, samples, tables = data.expansion, data.samples, list[PageTable]()
    if found is not None:
        tables += [expansion_tables.inputs_table(found, data.study), expansion_tables.designs_table(found)]
    if data.journeys is not None:
        tables += [landing_tables.inputs_table(data), *landing_tables.output_tables(data)]
    if samples is not None:
        tables.append(expansion_tables.samples_table(samples.results))
    return [*tables, landing_tables.touchdowns_table(data)]


def _draw_outcomes(data: PageData) -> "Figure":
    return outcomes_figure(impacts(data), outcome_shares(data), whole_words(data))


def outcome_shares(data: PageData) -> list[ShareBar]:
    """What becomes of the landings after the first touchdown, as bars have it; what none met is one bar."""
    known, limit = dispersion.outcomes_known(data), time_limit(data.study["flight"]["duration"])
    words = {key: SHORT_OUTCOME_WORDS.get(key, long) for key, long in dispersion.parts(data).items()}
    return folded([
        share_bar(known[key], short.format(limit=limit), FATE_COLOURS[key], data.digits) for key, short in words.items()
    ])  # fmt: skip


def share_bar(entry: CountedShare, words: str, colour: str, digits: int) -> ShareBar:
    """A share of the summary, with its interval or its limit where it has one."""
    limited = entry if entry.upper_limit is None else entry.within(None, entry.upper_limit)
    return ShareBar(words, limited.share, colour, digits)


def impacts(data: PageData) -> PlaceMap:
    """Where the samples impact after the first touchdown, with the regions of these places; empty without samples."""
    colour, samples = FATE_COLOURS[FlightStatus.IMPACT], data.samples
    if samples is None:
        return PlaceMap([], [], *aim_point(data))
    places = Places("impacts", colour, samples.latitude, samples.longitude)
    return PlaceMap([places], [Regions("the impacts", colour, samples.results.regions)], *aim_point(data))


def aim_point(data: PageData) -> tuple[tuple[float, float], float]:
    """The aim point [deg], and the radius of the body there [m]."""
    site = data.results.site
    return (site.latitude_deg, site.longitude_deg), float(np.linalg.norm(site.place_m))


def whole_words(data: PageData) -> str:
    """What the shares of the outcomes are shares of."""
    samples = data.results.samples
    if data.journeys is not None or samples is None:
        return "all landings"
    return captions.whole(samples.shares.sample_count, samples.sample_count)


def _draw_outputs(data: PageData, samples: PageSamples) -> "Figure | None":
    """The outputs of samples that leave beside those of runs; None where no sample does."""
    fitted = data.expansion if samples.results.model == expansion.MODEL else None
    table, runs = samples.table, data.runs if fitted is None else fitted.runs
    leaves, left = (one["outcome"] == TouchdownOutcome.CLEAR for one in (table, runs))
    if not leaves.any():
        return None
    return scatter_figure(
        {name: table[name][leaves] for name in PAPER_OUTPUTS}, {name: runs[name][left] for name in PAPER_OUTPUTS}
    )


def _draw_body(data: PageData, samples: PageSamples) -> "Figure":
    return body_figure(data.body_vertices, data.body_faces, samples.facet, np.array(data.results.site.place_m))


def _draw_runs(data: PageData) -> "Figure":
    return runs_figure(landings_of_runs(data), quantiles_of_runs(data))


def landings_of_runs(data: PageData) -> LandingsOfRuns:
    """The first touchdowns as they ended."""
    runs = data.runs
    nan = np.full(len(runs["key"]), np.nan)
    column = {name: runs.get(name, nan) for name in ("speed_out", "elevation_out", OVER_RIM, "bed")}
    bed = np.nan_to_num(column["bed"]).astype(np.int64)
    return LandingsOfRuns(
        column["speed_out"], column["elevation_out"], runs["outcome"], column[OVER_RIM] == 1.0, bed
    )  # fmt: skip


def quantiles_of_runs(data: PageData) -> dict[str, dict[str, float]]:
    """Quantiles of the outputs [SI], by output and level."""
    return {
        name: {level: one.value for level, one in spread.quantiles.items()}
        for name, spread in data.results.spreads.items()
    }


def _draw_counts(data: PageExpansion, page: PageData) -> "Figure":
    results, section = data.results, page.study["expansion"]
    table, measure = results.node_counts, "level" if section["points"] == "smolyak" else "degree"
    designs = [
        Design(name, len(found.inputs), section[f"{name}_{measure}"], results.designs[name].run_count, measure)
        for name, found in (("screening", results.screening), ("refined", results.refined))
    ]
    tensor, smolyak = np.array(table.tensor, dtype=float), np.array(table.smolyak, dtype=float)
    return count_figure(table.input_counts, table.levels, tensor, smolyak, designs)


def draw_sobol(data: PageExpansion) -> "Figure":
    screening = data.results.screening
    names = tuple(screening.inputs)
    first = {output: np.array([screening.sobol_first[output][name] for name in names]) for output in PAPER_OUTPUTS}
    scatter = {output: screening.fits[output].noise_share for output in PAPER_OUTPUTS}
    return sobol_figure(names, first, screening.std, scatter)


def _draw_errors(data: PageExpansion) -> "Figure":
    return error_figure(data.scores["refined"], data.scores["test_kept"], data.scores["test_all"])
