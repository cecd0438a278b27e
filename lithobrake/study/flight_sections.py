"""The tables of the study file that say where a lander comes down and how it is followed from there."""

from typing import Annotated, Literal

from pydantic import Field, Strict

from lithobrake.study.quantity import (
    Angle,
    LengthUnit,
    MaybeUncertain,
    Number,
    Numbers,
    Scalar,
    Section,
    Whole,
)

BUILT_IN_BODIES = ("didymos", "dimorphos")


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
    """Whether the partner of a built-in body attracts and may be hit; false: the body is alone, as in the paper."""
    partner_longitude_deg: Angle | None = None
    """East longitude over which the partner is when the lander leaves. Absent: unknown, sampled over the circle."""
    mass: Annotated[Scalar, MaybeUncertain("kg", above=0)] | None = None
    """Mass of the body; absent: that of the built-in body."""
    spin_period: Annotated[Scalar, MaybeUncertain("s", above=0)] | None = None
    """Spin period of the body; absent: that of the kernels, or of the built-in body."""
    rotation: RotationSection | None = None
    rotation_time: Annotated[Scalar, MaybeUncertain("s", at_least=0)] | None = None
    """Time from the initial state of site.rotation to the arrival of the lander. Absent: sampled uniformly over its
    days."""
    kernels: list[str] = Field(default=[])
    """Kernels of SPICE, relative to the study file, from which the spin is read: text constants (PCK); with an epoch
    also leap seconds (LSK) and an ephemeris of body and partner (SPK)."""
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
    is the rms gradient. A gradient in a random direction is sampled for each touchdown of a journey; without [journey],
    for each impact after the first, and on hard ground for each impact. Absent: the facets are flat."""
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

    duration: Annotated[float, Number("s", above=0)] = 43_200.0
    """Longest flight."""
    flight_count: Annotated[int, Whole("", at_least=1)] | None = Field(default=None, examples=["1000"])
    """Number of samples whose flights are computed, the first ones that leave the surface. Absent: all."""
    gravity: Literal["exact", "table"] = "table"
    """Gravity of the polyhedron. "exact": summed over its facets. "table": from a table that is made once for each
    shape, some 30 times faster; its error is reported."""


class RestSection(Section):
    """Landers followed from bounce to bounce until they rest: on the soil, by the emulator or the expansion, and on
    hard ground for comparison.

    On the soil, impacts after the first need impact.speed and impact.incidence_deg to be uncertain; an impact outside
    the range of the runs ends the trajectory. On hard ground every impact has the same restitution and friction; the
    defaults are in the middle of the values in the literature, and are not measured. On both, a captured lander slides
    until it rests or leaves the ground again."""

    count: Annotated[int, Whole("", at_least=0)] = Field(default=10_000, examples=["1000"])
    """Number of samples that are followed, the first ones; 0: none."""
    duration: Annotated[float, Number("s", above=0)] = 86_400.0
    """Longest journey, counted from the first impact."""
    arc_count: Annotated[int, Whole("", at_least=0, at_most=300)] = 100
    """Number of these samples, the first ones, whose flights on the soil are stored for exports; 0: none."""
    normal_restitution: Annotated[float, Number("", at_least=0, at_most=1)] = 0.6
    """Hard ground: outgoing divided by incoming speed along the normal."""
    tangential_restitution: Annotated[float, Number("", at_least=0, at_most=1)] = 0.8
    """Hard ground: the same along the ground, unless friction limits the change."""
    friction: Annotated[float, Number("", at_least=0)] = 0.6
    """Hard ground: largest change of the velocity along the ground divided by that along the normal; also the friction
    of a sliding lander."""
    rest_height: Annotated[float, Number("m", above=0)] = 0.01
    """Hard ground: a lander stops bouncing when its rebound would rise less than this."""
    rolling_friction: Annotated[float, Number("", at_least=0)] | None = None
    """Every ground: resistance divided by the normal force, for a captured lander that rolls like a sphere. Absent: it
    slides, on hard ground with the friction above, on soil with one that follows from the friction of its hull."""
