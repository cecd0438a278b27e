"""Moments and Sobol indices, read off the coefficients of an orthonormal expansion."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.multi_index import Indices
from lithobrake.vocabulary.arrays import Array


def _shares(indices: Indices, coefficients: Array, chosen: NDArray[np.bool_]) -> Array:
    """Share of the variance in groups of terms, chosen [group_count, term_count]; 0 where an output does not vary."""
    squares = coefficients**2 * _varying(indices)[:, None]
    variance = squares.sum(axis=0)
    shares = np.zeros((len(chosen), len(variance)))
    return np.divide(chosen.astype(float) @ squares, variance, out=shares, where=variance > 0)


def _varying(indices: Indices) -> NDArray[np.bool_]:
    return indices.sum(axis=1) > 0


def mean_of(indices: Indices, coefficients: Array) -> Array:
    """Mean of each output [output_count]: the constant term. Source: [Landings-PCE], Eq 18."""
    return coefficients[~_varying(indices)].sum(axis=0)


def variance_of(indices: Indices, coefficients: Array) -> Array:
    """Variance of each output [output_count]. Source: [Landings-PCE], Eq 21, with orthonormal polynomials."""
    return (coefficients[_varying(indices)] ** 2).sum(axis=0)


def first_order(indices: Indices, coefficients: Array) -> Array:
    """First-order Sobol indices [input_count, output_count]. Source: [Landings-PCE], Eq 23; [Sudret-2008]."""
    active = indices > 0
    return _shares(indices, coefficients, (active & (active.sum(axis=1) == 1)[:, None]).T)


def total_order(indices: Indices, coefficients: Array) -> Array:
    """Total Sobol indices [input_count, output_count]. Source: [Sudret-2008], Eq 36."""
    return _shares(indices, coefficients, (indices > 0).T)


def group_share(indices: Indices, coefficients: Array, members: Sequence[int]) -> Array:
    """Share of the variance in all terms of these inputs only (closed index), [output_count]. Source: [Sobol-2001]."""
    others = [k for k in range(indices.shape[1]) if k not in set(members)]
    inside = (indices[:, others].sum(axis=1) == 0) & _varying(indices)
    return _shares(indices, coefficients, inside[None, :])[0]


def interaction(indices: Indices, coefficients: Array, members: Sequence[int]) -> Array:
    """Sobol index of exactly this set of inputs, [output_count]. Source: [Sudret-2008], Eq 35."""
    wanted = np.isin(np.arange(indices.shape[1]), list(members))
    return _shares(indices, coefficients, ((indices > 0) == wanted).all(axis=1)[None, :])[0]
