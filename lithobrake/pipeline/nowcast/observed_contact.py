"""The first contact of a lander as it was observed: numbers in a row, or the record of an accelerometer."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lithobrake.analysis.posterior import Observation
from lithobrake.analysis.subset_simulation import ALSO_OF_CAPTURED
from lithobrake.files.reading import CsvTable, DamagedFileError, read_table
from lithobrake.pipeline.first_touchdown.emulator import ELEVATION, SPEED, SPIN
from lithobrake.pipeline.inferred_study import OUTCOME, SPEED_CHANGE, read_bounces
from lithobrake.study.units import conversion
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.number_words import percent
from lithobrake.vocabulary.outcomes import TouchdownOutcome

TIME, ACCELERATION, RATE = "time", "acceleration", "angular_rate"
# Columns of a record with their units.
RECORD = {TIME: "s", ACCELERATION: "m/s2", RATE: "rad/s"}
REMEDY = "write the columns time and acceleration, a line for each sample"
# Contact is where samples are above this part of the peak.
THRESHOLD = 0.05
# Touches about the peak are one contact if they are apart by at most this part of its length.
QUIET = 0.5
FEWEST_SAMPLES = 5
# Of the median step: a longer one is a gap.
GAP = 3.0
# A record of zeros has no contact.
LEAST_PEAK = 1e-9
# Other outcomes are those of a simulation alone.
OUTCOMES = (TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED)
# Numbers that a lander has whether it left the surface or not, and the motion that one has which left.
OF_BOTH = (*ALSO_OF_CAPTURED, SPEED_CHANGE)
MOTION = (SPEED, ELEVATION, SPIN)
SAY_OUTCOME = f"say in a column {OUTCOME} whether the lander left the surface: {', '.join(OUTCOMES)}"


@dataclass(frozen=True)
class ContactRecord:
    """time [s], acceleration by contacts [m/s2] and angular rate [rad/s], sizes of the vectors, [sample_count].

    rate: None where it was not recorded; outcome: of the contact, which the samples do not tell.
    """

    time: Array
    acceleration: Array
    rate: Array | None
    outcome: str

    @classmethod
    def read(cls, path: Path, table: CsvTable) -> "ContactRecord":
        """Of a table. Raises ValueError for samples that are no record of one whole contact, and for gaps in it."""
        columns = {name: _column(path, table, name) for name in RECORD if name in table.rows[0]}
        if ACCELERATION not in columns:
            raise ValueError(f"{path} has no column {ACCELERATION}; {REMEDY}")
        record = cls(columns[TIME], np.abs(columns[ACCELERATION]), columns.get(RATE), _outcome(path, table))
        if len(record.time) < FEWEST_SAMPLES:
            raise ValueError(f"{path} has {len(record.time)} samples; allowed: at least {FEWEST_SAMPLES}; {REMEDY}")
        steps = np.diff(record.time)
        if (steps <= 0.0).any():
            back = int(np.argmax(steps <= 0.0)) + 2
            raise ValueError(f"{path} goes back in time in row {back}; sort its rows by time, each time once")
        if record.acceleration.max() < LEAST_PEAK:
            raise ValueError(f"{path} has no acceleration above 0, so no contact; give the record of the first contact")
        record.refuse_other_contacts(path)
        first, last = record.contact
        gaps = np.flatnonzero(steps[max(first - 1, 0) : last + 1] > GAP * np.median(steps)) + max(first - 1, 0)
        if len(gaps):
            raise ValueError(
                f"{path} has a gap of {steps[gaps[0]]:.3g} s at {record.time[gaps[0]]:g} s, and its other samples are "
                f"{np.median(steps):.3g} s apart; fill the gap, or give the numbers of the contact in a row instead"
            )
        return record

    @property
    def contact(self) -> tuple[int, int]:
        """Places of the first and the last sample in contact."""
        touching, step = np.flatnonzero(self._touching), float(np.median(np.diff(self.time)))
        first = last = int(np.searchsorted(touching, self.acceleration.argmax()))
        # Touches before and behind are taken in one by one, as the contact may hold several close together.
        while True:
            length = self.time[touching[last]] - self.time[touching[first]] + step
            near = [
                other
                for own, other in ((first, first - 1), (last, last + 1))
                if 0 <= other < len(touching) and self._are_one(touching[own], touching[other], step + QUIET * length)
            ]
            if not near:
                return int(touching[first]), int(touching[last])
            first, last = min(first, *near), max(last, *near)

    def _are_one(self, own: int, other: int, reach: float) -> bool:
        """Whether two samples in contact are neighbours, or not farther apart than a reach [s]."""
        return abs(own - other) == 1 or abs(float(self.time[own] - self.time[other])) <= reach

    @property
    def _touching(self) -> np.ndarray:
        touching: np.ndarray = self.acceleration >= THRESHOLD * self.acceleration.max()
        return touching

    def refuse_other_contacts(self, path: Path) -> None:
        """Raise ValueError for a record that begins or ends in contact, or has samples in contact beside it."""
        touching, (first, last) = self._touching, self.contact
        above = f"above {percent(THRESHOLD)} of the peak"
        for place, word in ((0, "begins"), (-1, "ends")):
            if touching[place]:
                raise ValueError(
                    f"{path} {word} in contact, with {self.acceleration[place]:.3g} m/s2 at {self.time[place]:g} s, "
                    f"{above}; give the record from before the first touch until after the last, without an offset"
                )
        touching[first : last + 1] = False
        if touching.any():
            other = int(touching.argmax())
            raise ValueError(
                f"{path} has {self.acceleration[other]:.3g} m/s2 at {self.time[other]:g} s, {above} and apart from the "
                f"contact of {self.time[first]:g} to {self.time[last]:g} s; keep the first contact alone, and filter "
                "noise out"
            )

    @property
    def speed_change(self) -> float:
        """Integral of the acceleration over the contact [m/s]: the change of velocity, where its direction is kept."""
        first, last = self.contact
        return float(np.trapezoid(self.acceleration[first : last + 1], self.time[first : last + 1]))

    def observation(self) -> Observation:
        """Duration, peak and change of velocity with the errors of the sampling, and the spin after the contact."""
        first, last = self.contact
        step, peak = float(np.median(np.diff(self.time))), int(self.acceleration.argmax())
        beside = self.acceleration[max(peak - 1, 0) : peak + 2]
        outputs = {
            "contact_duration": max(float(self.time[last] - self.time[first]), step),
            "peak_acceleration": float(self.acceleration[peak]),
            "speed_change": self.speed_change,
        }
        # Between two samples the peak may have been higher by as much as they differ.
        errors = {
            "contact_duration": step,
            "peak_acceleration": float(np.ptp(beside)),
            "speed_change": step * float(self.acceleration[peak]),
        }
        # What stays where it is has no spin.
        if self.rate is not None and self.outcome == TouchdownOutcome.CLEAR:
            outputs["spin_out"] = float(abs(self.rate[-1]))
            errors["spin_out"] = float(np.std(self.rate[last:]))
        return Observation(outputs, errors, outcome=self.outcome)


def _outcome(path: Path, table: CsvTable) -> str:
    """How the contact ended, of one or all rows."""
    words = {row.get(OUTCOME, "").strip() for row in table.rows} - {""}
    if len(words) != 1 or not words <= {*OUTCOMES}:
        raise ValueError(f"{path} has {' and '.join(sorted(words)) or 'no outcome'}; {SAY_OUTCOME}")
    return words.pop()


def _column(path: Path, table: CsvTable, name: str) -> Array:
    try:
        factor = conversion(table.units[name], RECORD[name]) if name in table.units else 1.0
    except ValueError as error:
        raise ValueError(f"{path} has {name} in the {error}; convert the column") from error
    values = []
    for number, row in enumerate(table.rows, start=1):
        try:
            values.append(factor * float(row[name]))
        except ValueError as error:
            raise DamagedFileError(f'{path} has "{row[name]}" for {name} in row {number}; write a number') from error
    found = np.array(values)
    if not np.isfinite(found).all():
        lost = int(np.argmin(np.isfinite(found)))
        raise ValueError(f"{path} has {found[lost]} for {name} in row {lost + 1}; leave out samples without a number")
    return found


def read_contact(path: str | os.PathLike[str]) -> Observation:
    """Read a first contact from a CSV file: the one row of `read_bounces`, or a record with a column of times.

    Raises ValueError for more than one row, and for what either refuses.
    """
    if is_record(path):
        return ContactRecord.read(Path(path), read_table(path, (), REMEDY)).observation()
    found = read_bounces(path)
    if len(found) > 1:
        raise ValueError(
            f"{path} has {len(found)} bounces; where the lander rests follows from its first: keep its row"
        )
    return found[0]


def is_record(path: str | os.PathLike[str]) -> bool:
    """Whether a file holds the record of an accelerometer."""
    table = read_table(path, (), REMEDY)
    return bool(table.rows) and TIME in table.rows[0]


def checked_contact(contact: Observation, bounds: Mapping[str, tuple[float, float]], where: str) -> None:
    """Raise ValueError, with the file, for outputs that cannot be observed, and values and errors beyond bounds."""
    for name, value in contact.outputs.items():
        if name not in bounds:
            raise ValueError(f"{where} has {name}; outputs that may be observed: {', '.join(bounds)}")
        low, high = bounds[name]
        if not low <= value <= high:
            ends = f"{low:g} or more" if np.isinf(high) else f"{low:g} to {high:.4g}"
            raise ValueError(f"{where} has {value:g} for {name}; allowed: {ends}; look at sign and unit")
    for name, error in contact.errors.items():
        if name not in contact.outputs or not 0.0 <= error < np.inf:
            raise ValueError(f"{where} has {error:g} for error:{name}; allowed: 0 or more, of what was observed")
    if contact.outcome not in (None, *OUTCOMES):
        raise ValueError(f"{where} has the outcome {contact.outcome}; allowed: {', '.join(OUTCOMES)}")
    wrong = [name for name in contact.outputs if name not in OF_BOTH]
    if contact.outcome == TouchdownOutcome.CAPTURED and wrong:
        raise ValueError(
            f"{where} has the outcome {contact.outcome} and {', '.join(wrong)}; allowed: {', '.join(OF_BOTH)}, as a "
            "captured lander did not leave the surface; leave them out"
        )
    if contact.bed is not None:
        raise ValueError(f"{where} has the bed {contact.bed}; a nowcast is of one contact; leave the column out")
    if not contact.outputs and contact.outcome is None:
        raise ValueError(f"{where} has neither outputs nor an outcome; give at least one: {', '.join(bounds)}")
    if contact.outcome is None and not any(name in MOTION for name in contact.outputs):
        raise ValueError(f"{where} has {', '.join(contact.outputs)} and no outcome; {SAY_OUTCOME}")
