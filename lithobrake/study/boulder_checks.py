"""What boulders among the grains ask of a study: to be larger than these, and ground on which none meets itself."""

import math
from collections.abc import Iterator

from lithobrake.geometry.boulder_limits import BOULDER_REACH
from lithobrake.geometry.longest_grain import longest_reach
from lithobrake.study.bed_section import BoulderSection, Constant
from lithobrake.study.period_checks import SKINS, TWO_IMAGES
from lithobrake.study.study import Study


def boulder_problems(study: Study, largest: float, lander_radius: float) -> Iterator[str]:
    """Sizes and cover of boulders, and the least width of their bed; largest: diameter of a grain, all [m]."""
    if study.bed.boulders is None:
        return
    lower, upper = boulder_diameters(study.bed.boulders)
    if lower < largest:
        yield (
            f"bed.boulders.diameter reaches from {lower:g} m, and grains to {largest:g} m (bed.diameter); allowed: "
            f"boulders of at least {largest:g} m; raise it, or lower bed.diameter"
        )
    low, high = study.bed.boulders.cover
    if low > high:
        yield f"bed.boulders.cover is [{low:g}, {high:g}] m; allowed: the smaller first; swap them"
    width, least = min(study.bed.width), boulder_width(study, largest, lander_radius)
    if width < least:
        why = "as they lie between the walls" if study.bed.sides == "walls" else TWO_IMAGES
        yield (
            f"bed.width is {width:g} m at its narrowest; allowed: at least {least:.3g} m for boulders of {upper:g} m, "
            f"{why}; widen the bed and add grains, or lower bed.boulders.diameter"
        )


def boulder_diameters(section: BoulderSection) -> tuple[float, float]:
    """Diameters of the smallest and the largest boulder [m]."""
    sizes = section.diameter
    return (sizes.value,) * 2 if isinstance(sizes, Constant) else (sizes.lower, sizes.upper)


def boulder_width(study: Study, largest: float, lander_radius: float) -> float:
    """The least width of a bed with boulders [m]; 0 without any."""
    section = study.bed.boulders
    if section is None:
        return 0.0
    lower, upper = boulder_diameters(section)
    reach = BOULDER_REACH * upper
    if study.bed.sides != "periodic":
        return 2.0 * reach
    # Of the smallest a bed has most.
    count = section.coverage * study.bed.width[0] * study.bed.width[1] / (0.25 * math.pi * lower**2)
    beside = reach if count > 1.0 else max(longest_reach(study.bed.cloud_point_count) * largest, lander_radius)
    return 2.0 * (reach + beside) + SKINS * largest
