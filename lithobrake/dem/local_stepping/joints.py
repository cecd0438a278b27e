"""Joints among contacts that step for themselves: a joint is looked at at its own instants, like a contact that stays.

Its force is steady between looks, on both bodies at one point, so momentum is kept to the last bits, and angular
momentum as with contacts.
"""

from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies
from lithobrake.dem.bodies.joint import Joint, joint_law, joint_step
from lithobrake.dem.bodies.orientation import Quaternion
from lithobrake.dem.bodies.rigid_body import RigidBody
from lithobrake.dem.bodies.vectors import cross, dot, minus, plus, put, row, scaled, times, transposed_times
from lithobrake.dem.local_stepping.free_motion import Flight, spin_of
from lithobrake.dem.local_stepping.pushes import push
from lithobrake.vocabulary.array_types import Floats, Integers, Vector


class Joints(NamedTuple):
    """Per joint, constants first. Tensors and angles are in the frame of the second body; see joint.JointLaw."""

    first: Integers  # [joint_count], body
    second: Integers  # [joint_count], body that hangs on it
    first_arm: Floats  # [joint_count, 3], m, to the pin, frame of the first
    second_arm: Floats  # [joint_count, 3], m, frame of the second
    turn: Floats  # [joint_count, 4], w x y z, of the second in the frame of the first, at rest
    pin: Floats  # [joint_count], N/m
    pin_dashpot: Floats  # [joint_count], N s/m
    hinge: Floats  # [joint_count, 3, 3], N m
    hinge_dashpot: Floats  # [joint_count, 3, 3], N m s
    stop: Floats  # [joint_count], N m
    weight: Floats  # [joint_count, 3, 3]
    limit: Floats  # [joint_count], twice the sine of half the limit
    interval: Floats  # [joint_count], s, from look to look
    last: Floats  # [joint_count], s, when it was last looked at
    due: Floats  # [joint_count], s, when it is to be looked at again
    power: Floats  # [joint_count], W, that its dashpots took then
    force: Floats  # [joint_count, 3], N, on the second since then
    first_torque: Floats  # [joint_count, 3], N m
    second_torque: Floats  # [joint_count, 3], N m


def joints_of(joints: list[Joint], bodies: list[RigidBody], steps: float, time: float) -> Joints:
    """Return joints as arrays, with so many looks in the shortest period of each, from an instant [s] on."""
    laws = [joint_law(joint, bodies[joint.second]) for joint in joints]
    count = len(joints)

    def column(values: list[object], *shape: int) -> Floats:
        return np.array(values, dtype=np.float64).reshape(count, *shape)

    intervals = [
        joint_step(joint, bodies[joint.first], bodies[joint.second], law, steps)
        for joint, law in zip(joints, laws, strict=True)
    ]
    return Joints(
        first=np.array([joint.first for joint in joints], dtype=np.int64),
        second=np.array([joint.second for joint in joints], dtype=np.int64),
        first_arm=column([joint.first_arm for joint in joints], 3),
        second_arm=column([joint.second_arm for joint in joints], 3), turn=column([joint.turn for joint in joints], 4),
        pin=column([law.pin for law in laws]), pin_dashpot=column([law.pin_dashpot for law in laws]),
        hinge=column([law.hinge for law in laws], 3, 3), stop=column([law.stop for law in laws]),
        hinge_dashpot=column([law.hinge_dashpot for law in laws], 3, 3),
        weight=column([law.weight for law in laws], 3, 3),
        limit=column([2.0 * np.sin(0.5 * joint.limit) for joint in joints]), interval=column([*intervals]),
        last=np.full(count, time), due=np.full(count, time), power=np.zeros(count), force=np.zeros((count, 3)),
        first_torque=np.zeros((count, 3)), second_torque=np.zeros((count, 3)),
    )  # fmt: skip


class JointForce(NamedTuple):
    force: Vector  # N, on the second
    first_torque: Vector  # N m, that the same force and couple have about the centre of mass of the first
    second_torque: Vector  # N m
    power: float  # W, that its dashpots take


@kernel
def quaternion_at(quaternions: Floats, i: int) -> Quaternion:
    return (quaternions[i, 0], quaternions[i, 1], quaternions[i, 2], quaternions[i, 3])


@kernel
def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the product of two quaternions w, x, y, z."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


@kernel
def bend_of(bodies: Bodies, joints: Joints, joint: int) -> tuple[float, Vector]:
    """Return the turn of the second of a joint from its rest, in its own frame: the cosine of half the angle, above 0,
    and the axis times the sine.
    """
    first, second = quaternion_at(bodies.quaternion, joints.first[joint]), joints.second[joint]
    w, x, y, z = product(first, quaternion_at(joints.turn, joint))
    w, x, y, z = product((w, -x, -y, -z), quaternion_at(bodies.quaternion, second))
    return (w, (x, y, z)) if w >= 0.0 else (-w, (-x, -y, -z))


