"""The runs of a design as a table of the folder, from which every later stage reads them.

The ledger knows every run that was ever made; `designs/NAME.csv` holds those that a design asks for, in its order, so
that what comes after needs neither the ledger nor the model.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from lithobrake.campaign import Runs
from lithobrake.files.atomic import write_rows
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.study_folder import AGAIN, StudyFolder
from lithobrake.study.units import run_units
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import OUTPUTS, TO_REST

# What is known of every run, whatever its inputs and outputs; times stand in the ledger alone: they never repeat.
PLAIN_COLUMNS = ("key", "outcome", "reason")


@dataclass(frozen=True)
class DesignRuns:
    """The runs of one design, in its order; all arrays of shape [run_count], NaN where a run has no such number.

    keys: of the ledger; the same where a point occurs twice. outcomes: how each ended, "failed" among them; reasons:
    why those failed. inputs: all that a run was given and drew, in the file's units; outputs [SI].
    """

    keys: list[str]
    outcomes: list[str]
    reasons: list[str]
    inputs: Mapping[str, np.ndarray]
    outputs: Mapping[str, np.ndarray]

    @classmethod
    def of(cls, runs: Runs) -> "DesignRuns":
        records = runs.records
        return cls(
            keys=[one.key for one in records],
            outcomes=runs.outcomes,
            reasons=[reason or "" for reason in runs.reasons],
            inputs=_by_name([one.inputs for one in records]),
            outputs=_by_name([one.outputs for one in records]),
        )

    @classmethod
    def distinct(cls, designs: Sequence["DesignRuns"]) -> "DesignRuns":
        # np.unique sorts by key; the sorted places give the order of the designs back.
        first = np.sort(np.unique([key for one in designs for key in one.keys], return_index=True)[1])

        def words(name: str) -> list[str]:
            return np.concatenate([np.array(getattr(one, name), dtype=object) for one in designs])[first].tolist()

        def tables(part: str) -> dict[str, np.ndarray]:
            found = [getattr(one, part) for one in designs]
            absent = [np.full(one.run_count, np.nan) for one in designs]
            return {
                name: np.concatenate([one.get(name, nan) for one, nan in zip(found, absent, strict=True)])[first]
                for name in dict.fromkeys(name for one in found for name in one)
            }

        return cls(
            keys=words("keys"),
            outcomes=words("outcomes"),
            reasons=words("reasons"),
            inputs=tables("inputs"),
            outputs=tables("outputs"),
        )

    @property
    def run_count(self) -> int:
        return len(self.keys)

    @property
    def y(self) -> np.ndarray:
        """Fitted outputs, shape [run_count, output_count]; a row of NaN where the lander did not leave."""
        y = np.column_stack([self.output(name) for name in OUTPUTS])
        # Outputs are fitted and drawn jointly, so a run counts with all of them or with none.
        clear = np.array(self.outcomes) == TouchdownOutcome.CLEAR
        return np.where((clear & ~np.isnan(y).any(axis=1))[:, None], y, np.nan)

    @property
    def has_outputs(self) -> np.ndarray:
        """Which runs have outputs, shape [run_count]."""
        return np.isfinite(self.y).all(axis=1)

    def output(self, name: str) -> np.ndarray:
        """One output, shape [run_count]."""
        return self.outputs.get(name, np.full(self.run_count, np.nan))

    @property
    def longest_way(self) -> float:
        """Longest way of a touchdown along the ground [m]; 0 where the runs do not say."""
        along, aside, *_ = (self.output(name) for name in TO_REST)
        return float(np.nanmax(np.nan_to_num(np.hypot(along, aside)), initial=0.0))

    def columns(self, names: Sequence[str]) -> np.ndarray:
        """These inputs in columns, shape [run_count, len(names)]."""
        return np.column_stack([self.inputs[name] for name in names])

    def ranges(self, names: Iterable[str]) -> dict[str, tuple[float, float]]:
        """Smallest and largest value of each of these inputs, in the file's units, by dotted key."""
        return {name: (float(self.inputs[name].min()), float(self.inputs[name].max())) for name in names}

    def outcome_counts(self) -> dict[str, int]:
        """How often each outcome came, by name in the order of the alphabet."""
        return {name: self.outcomes.count(name) for name in sorted(set(self.outcomes))}

    def save(self, folder: StudyFolder, design: str) -> None:
        """Write designs/NAME.csv, one row a run, units in the header."""
        units = run_units()
        head = [f"input:{name}" + _unit(name, units) for name in self.inputs]
        head += [f"output:{name}" + _unit(name, units) for name in self.outputs]
        columns = [*self.inputs.values(), *self.outputs.values()]
        # repr has all digits, so that what is read is what was computed, to the last bit.
        cells = [["" if np.isnan(value) else repr(value) for value in column.tolist()] for column in columns]
        path = folder / file_of(design)
        path.parent.mkdir(exist_ok=True)
        write_rows(path, [*PLAIN_COLUMNS, *head], zip(self.keys, self.outcomes, self.reasons, *cells, strict=True))

    @classmethod
    def load(cls, folder: StudyFolder, design: str) -> "DesignRuns":
        """Read what `save` wrote. Raises DamagedFileError for another file."""
        rows = read_rows(folder / file_of(design), PLAIN_COLUMNS, AGAIN)
        inputs, outputs = (
            {title.removeprefix(part): _numbers(rows, title) for title in rows[0] if title.startswith(part)}
            for part in ("input:", "output:")
        )
        return cls(
            keys=[row["key"] for row in rows],
            outcomes=[row["outcome"] for row in rows],
            reasons=[row["reason"] for row in rows],
            inputs=inputs,
            outputs=outputs,
        )


def file_of(design: str) -> str:
    return f"designs/{design}.csv"


def _numbers(rows: Sequence[Mapping[str, str]], title: str) -> np.ndarray:
    return np.array([float(row[title]) if row[title] else np.nan for row in rows])


def _by_name(rows: Sequence[Mapping[str, float]]) -> dict[str, np.ndarray]:
    """Numbers by name, shape [row_count], NaN where a row has none."""
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: np.array([row.get(name, np.nan) for row in rows], dtype=float) for name in names}


def _unit(name: str, units: Mapping[str, str]) -> str:
    return f" [{units[name]}]" if name in units else ""
