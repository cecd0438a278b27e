"""The tables of the study file that say how the lander arrives, and how its contact with the soil is worked out."""

from typing import Annotated, Literal

from pydantic import Field

from lithobrake.study.quantity import Angle, MaybeUncertain, Number, Numbers, Scalar, Section

Interval = Annotated[tuple[float, float], Numbers("m", count=2, ascending=True)]
Place = Annotated[Scalar, MaybeUncertain("m")]
Spin = Annotated[Scalar, MaybeUncertain("rad/s")]


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
    azimuth_deg: Annotated[Scalar | str, MaybeUncertain("deg", at_least=-360, at_most=360, word="random")] = 0.0
    """Direction of the horizontal velocity in the bed, from +x. "random", the default of design.method = "drawn": it is
    sampled for each run."""
    place: PlaceSection | None = None
    """Impact point, the same for all runs. Absent: the middle of the bed, or as `region` states."""
    region: RegionSection | None = None
    """Instead of `place`: the impact point of each run is sampled in this rectangle. With design.method = "drawn" and
    neither of the two, it is sampled over the whole bed if the ground repeats; between walls, where it is so far from
    the walls that they do not affect the first impact."""
    orientation: Annotated[tuple[float, ...] | str, Numbers("", count=4, word="random")] = (1.0, 0.0, 0.0, 0.0)
    """Attitude as a quaternion w, x, y, z. "random", the default of design.method = "drawn": it is sampled for each
    run, uniformly over rotations."""
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

    gravity: Annotated[Scalar | str, MaybeUncertain("m/s2", word="site")] = Field(examples=["5e-5"])
    """Acceleration toward the surface. A negative value points outward, as is possible near the equator of a fast
    rotator. "site": that of gravity and rotation together at the site of [site]."""
    slope_deg: Annotated[Scalar, MaybeUncertain("deg", at_least=0, below=90)] = 0.0
    """Angle by which the surface is tilted relative to the acceleration."""
    slope_azimuth_deg: Angle = 0.0
    """Downhill direction in the bed, from +x."""


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
    held_speed: Annotated[float, Number("", at_least=0, below=1)] = 0.0
    """Grains in contact are frozen while they are slower than this fraction of the lander's speed and farther from it
    than the walls of the smallest bed would be. An impact that makes them faster releases them. 0: no grain is frozen.
    Only with stepping = "local"."""


class LandingSection(Section):
    """When the simulation of a touchdown stops."""

    time_limit: Annotated[float, Number("s", above=0)] = 60.0
    """Longest simulated time of one touchdown."""
