"""The law of emulators as plain tables: all that a draw is made of, for programs in other languages.

An input's germ is (g(x) - germ_zero) germ_slope, with g the logarithm where is_log and x itself elsewhere; its
polynomials follow from center and spread by their recurrence, and a term is the product of those of its degrees.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.basis import recurrences_of
from lithobrake.chaos.multi_index import Indices
from lithobrake.chaos.polynomials import Array
from lithobrake.emulator.model import Emulator
from lithobrake.emulator.residual_rows import smoothing

# Equal steps of probability between which the quantiles of an input may be taken as straight.
QUANTILE_STEPS = 512


def law_tables(models: Sequence[Emulator]) -> dict[str, Array]:
    """Tables of emulators that share runs and choices, as refits do; the first axis of a law's own is the emulator.

    multi_indices [term_count, input_count], without the constant; bandwidth, infinite where rows are drawn alike;
    row_inputs [row_count, input_count], standardised; location, log_scale, rows, row_weights and classes as in Law and
    OutcomeClasses; smoothing_size [model_count] and smoothing_root [model_count, coordinate_count, coordinate_count];
    lower, upper [coordinate_count] of the first run.
    """
    first, columns = models[0], list(models[0].runs.modelled)
    linear = first.terms.matrix(first.runs.x)[first.runs.has_outputs, : len(first.runs.inputs)]
    smooth = [smoothing(model.law.rows, model.law.weights) for model in models]
    return {
        **_input_tables(first.runs.inputs, first.terms.indices),
        "multi_indices": first.terms.indices.astype(float),
        "bandwidth": np.array([first.choices.bandwidth]),
        "row_inputs": linear,
        "location": np.stack([model.law.location for model in models]),
        "log_scale": np.stack([model.law.log_scale for model in models]),
        "rows": np.stack([model.law.rows for model in models]),
        "row_weights": np.stack([model.law.weights for model in models]),
        "smoothing_size": np.array([size for size, _ in smooth]),
        "smoothing_root": np.stack([root for _, root in smooth]),
        "class_intercepts": np.stack([model.classes.intercepts for model in models]),
        "class_slopes": np.stack([model.classes.slopes for model in models]),
        "class_never": np.stack([model.classes.never for model in models]),
        "lower": first.runs.lower[0, columns],
        "upper": first.runs.upper[0, columns],
    }


def _input_tables(inputs: Mapping[str, Distribution], indices: Indices) -> dict[str, Array]:
    """is_log, germ_zero, germ_slope [input_count]; center, spread [input_count, degree], 0 beyond an input's own;
    germ_quantiles [input_count, step_count + 1] at equal steps of probability, an infinite end half a step inside.
    """
    recurrences = recurrences_of(inputs, indices)
    shape = len(inputs), max(one.degree for one in recurrences)
    tables = {"center": np.zeros(shape), "spread": np.ones(shape)}
    for k, one in enumerate(recurrences):
        tables["center"][k, : one.degree], tables["spread"][k, : one.degree] = one.center, one.spread
    is_log = np.array([entry.kind in ("log_uniform", "log_normal") for entry in inputs.values()])
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
