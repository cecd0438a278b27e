"""What is recorded of the contacts of one body, the watched one, whether all contacts share their steps or not."""

import numpy as np

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Floats
from lithobrake.dem.bodies.vectors import Vector, dot

# Where it stands in a record: largest force [N]; first and last instant of touch (NaN: none) by the clock of the
# stepping, steps taken or seconds (World.watched gives seconds); whether anything touches it, 1 or 0; steps taken.
PEAK_FORCE, FIRST_CONTACT, LAST_CONTACT, TOUCHED, STEPS = 0, 1, 2, 3, 4


def new_record() -> Floats:
    """Return the record of a body that nothing has touched yet."""
    return np.array([0.0, np.nan, np.nan, 0.0, 0.0])


@kernel
def record_touch(force: Vector, touched: bool, now: float, record: Floats) -> None:
    """Note whether the watched body is touched now, and if so the force on it [N] and the instant. Writes to record."""
    record[TOUCHED] = 1.0 if touched else 0.0
    if touched:
        record[PEAK_FORCE] = max(record[PEAK_FORCE], dot(force, force) ** 0.5)
        if np.isnan(record[FIRST_CONTACT]):
            record[FIRST_CONTACT] = now
        record[LAST_CONTACT] = now
