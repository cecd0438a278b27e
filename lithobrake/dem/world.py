"""The world: bodies and planes under a constant acceleration, and their motion in time."""

import math
import os
from collections.abc import Iterable, Sequence
from dataclasses import asdict

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.dem.bodies.joint import LARGEST_LIMIT, PIN_RATIO, new_joint
from lithobrake.dem.bodies.rigid_body import Part, Plane, new_body, rows, uniform_bodies, unit, units, vector
from lithobrake.dem.bodies.shape import Shape
from lithobrake.dem.bodies.vectors import period_of, refuse_tilted_plane
from lithobrake.dem.law.restitution import contact_options
from lithobrake.dem.local_stepping.agenda import FEWEST_STEPS
from lithobrake.dem.local_stepping.local_engine import Setting
from lithobrake.dem.observables import Observables
from lithobrake.dem.stepping.engine import Engine, rotation_matrices
from lithobrake.dem.stepping.time_loop import (
    DIVERGED,
    FIRST_CONTACT,
    LAST_CONTACT,
    PEAK_FORCE,
    STEP_TOO_LARGE,
    STEPS,
    TOUCHED,
    new_record,
)
from lithobrake.dem.stepping.time_step_stability import (
    LONGEST_RUN,
    Clock,
    checked_count,
    checked_step,
    chosen_step,
)
from lithobrake.dem.world_state import NOTHING_WATCHED, WorldState, read_checkpoint, write_checkpoint
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.field_errors import FieldError, field_number
from lithobrake.vocabulary.material_properties import Material

# Of the contact radius R*: a deeper dent is no small overlap, on which Hertz' law rests.
DEEPEST_DENT = 0.15
# More than any machine has cores.
MOST_THREADS = 1024
# Of the speed with which a blow lets go what is held: what is slower is held, where nothing else is asked for.
CALM = 0.5


class StepTooLargeError(FieldError):
    """A contact that was met asks for a smaller time step; the step at which it was met has been taken."""


