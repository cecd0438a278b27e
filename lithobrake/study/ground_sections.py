"""The tables of the study file that say what the lander touches: bed, grains, and soils by region."""

import re
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Literal

from pydantic import Field, create_model, model_validator
from pydantic_core import PydanticCustomError

from lithobrake.files.reading import read_text
from lithobrake.geometry.bed_limits import LARGEST_COVERAGE
from lithobrake.study.quantity import MaybeUncertain, Number, Numbers, Scalar, Section, Uncertain, Whole
from lithobrake.vocabulary.constants import FEWEST_BEDS_OF_INTERVAL
from lithobrake.vocabulary.material_properties import PROPERTIES, SURFACE_PROPERTIES, MaterialProperty
from lithobrake.vocabulary.plain_text import show

Metres = Annotated[float, Number("m", above=0)]
# Runs on each bed with which an interval is narrowest for the time, by what a bed costs and how alike runs on it are
# (docs/estimates.md).
LANDINGS_A_BED, JOURNEYS_A_BED = 20, 4
MOST_BEDS = 1000
# As a table has them that gives the density too.
ALL_PROPERTIES = ("density", *SURFACE_PROPERTIES)
Ends = tuple[float, float]


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


SIZES = (Constant, Between, Bell, PowerLaw)


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
    sides: Literal["walls", "periodic"] = "periodic"
    """What is beyond the width. "walls": an open box, which a lander may leave across its edge. "periodic": the same
    ground again; no lander leaves it laterally, and one that travels farther meets ground that it has disturbed.
    "walls" only with journey.touchdowns = 1."""
    diameter: Annotated[Constant | Between | Bell | PowerLaw, Field(discriminator="distribution")] = Field(
        examples=['{ distribution = "constant", value = 0.08 }']
    )
    """Diameter of the sphere of equal volume: constant (value), uniform (lower, upper), normal (mean, std, lower,
    upper) or power_law (exponent or cumulative_exponent, lower, upper). With power_law the number of grains per
    diameter D is proportional to D**-exponent, and that of grains larger than D to D**-cumulative_exponent, whose
    exponent is smaller by 1. Both are written positive."""
    bed_count: Annotated[int, Whole("", at_least=1, at_most=MOST_BEDS)] | None = None
    """Number of beds; with more than one, the bed of each run is sampled. Absent: with journey.touchdowns
    = 1 one bed for every 20 landers, otherwise one for every 4 (rounded up), at least 12; one without landers."""
    seed: Annotated[int, Whole("", at_least=0, at_most=2**53)] | None = None
    """Seed of the first bed; the following beds have the following numbers. Absent: it follows from the seed of the
    study."""
    cloud_point_count: Annotated[int, Whole("", at_least=4, at_most=100)] = 14
    """Points in the random cloud whose hull is a grain."""
    pour_gravity: Annotated[float, Number("m/s2", above=0, at_most=1000)] = 9.81
    """Acceleration under which the grains fall. It is then lowered slowly to that under which they settle."""
    pour_friction: Annotated[float, Number("", at_least=0)] | None = None
    """Coefficient of friction while the grains are poured and come to rest: the less, the denser they pack (a solid
    fraction of 0.67 at 0.1, 0.58 at 0.9). Absent: that of the grains, at its median."""
    boulders: BoulderSection | None = None
    """Boulders among the grains."""
    settle_gravity: Annotated[float, Number("m/s2", above=0)] | None = None
    """Acceleration under which the bed comes to rest; absent: surface.gravity, which must then point inward."""


