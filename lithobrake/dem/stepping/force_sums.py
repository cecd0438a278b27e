"""The contact forces of all pairs, and their sums on the bodies of one partition or of many."""

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Pairs, Partition, Reactions, Step
from lithobrake.dem.bodies.vectors import row
from lithobrake.dem.law.contact_law import add_wrench, contact_force
from lithobrake.dem.narrow_phase.scratch import System


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
