"""What is in a world and how it moves, with the engine for it: made when it is asked for, left when something is added.

The engine advances `motion` in place, so what a person reads of it needs no engine.
"""

import numpy as np

from lithobrake.dem.bodies.arrays import LOSSES, Floats, Pairs, Period, Step
from lithobrake.dem.bodies.motion import write_spins
from lithobrake.dem.bodies.rigid_body import Plane, RigidBody
from lithobrake.dem.local_stepping.local_engine import LocalEngine, Setting
from lithobrake.dem.stepping.assembly import inertias, inverses, rotation_matrices
from lithobrake.dem.stepping.engine import Engine
from lithobrake.dem.stepping.neighbours import no_pairs
from lithobrake.dem.stepping.watch import new_record

NOTHING_WATCHED = -1


class WorldState:
    """Everything that the next step of a world depends on, but gravity, drag and time step."""

    def __init__(self, options: dict[str, str], period: Period) -> None:
        self.options, self.period = options, period
        self.bodies: list[RigidBody] = []
        self.planes: list[Plane] = []
        # Position [m], velocity [m/s], quaternion (body to world) and angular momentum [kg m2/s], [body_count, 3 or 4].
        self.motion: dict[str, Floats] = {
            "position": np.zeros((0, 3)), "velocity": np.zeros((0, 3)), "quaternion": np.zeros((0, 4)),
            "angular_momentum": np.zeros((0, 3)),
        }  # fmt: skip
        self.pairs: Pairs = no_pairs()
        self.lost = np.zeros(LOSSES)  # J, see Pairs
        self.watched, self.watch_record = NOTHING_WATCHED, new_record()  # of the steps that all contacts share
        self.thread_count = 1
        self.engine: Engine | None = None
        self.reader: Engine | None = None  # in place of an engine, as long as there is none
        self.local: LocalEngine | None = None
        self._mass: Floats = np.zeros(0)
        self._inverse_inertia: Floats = np.zeros((0, 3, 3))

    def add_bodies(self, bodies: list[RigidBody], motion: dict[str, Floats]) -> int:
        """Add bodies in their motion, by the names above, [count, 3 or 4]; return the number of the last."""
        self.disassemble()
        self.motion = {name: np.concatenate([array, motion[name]]) for name, array in self.motion.items()}
        self.bodies += bodies
        return len(self.bodies) - 1

    @property
    def mass(self) -> Floats:
        """Masses [kg], shape [body_count]."""
        if len(self._mass) != len(self.bodies):
            self._mass = np.array([body.mass for body in self.bodies])
        return self._mass

    @property
    def inverse_inertia(self) -> Floats:
        """Inverses of the inertias [1/(kg m2)], shape [body_count, 3, 3], body frame."""
        if len(self._inverse_inertia) != len(self.bodies):
            self._inverse_inertia = inverses(inertias(self.bodies))
        return self._inverse_inertia

    def read(self, step: Step) -> Engine:
        """Return an engine with the forces of the motion at hand, to be read: nothing that comes later depends on it.

        Where nothing has been stepped yet, one on copies takes a step of no duration, with gravity and drag of `step`.
        """
        if self.local is not None:
            self.local.sum_forces()
        if self.engine is not None:
            return self.engine
        if self.reader is None:
            motion = {name: array.copy() for name, array in self.motion.items()}
            pairs = self.pairs._replace(**{name: array.copy() for name, array in self.pairs._asdict().items()})
            self.reader = self._ready(motion, pairs, self.lost.copy(), step)
        return self.reader

    def stepping_together(self, step: Step) -> Engine:
        """Return the engine, all contacts at the same steps again; a new one has taken a step of no duration."""
        self._step_together()
        if self.engine is None:
            self.engine = self._ready(self.motion, self.pairs, self.lost, step)
        return self.engine

    def _ready(self, motion: dict[str, Floats], pairs: Pairs, lost: Floats, step: Step) -> Engine:
        engine = self._new_engine(motion, pairs, lost)
        engine.list_neighbours()
        engine.advance(1, step._replace(time_step=0.0), NOTHING_WATCHED)
        return engine

    def _new_engine(self, motion: dict[str, Floats], pairs: Pairs, lost: Floats) -> Engine:
        return Engine(
            self.bodies, self.planes, self.options, motion, pairs, lost, self.watch_record, self.thread_count,
            self.period,
        )  # fmt: skip

    def stepping_locally(self, setting: Setting, time: float) -> LocalEngine:
        """Return the engine that moves each contact at its own steps, from an instant [s] on."""
        if self.local is None or self.local.setting != setting or self.local.time != time:
            self._step_together()
            self.engine = self.engine or self._new_engine(self.motion, self.pairs, self.lost)
            self.local = LocalEngine(self.engine, self.bodies, setting, time)
            # It finds neighbours and contacts by itself, at its own reach, before anybody is held.
            self.local.run(0.0)
        return self.local

    def _step_together(self) -> None:
        self.reader = None
        if self.local is not None:
            self.local.give_back()
            self.local = None

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

    def spin(self, some: slice) -> Floats:
        """Return the angular velocities of some bodies [rad/s], shape [count, 3], world frame."""
        momentum, rotation = self.motion["angular_momentum"][some], rotation_matrices(self.motion["quaternion"][some])
        spin = np.zeros_like(momentum)
        write_spins(rotation, momentum, self.inverse_inertia[some], spin)
        return spin
