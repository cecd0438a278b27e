"""Whether observed bounces are of what an emulator knows, and how many would say something of an input."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import logsumexp

from lithobrake.analysis.bayesian_inference import Bounds, Posterior, posterior_of
from lithobrake.analysis.posterior import Observation, completed_points
from lithobrake.chaos import sobol_sequence
from lithobrake.chaos.design import sample_inputs
from lithobrake.chaos.training_data import one_thread
from lithobrake.emulator.density import BedEffect, observed_density
from lithobrake.emulator.model import Emulator
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import random_numbers, whole_number

# Draws of what would be observed, beside what was.
REPLICATES = 400
# Points that stand for the law of the inputs: of the posterior, and of the prior.
POSTERIOR_POINTS, PRIOR_POINTS = 200, 2048
# Bounces at most that are looked at, and truths over which the outcome is averaged.
MOST_BOUNCES, TRUTHS = 128, 8
HALF = 0.5
# With fewer points of weight on any soil what is left of a standard deviation is not known, and not told.
FEWEST_EFFECTIVE = 30.0


def predictive_p_value(
    model: Emulator, posterior: Posterior, observation: Observation, *, bounds: Bounds | None = None, seed: int = 0
) -> float:
    """Posterior predictive p-value: probability of a bounce with a density as low as that of the observed one.

    A small one, below 0.05, says that the emulator, at no inputs that the prior allows, gives such bounces often: look
    for an error of the observation, or a thing that the model leaves out. observation: with outputs. bounds: as in
    `infer`. Raises ValueError for an observation without outputs.
    Source: [Gelman-2013], chapter 6 (posterior predictive checks; here of the density).
    """
    if not observation.outputs:
        raise ValueError("the observation has no outputs; give one that has, as an outcome alone is never surprising")
    random, names = random_numbers(seed), list(observation.outputs)
    sample = dict(zip(posterior.inputs, posterior.sample(POSTERIOR_POINTS, seed).T, strict=True))
    x = completed_points(model.runs.inputs, {**sample, **observation.known}, POSTERIOR_POINTS, seed)
    low, high = bounds(x) if bounds else (None, None)
    drawn = model.draw(x, max(1, REPLICATES // POSTERIOR_POINTS) * 2, seed, lower=low, upper=high)
    columns = [model.output_names.index(name) for name in names]
    y = drawn.y[:, :, columns].reshape(-1, len(names))
    y = y[np.isfinite(y).all(axis=1)][:REPLICATES]
    # What is seen has the error of the observation on top.
    y = y + random.standard_normal(y.shape) * [observation.errors.get(name, 0.0) for name in names]

    def told(values: Sequence[float]) -> float:
        seen = dict(zip(names, values, strict=True))
        found = model.log_density(seen, x, errors=observation.errors, lower=low, upper=high)
        return float(logsumexp(found))

    observed = told(list(observation.outputs.values()))
    return float(np.mean([told(one) <= observed for one in y.tolist()]))


@dataclass(frozen=True)
class Identifiability:
    """Expected reduction of an input's standard deviation by observed bounces on one soil.

    sd_ratio    standard deviation after over before, by number of bounces, as far as the points of the prior can tell
    bounces     how many halve it; None where none of these do
    """

    sd_ratio: dict[int, float]
    bounces: float | None


def identifiability(
    model: Emulator,
    outputs: Collection[str],
    *,
    errors: dict[str, float] | None = None,
    own: Collection[str] = (),
    bounds: Bounds | None = None,
    truths: int = TRUTHS,
    seed: int = 0,
) -> dict[str, Identifiability]:
    """Compute how many observed bounces would halve the standard deviation of each input.

    outputs: that would be observed of each bounce, with errors (standard deviations, by name). Soils are drawn from
    the prior, up to 128 bounces on each from the emulator, and the root mean square of what is left of the standard
    deviation is averaged over soils. own, bounds: as in `infer`. The emulator is taken as exact, so the real number is
    larger.
    """
    inputs, random = model.runs.inputs, random_numbers(seed)
    whole_number("truths", truths, 1)
    modelled = [model.output_names[column] for column in model.runs.modelled]
    if isinstance(outputs, str) or not set(outputs) <= set(modelled):
        raise ValueError(f"outputs are {outputs!r}; allowed: some of {', '.join(modelled)}")
    counts = [1 << power for power in range(MOST_BOUNCES.bit_length())]
    shared = {name: law for name, law in inputs.items() if name not in own}
    points = sobol_sequence(shared, PRIOR_POINTS, seed=seed)
    squares, fewest = {name: np.zeros(len(counts)) for name in shared}, np.full(len(counts), np.inf)
    for number, truth in enumerate(sample_inputs(shared, truths, seed)):
        likelihoods = _likelihoods(model, truth, points, outputs, errors or {}, own, bounds, seed + number, random)
        for place, count in enumerate(counts):
            found = posterior_of(shared, points, likelihoods[:count].sum(axis=0))
            fewest[place] = min(fewest[place], found.effective_count)
            for name, one in found.learnt().items():
                squares[name][place] += one.sd_ratio**2 / truths
    told = int(np.argmax([*(fewest < FEWEST_EFFECTIVE), True]))
    return {
        name: Identifiability(
            dict(zip(counts, np.sqrt(of[:told]).tolist(), strict=False)), _halving(counts, np.sqrt(of[:told]))
        )
        for name, of in squares.items()
    }


@one_thread()
def _likelihoods(
    model: Emulator,
    truth: Array,
    points: Array,
    outputs: Collection[str],
    errors: dict[str, float],
    own: Collection[str],
    bounds: Bounds | None,
    seed: int,
    random: np.random.Generator,
) -> Array:
    """Logarithms of the likelihoods of bounces on one soil at points of the prior, [MOST_BOUNCES, point_count]."""
    inputs, names = model.runs.inputs, list(outputs)

    def with_own(shared: Array, offset: int) -> Array:
        given = dict(zip((name for name in inputs if name not in own), shared.T, strict=True))
        return completed_points(inputs, given, len(shared), 7919 * seed + offset)

    def looked_at(offset: int) -> tuple[tuple[Array, Array], tuple[ArrayLike | None, ArrayLike | None]]:
        x = with_own(points, offset)
        return (x, model.terms.matrix(x)), bounds(x) if bounds else (None, None)

    at = with_own(np.tile(truth, (MOST_BOUNCES, 1)), 0)
    low, high = bounds(at) if bounds else (None, None)
    drawn = model.draw(at, 1, seed, lower=low, upper=high)
    found, alone = np.empty((MOST_BOUNCES, len(points))), BedEffect.none(len(model.runs.modelled))
    terms, ends = looked_at(1)
    for number in range(MOST_BOUNCES):
        # Bounces that draw nothing of their own are all looked at from the same points.
        if own and number:
            terms, ends = looked_at(1 + number)
        ended = int(drawn.outcome[number, 0])
        y = drawn.y[number, 0, [model.output_names.index(name) for name in names]]
        if ended == model.runs.output_outcome:
            blurred = y + random.standard_normal(len(names)) * [errors.get(name, 0.0) for name in names]
            seen = dict(zip(names, blurred.tolist(), strict=True))
            found[number] = observed_density(model, seen, terms, errors, None, ends, alone)[0]
        else:
            found[number] = observed_density(model, {}, terms, {}, model.outcome_names[ended], ends, alone)[0]
    return found


def _halving(counts: Sequence[int], ratio: Array) -> float | None:
    """At how many bounces a ratio that falls comes to a half; None where it does not."""
    below = np.flatnonzero(ratio <= HALF)
    if len(below) == 0:
        return None
    place = int(below[0])
    if place == 0:
        return float(counts[0])
    first, second = ratio[place - 1], ratio[place]
    # Straight between two counts on logarithmic scales, as a standard deviation falls with a power of their number.
    share = np.log(first / HALF) / np.log(first / second)
    return float(np.exp(np.log(counts[place - 1]) + share * np.log(counts[place] / counts[place - 1])))
