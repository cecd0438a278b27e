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
    """Speed; far below the limit already a contact may be too deep for its law, which is looked at too."""
    incidence_deg: Annotated[Scalar, MaybeUncertain("deg", at_least=0, below=90)] | None = Field(examples=["30.0"])
    """Angle between the velocity and the mean surface normal; 0 is straight down."""
    azimuth_deg: Annotated[Scalar | str, MaybeUncertain("deg", at_least=-360, at_most=360, word="random")] = 0.0
    """Direction of the horizontal velocity in the bed, from +x; "random" draws it anew for each run, which is the
    default of design.method = "drawn"."""
    place: PlaceSection | None = None
    """The place of impact, the same for all runs; absent: the middle of the bed, or as `region` says."""
    region: RegionSection | None = None
    """In place of `place`: each run draws its place in this rectangle. With design.method = "drawn" and neither of
    the two: all over ground that repeats, or wherever the lander is so far from the walls that they do not answer its
    first blow."""
    orientation: Annotated[tuple[float, ...] | str, Numbers("", count=4, word="random")] = (1.0, 0.0, 0.0, 0.0)
    """Attitude as a quaternion w, x, y, z; "random" draws it anew for each run, uniform over rotations, which is the
    default of design.method = "drawn"."""
    pointing_error_deg: Annotated[float, Number("deg", above=0, at_most=180)] | None = None
    """Half the opening of a cone about the lander's z axis, as `orientation` turns it: each run draws where this axis
    points, evenly over the cone, and the lander turns there by the shortest way, without a roll about the axis."""
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
    steps_per_contact: Annotated[float, Number("", at_least=10, at_most=1000)] = 25.0
    """Time steps in each contact, or in the shortest that the impact can make."""
    stepping: Literal["global", "local"] = "local"
    """Steps of a touchdown: "local", each contact at steps of its own, or "global", the same for all contacts, which
    takes several times as long."""
    resolved_speed: Annotated[float, Number("", at_least=0, at_most=1)] = 0.3
    """Collisions slower than this share of the lander's speed take fewer steps than steps_per_contact, in proportion,
    but at least five. 0: all take as many. Only with stepping = "local"."""
    held_speed: Annotated[float, Number("", at_least=0, below=1)] = 0.0
    """Grains that touch something stand still while they are slower than this share of the lander's speed and farther
    from it than the smallest bed keeps clear; a blow that makes them faster frees them. 0: none do. Only with
    stepping = "local"."""


class LandingSection(Section):
    """When a touchdown is given up."""

    time_limit: Annotated[float, Number("s", above=0)] = 60.0
    """Longest simulated time of one touchdown."""
