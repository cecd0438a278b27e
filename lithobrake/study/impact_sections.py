"""The tables of the study file that say where and how the lander comes down, and how it is followed."""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, Strict

from lithobrake.study.quantity import Angle, LengthUnit, MaybeUncertain, Number, Numbers, Scalar, Section, Whole

if TYPE_CHECKING:
    pass

# Grains that barely move are held still in a slow touchdown, which costs a third less and changes no statistic of it
# (docs/decisions/touchdown.md).
HELD_SPEED = 0.03
# So many together stay where the resolution of a time is 0.1 ms [s].
LATEST = 1e11
Interval = Annotated[tuple[float, float], Numbers("m", count=2, ascending=True)]
Place = Annotated[Scalar, MaybeUncertain("m")]
Spin = Annotated[Scalar, MaybeUncertain("rad/s")]
# No body of rubble turns faster than once in ten minutes.
Rotation = Annotated[Scalar, MaybeUncertain("rad/s", at_least=-0.01, at_most=0.01)]


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

    speed: Annotated[Scalar, MaybeUncertain("m/s", above=0, at_most=1000)] | None = Field(examples=["0.2"])
    """Speed. A contact may be too deep for the contact law even far below the limit; this is checked too."""
    incidence_deg: Annotated[Scalar, MaybeUncertain("deg", at_least=0, below=90)] | None = Field(examples=["30.0"])
    """Angle between the velocity and the mean surface normal; 0 is straight down."""
    azimuth_deg: Annotated[Scalar | str, MaybeUncertain("deg", at_least=-360, at_most=360, word="random")] = "random"
    """Direction of the horizontal velocity in the bed, from +x. "random": it is sampled for each run."""
    place: PlaceSection | None = None
    """Impact point, the same for all runs. Absent: as `region` states."""
    region: RegionSection | None = None
    """Instead of `place`: the impact point of each run is sampled in this rectangle. With neither
    of the two, it is sampled over the whole bed if the ground repeats; between walls, where it is so far from
    the walls that they do not affect the first impact."""
    orientation: Annotated[tuple[float, ...] | str, Numbers("", count=4, word="random")] = "random"
    """Attitude as a quaternion w, x, y, z. "random": it is sampled for each run, uniformly over rotations."""
    pointing_error_deg: Annotated[float, Number("deg", above=0, at_most=180)] | None = None
    """Half the opening angle of a cone about the lander's z axis, as `orientation` turns it. The direction of this axis
    is sampled for each run, uniformly over the cone; the lander turns there by the shortest rotation, without a roll
    about the axis."""
    spin_x: Spin = 0.0
    """Angular velocity about the bed's x axis."""
    spin_y: Spin = 0.0
    """Angular velocity about the bed's y axis."""
    spin_z: Spin = 0.0
    """Angular velocity about the bed's z axis."""


class SurfaceSection(Section):
    """The constant acceleration during the touchdown."""

    gravity: Annotated[Scalar | str, MaybeUncertain("m/s2", word="site")] = Field(default="site", examples=["5e-5"])
    """Acceleration toward the surface. "site": that of gravity and rotation together where each touchdown is, with the
    slope there. A number, only with journey.touchdowns = 1: the same for all first touchdowns, with slope_deg; a
    negative value points outward, as is possible near the equator of a fast rotator."""
    slope_deg: Annotated[Scalar, MaybeUncertain("deg", at_least=0, below=90)] = 0.0
    """Angle by which the surface is tilted relative to the acceleration."""
    slope_azimuth_deg: Angle = 0.0
    """Downhill direction in the bed, from +x."""
    rotation_x: Rotation = 0.0
    """Angular velocity of the ground about the bed's x axis, for the Coriolis acceleration. With gravity = "site" it is
    that of the body where each touchdown is."""
    rotation_y: Rotation = 0.0
    """Angular velocity of the ground about the bed's y axis."""
    rotation_z: Rotation = 0.0
    """Angular velocity of the ground about the bed's z axis."""


class ContactSection(Section):
    """Options of the contact law."""

    shear_modulus_rule: Literal["mindlin", "paper"] = "mindlin"
    """Effective shear modulus: Mindlin's, or Eq. (8) as printed in the paper."""
    damping_mass: Literal["contact", "paper"] = "contact"
    """Mass in the damping terms: "contact", the effective mass at the contact point, or "paper", that of the two whole
    bodies."""
    pair_rule: Literal["smaller", "mean", "geometric"] = "smaller"
    """Restitution and friction of a contact: the smaller value of its two materials, their mean, or their geometric
    mean."""
    steps_per_contact: Annotated[float, Number("", at_least=10, at_most=1000)] = 25.0
    """Time steps in each contact, or with stepping = "global" in the shortest contact of the impact."""
    stepping: Literal["global", "local"] = "local"
    """Time steps of a touchdown. "local": each contact has steps of its own. "global": all contacts have the same
    steps, which takes several times as long."""
    resolved_speed: Annotated[float, Number("", at_least=0, at_most=1)] = 0.3
    """Collisions slower than this fraction of the lander's speed take fewer steps than steps_per_contact, in proportion
    to their speed, but at least five. 0: all collisions take the same number of steps. Only with stepping = "local"."""
    held_speed: Annotated[float, Number("", at_least=0, below=1)] = HELD_SPEED
    """Grains in contact are frozen while they are slower than half of this fraction of the lander's speed and farther
    from it than the walls of the smallest bed would be. Once the lander has left the contacts of an impact behind, or
    is too slow to leave, those near it are frozen, too, below five times the fraction. An impact that makes them faster
    than the fraction releases them. 0: no grain is frozen. With stepping = "global" 0 is the default and the only
    value."""


