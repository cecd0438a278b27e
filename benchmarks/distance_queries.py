"""What the narrow phase says of pairs: closest points, features named at another pose, gap over a plane."""

import math
import time
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
from distance_pairs import Floats, Integers, Library, Poses, units

from lithobrake.compilation import lighter_compilation
from lithobrake.compilation.compiled import disk_cache
from lithobrake.dem import Material, World
from lithobrake.dem.bodies.arrays import Bodies, Cores, Pairs, Planes
from lithobrake.dem.bodies.rigid_body import RigidBody
from lithobrake.dem.bodies.vectors import NO_PERIOD, dot, minus, put, row, scaled
from lithobrake.dem.narrow_phase.contact_patch import measure_feature
from lithobrake.dem.narrow_phase.feature_distance import ALL_FEATURES, SPHERES, feature_kind, listed_feature
from lithobrake.dem.narrow_phase.feature_list import list_bodies, list_margin, list_plane
from lithobrake.dem.narrow_phase.gjk import PENETRATING, weighted
from lithobrake.dem.narrow_phase.penetration import find_closest_points, penetration_vector
from lithobrake.dem.narrow_phase.scratch import Scratch, scratch_for
from lithobrake.dem.stepping.engine import bodies_of, parts_of, shapes_of
from lithobrake.dem.stepping.neighbours import Neighbours, new_pairs

ROCK = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=2500.0)
# Names that the list of a pair has room for.
NAMES = 20_000
NO_ONE = np.zeros((1, 1), dtype=np.bool_)
# Columns of an answer: signed distance [m], normal, point on first, point on second (from the first's centroid), steps.
DISTANCE, NORMAL, FIRST, SECOND, STEPS = 0, slice(1, 4), slice(4, 7), slice(7, 10), 10


