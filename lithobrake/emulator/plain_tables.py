"""The law of emulators as plain tables: all that a draw is made of, for programs in other languages.

An input's germ is (g(x) - germ_zero) germ_slope, with g the logarithm where is_log and x itself elsewhere; its
polynomials follow from center and spread by their recurrence, and a term is the product of those of its degrees.
"""

from collections.abc import Sequence

import numpy as np

from lithobrake.chaos.basis import input_tables
from lithobrake.emulator.model import Emulator
from lithobrake.emulator.residual_rows import smoothing
from lithobrake.vocabulary.arrays import Array


def law_tables(models: Sequence[Emulator]) -> dict[str, Array]:
    """Tables of emulators that share runs and choices, as refits do; the first axis of a law's own is the emulator.

    multi_indices [term_count, input_count], without the constant; kernel_widths [input_count], infinite where nearness
    in an input does not count; row_inputs [row_count, input_count], standardised; location, log_scale, scale_limits,
    rows, row_weights and classes as in Law and OutcomeClasses; smoothing_size [model_count] and smoothing_root
    [model_count, coordinate_count, coordinate_count]; lower, upper [coordinate_count] of the first run, infinite where
    they bend no coordinate. Raises ValueError for no emulator.
    """
    if not models:
        raise ValueError("models are none, but must be at least one emulator: give those of refits")
    first, columns = models[0], list(models[0].runs.modelled)
    linear = first.terms.matrix(first.runs.x)[first.runs.has_outputs, : len(first.runs.inputs)]
    low, high = first.runs.bending(first.runs.lower, first.runs.upper)
    smooth = [smoothing(model.law.rows, model.law.weights) for model in models]
    return {
        **input_tables(first.runs.inputs, first.terms.indices),
        "multi_indices": first.terms.indices.astype(float),
        "kernel_widths": np.array(first.choices.widths),
        "row_inputs": linear,
        "location": np.stack([model.law.location for model in models]),
        "log_scale": np.stack([model.law.log_scale for model in models]),
        "scale_limits": np.stack([model.law.scale_limits for model in models]),
        "rows": np.stack([model.law.rows for model in models]),
        "row_weights": np.stack([model.law.weights for model in models]),
        "smoothing_size": np.array([size for size, _ in smooth]),
        "smoothing_root": np.stack([root for _, root in smooth]),
        "class_intercepts": np.stack([model.classes.intercepts for model in models]),
        "class_slopes": np.stack([model.classes.slopes for model in models]),
        "class_never": np.stack([model.classes.never for model in models]),
        "lower": low[0, columns],
        "upper": high[0, columns],
    }
