"""Distances of the narrow phase against brute force, on families of pairs that are hard on it: one line a family.

    python benchmarks/fuzz_distance.py [--pairs 48000] [--seed 1] [--shapes 100]

Errors are over the bounding radius of the smaller body. Expected is the smallest distance of all features, or, for
cores that overlap, the depth over all directions in which they can part first (distance_check.py). Positions are taken
as they are in double precision, so that at 1e5 m from the origin it is the pair of rounded positions that counts: their
rounding is 1.5e-11 m itself.
"""

import platform
import sys
import time
from typing import NamedTuple

import numba
import numpy as np
from distance_check import Meshes, gap_along, meshes_of, surface_distance, turned, widest_gap
from distance_pairs import FAMILIES, Family, Floats, Integers, Library, Poses, library, poses
from distance_queries import DISTANCE, FIRST, NORMAL, SECOND, STEPS, cached, closest, kept, over_plane
from harness import command_line, origin

# Where the distance is a smaller part of the smaller body, round-off turns the line between the points too far.
NORMAL_COUNTS = 1e-3


class Result(NamedTuple):
    """What came of a family; errors over the size of the smaller body."""

    pairs: int
    overlapping: float  # share
    not_finite: int
    distance: float  # worst error
    points: float  # worst: out of their bodies, or not as far apart along the normal as the distance says
    normal: float  # worst: gap along the normal short of the distance, or points apart across the normal
    steps_most: int
    steps_mean: float


def solids(shapes: Library) -> Meshes:
    """Return the cores as triangle meshes."""
    point = np.zeros((0, 3), dtype=np.int64)
    return meshes_of([(s.core, s.core_polyhedron.triangles if len(s.core) > 1 else point) for s in shapes.shapes])


@cached
def expect(
    meshes: Meshes, first: Integers, second: Integers, rotation: Floats, position: Floats, normal: Floats,
    distance: Floats, gap: Floats,
) -> None:  # fmt: skip
    """Write the signed distance [m] of each pair by brute force, and the gap along the normals at hand."""
    for k in range(len(first)):
        a = turned(meshes, first[k], rotation[k, 0], np.zeros(3))
        b = turned(meshes, second[k], rotation[k, 1], position[k, 1] - position[k, 0])
        gap[k] = gap_along(a, b, normal[k, 0], normal[k, 1], normal[k, 2])
        # A gap along any direction proves that they are apart; without one, all directions are tried.
        widest = gap[k] if gap[k] > 0.0 else widest_gap(meshes, first[k], second[k], a, b)
        distance[k] = surface_distance(meshes, first[k], second[k], a, b) if widest > 0.0 else widest


def outside(shapes: Library, shape: Integers, point: Floats) -> Floats:
    """Return how far points [count, 3] of the body frame are outside a core [m], shape [count]: above some face of it,
    or, for a sphere, off its centre.
    """
    start, normal, offset = shapes.cores.face_start, shapes.cores.normal, shapes.cores.offset
    result = np.linalg.norm(point, axis=1)
    for s in np.unique(shape):
        if start[s] < start[s + 1]:
            faces, own = slice(start[s], start[s + 1]), shape == s
            result[own] = (point[own] @ normal[faces].T - offset[faces]).max(axis=1)
    return result


def check_points(shapes: Library, meshes: Meshes, pairs: Poses, size: Floats) -> Result:
    answer = closest(shapes, pairs)
    # Contiguous, as for names: `expect` is compiled once.
    claimed, normal, n = answer[:, DISTANCE], answer[:, NORMAL].copy(), len(answer)
    expected, gap = np.zeros(n), np.zeros(n)
    expect(meshes, *pairs, normal, expected, gap)
    between, apart = answer[:, SECOND] - answer[:, FIRST], pairs.position[:, 1] - pairs.position[:, 0]
    along = np.einsum("ni,ni->n", between, normal)
    points = np.abs(along - claimed)
    for side, shape, seen in ((0, pairs.first, answer[:, FIRST]), (1, pairs.second, answer[:, SECOND] - apart)):
        body_frame = np.einsum("nji,nj->ni", pairs.rotation[:, side], seen)
        points = np.maximum(points, outside(shapes, shape, body_frame))
    across = np.linalg.norm(between - along[:, None] * normal, axis=1)
    counts = (claimed < 0.0) | (claimed > NORMAL_COUNTS * size)
    return Result(
        n, float((expected < 0.0).mean()), int((~np.isfinite(answer).all(axis=1)).sum()),
        worst(np.abs(claimed - expected) / size), worst(points / size),
        worst((np.maximum(claimed - gap, across) / size)[counts]),
        int(answer[:, STEPS].max()), float(answer[:, STEPS].mean()),
    )  # fmt: skip


