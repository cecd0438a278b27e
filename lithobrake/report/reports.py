"""The pages of a study, of a comparison of two studies and of a map of sites, with their figures as files."""

import io
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.atomic import make_folder, write_whole
from lithobrake.report.content import Content, PageSection, PageTable, Panel, Plot
from lithobrake.report.figures.option_figures import DifferenceRow, difference_figure
from lithobrake.report.figures.site_figures import agreement_figure, drawn_and_flat, rest_figure, sites_figure
from lithobrake.report.figures.style import STYLE, figure_style
from lithobrake.report.pages.html import data_files, page, picture_files
from lithobrake.report.pages.study_page import study_content
from lithobrake.report.tables.dispersion_tables import provenance_table
from lithobrake.results import open_study
from lithobrake.results.page_data import page_results
from lithobrake.results.questions import ComparedAnswer, StudyComparison
from lithobrake.results.site_results import SiteCell, SiteMap, SiteSpread
from lithobrake.statements import comparison as compared
from lithobrake.statements import sites as mapped
from lithobrake.statements.answers import Tile
from lithobrake.statements.captions import facts
from lithobrake.statements.comparison import bounded, factor, unit
from lithobrake.statements.labels import quantile, signed_points, two_digits
from lithobrake.vocabulary.constants import HOUR
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import as_sentence, with_interval

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Per inch, of what is a picture inside an SVG.
SVG_DOTS = 140
# The kinds of files of a figure, and what each must not have of the moment and the program that made it.
PICTURES: dict[str, dict[str, None]] = {"png": {"Software": None}, "svg": {"Date": None, "Creator": None}}
# Answers of the tiles.
TOLD = 4
# Sites of the short table.
BEST = 12


def write_report(folder: Path, progress: Callable[[int, int], None] = lambda done, total: None) -> Path:
    """Write report/index.html of a study's folder, and its figures as PNG and SVG files; returns the path of the page.

    progress: called with the number of figures that are drawn, and that of all.
    Raises ValueError when a file that the report reads is missing.
    """
    data = page_results(open_study(folder))
    content = study_content(data)
    drawn = drawn_panels(folder / "report", content.plots, progress)
    pictures = [
        (name, f"Figure {number}. {panel.title}")
        for number, (panel, names) in enumerate((one for one in drawn.values() if one[1]), start=1)
        for name in names
    ]
    origin = [data_files(folder), picture_files(folder, pictures), provenance_table(data)]
    files = PageSection("Files", tables=origin, texts={"The study file": data.study_text}, is_printed=False)
    whole = replace(content, sections=[*content.sections, files])
    panels = {name: panel for name, (panel, _) in drawn.items()}
    path = folder / "report" / "index.html"
    write_whole(path, page(data.study["title"] or folder.name, facts(data), whole, panels))
    return path


def drawn_panels(
    place: Path, plots: Sequence[Plot], progress: Callable[[int, int], None]
) -> dict[str, tuple[Panel, list[str]]]:
    """Draw all figures, and write each as a PNG and an SVG file in a folder, which is made.

    Returns by name of the plot its panel and the names of its files, none where there is nothing to draw.
    """
    make_folder(place)
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


def write_comparison(comparison: StudyComparison, texts: Sequence[str], place: Path) -> Path:
    """Write index.html and its figure into a folder, which is made; texts: the two study files. Returns the page."""
    plot = Plot("differences", "B minus A", compared.caption(comparison), lambda: _draw(comparison))
    title = " against ".join(comparison.titles)
    facts = f"A: {comparison.names[0]}. B: {comparison.names[1]}. {as_sentence(comparison.of)}"
    first = compared.sentence(comparison, next(iter(comparison.answers)))
    tiles = [Tile(*one) for one in compared.tiles(comparison, TOLD)]
    sections = [
        PageSection("Answers", [plot], [_comparison_table(comparison)]),
        PageSection(
            "Study files",
            tables=[_settings(comparison)],
            said=[] if comparison.settings else ["The study files agree in every key."],
            texts={f"The study file of {letter}": text for letter, text in zip("AB", texts, strict=True)},
        ),
    ]
    content = Content(first, compared.warnings(comparison), tiles, None, sections)
    panels = {name: panel for name, (panel, _) in drawn_panels(place, content.plots, lambda done, total: None).items()}
    text = page(title, facts, content, panels, kind="Comparison of two studies")
    path = place / "index.html"
    write_whole(path, text)
    return path


def _draw(comparison: StudyComparison) -> "Figure":
    answers = [one for one in comparison.answers.values() if one.difference.is_known]
    fractions = [_shown(one, 100.0) for one in answers if one.is_fraction]
    numbers = [one for one in answers if not one.is_fraction and one.first.value]
    others = [_shown(one, 100.0 if one.is_ratio else 100.0 / abs(one.first.value)) for one in numbers]
    return difference_figure([("percentage points", fractions), ("difference over the value of A [%]", others)])


def _shown(one: ComparedAnswer, times: float) -> DifferenceRow:
    return DifferenceRow(one.words, one.difference.on_scale(lambda value: times * value), compared.difference(one))


def _comparison_table(comparison: StudyComparison) -> PageTable:
    rows = [
        [
            f"{one.words} [{unit(one)}]" if unit(one) else one.words,
            bounded(one.first, factor(one)),
            bounded(one.second, factor(one)),
            compared.difference(one) if one.is_ratio else bounded(one.difference, factor(one), signed=True),
            str(one.pairs),
            "none" if one.correlation is None else two_digits(one.correlation),
            "none" if one.landings_saved is None else two_digits(one.landings_saved),
        ]
        for one in comparison.answers.values()
    ]
    columns = ["answer", "A", "B", "B minus A", "pairs", "correlation", "landings saved"]
    return PageTable("Answers", columns, rows, compared.table_note(comparison), numbers=frozenset(columns[4:]))


