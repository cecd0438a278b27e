"""Parts of a lander that hang on it by a hinge, and the hinge that stands for the bending of a boom."""

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from lithobrake.dem import Part, RigidBody, inertia_about, new_body
from lithobrake.vocabulary.array_types import Vector
from lithobrake.vocabulary.field_errors import FieldError, field_number, field_numbers, value_within

LARGEST_LIMIT = 0.5 * math.pi
# First root of cos(x) cosh(x) = -1, by which a clamped beam bends.
FIRST_ROOT = 1.8751040687119611
# Of the length of a clamped beam: the rigid link that stands for it, whose tip has a quarter of the beam's mass.
LINK = 0.75


@dataclass(frozen=True)
class Hinge:
    """An elastic hinge: where it is, in the axes of the lander, how stiff, how damped, and how far it bends.

    stiffness: about every axis. limit: bend beyond which an elastic stop acts. Raises ValueError for values outside
    their ranges.
    """

    point: Vector  # m
    stiffness: float  # N m/rad
    damping_ratio: float  # of the part's motion on a lander that is held
    limit: float = LARGEST_LIMIT  # rad

    def __post_init__(self) -> None:
        field_numbers("Hinge.point", self.point, 3, "are three finite numbers", "m")
        field_number("Hinge.stiffness", self.stiffness, "is a finite value above 0", "N m/rad", above=0.0)
        for name, value, most, unit in (
            ("damping_ratio", self.damping_ratio, 1.0, ""), ("limit", self.limit, LARGEST_LIMIT, "rad"),
        ):  # fmt: skip
            allowed = value_within(0.0, most)
            if not 0.0 <= field_number(f"Hinge.{name}", value, allowed, unit) <= most:
                raise FieldError(f"Hinge.{name}", value, allowed, unit=unit)


@dataclass(frozen=True, eq=False)
class HingedPart(Part):
    """A convex part that hangs on the lander by a hinge; its shape stands in the axes of the lander."""

    hinge: Hinge = field(kw_only=True)

    @property
    def body(self) -> RigidBody:
        """The part as a body of its own, of uniform mass."""
        return new_body(self.shape, self.material, None, None)


def hinge_stiffness(part: Part, point: Vector, frequency: float) -> float:
    """Return the stiffness [N m/rad] of a hinge at a point [m] on which a part swings at a frequency [Hz].

    About the axis of its largest moment of inertia there, on a lander that is held.
    """
    body = new_body(part.shape, part.material, None, None)
    inertia = inertia_about(body, np.array(point) - body.centre_of_mass)
    return (2.0 * math.pi * frequency) ** 2 * float(np.linalg.eigvalsh(inertia)[-1])


class BeamLink(NamedTuple):
    """A rigid link on a hinge that moves as the first mode of a clamped beam: LINK of its length and mass, at its end.

    Its tip has the effective mass of that mode there, a quarter of the beam's. The rest of the beam, at its root, moves
    with what it is clamped to.
    """

    length: float  # m
    mass: float  # kg
    stiffness: float  # N m/rad, of the hinge
    frequency: float  # Hz, first of the clamped beam


def beam_frequency(length: float, mass: float, bending_stiffness: float) -> float:
    """Return the first frequency [Hz] of a uniform beam clamped at one end.

    length [m], mass [kg], bending_stiffness: Young's modulus times second moment of area [N m2].
    Source: [Blevins-1979], table 8-1.
    """
    return FIRST_ROOT**2 / (2.0 * math.pi) * math.sqrt(bending_stiffness / (mass * length**3))


def beam_link(length: float, mass: float, frequency: float) -> BeamLink:
    """Return the link and hinge for a uniform boom of a length [m], a mass [kg] and a first frequency [Hz].

    The hinge stands a quarter of the length from the clamp. A steady force bends the tip of the link by 3 % less than
    that of the beam. Raises ValueError for values that are not positive.
    """
    for name, value, unit in (("length", length, "m"), ("mass", mass, "kg"), ("frequency", frequency, "Hz")):
        field_number(f"beam_link {name}", value, "is a finite value above 0", unit, above=0.0)
    inertia = (LINK * mass) * (LINK * length) ** 2 / 3.0
    return BeamLink(LINK * length, LINK * mass, (2.0 * math.pi * frequency) ** 2 * inertia, frequency)
