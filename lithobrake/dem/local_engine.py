"""The arrays of a world whose contacts take steps of their own, and the loop that gives them room."""

import numpy as np

from lithobrake.dem.agenda import new_agenda
from lithobrake.dem.arrays import Pairs, Step
from lithobrake.dem.engine import Engine
from lithobrake.dem.local_steps import (
    DIVERGED,
    DONE,
    FEATURES_OVERFLOW,
    PAIRS_FULL,
    Flight,
    Plans,
    Rules,
    advance_locally,
    catch_up,
    duration_of,
    link,
)
from lithobrake.dem.agenda import put_on
from lithobrake.dem.neighbours import new_pairs, with_more_overflow
from lithobrake.dem.threads import new_reactions
from lithobrake.dem.timestep import smallest_mass_at_contact

SKIN = 0.25
ROOM = 1.5
TUNE = [0.5, 0.02]


class LocalEngine:
    def __init__(self, engine: Engine, rigid, steps_per_contact: float, step: Step, time: float, watched: int) -> None:
        self.engine, self.bodies = engine, engine.bodies
        n = len(self.bodies.mass)
        turning = np.array([np.linalg.eigvalsh(m).max() for m in self.bodies.inverse_inertia_body])
        mass = np.array([smallest_mass_at_contact(b.shape, b.mass, b.inertia) for b in rigid])
        self.flight = Flight(
            np.full(n, time), np.full((n, 3), np.nan), np.zeros((n, 3)), np.zeros(n), turning, mass,
            np.full(n, -1), np.full(n, -1), np.zeros(8, np.int64),
        )
        self.rules = Rules(step.gravity, step.drag, step.paper_mass, steps_per_contact, SKIN * float(np.median(self.bodies.bounding_radius)), *TUNE)
        self.watched, self.record, self.counts = watched, np.array([0.0, -1.0, 0.0, 0.0]), np.zeros(2, np.int64)
        self.time = time
        self.give_room(engine.pairs, int(ROOM * len(engine.pairs.first)) + 8 * n + 64, fresh=True)

    def give_room(self, pairs: Pairs, capacity: int, fresh=False) -> None:
        used = np.flatnonzero(pairs.first >= 0)
        n = len(self.bodies.mass)
        new = new_pairs(np.full(capacity, -1), np.zeros(capacity, np.int64))
        for name in Pairs._fields[:-1]:
            getattr(new, name)[: len(used)] = getattr(pairs, name)[used]
        new = new._replace(overflow=pairs.overflow)
        reactions, last, interval, inverse_mass = new_reactions(capacity), np.full(capacity, self.time), np.zeros(capacity), np.ones(capacity)
        due = np.full(len(used), self.time)
        body_due = np.full(n, self.time)
        if not fresh:
            for name in reactions._fields:
                getattr(reactions, name)[: len(used)] = getattr(self.reactions, name)[used]
            last[: len(used)], interval[: len(used)] = self.plans.last[used], self.plans.interval[used]
            due, body_due = self.agenda.due[n + used], self.agenda.due[:n].copy()
        free = np.arange(capacity - 1, -1, -1)
        apart, spin = np.zeros((capacity, 3)), np.zeros((capacity, 2, 3))
        if not fresh:
            inverse_mass[: len(used)] = self.plans.inverse_mass[used]
            apart[: len(used)], spin[: len(used)] = self.plans.apart[used], self.plans.spin[used]
        self.pairs, self.reactions = new, reactions
        self.plans = Plans(last, interval, inverse_mass, np.zeros(capacity), apart, spin, np.full(2 * capacity, -1), free, np.array([capacity - len(used)]))
        self.agenda = new_agenda(n + capacity)
        self.flight.head[:], self.flight.stamp[:] = -1, -1
        enter(self.bodies, self.engine.planes, new, self.engine.laws, self.flight, self.plans, self.agenda, len(used), due, body_due)
        self.scratch = self.engine._scratch(new)

    def run(self, duration: float) -> int:
        end = self.time + duration
        while True:
            reason = advance_locally(
                self.bodies, self.engine.cores, self.engine.planes, self.pairs, self.engine.laws, self.scratch,
                self.reactions, self.flight, self.plans, self.agenda, end, self.watched, self.record, self.rules, self.counts,
            )
            if reason == DONE:
                break
            if reason == PAIRS_FULL:
                self.give_room(self.pairs, 2 * len(self.pairs.first))
            elif reason == FEATURES_OVERFLOW:
                self.pairs = with_more_overflow(self.pairs)
                self.scratch = self.engine._scratch(self.pairs)
            else:
                raise FloatingPointError("diverged")
        self.time = end
        catch_up(self.bodies, self.flight, end, self.rules)
        return reason


from lithobrake.compiled import large_kernel


@large_kernel
def enter(bodies, planes, pairs, laws, flight, plans, agenda, used, due, body_due):
    for pair in range(used):
        first, second = pairs.first[pair], pairs.second[pair]
        plans.duration[pair] = duration_of(bodies, planes, laws, flight, first, second)
        link(flight, plans, first, 2 * pair)
        if second >= 0:
            link(flight, plans, second, 2 * pair + 1)
        put_on(agenda, len(bodies.mass) + pair, due[pair])
    for body in range(len(bodies.mass)):
        put_on(agenda, body, body_due[body])
