"""How wide the interval of a study will be, how many runs a width asks for, and when to stop."""

import math
from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from lithobrake.analysis.confidence import LEVEL, answered_runs, answers, bed_components, numbered_beds, t_quantile
from lithobrake.analysis.share_estimate import plain_interval, share_estimate
from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.given_numbers import LARGEST, finite_number, whole_number

# Standard deviation of a run's share of flights that return, as measured on studies in which some do and some do not
# (docs/estimates.md): the range, and the larger one, which promises no more than a study keeps.
SPREAD_RANGE = (0.04, 0.21)
SPREAD = SPREAD_RANGE[1]
# Correlation of two runs on one bed in the mean over studies, of the return fraction of landings and of the fraction at
# rest of journeys (docs/estimates.md).
CORRELATION, JOURNEY_CORRELATION = 0.02, 0.07
# Narrower intervals than this part of the spread would take a million million runs.
NARROWEST = 1e-6
# Correlations of two runs on one bed; before a study has runs they are as likely as by an exponential law.
CORRELATIONS = np.linspace(0.0, 0.5, 101)
STUDIES = 400
# Runs of studies that are made up, in all: larger studies are fewer, and scatter less.
MOST_RUNS, FEWEST_STUDIES = 1_000_000, 100
# Each look at the runs is a chance to stop by luck, so looks are a tenth of the runs apart; and what the first runs say
# of their scatter is rough, so no look asks for more than twice the runs.
SMALLEST_STEP, LARGEST_STEP = 1.1, 2.0
# More beds than any half width asks for.
MOST_BEDS = 2**60
# Counts of runs are multiples of this.
RUNS_A_STEP = 10


def expected_half_width(
    run_count: int, bed_count: int, *, spread: float = SPREAD, correlation: float = CORRELATION
) -> float | None:
    """Half width of the interval of a mean over runs on beds of equal counts [unit of spread]; None for one bed.

    spread: standard deviation of a run at what the inputs leave open; correlation of two runs on one bed, 0 to 1.
    Raises ValueError for counts or numbers that cannot be. Source: [Cochran-1977], section 10.3 (two stages).
    """
    whole_number("bed_count", bed_count, 1, whole_number("run_count", run_count, 1))
    _check_scatter(spread, correlation)
    if bed_count == 1:
        return None
    variance = spread**2 * (correlation / bed_count + (1.0 - correlation) / run_count)
    return t_quantile(bed_count - 1) * math.sqrt(variance)


def best_runs_a_bed(bed_cost: float, correlation: float = CORRELATION) -> float:
    """Runs on each bed that give the narrowest interval for their time, sqrt(c (1 - rho) / rho), at least 1.

    bed_cost: of a bed, c, in runs, above 0; correlation of two runs on one bed, rho: 0 gives infinity, 1 gives 1.
    Raises ValueError for numbers that cannot be. Source: [Cochran-1977], section 10.6.
    """
    finite_number("bed_cost", bed_cost, above=0.0)
    _check_scatter(0.0, correlation)
    return max(math.sqrt(bed_cost * (1.0 - correlation) / correlation), 1.0) if correlation else math.inf


def cost_over_best(runs_a_bed: float, best: float, bed_cost: float, correlation: float = CORRELATION) -> float:
    """Ratio of the times to reach one interval width with two numbers of runs on each bed.

    runs_a_bed, best, bed_cost (in runs): above 0. Student's t, which falls with more beds, is left out.
    Raises ValueError for numbers that cannot be. Source: [Cochran-1977], section 10.6.
    """
    for name, value in (("runs_a_bed", runs_a_bed), ("best", best), ("bed_cost", bed_cost)):
        finite_number(name, value, above=0.0)
    _check_scatter(0.0, correlation)
    # Cost of a run with its part of the bed, times variance of the mean over that of independent runs.
    costs = [(1.0 + bed_cost / one) * (1.0 + (one - 1.0) * correlation) for one in (runs_a_bed, best)]
    return costs[0] / costs[1]


