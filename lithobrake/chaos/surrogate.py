"""The fitted expansion: evaluate it, read its moments and indices, score it, keep it in a file."""

import os
import warnings
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.chaos import scores, sobol_indices, storage
from lithobrake.chaos.basis import Indices, outside_count, points_of
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.evaluation import EvaluationPlan, evaluate, make_plan
from lithobrake.chaos.numerical_distributions import checked_inputs
from lithobrake.chaos.sobol_indices import skewness_and_kurtosis
from lithobrake.chaos.training_data import one_thread
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import numbers

FORMAT = "lithobrake expansion"


class Surrogate:
    """A polynomial chaos expansion of one or several outputs; made by `fit` or `load`.

    inputs: name -> distribution, in column order; multi_indices [term_count, input_count]; coefficients of the
    orthonormal terms [term_count, output_count] ([term_count] for a one-dimensional y; as coefficient_table always with
    an axis of outputs); report: how it was fitted, plain JSON values; residuals of the training points
    [count, output_count], kept jointly over outputs.
    Source: [Landings-PCE], Eq 13; [Xiu-2002].
    """

    def __init__(
        self,
        inputs: Mapping[str, Distribution],
        multi_indices: Indices,
        coefficients: Array,
        *,
        output_names: Sequence[str],
        one_dimensional: bool,
        residuals: Array | None = None,
        report: dict[str, Any] | None = None,
    ) -> None:
        self.inputs = checked_inputs(inputs)
        self.multi_indices = multi_indices
        self.output_names = list(output_names)
        self.one_dimensional = one_dimensional
        self.residuals = np.zeros((0, len(self.output_names))) if residuals is None else residuals
        self.report = report or {}
        self.coefficient_table = coefficients

    @property
    def input_names(self) -> list[str]:
        """Names of the inputs in column order."""
        return list(self.inputs)

    @property
    def coefficients(self) -> Array:
        """Coefficients of the orthonormal terms [term_count, output_count], or [term_count]."""
        return self.coefficient_table[:, 0] if self.one_dimensional else self.coefficient_table

    @property
    def degree(self) -> int:
        """Highest total degree among the terms."""
        return int(self.multi_indices.sum(axis=1).max())

    @property
    def term_count(self) -> int:
        """Number of terms, the constant among them."""
        return len(self.multi_indices)

    @property
    def dropped_count(self) -> int:
        """Number of training rows that were all NaN (missing runs) and were left out."""
        return int(self.report.get("dropped_count", 0))

    @cached_property
    def _plan(self) -> EvaluationPlan:
        return make_plan(self.inputs, self.multi_indices, self.coefficient_table)

    def __call__(self, x: ArrayLike, *, outside: str = "raise") -> Array:
        """Evaluate at points x in physical units [count, input_count]; result [count, output_count] or [count].

        outside: "raise" refuses points outside the support of an input (ValueError); "warn" counts them in a
        warning and extrapolates. Values that are not finite are always refused.
        """
        points = self.checked_points(x, outside)
        return self.shaped(self.evaluated(points))

    @one_thread()
    def evaluated(self, points: Array) -> Array:
        """Values [count, output_count] at points [count, input_count] that have been checked."""
        return evaluate(self.inputs, self._plan, points)

    def checked_points(self, x: ArrayLike, outside: str = "raise") -> Array:
        """Points [count, input_count] after the checks that `__call__` describes."""
        if outside not in ("raise", "warn"):
            raise ValueError(f"outside is {outside!r}, but must be 'raise' or 'warn'")
        points = points_of(self.inputs, x)
        if not np.all(np.isfinite(points)):
            raise ValueError(f"{int((~np.isfinite(points)).any(axis=1).sum())} points of x are not finite: remove them")
        count, sentence = outside_count(self.inputs, points)
        if count:
            text = f"{count} of {len(points)} points are outside the support of the inputs (first: {sentence})"
            # Where an input enters by its logarithm there is nothing to extrapolate to at or below 0.
            undefined = any(
                entry.logarithmic and bool((points[:, k] <= 0.0).any()) for k, entry in enumerate(self.inputs.values())
            )
            if outside == "raise" or undefined:
                raise ValueError(f"{text}: an expansion does not extrapolate; leave them out, or pass outside='warn'")
            warnings.warn(f"{text}: values there are extrapolated", stacklevel=3)
        return points

    def shaped(self, values: Array) -> Any:
        """Drop the last axis (outputs) if y was one-dimensional."""
        if not self.one_dimensional:
            return values
        return float(values[0]) if values.ndim == 1 else values[..., 0]

    @property
    def mean(self) -> Any:
        """Mean of each output [output_count], or a number. Source: [Landings-PCE], Eq 18."""
        return self.shaped(sobol_indices.mean_of(self.multi_indices, self.coefficient_table))

    @property
    def variance(self) -> Any:
        """Variance of each output [output_count], or a number. Source: [Landings-PCE], Eq 21."""
        return self.shaped(sobol_indices.variance_of(self.multi_indices, self.coefficient_table))

    @cached_property
    def _shape_moments(self) -> tuple[Array, Array, bool]:
        return skewness_and_kurtosis(self.inputs, self.multi_indices, self.coefficient_table)

    @property
    def skewness(self) -> Any:
        """Skewness of each output [output_count], or a number; `shape_moments` says how, and whether exactly."""
        return self.shaped(self._shape_moments[0])

    @property
    def kurtosis(self) -> Any:
        """Kurtosis of each output (3 for a normal) [output_count], or a number; as for the skewness."""
        return self.shaped(self._shape_moments[1])

    @property
    def sobol_first(self) -> Array:
        """First-order Sobol indices [input_count, output_count] or [input_count]; 0 where nothing varies."""
        return self.shaped(sobol_indices.first_order(self.multi_indices, self.coefficient_table))

    @property
    def sobol_total(self) -> Array:
        """Total Sobol indices [input_count, output_count] or [input_count]; 0 where nothing varies."""
        return self.shaped(sobol_indices.total_order(self.multi_indices, self.coefficient_table))

    def sobol_group(self, names: Sequence[str]) -> Array:
        """Share of the variance in all terms of these inputs only, [output_count] or a number."""
        return self.shaped(sobol_indices.group_share(self.multi_indices, self.coefficient_table, self.columns(names)))

    def sobol_interaction(self, names: Sequence[str]) -> Array:
        """Sobol index of exactly this set of inputs (any order), [output_count] or a number."""
        return self.shaped(sobol_indices.interaction(self.multi_indices, self.coefficient_table, self.columns(names)))

    def columns(self, names: Sequence[str]) -> list[int]:
        """Column of each named input. Raises ValueError for an unknown name."""
        wanted = [names] if isinstance(names, str) else list(names)
        unknown = [name for name in wanted if name not in self.inputs]
        if unknown:
            raise ValueError(f"no input is named {', '.join(map(repr, unknown))}: there are {', '.join(self.inputs)}")
        return [self.input_names.index(name) for name in wanted]

    def score(self, x: ArrayLike, y: ArrayLike) -> dict[str, scores.Score]:
        """Scores at points x with known outputs y, by output name: mape, ape [%], q2, rrmse, rmse, std.

        Raises ValueError for NaN in y. Source: [Landings-PCE], Eq 24; `score_of` has the definitions.
        """
        truth, count = numbers("y", y), len(points_of(self.inputs, x))
        if truth.ndim == 1 and len(self.output_names) == 1:
            truth = truth[:, None]
        if truth.shape != (count, len(self.output_names)) or count == 0:
            raise ValueError(
                f"y has shape {truth.shape}, but must be [{count}, {len(self.output_names)}], one row for each of at "
                "least one point"
            )
        if not np.all(np.isfinite(truth)):
            raise ValueError("y holds values that are not finite: leave out the runs without outputs before scoring")
        predicted = np.asarray(self(x)).reshape(truth.shape)
        columns = enumerate(self.output_names)
        return {name: scores.score_of(predicted[:, k], truth[:, k]) for k, name in columns}

    def runs_needed(self, target: float) -> dict[str, dict[str, Any]]:
        """How many more runs would bring the expected error to `target` (in units of the spread), by output name."""
        return scores.runs_needed(self.report, target)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything into one readable JSON file."""
        storage.write(FORMAT, self.content(), path)

    def content(self) -> dict[str, Any]:
        """Everything that makes the expansion, as plain JSON values."""
        return {
            "inputs": storage.inputs_to_json(self.inputs),
            "output_names": self.output_names,
            "one_dimensional": self.one_dimensional,
            "multi_indices": self.multi_indices.tolist(),
            "coefficients": self.coefficient_table.tolist(),
            "report": self.report,
            "residuals": self.residuals.tolist(),
        }

    @classmethod
    def from_content(cls, content: Mapping[str, Any]) -> Self:
        """Make the expansion that `content` gave. Raises ValueError for content that is none."""
        inputs, names = storage.inputs_from_json(content["inputs"]), storage.names_from_json(content["output_names"])
        indices = storage.indices_from_json(content["multi_indices"], len(inputs))
        coefficients = storage.numbers_from_json("coefficients", content["coefficients"], len(names))
        if len(coefficients) != len(indices):
            raise ValueError(f"there are {len(coefficients)} coefficients for {len(indices)} multi_indices")
        one_dimensional, report = content["one_dimensional"], content["report"]
        if type(one_dimensional) is not bool or (one_dimensional and len(names) > 1) or not isinstance(report, dict):
            raise ValueError("one_dimensional must be true or false, true for one output only, and report a table")
        residuals = storage.numbers_from_json("residuals", content["residuals"], len(names))
        return cls(
            inputs,
            indices,
            coefficients,
            output_names=names,
            one_dimensional=one_dimensional,
            residuals=residuals,
            report=report,
        )


def load(path: str | os.PathLike[str]) -> Surrogate:
    """Read an expansion that `Surrogate.save` wrote. Raises ValueError if the file is of another kind or damaged."""
    return storage.read(FORMAT, Surrogate.from_content, path)
