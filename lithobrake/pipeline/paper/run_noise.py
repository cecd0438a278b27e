"""How single runs scatter about the expansion, to be drawn from for samples and for every later bounce."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns

if TYPE_CHECKING:
    from lithobrake.chaos import Surrogate

# An angle scatters as much after a slow impact as after a fast one.
ANGLES = ("elevation_out",)


@dataclass(frozen=True)
class Scatter:
    """Rows of joint differences of single runs from the expansion, made at impacts of about `speed` [m/s].

    rows    [row_count, output_count], SI; drawn whole, so that outputs stay together
    grows   which outputs scatter in proportion to the impact speed, [output_count]: velocities and spin
    """

    rows: np.ndarray
    speed: float
    grows: np.ndarray

    @classmethod
    def of(cls, job: Job, refined: "Surrogate") -> "Scatter":
        """That of the runs of the refined design."""
        from lithobrake.chaos import joint_scatter

        runs = DesignRuns.load(job.folder, "refined")
        rows = joint_scatter(refined, runs.columns(refined.input_names), runs.y)
        # Every run has its impact speed among its inputs, whether the study varies it or not.
        speeds = runs.inputs["impact.speed"][runs.has_outputs]
        grows = np.array([name not in ANGLES for name in refined.output_names])
        return cls(rows, float(np.sqrt(np.mean(speeds**2))), grows)

    def draw(self, speed: np.ndarray, random: np.random.Generator) -> np.ndarray:
        """Differences for impacts at speeds [m/s], shape [count]; shape [count, output_count].

        Drawn at full size, those of fast impacts would throw a slow lander up faster than it came.
        """
        rows = self.rows[random.integers(len(self.rows), size=len(speed))]
        drawn: np.ndarray = rows * np.where(self.grows, (speed / self.speed)[:, None], 1.0)
        return drawn
