"""The ground of the first touchdowns of journeys before they are made: how hard it pulls, and how it slopes."""

import math
from dataclasses import dataclass

import numpy as np

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.local_ground import STEEPEST_DEG, friction_of
from lithobrake.study.period_checks import LEAST_FRICTION
from lithobrake.vocabulary.quantities import GROUND

# Of the touchdowns: those between which nine in ten lie, and those with a smaller slope.
LOW, MEDIAN, HIGH = 0.05, 0.5, 0.95


@dataclass(frozen=True)
class PlannedGround:
    """Gravity and rotation together [m/s2], below 0 outward, and slope [deg] of the beds of first touchdowns.

    gravity: that of which one in twenty has less, the median, and that of which one in twenty has more. slope_deg: the
    median, and that of which one in twenty has more. steeper: part of them that lies steeper than soil holds, so that
    the bed is tilted less. roughness_deg: of the ground at the lander's scale, 0 for flat facets.
    """

    gravity: tuple[float, float, float]
    slope_deg: tuple[float, float]
    steeper: float
    roughness_deg: float

    def line(self) -> str:
        """All of it in a line of text."""
        low, middle, high = self.gravity
        median, most = self.slope_deg
        rough = f", with a roughness of {self.roughness_deg:g} deg rms" if self.roughness_deg else ""
        capped = (
            f"; {100.0 * self.steeper:.0f} % lie steeper than soil holds, and their beds are tilted up to "
            f"{STEEPEST_DEG:g} deg"
            if self.steeper >= 0.005
            else ""
        )
        return (
            f"First touchdowns: {middle:.2g} m/s2 in the median, {low:.2g} to {high:.2g} for nine in ten; slope "
            f"{median:.0f} deg in the median, up to {most:.0f} deg for 95 %{rough}{capped}."
        )


def planned_ground(design: DrawnDesign) -> PlannedGround | None:
    """The ground of the first touchdowns of a study; None where it follows no journeys."""
    study = design.study
    if study.journey is None:
        return None
    strength, slope = np.array([[row[name] for name in GROUND[:2]] for row in design.rows]).T
    held = [min(STEEPEST_DEG, math.degrees(math.atan(friction_of(row) / LEAST_FRICTION))) for row in design.rows]
    low, middle, high = np.quantile(strength, [LOW, MEDIAN, HIGH]).tolist()
    median, most = np.quantile(slope, [MEDIAN, HIGH]).tolist()
    steeper = float(np.mean(slope > np.array(held) - 1e-9))
    return PlannedGround((low, middle, high), (median, most), steeper, study.site.roughness_deg or 0.0)
