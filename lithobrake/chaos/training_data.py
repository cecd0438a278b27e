"""The data of a fit, checked once, and linear algebra on one thread."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.chaos.basis import checked_points, checked_weights, points_of
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.numerical_distributions import checked_inputs
from lithobrake.chaos.scores import equal_rows
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import LARGEST, numbers_or_nan, without_rounding


@dataclass(frozen=True)
class Training:
    """inputs by name; x [count, input_count] in physical units; y [count, output_count]; weights [count] or None.

    dropped_count: rows left out because all their outputs were NaN. one_dimensional: y was given as [count].
    """

    inputs: dict[str, Distribution]
    x: Array
    y: Array
    weights: Array | None
    output_names: list[str]
    one_dimensional: bool
    dropped_count: int

    @cached_property
    def groups(self) -> list[NDArray[np.int64]]:
        """Rows of equal inputs, where any occur more than once: left out together when an error is estimated.

        Leaving out one of several equal runs would only ask how well its twins predict it.
        """
        group = equal_rows(self.x)
        if group.max() == len(self.x) - 1:
            return []
        return np.split(np.argsort(group, kind="stable"), np.cumsum(np.bincount(group))[:-1])

    @property
    def count(self) -> int:
        return len(self.x)


def checked_training(
    inputs: Mapping[str, Distribution],
    x: ArrayLike,
    y: ArrayLike,
    *,
    output_names: Sequence[str] | None = None,
    weights: ArrayLike | None = None,
) -> Training:
    """Check the data of a fit. A row of y that is all NaN, or masked, is a missing run: dropped and counted.

    Raises ValueError for wrong shapes, points outside the support, any other non-finite value, wrong weights.
    """
    distributions = checked_inputs(inputs)
    points, outputs = points_of(distributions, x), numbers_or_nan("y", y)
    one_dimensional = outputs.ndim == 1
    table = outputs[:, None] if one_dimensional else outputs
    if table.ndim != 2 or len(table) != len(points) or table.shape[1] == 0:
        raise ValueError(f"y has shape {outputs.shape}, but must be [{len(points)}] or [{len(points)}, output_count]")
    # A run that failed has no output at all; a row with some of them is more likely an error in the data.
    missing: NDArray[np.bool_] = np.all(np.isnan(table), axis=1)
    kept, rows = table[~missing], points[~missing]
    if not np.all(np.isfinite(kept)):
        wrong = int((~np.isfinite(kept)).any(axis=1).sum())
        raise ValueError(
            f"{wrong} rows of y hold NaN or infinity in some outputs: a missing run must be NaN in all outputs, "
            "so set the whole row to NaN or leave it out"
        )
    # Before anything is squared: variances of larger numbers would overflow silently.
    check_magnitude("y", kept)
    if not len(kept):
        raise ValueError(f"none of the {len(points)} rows of y holds outputs: at least one run is needed")
    counted = None if weights is None else checked_weights(weights, len(points))[~missing]
    return Training(
        distributions,
        checked_points(distributions, rows),
        without_rounding(kept),
        None if counted is None else counted / counted.mean(),
        _names(output_names, kept.shape[1], one_dimensional),
        one_dimensional,
        int(missing.sum()),
    )


def check_magnitude(name: str, values: Array) -> None:
    """Refuse outputs [count, output_count] whose squares, or those of their spread, are no numbers."""
    most = float(np.abs(values).max(initial=0.0))
    if most > LARGEST:
        raise ValueError(f"{name} reaches {most:g} in size, but must stay within {LARGEST:g}: give it in a larger unit")
    spread = np.ptp(without_rounding(values), axis=0) if len(values) else np.zeros(1)
    if ((spread > 0.0) & (spread < 1.0 / LARGEST)).any():
        raise ValueError(
            f"{name} varies by {spread[spread > 0.0].min():g}, but must vary by at least {1.0 / LARGEST:g}, or not at "
            "all: give it in a smaller unit"
        )


def _names(output_names: Sequence[str] | None, count: int, one_dimensional: bool) -> list[str]:
    if output_names is None:
        return ["y"] if one_dimensional else [f"y{k}" for k in range(count)]
    names = [output_names] if isinstance(output_names, str) else [str(name) for name in output_names]
    if len(names) != count or len(set(names)) != count:
        raise ValueError(f"output_names is {names}, but must be {count} different names")
    return names


@cache
def _libraries() -> Any:
    """The linear algebra libraries of this process; to find them takes milliseconds, so they are found once."""
    # SciPy brings a library of its own, which must be loaded to be found.
    import scipy.linalg  # noqa: F401
    from threadpoolctl import ThreadpoolController  # type: ignore[import-untyped]

    return ThreadpoolController()


@contextmanager
def one_thread() -> Iterator[None]:
    """Hold the linear algebra libraries to one thread; what was set before comes back at the end.

    Several threads split a matrix product by their number, and so add its terms in another order.
    """
    with _libraries().limit(limits=1):
        yield
