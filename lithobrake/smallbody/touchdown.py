"""Who answers a touchdown: impacts of landers in, and how each of them ends out."""

from dataclasses import dataclass, field, fields
from typing import Protocol

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.vocabulary.array_types import Array, Integers
from lithobrake.vocabulary.outcomes import JourneyEnd, TouchdownOutcome
from lithobrake.vocabulary.quantities import UNKNOWN_END

FAILED = JourneyEnd.FAILED.value
# As wide as the longest word of an outcome: NumPy cuts longer ones without notice.
WORD = f"<U{max(map(len, (*TouchdownOutcome, FAILED, UNKNOWN_END)))}"


def into_frame(axes: Array, vectors: Array) -> Array:
    """Vectors fixed to the body in frames with these axes in rows; [count, 3, 3], [count, 3]."""
    # A product for each row, whose rounding does not depend on how many rows there are.
    found: Array = np.matmul(axes, vectors[:, :, None])[:, :, 0]
    return found


def out_of_frame(axes: Array, vectors: Array) -> Array:
    """The reverse of `into_frame`."""
    found: Array = np.matmul(vectors[:, None, :], axes)[:, 0]
    return found


@dataclass(frozen=True)
class ImpactStates:
    """States of landers at impact; one entry or row for each, vectors fixed to the body that is hit.

    lander         its place among all that are followed, and number of the touchdown among those of the lander, from 0
    ground         that is met: its place among those of `grounds_of`, 0 the first body's, 1 its partner's
    position       [m]; axes, in rows, of the frame of the touchdown: x along the incoming horizontal velocity, z along
                   the normal of the ground that is met
    speed          [m/s], and incidence_deg, in that frame; mean_incidence_deg: against the facet of the shape
    spin           angular velocity against the ground [rad/s]; attitude: of the lander's axes, None where not known
    acceleration   of what rests there [m/s2], and rotation of the ground [rad/s], in the frame of the touchdown
    time           since the first touchdown began [s]; left: of the journey [s]; clock: time as of `fly` [s]
    mass           of the body that is met [kg]; spin_period [s]
    """

    lander: Integers
    number: Integers
    ground: Integers
    position: Array
    axes: Array
    speed: Array
    incidence_deg: Array
    mean_incidence_deg: Array
    spin: Array
    attitude: "list[Rotation | None]"
    acceleration: Array
    rotation: Array
    time: Array
    left: Array
    clock: Array
    mass: Array
    spin_period: Array

    def __len__(self) -> int:
        return len(self.lander)

    def at(self, which: Integers) -> "ImpactStates":
        """Some of the impacts."""
        parts = {one.name: getattr(self, one.name) for one in fields(self)}
        attitude = [self.attitude[one] for one in which.tolist()]
        return ImpactStates(
            **{name: part[which] for name, part in parts.items() if name != "attitude"}, attitude=attitude
        )

    @property
    def local_spin(self) -> Array:
        """The spins in the frames of the touchdowns."""
        return into_frame(self.axes, self.spin)


@dataclass(frozen=True)
class Answers:
    """How touchdowns end, [count] and [count, 3], vectors in the frames of the touchdowns.

    outcome     a word of TouchdownOutcome, "failed", or UNKNOWN_END
    velocity    [m/s], and spin against the ground [rad/s], of those that leave; with which captured ones slide on
    way         along the ground from the impact to where the touchdown ended [m]; length: of the path between them [m]
    rise        of the lander from the impact to where it leaves, along the normal [m]; below 0 where it has sunk
    duration    [s]; contacts: with the ground
    attitude    of the lander in the frame at the end, None where the model has none; reason: why a touchdown failed
    """

    outcome: np.ndarray
    velocity: Array
    spin: Array
    way: Array
    length: Array
    rise: Array
    duration: Array
    contacts: Integers
    attitude: "list[Rotation | None]" = field(default_factory=list)
    reason: list[str] = field(default_factory=list)

    @classmethod
    def unknown(cls, count: int) -> "Answers":
        velocity, spin, way = (np.zeros((count, 3)) for _ in range(3))
        length, rise, duration = (np.zeros(count) for _ in range(3))
        contacts = np.zeros(count, dtype=np.int64)
        states = (velocity, spin, way, length, rise, duration, contacts)
        return cls(np.full(count, UNKNOWN_END, dtype=WORD), *states, [None] * count, [""] * count)

    @property
    def is_known(self) -> np.ndarray:
        """Which touchdowns have an answer, [count]."""
        known: np.ndarray = self.outcome != UNKNOWN_END
        return known

    def fill(self, which: Integers, others: "Answers") -> None:
        """Put other answers at the places `which`."""
        for one in fields(self):
            mine, theirs = getattr(self, one.name), getattr(others, one.name)
            if isinstance(mine, list):
                for place, value in zip(which.tolist(), theirs, strict=True):
                    mine[place] = value
            else:
                mine[which] = theirs


def horizontal_velocity(impacts: ImpactStates) -> Array:
    """Incoming velocities along the ground [m/s], [count, 3], in the frames of the touchdowns."""
    velocity = np.zeros((len(impacts), 3))
    velocity[:, 0] = impacts.speed * np.sin(np.radians(impacts.incidence_deg))
    return velocity


class Touchdown(Protocol):
    """Model of a touchdown: a simulated landing, an emulator, hard ground, or a program of the user."""

    def answers(self, impacts: ImpactStates) -> Answers: ...
