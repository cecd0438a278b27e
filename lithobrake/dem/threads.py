"""The time loop on several threads, with the same bits as on one.

Every pair keeps what it does to its bodies, and every body fetches it in the order of the pairs: the order in which one
thread adds it.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import numpy as np

from lithobrake.compiled import large_kernel
from lithobrake.dem.advance import (
    DIVERGED,
    DONE,
    LIST_USED_UP,
    NAMES_OVERFLOW,
    STEP_TOO_LARGE,
    act_all,
    apply_drag,
    note,
)
from lithobrake.dem.arrays import Bodies, Cores, Floats, Integers, Laws, Pairs, Planes, Reactions, Step
from lithobrake.dem.distance import Search
from lithobrake.dem.force import deliver
from lithobrake.dem.listing import renew
from lithobrake.dem.motion import drift, kick
from lithobrake.dem.stability import unsteady
from lithobrake.dem.vectors import row


class Incidence(NamedTuple):
    """Which pairs each body is in, each in the order of the pairs: as second, then, in one run, as first."""

    as_second_start: Integers  # [body_count + 1]
    as_second: Integers  # [as_second_total]
    as_first_start: Integers  # [body_count + 1]


def incidence_of(pairs: Pairs, body_count: int) -> Incidence:
    """Return the pairs of each body; pairs are ordered by (first, second), and a second body has the higher number."""
    everyone = np.arange(body_count + 1)
    among_bodies = np.flatnonzero(pairs.second >= 0)
    as_second = among_bodies[np.argsort(pairs.second[among_bodies], kind="stable")]
    return Incidence(
        np.searchsorted(pairs.second[as_second], everyone), as_second, np.searchsorted(pairs.first, everyone)
    )


def room_for(count: int) -> Reactions:
    """Return room for what so many pairs do."""
    return Reactions(*(np.zeros((count, 3)) for _ in range(3)))


@large_kernel
def begin_step(bodies: Bodies, step: Step, start: int, stop: int) -> float:
    """Kick and drift bodies start to stop; return how far their surfaces may have moved [m], see `drift`."""
    kick(bodies, step, start, stop)
    return drift(bodies, step, start, stop)


@large_kernel
def end_step(
    bodies: Bodies, pairs: Pairs, reactions: Reactions, incidence: Incidence, step: Step, start: int, stop: int
) -> None:
    """Let bodies start to stop fetch their forces, and kick them."""
    for body in range(start, stop):
        bodies.force[body] = 0.0
        bodies.torque[body] = 0.0
        for k in range(incidence.as_second_start[body], incidence.as_second_start[body + 1]):
            pair = incidence.as_second[k]
            if pairs.overlap[pair] > 0.0:
                deliver(bodies, body, 1.0, row(reactions.force, pair), row(reactions.second_torque, pair))
        for pair in range(incidence.as_first_start[body], incidence.as_first_start[body + 1]):
            if pairs.overlap[pair] > 0.0:
                deliver(bodies, body, -1.0, row(reactions.force, pair), row(reactions.first_torque, pair))
    if step.drag > 0.0:
        apply_drag(bodies, step, start, stop)
    kick(bodies, step, start, stop)


class Team:
    """Threads that share the bodies and pairs of an engine out in equal runs."""

    def __init__(self, pool: ThreadPoolExecutor, searches: list[Search], body_count: int, pairs: Pairs) -> None:
        self.pool, self.searches = pool, searches  # scratch, one for each thread and for the one that calls
        self.body_count, self.pairs = body_count, pairs
        self.reactions = room_for(len(pairs.first))
        self.incidence = incidence_of(pairs, body_count)

    def share(self, total: int, work: Callable[[int, int, Search], Any]) -> list[Any]:
        """Do a piece of work for all of a number of things: work(start, stop, scratch); return what came of it."""
        ends = [round(total * k / len(self.searches)) for k in range(len(self.searches) + 1)]
        parts = list(zip(ends[:-1], ends[1:], self.searches, strict=True))
        others = [self.pool.submit(work, *part) for part in parts[1:]]
        return [work(*parts[0]), *(other.result() for other in others)]

    def advance(
        self, step_count: int, drifted: bool, bodies: Bodies, cores: Cores, planes: Planes, laws: Laws, step: Step,
        half_skin: float, probe: int, probed: Floats,
    ) -> tuple[int, int, bool]:  # fmt: skip
        """Take up to `step_count` steps, see advance.advance."""
        pairs, reactions = self.pairs, self.reactions
        pair_count = len(pairs.first)
        for taken in range(step_count):
            if not drifted:
                ways = self.share(self.body_count, lambda start, stop, _: begin_step(bodies, step, start, stop))
                if not np.isfinite(ways).all():
                    return taken, DIVERGED, False
                if max(ways) > half_skin:
                    return taken, LIST_USED_UP, True
            lacking = self.share(
                pair_count,
                lambda start, stop, search: renew(bodies, cores, planes, pairs, search, step.time_step, start, stop),
            )
            if max(lacking) > 0:
                return taken, NAMES_OVERFLOW, True
            drifted = False
            turned = self.share(
                pair_count,
                lambda start, stop, search: act_all(
                    bodies, cores, planes, pairs, laws, step, search, reactions, start, stop
                ),
            )
            self.share(
                self.body_count,
                lambda start, stop, _: end_step(bodies, pairs, reactions, self.incidence, step, start, stop),
            )
            if probe >= 0:
                note(probe, bodies, probed)
            if unsteady(taken, max(turned), bodies, planes, pairs, laws, step.paper_mass, step.time_step):
                return taken + 1, STEP_TOO_LARGE, False
        return step_count, DONE, False