def runs_for_half_width(
    half_width: float, runs_per_bed: int = 20, *, spread: float = SPREAD, correlation: float = CORRELATION
) -> int:
    """Smallest number of runs (whole beds) whose expected half-width does not exceed the requested one.

    Raises ValueError for a half width below a millionth of the spread, and for numbers that cannot be.
    """
    _check_scatter(spread, correlation)
    finite_number("half_width", half_width, above=0.0, at_least=NARROWEST * spread)
    whole_number("runs_per_bed", runs_per_bed, 1)

    def narrow_enough(bed_count: int) -> bool:
        found = expected_half_width(bed_count * runs_per_bed, bed_count, spread=spread, correlation=correlation)
        return found is not None and found <= half_width

    # The width falls with every bed.
    return runs_per_bed * bisect_left(range(MOST_BEDS), True, lo=2, key=narrow_enough)


def _check_scatter(spread: float, correlation: float) -> None:
    """Refuse a spread below 0, and a correlation outside 0 to 1, with a ValueError."""
    finite_number("spread", spread, at_least=0.0, at_most=LARGEST)
    finite_number("correlation", correlation, at_least=0.0, at_most=1.0)


# What is known of the outcome of a run, 0 to 1, and what is not: gives those of so many independent runs of one study
# [count], whose own numbers are drawn first.
RunLaw = Callable[[np.random.Generator, int], Array]


@dataclass(frozen=True)
class AllOrNothing:
    """Each run is 0 or 1, as at rest or not; the fraction of 1 lies between two, more likely near the first.

    It is likeliest + (farthest - likeliest) u^2 with u uniform from 0 to 1.
    """

    likeliest: float
    farthest: float

    def __call__(self, random: np.random.Generator, count: int) -> Array:
        share = self.likeliest + (self.farthest - self.likeliest) * random.random() ** 2
        return (random.random(count) < share).astype(float)


@dataclass(frozen=True)
class Shares:
    """Each run is a share of 0 to 1 by a beta law of this mean, whose standard deviation may be any between two."""

    mean: float
    smallest_spread: float
    largest_spread: float

    def __call__(self, random: np.random.Generator, count: int) -> Array:
        spread = self.smallest_spread + (self.largest_spread - self.smallest_spread) * random.random()
        size = self.mean * (1.0 - self.mean) / spread**2 - 1.0
        return random.beta(self.mean * size, (1.0 - self.mean) * size, count)


@dataclass(frozen=True, eq=False)
class LikeRuns:
    """Runs are as those of a study so far, values [run_count] on beds [run_count] numbered from 0.

    Which of them stand for how many is drawn, by beds. Where all are 0 or 1, half a run at 0 and half a run at 1 are
    added: runs that all end alike do not say that none will differ.
    Source: [Rubin-1981] (Bayesian bootstrap).
    """

    values: Array
    bed: Labels

    def __call__(self, random: np.random.Generator, count: int) -> Array:
        weights = random.standard_exponential(int(self.bed.max()) + 1)[self.bed]
        values = self.values
        if np.isin(values, (0.0, 1.0)).all():
            values = np.append(values, (0.0, 1.0))
            weights = np.append(weights, random.standard_gamma(0.5, 2))
        return random.choice(values, count, p=weights / weights.sum())


class HalfWidthRange(NamedTuple):
    """5 %, 50 % and 95 % quantiles of the half-width over studies, as fractions of 1."""

    lower: float
    median: float
    upper: float


