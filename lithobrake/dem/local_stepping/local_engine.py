"""The arrays of a world whose contacts take steps of their own: made from those of an engine, and given back to it."""

from typing import Any, NamedTuple, Self

import numpy as np

from lithobrake.dem.bodies.arrays import Pairs, Reactions, Step
from lithobrake.dem.bodies.joint import Joint, leaders_of
from lithobrake.dem.bodies.rigid_body import RigidBody
from lithobrake.dem.bodies.vectors import folded
from lithobrake.dem.local_stepping.agenda import Agenda, Plans, Schedule, new_agenda
from lithobrake.dem.local_stepping.cells import Cells, cells_of
from lithobrake.dem.local_stepping.free_motion import Flight, Rules
from lithobrake.dem.local_stepping.holding import hold_what_is_slow
from lithobrake.dem.local_stepping.joints import Joints, joints_of
from lithobrake.dem.local_stepping.local_steps import NO_ROOM, advance_locally
from lithobrake.dem.local_stepping.neighbour_search import LISTED, NO_SLOT
from lithobrake.dem.stepping.engine import Engine
from lithobrake.dem.stepping.neighbours import free_slots, new_pairs, with_overflow_for_all, with_overflow_where_used
from lithobrake.dem.stepping.time_loop import new_reactions, new_record
from lithobrake.vocabulary.array_types import Floats

# Nothing to enter.
NOTHING: Floats = np.zeros(0)
# Slots for pairs at the start, for each body.
# A poured bed has some 5 pairs of neighbours a grain.
SLOTS = 8


# What a run has beside its engine.
TABLES: dict[str, type[Any]] = {
    "flight": Flight, "plans": Plans, "agenda": Agenda, "cells": Cells, "reactions": Reactions,
    "joints": Joints,
}  # fmt: skip


class Setting(NamedTuple):
    """What a run depends on; with another setting, plans are made anew."""

    step: Step
    steps_per_contact: float
    watched: int


def flight_of(engine: Engine, bodies: list[RigidBody], joints: list[Joint], time: float) -> Flight:
    """Return bodies that have just arrived at an instant [s] and were never planned."""
    n = len(bodies)
    moments: Floats = np.linalg.eigvalsh(engine.bodies.inverse_inertia_body).astype(np.float64)
    mass = np.array([mass for body in bodies for mass in body.smallest_masses_at_contact])
    # NaN, from which no change is small: every body is planned at its first look.
    never = np.full((n, 3), np.nan)
    stamp = np.full(len(mass) + len(engine.planes.offset), -1)
    members = [body for joint in joints for body in (joint.first, joint.second)]
    joined = np.bincount(np.array(members, dtype=np.int64), minlength=n).astype(np.int64)
    return Flight(
        time=np.full(n, time), planned=np.full(n, time), velocity=never, momentum=np.zeros((n, 3)),
        force=np.zeros((n, 3)), torque=np.zeros((n, 3)), slack=np.zeros(n), surge=np.zeros(n),
        touching=joined.copy(), turning=moments[:, -1].copy(), slenderness=moments[:, -1] / moments[:, 0],
        mass=mass, leader=leaders_of(n, joints),
        mobility=np.array([body.surface_mobility if joined[k] else 0.0 for k, body in enumerate(bodies)]),
        joints=joined, head=np.full(n, -1), stamp=stamp, held=np.zeros(n, np.bool_), fastest_held=np.zeros(1),
        resolved_speed=np.zeros(1), told=np.full(n, time),
    )  # fmt: skip


def plans_of(capacity: int, used: int, time: float) -> Plans:
    """Return slots for pairs, of which the first are used, looked at now [s]."""
    free = np.arange(capacity - 1, -1, -1)
    return Plans(
        last=np.full(capacity, time), interval=np.zeros(capacity), inverse_mass=np.ones(capacity),
        longest=np.zeros(capacity), duration=np.zeros(capacity), apart_until=np.zeros(capacity),
        apart=np.zeros((capacity, 3)), spin=np.zeros((capacity, 2, 3)),
        link=np.full(2 * capacity, -1), free=free, free_count=np.array([capacity - used]),
    )  # fmt: skip


