"""The time loop on several threads, with the same bits as on one.

Every thread has a run of bodies and the pairs of which they are the first. Pairs whose second is another thread's come
first, and keep what they do; then every body begins its sum with what it got from the threads before, and goes on with
its own pairs: the order in which one thread adds it.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from lithobrake.dem.advance import (
    DIVERGED,
    DONE,
    LIST_USED_UP,
    NAMES_OVERFLOW,
    STEP_TOO_LARGE,
    begin_step,
    end_step,
    note,
)
from lithobrake.dem.arrays import Bodies, Cores, Floats, Laws, Pairs, Planes, Reactions, Share, Step
from lithobrake.dem.distance import Search
from lithobrake.dem.force import act_across, act_within
from lithobrake.dem.listing import renew
from lithobrake.dem.stability import unsteady


def shares_of(pairs: Pairs, body_count: int, count: int) -> list[Share]:
    """Return so many shares of about as many pairs each."""
    everyone = pairs.first if len(pairs.first) else np.arange(body_count)
    ends = np.array([0, *(everyone[len(everyone) * k // count] for k in range(1, count)), body_count])
    pair_ends = np.searchsorted(pairs.first, ends)
    owner = np.searchsorted(ends[1:], pairs.first, side="right")
    other = np.searchsorted(ends[1:], np.maximum(pairs.second, pairs.first), side="right")
    return [
        Share(
            int(ends[k]), int(ends[k + 1]), int(pair_ends[k]), int(pair_ends[k + 1]),
            outgoing=np.flatnonzero((owner == k) & (other > k)), incoming=np.flatnonzero((other == k) & (owner < k)),
        )
        for k in range(count)
    ]  # fmt: skip


def room_for(count: int) -> Reactions:
    """Return room for what so many pairs do."""
    return Reactions(*(np.zeros((count, 3)) for _ in range(3)))


class Team:
    """Threads that share the bodies and pairs of an engine out."""

    def __init__(self, pool: ThreadPoolExecutor, searches: list[Search], body_count: int, pairs: Pairs) -> None:
        self.pool, self.searches = pool, searches  # scratch, one for each thread and for the one that calls
        self.pairs, self.reactions = pairs, room_for(len(pairs.first))
        self.shares = shares_of(pairs, body_count, len(searches))

    def each(self, work: Callable[[Share, Search], Any]) -> list[Any]:
        """Do a piece of work for every share: work(share, scratch); return what came of it."""
        parts = list(zip(self.shares, self.searches, strict=True))
        others = [self.pool.submit(work, *part) for part in parts[1:]]
        return [work(*parts[0]), *(other.result() for other in others)]

    def advance(
        self, step_count: int, drifted: bool, bodies: Bodies, cores: Cores, planes: Planes, laws: Laws, step: Step,
        half_skin: float, probe: int, probed: Floats,
    ) -> tuple[int, int, bool]:  # fmt: skip
        """Take up to `step_count` steps, see advance.advance."""
        pairs = self.pairs

        def begin(share: Share, _: Search) -> float:
            return begin_step(bodies, step, share.start, share.stop)

        def look(share: Share, search: Search) -> int:
            return renew(
                bodies, cores, planes, pairs, search, step.time_step, share.first_pair, share.last_pair
            )  # fmt: skip

        def across(share: Share, search: Search) -> float:
            return act_across(bodies, cores, planes, pairs, laws, step, search, self.reactions, share)

        def end(share: Share, search: Search) -> float:
            rate = act_within(bodies, cores, planes, pairs, laws, step, search, self.reactions, share)
            end_step(bodies, step, share.start, share.stop)
            return rate

        for taken in range(step_count):
            if not drifted:
                ways = self.each(begin)
                if not np.isfinite(ways).all():
                    return taken, DIVERGED, False
                if max(ways) > half_skin:
                    return taken, LIST_USED_UP, True
            if max(self.each(look)) > 0:
                return taken, NAMES_OVERFLOW, True
            drifted = False
            rates = self.each(across) + self.each(end)
            if probe >= 0:
                note(probe, bodies, probed)
            if unsteady(taken, max(rates), bodies, planes, pairs, laws, step.paper_mass, step.time_step):
                return taken + 1, STEP_TOO_LARGE, False
        return step_count, DONE, False
