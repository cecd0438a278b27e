"""The ground about a place laid flat without a change of area: a local panel in metres, or both halves of the body."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# Lines of the graticule: so many points each, and round steps between them [deg].
LINE_POINTS = 361
STEPS_DEG = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0)
# A panel has about so many lines of each kind.
LINES = 4.0


@dataclass(frozen=True)
class GroundMap:
    """Lambert's azimuthal map of a sphere about a place: latitude and longitude [deg] of it, and the radius [m].

    Source: [Snyder-1987], chapter 24.
    """

    latitude: float
    longitude: float
    radius: float

    @property
    def edge(self) -> float:
        """How far from the middle the half of the sphere around it reaches on the map [m]."""
        return float(np.sqrt(2.0)) * self.radius

    @property
    def opposite(self) -> "GroundMap":
        """The map about the place on the other side."""
        return GroundMap(-self.latitude, self.longitude + 180.0, self.radius)

    def places(self, latitude: Array, longitude: Array) -> tuple[Array, Array]:
        """Metres east and north on the map of latitudes and longitudes [deg], [count] each."""
        facing, east, north = self._axes(latitude, longitude)
        size = self.radius * np.sqrt(2.0 / np.maximum(1.0 + facing, 1e-12))
        return size * east, size * north

    def facing(self, latitude: Array, longitude: Array) -> Array:
        """Cosine of the angle from the middle, [count]: above 0 on the half of the sphere around it."""
        return self._axes(latitude, longitude)[0]

    def line(self, latitude: Array, longitude: Array, least: float = 0.0) -> tuple[Array, Array]:
        """A line on the map, broken where it lies farther from the middle than an angle of this cosine."""
        east, north = self.places(latitude, longitude)
        is_far = self.facing(latitude, longitude) < least
        return np.where(is_far, np.nan, east), np.where(is_far, np.nan, north)

    def back(self, east: Array, north: Array) -> tuple[Array, Array]:
        """Latitude and longitude [deg] of places on the map [m], within its edge."""
        x, y = east / self.radius, north / self.radius
        square = np.minimum(x**2 + y**2, 4.0)
        scale = np.sqrt(1.0 - 0.25 * square)
        facing, along, up = 1.0 - 0.5 * square, scale * x, scale * y
        middle = np.radians(self.latitude)
        height = facing * np.sin(middle) + up * np.cos(middle)
        turn = np.arctan2(along, facing * np.cos(middle) - up * np.sin(middle))
        return np.degrees(np.arcsin(np.clip(height, -1.0, 1.0))), self.longitude + np.degrees(turn)

    def _axes(self, latitude: Array, longitude: Array) -> tuple[Array, Array, Array]:
        """Parts of the direction of a place along the middle, east and north there."""
        lat, middle = np.radians(np.asarray(latitude, dtype=float)), np.radians(self.latitude)
        turn = np.radians(np.asarray(longitude, dtype=float) - self.longitude)
        facing = np.sin(middle) * np.sin(lat) + np.cos(middle) * np.cos(lat) * np.cos(turn)
        north = np.cos(middle) * np.sin(lat) - np.sin(middle) * np.cos(lat) * np.cos(turn)
        return facing, np.cos(lat) * np.sin(turn), north


@dataclass(frozen=True)
class MapPanel:
    """A square part of a map: its middle [m east and north] and half of its width [m]."""

    east: float
    north: float
    half: float

    def holds(self, east: Array, north: Array) -> NDArray[np.bool_]:
        """Which places lie within it."""
        return np.asarray((np.abs(east - self.east) <= self.half) & (np.abs(north - self.north) <= self.half))


# A panel has so much more than what it has to hold; one wider than a part of the half sphere is drawn as both halves.
MARGIN, WIDEST = 1.12, 0.7


def panel_around(ground: GroundMap, lines: Sequence[tuple[Array, Array]]) -> MapPanel | None:
    """The panel that holds the middle and these latitudes and longitudes [deg]; None where they lie too far apart."""
    latitude, longitude = (np.concatenate([np.array([middle]), *parts]) for middle, parts in zip(
        (ground.latitude, ground.longitude), zip(*lines, strict=True) if lines else ((), ()), strict=True
    ))  # fmt: skip
    if ground.facing(latitude, longitude).min() < 0.0:
        return None
    east, north = ground.places(latitude, longitude)
    half = MARGIN * 0.5 * max(float(np.ptp(east)), float(np.ptp(north)), 1e-6 * ground.radius)
    middle = 0.5 * float(east.min() + east.max()), 0.5 * float(north.min() + north.max())
    return MapPanel(*middle, half) if half < WIDEST * ground.edge else None


def step_of(width_deg: float) -> float:
    """The round step [deg] between lines of a graticule over a width [deg]."""
    return min(STEPS_DEG, key=lambda step: abs(np.log(width_deg / step / LINES)))


def round_length(most: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not more."""
    power = 10.0 ** np.floor(np.log10(most))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= most * (1.0 + 1e-12)))
