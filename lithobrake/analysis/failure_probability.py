"""Probability that a landing meets a limit state, and which inputs make these landings."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import LEVEL, answered_runs, answers
from lithobrake.analysis.outcome_model import refit_interval
from lithobrake.analysis.share_estimate import share_estimate
from lithobrake.analysis.unseen_event import runs_by_bed, unseen_limit
from lithobrake.chaos.basis import checked_points
from lithobrake.chaos.design import sample_inputs
from lithobrake.chaos.distributions import Distribution
from lithobrake.emulator.model import Draws, Emulator
from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.given_numbers import numbers_or_nan, random_numbers, whole_number
from lithobrake.vocabulary.landing_fraction import LandingFraction

DRAW_COUNT = 400
# Of an event that is rarer (or whose opposite is) runs have met too few for the probability to be told from them alone.
RARE = 1.0 / 50.0
# What answers: the runs themselves, or draws of the emulator.
RUNS, EMULATOR = "runs", "emulator"


@dataclass(frozen=True)
class FailureInput:
    """Distribution of an input among failing landings, compared with its input distribution.

    distance        largest difference of the two distribution functions (Kolmogorov's), 0 to 1; its interval by drawing
                    the beds anew
    luck            distance that no input without effect passes, with probability LEVEL, all inputs together
    median, median_of_all   of the input among failing landings, and by its law, in its unit
    """

    distance: Estimate
    luck: float
    median: float
    median_of_all: float

    @property
    def found(self) -> bool:
        """Whether failing landings differ in this input by more than luck."""
        return self.distance.value > self.luck


def failure_inputs(
    inputs: Mapping[str, Distribution], x: ArrayLike, failing: ArrayLike, bed: ArrayLike, seed: int = 0
) -> dict[str, FailureInput]:
    """Compare each input among failing runs with its law.

    x [run_count, input_count] in physical units, drawn from the law of the inputs; failing [run_count], from 0 to 1, or
    NaN where nobody knows; bed [run_count]. Empty where no run fails. Beds are drawn with replacement, `DRAW_COUNT`
    times, and failures are dealt out anew to the runs as often to tell what luck alone does.
    Source: [Spear-1980] (distribution functions of failing and other points compared); [Field-2007] (groups drawn
    whole).
    """
    known = np.isfinite(answers("failing", failing))
    weights, beds = answered_runs(failing, bed)
    if not ((weights >= 0.0) & (weights <= 1.0)).all():
        raise ValueError("failing must lie between 0 and 1, or be NaN where nobody knows")
    points = checked_points(inputs, x)[known]
    if not weights.sum() > 0.0:
        return {}
    random = random_numbers(seed)
    # Luck deals out what the runs have: shares of flights, or ones and noughts.
    dealt = np.array([random.permutation(weights) for _ in range(DRAW_COUNT)])
    drawn = weights * _counts_of_beds(beds, random)[:, beds]
    drawn = drawn[drawn.sum(axis=1) > 0.0]
    columns = [OrderedInput.of(law, values) for law, values in zip(inputs.values(), points.T, strict=True)]
    luck = np.quantile(np.max([column.distance(dealt) for column in columns], axis=0), LEVEL)
    found = {}
    for (name, law), column in zip(inputs.items(), columns, strict=True):
        distance = float(column.distance(weights[None])[0])
        # Drawing anew adds the luck of the draw to a distance, which has no sign: what it adds is taken off.
        spread = column.distance(drawn) - max(float(np.mean(column.distance(drawn))) - distance, 0.0)
        lower, upper = np.quantile(spread, [0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL])
        bounds = max(min(float(lower), distance), 0.0), min(max(float(upper), distance), 1.0)
        found[name] = FailureInput(
            Estimate(distance, *bounds), float(luck), column.median(weights), float(law.median)
        )  # fmt: skip
    return found


@dataclass(frozen=True)
class OrderedInput:
    """One input of the runs: its values in order, their places among the runs, and its distribution function there."""

    values: Array
    order: np.ndarray
    law: Array

    @classmethod
    def of(cls, law: Distribution, values: Array) -> "OrderedInput":
        """The values of one input, by its law."""
        order = np.argsort(values, kind="stable")
        return cls(values[order], order, law.cdf(values[order]))

    def distance(self, weights: Array) -> Array:
        """Largest difference between the law and the runs, weighted [draw_count, run_count], shape [draw_count]."""
        steps = np.cumsum(weights[:, self.order], axis=1)
        steps /= steps[:, -1:]
        before = np.column_stack([np.zeros(len(steps)), steps[:, :-1]])
        return np.maximum(np.abs(steps - self.law), np.abs(before - self.law)).max(axis=1)

    def median(self, weights: Array) -> float:
        """Weighted median of the values."""
        steps = np.cumsum(weights[self.order])
        return float(self.values[np.searchsorted(steps, 0.5 * steps[-1])])


def _counts_of_beds(beds: np.ndarray, random: np.random.Generator) -> Array:
    """How often each bed comes when as many are drawn with replacement, [DRAW_COUNT, bed_count]."""
    count = int(beds.max()) + 1
    drawn = random.integers(count, size=(DRAW_COUNT, count))
    return np.array([np.bincount(one, minlength=count) for one in drawn], dtype=float)


@dataclass(frozen=True)
class FailureProbability:
    """Probability of a limit state over the input distributions, on beds that were not in the study.

    probability                 from the runs where it is at least a fiftieth away from 0 and 1, else from the emulator
    source                      "runs" or "emulator"
    by_runs                     what the runs say, whichever answers, with bounds for those without an outcome
    by_emulator                 what the emulator says; None where it was not asked, or cannot tell
    tail_limit                  the largest probability that an event may have which none of so many runs has met;
                                what an emulator has of rarer ones rests on the form of its scatter, so its interval
                                then reaches at least as far as that of the runs
    """

    probability: Estimate
    source: str
    by_runs: LandingFraction
    by_emulator: Estimate | None
    tail_limit: float


def failure_probability(
    failing: ArrayLike,
    bed: ArrayLike,
    *,
    terms: tuple[Array, Labels] | None = None,
    drawn: tuple[ArrayLike, ArrayLike] | None = None,
    like_missing: ArrayLike | None = None,
    why: str | None = None,
) -> FailureProbability:
    """Estimate the probability of a limit state from runs and from samples of an emulator fitted to them.

    failing [run_count]  whether each run meets it, or the share of its flights that do; NaN where nobody knows
    bed [run_count]      label of the bed of each run: the units of the interval
    terms                as in `share_estimate`, which is what the runs say
    drawn                how many draws of each refit of the emulator meet it, and how many were made, [refit_count]
                         each, as `drawn_failures` gives them; None: runs alone
    like_missing, why    as in `share_estimate`

    Raises ValueError as `share_estimate` and `refit_interval` do.
    """
    runs = share_estimate(failing, bed, terms=terms, like_missing=like_missing, why=why)
    beds = np.asarray(bed)[np.isfinite(numbers_or_nan("failing", failing))]
    limit = unseen_limit(beds)
    by_runs = FailureProbability(runs.share, RUNS, runs, None, limit)
    if drawn is None or runs.share.bounds is None:
        return by_runs
    emulator = refit_interval(*drawn, *runs_by_bed(beds))
    if RARE <= runs.share.value <= 1.0 - RARE:
        return replace(by_runs, by_emulator=emulator)
    # The emulator learnt nothing from the runs without an outcome: none of them may meet the limit state, or all.
    assert emulator.bounds is not None
    lower, upper = ((1.0 - runs.missing) * end for end in emulator.bounds)
    upper += runs.missing
    # A tail that is rarer than so many runs can show rests on the form of its scatter: it rules out no more than they.
    if emulator.value < limit:
        upper = max(upper, runs.share.bounds[1])
    if emulator.value > 1.0 - limit:
        lower = min(lower, runs.share.bounds[0])
    return FailureProbability(Estimate(emulator.value, lower, upper), EMULATOR, runs, emulator, limit)


def drawn_failures(
    model: Emulator,
    failing: Callable[[Draws], ArrayLike],
    *,
    refit_count: int = 50,
    sample_count: int = 100_000,
    seed: int = 0,
) -> tuple[Labels, Labels]:
    """Count draws that meet a limit state, refit by refit: how many do, and how many were made, [refit_count] each.

    failing: whether each of some draws does, [point_count, 1] or [point_count]; NaN where that is not known, which
    does not count. Inputs are drawn from their laws, one draw at each point.
    """
    whole_number("refit_count", refit_count, 1)
    points, met = -(-whole_number("sample_count", sample_count, 1) // refit_count), []
    for number, one in enumerate(model.refits(refit_count, seed)):
        own = int(np.random.SeedSequence([seed, number]).generate_state(1)[0])
        x = sample_inputs(model.runs.inputs, points, own)
        met.append(np.asarray(failing(one.draw(x, 1, own)), dtype=float).ravel())
    return drawn_counts(np.concatenate(met), np.repeat(np.arange(refit_count), points), refit_count)


def drawn_counts(met: ArrayLike, refit: ArrayLike, refit_count: int) -> tuple[Labels, Labels]:
    """Count draws by refit [refit_count]: those that meet a limit state, and all of which that is known.

    met [draw_count]: 1, 0, or NaN where nobody knows; refit [draw_count]: place of the refit that each is of.
    """
    found, of = numbers_or_nan("met", met), np.asarray(refit)
    known = np.isfinite(found)
    places = np.isin(of, range(refit_count)).all()
    if of.shape != found.shape or not places or not np.isin(found[known], (0.0, 1.0)).all():
        raise ValueError(
            f"met has shape {found.shape} and refit {of.shape}, but both must be [draw_count]: 1, 0 or NaN, and a "
            f"place from 0 to {refit_count - 1}"
        )
    counts = np.bincount(of[known], weights=found[known], minlength=refit_count)
    return counts.astype(np.int64), np.bincount(of[known], minlength=refit_count)
