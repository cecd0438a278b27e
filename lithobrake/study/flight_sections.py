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
    """How a body turns that does not keep one face to its partner, as Dimorphos may since the impact of DART: its
    start, after which Euler's equations of a rigid body under the partner's torque hold."""

    yaw_deg: Annotated[float, Number("deg", at_least=-180, at_most=180)] = Field(0.0, examples=["30.0"])
    """Turn about z, the axis of the orbit, at the start, away from the attitude that keeps one face to the partner."""
    pitch_deg: Annotated[float, Number("deg", at_least=-90, at_most=90)] = 0.0
    """Turn about the new y after it."""
    roll_deg: Annotated[float, Number("deg", at_least=-180, at_most=180)] = 0.0
    """Turn about the newest x, the long axis, after these."""
    spin: Annotated[tuple[float, ...], Numbers("rad/s", at_least=-2e-3, at_most=2e-3)] = (0.0, 0.0, 0.0)
    """Angular velocity at the start along the body's x, y and z, beside the one that keeps pace with the orbit."""
    days: Annotated[float, Number("d", above=0, at_most=1000)] = 30.0
    """Time from the start over which landers arrive."""


class SiteSection(Section):
    """Where on which body the lander touches down. Uncertain values here vary in the Monte Carlo only."""

    body: str = "didymos"
    """"didymos" or "dimorphos" (built in, in any case), or a closed mesh (OBJ, STL, PDS plates, ICQ or a shape kernel
    of SPICE) around the body's centre; the path counts from the study file."""
    extents: Annotated[tuple[float, float, float], Numbers("m", count=3, above=0)] | None = None
    """Extents of a built-in body along its axes x, y and z, in place of its own; write site.mass too."""
    name: str | None = None
    """Name of the body of a mesh, for report and exports; absent: it has none."""
    unit: LengthUnit | None = None
    """Unit of the lengths in the mesh: "m", "km", "cm" or "mm"; absent: what its header or label says, else metres."""
    gravity_facets: Annotated[int, Whole("", at_least=100)] | None = None
    """Facets that gravity is summed over; a mesh that has more is thinned for that, keeping volume and centroid, and
    stays as it is for the ground. Absent: all."""
    partner: Annotated[bool, Strict()] = True
    """Whether the partner of a built-in body attracts and may be hit; false: the body is alone, as in the paper."""
    partner_longitude_deg: Angle | None = None
    """East longitude over which the partner stands when the lander leaves; absent: not known, drawn over the circle."""
    mass: Annotated[Scalar, MaybeUncertain("kg", above=0)] | None = None
    """Mass of the body; absent: that of the built-in body."""
    spin_period: Annotated[Scalar, MaybeUncertain("s", above=0)] | None = None
    """Spin period of the body; absent: that of the kernels, or of the built-in body."""
    rotation: RotationSection | None = None
    rotation_time: Annotated[Scalar, MaybeUncertain("s", at_least=0)] | None = None
    """Time since the start of site.rotation at which the lander arrives; absent: drawn evenly over its days."""
    kernels: list[str] = Field(default=[])
    """Kernels of SPICE, counted from the study file, from which the spin is read: text constants (PCK); with an epoch
    also leap seconds (LSK) and an ephemeris of body and partner (SPK)."""
    kernel_body: str | None = None
    """Name of the body in the kernels, or its number as text; absent: that of the built-in body."""
    epoch: str | None = None
    """UTC date and time of the touchdown, "2027-01-20T12:00:00": the partner stands where the kernels have it then."""
    pole_right_ascension_deg: Annotated[float, Number("deg", at_least=-360, at_most=360)] | None = None
    """Right ascension, in ICRF, of the pole about which the body turns counter-clockwise."""
    pole_declination_deg: Annotated[float, Number("deg", at_least=-90, at_most=90)] | None = None
    """Declination of that pole."""
    meridian_deg: Annotated[float, Number("deg", at_least=-360, at_most=360)] | None = None
    """Angle W of longitude 0 at delivery.epoch, or, without one, at the epoch of an export, from the node of the body's
    equator on that of ICRF, eastward."""
    roughness_deg: Annotated[float, Number("deg", at_least=0, at_most=60)] | None = None
    """Rms slope of the ground at the lander's scale against the facets of the body's shape: the angle whose tangent is
    the rms gradient. Each touchdown of a journey draws its gradient, in any direction; without [journey] so does each
    impact after the first, and on hard ground each impact. Absent: the facets are flat."""
    latitude_deg: Annotated[Scalar, MaybeUncertain("deg", at_least=-90, at_most=90)] = 0.0
    """Latitude, planetocentric."""
    longitude_deg: Angle = 0.0
    """Longitude, east."""
    heading_deg: Angle = 0.0
    """Direction of the incoming horizontal velocity, from north toward east."""
    north_error: Annotated[Scalar, MaybeUncertain("m")] = 0.0
    """How far the delivery misses the site toward north: a way over the ground, as if the body were a ball of the
    radius at the site; at most a quarter of the way round."""
    east_error: Annotated[Scalar, MaybeUncertain("m")] = 0.0
    """The same toward east."""


class FlightSection(Section):
    """The flight from the bounce to the next impact."""

    duration: Annotated[float, Number("s", above=0)] = 43_200.0
    """Longest flight."""
    flight_count: Annotated[int, Whole("", at_least=1)] | None = Field(default=None, examples=["1000"])
    """How many samples fly (the first ones that leave the surface); absent: all."""
    gravity: Literal["exact", "table"] = "table"
    """Gravity of the polyhedron: summed over its facets, or from a table that is built once for a shape, whose error is
    told; the table is some 30 times faster."""


class RestSection(Section):
    """From bounce to bounce until a lander rests: on the soil, by the expansion, and on hard ground for comparison.

    The soil is asked again at each impact where impact.speed and impact.incidence_deg are both uncertain; an impact
    outside the range of the runs ends the journey there. Hard ground answers every impact, the first among them, with
    the same restitution and friction; the defaults are in the middle of what is used, not measured. On either, what is
    captured slides on until it rests or leaves the ground again."""

    count: Annotated[int, Whole("", at_least=0)] = Field(default=10_000, examples=["1000"])
    """How many samples are followed, the first ones; 0: none."""
    duration: Annotated[float, Number("s", above=0)] = 86_400.0
    """Longest journey, counted from the first impact."""
    arc_count: Annotated[int, Whole("", at_least=0, at_most=300)] = 100
    """Of how many of these samples, the first ones, each flight on the soil is noted, to be passed on; 0: none."""
    normal_restitution: Annotated[float, Number("", at_least=0, at_most=1)] = 0.6
    """Hard ground: outgoing over incoming speed along the normal."""
    tangential_restitution: Annotated[float, Number("", at_least=0, at_most=1)] = 0.8
    """Hard ground: the same along the ground, unless friction takes less."""
    friction: Annotated[float, Number("", at_least=0)] = 0.6
    """Hard ground: largest loss along the ground over the change along the normal, and of what slides."""
    rest_height: Annotated[float, Number("m", above=0)] = 0.01
    """Hard ground: a lander bounces no more where its rebound would rise less than this."""
    rolling_friction: Annotated[float, Number("", at_least=0)] | None = None
    """Every ground: resistance, over the force on the ground, of a captured lander that rolls on like a ball; absent:
    it slides, on hard ground with the friction above, on soil with one that follows from that of its hull."""
