"""Inputs as plain tables: what turns their values into polynomials, for programs in other languages."""

from collections.abc import Mapping

import numpy as np

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.basis import recurrences_of
from lithobrake.chaos.multi_index import Indices
from lithobrake.vocabulary.arrays import Array

# Equal steps of probability between which the quantiles of an input may be taken as straight.
QUANTILE_STEPS = 512


def input_tables(inputs: Mapping[str, Distribution], indices: Indices) -> dict[str, Array]:
    """is_log, germ_zero, germ_slope [input_count]; center, spread [input_count, degree], 0 beyond an input's own;
    germ_quantiles [input_count, step_count + 1] at equal steps of probability, an infinite end half a step inside.
    """
    recurrences = recurrences_of(inputs, indices)
    shape = len(inputs), max(one.degree for one in recurrences)
    tables = {"center": np.zeros(shape), "spread": np.ones(shape)}
    for k, one in enumerate(recurrences):
        tables["center"][k, : one.degree], tables["spread"][k, : one.degree] = one.center, one.spread
    is_log = np.array([entry.logarithmic for entry in inputs.values()])
    probability = np.linspace(0.0, 1.0, QUANTILE_STEPS + 1)
    zero, slope, quantiles = np.empty(len(inputs)), np.empty(len(inputs)), np.empty((len(inputs), len(probability)))
    for k, entry in enumerate(inputs.values()):
        half = 0.5 / QUANTILE_STEPS
        # The logarithm of zero is as far away as no limit.
        inside = [np.isfinite(end) and not (is_log[k] and end == 0.0) for end in entry.support]
        x = entry.ppf(np.clip(probability, 0.0 if inside[0] else half, 1.0 if inside[1] else 1.0 - half))
        quantiles[k] = entry.germ(x)
        low, high = np.log(x[[0, -1]]) if is_log[k] else x[[0, -1]]
        slope[k] = (quantiles[k, -1] - quantiles[k, 0]) / (high - low)
        zero[k] = 0.5 * (low + high) - 0.5 * (quantiles[k, 0] + quantiles[k, -1]) / slope[k]
    return {
        "is_log": is_log.astype(float), "germ_zero": zero, "germ_slope": slope, "germ_quantiles": quantiles, **tables,
    }  # fmt: skip
