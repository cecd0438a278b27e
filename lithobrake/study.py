"""The study file: what a user writes. Every key has its unit, range and default here, and nowhere else.

A `MaybeUncertain` key takes a number, or a table with a distribution. `lithobrake new` writes these very lines.
"""

from typing import Annotated, Literal

from pydantic import BaseModel, Field

from lithobrake.outputs import OUTPUTS as OUTPUTS
from lithobrake.quantity import MaybeUncertain, Number, Numbers, Scalar, Uncertain, Whole
from lithobrake.study_campaign import CampaignSection, Section, SolverSection
from lithobrake.study_design import DesignSection, MonteCarloSection
from lithobrake.study_flight import BUILT_IN_BODIES as BUILT_IN_BODIES
from lithobrake.study_flight import Angle, FlightSection, LengthUnit, RestSection, SiteSection

Metres = Annotated[float, Number("m", above=0)]
Interval = Annotated[tuple[float, float], Numbers("m", count=2, ascending=True)]
Place = Annotated[Scalar, MaybeUncertain("m")]
Density = Annotated[Scalar, MaybeUncertain("kg/m3", above=0)]
YoungModulus = Annotated[Scalar, MaybeUncertain("Pa", above=0)]
PoissonRatio = Annotated[Scalar, MaybeUncertain("", at_least=0, below=0.5)]
Restitution = Annotated[Scalar, MaybeUncertain("", above=0, at_most=1)]
Friction = Annotated[Scalar, MaybeUncertain("", at_least=0)]
Cohesion = Annotated[Scalar, MaybeUncertain("N", at_least=0)]
SurfaceEnergy = Annotated[Scalar, MaybeUncertain("J/m2", at_least=0)]
Spin = Annotated[Scalar, MaybeUncertain("rad/s")]


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
    """Number of grains falling with size as diameter**-exponent, between two limits."""

    distribution: Literal["power_law"]
    exponent: Annotated[float, Number("")]
    lower: Metres
    upper: Metres


class BedSection(Section):
    """The surface: grains are convex hulls of random clouds of points, poured into an open box and settled."""

    grain_count: Annotated[int, Whole("", at_least=10, at_most=1_000_000)] = Field(examples=["150"])
    """How many grains."""
    width: Annotated[tuple[float, float], Numbers("m", count=2, above=0)] = Field(examples=["[0.55, 0.55]"])
    """Inner width of the box along x and y; at least twice the lander's largest diameter."""
    diameter: Annotated[Constant | Between | Bell | PowerLaw, Field(discriminator="distribution")] = Field(
        examples=['{ distribution = "constant", value = 0.08 }']
    )
    """Diameter of the sphere of equal volume: constant (value), uniform (lower, upper), normal (mean, std, lower,
    upper) or power_law (exponent, lower, upper)."""
    bed_count: Annotated[int, Whole("", at_least=1, at_most=1000)] = 1
    """How many beds; with more than one, each run draws its bed."""
    cloud_point_count: Annotated[int, Whole("", at_least=4, at_most=100)] = 14
    """Points in the random cloud whose hull is a grain."""
    pour_gravity: Annotated[float, Number("m/s2", above=0)] = 9.81
    """Acceleration under which the grains fall; it is then lowered slowly to the one they settle under."""
    settle_gravity: Annotated[float, Number("m/s2", above=0)] | None = None
    """Acceleration under which the bed comes to rest; absent: surface.gravity, which must then point inward."""


