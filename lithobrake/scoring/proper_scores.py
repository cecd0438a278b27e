"""Proper scores of a predictive distribution, which is a weighted sample: lower is better, and the truth is best.

An observation has an error, so what is scored is the prediction of the measurement: every sampled value with that error
around it. A prediction that is sharper than the measurement is then not rewarded for it.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.normal_law import mean_distance

# Draws of the measurement error of a place, and their seed.
ERROR_DRAWS, SEED = 20, 0


@dataclass(frozen=True, eq=False)
class DistanceScore:
    """A score of distances: the mean distance to the observation less half of that between two sampled values.

    to_observed: shape [count]; within: shape [count, count]. Two sampled values are two different ones, so that the
    score of a small sample is in the mean that of the distribution it comes from (a fair score).
    Source: [Gneiting-2007], Equations 21 and 22; [Ferro-2014] for fair scores.
    """

    to_observed: Floats
    within: Floats

    def of(self, weights: ArrayLike | None = None) -> float:
        """The score for weights of the values, shape [count]; default: equal ones."""
        count = len(self.to_observed)
        share = np.ones(count) if weights is None else np.asarray(weights, dtype=np.float64)
        share = share / share.sum()
        own = share * share
        different = 1.0 - own.sum()
        if different <= 0.0:
            # One value alone has no other: what is left is the scatter of the measurement.
            return float(share @ self.to_observed - 0.5 * share @ self.within @ share)
        apart = (share @ self.within @ share - own @ np.diagonal(self.within)) / different
        return float(share @ self.to_observed - 0.5 * apart)


def crps(values: ArrayLike, observed: float, error: float = 0.0) -> DistanceScore:
    """Continuous ranked probability score, in the unit of the values; of one value alone, the distance to it.

    values: sample, shape [count]; observed: the measurement, with the standard deviation `error` of a normal law. Exact
    for the mixture of normal laws that the error makes of the sample.
    Source: [Gneiting-2007], Equation 21; for normal mixtures [Grimit-2006].
    """
    sample = np.asarray(values, dtype=np.float64)
    within = mean_distance(sample[:, None] - sample, math.sqrt(2.0) * error)
    return DistanceScore(mean_distance(sample - observed, error), within)


def energy_score(places: ArrayLike, observed: ArrayLike, error: float = 0.0) -> DistanceScore:
    """Energy score of predicted places [m]: the CRPS of vectors.

    places: sample, shape [count, 3]; observed: shape [3]; error: standard deviation of the measurement along each axis
    [m], by draws of a fixed seed.
    Source: [Gneiting-2007], Equation 22.
    """
    sample = np.asarray(places, dtype=np.float64)
    apart, between = sample - np.asarray(observed, dtype=np.float64), sample[:, None] - sample
    if error == 0.0:
        return DistanceScore(np.linalg.norm(apart, axis=-1), np.linalg.norm(between, axis=-1))
    noise = np.random.default_rng(SEED).normal(0.0, error, (ERROR_DRAWS, 3))
    to_observed, within = np.zeros(len(sample)), np.zeros((len(sample), len(sample)))
    # Either sign of each draw, so that the mean error is none.
    for one in np.concatenate([noise, -noise]):
        to_observed += np.linalg.norm(apart + one, axis=-1)
        within += np.linalg.norm(between + math.sqrt(2.0) * one, axis=-1)
    return DistanceScore(to_observed / (2 * ERROR_DRAWS), within / (2 * ERROR_DRAWS))


def log_score(hits: ArrayLike, kinds: int, weights: ArrayLike | None = None) -> float:
    """Minus the logarithm to base 2 of the probability of what was observed [bits].

    hits: for each sampled landing whether it ended so (0 to 1), shape [count]; kinds: of ends that there may be. The
    probability is the posterior mean with Jeffreys' prior, (n + 1/2) / (total + kinds / 2), since what no sample shows
    is not impossible; weighted landings count with their effective number.
    Source: [Gneiting-2007], Section 4.1.
    """
    values = np.asarray(hits, dtype=np.float64)
    share = np.ones(len(values)) if weights is None else np.asarray(weights, dtype=np.float64)
    count = effective_number(share)
    return -math.log2((count * float(share @ values) / share.sum() + 0.5) / (count + 0.5 * kinds))


def effective_number(weights: Floats) -> float:
    """So many landings of equal weight have a mean of as small a variance."""
    return float(weights.sum() ** 2 / (weights @ weights))


def probability_below(values: ArrayLike, observed: float, error: float, weights: ArrayLike) -> float:
    """Where an observation lies in its predictive distribution, from 0 to 1; ties count half.

    values, weights: shape [count]; error: standard deviation of the measurement.
    """
    apart, share = observed - np.asarray(values, dtype=np.float64), np.asarray(weights, dtype=np.float64)
    below = special.ndtr(apart / error) if error > 0.0 else np.where(apart == 0.0, 0.5, apart > 0.0)
    return float(share @ below / share.sum())
