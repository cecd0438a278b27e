"""Hard ground whose restitution is drawn: what a soft surface does, in the words of tools that know only hard ones."""

import csv
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lithobrake.files.atomic import atomic_path
from lithobrake.files.reading import read_rows
from lithobrake.smallbody.bounce import Impacts, Rebounds
from lithobrake.vocabulary.arrays import Array
from lithobrake.vocabulary.outcomes import TouchdownOutcome

# Levels of the quantiles of each cell; the outermost are the smallest and largest value.
LEVELS = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)
DRAWN = ("normal_restitution", "tangential_restitution", "azimuth_deg")
# Follows from the two restitutions and the direction; for tools that ask for it.
FRICTION = "friction"
EDGES = ("speed_from [m/s]", "speed_to [m/s]", "incidence_from_deg", "incidence_to_deg")
CAPTURED = TouchdownOutcome.CAPTURED.value
COUNTS = ("samples", "runs", CAPTURED, "correlation")


@dataclass(frozen=True)
class RestitutionTable:
    """A bounce by draws from quantiles in cells of speed and incidence; an impact beyond them is that of the next cell.

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
        with atomic_path(Path(path)) as draft, draft.open("w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow([*EDGES, *COUNTS, *names])
            for row, column in np.ndindex(self.captured.shape):
                edges = [*self.speed[row : row + 2].tolist(), *self.incidence_deg[column : column + 2].tolist()]
                counts = [getattr(self, name)[row, column].item() for name in COUNTS]
                values = [self.quantiles[name][row, column].tolist() for name in (*DRAWN, FRICTION)]
                table.writerow([*edges, *counts, *(one for part in values for one in part)])

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