def half_width_range(
    law: RunLaw, bed: ArrayLike, *, values: ArrayLike = (), values_bed: ArrayLike = (), missing: float = 0.0,
    correlation: float = CORRELATION, seed: int = 0,
) -> HalfWidthRange | None:  # fmt: skip
    """Range of the half-width of the 90 % interval in nine of ten studies; None for one bed.

    bed [run_count]      of each run that is still to come, any labels
    values, values_bed   outcomes of the runs that there are, 0 to 1 or NaN, and their beds [known_count]
    missing              fraction of the runs to come that will have no outcome; where some of the runs that there are
                         have none, it is drawn by these
    correlation          of two runs on one bed, in the mean over studies; above 0

    Each run takes, with the probability of the root of the correlation, what its bed has in common. The correlation is
    drawn by an exponential law, and by how likely it makes the mean squares between and within beds of the runs that
    there are. Raises ValueError for numbers that cannot be.
    """
    finite_number("missing", missing, at_least=0.0, at_most=1.0)
    finite_number("correlation", correlation, above=0.0, at_most=1.0)
    known, to_come = answers("values", values), np.asarray(bed)
    beds = numbered_beds(np.concatenate([np.asarray(values_bed, dtype=float), to_come]), len(known) + len(to_come))
    whole_number("how many runs there are in all", len(beds), 1)
    if np.ptp(beds) == 0:
        return None
    random = np.random.default_rng(seed)
    study_count = min(max(MOST_RUNS // len(beds), FEWEST_STUDIES), STUDIES) if len(to_come) else 1
    weights = np.exp(-CORRELATIONS / correlation) * _likelihood(known, beds[: len(known)])
    correlations = random.choice(CORRELATIONS, study_count, p=weights / weights.sum())
    lost = int(np.isnan(known).sum())
    # Jeffreys' prior for a fraction.
    rates = random.beta(lost + 0.5, len(known) - lost + 0.5, study_count) if lost else np.full(study_count, missing)
    pairs = zip(rates.tolist(), correlations.tolist(), strict=True)
    widths = [_one(law, known, beds, rate, correlation, random) for rate, correlation in pairs]
    tail = 0.5 - 0.5 * LEVEL
    found = np.quantile([one for one in widths if one is not None] or [0.5], (tail, 0.5, 1.0 - tail))
    return HalfWidthRange(*found.tolist())


def _one(
    law: RunLaw, known: Array, beds: Labels, missing: float, correlation: float, random: np.random.Generator
) -> float | None:
    """Half width of a study that is made up; None where it has no interval."""
    new, bed_count = beds[len(known) :], int(beds.max()) + 1
    drawn = law(random, len(new) + bed_count)
    own, common = drawn[: len(new)], drawn[len(new) :]
    share = math.sqrt(correlation)
    # What runs on a bed have in common is what some run on it has shown, if that one took it.
    shown = random.permutation(np.flatnonzero(np.isfinite(known)))
    shown = shown[random.random(len(shown)) < share]
    common[beds[shown]] = known[shown]
    alike = random.random(len(new)) < share
    values = np.where(alike, common[new], own)
    values[random.random(len(new)) < missing] = np.nan
    bounds = plain_interval(np.concatenate([known, values]), beds)
    return None if bounds is None else 0.5 * (bounds[1] - bounds[0])


def _likelihood(known: Array, beds: Labels) -> Array:
    """How likely each of CORRELATIONS makes the mean squares of runs between and within beds; 1 where they say nothing.

    For normal scatter; the runs of beds count as equally many. Source: [Searle-1992], section 3.6.
    """
    values, bed = answered_runs(known, beds)
    if len(values) < 2 or np.ptp(values) == 0.0 or not 2 <= int(bed.max()) + 1 < len(values):
        return np.ones_like(CORRELATIONS)
    found = bed_components(values, bed)
    if found.within <= 0.0:
        return np.ones_like(CORRELATIONS)
    # Mean squares with these components are to each other as F times this.
    scale = 1.0 + float(found.counts.mean()) * CORRELATIONS / (1.0 - CORRELATIONS)
    density = stats.f.pdf(float(found.squares.mean()) / found.within / scale, len(found.squares), found.within_freedom)
    return density / scale


def half_width_of(values: ArrayLike, bed: ArrayLike) -> float | None:
    """Half the interval of the mean of values [run_count], each from 0 to 1, on beds [run_count] of any labels.

    Runs without an answer are NaN and left out: what they hide no number of runs narrows, and the interval of
    `share_estimate` adds it. None where the runs give no interval: no answer, or all on one bed.
    """
    known, beds = answered_runs(answers("values", values), bed)
    if len(known) == 0:
        return None
    return share_estimate(known, beds).share.half_width


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
    """Total number of runs of the next round; None if the requested half-width is reached.

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
