"""Landings on soil as a bounce: what simulated touchdowns of a finished study did, drawn anew."""

from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray

import lithobrake
from lithobrake.smallbody import Impacts, Rebounds

NEAR = 20  # touchdowns among which one is drawn
REST_HEIGHT = 0.01  # m, below which a rebound is none, as on hard ground


@dataclass(frozen=True)
class RecordedSoil:
    """Each impact repeats one of the touchdowns, NEAR or as many as `near` says, nearest in speed and incidence.

    speed [m/s], incidence [rad], [count]; ratio: outgoing velocity over incoming speed, x along the ground as it came
    in and z outward, [count, 3]; captured, [count]. Distance is that of the logarithm of the speed and of the
    incidence, each over its standard deviation.
    """

    speed: NDArray[np.float64]
    incidence: NDArray[np.float64]
    ratio: NDArray[np.float64]
    captured: NDArray[np.bool_]
    near: int = NEAR

    @classmethod
    def of_study(cls, folder: Path, kind: int | None = None, near: int = NEAR) -> Self:
        """The touchdowns of a finished study with journeys that ended as clear or captured.

        kind: the number of a kind of its ground, of which alone they are.
        """
        table = lithobrake.open_study(folder).touchdowns
        known = np.isin(table["outcome"], ("clear", "captured"))
        if kind is not None:
            known &= np.asarray(table["ground.kind"]) == kind
        speed = np.asarray(table["impact.speed"], dtype=np.float64)[known]
        velocity = np.column_stack([table[f"velocity_out_{axis}"] for axis in "xyz"])[known]
        captured = np.asarray(table["outcome"])[known] == "captured"
        incidence = np.radians(np.asarray(table["impact.incidence_deg"], dtype=np.float64)[known])
        ratio = np.where(captured[:, None], 0.0, velocity / speed[:, None])
        return cls(speed, incidence, ratio, captured, near)

    def __call__(self, impacts: Impacts, random: np.random.Generator) -> Rebounds:
        """Draw a touchdown for each impact; spin is kept."""
        scale = np.log(self.speed).std(), self.incidence.std()
        gap = ((np.log(impacts.speed)[:, None] - np.log(self.speed)) / scale[0]) ** 2
        gap += ((impacts.incidence[:, None] - self.incidence) / scale[1]) ** 2
        near = np.argpartition(gap, self.near, axis=1)[:, : self.near]
        row = near[np.arange(len(near)), random.integers(0, self.near, len(near))]
        velocity = self.ratio[row] * impacts.speed[:, None]
        outward = impacts.effective_acceleration
        with np.errstate(divide="ignore"):
            apex = np.where(outward < 0.0, velocity[:, 2] ** 2 / (-2.0 * outward), np.inf)
        stopped = self.captured[row] | (apex < REST_HEIGHT) | (velocity[:, 2] <= 0.0)
        return Rebounds(velocity, impacts.spin, stopped, np.zeros(len(row), dtype=bool))
