"""The report of a study: figures, tables and provenance on one page, and the figures beside it as PNG files."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.atomic import atomic_path
from lithobrake.outcomes import JourneyStatus, TouchdownOutcome
from lithobrake.report import captions
from lithobrake.report.bed_figure import bed_figure
from lithobrake.report.body_figure import body_figure
from lithobrake.report.captions import hours
from lithobrake.report.count_figure import Design, count_figure
from lithobrake.report.dispersion_tables import GROUND_WORDS, SUMS, followed, outcome_words
from lithobrake.report.error_figure import error_figure
from lithobrake.report.landing_figure import landing_figure
from lithobrake.report.map_figure import Share, map_figure
from lithobrake.report.page import Panel, page
from lithobrake.report.rest_figure import RestMap, rest_figure
from lithobrake.report.results import Results, page_results
from lithobrake.report.scatter_figure import scatter_figure
from lithobrake.report.sobol_figure import sobol_figure
from lithobrake.report.study_files import data_files, picture_files
from lithobrake.report.style import PAPER_OUTPUTS, figure_style, input_label
from lithobrake.report.tables import provenance, tables, tiles
from lithobrake.results import open_study
from lithobrake.results.telling_numbers import TellingNumbers

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# What may become of a lander after all bounces, as short as it has to be beside a bar.
SHORT_JOURNEY_WORDS = {
    JourneyStatus.SETTLED: "at rest",
    JourneyStatus.LOFTED: "lifted off again",
    JourneyStatus.OUTSIDE: "outside the runs",
    JourneyStatus.SLIDING: JourneyStatus.SLIDING.label,
    JourneyStatus.BOUNCING: "still bouncing",
    JourneyStatus.FLYING: "not at rest, {hours}",
    JourneyStatus.ESCAPED: JourneyStatus.ESCAPED.label,
    JourneyStatus.PARTNER: "on the partner",
}


def write_report(folder: Path, progress: Callable[[int, int], None]) -> Path:
    """Write report/index.html of a study's folder, and its figures as PNG files; returns the path of the page.

    Raises ValueError when a file that the report reads is missing.
    """
    data = page_results(open_study(folder))
    (folder / "report").mkdir(exist_ok=True)
    panels, pictures, figures = [], [], _figures(data)
    for number, (name, title, sentence, draw) in enumerate(figures, start=1):
        progress(number - 1, len(figures))
        with figure_style():
            figure = draw()
            picture = None if figure is None else _png(figure)
        if picture is not None:
            file = f"figure_{number}_{name}.png"
            with atomic_path(folder / "report" / file) as draft:
                draft.write_bytes(picture)
            pictures.append((file, f"Figure {number}. {title}"))
        panels.append(Panel(title, sentence, picture))
    title = data.study.get("title") or folder.name
    origin = [data_files(folder), picture_files(folder, pictures), *provenance(data)]
    answer, facts = captions.answer(data), captions.facts(data)
    text = page(title, answer, facts, tiles(data), panels, tables(data), origin, data.study_text)
    path = folder / "report" / "index.html"
    with atomic_path(path) as draft:
        draft.write_text(text, encoding="utf-8")
    return path


def _figures(data: Results) -> list[tuple[str, str, str, Callable[[], "Figure | None"]]]:
    """The figures of the method in its order: name of the file, title, sentence, and what draws it."""
    colour = _colour_input(data)
    of_expansions: list[tuple[str, str, str, Callable[[], Figure | None]]] = []
    if not data.is_drawn:
        of_expansions = [
            ("counts", "What the designs cost", captions.counts(data), lambda: _counts(data)),
            ("sobol", "What matters", captions.sobol(data), lambda: _sobol(data)),
            ("errors", "How good the expansion is", captions.errors(data), lambda: _errors(data)),
        ]
    return [
        ("bed", "The surface", captions.bed(data), lambda: _bed(data)),
        ("landing", "A landing", captions.landing(data), lambda: _landing(data)),
        *of_expansions,
        ("outputs", "What may come out", captions.scatter(data, colour), lambda: _outputs(data, colour)),
        ("map", "Where the lander comes down", captions.impact_map(data), lambda: _map(data)),
        ("body", "The same on the body", captions.body(data), lambda: _body(data)),
        ("rest", "Where it rests", captions.rest(data), lambda: _rest(data)),
    ]


def _png(figure: "Figure") -> bytes:
    memory = io.BytesIO()
    # The picture's own metadata would differ between versions of matplotlib; the page has the provenance.
    figure.savefig(memory, format="png", metadata={"Software": None})
    return memory.getvalue()


def _bed(data: Results) -> "Figure | None":
    if data.bed is None:
        return None
    moving, first = data.bed.moving, data.results["beds"][0]
    width = tuple(data.study["bed"]["width"])
    return bed_figure(
        *(data.bed.bodies, moving.time, moving.position, moving.orientation),
        *(width, first["surface_height_m"], moving.history),
    )


def _landing(data: Results) -> "Figure | None":
    if data.landing is None:
        return None
    moving, width = data.landing.moving, tuple(data.study["bed"]["width"])
    return landing_figure(data.landing.bodies, moving.time, moving.position, moving.orientation, width)


def _counts(data: Results) -> "Figure":
    table, results, design = data.results["node_counts"], data.results, data.study["design"]
    measure = "level" if design["points"] == "smolyak" else "degree"
    designs = [
        Design(
            name,
            len(results[name]["inputs"]),
            design[f"{name}_{measure}"],
            results["designs"][name]["run_count"],
            measure,
        )
        for name in ("screening", "refined")
    ]
    tensor, smolyak = np.array(table["tensor"], dtype=float), np.array(table["smolyak"], dtype=float)
    return count_figure(table["input_counts"], table["levels"], tensor, smolyak, designs)


def _sobol(data: Results) -> "Figure":
    screening = data.results["screening"]
    names = tuple(screening["inputs"])
    first = {output: np.array([screening["sobol_first"][output][name] for name in names]) for output in PAPER_OUTPUTS}
    scatter = {output: screening["fits"][output]["noise_share"] for output in PAPER_OUTPUTS}
    return sobol_figure(names, first, screening["std"], scatter)


def _errors(data: Results) -> "Figure":
    return error_figure(data.scores["refined"], data.scores["test_kept"], data.scores["test_all"])


def _colour_input(data: Results) -> str:
    """The restitution of the grains, as in [Landings-PCE], or the input that decides the speed most."""
    if "grain.restitution" in data.samples:
        return "grain.restitution"
    if data.is_drawn:
        return next(iter(data.samples.columns))
    return TellingNumbers.of(data.results).main_input.name


def _outputs(data: Results, colour_name: str) -> "Figure | None":
    samples = data.samples
    leaves = samples["outcome"] == TouchdownOutcome.CLEAR
    if not leaves.any():
        return None
    colour = samples.columns[colour_name]
    return scatter_figure(samples, (input_label(colour_name, colour.units), colour.values), leaves)


def _map(data: Results) -> "Figure":
    table, site, limit = data.results["shares"], data.results["site"], hours(data.study["flight"]["duration"])
    shares = [
        Share(words.format(hours=limit), table[key]["share"], upper=table[key].get("upper_limit"))
        for key, words in outcome_words(data).items()
        if key not in SUMS
    ]
    where = (site["latitude_deg"], site["longitude_deg"])
    whole = _samples(table["sample_count"], data.results["monte_carlo"]["sample_count"])
    return map_figure(data.latitude, data.longitude, where, shares, data.body_vertices, data.results["ellipses"], whole)


def _samples(looked_at: int, count: int) -> str:
    """What the shares of the flights are shares of."""
    words = f"{looked_at:,} samples".replace(",", " ")
    return f"all {words}" if looked_at == count else f"the {words} up to the last that was flown"


def _body(data: Results) -> "Figure | None":
    if not len(data.facet):
        return None
    return body_figure(data.body_vertices, data.body_faces, data.facet, np.array(data.results["site"]["place_m"]))


def _rest(data: Results) -> "Figure | None":
    found, site, limit = followed(data), data.results["site"], hours(data.study["rest"]["duration"])
    if not found:
        return None
    # The same statuses on both sides, so that rows and colours match.
    met = {key: words for key, words in SHORT_JOURNEY_WORDS.items() if any(one[key]["count"] for one in found.values())}
    maps = []
    for ground, (latitude, longitude) in data.rest.items():
        table = found.get(ground)
        shares = [Share(words.format(hours=limit), table[key]["share"]) for key, words in met.items() if table]
        absent = None if table else f"Not asked: {data.results['rest']['why_no_soil']}."
        ellipses = table["ellipses"] if table else None
        whole = f"the {table['sample_count']} followed" if table else ""
        maps.append(RestMap(f"On {GROUND_WORDS[ground]}", latitude, longitude, ellipses, shares, absent, whole))
    return rest_figure(maps, (site["latitude_deg"], site["longitude_deg"]), data.body_vertices)
