"""The page of a comparison of two studies."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.atomic import atomic_path
from lithobrake.report.content import Content, PageSection, PageTable, Plot, Tile
from lithobrake.report.figures.difference_figure import ShownDifference, difference_figure
from lithobrake.report.pages.html import page
from lithobrake.report.study_report import drawn_panels
from lithobrake.report.words.comparison_words import bounded, factor, sentence, shown, unit, verdict
from lithobrake.report.words.numbers import number
from lithobrake.results.comparison import ComparedAnswer, StudyComparison
from lithobrake.vocabulary.percentages import percent

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Answers of the tiles.
TOLD = 4


def write_comparison(comparison: StudyComparison, texts: Sequence[str], place: Path) -> Path:
    """Write index.html and its figure into a folder, which is made; texts: the two study files. Returns the page."""
    plot = Plot("differences", "B minus A", _caption(comparison), lambda: _draw(comparison))
    title = " against ".join(comparison.titles)
    facts = f"A: {comparison.names[0]}. B: {comparison.names[1]}. {comparison.of[:1].upper()}{comparison.of[1:]}."
    warnings = [words for words in (comparison.note, comparison.why) if words]
    first = sentence(comparison, next(iter(comparison.answers)))
    sections = [
        PageSection("Answers", [plot], [_table(comparison)]),
        PageSection(
            "Study files",
            tables=[_settings(comparison)],
            said=[] if comparison.settings else ["The study files agree in every key."],
            texts={f"The study file of {letter}": text for letter, text in zip("AB", texts, strict=True)},
        ),
    ]
    content = Content(first, warnings, _tiles(comparison), None, sections)
    panels = {name: panel for name, (panel, _) in drawn_panels(place, content.plots, lambda done, total: None).items()}
    text = page(title, facts, content, panels, kind="Comparison of two studies")
    path = place / "index.html"
    with atomic_path(path) as draft:
        draft.write_text(text, encoding="utf-8")
    return path


def _tiles(comparison: StudyComparison) -> list[Tile]:
    told = [(one, one.difference.value) for one in list(comparison.answers.values())[:TOLD]]
    return [
        Tile(
            shown(value, factor(one), signed=True),
            unit(one, of_difference=True),
            f"{one.words}, B minus A: {verdict(one)}",
        )
        for one, value in told
        if value is not None
    ]


def _caption(comparison: StudyComparison) -> str:
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
    answers = comparison.answers.values()
    fractions = [_shown(one, 100.0) for one in answers if one.is_fraction and one.difference.value is not None]
    others = [
        _shown(one, 100.0 / abs(one.first.value))
        for one in answers
        if not one.is_fraction and one.first.value and one.difference.value is not None
    ]
    return difference_figure([("percentage points", fractions), ("difference over the value of A [%]", others)])


def _shown(one: ComparedAnswer, times: float) -> ShownDifference:
    found = one.difference
    lower, upper = (None if end is None else times * end for end in (found.lower, found.upper))
    words = f"{bounded(found, factor(one), signed=True)} {unit(one, of_difference=True)}".strip()
    return ShownDifference(one.words, times * (found.value or 0.0), lower, upper, words)


def _table(comparison: StudyComparison) -> PageTable:
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