def cached(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function as the package compiles its kernels, kept on disk beside those it calls: that folder changes
    with their sources.
    """
    outside, folder = numba.config.CACHE_DIR, disk_cache("dem").folder
    numba.config.CACHE_DIR = str(folder)
    try:
        made = numba.njit(function, cache=folder is not None, error_model="numpy")
        if lighter_compilation.is_known():
            made._compiler = lighter_compilation.KernelCompiler(made, is_inner=False)
        return made
    finally:
        numba.config.CACHE_DIR = outside


def one_pair(second: int) -> Pairs:
    """Return a pair with room for many names."""
    first, other = np.zeros(1, dtype=np.int64), np.full(1, second)
    pair = new_pairs(Neighbours(first, other, first.copy(), other.copy()))
    return pair._replace(overflow_row=np.zeros(1, dtype=np.int64), overflow=np.zeros((1, NAMES), dtype=np.int64))


def scratch(shapes: Library) -> Scratch:
    vertices, edges = (int(np.diff(s).max()) for s in (shapes.cores.vertex_start, shapes.cores.edge_start))
    return scratch_for(vertices + edges, 1)


def closest(shapes: Library, poses: Poses) -> Floats:
    """Return signed distance, normal, points and number of steps for each pair, [pair_count, 11]."""
    answer = np.zeros((len(poses.first), 11))
    ask_closest(shapes.cores, poses.first, poses.second, poses.rotation, poses.position, scratch(shapes), answer)
    return answer


@cached
def ask_closest(
    cores: Cores,
    first: Integers,
    second: Integers,
    rotation: Floats,
    position: Floats,
    scratch: Scratch,
    answer: Floats,
) -> None:
    """Search for closest points; of crossing cores, for the way out."""
    simplex = scratch.simplex
    for k in range(len(first)):
        shapes, turned = (first[k], second[k]), rotation[k]
        apart = minus(row(position[k], 1), row(position[k], 0))
        found, count, _ = find_closest_points(
            cores, simplex, scratch.turned, scratch.relative, shapes, turned, (0, 1), apart, math.inf
        )
        answer[k, STEPS] = simplex.steps[0]
        if found == PENETRATING:
            distance, normal, here, there = penetration_vector(
                cores, simplex, scratch.turned, scratch.relative, shapes, turned, (0, 1), apart
            )
        else:
            between = weighted(simplex.difference, simplex.weight, count)
            distance = dot(between, between) ** 0.5
            normal = scaled(-1.0 / distance, between)
            here = weighted(simplex.on_first, simplex.weight, count)
            there = weighted(simplex.on_second, simplex.weight, count)
        answer[k, DISTANCE] = distance
        put(answer[k : k + 1, NORMAL], 0, normal)
        put(answer[k : k + 1, FIRST], 0, here)
        put(answer[k : k + 1, SECOND], 0, there)


def search_bed(world: World, count: int) -> tuple[int, float]:
    """Search the closest points of a bed's grains so many times in all, from nothing each time: of those whose bounding
    spheres, with a tenth of the smallest radius about them, meet.

    Returns the number of pairs and the CPU time of a search [us].
    """
    engine = world._state.stepping_together(world._step(0.0))
    reach = engine.bodies.bounding_radius + 0.1 * engine.bodies.bounding_radius.min()
    apart = np.linalg.norm(world.position[:, None] - world.position, axis=2)
    first, second = np.nonzero(np.triu(apart < reach[:, None] + reach, 1))
    work = engine.cores, engine.bodies, first, second, engine.scratch
    ask_again(*work, 1)
    start = time.process_time()
    ask_again(*work, count)
    return len(first), (time.process_time() - start) / count * 1e6


@cached
def ask_again(cores: Cores, bodies: Bodies, first: Integers, second: Integers, scratch: Scratch, count: int) -> None:
    """Go through the pairs again and again."""
    for k in range(count):
        a, b = first[k % len(first)], second[k % len(first)]
        apart = minus(row(bodies.position, b), row(bodies.position, a))
        find_closest_points(
            cores, scratch.simplex, scratch.turned, scratch.relative, (bodies.shape[a], bodies.shape[b]),
            bodies.rotation, (a, b), apart, math.inf,
        )  # fmt: skip


def bodies_for(shapes: Library) -> Bodies:
    """Return two bodies of every shape, so that a shape can meet itself; they lie wherever."""
    bodies = [RigidBody(shape, ROCK, 1.0, np.eye(3)) for shape in shapes.shapes * 2]
    state = {name: np.zeros((len(bodies), 3)) for name in ("position", "velocity", "angular_momentum")}
    state["quaternion"] = np.tile([1.0, 0.0, 0.0, 0.0], (len(bodies), 1))
    parts = parts_of(bodies)
    return bodies_of(bodies, parts, shapes_of(parts), [ROCK], state, NO_PERIOD)


@cached
def turn(rotation: Floats, axis: Floats, angle: float) -> None:
    """Turn a rotation [3, 3] about an axis of the world."""
    cosine, sine = math.cos(angle), math.sin(angle)
    for k in range(3):
        x, y, z = rotation[0, k], rotation[1, k], rotation[2, k]
        along = (1.0 - cosine) * (axis[0] * x + axis[1] * y + axis[2] * z)
        rotation[0, k] = cosine * x + sine * (axis[1] * z - axis[2] * y) + along * axis[0]
        rotation[1, k] = cosine * y + sine * (axis[2] * x - axis[0] * z) + along * axis[1]
        rotation[2, k] = cosine * z + sine * (axis[0] * y - axis[1] * x) + along * axis[2]


def kept(shapes: Library, poses: Poses, generator: np.random.Generator) -> tuple[Floats, Floats]:
    """Return the smallest distance [m] of the features that were named while the first body stood elsewhere, and the
    distance up to which they are named. NaN: the names do not serve that long, or the cores crossed.
    """
    n = len(poses.first)
    distance, reach = np.full(n, np.nan), np.zeros(n)
    moves = np.column_stack([units(generator, n), units(generator, n), generator.random((n, 2))])
    pair = one_pair(1)
    ask_kept(
        shapes.cores, bodies_for(shapes), poses.first, poses.second, poses.rotation, poses.position, pair,
        scratch(shapes), moves, distance, reach,
    )  # fmt: skip
    return distance, reach


@cached
def ask_kept(
    cores: Cores, bodies: Bodies, first: Integers, second: Integers, rotation: Floats, position: Floats, pair: Pairs,
    scratch: Scratch, moves: Floats, distance: Floats, reach: Floats,
) -> None:  # fmt: skip
    """List features with the first body moved, move it back, and measure them."""
    for k in range(len(first)):
        one, two = first[k], second[k] + len(cores.rounding)
        pair.first[0], pair.second[0], pair.first_part[0], pair.second_part[0] = one, two, one, two
        for body, side in ((one, 0), (two, 1)):
            bodies.position[body], bodies.rotation[body] = position[k, side], rotation[k, side]
        reach[k] = cores.rounding[first[k]] + cores.rounding[second[k]]
        margin = list_margin(0, bodies, cores, pair, 0.0)
        travel, part = margin * moves[k, 6], moves[k, 7]
        bodies.position[one] += part * travel * moves[k, 0:3]
        turn(bodies.rotation[one], moves[k, 3:6], (1.0 - part) * travel / bodies.bounding_radius[one])
        serves = list_bodies(0, bodies, cores, pair, scratch.simplex, scratch.turned, scratch.relative, margin)
        bodies.position[one], bodies.rotation[one] = position[k, 0], rotation[k, 0]
        if pair.feature_count[0] != ALL_FEATURES and travel < serves:
            distance[k] = nearest_listed(cores, bodies, one, two, pair, reach[k])


@cached
def nearest_listed(cores: Cores, bodies: Bodies, one: int, two: int, pair: Pairs, reach: float) -> float:
    """Return the smallest distance of the named features, at most `reach` [m]."""
    apart = minus(row(bodies.position, two), row(bodies.position, one))
    if pair.feature_count[0] > 0 and feature_kind(listed_feature(0, pair, 0)) == SPHERES:
        return min(reach, dot(apart, apart) ** 0.5)
    smallest = reach
    shapes = (bodies.shape[one], bodies.shape[two])
    for k in range(pair.feature_count[0]):
        feature = listed_feature(0, pair, k)
        smallest = min(smallest, measure_feature(bodies, cores, feature, (one, two), shapes, apart, reach)[2])
    return smallest


def over_plane(shapes: Library, poses: Poses) -> Floats:
    """Return how far the first body of each pair stands over a plane through the centroid of the second [m]."""
    away = poses.position[:, 0] - poses.position[:, 1]
    normal = away / np.linalg.norm(away, axis=1)[:, None]
    gap = np.zeros(len(normal))
    pair = one_pair(-1)
    ask_plane(
        shapes.cores, bodies_for(shapes), poses.first, poses.rotation, poses.position, normal, pair, gap
    )  # fmt: skip
    return gap


@cached
def ask_plane(
    cores: Cores, bodies: Bodies, first: Integers, rotation: Floats, position: Floats, normal: Floats, pair: Pairs,
    gap: Floats,
) -> None:  # fmt: skip
    for k in range(len(first)):
        pair.first[0] = pair.first_part[0] = first[k]
        bodies.position[first[k]], bodies.rotation[first[k]] = position[k, 0], rotation[k, 0]
        planes = Planes(normal[k : k + 1], np.array([np.dot(normal[k], position[k, 1])]), pair.first, NO_ONE)
        gap[k] = list_plane(0, bodies, cores, planes, pair, math.inf)
