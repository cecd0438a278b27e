"""The grains of a bed whose sizes have a distribution, in the numbers by which boulder fields are known."""

import math
from dataclasses import dataclass

import numpy as np

from lithobrake.study import Study
from lithobrake.study.touchdown_model import grain_sizes

# Of grains that are larger than the diameter that is told.
LARGE_FRACTION = 0.1


@dataclass(frozen=True)
class PlannedGrains:
    """Diameters [m]: smallest, largest, their mean, and that which a tenth of the grains exceeds; and how many grains
    there are over a square metre of the bed, from its surface to its floor."""

    smallest: float
    largest: float
    mean: float
    large: float
    count_per_m2: float

    def line(self) -> str:
        """All of it in a line of text."""
        return (
            f"Grains: {self.smallest:.3g} to {self.largest:.3g} m in diameter, mean {self.mean:.3g} m; "
            f"{self.count_per_m2:.3g} per m2 of bed, of which {LARGE_FRACTION * self.count_per_m2:.3g} are larger than "
            f"{self.large:.3g} m."
        )


def planned_grains(study: Study) -> PlannedGrains | None:
    """The grains of a study's beds; None where they all have one size, or there are none."""
    if not study.has_soil:
        return None
    sizes = grain_sizes(study)
    if sizes.lower == sizes.upper:
        return None
    large = float(sizes.draw(np.array([1.0 - LARGE_FRACTION]))[0])
    count = study.bed.grain_count / math.prod(study.bed.width)
    return PlannedGrains(sizes.lower, sizes.upper, sizes.mean_diameter, large, count)
