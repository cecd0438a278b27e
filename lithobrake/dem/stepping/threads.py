"""The time loop on several threads, with the same bits as on one.

Every thread has a run of bodies and the pairs of which they are the first. Pairs whose second is another thread's come
first, and keep what they do; then every body begins its sum with what it got from the threads before, and goes on with
its own pairs: the order in which one thread adds it.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from lithobrake.dem.bodies.arrays import Floats, Pairs, Partition, Reactions, Step
from lithobrake.dem.narrow_phase.feature_list import update_feature_lists
from lithobrake.dem.narrow_phase.scratch import Scratch, System
from lithobrake.dem.stepping.force_sums import forces_across_partitions, forces_within_partition
from lithobrake.dem.stepping.stability import step_is_too_large
from lithobrake.dem.stepping.time_loop import (
    DIVERGED,
    DONE,
    FEATURES_OVERFLOW,
    LIST_USED_UP,
    STEP_TOO_LARGE,
    begin_step,
    end_step,
    record_step,
)


def partitions_of(pairs: Pairs, body_count: int, count: int) -> list[Partition]:
    """Return so many partitions of about as many pairs each."""
    everyone = pairs.first if len(pairs.first) else np.arange(body_count)
    ends = np.array([0, *(everyone[len(everyone) * k // count] for k in range(1, count)), body_count])
    pair_ends = np.searchsorted(pairs.first, ends)
    owner = np.searchsorted(ends[1:], pairs.first, side="right")
    other = np.searchsorted(ends[1:], np.maximum(pairs.second, pairs.first), side="right")
    return [
        Partition(
            int(ends[k]), int(ends[k + 1]), int(pair_ends[k]), int(pair_ends[k + 1]),
            outgoing=np.flatnonzero((owner == k) & (other > k)), incoming=np.flatnonzero((other == k) & (owner < k)),
        )
        for k in range(count)
    ]  # fmt: skip


def new_reactions(count: int) -> Reactions:
    """Return room for what so many pairs do."""
    return Reactions(*(np.zeros((count, 3)) for _ in range(3)))


class Team:
    """Threads that work on the bodies and pairs of an engine together."""

    def __init__(self, pool: ThreadPoolExecutor, scratches: list[Scratch], body_count: int, pairs: Pairs) -> None:
        self.pool, self.scratches = pool, scratches  # scratch, one for each thread and for the one that calls
        self.reactions = new_reactions(len(pairs.first))
        self.partitions = partitions_of(pairs, body_count, len(scratches))

    def each(self, work: Callable[[Partition, Scratch], Any]) -> list[Any]:
        """Do a piece of work for every partition: work(partition, scratch); return what came of it."""
        parts = list(zip(self.partitions, self.scratches, strict=True))
        others = [self.pool.submit(work, *part) for part in parts[1:]]
        return [work(*parts[0]), *(other.result() for other in others)]

    def advance(
        self, system: System, step: Step, step_count: int, drifted: bool, travel_limit: float, watched: int,
        watch_record: Floats,
    ) -> tuple[int, int, bool]:  # fmt: skip
        """Take up to `step_count` steps, see time_loop.advance; every thread with scratch of its own."""
        bodies, cores, planes, pairs, laws, _, _ = system

        def begin(partition: Partition, _: Scratch) -> float:
            return begin_step(bodies, step, partition.start, partition.stop)

        def update_lists(partition: Partition, scratch: Scratch) -> int:
            return update_feature_lists(
                bodies, cores, planes, pairs, scratch, step.time_step, partition.first_pair, partition.last_pair
            )

        def across(partition: Partition, scratch: Scratch) -> float:
            return forces_across_partitions(system._replace(scratch=scratch), step, partition)

        def end(partition: Partition, scratch: Scratch) -> float:
            rate = forces_within_partition(system._replace(scratch=scratch), step, partition)
            end_step(bodies, step, partition.start, partition.stop)
            return rate

        for taken in range(step_count):
            if not drifted:
                ways = self.each(begin)
                if not np.isfinite(ways).all():
                    return taken, DIVERGED, False
                if max(ways) > travel_limit:
                    return taken, LIST_USED_UP, True
            if max(self.each(update_lists)) > 0:
                return taken, FEATURES_OVERFLOW, True
            drifted = False
            rates = self.each(across) + self.each(end)
            if watched >= 0:
                record_step(bodies, watched, watch_record)
            if step_is_too_large(bodies, planes, pairs, laws, step, taken, max(rates)):
                return taken + 1, STEP_TOO_LARGE, False
        return step_count, DONE, False
