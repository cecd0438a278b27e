"""Draws of the delivery that go together: by a Gaussian copula, from draws that do not."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.study.journey_sections import PLACE_KEYS, SURFACE_KEYS
from lithobrake.study.quantity import Uncertain

if TYPE_CHECKING:
    from lithobrake.chaos import GaussianCopula
    from lithobrake.study.study import Study


def correlated_keys(study: "Study") -> tuple[str, ...]:
    """The keys of [delivery] that are correlated with another, those of the place before all others."""
    pairs = () if study.delivery is None else study.delivery.correlations or ()
    named = {key for one, other, _ in pairs for key in (one, other)}
    return tuple(key for key in SURFACE_KEYS if key in named)


def copula_of(study: "Study", keys: tuple[str, ...]) -> "GaussianCopula":
    """The distribution of these keys together. Raises ValueError for correlations that contradict each other."""
    from lithobrake.chaos import GaussianCopula

    laws, matrix = {}, np.eye(len(keys))
    for key in keys:
        value = getattr(study.site if key in PLACE_KEYS else study.impact, key)
        assert isinstance(value, Uncertain)
        laws[key] = value.to_chaos()
    assert study.delivery is not None
    for one, other, correlation in study.delivery.correlations or ():
        if one in keys and other in keys:
            row, column = keys.index(one), keys.index(other)
            matrix[row, column] = matrix[column, row] = correlation
    return GaussianCopula(laws, matrix)


def drawn_together(study: "Study", columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Columns by key, each [count], of which those that are correlated go together; all else stays as it is.

    columns: independent draws. A key follows from those before it alone, so that the place of a lander is the same
    whether the rest of its arrival is asked for or not.
    """
    keys = tuple(key for key in correlated_keys(study) if key in columns)
    # One alone goes with nothing here.
    if len(keys) < 2:
        return dict(columns)
    table = np.column_stack([columns[key] for key in keys])
    return {**columns, **dict(zip(keys, copula_of(study, keys).dependent(table).T, strict=True))}
