"""The contact forces of all pairs, and their sums on the bodies of one partition or of many."""

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, Laws, Pairs, Partition, Planes, Reactions, Step
from lithobrake.dem.bodies.vectors import row
from lithobrake.dem.law.contact_law import add_wrench, contact_force
from lithobrake.dem.narrow_phase.scratch import Scratch


@large_kernel
def contact_forces(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, scratch: Scratch,
    reactions: Reactions, kept: bool, start: int, stop: int,
) -> float:  # fmt: skip
    """Compute the contact forces of pairs from start to before stop; return the largest square of a rate [1/s2].

    Writes to bodies, pairs, scratch and reactions.
    """
    fastest = 0.0
    for pair in range(start, stop):
        fastest = max(fastest, contact_force(pair, bodies, cores, planes, pairs, laws, step, scratch, reactions, kept))
    return fastest


@large_kernel
def forces_across_partitions(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, scratch: Scratch,
    reactions: Reactions, partition: Partition,
) -> float:  # fmt: skip
    """Compute the contact forces of a partition's pairs with bodies of later partitions, and keep them.

    Returns as contact_forces. Writes to bodies, pairs, scratch and reactions.
    """
    fastest = 0.0
    for k in range(len(partition.outgoing)):
        pair = partition.outgoing[k]
        rate = contact_forces(bodies, cores, planes, pairs, laws, step, scratch, reactions, True, pair, pair + 1)
        fastest = max(fastest, rate)
    return fastest


@large_kernel
def forces_within_partition(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, scratch: Scratch,
    reactions: Reactions, partition: Partition,
) -> float:  # fmt: skip
    """Sum up the contact forces on the bodies of a partition, once those across partitions are known.

    Sums run in the order of the pairs, in one partition as in many. Returns as contact_forces.
    Writes to bodies, pairs, scratch and reactions.
    """
    gather_reactions(bodies, pairs, reactions, partition)
    fastest, start = 0.0, partition.first_pair
    for k in range(len(partition.outgoing)):
        pair = partition.outgoing[k]
        rate = contact_forces(bodies, cores, planes, pairs, laws, step, scratch, reactions, False, start, pair)
        fastest, start = max(fastest, rate), pair + 1
        if pairs.overlap[pair] > 0.0:
            add_wrench(bodies, pairs.first[pair], -1.0, row(reactions.force, pair), row(reactions.first_torque, pair))
    rate = contact_forces(
        bodies, cores, planes, pairs, laws, step, scratch, reactions, False, start, partition.last_pair
    )
    return max(fastest, rate)


@kernel
def gather_reactions(bodies: Bodies, pairs: Pairs, reactions: Reactions, partition: Partition) -> None:
    """Begin the sums of a partition's bodies with what pairs of earlier partitions do to them. Writes to bodies."""
    bodies.force[partition.start : partition.stop] = 0.0
    bodies.torque[partition.start : partition.stop] = 0.0
    for k in range(len(partition.incoming)):
        pair = partition.incoming[k]
        if pairs.overlap[pair] > 0.0:
            add_wrench(bodies, pairs.second[pair], 1.0, row(reactions.force, pair), row(reactions.second_torque, pair))
