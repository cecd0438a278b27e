"""What the rows of the experiments say: exponents, prefactor, times and shares, each with its 95 % interval.

And the rows of the table in which the page holds them against what was measured.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from quantities import NOT_SHOWN
from result_rows import Row
from scipy.stats import t as student
from sphere_bed import Floats

SHARE = 0.25  # of a measured value: the tolerance of prefactors, coefficients, times, depths, speeds and densities


@dataclass(frozen=True)
class Estimate:
    """A value with the half width of its 95 % interval, from so many rows."""

    value: float
    half: float
    rows: int


def mean_of(values: list[float]) -> Estimate:
    """Return the mean of independent values."""
    count = len(values)
    half = student.ppf(0.975, count - 1) * np.std(values, ddof=1) / math.sqrt(count) if count > 1 else math.nan
    return Estimate(float(np.mean(values)), float(half), count)


def powers(target: Floats, *factors: Floats) -> list[Estimate]:
    """Return the exponents of a product of powers fitted to positive values, by least squares of the logarithms."""
    columns = np.stack([np.ones(len(target)), *(np.log(factor) for factor in factors)], axis=1)
    solution, *_ = np.linalg.lstsq(columns, np.log(target), rcond=None)
    left = np.log(target) - columns @ solution
    free = len(target) - columns.shape[1]
    spread = np.linalg.inv(columns.T @ columns) * float(left @ left) / max(free, 1)
    width = student.ppf(0.975, free) if free > 0 else math.nan
    return [
        Estimate(float(value), float(width * math.sqrt(variance)), len(target))
        for value, variance in zip(solution[1:], np.diag(spread)[1:], strict=True)
    ]


def column(rows: list[Row], name: str) -> Floats:
    return np.array([row[name] for row in rows], dtype=np.float64)


def below_mean_surface(rows: list[Row]) -> Floats:
    """Depth [m] of the ball's lowest point below the mean surface."""
    return column(rows, "deepest")


def below_first_touch(rows: list[Row]) -> Floats:
    """Depth [m] below where the ball first touched a bead, above the mean surface by a part of a bead."""
    return column(rows, "deepest") + column(rows, "touch_height")


def total_drop(rows: list[Row]) -> Floats:
    """Way [m] from where the ball was let go to where it came deepest, the same from either surface."""
    return column(rows, "fall") + column(rows, "deepest")


def drop_exponents(rows: list[Row], depth: Floats) -> list[Estimate]:
    """Exponents of the density and of the total drop distance for depths [m] of these drops."""
    return powers(depth, column(rows, "density"), total_drop(rows))


def diameter_exponent(rows: list[Row], depth: Floats) -> Estimate:
    """Exponent of the diameter at one density and fall, that of the total drop distance held at 1/3."""
    return powers(depth / total_drop(rows) ** (1 / 3), column(rows, "diameter"))[0]


def density_exponent(light: Row, heavy: Row, depth_of: Callable[[list[Row]], Floats]) -> float:
    """Exponent of the density that two drops of one diameter give, that of the total drop distance held at 1/3."""
    pair = [light, heavy]
    low, high = depth_of(pair) / total_drop(pair) ** (1 / 3)
    return math.log(high / low) / math.log(heavy["density"] / light["density"])


def scale(rows: list[Row]) -> Floats:
    """(density of ball over bulk)^(1/2) D^(2/3) H^(1/3) [m] of each drop; depth over it is the prefactor."""
    ratio = column(rows, "density") / column(rows, "bulk_density")
    return np.sqrt(ratio) * column(rows, "diameter") ** (2 / 3) * total_drop(rows) ** (1 / 3)


def stopping(rows: list[Row]) -> list[float]:
    """Stopping time in units of depth over impact speed."""
    return list(column(rows, "stopping_time") * column(rows, "impact_speed") / column(rows, "deepest"))


def gravity_exponents(rows: list[Row]) -> dict[str, Estimate]:
    return {
        name: powers(column(rows, name), column(rows, "share"))[0]
        for name in ("depth", "stopping_time", "time_to_90")
    }  # fmt: skip


def leaving(rows: list[Row]) -> list[float]:
    """Speeds out over in of the grains that leave the bed upwards."""
    return [row["speed_ratio"] for row in rows if row["vertical_ratio"] > 0.0]


def speeds(rows: list[Row]) -> list[float]:
    """Speeds out over in of all grains, 0 where one stays or falls back at its last look."""
    return [row["speed_ratio"] if row["vertical_ratio"] > 0.0 else 0.0 for row in rows]


class Line(NamedTuple):
    """One quantity, as it was measured and as ours has it; cause: the row that shows why the two disagree."""

    quantity: str
    measured: str
    ours: str
    rows: int
    ratio: str
    agrees: bool
    cause: str = NOT_SHOWN
    tolerance: str = ""

    def cells(self) -> list[str]:
        cells = [self.quantity, self.measured, self.ours, str(self.rows), self.ratio, "yes" if self.agrees else "no"]
        return [*cells, "" if self.agrees else self.cause]


Lines = list[Line]


def said(estimate: Estimate) -> str:
    """Return a value with its interval, to a thousandth, or to three digits where it is 10 or more."""
    digits = max(0, 3 - len(f"{abs(estimate.value):.0f}")) if abs(estimate.value) >= 10.0 else 3
    value = f"{estimate.value:.{digits}f}"
    return f"{value} +- {estimate.half:.{digits}f}" if math.isfinite(estimate.half) else value


def line(
    quantity: str, measured: float, ours: Estimate, bar: float, text: str = "", cause: str = NOT_SHOWN
) -> Line:  # fmt: skip
    """Return a row of the table: it agrees where our value is within a bar of the measured one."""
    ratio = f"{ours.value / measured:.2f}" if measured else "-"
    agrees = abs(ours.value - measured) <= bar
    tolerance = f"{100.0 * bar / measured:.0f} %" if bar == SHARE * measured else f"{bar:g}"
    return Line(quantity, text or f"{measured:.3g}", said(ours), ours.rows, ratio, agrees, cause, tolerance)