class LocalEngine:
    """Moves the bodies of an engine on, each contact at its own steps, until it is given back."""

    def __init__(
        self, engine: Engine, bodies: list[RigidBody], joints: list[Joint], setting: Setting, time: float
    ) -> None:  # fmt: skip
        self._begin(engine, setting, time)
        self.flight = flight_of(engine, bodies, joints, time)
        self.joints = joints_of(joints, bodies, setting.steps_per_contact, time)
        self.cells = cells_of(engine.bodies, engine.skin)
        self.record = new_record()
        self.plans: Plans
        self.agenda: Agenda
        engine.list_neighbours()
        # Contacts push from their first look on.
        engine.bodies.force[:], engine.bodies.torque[:] = 0.0, 0.0
        count = len(engine.pairs.first)
        self._take(engine.pairs, max(SLOTS * len(bodies), 2 * count, 1))
        self._enter(np.concatenate([np.full(len(bodies), -np.inf), np.full(count, time)]))

    @classmethod
    def resumed(cls, engine: Engine, setting: Setting, time: float, pairs: Pairs, state: dict[str, Floats]) -> Self:
        """Go on from where another one for the same bodies stood at a time [s], with its pairs and state."""
        local = cls.__new__(cls)
        local._begin(engine, setting, time)
        engine.pairs, engine.scratch = pairs, engine.scratch_of(pairs)
        for name, table in TABLES.items():
            setattr(local, name, table(**{field: state[f"{name}/{field}"] for field in table._fields}))
        local.record = state["record"]
        return local

    def _begin(self, engine: Engine, setting: Setting, time: float) -> None:
        self.engine, self.setting, self.time = engine, setting, time
        step = setting.step
        rate = float(np.linalg.norm(step.rotation))
        self.rules = Rules(
            step.gravity, step.rotation, rate, step.drag, step.paper_mass, setting.steps_per_contact, engine.skin
        )

    @property
    def state(self) -> dict[str, Floats]:
        """All that the next look depends on, beside the engine, its pairs and the setting, by name."""
        tables = {name: getattr(self, name) for name in TABLES}
        found = {f"{name}/{field}": array for name, table in tables.items() for field, array in table._asdict().items()}
        return found | {"record": self.record}

    @property
    def pairs(self) -> Pairs:
        """The pairs in their slots, those that are free with first = -1."""
        return self.engine.pairs

    def _take(self, pairs: Pairs, capacity: int) -> None:
        used = np.flatnonzero(pairs.first >= 0)
        slots = new_pairs(free_slots(capacity))._replace(overflow=pairs.overflow)
        for name in Pairs._fields[:-1]:
            getattr(slots, name)[: len(used)] = getattr(pairs, name)[used]
        self.engine.pairs, self.engine.scratch = slots, self.engine.scratch_of(slots)
        self.reactions = new_reactions(capacity)
        self.plans = plans_of(capacity, len(used), self.time)
        self.agenda = new_agenda(len(self.flight.time) + capacity + len(self.joints.first))

    def _enter(self, due: Floats) -> None:
        """Enter bodies and pairs in their lists, see enter_all."""
        self.flight.head[:], self.flight.stamp[:] = -1, -1
        self._advance(due, -np.inf)

    def _advance(self, due: Floats, end: float) -> int:
        schedule = Schedule(self.flight, self.plans, self.agenda, self.cells)
        # Few worlds have joints, and what is compiled for them takes an eighth of all.
        joints = self.joints if len(self.joints.first) > 0 else None
        return advance_locally(
            self.engine.system(self.reactions), schedule, joints, due, end, self.rules, self.setting.watched,
            self.record,
        )  # fmt: skip

    def _widen(self) -> None:
        pairs, plans, agenda, reactions = self.pairs, self.plans, self.agenda, self.reactions
        used, n = np.flatnonzero(pairs.first >= 0), len(self.flight.time)
        self.engine.book()
        self._take(pairs, 2 * len(pairs.first))
        for name in ("last", "interval", "inverse_mass", "longest", "apart_until", "apart", "spin"):
            getattr(self.plans, name)[: len(used)] = getattr(plans, name)[used]
        for name in reactions._fields:
            getattr(self.reactions, name)[: len(used)] = getattr(reactions, name)[used]
        self._enter(np.concatenate([agenda.due[:n], agenda.due[n + used]]))

    def run(self, duration: float) -> bool:
        """Move on by a duration [s]; tell whether all is still finite."""
        engine, end = self.engine, self.time + duration
        while True:
            reason = self._advance(NOTHING, end)
            if reason == NO_SLOT:
                self._widen()
            elif reason == NO_ROOM:
                engine.pairs = with_overflow_for_all(self.pairs)
                engine.scratch = engine.scratch_of(self.pairs)
            else:
                break
        self.time = end
        return reason == LISTED and bool(np.isfinite(engine.bodies.travel).all())

    def work_since_looks(self) -> float:
        """Return what contacts have done to their bodies since they were last looked at [J], as steady forces."""
        bodies, pairs, plans, reactions = self.engine.bodies, self.pairs, self.plans, self.reactions
        pair = np.flatnonzero((pairs.first >= 0) & (pairs.overlap > 0.0))
        time = self.time - plans.last[pair]
        first, second = pairs.first[pair], pairs.second[pair]
        is_body = (second >= 0)[:, None]
        apart = np.where(is_body, bodies.position[second], 0.0) - bodies.position[first]
        # Bodies move by less than half a period between two looks, whichever image the last one took.
        moved = folded(apart - plans.apart[pair], bodies.period)
        spins = np.einsum("bij,bj->bi", bodies.inverse_inertia, bodies.angular_momentum)
        work = (reactions.force[pair] * moved).sum(axis=1)
        for torque, at, body, sign in (
            (reactions.first_torque, 0, first, -1.0), (reactions.second_torque, 1, second, 1.0),
        ):  # fmt: skip
            mean = 0.5 * (plans.spin[pair, at] + spins[body])
            turned = np.where(is_body | (at == 0), mean, 0.0) * time[:, None]
            work += sign * (torque[pair] * turned).sum(axis=1)
        # What waits has not moved, however long ago it was looked at.
        waits = np.isinf(self.agenda.due[len(self.flight.time) + pair])
        return float(work[~waits].sum())

    def slow_down(self, resolved_speed: float) -> None:
        """Take all steps of collisions at this speed [m/s] and above; of slower ones fewer, in proportion."""
        self.flight.resolved_speed[0] = resolved_speed

    def hold(self, calm: float, limit: float, reach: float) -> None:
        """Hold what is slower than `calm` [m/s] and beyond a reach [m] of the watched body, and let go what is within.

        limit: speed [m/s] with which a blow has a held body let go; 0: all are let go.
        """
        if limit > 0.0 or self.flight.held.any():
            hold_what_is_slow(
                self.engine.bodies, self.pairs, self.flight, self.plans, self.agenda, self.setting.watched,
                calm, limit, reach, self.time, self.rules,
            )  # fmt: skip

    def give_back(self) -> None:
        """Leave the engine with its pairs in order, ready for steps that all contacts share."""
        pairs = self.pairs
        self.hold(0.0, 0.0, 0.0)
        self.engine.book()
        used = np.flatnonzero(pairs.first >= 0)
        # Slots were filled as pairs were met; sums of forces at common steps run in the order of the bodies.
        order = pairs.second_part, pairs.first_part, pairs.second, pairs.first
        used = used[np.lexsort([numbers[used] for numbers in order])]
        arrays = {name: getattr(pairs, name)[used] for name in Pairs._fields[:-1]}
        self.engine.pairs = with_overflow_where_used(Pairs(**arrays, overflow=pairs.overflow))
        self.engine.list_neighbours()
