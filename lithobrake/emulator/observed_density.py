"""Density of an observed run by an emulator, alone or beside others on its bed."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.emulator.bed_effect import BedEffect
from lithobrake.emulator.coordinates import with_slope
from lithobrake.emulator.density import DENSITY_FACTOR, Kernels
from lithobrake.emulator.residual_rows import log_row_weights, smoothing
from lithobrake.emulator.storage import Parts
from lithobrake.vocabulary.arrays import Array
from lithobrake.vocabulary.given_numbers import finite_number

# Of an observation: the squares of larger ones overflow, and these say nothing either.
LARGEST_ERROR = 1e100


def kernels_of(model: Parts) -> Kernels:
    """The kernels about the residual rows whose sum is the density of an observed run."""
    return Kernels.of(model.law.rows, *smoothing(model.law.rows, model.law.weights, DENSITY_FACTOR))


def observed_density(
    model: Parts,
    observed: Mapping[str, float],
    matrix: Array,
    errors: Mapping[str, float],
    outcome: str | None,
    bounds: tuple[ArrayLike | None, ArrayLike | None],
    bed: BedEffect,
) -> tuple[Array, BedEffect]:
    """Logarithm of the density of an observed run at terms [point_count, term_count], and what it says of its bed.

    observed, errors, outcome, bounds (lower and upper): as in `Emulator.log_density`. bed: its effect as far as other
    runs show it. An outcome without outputs has its chance alone, and says nothing of the bed.
    """
    linear = matrix[:, : len(model.runs.inputs)]
    ended = _checked_outcome(model, observed, errors, outcome)
    chance = np.log(np.maximum(model.classes.chances(matrix)[:, ended], np.finfo(float).tiny))
    if not observed:
        return chance, bed
    low, high = model.runs.bounds_at(*bounds, len(matrix))
    columns = [model.runs.output_names.index(name) for name in observed]
    y = np.broadcast_to(list(observed.values()), (len(matrix), len(columns)))
    possible = np.all((y > low[:, columns]) & (y < high[:, columns]), axis=1)
    bent_low, bent_high = model.runs.bending(low, high)
    coordinate, slope = with_slope(y, bent_low[:, columns], bent_high[:, columns])
    places = [model.runs.modelled.index(column) for column in columns]
    location, scale = (one[:, places] for one in model.law.at(matrix))
    # What lies beyond a bound at some point cannot have come from there.
    inside = possible & np.all(np.isfinite(coordinate), axis=1)
    kernels = kernels_of(model)
    standard = (np.where(inside[:, None], coordinate, 0.0) - location) / scale
    blur = slope * [errors.get(name, 0.0) for name in observed] / scale
    left = standard - bed.mean @ kernels.root[places].T
    chances = log_row_weights(linear, model.row_points, model.law.weights, model.choices.widths)
    found = kernels.log_density(places, left, blur, chances, bed.spread)
    steepness = np.log(np.where(inside[:, None], slope, 1.0)).sum(axis=1) - np.log(scale).sum(axis=1)
    density: Array = np.where(inside, chance + found + steepness, -np.inf)
    return density, bed.given(kernels.root, places, left, blur)


def _checked_outcome(
    model: Parts, observed: Mapping[str, float], errors: Mapping[str, float], outcome: str | None
) -> int:
    """Place of the outcome of an observation. Raises ValueError for names and values that cannot be."""
    modelled = [model.runs.output_names[column] for column in model.runs.modelled]
    if not (isinstance(observed, Mapping) and isinstance(errors, Mapping)):
        raise ValueError(f"outputs and errors must be dicts by name; outputs that may be observed: {modelled}")
    for name, value in observed.items():
        if name not in modelled:
            raise ValueError(f"{name} is observed as {value}; allowed: finite numbers of {', '.join(modelled)}")
        finite_number(f"observed {name}", value)
    for name, error in errors.items():
        if name not in observed:
            raise ValueError(f"the error of {name} is {error}; allowed: 0 or more, of what was observed")
        finite_number(f"the error of {name}", error, at_least=0.0, at_most=LARGEST_ERROR)
    if outcome is None:
        return model.runs.output_outcome
    if outcome not in model.runs.outcome_names:
        raise ValueError(f"outcome is {outcome!r}; allowed: {', '.join(model.runs.outcome_names)}")
    ended = model.runs.outcome_names.index(outcome)
    if observed and ended != model.runs.output_outcome:
        raise ValueError(f"outcome is {outcome!r}, which has no outputs: leave {', '.join(observed)} out")
    return ended
