"""Probability that a landing meets a limit state: from the runs, and where it is rare from an emulator of them.

A lander fails with some probability at every soil, so there is no surface between safe and failing soils: neither a
design point nor a learning function that looks for such a surface says anything here. What counts is the share of
landings, over beds that were not in the study.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import LEVEL, IntervalEstimate
from lithobrake.analysis.outcome_model import unseen_limit
from lithobrake.analysis.refit_interval import refit_interval
from lithobrake.analysis.share_estimate import ShareEstimate, share_estimate
from lithobrake.chaos.design import sample_inputs
from lithobrake.vocabulary.arrays import Array, Labels
from lithobrake.vocabulary.given_numbers import numbers_or_nan, whole_number

if TYPE_CHECKING:
    from lithobrake.emulator import Draws, Emulator

# Of an event that is rarer (or whose opposite is) runs have met too few for the probability to be told from them alone.
RARE = 1.0 / 50.0
# What answers: the runs themselves, or draws of the emulator.
RUNS, EMULATOR = "runs", "emulator"


@dataclass(frozen=True)
class FailureProbability:
    """Probability of a limit state over the law of the inputs, on beds that were not in the study.

    probability, lower, upper   from the runs where it is at least a fiftieth away from 0 and 1, else from the emulator;
                                bounds None where there is none, and `why` says why
    source                      "runs" or "emulator"
    by_runs                     what the runs say, whichever answers, with bounds for those without an outcome
    by_emulator                 what the emulator says; None where it was not asked, or cannot tell
    tail_limit                  the largest probability that an event may have which no run on so many beds has met;
                                what an emulator has of rarer ones rests on the form of its scatter, so its interval
                                then reaches at least as far as that of the runs
    """

    probability: float
    lower: float | None
    upper: float | None
    source: str
    by_runs: ShareEstimate
    by_emulator: IntervalEstimate | None
    tail_limit: float
    level: float = LEVEL

    @property
    def why(self) -> str | None:
        """Why there is no interval; None where there is one."""
        return self.by_runs.why


def failure_probability(
    failing: ArrayLike,
    bed: ArrayLike,
    *,
    terms: tuple[Array, Labels] | None = None,
    drawn: tuple[ArrayLike, ArrayLike] | None = None,
    like_missing: ArrayLike | None = None,
    why: str | None = None,
) -> FailureProbability:
    """Estimate the probability of a limit state from runs, and from draws of an emulator fitted to them.

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
    by_runs = FailureProbability(runs.share, runs.lower, runs.upper, RUNS, runs, None, limit)
    if drawn is None or runs.lower is None or runs.upper is None:
        return by_runs
    emulator = refit_interval(*drawn, len(np.unique(beds)))
    if RARE <= runs.share <= 1.0 - RARE:
        return replace(by_runs, by_emulator=emulator)
    # The emulator learnt nothing from the runs without an outcome: none of them may meet the limit state, or all.
    lower, upper = (1.0 - runs.missing) * emulator.lower, (1.0 - runs.missing) * emulator.upper + runs.missing
    # A tail that is rarer than so many beds can show rests on the form of its scatter: it rules out no more than they.
    if emulator.value < limit:
        upper = max(upper, runs.upper)
    if emulator.value > 1.0 - limit:
        lower = min(lower, runs.lower)
    return FailureProbability(emulator.value, lower, upper, EMULATOR, runs, emulator, limit)


def drawn_failures(
    model: "Emulator",
    failing: Callable[["Draws"], ArrayLike],
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