class GrainSection(Section):
    """The rock of the grains."""

    density: Density = Field(examples=["2500.0"])
    """Density of the rock."""
    young_modulus: YoungModulus = Field(examples=['{ distribution = "log_uniform", lower = 1e6, upper = 1e8 }'])
    """Young's modulus; expand it over decades with log_uniform."""
    poisson_ratio: PoissonRatio = Field(examples=['{ distribution = "uniform", lower = 0.15, upper = 0.35 }'])
    """Poisson's ratio."""
    restitution: Restitution = Field(examples=['{ distribution = "uniform", lower = 0.3, upper = 0.8 }'])
    """Coefficient of restitution between grains."""
    friction: Friction = Field(examples=['{ distribution = "uniform", lower = 0.3, upper = 0.9 }'])
    """Coefficient of friction."""
    rolling_friction: Friction = 0.0
    """Resistance to rolling: a contact's largest couple over normal force and contact radius."""
    spinning_friction: Friction = 0.0
    """Resistance to spinning about the contact normal, likewise."""
    cohesion_force: Cohesion = 0.0
    """Pull of every contact, whatever its size."""
    surface_energy: SurfaceEnergy = 0.0
    """Pull of a contact in proportion to its radius R*: 4 pi surface_energy R*; lunar soil 0.0029 for clean grains."""


class LanderSection(Section):
    """The lander: a rigid convex body."""

    shape: Literal["box", "sphere", "hull"] = Field(examples=['"box"'])
    """Shape: "box" takes edges, "sphere" takes diameter, "hull" takes file."""
    mass: Annotated[Scalar, MaybeUncertain("kg", above=0)] = Field(examples=["2.6"])
    """Mass."""
    edges: Annotated[tuple[float, float, float], Numbers("m", count=3, above=0)] | None = Field(
        default=None, examples=["[0.1, 0.1, 0.227]"]
    )
    """Edge lengths of a box."""
    diameter: Annotated[Scalar, MaybeUncertain("m", above=0)] | None = None
    """Diameter of a sphere."""
    file: str | None = None
    """Closed mesh (OBJ or STL) whose convex hull is the lander; the path counts from the study file."""
    unit: LengthUnit = "m"
    """Unit of the lengths in the mesh: "m", "km", "cm" or "mm"."""
    inertia: Annotated[tuple[float, float, float], Numbers("kg m2", count=3, above=0)] | None = None
    """Moments of inertia about the axes of the shape, each at most the sum of the other two; absent: those of the
    homogeneous body."""
    young_modulus: YoungModulus | None = None
    """Young's modulus of the lander; absent: that of the grains."""
    poisson_ratio: PoissonRatio | None = None
    """Poisson's ratio of the lander; absent: that of the grains."""
    restitution: Restitution | None = Field(
        default=None, examples=['{ distribution = "uniform", lower = 0.4, upper = 0.9 }']
    )
    """Restitution of the lander's hull; absent: that of the grains."""
    friction: Friction | None = None
    """Friction of the lander's hull; absent: that of the grains."""
    rolling_friction: Friction | None = None
    """Rolling friction of the lander's hull; absent: that of the grains."""
    spinning_friction: Friction | None = None
    """Spinning friction of the lander's hull; absent: that of the grains."""
    cohesion_force: Cohesion | None = None
    """Cohesion of the lander's hull; absent: that of the grains."""
    surface_energy: SurfaceEnergy | None = None
    """Surface energy of the lander's hull; absent: that of the grains."""


class PlaceSection(Section):
    """One place, counted from the middle of the bed."""

    x: Place = 0.0
    """Along the first width."""
    y: Place = 0.0
    """Along the second width."""


class RegionSection(Section):
    """A rectangle, counted from the middle of the bed, in which each run draws its place."""

    x: Interval
    """Smallest and largest x."""
    y: Interval
    """Smallest and largest y."""


class ImpactSection(Section):
    """How the lander arrives."""

    speed: Annotated[Scalar, MaybeUncertain("m/s", above=0, at_most=1000)] = Field(examples=["0.2"])
    """Speed; far below the limit already a contact may be too deep for its law, which is looked at too."""
    incidence_deg: Annotated[Scalar, MaybeUncertain("deg", at_least=0, below=90)] = Field(examples=["30.0"])
    """Angle between the velocity and the mean surface normal; 0 is straight down."""
    azimuth_deg: Annotated[Scalar | str, MaybeUncertain("deg", at_least=-360, at_most=360, word="random")] = 0.0
    """Direction of the horizontal velocity in the bed, from +x; "random" draws it anew for each run."""
    place: PlaceSection | None = None
    """The place of impact, the same for all runs; absent: the middle of the bed."""
    region: RegionSection | None = None
    """In place of `place`: each run draws its place in this rectangle."""
    orientation: Annotated[tuple[float, ...] | str, Numbers("", count=4, word="random")] = (1.0, 0.0, 0.0, 0.0)
    """Attitude as a quaternion w, x, y, z; "random" draws it anew for each run, uniform over rotations."""
    spin_x: Spin = 0.0
    """Angular velocity about the bed's x axis."""
    spin_y: Spin = 0.0
    """Angular velocity about the bed's y axis."""
    spin_z: Spin = 0.0
    """Angular velocity about the bed's z axis."""


