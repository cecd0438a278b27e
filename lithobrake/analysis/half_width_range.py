"""Between which half widths the interval of a study will lie, from studies of the same counts that are made up.

A study that is made up has the beds of the real one, runs by a law that says what is not known of them, and the
estimator of the real one: the rules for fractions near 0 and 1, for few beds and for runs without an outcome are in it.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.bed_components import bed_components
from lithobrake.analysis.confidence import LEVEL, answered_runs, answers, numbered_beds
from lithobrake.analysis.half_width import CORRELATION
from lithobrake.analysis.share_estimate import plain_interval
from lithobrake.vocabulary.arrays import Array, Labels
from lithobrake.vocabulary.given_numbers import finite_number, whole_number

# Correlations of two runs on one bed; before a study has runs they are as likely as by an exponential law.
CORRELATIONS = np.linspace(0.0, 0.5, 101)
STUDIES = 400
# Runs of studies that are made up, in all: larger studies are fewer, and scatter less.
MOST_RUNS, FEWEST_STUDIES = 1_000_000, 100


class RunLaw(Protocol):
    """What is known of the outcome of a run, 0 to 1, and what is not."""

    def study(self, random: np.random.Generator, count: int) -> Array:
        """Outcomes of so many independent runs of one study, whose own numbers are drawn first; [count]."""


@dataclass(frozen=True)
class AllOrNothing:
    """Each run is 0 or 1, as at rest or not; the fraction of 1 lies between two, more likely near the first.

    It is likeliest + (farthest - likeliest) u^2 with u uniform from 0 to 1.
    """

    likeliest: float
    farthest: float

    def study(self, random: np.random.Generator, count: int) -> Array:
        """As RunLaw has it."""
        share = self.likeliest + (self.farthest - self.likeliest) * random.random() ** 2
        return (random.random(count) < share).astype(float)


@dataclass(frozen=True)
class Shares:
    """Each run is a share of 0 to 1 by a beta law of this mean, whose standard deviation may be any between two."""

    mean: float
    smallest_spread: float
    largest_spread: float

    def study(self, random: np.random.Generator, count: int) -> Array:
        """As RunLaw has it."""
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

    def study(self, random: np.random.Generator, count: int) -> Array:
        """As RunLaw has it."""
        weights = random.standard_exponential(int(self.bed.max()) + 1)[self.bed]
        values = self.values
        if np.isin(values, (0.0, 1.0)).all():
            values = np.append(values, (0.0, 1.0))
            weights = np.append(weights, random.standard_gamma(0.5, 2))
        return random.choice(values, count, p=weights / weights.sum())


class HalfWidthRange(NamedTuple):
    """Half widths that a twentieth of the studies are below, half of them, and all but a twentieth; shares of 1."""

    lower: float
    median: float
    upper: float


def half_width_range(
    law: RunLaw, bed: ArrayLike, *, values: ArrayLike = (), values_bed: ArrayLike = (), missing: float = 0.0,
    correlation: float = CORRELATION, seed: int = 0,
) -> HalfWidthRange | None:  # fmt: skip
    """Range that holds the half width of the 90 % interval of nine in ten studies; None for one bed.

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
    drawn = law.study(random, len(new) + bed_count)
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
    from scipy import stats

    values, bed = answered_runs(known, beds)
    if len(values) < 2 or np.ptp(values) == 0.0 or not 2 <= int(bed.max()) + 1 < len(values):
        return np.ones_like(CORRELATIONS)
    found = bed_components(values, bed)
    if found.within <= 0.0:
        return np.ones_like(CORRELATIONS)
    # Mean squares with these components are to each other as F times this.
    scale = 1.0 + float(found.counts.mean()) * CORRELATIONS / (1.0 - CORRELATIONS)
    density = stats.f.pdf(float(found.squares.mean()) / found.within / scale, len(found.squares), found.within_freedom)
    likelihood: Array = density / scale
    return likelihood
