"""What happens at an impact: the interface, hard ground, and hard ground whose restitution is drawn."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lithobrake.files.atomic import write_rows
from lithobrake.files.reading import read_rows
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.outcomes import CAPTURED

# Levels of the quantiles of each cell; the outermost are the smallest and largest value.
LEVELS = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)
DRAWN = ("normal_restitution", "tangential_restitution", "azimuth_deg")
# Follows from the two restitutions and the direction; for tools that ask for it.
FRICTION = "friction"
EDGES = ("speed_from [m/s]", "speed_to [m/s]", "incidence_from_deg", "incidence_to_deg")
COUNTS = ("samples", "runs", CAPTURED, "correlation")


@dataclass(frozen=True)
class Impacts:
    """Landers that touch the ground, in the frame of each impact.

    speed       [m/s], [count]
    incidence   angle of the velocity from the inward normal [rad], [count]
    spin        angular velocity [rad/s], [count, 3]
    effective_acceleration   gravity and centrifugal acceleration along the outward normal [m/s2], [count]; below 0 it
                holds a lander
    lander      which of the landers each is, counted among all that are followed, [count]
    """

    speed: NDArray[np.float64]
    incidence: NDArray[np.float64]
    spin: NDArray[np.float64]
    effective_acceleration: NDArray[np.float64]
    lander: NDArray[np.int64]


@dataclass(frozen=True)
class Rebounds:
    """How the landers leave, in the frame of each impact.

    velocity    [m/s], [count, 3]; of a captured lander what it slides on with, of which only x and y are read
    spin        [rad/s], [count, 3]
    captured    the lander stays on the ground, [count]
    outside     the model does not cover this impact, [count]; neither velocity nor captured is then read
    """

    velocity: NDArray[np.float64]
    spin: NDArray[np.float64]
    captured: NDArray[np.bool_]
    outside: NDArray[np.bool_]


Bounce = Callable[[Impacts, np.random.Generator], Rebounds]
"""Model of a rebound: a function of impacts and a random generator that returns the rebounds, in the same order."""


@dataclass(frozen=True)
class HardSurface:
    """A point on hard ground: constant restitution along and across the normal, the latter limited by friction.

    The normal velocity v becomes -normal_restitution v. The horizontal one becomes tangential_restitution times itself,
    unless that takes more than friction times the normal impulse. A lander whose rebound rises less than rest_height
    [m] under the effective acceleration is captured; where that points outwards none is. Keep that height above a
    millimetre: flights are not told from rest below a millionth of the body's radius. It slides on with its horizontal
    velocity. Spin is kept: a point has none to change.

    Source: [Tardivel-2014]: an impact as normal restitution and Coulomb friction.
    """

    normal_restitution: float
    tangential_restitution: float = 1.0
    friction: float = np.inf
    rest_height: float = 0.01

    def __post_init__(self) -> None:
        for name in ("normal_restitution", "tangential_restitution"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise ValueError(f"{name} is {getattr(self, name)}; it must lie in 0 to 1.")
        for name in ("friction", "rest_height"):
            if not getattr(self, name) >= 0.0:
                raise ValueError(f"{name} is {getattr(self, name)}; it must not be below 0.")

    def __call__(self, impacts: Impacts, random: np.random.Generator) -> Rebounds:
        """Bounce without scatter; `random` is not read."""
        down, along = impacts.speed * np.cos(impacts.incidence), impacts.speed * np.sin(impacts.incidence)
        up, outward = self.normal_restitution * down, impacts.effective_acceleration
        # Without horizontal motion there is nothing to lose, whatever the friction.
        with np.errstate(invalid="ignore", divide="ignore"):
            kept = 1.0 - self.friction * (down + up) / along
            apex = np.where(outward < 0.0, up**2 / (-2.0 * outward), np.inf)
        kept = np.where(along > 0.0, np.maximum(kept, self.tangential_restitution), 0.0)
        velocity = np.stack([kept * along, np.zeros_like(up), up], axis=1)
        captured = apex < self.rest_height
        return Rebounds(velocity, impacts.spin, captured, np.zeros(len(up), dtype=bool))


@dataclass(frozen=True)
class RestitutionTable:
    """Bounce sampled from quantiles in cells of speed and incidence; impacts beyond them use the nearest cell.

    speed [m/s] and incidence_deg: edges of the cells, [speed_count + 1] and [incidence_count + 1]
    quantiles     at LEVELS by name, [speed_count, incidence_count, level_count]: outgoing over incoming velocity along
                  the normal and along the ground, the angle from the incoming horizontal direction to the left, and
                  friction, the change of the horizontal velocity over that along the normal
    correlation   of the normal scores of the two restitutions, [speed_count, incidence_count]
    captured      share of landers that stay, likewise; samples, runs: what each cell was made of
    rest_height   a lander whose rebound rises less [m] is captured, as on HardSurface
    """

    speed: Array
    incidence_deg: Array
    quantiles: dict[str, Array]
    correlation: Array
    captured: Array
    samples: NDArray[np.int64]
    runs: NDArray[np.int64]
    rest_height: float = 0.01

    def __call__(self, impacts: Impacts, random: np.random.Generator) -> Rebounds:
        """Draw restitution and direction of each impact; spin is kept, as a point has none to change."""
        from scipy import special

        count = len(impacts.speed)
        row, column = cells(self.speed, impacts.speed), cells(self.incidence_deg, np.degrees(impacts.incidence))
        scores, stays = random.standard_normal((count, 3)), random.random(count)
        # A Gaussian copula: normal scores are correlated first, and become the quantiles of each restitution then.
        tie = self.correlation[row, column]
        scores[:, 1] = tie * scores[:, 0] + np.sqrt(1.0 - tie**2) * scores[:, 1]
        drawn = {}
        for place, name in enumerate(DRAWN):
            found = np.empty(count)
            for cell in set(zip(row.tolist(), column.tolist(), strict=True)):
                here = (row == cell[0]) & (column == cell[1])
                found[here] = np.interp(special.ndtr(scores[here, place]), LEVELS, self.quantiles[name][cell])
            drawn[name] = found
        up = drawn["normal_restitution"] * impacts.speed * np.cos(impacts.incidence)
        along = drawn["tangential_restitution"] * impacts.speed * np.sin(impacts.incidence)
        azimuth, outward = np.radians(drawn["azimuth_deg"]), impacts.effective_acceleration
        with np.errstate(divide="ignore"):
            apex = np.where(outward < 0.0, up**2 / (-2.0 * outward), np.inf)
        velocity = np.stack([along * np.cos(azimuth), along * np.sin(azimuth), up], axis=1)
        stopped = stays < self.captured[row, column]
        # The runs do not tell with which velocity a lander is captured, only that little is left.
        velocity[stopped] = 0.0
        captured = (apex < self.rest_height) | stopped | (up <= 0.0)
        return Rebounds(velocity, impacts.spin, captured, np.zeros(count, dtype=bool))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a CSV file, one row a cell; names end with the level of a quantile, and have units in brackets."""
        names = [f"{name}_q{level:g}" for name in (*DRAWN, FRICTION) for level in LEVELS]
        rows = []
        for row, column in np.ndindex(self.captured.shape):
            edges = [*self.speed[row : row + 2].tolist(), *self.incidence_deg[column : column + 2].tolist()]
            counts = [getattr(self, name)[row, column].item() for name in COUNTS]
            values = [self.quantiles[name][row, column].tolist() for name in (*DRAWN, FRICTION)]
            rows.append([*edges, *counts, *(one for part in values for one in part)])
        write_rows(path, [*EDGES, *COUNTS, *names], rows)

    @classmethod
    def read(cls, path: str | os.PathLike[str], rest_height: float = 0.01) -> "RestitutionTable":
        """Read what `save` wrote. Raises DamagedFileError for another file."""
        wanted = tuple(name.partition(" [")[0] for name in EDGES)
        rows = read_rows(Path(path), (*wanted, *COUNTS), "make it anew with the study that it is of")
        edges = np.array([[float(row[name]) for name in wanted] for row in rows])
        speed, incidence = (np.unique(edges[:, one : one + 2]) for one in (0, 2))
        shape = (len(speed) - 1, len(incidence) - 1)

        def column(name: str) -> Array:
            return np.reshape([float(row[name]) for row in rows], shape)

        quantiles = {
            name: np.stack([column(f"{name}_q{level:g}") for level in LEVELS], axis=-1) for name in (*DRAWN, FRICTION)
        }
        samples, runs = (column(name).astype(np.int64) for name in ("samples", "runs"))
        found = (column("correlation"), column(CAPTURED), samples, runs)
        return cls(speed, incidence, quantiles, *found, rest_height)


def cells(edges: Array, values: Array) -> NDArray[np.int64]:
    """The cell of each value [count] between edges [cell_count + 1]; the outermost cells take what lies beyond."""
    found: NDArray[np.int64] = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)
    return found


def impact_frame(velocity: Array, up: Array) -> Array:
    """Axes in rows, [count, 3, 3]: x along the horizontal velocity, y = z cross x, z = up, the unit normal."""
    level = velocity - np.einsum("ni,ni->n", velocity, up)[:, None] * up
    # A vertical impact has no horizontal direction; any will do.
    aside = np.eye(3)[np.argmin(np.abs(up), axis=1)]
    length = np.linalg.norm(level, axis=1, keepdims=True)
    level = np.where(length > 1e-12 * np.linalg.norm(velocity, axis=1, keepdims=True), level, np.cross(up, aside))
    x = level / np.linalg.norm(level, axis=1, keepdims=True)
    return np.stack([x, np.cross(up, x), up], axis=1)
