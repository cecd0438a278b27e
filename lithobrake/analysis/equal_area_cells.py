"""Cells of equal area that cover the sphere in bands of latitude, each nearly as wide as it is high."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.vocabulary.arrays import Array, Labels
from lithobrake.vocabulary.given_numbers import whole_number

FEWEST, MOST = 4, 20_000


@dataclass(frozen=True)
class EqualAreaCells:
    """Cells of one solid angle each, seen from the centre, numbered from the south and in each band from west to east.

    count   of the cells in each band, [band_count]
    edges   sines of the latitudes of the bands' borders, from -1 to 1, [band_count + 1]
    """

    count: Labels
    edges: Array

    @classmethod
    def of(cls, total: int) -> "EqualAreaCells":
        """So many cells, 4 to 20 000. Raises ValueError for another number."""
        number = whole_number("cells", total, FEWEST, MOST)
        bands = max(2, round(0.5 * math.sqrt(math.pi * number)))
        borders = np.sin(np.linspace(-0.5 * np.pi, 0.5 * np.pi, bands + 1))
        # Bands of equal height, moved until each holds a whole number of cells.
        below = np.rint(0.5 * number * (1.0 + borders)).astype(np.int64)
        kept = np.unique(below)
        return cls(np.diff(kept), 2.0 * kept / number - 1.0)

    @property
    def total(self) -> int:
        """How many cells there are."""
        return int(self.count.sum())

    @property
    def bounds_deg(self) -> Array:
        """South, north, west and east of each cell [deg], [cell_count, 4]; longitudes from -180 to 180."""
        latitude = np.degrees(np.arcsin(self.edges))
        parts = [
            np.column_stack([np.full(count, south), np.full(count, north), meridians[:-1], meridians[1:]])
            for count, south, north in zip(self.count.tolist(), latitude[:-1], latitude[1:], strict=True)
            for meridians in (np.linspace(-180.0, 180.0, count + 1),)
        ]
        return np.concatenate(parts)

    @property
    def centres_deg(self) -> Array:
        """Latitude and longitude of the middle of each cell [deg], [cell_count, 2]: half of its area on either side."""
        half = np.full((self.total, 1, 2), 0.5)
        # Without the rounding that leaves the equator and longitude 0 beside themselves.
        middles: Array = np.round(self.places_deg(half)[:, 0], 12) + 0.0
        return middles

    def places_deg(self, uniforms: ArrayLike) -> Array:
        """Latitude and longitude [deg], [cell_count, place_count, 2], of places spread evenly over each cell.

        uniforms: numbers from 0 to 1, [cell_count, place_count, 2], northward and eastward within the cell.
        """
        northward, eastward = np.moveaxis(np.asarray(uniforms, dtype=float), -1, 0)
        south, north = (np.repeat(ends, self.count)[:, None] for ends in (self.edges[:-1], self.edges[1:]))
        west, east = (self.bounds_deg[:, which, None] for which in (2, 3))
        latitude = np.degrees(np.arcsin(np.clip(south + northward * (north - south), -1.0, 1.0)))
        return np.stack([latitude, west + eastward * (east - west)], axis=-1)

    def cell_of(self, latitude_deg: ArrayLike, longitude_deg: ArrayLike) -> Labels:
        """Number of the cell in which each place lies, [count]; longitudes of any turn."""
        sine = np.sin(np.radians(np.asarray(latitude_deg, dtype=float)))
        band = np.clip(np.searchsorted(self.edges, sine, side="right") - 1, 0, len(self.count) - 1)
        turn = (np.asarray(longitude_deg, dtype=float) + 180.0) / 360.0 % 1.0
        column = np.minimum((turn * self.count[band]).astype(np.int64), self.count[band] - 1)
        first = np.concatenate([[0], np.cumsum(self.count)])
        found: Labels = first[band] + column
        return found
