"""The first contact of a lander as it was observed: numbers in a row, or the record of an accelerometer."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lithobrake.analysis.posterior import Observation
from lithobrake.files.reading import CsvTable, DamagedFileError, read_table
from lithobrake.pipeline.inferred_study import read_bounces
from lithobrake.study.units import conversion
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.outcomes import TouchdownOutcome

TIME, ACCELERATION, RATE = "time", "acceleration", "angular_rate"
# Columns of a record with their units.
RECORD = {TIME: "s", ACCELERATION: "m/s2", RATE: "rad/s"}
REMEDY = "write the columns time and acceleration, a line for each sample"
# Contact lasts from the first to the last sample above this part of the peak.
THRESHOLD = 0.05
FEWEST_SAMPLES = 5
# Of the median step: a longer one is a gap.
GAP = 3.0
# A record of zeros has no contact.
LEAST_PEAK = 1e-9
# Other outcomes are those of a simulation alone.
OUTCOMES = (TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED)


@dataclass(frozen=True)
class ContactRecord:
    """time [s], acceleration by contacts [m/s2] and angular rate [rad/s], sizes of the vectors, [sample_count].

    rate: None where it was not recorded.
    """

    time: Array
    acceleration: Array
    rate: Array | None

    @classmethod
    def read(cls, path: Path, table: CsvTable) -> "ContactRecord":
        """Of a table. Raises ValueError for samples that are no record, and for gaps within the contact."""
        columns = {name: _column(path, table, name) for name in RECORD if name in table.rows[0]}
        if ACCELERATION not in columns:
            raise ValueError(f"{path} has no column {ACCELERATION}; {REMEDY}")
        record = cls(columns[TIME], np.abs(columns[ACCELERATION]), columns.get(RATE))
        if len(record.time) < FEWEST_SAMPLES:
            raise ValueError(f"{path} has {len(record.time)} samples; allowed: at least {FEWEST_SAMPLES}; {REMEDY}")
        steps = np.diff(record.time)
        if (steps <= 0.0).any():
            back = int(np.argmax(steps <= 0.0)) + 2
            raise ValueError(f"{path} goes back in time in row {back}; sort its rows by time, each time once")
        if record.acceleration.max() < LEAST_PEAK:
            raise ValueError(f"{path} has no acceleration above 0, so no contact; give the record of the first contact")
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
        touching = np.flatnonzero(self.acceleration >= THRESHOLD * self.acceleration.max())
        return int(touching[0]), int(touching[-1])

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
        if self.rate is not None:
            outputs["spin_out"] = float(abs(self.rate[-1]))
            errors["spin_out"] = float(np.std(self.rate[last:]))
        return Observation(outputs, errors)


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
    if contact.outcome == TouchdownOutcome.CAPTURED and contact.outputs:
        raise ValueError(
            f"{where} has the outcome {contact.outcome} and {', '.join(contact.outputs)}; allowed: outputs of a lander "
            "that left the surface; leave them out"
        )
    if not contact.outputs and contact.outcome is None:
        raise ValueError(f"{where} has neither outputs nor an outcome; give at least one: {', '.join(bounds)}")
