"""What a public function was given, checked where it comes in: one sentence with the name, the value and the range."""

import math
from numbers import Real
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

# Squares of larger numbers, and sums of these, are infinite.
LARGEST = 1e100
# Values that differ by less than this part of their size are one value: sums added in another order differ by that.
ROUNDING = 1e-14
# Numbers of one array that are made for a caller: of 8 bytes each, so 8.6 GB.
MOST_NUMBERS = 2**30


def whole_number(name: str, value: object, at_least: int, at_most: int | None = None) -> int:
    """Check a whole number and give it back; raises ValueError for anything else, with its name and range."""
    whole = isinstance(value, Real) and not isinstance(value, bool) and value % 1 == 0
    if not whole or value < at_least or (at_most is not None and value > at_most):  # type: ignore[operator]
        allowed = f"of at least {at_least}" if at_most is None else f"from {at_least} to {at_most}"
        raise ValueError(f"{name} is {value!r}, but must be a whole number {allowed}")
    return int(value)  # type: ignore[call-overload]


def sample_count(name: str, value: object, numbers_each: int, at_least: int = 1) -> int:
    """Check how many samples are asked for, of so many numbers each; raises ValueError for more than memory holds."""
    return whole_number(name, value, at_least, MOST_NUMBERS // max(numbers_each, 1))


def finite_number(
    name: str,
    value: object,
    *,
    above: float | None = None,
    at_least: float | None = None,
    below: float | None = None,
    at_most: float | None = None,
) -> float:
    """Check a number and give it back; raises ValueError for anything else, with its name and range.

    above, below: limits that it may not reach; at_least, at_most: limits that it may.
    """
    # Squares of larger numbers would be infinite; a whole number beyond all floats would overflow.
    # A number of NumPy would take the limit into its own precision.
    plain = value.item() if isinstance(value, Real) and hasattr(value, "item") else value
    real = isinstance(value, Real) and not isinstance(value, bool) and bool(abs(plain) <= LARGEST)  # type: ignore[arg-type]
    number = float(plain) if real else math.nan  # type: ignore[arg-type]
    low_enough = (below is None or number < below) and (at_most is None or number <= at_most)
    high_enough = (above is None or number > above) and (at_least is None or number >= at_least)
    if not (math.isfinite(number) and low_enough and high_enough):
        named = {"above": above, "of at least": at_least, "below": below, "of at most": at_most}
        ends = [f"{word} {limit:g}" for word, limit in named.items() if limit is not None]
        if below is None and at_most is None and isinstance(plain, int | float) and LARGEST < abs(plain) < math.inf:
            ends.append(f"of at most {LARGEST:g} in size")
        raise ValueError(f"{name} is {value!r}, but must be a finite number{' ' if ends else ''}{' and '.join(ends)}")
    return number


def random_numbers(seed: object) -> "np.random.Generator":
    """A stream of random numbers, the same for the same seed; raises ValueError for what is no whole number from 0."""
    import numpy as np

    return np.random.default_rng(whole_number("seed", seed, 0))


def numbers(name: str, values: "ArrayLike") -> "NDArray[np.float64]":
    """An array of floats of any shape; raises ValueError for what is no number, and for masked values."""
    import numpy as np

    array, masked = _floats(name, values)
    if np.any(masked):
        raise ValueError(
            f"{name} has {int(np.sum(masked))} masked values, but must hold a number everywhere: leave these rows out"
        )
    return array


def numbers_or_nan(name: str, values: "ArrayLike") -> "NDArray[np.float64]":
    """An array of floats of any shape, NaN where a value is masked; raises ValueError for what is no number."""
    import numpy as np

    array, masked = _floats(name, values)
    return np.where(masked, np.nan, array) if np.any(masked) else array


def without_rounding(values: "NDArray[np.float64]") -> "NDArray[np.float64]":
    """Outputs [run_count] or [run_count, output_count], NaN where a run has none; one that varies by rounding is one.

    The rule knows no unit: an output varies if its values differ by more than `ROUNDING` times the largest of them.
    """
    import numpy as np

    if not len(values):
        return values
    least, most = np.fmin.reduce(values, axis=0), np.fmax.reduce(values, axis=0)
    alike = most - least <= ROUNDING * np.maximum(np.abs(least), np.abs(most))
    return np.where(alike & np.isfinite(values), least, values)


def labels(name: str, values: "ArrayLike", count: int, of_what: str) -> "NDArray[Any]":
    """Labels [count] of any kind, one for each run or point; raises ValueError for another shape, NaN and masks."""
    import numpy as np

    array = np.asanyarray(values)
    if array.shape != (count,):
        raise ValueError(f"{name} has shape {array.shape}, but must be [{count}]: one label for {of_what}")
    given = np.asarray(array)
    if given.dtype.kind == "O":
        # Labels of several kinds, or none, have no order.
        try:
            given.argsort()
        except TypeError as error:
            raise ValueError(f"{name} hold labels that cannot be told apart ({error}): number them") from None
    nothing = ~np.isfinite(given) if given.dtype.kind == "f" else np.zeros(count, dtype=bool)
    if (nothing | np.ma.getmaskarray(array)).any():
        raise ValueError(
            f"{name} hold NaN or infinity, or are masked, but must be one label for {of_what}: number them"
        )
    return given


def _floats(name: str, values: Any) -> "tuple[NDArray[np.float64], Any]":
    """Floats of an array, and which of them are masked: booleans of the same shape, or False."""
    import numpy as np

    try:
        array = np.asanyarray(values)
        # NumPy drops the imaginary part, and takes a date for a count of days.
        if array.dtype.kind in "cmM":
            raise TypeError(f"{array.dtype} is no kind of real number")
        return np.asarray(array, dtype=float), np.ma.getmask(array)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} must be an array of real numbers ({error})") from None
