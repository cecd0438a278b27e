"""What the landers say of MASCOT: where its time, contacts and path lie in the distributions of each setting."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from harness import Row, read_rows

from lithobrake.analysis.confidence import wilson_interval

HERE = Path(__file__).parent
# The criterion: each of the three in the central 80 %.
TAILS = (0.1, 0.9)
LEVEL = 1.645  # standard deviations: intervals hold with 90 %
MEASURED = {"time_s": 663.0, "contacts": 4.0, "path_m": 17.0}
# The same time as it was observed: until the lander stays within 0.1 m of where it comes to rest.
OBSERVED = {"settled_s": 663.0}
BOUNCING = 105.0 * 60.0  # s, the longest that was expected before the flight


@dataclass(frozen=True)
class Answer:
    """One quantity of one setting: quantiles 0.1, 0.5 and 0.9, and how many landers lie below what was measured."""

    low: float
    middle: float
    high: float
    below: float
    interval: tuple[float, float]
    agrees: bool

    @property
    def is_open(self) -> bool:
        """Whether more landers may change whether it agrees: a limit lies within the interval."""
        return any(self.interval[0] <= tail <= self.interval[1] for tail in TAILS)


def rows_of(setting: str, table: Path = HERE / "mascot.csv") -> list[Row]:
    return [row for row in read_rows(table, {"setting": str, "end": str}) if row["setting"] == setting]


def column(rows: list[Row], name: str) -> np.ndarray:
    return np.array([row[name] for row in rows])


def answer(values: np.ndarray, measured: float) -> Answer:
    """Hold a measured value against those of landers; half of the landers that have just it count as below."""
    low, middle, high = (float(value) for value in np.quantile(values, [TAILS[0], 0.5, TAILS[1]]))
    below = float(np.sum(values < measured) + 0.5 * np.sum(values == measured))
    interval = wilson_interval(round(below), len(values), LEVEL)
    return Answer(low, middle, high, below / len(values), interval, low <= measured <= high)


def farther(rows: list[Row]) -> float:
    """Part of the landers that are farther than MASCOT from the middle in all three together.

    By the distance of Mahalanobis in the logarithms of time, contacts and path.
    """
    values = np.log(np.stack([np.maximum(column(rows, name), 1e-3) for name in MEASURED], axis=1))
    inverse = np.linalg.inv(np.cov(values.T))
    away = np.vstack([values, np.log(list(MEASURED.values()))]) - values.mean(axis=0)
    squares = np.einsum("ij,jk,ik->i", away, inverse, away)
    return float(np.mean(squares[:-1] > squares[-1]))


def said(value: float) -> str:
    """A number to three digits, never in powers of ten."""
    return f"{value:.0f}" if abs(value) >= 100.0 else f"{value:.3g}"


def ratio(rows: list[Row]) -> np.ndarray:
    """Speed after over speed before the first contact, of those that left it."""
    values: np.ndarray = column(rows, "rebound_speed") / column(rows, "first_speed")
    return values[np.isfinite(values)]
