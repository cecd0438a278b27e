"""Bands of longitude in which a share is reached."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Band:
    """From begin to end [deg], end at or above begin and at most 360 beyond it; both nan: no longitude at all."""

    begin: float
    end: float

    def __str__(self) -> str:
        if np.isnan(self.begin):
            return "none"
        if self.end - self.begin >= 360.0:
            return "all"
        return f"{self.begin % 360.0:.0f} to {self.end % 360.0:.0f}"

    def agrees(self, other: "Band", bar: float) -> bool:
        """Whether both ends lie within the bar [deg] of those of another band."""
        if np.isnan(self.begin) or self.end - self.begin >= 360.0:
            return False
        gaps = [abs((one + 180.0) % 360.0 - 180.0) for one in (self.begin - other.begin, self.end - other.end)]
        return max(gaps) <= bar


def band_of(longitudes: NDArray[np.float64], values: NDArray[np.float64], level: float) -> Band:
    """The band around the highest value in which values stay at or above a level; ends are interpolated.

    longitudes [deg]: evenly spaced around the circle, [count], with their values.
    """
    count, step = len(longitudes), 360.0 / len(longitudes)
    if values.max() < level:
        return Band(np.nan, np.nan)
    if values.min() >= level:
        return Band(0.0, 360.0)
    top = int(values.argmax())

    def reach(way: int) -> float:
        """Degrees from the top to where the level is crossed."""
        steps = next(k for k in range(1, count) if values[(top + way * k) % count] < level)
        inner, outer = values[(top + way * (steps - 1)) % count], values[(top + way * steps) % count]
        return step * (steps - 1 + float((inner - level) / (inner - outer)))

    place = float(longitudes[top])
    return Band(place - reach(-1), place + reach(1))