class LandingSection(Section):
    """When the simulation of a touchdown stops."""

    time_limit: Annotated[float, Number("s", above=0, at_most=LATEST)] | None = None
    """Longest simulated time of one touchdown. Absent: what is left of journey.duration; with journey.hop_height = 0,
    60 s."""


class RotationSection(Section):
    """Rotation of a body that does not keep one face to its partner, as may be the case for Dimorphos since the impact
    of DART. The keys give the initial state; Euler's equations of a rigid body under the partner's torque give the
    rest."""

    yaw_deg: Annotated[float, Number("deg", at_least=-180, at_most=180)] = Field(0.0, examples=["30.0"])
    """Initial rotation about z, the axis of the orbit, from the attitude that keeps one face to the partner."""
    pitch_deg: Annotated[float, Number("deg", at_least=-90, at_most=90)] = 0.0
    """Then the rotation about the new y."""
    roll_deg: Annotated[float, Number("deg", at_least=-180, at_most=180)] = 0.0
    """Then the rotation about the newest x, the long axis."""
    spin: Annotated[tuple[float, ...], Numbers("rad/s", at_least=-2e-3, at_most=2e-3)] = (0.0, 0.0, 0.0)
    """Initial angular velocity along the body's x, y and z, in addition to one turn per orbit."""
    days: Annotated[float, Number("d", above=0, at_most=1000)] = 30.0
    """Time span, from the initial state, in which landers arrive."""


class PartnerSection(Section):
    """The partner of a body that is read from a mesh, the other body of a binary or a planet: a sphere or a spheroid on
    a circular orbit in the plane of the equator, which attracts and may be hit. Landers continue on it; on a planet
    their journeys end. `period` or `distance` gives the orbit; with neither the body keeps one face to its partner,
    over longitude 0."""

    name: str = "partner"
    """Name of the partner."""
    mass: Annotated[float, Number("kg", above=0, at_most=1e31)] = Field(examples=["5.3e11"])
    """Mass of the partner."""
    diameter: Annotated[float, Number("m", above=0, at_most=1e10)] = Field(examples=["780.0"])
    """Diameter of the partner, at its equator."""
    polar_diameter: Annotated[float, Number("m", above=0, at_most=1e10)] | None = None
    """Diameter along its spin axis. Absent: that of the equator, a sphere."""
    spin_period: Annotated[float, Number("s", at_least=1, at_most=1e12)] | None = None
    """Spin period of the partner, about the axis of the orbit. Absent: it keeps one face to the body."""
    period: Annotated[float, Number("s", above=0, at_most=1e12)] | None = None
    """Period of the orbit. Absent: it follows from `distance`, or is the spin period."""
    distance: Annotated[float, Number("m", above=0, at_most=1e12)] | None = None
    """Distance of the two centres, the semi-major axis of the orbit."""


