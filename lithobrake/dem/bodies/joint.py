"""An elastic joint of two bodies: a pin that holds them together at a point, and a hinge that bends about it."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.dem.bodies.rigid_body import RigidBody, inertia_about, vector
from lithobrake.vocabulary.array_types import Floats, Integers
from lithobrake.vocabulary.field_errors import FieldError, field_number, value_within

# Rate of the pin over that of the hinge. The pin lowers the frequency of the joint by half of one over its square,
# 0.5 %; a stiffer one takes shorter steps.
PIN_RATIO, SMALLEST_PIN_RATIO = 10.0, 2.0
# c dt + (w dt)^2 / 4 of a joint; 1 is the limit of stability.
STABLE_FRACTION = 0.5
# Looks at a joint in half of its shortest period, over steps in a contact, which is such a half; and the fewest.
LOOKS_PER_STEP, FEWEST_LOOKS = 0.2, 5.0
LARGEST_LIMIT = 0.5 * math.pi
WHO = ("first", "second")


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint as it was given: the second body hangs on the first."""

    first: int
    second: int
    first_arm: Floats  # m, [3], from the centre of mass of the first to the pin, frame of the first
    second_arm: Floats  # m, [3], the same of the second
    turn: Floats  # [4], unit quaternion w, x, y, z: attitude of the second in the frame of the first, at rest
    stiffness: float  # N m/rad
    damping_ratio: float
    limit: float  # rad
    pin_ratio: float


class JointLaw(NamedTuple):
    """What holds the second body of a joint; tensors in its frame."""

    pin: float  # N/m
    pin_dashpot: float  # N s/m
    hinge: Floats  # N m, [3, 3]
    hinge_dashpot: Floats  # N m s, [3, 3]
    stop: float  # N m, stiffness against bending beyond the limit
    weight: Floats  # [3, 3], inertia about the pin over its largest moment


def checked_joint_numbers(stiffness: float, damping_ratio: float, limit: float, pin_ratio: float) -> None:
    """Raise ValueError for a number of World.join outside its range."""
    field_number("World.join stiffness", stiffness, "is a finite value above 0", "N m/rad", above=0.0)
    for name, value, least, most, unit in (
        ("damping_ratio", damping_ratio, 0.0, 1.0, ""),
        ("limit", limit, 0.0, LARGEST_LIMIT, "rad"),
        ("pin_ratio", pin_ratio, SMALLEST_PIN_RATIO, 1e3, ""),
    ):
        allowed = value_within(least, most)
        if not least <= field_number(f"World.join {name}", value, allowed, unit) <= most:
            raise FieldError(f"World.join {name}", value, allowed, unit=unit)
    if limit == 0.0:
        raise FieldError("World.join limit", limit, "is above 0", "make the part rigid instead", "rad")


def joint_law(joint: Joint, body: RigidBody) -> JointLaw:
    """Return what holds the second body of a joint.

    The hinge has its stiffness about every axis, but no more than lets the body ring at the rate of the pin: a thin
    boom has next to no inertia about its own axis. The rate of the hinge is that about the axis of the largest moment
    of inertia about the pin, with the first body held. The pin rings with the mass of the second alone, the stop with
    its inertia. Every dashpot has the same damping ratio.
    """
    inertia = inertia_about(body, joint.second_arm)
    moments, axes = np.linalg.eigh(inertia)
    rate = math.sqrt(joint.stiffness / moments[2])
    fast = joint.pin_ratio * rate
    stiffness = np.minimum(joint.stiffness, fast**2 * moments)
    dashpot = 2.0 * joint.damping_ratio * np.sqrt(stiffness * moments)
    return JointLaw(
        pin=fast**2 * body.mass, pin_dashpot=2.0 * joint.damping_ratio * fast * body.mass,
        hinge=(axes * stiffness) @ axes.T, hinge_dashpot=(axes * dashpot) @ axes.T, stop=fast**2 * moments[2],
        weight=inertia / moments[2],
    )  # fmt: skip


def rotation_of(quaternion: Floats) -> Floats:
    """Return the rotation matrix [3, 3] of a unit quaternion w, x, y, z."""
    w, v = quaternion[0], quaternion[1:]
    across = np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
    matrix: Floats = np.eye(3) + 2.0 * w * across + 2.0 * across @ across
    return matrix