def check_kept(shapes: Library, meshes: Meshes, pairs: Poses, size: Floats, generator: np.random.Generator) -> Result:
    """Compare distances of named features, up to that at which bodies touch; cores that cross are asked otherwise."""
    claimed, reach = kept(shapes, pairs, generator)
    n = len(claimed)
    expected, gap = np.zeros(n), np.zeros(n)
    expect(meshes, *pairs, np.zeros((n, 3)), expected, gap)
    serve = np.isfinite(claimed) & (expected > 0.0)
    error = np.abs(claimed - np.minimum(expected, reach))[serve] / size[serve]
    return Result(int(serve.sum()), 0.0, 0, worst(error), 0.0, 0.0, 0, 0.0)


def check_plane(shapes: Library, pairs: Poses, size: Floats) -> Result:
    claimed = over_plane(shapes, pairs)
    away = pairs.position[:, 0] - pairs.position[:, 1]
    normal = away / np.linalg.norm(away, axis=1)[:, None]
    corners = np.einsum("nij,nkj->nki", pairs.rotation[:, 0], shapes.corner[pairs.first]) + away[:, None]
    expected = np.einsum("nki,ni->nk", corners, normal).min(axis=1) - shapes.cores.rounding[pairs.first]
    lost = int((~np.isfinite(claimed)).sum())
    return Result(len(claimed), 0.0, lost, worst(np.abs(claimed - expected) / size), 0.0, 0.0, 0, 0.0)


def worst(errors: Floats) -> float:
    """Return the largest error, NaN if any is; 0 of none."""
    return float(errors.max()) if len(errors) else 0.0


def check(shapes: Library, meshes: Meshes, name: str, seed: int, count: int) -> Result:
    family: Family = FAMILIES[name]
    generator = np.random.default_rng((seed, list(FAMILIES).index(name)))
    pairs = poses(shapes, family, generator, count)
    size = np.minimum(shapes.size[pairs.first], shapes.size[pairs.second])
    if family.asks == "kept":
        return check_kept(shapes, meshes, pairs, size, generator)
    if family.asks == "plane":
        return check_plane(shapes, pairs, shapes.size[pairs.first])
    return check_points(shapes, meshes, pairs, size)


def main() -> None:
    parser = command_line(__doc__, seed=1)
    parser.add_argument("--pairs", type=int, default=48_000, help="of every family")
    parser.add_argument("--shapes", type=int, default=100, help="of every kind")
    chosen = parser.parse_args()
    made = origin(" ".join(sys.argv))
    print(f"# {made['command']}; {made['date']}, {made['machine']},")
    print(f"# Python {platform.python_version()}, NumPy {np.__version__}, Numba {numba.__version__}, one thread")
    print(f"{'family':18}   pairs  overlap  not finite  distance   points   normal  steps: most  mean")
    start = time.process_time()
    shapes = library(np.random.default_rng(chosen.seed), chosen.shapes)
    meshes, total = solids(shapes), 0
    for name in FAMILIES:
        r = check(shapes, meshes, name, chosen.seed, chosen.pairs)
        total += r.pairs
        line = f"{name:18} {r.pairs:7d} {100 * r.overlapping:6.0f} %  {r.not_finite:10d}   {r.distance:.1e}"
        if FAMILIES[name].asks == "closest":
            line += f"  {r.points:.1e}  {r.normal:.1e}  {r.steps_most:11d}  {r.steps_mean:4.1f}"
        print(line, flush=True)
    print(f"# {total} pairs in {time.process_time() - start:.0f} s of CPU time, compilation included")


if __name__ == "__main__":
    main()
