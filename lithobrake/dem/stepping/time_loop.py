"""The time loop, on one thread or several with the same bits: sums of forces, and the watched body."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Pairs, Partition, Reactions, Step
from lithobrake.dem.bodies.motion import drift, kick
from lithobrake.dem.bodies.vectors import dot, plus, row, scaled
from lithobrake.dem.law.contact_law import add_wrench, contact_force
from lithobrake.dem.narrow_phase.feature_list import update_feature_lists
from lithobrake.dem.narrow_phase.scratch import Scratch, System
from lithobrake.dem.stepping.time_step_stability import step_is_too_large
from lithobrake.vocabulary.array_types import Floats, Vector

# Where it stands in a record: largest force [N]; first and last instant of touch (NaN: none) by the clock of the
# stepping, steps taken or seconds (World.watched gives seconds); whether anything touches it, 1 or 0; steps taken.
PEAK_FORCE, FIRST_CONTACT, LAST_CONTACT, TOUCHED, STEPS = 0, 1, 2, 3, 4
DONE, LIST_USED_UP, FEATURES_OVERFLOW, STEP_TOO_LARGE, DIVERGED = 0, 1, 2, 3, 4


@large_kernel
def contact_forces(system: System, step: Step, kept: bool, start: int, stop: int) -> float:
    """Compute the contact forces of pairs from start to before stop; return the largest square of a rate [1/s2].

    Writes to system.
    """
    fastest = 0.0
    for pair in range(start, stop):
        fastest = max(fastest, contact_force(pair, system, step, kept))
    return fastest


@large_kernel
def forces_across_partitions(system: System, step: Step, partition: Partition) -> float:
    """Compute the contact forces of a partition's pairs with bodies of later partitions, and keep them.

    Returns as contact_forces. Writes to system.
    """
    fastest = 0.0
    for k in range(len(partition.outgoing)):
        pair = partition.outgoing[k]
        fastest = max(fastest, contact_forces(system, step, True, pair, pair + 1))
    return fastest


@large_kernel
def forces_within_partition(system: System, step: Step, partition: Partition) -> float:
    """Sum up the contact forces on the bodies of a partition, once those across partitions are known.

    Sums run in the order of the pairs, in one partition as in many. Returns as contact_forces. Writes to system.
    """
    bodies, pairs, reactions = system.bodies, system.pairs, system.reactions
    gather_reactions(bodies, pairs, reactions, partition)
    fastest, start = 0.0, partition.first_pair
    for k in range(len(partition.outgoing)):
        pair = partition.outgoing[k]
        fastest, start = max(fastest, contact_forces(system, step, False, start, pair)), pair + 1
        # The reactions of a pair that is apart are still those of its last touch.
        if pairs.overlap[pair] > 0.0:
            add_wrench(bodies, pairs.first[pair], -1.0, row(reactions.force, pair), row(reactions.first_torque, pair))
    return max(fastest, contact_forces(system, step, False, start, partition.last_pair))


@kernel
def gather_reactions(bodies: Bodies, pairs: Pairs, reactions: Reactions, partition: Partition) -> None:
    """Begin the sums of a partition's bodies with what pairs of earlier partitions do to them. Writes to bodies."""
    bodies.force[partition.start : partition.stop] = 0.0
    bodies.torque[partition.start : partition.stop] = 0.0
    for k in range(len(partition.incoming)):
        pair = partition.incoming[k]
        if pairs.overlap[pair] > 0.0:
            add_wrench(bodies, pairs.second[pair], 1.0, row(reactions.force, pair), row(reactions.second_torque, pair))


def new_record() -> Floats:
    return np.array([0.0, np.nan, np.nan, 0.0, 0.0])


@kernel
def record_touch(force: Vector, touched: bool, now: float, record: Floats) -> None:
    """Note whether the watched body is touched now, and if so the force on it [N] and the instant. Writes to record."""
    record[TOUCHED] = 1.0 if touched else 0.0
    if touched:
        record[PEAK_FORCE] = max(record[PEAK_FORCE], dot(force, force) ** 0.5)
        if np.isnan(record[FIRST_CONTACT]):
            record[FIRST_CONTACT] = now
        record[LAST_CONTACT] = now