def default_bed_count(run_count: int, runs_a_bed: int) -> int:
    """How many beds a study has of which nothing else is said: by so many runs on each, within limits.

    Source: [Cochran-1977], section 10.6.
    """
    # Rounded up: to the nearest, the newest bed would be half full at each further 20 landings or 4 journeys.
    return min(run_count, MOST_BEDS, max(FEWEST_BEDS_OF_INTERVAL, -(-run_count // runs_a_bed)))


def allowed(name: str, kind: type[Number] = MaybeUncertain) -> Number:
    """The unit and the range of a property."""
    known = PROPERTIES[name]
    return kind(known.unit, known.above, known.at_least, known.below, known.at_most)


def meaning(known: MaterialProperty) -> str:
    """What a property of the grains is."""
    return known.meaning


def with_properties(
    base: type[Section],
    names: Collection[str],
    words: Callable[[MaterialProperty], str] = meaning,
    *,
    needed: bool = False,
    fixed: Collection[str] = (),
    examples: Mapping[str, str] = MappingProxyType({}),
) -> Any:
    """A table with these properties behind its own keys.

    words: what a key means; needed: those without a default must be given, where else any may be left out; fixed:
    properties that cannot be uncertain there.
    """
    fields: dict[str, Any] = {}
    for name in names:
        known = PROPERTIES[name]
        kind: Any = Annotated[float, allowed(name, Number)] if name in fixed else Annotated[Scalar, allowed(name)]
        default: Any = (... if known.default is None else known.default) if needed else None
        shown = known.example if needed else examples.get(name)
        field = Field(default=default, description=words(known), examples=None if shown is None else [shown])
        fields[name] = (kind if needed else kind | None, field)
    # Nothing stands in a source that pydantic could look for, which it does through all modules.
    sourceless: Any = {"use_attribute_docstrings": False}
    return create_model(base.__name__, __base__=base, __module__=__name__, __cls_kwargs__=sourceless, **fields)


_GrainProperties: Any = with_properties(Section, ALL_PROPERTIES, needed=True)


class GrainSection(_GrainProperties):
    """The rock of the grains."""


_SoilProperties: Any = with_properties(
    Section, ALL_PROPERTIES, examples={"friction": '{ distribution = "uniform", lower = 0.2, upper = 0.4 }'}
)


class SoilGrainSection(_SoilProperties):
    """Material of the grains of a region where it differs from [grain]; the sizes are those of [bed] everywhere. A
    property that is absent is that of [grain]."""

    def values(self) -> dict[str, Scalar]:
        """The numbers that differ, by their names in [grain]."""
        given = {name: getattr(self, name) for name in type(self).model_fields}
        return {name: value for name, value in given.items() if isinstance(value, float | Uncertain)}


class SoilSection(Section):
    """The soil of a region of the body. There may be any number of regions, each in a table [soil.NAME] of its own. A
    region is the ground within all of its bounds. Where regions overlap, the first in the file applies; where there is
    none, [grain] applies. All beds are those of [bed] and [grain]: a touchdown in the region uses one of them with the
    region's materials. The soil of each region is sampled once for each lander."""

    latitude_deg: Annotated[Ends, Numbers("deg", at_least=-90, at_most=90, count=2, ascending=True)] | None = None
    """Smallest and largest planetocentric latitude. If this or a bound below is absent, it does not limit the
    region."""
    longitude_deg: Annotated[Ends, Numbers("deg", at_least=-360, at_most=360, count=2)] | None = None
    """First longitude and, eastward of it, the last one; [170, -170] crosses 180."""
    slope_deg: Annotated[Ends, Numbers("deg", at_least=0, at_most=180, count=2, ascending=True)] | None = None
    """Smallest and largest slope of its facets, at their centres, against gravity, rotation and the partner's tide at
    the medians of [site]. Above 90 an object at rest leaves the ground."""
    facets: str | None = Field(default=None, examples=['"ponds.csv"'])
    """Text file, relative to the study file, with the numbers of its facets in the shape of the body, from 0, one per
    line."""
    ground: str | None = Field(default=None, examples=['"gravel"'])
    """Kind of ground of the region, by its name in [ground.kind.NAME]: a touchdown in it meets a bed of this kind."""
    grain: SoilGrainSection = SoilGrainSection()

    @model_validator(mode="before")
    @classmethod
    def _refuse_sizes(cls, table: Any) -> Any:
        """Say of sizes why a region has none; all else that is wrong is left for the fields to refuse."""
        grain = table.get("grain") if isinstance(table, Mapping) else None
        if isinstance(table, Mapping) and ("bed" in table or (isinstance(grain, Mapping) and "diameter" in grain)):
            words = "gives sizes of grains; allowed: materials alone, as beds are poured once for all of the body"
            raise PydanticCustomError("quantity", "{text}", {"text": f"{words}; make a study for each of the sizes"})
        return table

    @property
    def has_bounds(self) -> bool:
        return any(one is not None for one in (self.latitude_deg, self.longitude_deg, self.slope_deg, self.facets))


def facet_numbers(path: Path) -> tuple[int, ...]:
    """The numbers in a file of facets. Raises ValueError for a line that is none, or no number at all; OSError."""
    found = []
    for number, line in enumerate(read_text(path).splitlines(), start=1):
        text = line.strip()
        if text and not re.fullmatch(r"\d{1,9}", text, re.ASCII):
            raise ValueError(f"line {number} is {show(text)}; allowed: a whole number from 0; mend that line")
        found += [int(text)] if text else []
    if not found:
        raise ValueError("it has no facet; write their numbers, from 0, one a line")
    return tuple(found)