class SiteSection(Section):
    """The body, and the site on it where the lander touches down. Uncertain values here vary only in the Monte Carlo
    samples."""

    body: str = "didymos"
    """"didymos" or "dimorphos" (built in, in any case), or a closed mesh (OBJ, STL, PDS plates, ICQ or a shape kernel
    of SPICE) around the body's centre; the path is relative to the study file."""
    extents: Annotated[tuple[float, float, float], Numbers("m", count=3, above=0)] | None = None
    """Extents of a built-in body along its axes x, y and z, instead of its own; give site.mass too."""
    name: str | None = None
    """Name of the body of a mesh, for report and exports. Absent: no name."""
    unit: LengthUnit | None = None
    """Unit of the lengths in the mesh: "m", "km", "cm" or "mm"; absent: that of its header or label, otherwise
    metres."""
    gravity_facets: Annotated[int, Whole("", at_least=100)] | None = None
    """Number of facets for the gravity. A mesh with more facets is simplified for this purpose, with the same volume
    and centroid; the ground keeps the whole mesh. Absent: all facets."""
    partner: Annotated[bool, Strict()] = True
    """Whether the partner of a built-in body attracts and may be hit; false: the body is alone, as in the paper. For a
    mesh `partner_body` gives it; false confirms that there is none."""
    partner_body: PartnerSection | None = None
    partner_longitude_deg: Angle | None = None
    """East longitude over which the partner is when the lander leaves. Absent: unknown, sampled over the circle; 0 of a
    body that keeps one face to its partner."""
    mass: Annotated[Scalar, MaybeUncertain("kg", above=0)] | None = None
    """Mass of the body; absent: that of `density`, or of the built-in body."""
    density: Annotated[Scalar, MaybeUncertain("kg/m3", above=0)] | None = None
    """Bulk density of the body, instead of its mass, which is this times the volume of the shape."""
    spin_period: Annotated[Scalar, MaybeUncertain("s", above=0)] | None = None
    """Spin period of the body; absent: that of the kernels, or of the built-in body."""
    rotation: RotationSection | None = None
    rotation_time: Annotated[Scalar, MaybeUncertain("s", at_least=0)] | None = None
    """Time from the initial state of site.rotation to the arrival of the lander. Absent: sampled uniformly over its
    days."""
    kernels: list[str] = Field(default=[])
    """Kernels of SPICE, relative to the study file, from which the spin is read: text constants (PCK); with an epoch
    also an ephemeris of body and partner (SPK). A meta-kernel counts with the kernels that it names."""
    kernel_body: str | None = None
    """Name of the body in the kernels, or its number as text; absent: that of the built-in body."""
    epoch: str | None = None
    """UTC date and time of the touchdown, for example "2027-01-20T12:00:00"; the kernels give the position of the
    partner then."""
    pole_right_ascension_deg: Annotated[float, Number("deg", at_least=-360, at_most=360)] | None = None
    """Right ascension, in ICRF, of the pole about which the body rotates counter-clockwise."""
    pole_declination_deg: Annotated[float, Number("deg", at_least=-90, at_most=90)] | None = None
    """Declination of that pole."""
    meridian_deg: Annotated[float, Number("deg", at_least=-360, at_most=360)] | None = None
    """Angle W of longitude 0 at delivery.epoch or, without one, at the epoch of an export: eastward from the node of
    the body's equator on the equator of ICRF."""
    roughness_deg: Annotated[float, Number("deg", at_least=0, at_most=60)] | None = None
    """Rms slope of the ground at the lander's scale relative to the facets of the body's shape: the angle whose tangent
    is the rms gradient. A gradient in a random direction is sampled for each touchdown. Absent: the facets are flat."""
    latitude_deg: Annotated[Scalar, MaybeUncertain("deg", at_least=-90, at_most=90)] = 0.0
    """Latitude, planetocentric."""
    longitude_deg: Angle = 0.0
    """Longitude, east."""
    heading_deg: Angle = 0.0
    """Direction of the incoming horizontal velocity, from north toward east."""
    north_error: Annotated[Scalar, MaybeUncertain("m")] = 0.0
    """Distance over the ground by which the delivery misses the site toward north, on a sphere with the radius at the
    site; at most a quarter of its circumference."""
    east_error: Annotated[Scalar, MaybeUncertain("m")] = 0.0
    """The same toward east."""


class FlightSection(Section):
    """The flight from the bounce to the next impact."""

    duration: Annotated[float, Number("s", above=0, at_most=LATEST)] = 43_200.0
    """Longest flight."""
    flight_count: Annotated[int, Whole("", at_least=1)] | None = Field(default=None, examples=["1000"])
    """Number of samples whose flights are computed, the first ones that leave the surface. Absent: all."""
    gravity: Literal["exact", "table"] = "table"
    """Gravity of the polyhedron. "exact": summed over its facets. "table": from a table that is made once for each
    shape, some 30 times faster; its error is reported."""


class HardGroundSection(Section):
    """The same landers on hard ground, for comparison: every impact has the same restitution and friction. The defaults
    are in the middle of the values in the literature, and are not measured. With an emulator they are also followed on
    hard ground that is equivalent to the soil, with restitutions and directions sampled from the emulator. A captured
    lander slides until it rests or leaves the ground again."""

    count: Annotated[int, Whole("", at_least=0, at_most=1_000_000)] = Field(default=0, examples=["10_000"])
    """Number of landers that are followed on it; 0: none."""
    normal_restitution: Annotated[float, Number("", at_least=0, at_most=1)] = 0.6
    """Outgoing divided by incoming speed along the normal."""
    tangential_restitution: Annotated[float, Number("", at_least=0, at_most=1)] = 0.8
    """The same along the ground, unless friction limits the change."""
    friction: Annotated[float, Number("", at_least=0)] = 0.6
    """Largest change of the velocity along the ground divided by that along the normal; also the friction of a sliding
    lander."""
    rest_height: Annotated[float, Number("m", above=0)] = 0.01
    """A lander stops bouncing when its rebound would rise less than this."""
    rolling_friction: Annotated[float, Number("", at_least=0)] | None = None
    """Resistance divided by the normal force, for a captured lander that rolls like a sphere. Absent: it slides."""