@kernel
def apply_drag(bodies: Bodies, step: Step, start: int, stop: int) -> None:
    """Add a force against every velocity and a torque against every spin, for settling. Writes to bodies."""
    for body in range(start, stop):
        velocity, spin = row(bodies.velocity_predicted, body), row(bodies.spin_predicted, body)
        momentum = plus(row(bodies.angular_momentum, body), scaled(0.5 * step.time_step, row(bodies.torque, body)))
        for axis in range(3):
            bodies.force[body, axis] -= step.drag * bodies.mass[body] * velocity[axis]
            bodies.torque[body, axis] -= step.drag * momentum[axis]
        # Twice the kinetic energy: where velocities fall as exp(-drag t), energy is lost at the rate 2 drag E.
        energy = bodies.mass[body] * dot(velocity, velocity) + dot(spin, momentum)
        bodies.dragged[body] += step.drag * energy * step.time_step


@large_kernel
def begin_step(bodies: Bodies, step: Step, start: int, stop: int) -> float:
    """Kick and drift bodies start to stop; return how far their surfaces may have moved [m], see `drift`.

    Writes to bodies.
    """
    kick(bodies, step, start, stop)
    return drift(bodies, step, start, stop)


@large_kernel
def end_step(bodies: Bodies, step: Step, start: int, stop: int) -> None:
    """Kick bodies start to stop under their new forces. Writes to bodies."""
    if step.drag > 0.0:
        apply_drag(bodies, step, start, stop)
    kick(bodies, step, start, stop)


@large_kernel
def advance(
    system: System, step: Step, whole: Partition, step_count: int, drifted: bool, travel_limit: float, watched: int,
    watch_record: Floats,
) -> tuple[int, int, bool]:  # fmt: skip
    """Take up to `step_count` steps.

    Returns the steps taken, why it stopped, and whether the step in hand has drifted but not yet felt its forces (it
    goes on from there once the neighbour list is renewed). Body `watched` (none: -1) is recorded, see watch.py.
    `whole` is the partition of all bodies; there is no room in the reactions. Writes to system and watch_record.
    """
    bodies, cores, planes, pairs, laws, scratch, _ = system
    for taken in range(step_count):
        if not drifted:
            farthest = begin_step(bodies, step, whole.start, whole.stop)
            if not np.isfinite(farthest):
                return taken, DIVERGED, False
            if farthest > travel_limit:
                return taken, LIST_USED_UP, True
        lacking = update_feature_lists(
            bodies, cores, planes, pairs, scratch, step.time_step, whole.first_pair, whole.last_pair
        )
        if lacking > 0:
            return taken, FEATURES_OVERFLOW, True
        drifted = False
        rate = forces_within_partition(system, step, whole)
        end_step(bodies, step, whole.start, whole.stop)
        if watched >= 0:
            record_step(bodies, watched, watch_record)
        if step_is_too_large(bodies, planes, pairs, laws, step, taken, rate):
            return taken + 1, STEP_TOO_LARGE, False
    return step_count, DONE, False


@kernel
def record_step(bodies: Bodies, watched: int, watch_record: Floats) -> None:
    """Count a step, and note what its contacts did to the watched body. Writes to watch_record."""
    watch_record[STEPS] += 1.0
    force = row(bodies.force, watched)
    record_touch(force, dot(force, force) > 0.0, watch_record[STEPS], watch_record)


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
    return Reactions(*(np.zeros((count, 3)) for _ in range(3)))


class Team:
    def __init__(self, pool: ThreadPoolExecutor, scratches: list[Scratch], body_count: int, pairs: Pairs) -> None:
        self.pool, self.scratches = pool, scratches  # scratch, one for each thread and for the one that calls
        self.reactions = new_reactions(len(pairs.first))
        self.partitions = partitions_of(pairs, body_count, len(scratches))

    def each(self, work: Callable[[Partition, Scratch], Any]) -> list[Any]:
        parts = list(zip(self.partitions, self.scratches, strict=True))
        # The first share is worked on by the thread that calls, which would otherwise only wait.
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
            # Two rounds: no sum may begin before all reactions across partitions are known.
            rates = self.each(across) + self.each(end)
            if watched >= 0:
                record_step(bodies, watched, watch_record)
            if step_is_too_large(bodies, planes, pairs, laws, step, taken, max(rates)):
                return taken + 1, STEP_TOO_LARGE, False
        return step_count, DONE, False