class SurfaceSection(Section):
    """The constant acceleration during the touchdown."""

    gravity: Annotated[Scalar | str, MaybeUncertain("m/s2", word="site")] = Field(examples=["5e-5"])
    """Acceleration toward the surface; negative points outward, as it may near the equator of a fast rotator. "site":
    that of gravity and rotation together at the site of the section [site]."""
    slope_deg: Annotated[Scalar, MaybeUncertain("deg", at_least=0, below=90)] = 0.0
    """Angle by which the surface is tilted against the acceleration."""
    slope_azimuth_deg: Angle = 0.0
    """Downhill direction in the bed, from +x."""


class ContactSection(Section):
    """Readings of the contact law."""

    shear_modulus_rule: Literal["mindlin", "paper"] = "mindlin"
    """Effective shear modulus: Mindlin's, or Eq. (8) as the paper prints it."""
    damping_mass: Literal["contact", "paper"] = "contact"
    """Mass in the damping terms: that which the contact point feels, or that of the two whole bodies."""
    pair_rule: Literal["smaller", "mean", "geometric"] = "smaller"
    """Restitution and friction of a pair of materials."""
    steps_per_contact: Annotated[float, Number("", at_least=10, at_most=1000)] = 50.0
    """Time steps in the shortest contact."""


class LandingSection(Section):
    """When a touchdown is given up."""

    time_limit: Annotated[float, Number("s", above=0)] = 60.0
    """Longest simulated time of one touchdown."""


class Study(Section):
    """A landing study."""

    title: str = ""
    """One line about the study."""
    seed: Annotated[int, Whole("", at_least=0, at_most=2**53)] = 1
    """Everything random follows from this number."""
    bed: BedSection
    grain: GrainSection
    lander: LanderSection
    impact: ImpactSection
    surface: SurfaceSection
    contact: ContactSection = ContactSection()
    landing: LandingSection = LandingSection()
    solver: SolverSection = SolverSection()
    campaign: CampaignSection = CampaignSection()
    design: DesignSection = DesignSection()
    monte_carlo: MonteCarloSection = MonteCarloSection()
    site: SiteSection = SiteSection()
    flight: FlightSection = FlightSection()
    rest: RestSection = RestSection()

    def touchdown_values(self) -> dict[str, Scalar]:
        """Every scalar that the touchdown reads, by dotted key, in the units of the file; absent ones are left out."""
        values: dict[str, Scalar] = {}
        for section in ("grain", "lander", "impact", "surface", "solver"):
            values |= _scalars(section, getattr(self, section))
        if self.impact.region is None and self.impact.place is None:
            values |= {"impact.place.x": 0.0, "impact.place.y": 0.0}
        return values

    def site_values(self) -> dict[str, Scalar]:
        """Every scalar that only the flight reads, by dotted key."""
        return _scalars("site", self.site)


def _scalars(path: str, section: BaseModel) -> dict[str, Scalar]:
    values: dict[str, Scalar] = {}
    for name in type(section).model_fields:
        value = getattr(section, name)
        if isinstance(value, float | Uncertain):
            values[f"{path}.{name}"] = value
        elif isinstance(value, PlaceSection):
            values |= _scalars(f"{path}.{name}", value)
        elif isinstance(value, dict):
            values |= {f"{path}.{name}.{key}": entry for key, entry in value.items()}
    return values
