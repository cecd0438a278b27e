"""Runs in stages until the interval of a share is as narrow as asked: when to stop, and how many runs come next.

Source: [Chow-1965] (fixed width: go on until the interval of the runs so far is narrow enough).
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.bed_components import bed_components
from lithobrake.analysis.confidence import answered_runs, answers
from lithobrake.analysis.half_width import expected_half_width
from lithobrake.analysis.share_estimate import share_estimate
from lithobrake.vocabulary.given_numbers import finite_number, whole_number

# Each look at the runs is a chance to stop by luck, so looks are a tenth of the runs apart; and what the first runs say
# of their scatter is rough, so no look asks for more than twice the runs.
SMALLEST_STEP, LARGEST_STEP = 1.1, 2.0
# Counts of runs are multiples of this.
RUNS_A_STEP = 10


def half_width_of(values: ArrayLike, bed: ArrayLike) -> float | None:
    """Half the interval of the mean of values [run_count], each from 0 to 1, on beds [run_count] of any labels.

    Runs without an answer are NaN and left out: what they hide no number of runs narrows, and the interval of
    `share_estimate` adds it. None where the runs give no interval: no answer, or all on one bed.
    """
    known, beds = answered_runs(answers("values", values), bed)
    if len(known) == 0:
        return None
    found = share_estimate(known, beds)
    return None if found.lower is None or found.upper is None else 0.5 * (found.upper - found.lower)


def scatter_of(values: ArrayLike, bed: ArrayLike) -> tuple[float, float] | None:
    """Standard deviation of a run, and correlation of two on one bed, from values [run_count] on beds [run_count].

    None where this cannot be told: less than two answers, or none that differ. The correlation is 0 where no bed has
    two runs.
    """
    y, beds = answered_runs(values, bed)
    if len(y) < 2 or np.ptp(y) == 0.0:
        return None
    bed_count = int(beds.max()) + 1
    correlation = bed_components(y, beds).correlation.value if 2 <= bed_count < len(y) else 0.0
    return float(y.std(ddof=1)), min(max(correlation, 0.0), 1.0)


def next_run_count(
    values: ArrayLike, bed: ArrayLike, half_width: float, largest: int, bed_count_of: Callable[[int], int]
) -> int | None:
    """How many runs to go on to, those that are there among them; None where it is enough.

    values, bed [run_count]: answer of each run, 0 to 1 or NaN, and its bed. It is enough when half the interval is at
    most half_width, or with the largest count. bed_count_of: beds on which so many runs come down. The next count is
    the first whose half width is expected to do, by the scatter of the runs within and between beds. Raises ValueError
    for a half width that is not above 0, and for a largest count below 1.
    """
    finite_number("half_width", half_width, above=0.0)
    whole_number("largest", largest, 1)
    now, count = half_width_of(values, bed), len(answers("values", values))
    whole_number("how many runs values hold", count, 1)
    if count >= largest or (now is not None and now <= half_width):
        return None
    fewest, most = (RUNS_A_STEP * -(-round(count * step) // RUNS_A_STEP) for step in (SMALLEST_STEP, LARGEST_STEP))
    counts, scatter = range(fewest, most + 1, RUNS_A_STEP), scatter_of(values, bed)
    if now is None or scatter is None:
        # Nothing has shown yet how far runs scatter.
        return min(counts[-1], largest)
    ratio = half_width / now
    known = np.isfinite(answers("values", values)).sum()

    def expected(run_count: int) -> float:
        # Of runs to come as many will have an answer as of those that are there.
        answered = max(round(float(run_count * known / count)), 2)
        beds = min(bed_count_of(run_count), answered)
        return expected_half_width(answered, beds, spread=scatter[0], correlation=scatter[1]) or np.inf

    before = expected(count)
    return min(next((one for one in counts if expected(one) <= ratio * before), counts[-1]), largest)
