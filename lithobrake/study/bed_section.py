"""The table of the study file that says what the lander touches: the grains' sizes and their bed."""

from typing import Annotated, Literal

from pydantic import Field

from lithobrake.geometry.boulder_limits import LARGEST_COVERAGE
from lithobrake.study.quantity import Number, Numbers, Section, Whole

Metres = Annotated[float, Number("m", above=0)]
# Runs on each bed with which an interval is narrowest for the time, by what a bed costs and how alike runs on it are
# (docs/estimates.md). An interval needs a dozen beds.
LANDINGS_A_BED, JOURNEYS_A_BED = 20, 4
FEWEST_BEDS, MOST_BEDS = 12, 1000


class Constant(Section):
    """All grains have one size."""

    distribution: Literal["constant"]
    value: Metres


class Between(Section):
    """Grain sizes spread evenly between two limits."""

    distribution: Literal["uniform"]
    lower: Metres
    upper: Metres


class Bell(Section):
    """Grain sizes with a normal distribution, cut at two limits."""

    distribution: Literal["normal"]
    mean: Metres
    std: Metres
    lower: Metres
    upper: Metres


class PowerLaw(Section):
    """Number of grains that falls with the diameter D to a power, between two limits, by one of two exponents.

    exponent: differential, the number per diameter goes with D**-exponent. cumulative_exponent: the number of grains
    larger than D goes with D**-cumulative_exponent, before it is cut at the limits; it is 1 less than the other.
    """

    distribution: Literal["power_law"]
    exponent: Annotated[float, Number("")] | None = None
    cumulative_exponent: Annotated[float, Number("")] | None = None
    lower: Metres
    upper: Metres

    @property
    def differential_exponent(self) -> float:
        """The exponent of the number per diameter, whichever of the two is given."""
        return self.exponent if self.exponent is not None else 1.0 + (self.cumulative_exponent or 0.0)


class BoulderSection(Section):
    """Boulders among the grains, of the same material. They lie on a broad face, and grains are poured on and around
    them. Parts that would reach below the floor are cut off."""

    diameter: Annotated[Constant | Between | Bell | PowerLaw, Field(discriminator="distribution")] = Field(
        examples=['{ distribution = "power_law", cumulative_exponent = 2.65, lower = 0.3, upper = 0.6 }']
    )
    """Diameter of the sphere of equal volume, as bed.diameter. No boulder reaches farther than 0.75 diameters from its
    centroid."""
    coverage: Annotated[float, Number("", above=0, at_most=LARGEST_COVERAGE)] = Field(examples=["0.1"])
    """Fraction of the ground that the boulders cover, seen from above as discs of their diameters, in the mean over
    beds. A bed has a whole number of boulders; whether it is rounded up or down is random."""
    cover: Annotated[tuple[float, float], Numbers("m", count=2)] = Field((0.0, 0.0), examples=["[-0.1, 0.1]"])
    """Depth of a boulder's top below the mean surface of the grains, smallest and largest; it is sampled for each
    boulder. If negative, the boulder protrudes. A boulder that is too small for its depth lies on the floor."""


class BedSection(Section):
    """The surface: grains are convex hulls of random clouds of points, poured on a floor and settled."""

    grain_count: Annotated[int, Whole("", at_least=10, at_most=1_000_000)] = Field(examples=["150"])
    """Number of grains."""
    width: Annotated[tuple[float, float], Numbers("m", count=2, above=0)] = Field(examples=["[0.55, 0.55]"])
    """Width along x and y, between the walls or until the ground repeats. It must be at least twice the largest
    diameter of the lander's main shape, and wider than its parts reach."""
    sides: Literal["walls", "periodic"] = "walls"
    """What is beyond the width. "walls": an open box, which a lander may leave across its edge. "periodic": the same
    ground again; no lander leaves it laterally, and one that travels farther meets ground that it has disturbed.
    "periodic" is the default of design.method = "drawn"."""
    diameter: Annotated[Constant | Between | Bell | PowerLaw, Field(discriminator="distribution")] = Field(
        examples=['{ distribution = "constant", value = 0.08 }']
    )
    """Diameter of the sphere of equal volume: constant (value), uniform (lower, upper), normal (mean, std, lower,
    upper) or power_law (exponent or cumulative_exponent, lower, upper). With power_law the number of grains per
    diameter D is proportional to D**-exponent, and that of grains larger than D to D**-cumulative_exponent, whose
    exponent is smaller by 1. Both are written positive."""
    bed_count: Annotated[int, Whole("", at_least=1, at_most=MOST_BEDS)] | None = None
    """Number of beds; with more than one, the bed of each run is sampled. Absent: one; with design.method = "drawn",
    one bed for every 20 landings, or for every 4 journeys (rounded up), at least 12."""
    cloud_point_count: Annotated[int, Whole("", at_least=4, at_most=100)] = 14
    """Points in the random cloud whose hull is a grain."""
    pour_gravity: Annotated[float, Number("m/s2", above=0)] = 9.81
    """Acceleration under which the grains fall. It is then lowered slowly to that under which they settle."""
    boulders: BoulderSection | None = None
    """Boulders among the grains."""
    settle_gravity: Annotated[float, Number("m/s2", above=0)] | None = None
    """Acceleration under which the bed comes to rest; absent: surface.gravity, which must then point inward."""


def default_bed_count(run_count: int, runs_a_bed: int) -> int:
    """How many beds a drawn study has of which nothing else is said: by so many runs on each, within limits.

    Source: [Cochran-1977], section 10.6.
    """
    return min(run_count, MOST_BEDS, max(FEWEST_BEDS, -(-run_count // runs_a_bed)))
