"""Two studies that ran, compared run by run: the difference of every answer with its interval.

Run r of both came down on the same bed at the same place in the same attitude and heading, so what these do to the
answers cancels. Studies of which that does not hold are refused.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.analysis import PairedDifference, quantile_difference, ratio_difference, share_difference
from lithobrake.files.atomic import write_json
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.journey_limit_states import journeys_met
from lithobrake.pipeline.answer.run_answers import unknown_runs, why_no_interval
from lithobrake.pipeline.commands.running_estimates import CAPTURED
from lithobrake.pipeline.first_touchdown.run_flights import RunFlights
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.shared_numbers import COMMON, SharedNumbers, pair_count, values_by_lander
from lithobrake.pipeline.study_folder import REMEDY, FinishedFolder
from lithobrake.results import StudyResults, open_study
from lithobrake.results.questions import ComparedAnswer, StudyComparison
from lithobrake.results.study_files import intact_file, json_values
from lithobrake.statements.comparison import lines, other_beds, pairs
from lithobrake.study import Study
from lithobrake.vocabulary.file_names import STUDY_FILE
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.number_words import HIGH, LEVEL, MEDIAN
from lithobrake.vocabulary.outcomes import JourneyEnd, TouchdownOutcome
from lithobrake.vocabulary.quantities import TOUCHDOWN

# Numbers of a bed that tell it from every other.
OF_BED = ("solid_fraction", "surface_height_m")
OUTPUTS = ("speed_out", "elevation_out", "spin_out", "contact_duration", "penetration", "energy_lost")
# Tables of a study file that say how much of it is made, not of what.
EFFORT = ("title", "seed", "bed.bed_count", "design.run_count", "journey.count")
COPIED = ("impact", "site")


@dataclass(frozen=True)
class OneStudy:
    """A study of the two: its folder, results, study file, and what it draws, run by run or journey by journey.

    shared: what its landers have in common with those of the other; number: lander of each first touchdown
    [touchdown_count].
    """

    path: Path
    results: StudyResults
    study: Study
    shared: SharedNumbers
    number: np.ndarray

    @classmethod
    def open(cls, path: Path) -> "OneStudy":
        """Read a folder. Raises ValueError for a study that draws no lander, or did not run to its summary."""
        results = open_study(path)
        folder = FinishedFolder(path)
        source = folder.source()
        if not source.study.design.run_count:
            raise ValueError(f"{path} draws no lander (design.run_count is 0); compare studies that draw some")
        runs = DesignRuns.load(folder, "drawn")
        # A lander that is flown to the ground and misses it has a journey, and no run.
        bed, number = JourneyTable.load(folder).bed, runs.inputs["journey"].astype(int)
        columns = {
            name: values_by_lander(runs.inputs[name], number, len(bed)) for name in COMMON if name in runs.inputs
        }
        touchdowns = source.study.journey.touchdowns
        shared = SharedNumbers(str(path), touchdowns, columns | {"bed": bed.astype(float)})
        return cls(path, results, source.study, shared, number)

    @property
    def bed(self) -> np.ndarray:
        """Of each run, [run_count]."""
        return self.shared.columns["bed"].astype(int)

    @property
    def folder(self) -> FinishedFolder:
        """Its folder, to read."""
        return FinishedFolder(self.path)

    def by_lander(self, values: np.ndarray) -> np.ndarray:
        """Values of the first touchdowns [touchdown_count] as [run_count], NaN for a lander without one."""
        return values_by_lander(values, self.number, self.shared.run_count)


def compare_studies(first: Path, second: Path) -> StudyComparison:
    """Compare two studies that ran. Raises ValueError for two that cannot be paired, with the reason."""
    one, two = OneStudy.open(first), OneStudy.open(second)
    count = pair_count(one.shared, two.shared)
    bed = one.bed[:count]
    why = why_no_interval(one.study) or why_no_interval(two.study)
    found = dict(_answers((one, two), count, bed, why))
    return StudyComparison(
        names=(str(first), str(second)),
        titles=_titles(one, two),
        of=pairs(count, len(np.unique(bed))),
        level=LEVEL,
        settings=_settings(one.results.study, two.results.study),
        answers=found,
        note=_other_beds(one, two, np.unique(bed)),
        why=why,
    )


def _titles(one: OneStudy, two: OneStudy) -> tuple[str, str]:
    """Titles that tell the studies apart: those of their files, or the names of their folders."""
    titles = [str(each.results.study["title"]) for each in (one, two)]
    return (titles[0], titles[1]) if all(titles) and titles[0] != titles[1] else (one.path.name, two.path.name)


def comparison_files(out: Path) -> tuple[Path, Path]:
    """The files of a comparison in a folder: its page and its numbers."""
    return out / "index.html", out / "comparison.json"


def write_compared(comparison: StudyComparison, out: Path) -> tuple[Path, Path]:
    """Write page, figure and comparison.json of a comparison into a folder, which is made; returns page and numbers."""
    from lithobrake.report import write_comparison

    page, numbers = comparison_files(out)
    texts = [intact_file(Path(name), STUDY_FILE, REMEDY).read_text(encoding="utf-8") for name in comparison.names]
    write_comparison(comparison, texts, out)
    write_json(numbers, json_values(comparison))
    return page, numbers


def comparison_lines(comparison: StudyComparison) -> list[str]:
    """A comparison for a terminal: which studies, and a line for each answer."""
    return lines(comparison)


def _other_beds(one: OneStudy, two: OneStudy, used: np.ndarray) -> str | None:
    """What to say where beds of one number are not the same bed, as other grains or another gravity leave them."""
    tables = [each.results.beds for each in (one, two)]
    # Whose touchdowns are made by a program or function of the user's own has no beds.
    if not all(table.row_count for table in tables):
        return None
    pairs = ([table[name][used] for table in tables] for name in OF_BED)
    count = int(np.any([a != b for a, b in pairs], axis=0).sum())
    if not count:
        return None
    return other_beds(count, len(used))


def _answers(
    pair: tuple[OneStudy, OneStudy], count: int, bed: np.ndarray, why: str | None
) -> Iterator[tuple[str, ComparedAnswer]]:
    """Every answer that both studies have, by name."""
    if pair[0].study.journey.touchdowns != 1:
        yield from _journey_answers(pair, count, bed, why)
    yield from _bounce_answers(pair, count, bed, why)


def _journey_answers(
    pair: tuple[OneStudy, OneStudy], count: int, bed: np.ndarray, why: str | None
) -> Iterator[tuple[str, ComparedAnswer]]:
    tables = [JourneyTable.load(each.folder) for each in pair]
    for end in JourneyEnd:
        met = [table.end == end.value for table in tables]
        if end is not JourneyEnd.FAILED:
            met = [table.told(one) for table, one in zip(tables, met, strict=True)]
        met = [one[:count].astype(float) for one in met]
        if end is JourneyEnd.AT_REST or any((one == 1.0).any() for one in met):
            yield (
                end.value,
                _told(f"fraction {end.label}", "", share_difference(met[0], met[1], bed, why=why), is_fraction=True),
            )
    states = [each.study.limit_states.conditions() for each in pair]
    for name, text in states[0].items():
        state = LimitState.of(text)
        if state.journey and states[1].get(name) == text:
            met = [
                journeys_met(each.study, each.folder, table, state)[:count]
                for each, table in zip(pair, tables, strict=True)
            ]
            if all(np.isfinite(one).any() for one in met):
                yield (
                    name,
                    _told(f"fraction {name}", "", share_difference(met[0], met[1], bed, why=why), is_fraction=True),
                )
    numbers = (
        ("time_s", "time to rest", "s", False),
        ("contacts", "contacts", "", True),
        ("distance", "distance from aim", "m", False),
    )
    for name, words, unit, counts in numbers:
        values = [np.where(table.rests, table.numbers[name], np.nan)[:count] for table in tables]
        lost = [table.unknown[:count] for table in tables]
        yield from _quantiles(name, words, unit, values, bed, why, lost, counts=counts)
        if not counts:
            found = ratio_difference(values[0], values[1], bed, why=why, missing=(lost[0], lost[1]))
            yield f"{name}_ratio", _told(f"{words}, typical ratio", unit, found)


def _bounce_answers(
    pair: tuple[OneStudy, OneStudy], count: int, bed: np.ndarray, why: str | None
) -> Iterator[tuple[str, ComparedAnswer]]:
    runs = [(each, DesignRuns.load(each.folder, "drawn")) for each in pair]
    returns = [each.by_lander(RunFlights.load(each.folder, "drawn").returns)[:count] for each in pair]
    if all(np.isfinite(one).any() for one in returns):
        yield (
            "returns",
            _told("return fraction", "", share_difference(returns[0], returns[1], bed, why=why), is_fraction=True),
        )
    captured = [each.by_lander(_captured(one.outcomes))[:count] for each, one in runs]
    if all(np.isfinite(one).any() for one in captured):
        yield (
            TouchdownOutcome.CAPTURED.value,
            _told("fraction captured", "", share_difference(captured[0], captured[1], bed, why=why), is_fraction=True),
        )
    lost = [each.by_lander(unknown_runs(one).astype(float))[:count] == 1.0 for each, one in runs]
    for name in OUTPUTS:
        values = [each.by_lander(one.output(name))[:count] for each, one in runs]
        if all(np.isfinite(one).sum() > 1 for one in values):
            what = TOUCHDOWN[name]
            yield from _quantiles(name, what.title or what.long_name, what.units, values, bed, why, lost)


def _captured(outcomes: Sequence[str]) -> np.ndarray:
    """1 for a run that is captured, 0 for one that left, NaN for any other; [run_count]."""
    return np.array([CAPTURED.get(one, np.nan) for one in outcomes])


def _quantiles(
    name: str,
    words: str,
    unit: str,
    values: Sequence[np.ndarray],
    bed: np.ndarray,
    why: str | None,
    lost: Sequence[np.ndarray],
    *,
    counts: bool = False,
) -> Iterator[tuple[str, ComparedAnswer]]:
    """Median and 95th percentile of a number over the runs of each study that have it.

    lost: of each study, whether it is not known what became of a run.
    """
    if not all(np.isfinite(one).any() for one in values):
        return
    for level, title in ((MEDIAN, "median"), (HIGH, "95th percentile")):
        missing = tuple(out & np.isnan(one) for out, one in zip(lost, values, strict=True))
        found = quantile_difference(
            values[0], values[1], bed, level, counts=counts, why=why, missing=(missing[0], missing[1])
        )
        yield f"{name}_{title.split()[0]}", _told(f"{words}, {title}", unit, found)


def _told(words: str, unit: str, found: PairedDifference, *, is_fraction: bool = False) -> ComparedAnswer:
    # The comparison says why there are no intervals.
    first, second, difference = (one.without_reason for one in (found.first, found.second, found.difference))
    return ComparedAnswer(
        words, unit, is_fraction, first, second, difference, found.pairs, found.missing, found.correlation,
        found.landings_saved, found.is_ratio,
    )  # fmt: skip


def _settings(one: Mapping[str, Any], two: Mapping[str, Any]) -> dict[str, tuple[str, str]]:
    """Keys of the study files that differ, with both values in words."""
    a, b = (dict(_flat(tables)) for tables in (one, two))
    # What the reader of a journey study copies from [delivery] stands there already.
    copies = {f"{part}.{name.split('.')[1]}" for name in (*a, *b) if name.startswith("delivery.") for part in COPIED}
    names = [name for name in dict.fromkeys((*a, *b)) if name not in copies and name not in EFFORT]
    return {name: (a.get(name, "absent"), b.get(name, "absent")) for name in names if a.get(name) != b.get(name)}


def _flat(tables: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, str]]:
    """Numbers, words and distributions of a study by dotted key."""
    for name, value in tables.items():
        key = f"{prefix}{name}"
        if isinstance(value, Mapping) and "distribution" not in value:
            yield from _flat(value, f"{key}.")
        elif isinstance(value, Mapping):
            numbers = ", ".join(f"{part} {number:g}" for part, number in value.items() if part != "distribution")
            yield key, f"{value['distribution']}: {numbers}"
        else:
            yield key, f"{value:g}" if isinstance(value, float) else str(value)