def _settings(comparison: StudyComparison) -> PageTable:
    rows = [[name, *values] for name, values in comparison.settings.items()]
    return PageTable("Differences between the study files", ["key", "A", "B"], rows)


def write_sites(site_map: SiteMap, study_text: str, place: Path) -> Path:
    """Write index.html and its figures into a folder, which is made; returns the page."""
    words = mapped.caption(site_map) + mapped.everywhere(drawn_and_flat(site_map)[1])
    first = Plot("rest", "Landers at rest by site", mapped.rest_caption(site_map), lambda: rest_figure(site_map))
    every = Plot("sites", "Sites", words, lambda: sites_figure(site_map))
    sections = [
        PageSection("Sites", [every], [_best(site_map), _site_table(site_map, site_map.cells, "All sites")]),
        _of_agreement(site_map),
        PageSection("Files", tables=[_provenance()], texts={"The study file": study_text}),
    ]
    content = Content(mapped.page_answer(site_map), mapped.warnings(site_map), [], first, sections)
    panels = {name: panel for name, (panel, _) in drawn_panels(place, content.plots, lambda done, total: None).items()}
    text = page(site_map.title, site_map.of, content, panels, kind="Map of sites")
    path = place / "index.html"
    write_whole(path, text)
    return path


def _of_agreement(site_map: SiteMap) -> PageSection:
    """How the emulator and the study's own landings agree, or why that is not known."""
    said = [] if site_map.at_rest is None else [mapped.compared(site_map)]
    if not site_map.agreement:
        return PageSection("How sure", said=said)
    plot = Plot(
        *("agreement", "Emulator and landings", mapped.agreement_caption(site_map)),
        lambda: agreement_figure(site_map.agreement, site_map.level),
    )
    return PageSection("How sure", [plot], [_agreement(site_map)], said=said)


def _agreement(site_map: SiteMap) -> PageTable:
    columns = ["region about", "journeys", "at rest by landings", "by the emulator", "difference [points]", "agree"]
    rows = []
    for one in site_map.agreement:
        where = "whole body"
        if one.latitude_deg is not None and one.longitude_deg is not None:
            where = f"{one.latitude_deg:.0f}, {one.longitude_deg:.0f} deg"
        verdict = {True: "yes", False: "no", None: ""}[one.agrees]
        shares = with_interval(one.landings), with_interval(one.emulator)
        rows.append([where, str(one.journeys), *shares, signed_points(one.difference), verdict])
    note = "Both columns have the same landers, so the difference has a smaller error than either fraction."
    return PageTable("Emulator and landings", columns, rows, note, numbers=frozenset(columns[1:2]))


def _best(site_map: SiteMap) -> PageTable:
    answered = [site for site in site_map.cells if site.ends is not None]
    order = sorted(answered, key=_least, reverse=True)[:BEST]
    return _site_table(site_map, order, f"The {len(order)} sites with the highest lower end of the interval")


def _least(site: SiteCell) -> tuple[float, float]:
    assert site.ends is not None
    rests = site.ends.at_rest
    return (rests.value if rests.lower is None else rests.lower), rests.value


def _site_table(site_map: SiteMap, cells: "tuple[SiteCell, ...] | list[SiteCell]", title: str) -> PageTable:
    names = tuple(site_map.cells[0].light)
    light = {"sun": "sunlight [% of day]", "earth": "Earth [% of day]"}
    columns = [
        *("latitude", "longitude", "at rest [%]", "on the partner [%]", "escaped [%]", "time to rest [h]"),
        *("distance [m]", "slope [deg]", *(light.get(name, name) for name in names), "like the best", "journeys"),
    ]
    rows = [_row(site, names) for site in cells]
    return PageTable(title, columns, rows, mapped.table_note(site_map), numbers=frozenset((*columns[:2], columns[-1])))


def _row(site: SiteCell, names: tuple[str, ...]) -> list[str]:
    ends = site.ends
    if ends is None:
        of_landers = [f"no result ({site.beyond})", "", "", "", ""]
    else:
        shares = [_share(one) for one in (ends.at_rest, ends.partner, ends.escaped)]
        of_landers = [*shares, _estimate(ends.time_s, HOUR), _estimate(ends.distance_m, 1.0)]
    light = [_spread(site.light[name], 100.0) for name in names]
    ground = [_spread(site.slope_deg, 1.0), *light, "yes" if site.not_worse else ""]
    return [f"{site.latitude_deg:.0f}", f"{site.longitude_deg:.0f}", *of_landers, *ground, str(site.journeys)]


def _share(share: Estimate) -> str:
    return with_interval(share).replace(" %", "")


def _estimate(found: Estimate | None, unit: float) -> str:
    return "" if found is None else quantile(found, unit)


def _spread(found: SiteSpread, times: float) -> str:
    low, mean, high = (times * one for one in (found.low, found.mean, found.high))
    return f"{mean:.0f}" if round(low) == round(high) else f"{mean:.0f} ({low:.0f} to {high:.0f})"


def _provenance() -> PageTable:
    rows = [["sites.json", "every number of the map"], ["sites.csv", "a row for each site"]]
    rows += [["figure_*.svg, figure_*.png", "the figures"]]
    return PageTable("Files", ["file", "what it holds"], rows, "In the folder of this page.")
