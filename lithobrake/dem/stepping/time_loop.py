"""The time loop."""

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Floats, Partition, Step
from lithobrake.dem.bodies.motion import drift, kick
from lithobrake.dem.bodies.vectors import dot, plus, row, scaled
from lithobrake.dem.narrow_phase.feature_list import update_feature_lists
from lithobrake.dem.narrow_phase.scratch import System
from lithobrake.dem.stepping.force_sums import forces_within_partition
from lithobrake.dem.stepping.stability import step_is_too_large
from lithobrake.dem.stepping.watch import STEPS, record_touch

DONE, LIST_USED_UP, FEATURES_OVERFLOW, STEP_TOO_LARGE, DIVERGED = 0, 1, 2, 3, 4


@kernel
def apply_drag(bodies: Bodies, step: Step, start: int, stop: int) -> None:
    """Add a force against every velocity and a torque against every spin, for settling. Writes to bodies."""
    for body in range(start, stop):
        velocity, spin = row(bodies.velocity_predicted, body), row(bodies.spin_predicted, body)
        momentum = plus(row(bodies.angular_momentum, body), scaled(0.5 * step.time_step, row(bodies.torque, body)))
        for axis in range(3):
            bodies.force[body, axis] -= step.drag * bodies.mass[body] * velocity[axis]
            bodies.torque[body, axis] -= step.drag * momentum[axis]
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
