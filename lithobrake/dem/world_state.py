"""What is in a world and how it moves, with the engine for it: made when it is asked for, left when something is added.

The engine advances `motion` in place, so what a person reads of it needs no engine.
"""

import numpy as np

from lithobrake.dem.arrays import Floats, Pairs, Step
from lithobrake.dem.assembly import inverse_inertias, rotation_matrices
from lithobrake.dem.contact_law import LOSSES
from lithobrake.dem.engine import Engine
from lithobrake.dem.local_engine import LocalEngine, Setting
from lithobrake.dem.motion import write_spins
from lithobrake.dem.neighbours import no_pairs
from lithobrake.dem.rigid_body import Plane, RigidBody

NOTHING_WATCHED = -1


class WorldState:
    """Everything that the next step of a world depends on, but gravity, drag and time step."""

    def __init__(self, options: dict[str, str]) -> None:
        self.options = options
        self.bodies: list[RigidBody] = []
        self.planes: list[Plane] = []
        # Position [m], velocity [m/s], quaternion (body to world) and angular momentum [kg m2/s], [body_count, 3 or 4].
        self.motion: dict[str, Floats] = {
            "position": np.zeros((0, 3)), "velocity": np.zeros((0, 3)), "quaternion": np.zeros((0, 4)),
            "angular_momentum": np.zeros((0, 3)),
        }  # fmt: skip
        self.pairs: Pairs = no_pairs()
        self.lost = np.zeros(LOSSES)  # J, see contact_law.py
        self.watched, self.watch_record = NOTHING_WATCHED, np.zeros(4)  # see time_loop.py
        self.thread_count = 1
        self.engine: Engine | None = None
        self.local: LocalEngine | None = None
        self._inverse_inertia = np.zeros((0, 3, 3))

    def add_body(self, body: RigidBody, motion: dict[str, Floats]) -> int:
        """Add a body in its motion, by the names above; return its number."""
        self.disassemble()
        self.motion = {name: np.vstack([array, motion[name]]) for name, array in self.motion.items()}
        self.bodies.append(body)
        return len(self.bodies) - 1

    def assembled(self, step: Step) -> Engine:
        """Return the engine for what is in the world now, with the forces of the motion at hand.

        A new one takes a step of no duration first, for which gravity and drag are those of `step`.
        """
        if self.engine is None:
            self.engine = Engine(
                self.bodies, self.planes, self.options, self.motion, self.pairs, self.lost, self.watch_record,
                self.thread_count,
            )  # fmt: skip
            self.engine.advance(1, step._replace(time_step=0.0), NOTHING_WATCHED)
        return self.engine

    def stepping_together(self, step: Step) -> Engine:
        """Return the engine, all contacts at the same steps again."""
        self._step_together()
        return self.assembled(step)

    def _step_together(self) -> None:
        if self.local is not None:
            self.local.give_back()
            self.local = None

    def stepping_locally(self, setting: Setting, time: float) -> LocalEngine:
        """Return the engine that moves each contact at its own steps, from an instant [s] on."""
        if self.local is None or self.local.setting != setting or self.local.time != time:
            engine = self.stepping_together(setting.step)
            self.local = LocalEngine(engine, self.bodies, setting, time)
        return self.local

    def disassemble(self) -> None:
        """Make ready for a change of what is in the world; contacts keep their history."""
        self._step_together()
        if self.engine is not None:
            self.engine.book()
            self.pairs = self.engine.pairs
        self.motion = {name: array.copy() for name, array in self.motion.items()}
        self.engine = None

    def use_threads(self, thread_count: int) -> None:
        """Take steps on so many threads from now on."""
        self.thread_count = thread_count
        self._step_together()
        if self.engine is not None:
            self.engine.use_threads(thread_count)

    def spin(self) -> Floats:
        """Return the angular velocities [rad/s], shape [body_count, 3], world frame."""
        if len(self._inverse_inertia) != len(self.bodies):
            self._inverse_inertia = inverse_inertias(self.bodies)
        spin, rotation = np.zeros((len(self.bodies), 3)), rotation_matrices(self.motion["quaternion"])
        write_spins(rotation, self.motion["angular_momentum"], self._inverse_inertia, spin)
        return spin