class World(Observables):
    """Rigid bodies and planes in contact under a constant acceleration.

    gravity [m/s2], shape [3]. time_step [s]; None: a fiftieth of the shortest contact that the speeds at hand can
    make. shear_modulus_rule "mindlin" or "paper" ([Landings-PCE], Eq 8 as printed); damping_mass "contact" (the mass
    seen at the contact point) or "paper" (the reduced mass); pair_rule "smaller", "mean" or "geometric" for
    restitution, frictions and cohesion of two materials; tangential_dashpot "mindlin" (2 sqrt(G* / E*) times that along
    the normal) or "none", as in codes that damp along the normal alone. period [m], along x and y: what happens at a
    place happens at every image of it, one period on; positions are not wrapped, and planes are level. None: the world
    does not repeat. What is read of a world: observables.py.
    """

    def __init__(
        self,
        gravity: Sequence[float] = (0.0, 0.0, 0.0),
        time_step: float | None = None,
        *,
        shear_modulus_rule: str = "mindlin",
        damping_mass: str = "contact",
        pair_rule: str = "smaller",
        tangential_dashpot: str = "mindlin",
        period: Sequence[float] | None = None,
    ) -> None:
        options = contact_options(shear_modulus_rule, damping_mass, pair_rule, tangential_dashpot)
        if time_step is not None:
            checked_step(time_step, "is a finite value above 0, or None")
        super().__init__(WorldState(options, period_of(period)), gravity)
        self._clock = Clock(0.0, time_step, time_step)

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
        parts: Sequence[Part] = (),
        centre_of_mass: ArrayLike | None = None,
    ) -> int:
        """Add a body and return its number.

        position of the centre of mass [m], velocity [m/s], orientation (w, x, y, z) that turns the shape's vertices, as
        given, about that, spin [rad/s] in the world frame. mass [kg], centre_of_mass [m, 3, frame of the shape] and
        inertia [kg m2, 3 x 3, about the centre of mass, same frame] follow from the densities of the materials unless
        given: the centroid for one homogeneous shape. parts: further convex parts that move with it, in the frame of
        the shape; they may overlap, and do not touch each other. Raises ValueError for values that are not finite, a
        mass that is not positive or an inertia that no body has.
        """
        body = new_body(shape, material, mass, inertia, parts, centre_of_mass)
        quaternion = unit(orientation, "add_body orientation")
        rotation = rotation_matrices(quaternion[None])[0]
        motion = {
            "position": vector(position, "add_body position"),
            "velocity": vector(velocity, "add_body velocity"),
            "quaternion": quaternion,
            "angular_momentum": rotation @ (body.inertia @ (rotation.T @ vector(spin, "add_body spin"))),
        }
        self._clock.choose_anew()
        return self._state.add_bodies([body], {name: value[None] for name, value in motion.items()})

    def add_bodies(
        self, shapes: Sequence[Shape], material: Material, position: ArrayLike, orientation: ArrayLike
    ) -> range:
        """Add bodies at rest, of one material, and return their numbers.

        position [m], shape [count, 3], and orientation, [count, 4], as of add_body, which takes far longer for many.
        Raises ValueError for values that are not finite, and for other shapes.
        """
        place, turn = rows(position, 3, len(shapes), "position"), rows(orientation, 4, len(shapes), "orientation")
        quaternion = units(turn, "add_bodies orientation")
        bodies = uniform_bodies(shapes, material)
        rest = np.zeros_like(place)
        motion = {"position": place, "velocity": rest, "quaternion": quaternion, "angular_momentum": rest}
        self._clock.choose_anew()
        last = self._state.add_bodies(bodies, motion)
        return range(last + 1 - len(shapes), last + 1)

    def add_plane(
        self,
        point: Sequence[float],
        normal: Sequence[float],
        material: Material,
        *,
        bodies: Iterable[int] | None = None,
    ) -> int:
        """Add a half-space of matter behind a plane; `normal` points out of it. It meets the bodies listed, or all."""
        place, outward = vector(point, "add_plane point"), unit(normal, "add_plane normal")
        refuse_tilted_plane(self._state.period, outward)
        meets = None if bodies is None else frozenset(bodies)
        self._state.disassemble()
        self._clock.choose_anew()
        self.planes.append(Plane(place, outward, material, meets))
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

    def join(
        self, first: int, second: int, point: ArrayLike, stiffness: float, *, damping_ratio: float = 0.0,
        limit: float = LARGEST_LIMIT, pin_ratio: float = PIN_RATIO,
    ) -> int:  # fmt: skip
        """Hang a body on another by an elastic hinge at a point, as they stand now, and return the joint's number.

        point [m, 3, world frame]: where both are pinned together. stiffness [N m/rad]: of the hinge, about every axis;
        its torque is the stiffness times the sine of the bend. damping_ratio: of every motion of the joint, with the
        first body held. limit [rad, at most pi/2]: bend beyond which an elastic stop, as stiff as the pin, acts.
        pin_ratio: rate of the pin over that of the hinge; half of one over its square is the part by which the pin
        lowers the frequency. See joint.joint_law. Joined bodies do not touch each other. Joints act where contacts
        take steps of their own (run_locally).
        Raises ValueError for values outside these ranges, and for a second body that has a joint already.
        """
        law = stiffness, damping_ratio, limit, pin_ratio
        joint = new_joint(self._state.motion, self._state.joints, (first, second), point, law)
        self._refuse_watched({joint.second: joint.first}, self._state.watched)
        self._state.disassemble()
        self._clock.choose_anew()
        self._state.joints.append(joint)
        return len(self._state.joints) - 1

    # --- motion --------------------------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self._clock.time

    @time.setter
    def time(self, value: float) -> None:
        self._clock.time = value

    @property
    def time_step(self) -> float:
        """Time step [s]."""
        return self._chosen_step() if self._clock.time_step is None else self._clock.time_step

    @time_step.setter
    def time_step(self, value: float) -> None:
        self._clock.give(value)

    def _chosen_step(self) -> float:
        return chosen_step(
            self.position, self.velocity, self.spin, self.bodies, self.planes, self.gravity, self._state.options
        )

    @property
    def thread_count(self) -> int:
        """Number of threads that take a step; any number gives the same bits. It pays from some thousand bodies on."""
        return self._state.thread_count

    @thread_count.setter
    def thread_count(self, value: int) -> None:
        self._state.use_threads(checked_count(value, "World.thread_count", 1, MOST_THREADS))

    def run(self, duration: float | None = None, *, steps: int | None = None) -> None:
        """Advance by a duration [s], rounded to whole steps, or by a number of steps.

        Raises StepTooLargeError where the time step is too large for a contact (it names the largest safe one), and
        FloatingPointError where the motion diverged, a contact has yielded too deeply, or a body lies wholly behind a
        plane that meets it.
        """
        if (duration is None) == (steps is None):
            raise ValueError("World.run takes either duration [s] or steps: give one of them")
        if not self.bodies:
            raise ValueError("World.run has no body to move: add one first")
        count = self._clock.steps_in(duration, self._chosen_step) if steps is None else checked_count(steps)
        if count == 0:
            return
        if self._state.joints:
            raise ValueError(
                f"World.run takes one step for all, and the world has {len(self._state.joints)} joints; allowed are "
                "worlds without joints: use World.run_locally"
            )
        self._refuse_drag_in_turning_frame()
        self._clock.time_step = self.time_step
        engine = self._state.stepping_together(self._step(0.0))
        taken, reason = engine.advance(count, self._step(self.time_step), self._state.watched)
        self.time += taken * self.time_step
        if reason in (STEP_TOO_LARGE, DIVERGED):
            self._refuse(reason)
        self._refuse_deep()

    def run_locally(
        self, duration: float, steps_per_contact: float, *, resolved_speed: float = 0.0, held_speed: float = 0.0,
        calm_speed: float | None = None, reach: float = 0.0,
    ) -> None:  # fmt: skip
        """Advance by a duration [s], every contact at steps of its own, so many in the time of its collision.

        What is slow or far from anything then costs little; a landing is 4 to 5 times as fast (docs/performance.md).
        Energy of a landing is kept to four thousandths of the impact's with 25 steps, to one with 100. The time step
        plays no part. Collisions slower than resolved_speed [m/s] take fewer steps, in proportion, but never less than
        5; at 0.3 of the lander's, energy is kept to some hundredths. What is carried by what it touches, is beyond a
        reach [m] of the watched body and slower than calm_speed [m/s], without it half of held_speed, stands still
        until a blow would make it as fast as held_speed [m/s], or nothing carries it; with 0 nothing does.
        Raises ValueError for a duration below 0, less than 5 steps, or a held_speed without a watched body,
        FloatingPointError where the motion diverged, a contact has yielded too deeply, or a body lies wholly behind a
        plane that meets it.
        """
        calm_speed = CALM * held_speed if calm_speed is None else calm_speed
        if not self.bodies:
            raise ValueError("World.run_locally has no body to move: add one first")
        for name, value, least, si in (
            ("duration", duration, 0.0, "s"),
            ("steps_per_contact", steps_per_contact, FEWEST_STEPS, ""),
            ("resolved_speed", resolved_speed, 0.0, "m/s"),
            ("held_speed", held_speed, 0.0, "m/s"),
            ("calm_speed", calm_speed, 0.0, "m/s"),
            ("reach", reach, 0.0, "m"),
        ):
            allowed = f"is a finite value of at least {least:g}"
            if field_number(f"World.run_locally {name}", value, allowed, si) < least:
                raise FieldError(f"World.run_locally {name}", value, allowed, unit=si)
        if duration > LONGEST_RUN:
            raise FieldError("World.run_locally duration", duration, f"is at most {LONGEST_RUN:g}", unit="s")
        if held_speed > 0.0 and self._state.watched == NOTHING_WATCHED:
            raise FieldError(
                "World.run_locally held_speed", held_speed, "is 0 while no body is watched", "call watch first", "m/s"
            )
        self._refuse_drag_in_turning_frame()
        setting = Setting(self._step(0.0), float(steps_per_contact), self._state.watched)
        local = self._state.stepping_locally(setting, self.time)
        # No part of the setting: both follow the speed of the lander from call to call, and another setting has all
        # plans made anew.
        local.slow_down(resolved_speed)
        local.hold(calm_speed, held_speed, reach)
        if not local.run(duration):
            self._refuse(DIVERGED)
        self.time = local.time
        self._refuse_deep()

    def _refuse_drag_in_turning_frame(self) -> None:
        if self.drag > 0.0 and self.rotation.any():
            raise FieldError(
                "World.drag", self.drag, "is 0 where World.rotation is not", "settle without a rotation", "1/s"
            )

    def _refuse_deep(self) -> None:
        """Raise FloatingPointError for a dent deeper than its law holds for, and for a body, but the watched one, that
        lies wholly behind a plane which meets it.
        """
        engine = self._state.engine
        assert engine is not None
        if engine.laws.yield_pressure.any():
            self._refuse_deep_dent(engine)
        depth = engine.planes.offset[:, None] - engine.planes.normal @ self._state.motion["position"].T
        buried = engine.planes.meets & (depth > engine.bodies.bounding_radius)
        # Who watches a body sees by itself where that is.
        if self._state.watched != NOTHING_WATCHED:
            buried[:, self._state.watched] = False
        if buried.any():
            plane, body = np.argwhere(buried)[0]
            raise FloatingPointError(
                f"body {body} lies {depth[plane, body]:.3g} m behind plane {plane} at t = {self.time:.6g} s, and no "
                "contact is deeper than its body; take a stiffer material (young_modulus), or a lighter body"
            )

    def _refuse_deep_dent(self, engine: Engine) -> None:
        bodies, pairs = engine.bodies, engine.pairs
        curvature = bodies.curvature[pairs.first_part]
        curvature = curvature + np.where(pairs.second >= 0, bodies.curvature[pairs.second_part], 0.0)
        depth = pairs.deepest * curvature
        if depth.max(initial=0.0) > DEEPEST_DENT:
            k = int(np.argmax(depth))
            raise FloatingPointError(
                f"a contact of body {pairs.first[k]} has yielded by {pairs.deepest[k]:.3g} m at t = {self.time:.6g} s, "
                f"{depth[k]:.2g} of its radius; the law holds up to {DEEPEST_DENT:g}: raise yield_strength"
            )

    def _refuse(self, reason: int) -> None:
        if reason == STEP_TOO_LARGE:
            raise StepTooLargeError(
                "World.time_step", float(f"{self.time_step:.6g}"),
                f"for the contact met at t = {self.time:.6g} s is at most {self.largest_step:.6g} s",
                "make it smaller", "s",
            )  # fmt: skip
        assert reason == DIVERGED
        raise FloatingPointError(
            f"the motion diverged at t = {self.time:.6g} s: positions are no longer finite numbers; take more "
            "steps_per_contact, or a smaller time_step"
        )

    # --- the watched body ----------------------------------------------------------------------------------------

    def watch(self, body: int) -> None:
        """Note from now on the contact forces on one body and on what is joined to it, see `watched`."""
        number = range(len(self.bodies))[body]
        self._refuse_watched({joint.second: joint.first for joint in self._state.joints}, number)
        self._state.watched = number
        self._state.watch_record[:] = new_record()

    def _refuse_watched(self, hangs_on: dict[int, int], watched: int) -> None:
        if watched in hangs_on:
            raise ValueError(
                f"World.watch body is {watched}, which is joined to body {hangs_on[watched]}; allowed is a body that "
                "hangs on no other: watch the main body"
            )

    @property
    def watched(self) -> dict[str, float]:
        """Largest contact force [N] on the watched body, and its first and last contact [s; NaN: none]."""
        record = self._watch_record
        return {
            "peak_force": float(record[PEAK_FORCE]),
            "first_contact": self._instant(record[FIRST_CONTACT]),
            "last_contact": self._instant(record[LAST_CONTACT]),
        }

    @property
    def is_touched(self) -> bool:
        """Whether anything touches the watched body."""
        if self._state.local is not None:
            return bool(self._state.local.record[TOUCHED])
        return bool(self._read().bodies.force[self._state.watched].any())

    @property
    def first_touch(self) -> float | None:
        """Instant at which the watched body was first touched [s]; None where it was not."""
        first = self.watched["first_contact"]
        return None if math.isnan(first) else first

    @property
    def touch_duration(self) -> float | None:
        """Time from the first to the last touch of the watched body [s]; None where it was not touched."""
        lasted = float(self._watch_record[LAST_CONTACT] - self._watch_record[FIRST_CONTACT])
        if math.isnan(lasted):
            return None
        # Common steps are counted, and the first and the last one of the touch both belong to it.
        return lasted if self._state.local is not None else (lasted + 1.0) * self.time_step

    @property
    def _watch_record(self) -> Floats:
        return self._state.watch_record if self._state.local is None else self._state.local.record

    def _instant(self, clock: float) -> float:
        """Return an instant [s] from what a record says of it."""
        if self._state.local is not None:
            return float(clock)
        # Counted back from the present, as `time` may have been set since the record began.
        return float(self.time - (self._state.watch_record[STEPS] - clock) * self.time_step)

    # --- on disk -------------------------------------------------------------------------------------------------

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything to an HDF5 file, whole or not at all; `World.load` continues from it bit for bit."""
        write_checkpoint(path, self._state, self._step(0.0), asdict(self._clock))

    @staticmethod
    def load(path: str | os.PathLike[str]) -> "World":
        """Read a world that `save` wrote. Raises ValueError where the file is not one."""
        state, step, clock = read_checkpoint(path)
        world = World(step.gravity, None, period=None, **state.options)
        world._state, world._clock, world.drag, world.rotation = state, Clock(**clock), step.drag, step.rotation
        return world
