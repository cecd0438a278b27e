"""What ground that repeats asks of a study: a width in which nothing meets another twice, and a slope that holds it."""

import math
from collections.abc import Iterator

from lithobrake.geometry.longest_grain import longest_reach
from lithobrake.study.quantity import usual_reach
from lithobrake.study.study import Study

TWO_IMAGES = 'as with bed.sides = "periodic" nothing may meet another through two images'
# What the skins of lists of neighbours add to that (dem/bodies/period.py): of two grains, and of one and the lander.
SKINS, SKINS_AT_LANDER = 0.5, 0.7
# Friction over the tangent of a slope with which beds of hulls were seen to hold, two to three grains deep.
LEAST_FRICTION = 0.4


def widths_in_grains(study: Study) -> tuple[float, float]:
    """Least width of ground that repeats over the largest diameter of a grain, and how much wider than the lander.

    The fewer its points, the longer a grain may be.
    """
    longest = longest_reach(study.bed.cloud_point_count)
    return 4.0 * longest + SKINS, 2.0 * longest + SKINS_AT_LANDER


def slope_problems(study: Study) -> Iterator[str]:
    """Grains that run down a slope one over the other, where no wall holds them."""
    steepest, friction = usual_reach(study.surface.slope_deg)[1], usual_reach(study.grain.friction)[0]
    least = LEAST_FRICTION * math.tan(math.radians(steepest))
    if study.bed.sides == "periodic" and friction < least:
        yield (
            f"surface.slope_deg reaches to {steepest:g} and grain.friction down to {friction:g}; allowed with "
            f'bed.sides = "periodic" is friction of at least {least:.3g}, {LEAST_FRICTION:g} of the tangent of the '
            "slope, as such grains run down the slope otherwise; raise grain.friction, lower the slope, or set "
            'bed.sides = "walls"'
        )
