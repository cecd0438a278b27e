"""From runs to a stochastic expansion: degree, latent variable and noise are those that foretell groups left out best.

Source: [Zhu-2023].
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.threads import one_thread
from lithobrake.emulator.distant_bounds import with_distant_bounds
from lithobrake.emulator.latent_likelihood import LatentProblem, problem_of
from lithobrake.emulator.latent_terms import LATENTS, LatentTerms, latent_terms
from lithobrake.emulator.scores import folds_of, mean_by_groups
from lithobrake.emulator.stochastic_expansion import StochasticExpansion
from lithobrake.emulator.terms import candidate_terms
from lithobrake.emulator.training import TrainingRuns, checked_runs
from lithobrake.vocabulary.arrays import Array
from lithobrake.vocabulary.given_numbers import whole_number

HIGHEST_DEGREE = 5
# With fewer runs to a term, likelihood would follow single runs: such degrees are not looked at.
RUNS_PER_TERM = 5
# Noise as shares of the scatter about the mean, from nearly all of it down to where single runs become peaks.
NOISE_SHARES = (0.95, 0.85, 0.7, 0.55, 0.4, 0.3, 0.2)
FOLDS = 5


@one_thread()
def fit_stochastic_expansion(
    inputs: Mapping[str, Distribution],
    x: ArrayLike,
    y: ArrayLike,
    *,
    groups: ArrayLike | None = None,
    lower: ArrayLike | None = None,
    upper: ArrayLike | None = None,
    degree: int | None = None,
    latent: str | None = None,
    output_name: str = "y",
) -> StochasticExpansion:
    """Fit the density of one output at given inputs to runs, drawn from the law of the inputs.

    x: [run_count, input_count] in physical units.
    y: [run_count]; NaN where a run has no output: the law is that of runs with one.
    groups, lower, upper: as in `fit`.
    degree: of the terms of the inputs, from 0, no inputs, to 5; None chooses by groups left out.
    latent: distribution of the latent variable, "normal" or "uniform"; None chooses likewise.
    Raises ValueError for shapes and values that do not fit together, too few runs, and an output without scatter.
    """
    if np.ndim(y) != 1 and np.shape(y)[1:] != (1,):
        raise ValueError(f"y has shape {np.shape(y)}, but must be [run_count]: fit one expansion for each output")
    if latent is not None and latent not in LATENTS:
        raise ValueError(f"latent is {latent!r}, but must be one of {', '.join(LATENTS)}, or None to choose")
    runs = checked_runs(inputs, x, y, groups, None, None, lower, upper, (), (output_name,))
    candidate = candidate_terms(runs.inputs)
    runs = with_distant_bounds(runs, candidate.indices, candidate.matrix(runs.x[runs.has_outputs]))
    weights, group = np.ones(len(runs.x)), runs.group[runs.has_outputs]
    tried = [_held_out(problem_of(runs, terms, weights), group) for terms in _candidates(runs, degree, latent)]
    chosen = _simplest(tried, group)
    shares = NOISE_SHARES[: chosen.share_count]
    noise, coefficients = list(problem_of(runs, chosen.terms, weights).path(shares))[-1]
    return StochasticExpansion(runs, chosen.terms, coefficients, noise, chosen.logarithm, weights)


@dataclass(frozen=True)
class _HeldOut:
    """Terms, how many shares of the noise are gone down for the best, and logarithm of the density of each run where
    its group is left out [run_count].
    """

    terms: LatentTerms
    share_count: int
    logarithms: Array

    @property
    def logarithm(self) -> float:
        """Their mean."""
        return float(self.logarithms.mean())


def _simplest(tried: list[_HeldOut], group: NDArray[np.int64]) -> _HeldOut:
    """Of those that the best does not beat by more than a standard error, the one of the fewest terms.

    Of many that are tried, the best is so by luck too.
    """
    best = max(tried, key=lambda one: one.logarithm)
    close = []
    for one in tried:
        gain, error = mean_by_groups(best.logarithms - one.logarithms, group)
        if gain <= error:
            close.append(one)
    fewest = min(len(one.terms.indices) for one in close)
    return max((one for one in close if len(one.terms.indices) == fewest), key=lambda one: one.logarithm)


def _candidates(runs: TrainingRuns, degree: int | None, latent: str | None) -> list[LatentTerms]:
    """Terms of all degrees and latent variables that may be chosen; raises ValueError for a degree of too many."""
    degrees = range(HIGHEST_DEGREE + 1) if degree is None else [whole_number("degree", degree, 0, HIGHEST_DEGREE)]
    latents = LATENTS if latent is None else (latent,)
    found = [latent_terms(runs.inputs, one, law) for one, law in product(degrees, latents)]
    # No inputs are always a candidate: that is the law to fall back on.
    kept = [one for one in found if one.degree == 0 or RUNS_PER_TERM * len(one.indices) <= len(runs.y)]
    if not kept:
        raise ValueError(
            f"degree is {degree}, which has {len(found[0].indices)} terms and needs {RUNS_PER_TERM} runs for each, but "
            f"{len(runs.y)} runs have an output: lower it, or make more runs"
        )
    return kept


def _held_out(problem: LatentProblem, group: NDArray[np.int64]) -> _HeldOut:
    """Follow the noise down until runs in groups left out are foretold worse than before."""
    fold = folds_of(group, FOLDS)
    tests = [fold == number for number in range(int(fold.max()) + 1)]
    best = _HeldOut(problem.terms, 0, np.full(len(group), -np.inf))
    # All folds go down together, so that what single runs make of a little noise need not be found.
    for count, steps in enumerate(zip(*(problem.of(~test).path(NOISE_SHARES) for test in tests), strict=True), 1):
        logarithms = np.empty(len(group))
        for test, (noise, coefficients) in zip(tests, steps, strict=True):
            logarithms[test] = problem.of(test).log_densities(coefficients, noise)[0]
        if logarithms.mean() <= best.logarithm:
            break
        best = _HeldOut(problem.terms, count, logarithms)
    return best
