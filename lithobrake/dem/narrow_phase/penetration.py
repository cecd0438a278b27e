"""Penetration of cores: the shortest way out, and the point where it presses."""

import math

from lithobrake.compilation.compiled import large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, Floats
from lithobrake.dem.bodies.parts import both_roundings
from lithobrake.dem.bodies.vectors import Vector, dot, minus, plus, row, scaled, times
from lithobrake.dem.narrow_phase.closest_points import find_closest_points
from lithobrake.dem.narrow_phase.gjk import PENETRATING, weighted
from lithobrake.dem.narrow_phase.patch_energy import PENETRATION, add_point
from lithobrake.dem.narrow_phase.scratch import Scratch, Simplex, TurnedFeatures
from lithobrake.dem.narrow_phase.separating_axis import largest_separation

# Where the deepest points are looked for from, beyond the way out, over the size of the pair: far above round-off.
STAND_OFF = 0.01


@large_kernel
def penetration_vector(
    cores: Cores, simplex: Simplex, turned: TurnedFeatures, relative: Floats, shapes: tuple[int, int], rotation: Floats,
    members: tuple[int, int], apart: Vector,
) -> tuple[float, Vector, Vector, Vector]:  # fmt: skip
    """Return the shortest way out of crossing cores: signed distance, unit normal from first to second, and the points
    of first and second that lie deepest in each other, relative to the first body's centroid, in the world frame.

    Writes to simplex, turned and relative.
    """
    distance, normal = largest_separation(cores, turned, relative, shapes, rotation, members, apart)
    normal = times(rotation, members[0], normal)
    # Moved apart along the way out, they come closest where they leave each other; faces, somewhere amid both.
    size = dot(apart, apart) ** 0.5 - distance
    out = scaled(STAND_OFF * size - distance, normal)
    _, count, _ = find_closest_points(
        cores, simplex, turned, relative, shapes, rotation, members, plus(apart, out), math.inf
    )
    on_second = minus(weighted(simplex.on_second, simplex.weight, count), out)
    return distance, normal, weighted(simplex.on_first, simplex.weight, count), on_second


@large_kernel
def add_penetration_point(
    bodies: Bodies, cores: Cores, scratch: Scratch, count: int, members: tuple[int, int], shapes: tuple[int, int],
    apart: Vector,
) -> int:  # fmt: skip
    """Add the point at the shortest way out, if the cores still cross; return the number of points.

    Its overlap is the depth of the cores and both roundings. It keeps two flat bars apart of which no corner lies in
    the other: the points at which their edges meet stay on the sides of both, however deep they are. And it pushes out
    the sharp edge through whose far side another has come, where the nearest points of both edges draw inward.
    Writes to scratch.
    """
    simplex, turned, relative, patch = scratch
    found, _, _ = find_closest_points(cores, simplex, turned, relative, shapes, bodies.rotation, members, apart, 0.0)
    if found != PENETRATING:
        return count
    distance, normal, on_first, on_second = penetration_vector(
        cores, simplex, turned, relative, shapes, bodies.rotation, members, apart
    )
    half_difference = 0.5 * (cores.rounding[shapes[0]] - cores.rounding[shapes[1]])
    middle = plus(scaled(0.5, plus(on_first, on_second)), scaled(half_difference, normal))
    point, reach = plus(row(bodies.position, members[0]), middle), both_roundings(cores, shapes)
    return add_point(patch, count, PENETRATION, reach - distance, point, normal)
