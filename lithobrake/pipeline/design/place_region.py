"""Where on the bed the runs of a study come down that draw their place."""

from typing import Any

import numpy as np

from lithobrake.study import Study
from lithobrake.study.touchdown_model import grain, grain_sizes, lander, medians

Interval = tuple[float, float]
# Sizes of grains out of their distribution, evenly by share, whose mean is that of all.
SIZE_COUNT = 1000
# Of a lander that is flown to the ground [m/s]: the smallest width is the same at every speed.
ANY_SPEED = 1.0


def place_region(study: Study) -> tuple[Interval, Interval] | None:
    """The rectangle [m, from the middle of the bed, along x and y] out of which places are drawn; None for no draw.

    Where a drawn study names neither place nor region: all of a bed that repeats; between walls, wherever the lander is
    as far from each as in the smallest bed whose walls do not answer its first blow, or in the middle where a bed is no
    wider than that.
    """
    impact = study.impact
    if impact.region is not None:
        return impact.region.x, impact.region.y
    if impact.place is not None or study.design.method != "drawn":
        return None
    if study.bed.sides == "periodic":
        along, across = (0.5 * width for width in study.bed.width)
        return (-along, along), (-across, across)
    along, across = (max(0.0, 0.5 * (width - smallest_width(study))) for width in study.bed.width)
    return (-along, along), (-across, across)


def smallest_width(study: Study) -> float:
    """Width [m] of the smallest bed of a study at its medians; stiffness and speed cancel in it."""
    from lithobrake.touchdown import smallest_bed

    values: dict[str, Any] = medians(study)
    diameter = float(grain_sizes(study).draw((np.arange(SIZE_COUNT) + 0.5) / SIZE_COUNT).mean())
    speed = values.get("impact.speed", ANY_SPEED)
    return smallest_bed(lander(study, values), grain(values), diameter, speed)[0]
