"""The chance that a touchdown ends in capture, learnt from runs of which some were captured."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution

# Points whose probability is worked out at once: bounds the memory of the polynomial features.
_BLOCK = 65_536


class CaptureModel:
    """Logistic regression on a quadratic in the inputs, each put on the scale of its distribution.

    The penalty of the regression keeps it finite when few runs, or all on one side of a plane, were captured. Where no
    run or every run was captured there is nothing to learn, and the probability is 0 or 1 everywhere.
    """

    def __init__(self, inputs: Mapping[str, "Distribution"], x: np.ndarray, captured: np.ndarray) -> None:
        """Learn from runs: x [run_count, input_count] in physical units, captured [run_count] true or false."""
        if len(x) != len(captured) or len(x) == 0:
            raise ValueError(
                f"{len(x)} points and {len(captured)} outcomes; give one outcome for each of at least one run"
            )
        self._inputs = dict(inputs)
        self._constant = float(np.mean(captured)) if np.all(captured) or not np.any(captured) else None
        if self._constant is None:
            from sklearn.linear_model import LogisticRegression
            from sklearn.pipeline import make_pipeline
            from sklearn.preprocessing import PolynomialFeatures

            self._regression = make_pipeline(
                PolynomialFeatures(2, include_bias=False), LogisticRegression(max_iter=10_000)
            )
            self._regression.fit(self._scaled(x), np.asarray(captured, dtype=bool))

    def probability(self, x: np.ndarray) -> np.ndarray:
        """Probability of capture at x [point_count, input_count], in physical units; shape [point_count]."""
        if self._constant is not None:
            return np.full(len(x), self._constant)
        blocks = [x[start : start + _BLOCK] for start in range(0, len(x), _BLOCK)]
        return np.concatenate([self._regression.predict_proba(self._scaled(block))[:, 1] for block in blocks])

    def _scaled(self, x: np.ndarray) -> np.ndarray:
        columns = [distribution.germ(x[:, index]) for index, distribution in enumerate(self._inputs.values())]
        return np.column_stack(columns)
