"""The pages of a comparison of two studies and of a map of sites."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.atomic import write_whole
from lithobrake.report.content import Content, PageSection, PageTable, Plot, Tile
from lithobrake.report.figures.body_figures import agreement_figure, sites_figure
from lithobrake.report.figures.option_figures import DifferenceRow, difference_figure
from lithobrake.report.pages.html import page
from lithobrake.report.study_report import drawn_panels
from lithobrake.report.words.numbers import bounded, factor, number, sentence, shown, unit, verdict
from lithobrake.results.questions import ComparedAnswer, StudyComparison
from lithobrake.results.site_results import SiteCell, SiteMap, SiteSpread
from lithobrake.vocabulary.constants import HOUR
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.percentages import percent, with_interval

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Answers of the tiles.
TOLD = 4


def write_comparison(comparison: StudyComparison, texts: Sequence[str], place: Path) -> Path:
    """Write index.html and its figure into a folder, which is made; texts: the two study files. Returns the page."""
    plot = Plot("differences", "B minus A", _comparison_caption(comparison), lambda: _draw(comparison))
    title = " against ".join(comparison.titles)
    facts = f"A: {comparison.names[0]}. B: {comparison.names[1]}. {comparison.of[:1].upper()}{comparison.of[1:]}."
    warnings = [words for words in (comparison.note, comparison.why) if words]
    first = sentence(comparison, next(iter(comparison.answers)))
    sections = [
        PageSection("Answers", [plot], [_comparison_table(comparison)]),
        PageSection(
            "Study files",
            tables=[_settings(comparison)],
            said=[] if comparison.settings else ["The study files agree in every key."],
            texts={f"The study file of {letter}": text for letter, text in zip("AB", texts, strict=True)},
        ),
    ]
    content = Content(first, warnings, _comparison_tiles(comparison), None, sections)
    panels = {name: panel for name, (panel, _) in drawn_panels(place, content.plots, lambda done, total: None).items()}
    text = page(title, facts, content, panels, kind="Comparison of two studies")
    path = place / "index.html"
    write_whole(path, text)
    return path


def _comparison_tiles(comparison: StudyComparison) -> list[Tile]:
    return [
        Tile(
            shown(one.difference.value, factor(one), signed=True),
            unit(one, of_difference=True),
            f"{one.words}, B minus A: {verdict(one)}",
        )
        for one in list(comparison.answers.values())[:TOLD]
        if one.difference.is_known
    ]


def _comparison_caption(comparison: StudyComparison) -> str:
    saved = [one.landings_saved for one in comparison.answers.values() if one.landings_saved is not None]
    gain = (
        f" Two studies with different beds and impact points would need {number(min(saved), 2)} to "
        f"{number(max(saved), 2)} times as many landings for equally narrow intervals."
        if saved
        else ""
    )
    return (
        f"Differences of the results with their {percent(comparison.level)} intervals over beds and impact points, "
        f"from {comparison.of}: runs with the same number share bed, impact point, attitude and heading.{gain}"
    )


def _draw(comparison: StudyComparison) -> "Figure":
    answers = [one for one in comparison.answers.values() if one.difference.is_known]
    fractions = [_shown(one, 100.0) for one in answers if one.is_fraction]
    others = [_shown(one, 100.0 / abs(one.first.value)) for one in answers if not one.is_fraction and one.first.value]
    return difference_figure([("percentage points", fractions), ("difference over the value of A [%]", others)])


def _shown(one: ComparedAnswer, times: float) -> DifferenceRow:
    words = f"{bounded(one.difference, factor(one), signed=True)} {unit(one, of_difference=True)}".strip()
    return DifferenceRow(one.words, one.difference.on_scale(lambda value: times * value), words)


def _comparison_table(comparison: StudyComparison) -> PageTable:
    rows = [
        [
            f"{one.words} [{unit(one)}]" if unit(one) else one.words,
            bounded(one.first, factor(one)),
            bounded(one.second, factor(one)),
            bounded(one.difference, factor(one), signed=True),
            str(one.pairs),
            "none" if one.correlation is None else number(one.correlation, 2),
            "none" if one.landings_saved is None else number(one.landings_saved, 2),
        ]
        for one in comparison.answers.values()
    ]
    columns = ["answer", "A", "B", "B minus A", "pairs", "correlation", "landings saved"]
    note = (
        f"With {percent(comparison.level)} intervals. Correlation: of the two runs of a pair. Landings saved: factor "
        "by which an unpaired comparison needs more landings for the same interval."
    )
    return PageTable("Answers", columns, rows, note, numbers=frozenset(columns[4:]))


def _settings(comparison: StudyComparison) -> PageTable:
    rows = [[name, *values] for name, values in comparison.settings.items()]
    return PageTable("Differences between the study files", ["key", "A", "B"], rows)


# Sites of the short table.
BEST = 12


def write_sites(site_map: SiteMap, study_text: str, place: Path) -> Path:
    """Write index.html and its figures into a folder, which is made; returns the page."""
    first = Plot("sites", "Sites", _site_caption(site_map), lambda: sites_figure(site_map))
    sections = [
        PageSection("Sites", tables=[_best(site_map), _site_table(site_map, site_map.cells, "All sites")]),
        *([_of_agreement(site_map)] if site_map.agreement else []),
        PageSection("Files", tables=[_provenance()], texts={"The study file": study_text}),
    ]
    content = Content(site_map.statement, _warnings(site_map), _site_tiles(site_map), first, sections)
    panels = {name: panel for name, (panel, _) in drawn_panels(place, content.plots, lambda done, total: None).items()}
    text = page(site_map.title, site_map.of, content, panels, kind="Map of sites")
    path = place / "index.html"
    write_whole(path, text)
    return path


def _of_agreement(site_map: SiteMap) -> PageSection:
    """How the emulator and the study's own landings agree."""
    plot = Plot(
        *("agreement", "Emulator and landings", _agreement_caption(site_map)),
        lambda: agreement_figure(site_map.agreement, site_map.level),
    )
    return PageSection("How sure", [plot], [_agreement(site_map)])


