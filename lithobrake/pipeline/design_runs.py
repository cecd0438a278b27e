"""The runs of a design: made by a campaign, kept as a table of the folder, and read from there by whatever comes after.

Runs are made here and nowhere else. The ledger knows every run that was ever made; `designs/NAME.csv` holds those that
this design asks for, in its order, so that later stages need neither the ledger nor the model.
"""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from lithobrake.atomic import atomic_path
from lithobrake.campaign import Runs, missing
from lithobrake.outputs import OUTPUTS
from lithobrake.pipeline.designs import design_inputs, points, replicate_count
from lithobrake.pipeline.folder import AGAIN, StudyFolder
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.touchdowns import drawn_rows, touchdown_keys, touchdowns
from lithobrake.reading import read_rows
from lithobrake.study.units import OUTPUT_UNITS, input_units

# What is known of every run, whatever its inputs and outputs; times [s].
PLAIN_COLUMNS = ("key", "outcome", "reason", "wall_s", "cpu_s")


@dataclass(frozen=True)
class DesignRuns:
    """The runs of one design, in its order; all arrays of shape [run_count], NaN where a run has no such number.

    keys: of the ledger; the same where a point occurs twice. outcomes: how each ended, "failed" among them; reasons:
    why those failed. inputs: all that a run was given and drew, in the file's units; outputs [SI]; wall_s, cpu_s: times.
    """

    keys: list[str]
    outcomes: list[str]
    reasons: list[str]
    wall_s: np.ndarray
    cpu_s: np.ndarray
    inputs: Mapping[str, np.ndarray]
    outputs: Mapping[str, np.ndarray]

    @classmethod
    def of(cls, runs: Runs) -> "DesignRuns":
        """Those of a campaign."""
        records = runs.records
        names = {part: dict.fromkeys(name for one in records for name in getattr(one, part)) for part in _PARTS}
        inputs, outputs = (
            {name: np.array([getattr(one, part).get(name, np.nan) for one in records]) for name in names[part]}
            for part in _PARTS
        )
        return cls(
            [one.key for one in records],
            runs.outcomes,
            [reason or "" for reason in runs.reasons],
            *(np.array([_number(getattr(one, name)) for one in records]) for name in ("wall_s", "cpu_s")),
            inputs,
            outputs,
        )

    @property
    def run_count(self) -> int:
        """How many runs."""
        return len(self.keys)

    @property
    def first_of_each(self) -> np.ndarray:
        """Which runs come first of those that are the same, shape [run_count]."""
        first = np.zeros(self.run_count, dtype=bool)
        first[np.unique(self.keys, return_index=True)[1]] = True
        return first

    @property
    def y(self) -> np.ndarray:
        """Fitted outputs, shape [run_count, output_count]; a row of NaN where the lander did not leave."""
        absent = np.full(self.run_count, np.nan)
        y = np.column_stack([self.outputs.get(name, absent) for name in OUTPUTS])
        clear = np.array(self.outcomes) == "clear"
        return np.where((clear & ~np.isnan(y).any(axis=1))[:, None], y, np.nan)

    @property
    def has_outputs(self) -> np.ndarray:
        """Which runs have outputs, shape [run_count]."""
        return np.isfinite(self.y).all(axis=1)

    def columns(self, names: Sequence[str]) -> np.ndarray:
        """These inputs in columns, shape [run_count, len(names)]."""
        return np.column_stack([self.inputs[name] for name in names])

    def outcome_counts(self) -> dict[str, int]:
        """How often each outcome came, by name in the order of the alphabet."""
        return {name: self.outcomes.count(name) for name in sorted(set(self.outcomes))}

    def save(self, folder: StudyFolder, design: str) -> None:
        """Write designs/NAME.csv, one row a run, units in the header."""
        units = input_units() | OUTPUT_UNITS
        head = [f"input:{name}" + _unit(name, units) for name in self.inputs]
        head += [f"output:{name}" + _unit(name, units) for name in self.outputs]
        columns = [self.wall_s, self.cpu_s, *self.inputs.values(), *self.outputs.values()]
        cells = [["" if np.isnan(value) else repr(value) for value in column.tolist()] for column in columns]
        path = folder / file_of(design)
        path.parent.mkdir(exist_ok=True)
        with atomic_path(path) as draft, draft.open("w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow([*PLAIN_COLUMNS, *head])
            table.writerows(zip(self.keys, self.outcomes, self.reasons, *cells, strict=True))

    @classmethod
    def load(cls, folder: StudyFolder, design: str) -> "DesignRuns":
        """Read what `save` wrote. Raises DamagedFileError for another file."""
        rows = read_rows(folder / file_of(design), PLAIN_COLUMNS, AGAIN)
        tables: dict[str, dict[str, np.ndarray]] = {"input": {}, "output": {}}
        for title in rows[0] if rows else ():
            part, colon, name = title.partition(":")
            if colon:
                tables[part][name.partition(" [")[0]] = _numbers(rows, title)
        return cls(
            *([row[name] for row in rows] for name in PLAIN_COLUMNS[:3]),
            *(_numbers(rows, name) for name in PLAIN_COLUMNS[3:]),
            tables["input"],
            tables["output"],
        )


_PARTS = ("inputs", "outputs")


def file_of(design: str) -> str:
    """Name of the file of a design."""
    return f"designs/{design}.csv"


def make_runs(job: Job, design: str, kept: Sequence[str] = ()) -> None:
    """Make the runs of a design, all points once, then again if asked; those that the ledger has are read from it.

    Which runs they are is noted before they are made, so that whoever looks can tell them from all others.
    Raises ValueError when too many have failed, or those that failed lie together.
    """
    inputs, x = tuple(design_inputs(job.study)), points(job.study, design, kept)
    count, title = replicate_count(job.study, design), f"{design.replace('_', ' ')} runs"
    titles = [f"{title}, {number} of {count} times" if count > 1 else title for number in range(1, count + 1)]
    rows = [drawn_rows(job.study, inputs, x, replicate) for replicate in range(count)]
    keys = [key for replicate, one in enumerate(rows) for key in touchdown_keys(job.study, one, replicate)]
    job.folder.note_runs(design, keys)
    made = [touchdowns(job, rows[replicate], words, replicate) for replicate, words in enumerate(titles)]
    runs = Runs([record for one in made for record in one.records], sum(one.reused_count for one in made))
    _account(job, design, runs, np.tile(x, (count, 1)), inputs)
    DesignRuns.of(runs).save(job.folder, design)


def _account(job: Job, design: str, runs: Runs, x: np.ndarray, inputs: Sequence[str]) -> None:
    """Say what of a design was known before, and what is missing. Raises ValueError when too much is."""
    name, distinct = design.replace("_", " "), len({record.key for record in runs.records})
    if runs.reused_count:
        job.say(f"{name}: {runs.reused_count} of {distinct} runs were known and are reused")
    lost = missing(x, runs.reasons, inputs, job.study.campaign.failed_share)
    if lost:
        job.say(f"{name}: {lost}")


def _numbers(rows: Sequence[Mapping[str, str]], title: str) -> np.ndarray:
    return np.array([float(row[title]) if row[title] else np.nan for row in rows])


def _number(value: float | None) -> float:
    return np.nan if value is None else value


def _unit(name: str, units: Mapping[str, str]) -> str:
    return f" [{units[name]}]" if name in units else ""