@kernel
def pin_arms(bodies: Bodies, joints: Joints, joint: int) -> tuple[Vector, Vector, Vector]:
    """Return how far the pin is stretched, from the first to the second, and the arms of either body to its middle [m].

    A force at one point for both keeps angular momentum, also that of the dashpot, which is not along the stretch.
    """
    first, second = joints.first[joint], joints.second[joint]
    arm = times(bodies.rotation, first, row(joints.first_arm, joint))
    other = times(bodies.rotation, second, row(joints.second_arm, joint))
    apart = minus(row(bodies.position, second), row(bodies.position, first))
    stretch = minus(plus(apart, other), arm)
    return stretch, plus(arm, scaled(0.5, stretch)), minus(other, scaled(0.5, stretch))


@kernel
def swing_of(joints: Joints, joint: int, bend: Vector) -> float:
    """Return how far a bend, twice its vector part, swings the second: the angle where it is small [rad]."""
    return dot(bend, times(joints.weight, joint, bend)) ** 0.5


@kernel
def hinge_torque(joints: Joints, joint: int, half: tuple[float, Vector]) -> Vector:
    """Return the couple of the springs on the second, in its frame [N m]; half: see bend_of.

    It is minus the derivative of joint_energy by the turn: about one axis, the stiffness times the sine of the angle.
    """
    w, v = half
    bend = scaled(2.0, v)
    slope, swing = times(joints.hinge, joint, bend), swing_of(joints, joint, bend)
    if swing > joints.limit[joint]:
        beyond = joints.stop[joint] * (1.0 - joints.limit[joint] / swing)
        slope = plus(slope, scaled(beyond, times(joints.weight, joint, bend)))
    return scaled(-1.0, plus(scaled(w, slope), cross(slope, v)))


@kernel
def joint_force(bodies: Bodies, joints: Joints, joint: int) -> JointForce:
    """Return what a joint does to its bodies as they stand and move, and what it takes of their energy."""
    first, second = joints.first[joint], joints.second[joint]
    stretch, arm, other = pin_arms(bodies, joints, joint)
    spin, other_spin = spin_of(bodies, first), spin_of(bodies, second)
    motion = minus(row(bodies.velocity, second), row(bodies.velocity, first))
    motion = plus(motion, minus(cross(other_spin, other), cross(spin, arm)))
    drag = scaled(-joints.pin_dashpot[joint], motion)
    force = plus(scaled(-joints.pin[joint], stretch), drag)
    turning = transposed_times(bodies.rotation, second, minus(other_spin, spin))
    brake = scaled(-1.0, times(joints.hinge_dashpot, joint, turning))
    couple = plus(hinge_torque(joints, joint, bend_of(bodies, joints, joint)), brake)
    couple = times(bodies.rotation, second, couple)
    power = -dot(drag, motion) - dot(brake, turning)
    return JointForce(force, plus(cross(arm, force), couple), plus(cross(other, force), couple), power)


@kernel
def joint_energy(bodies: Bodies, joints: Joints, joint: int) -> float:
    """Return the energy [J] in the springs of a joint: pin, hinge and stop."""
    stretch, _, _ = pin_arms(bodies, joints, joint)
    bend = scaled(2.0, bend_of(bodies, joints, joint)[1])
    beyond = max(0.0, swing_of(joints, joint, bend) - joints.limit[joint])
    bent = dot(bend, times(joints.hinge, joint, bend))
    return 0.5 * (joints.pin[joint] * dot(stretch, stretch) + bent + joints.stop[joint] * beyond * beyond)


@large_kernel
def energy_of_joints(bodies: Bodies, joints: Joints) -> float:
    """Return the energy [J] in the springs of all joints."""
    energy = 0.0
    for joint in range(len(joints.first)):
        energy += joint_energy(bodies, joints, joint)
    return energy


@kernel
def renew_joint(bodies: Bodies, flight: Flight, joints: Joints, joint: int, passed: float) -> None:
    """Compute the force of a joint after a time [s] under the last one, push its bodies, and book what it took.

    Writes to bodies and joints.
    """
    first, second = joints.first[joint], joints.second[joint]
    now = joint_force(bodies, joints, joint)
    change = minus(now.force, row(joints.force, joint))
    # The force has pushed as it was: half of its change belongs to the time since.
    push(bodies, flight, first, -1.0, 0.5 * passed, change, minus(now.first_torque, row(joints.first_torque, joint)))
    push(bodies, flight, second, 1.0, 0.5 * passed, change, minus(now.second_torque, row(joints.second_torque, joint)))
    bodies.dragged[second] += 0.5 * passed * (joints.power[joint] + now.power)
    joints.power[joint] = now.power
    put(joints.force, joint, now.force)
    put(joints.first_torque, joint, now.first_torque)
    put(joints.second_torque, joint, now.second_torque)
