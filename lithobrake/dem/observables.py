"""What a person reads of a world: its motion, its forces and contacts, its energies."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.dem.bodies.arrays import DAMPING, FRICTION, ROLLING, Bodies, Pairs, Step
from lithobrake.dem.bodies.rigid_body import Plane, RigidBody, vector
from lithobrake.dem.bodies.vectors import NO_PERIOD
from lithobrake.dem.stepping.engine import Engine
from lithobrake.dem.stepping.time_step_stability import largest_step, shortest_contact
from lithobrake.dem.world_state import WorldState
from lithobrake.vocabulary.array_types import Floats

CONTACT = np.dtype(
    [
        ("body_a", np.int64), ("body_b", np.int64), ("part_a", np.int64), ("part_b", np.int64),
        ("point", np.float64, 3), ("normal", np.float64, 3),
        ("overlap", np.float64), ("normal_force", np.float64), ("tangential_force", np.float64, 3),
    ]
)  # fmt: skip


def kinetic(mass: Floats | float, velocity: Floats, spin: Floats, angular_momentum: Floats) -> Floats:
    """Return the kinetic energy [J] of bodies, shape [...], from vectors of shape [..., 3]."""
    energy: Floats = 0.5 * (mass * (velocity * velocity).sum(axis=-1) + (spin * angular_momentum).sum(axis=-1))
    return energy


def ledger(
    moving: float, mass: Floats, position: Floats, gravity: Floats, pairs: Pairs, lost: Floats, released: float = 0.0
) -> dict[str, float]:
    """Return the energies [J] of a world from that of its motion, `moving`: kinetic, potential, elastic, cohesive, what
    damping, friction and rolling took, and the total.

    A Hertz contact holds 2/5 force times overlap, cohesion minus force times overlap, a spring half its force squared
    over its stiffness. released: what contacts have given to the motion since they were last looked at [J].
    """
    potential = -float((mass[:, None] * position * gravity).sum())
    touching = pairs.tangential_stiffness > 0.0
    spring_square = (pairs.spring[touching] ** 2).sum(axis=1)
    elastic = 0.4 * float((pairs.elastic_force * pairs.overlap).sum()) - released
    elastic += 0.5 * float((spring_square / pairs.tangential_stiffness[touching]).sum())
    twisting = pairs.twist_stiffness > 0.0
    elastic += 0.5 * float((pairs.twist[twisting] ** 2 / pairs.twist_stiffness[twisting]).sum())
    rolling = pairs.roll_stiffness > 0.0
    elastic += 0.5 * float(((pairs.roll[rolling] ** 2).sum(axis=1) / pairs.roll_stiffness[rolling]).sum())
    parts = {
        "kinetic": moving, "potential": potential, "elastic": elastic,
        "cohesive": -float((pairs.cohesion * pairs.overlap).sum()), "damping": float(lost[DAMPING]),
        "friction": float(lost[FRICTION]), "rolling": float(lost[ROLLING]),
    }  # fmt: skip
    return {**parts, "total": float(np.sum(list(parts.values())))}


class BodyMotion(NamedTuple):
    """How one body moves, world frame."""

    position: Floats  # m, of the centre of mass, [3]
    velocity: Floats  # m/s, [3]
    orientation: Floats  # unit quaternion w, x, y, z, body to world
    angular_momentum: Floats  # kg m2/s, about the centre of mass, [3]
    spin: Floats  # rad/s, [3]
    mass: float  # kg

    @property
    def kinetic_energy(self) -> float:
        """Kinetic energy [J]."""
        return float(kinetic(self.mass, self.velocity, self.spin, self.angular_momentum))


def contacts_of(bodies: Bodies, pairs: Pairs) -> NDArray[Any]:
    """Return the pairs that touch as a structured array, see `World.contacts`."""
    touching = np.flatnonzero(pairs.overlap > 0.0)
    result = np.zeros(len(touching), dtype=CONTACT)
    result["body_a"], result["body_b"] = pairs.first[touching], pairs.second[touching]
    for name, members in (("a", "first"), ("b", "second")):
        # Planes have numbers below 0, which would count bodies from the end.
        number, part = result[f"body_{name}"], getattr(pairs, f"{members}_part")[touching]
        result[f"part_{name}"] = np.where(number < 0, 0, part - bodies.part_start[np.maximum(number, 0)])
    for name in ("point", "normal", "overlap", "normal_force", "tangential_force"):
        result[name] = getattr(pairs, name)[touching]
    return result


class Observables:
    """Bodies and planes under a constant acceleration, to be read; nothing here changes them.

    gravity [m/s2] and rotation of the frame [rad/s], shape [3].
    """

    def __init__(self, state: WorldState, gravity: Sequence[float]) -> None:
        self.gravity, self.rotation = gravity, np.zeros(3)
        self.drag = 0.0  # 1/s, viscous damping of all motion, for settling only
        self._state = state

    @property
    def gravity(self) -> Floats:
        """Acceleration of all that falls [m/s2], shape [3]."""
        return self._gravity

    @gravity.setter
    def gravity(self, value: ArrayLike) -> None:
        self._gravity = vector(value, "World.gravity")

    @property
    def rotation(self) -> Floats:
        """Rotation of the frame against the stars [rad/s], shape [3]; motions and spins are those against the frame.

        Gravity is what a body at rest in the frame feels, its centrifugal part included.
        """
        return self._rotation

    @rotation.setter
    def rotation(self, value: ArrayLike) -> None:
        self._rotation = vector(value, "World.rotation")

    def _step(self, time_step: float) -> Step:
        reduced = self._state.options["damping_mass"] == "paper"
        return Step(time_step, float(self.drag), tuple(self.gravity), tuple(self.rotation), reduced)

    def _read(self) -> Engine:
        return self._state.read(self._step(0.0))

    @property
    def period(self) -> tuple[float, float] | None:
        """Lengths along x and y after which the world repeats [m]; None where it does not."""
        period = self._state.period
        return None if period == NO_PERIOD else (period.x, period.y)

    @property
    def bodies(self) -> list[RigidBody]:
        """The bodies as they were added."""
        return self._state.bodies

    @property
    def planes(self) -> list[Plane]:
        """The planes as they stand."""
        return self._state.planes

    @property
    def mass(self) -> Floats:
        """Masses [kg], shape [body_count]."""
        return self._state.mass.copy()

    @property
    def inertia(self) -> Floats:
        """Principal moments of inertia [kg m2], ascending, shape [body_count, 3]."""
        return np.array([np.linalg.eigvalsh(body.inertia) for body in self.bodies]).reshape(-1, 3)

    # --- motion --------------------------------------------------------------------------------------------------

    @property
    def position(self) -> Floats:
        """Centres of mass [m], shape [body_count, 3]; of a plain body the centroid."""
        return self._state.motion["position"].copy()

    @property
    def velocity(self) -> Floats:
        """Velocities of the centres of mass [m/s], shape [body_count, 3]."""
        return self._state.motion["velocity"].copy()

    @property
    def orientation(self) -> Floats:
        """Orientations, unit quaternions w, x, y, z, body to world, shape [body_count, 4]."""
        return self._state.motion["quaternion"].copy()

    @property
    def angular_momentum(self) -> Floats:
        """Angular momenta about the centres of mass [kg m2/s], shape [body_count, 3], world frame."""
        return self._state.motion["angular_momentum"].copy()

    @property
    def spin(self) -> Floats:
        """Angular velocities [rad/s], shape [body_count, 3], world frame."""
        return self._state.spin(slice(None))

    def motion_of(self, body: int) -> BodyMotion:
        """Return how one body moves: cheaper than the arrays of all."""
        number = range(len(self.bodies))[body]
        motion = {name: array[number].copy() for name, array in self._state.motion.items()}
        return BodyMotion(
            motion["position"], motion["velocity"], motion["quaternion"], motion["angular_momentum"],
            self._state.spin(slice(number, number + 1))[0], self.bodies[number].mass,
        )  # fmt: skip

    # --- forces and contacts -------------------------------------------------------------------------------------

    @property
    def contact_force(self) -> Floats:
        """Sum of the contact forces on each body [N], shape [body_count, 3]."""
        force = self._read().bodies.force.copy()
        if self._state.joints and self._state.local is not None:
            joints = self._state.local.joints
            np.add.at(force, joints.first, joints.force)
            np.subtract.at(force, joints.second, joints.force)
        return force

    @property
    def contact_torque(self) -> Floats:
        """Sum of the torques of the contacts on each body about its centre of mass [N m], [body_count, 3], world."""
        torque = self._read().bodies.torque.copy()
        if self._state.joints and self._state.local is not None:
            joints = self._state.local.joints
            np.add.at(torque, joints.first, joints.first_torque)
            np.subtract.at(torque, joints.second, joints.second_torque)
        return torque

    def contacts(self) -> NDArray[Any]:
        """Return the contacts (overlap > 0), a structured array.

        body_a, body_b (plane k is -1 - k), part_a, part_b (of these bodies, 0: the shape of its own), point [m] (where
        a is; in a world with a period b may be there by an image of it), normal from a to b, overlap [m],
        normal_force [N], tangential_force on b [N, 3].
        """
        engine = self._read()
        return contacts_of(engine.bodies, engine.pairs)

    @property
    def largest_step(self) -> float:
        """Largest safe time step [s] for the contacts at their present overlaps; infinite where nothing touches.

        How it follows from them: stability.py.
        """
        engine, paper_mass = self._read(), self._step(0.0).paper_mass
        return float(largest_step(engine.bodies, engine.planes, engine.pairs, engine.laws, paper_mass))

    def shortest_contact(self, speed: float) -> float:
        """Return the duration [s] of the shortest collision that can happen at a relative speed [m/s].

        Raises ValueError for a speed of zero, and where no two things can meet.
        """
        return shortest_contact(self.bodies, self.planes, self._state.options, speed)

    # --- energies ------------------------------------------------------------------------------------------------

    @property
    def kinetic_energy(self) -> Floats:
        """Kinetic energy of each body [J], shape [body_count]."""
        return kinetic(self.mass, self.velocity, self.spin, self.angular_momentum)

    def energy(self) -> dict[str, float]:
        """Return the energy ledger [J]: see energy.ledger: kinetic, potential, elastic, cohesive, lost ones, total.

        The springs of joints count as elastic, and their dashpots as damping.
        """
        engine = self._read()
        kinetic = float(self.kinetic_energy.sum())
        local = self._state.local
        released = local.work_since_looks() if local is not None else 0.0
        released -= self._state.joint_energy(engine)
        return ledger(kinetic, self.mass, self.position, self.gravity, engine.pairs, engine.losses(), released)
