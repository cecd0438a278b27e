"""Runs of which it is not known what became of them: what an estimate may be, whatever they did.

One rule for all estimates ([Manski-2003]): each is made twice, with every missing run at one end of what it may have
and at the other. Its interval reaches from the one to the other, and beyond both by a sampling error that holds each
value between at the level (`partial_quantile`, [Imbens-2004]). An end that nothing limits is None, with the reason.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import numbers, numbers_or_nan
from lithobrake.vocabulary.number_words import counted, percent

# Least and most that a run may have of an output.
Limits = tuple[ArrayLike, ArrayLike]


def lost_runs(missing: ArrayLike | None, values: ArrayLike) -> NDArray[np.bool_]:
    """Whether it is not known what became of each run [run_count]; None: nothing is missing.

    Raises ValueError for another shape than that of the values, and for a missing run that has one.
    """
    known = np.isfinite(numbers_or_nan("values", values))
    if missing is None:
        return np.zeros(known.shape, dtype=bool)
    given = numbers("missing", missing)
    if given.shape != known.shape or not np.isin(given, (0.0, 1.0)).all() or (known & (given == 1.0)).any():
        raise ValueError(
            f"missing has shape {given.shape} and values {known.shape}; give true or false for each run, and true only "
            "for a run without a value"
        )
    lost: NDArray[np.bool_] = given == 1.0
    return lost


def filled(values: Array, lost: NDArray[np.bool_], limits: Limits) -> tuple[Array, Array]:
    """Values [run_count] with the least, and with the most, that each lost run may have."""
    least, most = (
        np.where(lost, np.broadcast_to(numbers_or_nan("limits", end), values.shape), values) for end in limits
    )
    return least, most


def none_bounds(lost: NDArray[np.bool_], what: str) -> str:
    """Why nothing bounds a number on one side, in a sentence."""
    return f"{_who(lost)}, and nothing limits what they would add to {what}"


def open_end(lost: NDArray[np.bool_], beyond: str | None) -> str | None:
    """Why an end lies beyond all values, with the missing runs that may lie there; None where none does."""
    return f"{beyond}; {_who(lost)}" if beyond and lost.any() else beyond


def _who(lost: NDArray[np.bool_]) -> str:
    count = int(lost.sum())
    return f"{counted(count, 'run')} of {len(lost)} ({percent(count / len(lost), 1)}) have no outcome"
