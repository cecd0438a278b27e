"""The world: bodies and planes under a constant acceleration, and their motion in time."""

import math
import os
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.dem import energy, timestep
from lithobrake.dem.arrays import Floats, Step
from lithobrake.dem.assembly import rotation_matrices
from lithobrake.dem.checkpoint import read_checkpoint, write_checkpoint
from lithobrake.dem.contacts import contacts_of
from lithobrake.dem.engine import Engine
from lithobrake.dem.material import Material, contact_options
from lithobrake.dem.rigid_body import Plane, new_body, unit, vector
from lithobrake.dem.shape import Shape
from lithobrake.dem.stability import largest_step
from lithobrake.dem.time_loop import DIVERGED, STEP_TOO_LARGE, WATCHED
from lithobrake.dem.world_state import WorldState


class World:
    """Rigid bodies and planes in contact under a constant acceleration.

    gravity [m/s2], shape [3]. time_step [s]; None: a fiftieth of the shortest contact that the speeds at hand can
    make. shear_modulus_rule "mindlin" or "paper" (its Eq. 8 as printed); damping_mass "contact" (the mass seen at
    the contact point) or "paper" (the reduced mass); pair_rule "smaller", "mean" or "geometric" for restitution,
    frictions and cohesion of two materials.
    """

    def __init__(
        self,
        gravity: Sequence[float] = (0.0, 0.0, 0.0),
        time_step: float | None = None,
        *,
        shear_modulus_rule: str = "mindlin",
        damping_mass: str = "contact",
        pair_rule: str = "smaller",
    ) -> None:
        self.options = contact_options(shear_modulus_rule, damping_mass, pair_rule)
        if time_step is not None:
            timestep.checked_step(time_step, "a finite value above 0, or None")
        self.gravity = vector(gravity, "World gravity")
        self.drag = 0.0  # 1/s, viscous damping of all motion, for settling only
        self.time = 0.0  # s
        self._given_time_step = time_step
        self._time_step = time_step
        self._take(WorldState(self.options))

    def _take(self, state: WorldState) -> None:
        self._state, self.bodies, self.planes = state, state.bodies, state.planes

    # --- what is in it -------------------------------------------------------------------------------------------

    def add_body(
        self,
        shape: Shape,
        material: Material,
        position: Sequence[float],
        velocity: Sequence[float] = (0.0, 0.0, 0.0),
        orientation: Sequence[float] = (1.0, 0.0, 0.0, 0.0),
        spin: Sequence[float] = (0.0, 0.0, 0.0),
        *,
        mass: float | None = None,
        inertia: ArrayLike | None = None,
    ) -> int:
        """Add a body and return its number.

        position of the centroid [m], velocity [m/s], orientation (w, x, y, z) that turns the shape's vertices, as
        given, about their centroid, spin [rad/s] in the world frame. mass [kg] and inertia [kg m2, 3 x 3, about the
        centroid, frame of the shape] follow from the material's density unless given. Raises ValueError for values
        that are not finite, a mass that is not positive or an inertia that no body has.
        """
        body = new_body(shape, material, mass, inertia)
        quaternion = unit(orientation, "add_body orientation")
        rotation = rotation_matrices(quaternion[None])[0]
        motion = {
            "position": vector(position, "add_body position"),
            "velocity": vector(velocity, "add_body velocity"),
            "quaternion": quaternion,
            "angular_momentum": rotation @ (body.inertia @ (rotation.T @ vector(spin, "add_body spin"))),
        }
        self._time_step = self._given_time_step
        return self._state.add_body(body, motion)

    def add_plane(
        self,
        point: Sequence[float],
        normal: Sequence[float],
        material: Material,
        *,
        bodies: Iterable[int] | None = None,
    ) -> int:
        """Add a half-space of matter behind a plane; `normal` points out of it. It meets the bodies listed, or all."""
        place = vector(point, "add_plane point")
        meets = None if bodies is None else frozenset(bodies)
        self._state.disassemble()
        self._time_step = self._given_time_step
        self.planes.append(Plane(place, unit(normal, "add_plane normal"), material, meets))
        return len(self.planes) - 1

    def move_plane(
        self, plane: int, point: Sequence[float] | None = None, *, bodies: Iterable[int] | None = None
    ) -> None:
        """Put a plane through another point [m], or let it meet other bodies; its contacts go on with their history.

        The move is a jump: keep it far below the overlaps. None leaves a value as it is.
        """
        number = range(len(self.planes))[plane]
        old = self.planes[number]
        place = old.point if point is None else vector(point, "move_plane point")
        meets = old.meets if bodies is None else frozenset(bodies)
        self._state.disassemble()
        self.planes[number] = Plane(place, old.normal, old.material, meets)

    def watch(self, body: int) -> None:
        """Note from now on the contact forces on one body, see `watched`."""
        self._state.watched = range(len(self.bodies))[body]
        self._state.watch_record[:] = 0.0

    @property
    def watched(self) -> dict[str, float]:
        """Largest contact force [N] on the watched body; steps from `watch` to its first and last contact (0: none)."""
        return {name: float(self._state.watch_record[place]) for name, place in WATCHED.items()}

    # --- motion --------------------------------------------------------------------------------------------------

    @property
    def time_step(self) -> float:
        """Time step [s]."""
        if self._time_step is None:
            speed = timestep.meeting_speed_bound(
                self.position, self.velocity, self.spin, self.bodies, self.planes, self.gravity
            )
            return self.shortest_contact(speed) / timestep.STEPS_PER_CONTACT
        return self._time_step

    @time_step.setter
    def time_step(self, value: float) -> None:
        self._time_step = self._given_time_step = timestep.checked_step(value)

    @property
    def thread_count(self) -> int:
        """Number of threads that take a step; any number gives the same bits. It pays from some thousand bodies on."""
        return self._state.thread_count

    @thread_count.setter
    def thread_count(self, value: int) -> None:
        if value != int(value) or value < 1:
            raise ValueError(f"World thread_count is {value!r}; allowed is a whole number of at least 1: change it")
        self._state.use_threads(int(value))

    @property
    def largest_step(self) -> float:
        """Largest safe time step [s] for the contacts at their present overlaps; infinite where nothing touches.

        Source: see stability.py.
        """
        engine, paper_mass = self._assembled(), self._step(0.0).paper_mass
        return float(largest_step(engine.bodies, engine.planes, engine.pairs, engine.laws, paper_mass))

    def shortest_contact(self, speed: float) -> float:
        """Return the duration [s] of the shortest collision that can happen at a relative speed [m/s].

        Raises ValueError for a speed of zero, and where no two things can meet.
        """
        return timestep.shortest_contact(self.bodies, self.planes, self.options, speed)

    def run(self, duration: float | None = None, *, steps: int | None = None) -> None:
        """Advance by a duration [s], rounded to whole steps, or by a number of steps.

        Raises ValueError where the time step is too large for a contact (it names the largest safe one), and
        FloatingPointError where the motion diverged.
        """
        if (duration is None) == (steps is None):
            raise ValueError("World.run takes either duration [s] or steps: give one of them")
        if not self.bodies:
            raise ValueError("World.run has no body to move: add one first")
        steps = self._steps_in(duration) if steps is None else steps
        if steps != int(steps) or steps < 0:
            raise ValueError(f"World.run steps is {steps!r}; allowed is a whole number of at least 0: change it")
        if steps == 0:
            return
        self._time_step = self.time_step
        taken, reason = self._assembled().advance(steps, self._step(self.time_step), self._state.watched)
        self.time += taken * self.time_step
        if reason in (STEP_TOO_LARGE, DIVERGED):
            self._refuse(reason)

    def _steps_in(self, duration: float | None) -> int:
        """Return the number of steps in a duration [s]; a step not yet chosen is made to fit into it."""
        if duration is None or not 0.0 <= duration < math.inf:
            raise ValueError(
                f"World.run duration is {duration!r} s; allowed is a finite value of at least 0: change it"
            )
        if self._time_step is None and duration > 0.0:
            self._time_step = duration / math.ceil(duration / self.time_step)
        return round(duration / self.time_step) if duration > 0.0 else 0

    def _refuse(self, reason: int) -> None:
        """Say why the time loop could not go on."""
        if reason == STEP_TOO_LARGE:
            raise ValueError(
                f"World time_step is {self.time_step:.6g} s; allowed for the contact met at t = {self.time:.6g} s "
                f"is at most {self.largest_step:.6g} s: make it smaller"
            )
        assert reason == DIVERGED
        raise FloatingPointError(
            f"the motion diverged at t = {self.time:.6g} s: positions are no longer finite numbers"
        )

    def _step(self, time_step: float) -> Step:
        return Step(time_step, float(self.drag), tuple(self.gravity), self.options["damping_mass"] == "paper")

    def _assembled(self) -> Engine:
        return self._state.assembled(self._step(0.0))

    # --- what came of it ------------------------------------------------------------------------------------------

    @property
    def position(self) -> Floats:
        """Centroids [m], shape [body_count, 3]."""
        return self._state.motion["position"].copy()

    @property
    def velocity(self) -> Floats:
        """Velocities of the centroids [m/s], shape [body_count, 3]."""
        return self._state.motion["velocity"].copy()

    @property
    def orientation(self) -> Floats:
        """Orientations, unit quaternions w, x, y, z, body to world, shape [body_count, 4]."""
        return self._state.motion["quaternion"].copy()

    @property
    def angular_momentum(self) -> Floats:
        """Angular momenta about the centroids [kg m2/s], shape [body_count, 3], world frame."""
        return self._state.motion["angular_momentum"].copy()

    @property
    def spin(self) -> Floats:
        """Angular velocities [rad/s], shape [body_count, 3], world frame."""
        return self._state.spin()

    @property
    def kinetic_energy(self) -> Floats:
        """Kinetic energy of each body [J], shape [body_count]."""
        return energy.kinetic(self.mass, self.velocity, self.spin, self.angular_momentum)

    @property
    def mass(self) -> Floats:
        """Masses [kg], shape [body_count]."""
        return np.array([body.mass for body in self.bodies])

    @property
    def inertia(self) -> Floats:
        """Principal moments of inertia [kg m2], ascending, shape [body_count, 3]."""
        return np.array([np.linalg.eigvalsh(body.inertia) for body in self.bodies]).reshape(-1, 3)

    @property
    def contact_force(self) -> Floats:
        """Sum of the contact forces on each body [N], shape [body_count, 3]."""
        return self._assembled().bodies.force.copy()

    @property
    def contact_torque(self) -> Floats:
        """Sum of the torques of the contacts on each body about its centroid [N m], world frame, [body_count, 3]."""
        return self._assembled().bodies.torque.copy()

    def contacts(self) -> NDArray[Any]:
        """Return the contacts (overlap > 0), a structured array.

        body_a, body_b (plane k is -1 - k), point [m], normal from a to b, overlap [m], normal_force [N],
        tangential_force on b [N, 3].
        """
        return contacts_of(self._assembled().pairs)

    def energy(self) -> dict[str, float]:
        """Return the energy ledger [J]: see energy.ledger: kinetic, potential, elastic, cohesive, lost ones, total."""
        engine = self._assembled()
        kinetic = float(self.kinetic_energy.sum())
        return energy.ledger(kinetic, self.mass, self.position, self.gravity, engine.pairs, engine.losses())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything to an HDF5 file, whole or not at all; `World.load` continues from it bit for bit."""
        clock = {"time": self.time, "given_time_step": self._given_time_step, "time_step": self._time_step}
        write_checkpoint(path, self._state, self._step(0.0), clock)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> "World":
        """Read a world that `save` wrote. Raises ValueError where the file is not one."""
        state, step, clock = read_checkpoint(path)
        world = World(step.gravity, clock["given_time_step"], **state.options)
        world._take(state)
        world.drag, world.time, world._time_step = step.drag, clock["time"], clock["time_step"]
        return world