def _warnings(site_map: SiteMap) -> list[str]:
    """What to beware of."""
    found = [site_map.why] if site_map.why else []
    lacking = len(site_map.cells) - site_map.answered
    if lacking:
        found += [
            f"{lacking} of {len(site_map.cells)} sites have no result: more than 10 % of their landers have an impact "
            "outside the range of the study's journeys. A study delivered all over the body covers them."
        ]
    if site_map.agreement and site_map.agreement[0].agrees is False:
        found += ["Emulator and landings do not agree on the landers at rest: follow more journeys (journey.count)."]
    return found


def _site_tiles(site_map: SiteMap) -> list[Tile]:
    shares = [site.ends.at_rest.value for site in site_map.cells if site.ends is not None]
    if not shares or site_map.at_rest is None:
        return []
    best = sum(site.not_worse for site in site_map.cells)
    hours = site_map.duration_s / HOUR
    return [
        Tile(percent(site_map.at_rest.value).removesuffix(" %"), "%", f"at rest within {hours:.3g} h, over all sites"),
        Tile(f"{100 * min(shares):.0f} to {100 * max(shares):.0f}", "%", "at rest, from site to site"),
        Tile(str(best), f"of {len(site_map.cells)}", "sites cannot be distinguished from the best"),
        Tile(str(site_map.answered), f"of {len(site_map.cells)}", "sites have a result"),
    ]


def _site_caption(site_map: SiteMap) -> str:
    light = "; light is the mean over a day and the seasons of the study" if site_map.cells[0].light else ""
    return (
        f"The same delivery to each of {len(site_map.cells)} sites of {site_map.body}, in "
        f"Hammer's equal-area projection about longitude 0. Slopes are those of the facets{light}. Intervals are "
        "in the table of all sites."
    )


def _agreement_caption(site_map: SiteMap) -> str:
    return (
        "The journeys of the study, by simulated landings and by refits of the emulator to other beds: "
        "all of them (filled), and those with their first touchdown in each region of an "
        f"eighth of the body, with {percent(site_map.level)} intervals."
    )


def _agreement(site_map: SiteMap) -> PageTable:
    columns = ["region about", "journeys", "at rest by landings", "by the emulator", "difference [points]", "agree"]
    rows = []
    for one in site_map.agreement:
        where = "whole body"
        if one.latitude_deg is not None and one.longitude_deg is not None:
            where = f"{one.latitude_deg:.0f}, {one.longitude_deg:.0f} deg"
        off = one.difference
        bounds = "" if off.bounds is None else f" ({' to '.join(f'{100 * end:+.0f}' for end in off.bounds)})"
        verdict = {True: "yes", False: "no", None: ""}[one.agrees]
        shares = with_interval(one.landings), with_interval(one.emulator)
        rows.append([where, str(one.journeys), *shares, f"{100 * off.value:+.0f}{bounds}", verdict])
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
    words = {"sun": "sunlight [% of day]", "earth": "Earth [% of day]"}
    columns = [
        *("latitude", "longitude", "at rest [%]", "on the partner [%]", "escaped [%]", "time to rest [h]"),
        *("distance [m]", "slope [deg]", *(words.get(name, name) for name in names), "like the best", "journeys"),
    ]
    note = (
        f"Middle of each site [deg]. Fractions and medians with {percent(site_map.level)} intervals; slope and light "
        "as the mean over the site, and the span of 90 % of its area. Journeys: of the study, with their first "
        "touchdown there."
    )
    rows = [_row(site, names) for site in cells]
    return PageTable(title, columns, rows, note, numbers=frozenset((*columns[:2], columns[-1])))


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
    if found is None:
        return ""
    value, ends = number(found.value / unit, 2), " to ".join(number(end / unit, 2) for end in found.bounds or ())
    return f"{value} ({ends})" if ends else value


def _spread(found: SiteSpread, times: float) -> str:
    low, mean, high = (times * one for one in (found.low, found.mean, found.high))
    return f"{mean:.0f}" if round(low) == round(high) else f"{mean:.0f} ({low:.0f} to {high:.0f})"


def _provenance() -> PageTable:
    rows = [["sites.json", "every number of the map"], ["sites.csv", "a row for each site"]]
    rows += [["figure_*.svg, figure_*.png", "the figures"]]
    return PageTable("Files", ["file", "what it holds"], rows, "In the folder of this page.")