def joint_step(joint: Joint, first: RigidBody, second: RigidBody, law: JointLaw, steps: float) -> float:
    """Return the interval [s] between looks at a joint where contacts take so many steps; it is stable by itself."""
    to_first = rotation_of(joint.turn)
    # Small motions of both, in the frame of the second: three ways and three angles of each.
    masses = np.zeros((12, 12))
    for k, (body, inertia) in enumerate(((first, to_first.T @ first.inertia @ to_first), (second, second.inertia))):
        masses[6 * k : 6 * k + 3, 6 * k : 6 * k + 3] = body.mass * np.eye(3)
        masses[6 * k + 3 : 6 * k + 6, 6 * k + 3 : 6 * k + 6] = inertia
    across = [np.cross(np.eye(3), arm) for arm in (to_first.T @ joint.first_arm, joint.second_arm)]
    stretch = np.hstack([-np.eye(3), -across[0].T, np.eye(3), across[1].T])
    bend = np.hstack([np.zeros((3, 3)), -np.eye(3), np.zeros((3, 3)), np.eye(3)])
    stiffness = law.pin * stretch.T @ stretch + bend.T @ (law.hinge + law.stop * law.weight) @ bend
    dashpot = law.pin_dashpot * stretch.T @ stretch + bend.T @ law.hinge_dashpot @ bend
    square, damping = (float(np.linalg.eigvals(np.linalg.solve(masses, m)).real.max()) for m in (stiffness, dashpot))
    stable = 2.0 * STABLE_FRACTION / (damping + math.sqrt(damping**2 + STABLE_FRACTION * square))
    return min(math.pi / (math.sqrt(square) * max(FEWEST_LOOKS, LOOKS_PER_STEP * steps)), stable)


def leaders_of(body_count: int, joints: list[Joint]) -> Integers:
    """Return, for each body, the one at the root of all that it is joined to; itself where it is not joined."""
    leader = np.arange(body_count)
    # What hangs on another was free before, so the leader of the first is final.
    for joint in joints:
        leader[joint.second] = leader[joint.first]
    return leader


def new_joint(
    motion: dict[str, Floats], joints: list[Joint], members: tuple[int, int], point: ArrayLike, law: tuple[float, ...]
) -> Joint:
    """Return a joint of two bodies at a point [m, 3] as they stand in a motion of positions and quaternions.

    law: stiffness, damping ratio, limit and pin ratio. Raises ValueError for numbers outside their ranges, and for a
    second body that is the first, or has a joint already.
    """
    checked_joint_numbers(*law)
    numbers = range(len(motion["position"]))
    first, second = (int(checked_body(member, numbers, name)) for member, name in zip(members, WHO, strict=True))
    taken = {joint.first for joint in joints} | {joint.second for joint in joints}
    if second == first or second in taken:
        why = "the first one" if second == first else "a body that has a joint already"
        raise ValueError(
            f"World.join second is {second}, {why}; allowed is another body without a joint: join from the main body "
            "outward"
        )
    place = vector(point, "World.join point")
    quaternions = [motion["quaternion"][body] for body in (first, second)]
    arms = [
        rotation_of(quaternion).T @ (place - motion["position"][body])
        for body, quaternion in zip((first, second), quaternions, strict=True)
    ]
    return Joint(first, second, arms[0], arms[1], between(*quaternions), *(float(number) for number in law))


def checked_body(body: int, numbers: range, name: str) -> int:
    """Return the number of a body. Raises ValueError for one that is not there."""
    if isinstance(body, bool) or not isinstance(body, int | np.integer) or body not in numbers:
        raise FieldError(
            f"World.join {name}", body, f"is the number of a body, 0 to {len(numbers) - 1}", "add it first"
        )
    return body


def between(one: Floats, other: Floats) -> Floats:
    """Return the attitude of the other of two unit quaternions w, x, y, z in the frame of the one."""
    (w, v), (a, b) = ((q[0], q[1:]) for q in (one, other))
    return np.array([w * a + v @ b, *(w * b - a * v - np.cross(v, b))])
