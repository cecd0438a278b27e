"""The grounds on which a lander may lie: of the body about which it flies, and of the other body of a binary.

Flights are given along axes fixed to the first body wherever they begin and end; a lander on the partner is given
along the partner's own axes, which turn with its ground.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lithobrake.smallbody import rotation
from lithobrake.vocabulary.array_types import Array, Integers
from lithobrake.vocabulary.constants import GRAVITATIONAL_CONSTANT
from lithobrake.vocabulary.outcomes import FlightStatus

if TYPE_CHECKING:
    from lithobrake.smallbody.acceleration import Orbit
    from lithobrake.smallbody.body import Body, Partner
    from lithobrake.vocabulary.array_types import Floats

# How a flight ends on the ground of a body, and on that of its partner: in the order of `grounds_of`.
LANDED = (FlightStatus.IMPACT, FlightStatus.PARTNER)


class Moments(NamedTuple):
    """Times [s] as of `fly`, and mass [kg] and spin_period [s] of the first body in each flight; [count] each."""

    time: Array
    mass: Array
    spin_period: Array

    def at(self, which: Integers) -> "Moments":
        """Some of them."""
        return Moments(*(one[which] for one in self))


@dataclass(frozen=True)
class BodyGround:
    """The ground of the first body, whose axes are those of the flights."""

    body: "Body"

    def own(self, when: Moments) -> tuple[Array, Array]:
        """Mass [kg] and spin period [s] of the body that has this ground, [count] each."""
        return when.mass, when.spin_period

    def felt(self, points: Array, when: Moments) -> Array:
        """Acceleration of what rests at points on the ground [m], [m/s2], both [count, 3], fixed to it."""
        return self.body.felt(points, *when)

    def spin(self, when: Moments) -> Array:
        """Angular velocity of the ground against the stars [rad/s], [count, 3], fixed to it."""
        return rotation.ground_spin(self.body.rotation, when.time, when.spin_period)

    def states_of_flights(self, position: Array, velocity: Array, when: Moments) -> tuple[Array, Array]:
        """States along the axes of flights from those along the axes of the ground: [m], [m/s], all [count, 3]."""
        return position, velocity

    def states_on_ground(self, position: Array, velocity: Array, when: Moments) -> tuple[Array, Array]:
        """The reverse of `states_of_flights`."""
        return position, velocity

    def turns(self, when: Moments) -> Array | None:
        """Matrices [count, 3, 3] that turn components along axes of flights into those along axes of the ground."""
        return None


@dataclass(frozen=True)
class PartnerGround(BodyGround):
    """The ground of the partner, along the axes that turn with it; around: the first body."""

    around: "Body"

    def own(self, when: Moments) -> tuple[Array, Array]:
        return np.full_like(when.mass, self.body.mass), np.full_like(when.mass, self.body.spin_period)

    def felt(self, points: Array, when: Moments) -> Array:
        """Gravity and rotation of the partner, and the tide of the first body as a point."""
        still = np.zeros_like(points)
        centre, _ = self._orbit(when).seen_from_partner(still, still, when.time)
        way = centre - points
        near, mean = (one / np.linalg.norm(one, axis=1, keepdims=True) ** 3 for one in (way, centre))
        tide = (GRAVITATIONAL_CONSTANT * when.mass)[:, None] * (near - mean)
        found: Array = self.body.effective_acceleration(points) + tide
        return found

    def spin(self, when: Moments) -> Array:
        return rotation.ground_spin(None, when.time, self.own(when)[1])

    def states_of_flights(self, position: Array, velocity: Array, when: Moments) -> tuple[Array, Array]:
        uniform = self._orbit(when).seen_from_body(position, velocity, when.time)
        return rotation.out_of_frame(self.around.rotation, *uniform, when.time)

    def states_on_ground(self, position: Array, velocity: Array, when: Moments) -> tuple[Array, Array]:
        uniform = rotation.into_frame(self.around.rotation, position, velocity, when.time)
        return self._orbit(when).seen_from_partner(*uniform, when.time)

    def turns(self, when: Moments) -> Array:
        orbit = self._orbit(when)
        angle = orbit.attitude + orbit.swing * when.time
        c, s, zero, one = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
        turns = np.stack([c, s, zero, -s, c, zero, zero, zero, one], axis=1).reshape(-1, 3, 3)
        if self.around.rotation is None:
            return turns
        # Not by a matrix product, whose rounding depends on how many rows there are.
        axes = self.around.rotation.at(when.time).axes
        found: Array = (turns[:, :, :, None] * axes[:, None, :, :]).sum(axis=2)
        return found

    def _orbit(self, when: Moments) -> "Orbit[Floats]":
        return self.around.orbit_with(GRAVITATIONAL_CONSTANT * when.mass, 2.0 * np.pi / when.spin_period)


def grounds_of(body: "Body") -> tuple[BodyGround, ...]:
    """The grounds on which landers about a body come down, its own first; none of a partner that is a planet."""
    partner: Partner | None = body.partner
    if partner is None or partner.is_planet:
        return (BodyGround(body),)
    return BodyGround(body), PartnerGround(partner.body, body)
