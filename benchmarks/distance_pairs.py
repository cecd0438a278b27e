"""Poses of pairs of convex bodies that are hard on a search for their distance: one family a difficulty.

Every pair is laid along a direction with a gap between the top of the first core and the bottom of the second: corners,
edges or faces meet there. Gaps, tilts and offsets are spread evenly over their orders of magnitude.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem import Box, ConvexHull, Shape, Sphere
from lithobrake.dem.bodies.arrays import Cores
from lithobrake.dem.bodies.rigid_body import AT_CENTRE
from lithobrake.dem.stepping.engine import cores_of, rotation_matrices

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
# Thickness over width of plates and needles.
SLIVER = 1e-4


class Library(NamedTuple):
    """Shapes in a row."""

    shapes: list[Shape]
    kinds: dict[str, Integers]  # the numbers of the shapes of a kind
    cores: Cores
    corner: Floats  # [shape_count, corner_max, 3], m, about the centroid; the first again where a core has fewer
    size: Floats  # [shape_count], m, bounding radius


class Poses(NamedTuple):
    """Pairs of shapes and how they stand."""

    first: Integers  # [pair_count]
    second: Integers  # [pair_count]
    rotation: Floats  # [pair_count, 2, 3, 3], body to world
    position: Floats  # [pair_count, 2, 3], m


class Family(NamedTuple):
    """What meets what (kinds of shapes; "same": itself), which features meet, and with what gap."""

    first: tuple[str, ...]
    second: tuple[str, ...]
    meet: Callable[..., tuple[Floats, Floats, Floats]]
    gap: Callable[..., Floats]
    origin: float = 0.0  # m, how far from the origin the pair stands
    asks: str = "closest"  # points, of the cores; "kept": features named at another pose; "plane": the first on a plane


def library(generator: np.random.Generator, count: int) -> Library:
    """Return `count` shapes of every kind, of half sizes from about 0.5 to 2 m, large ones a thousand times that."""
    shapes: list[Shape] = []
    kinds: dict[str, list[int]] = {}
    for _ in range(count):
        size = 2.0 ** generator.uniform(-1, 1)
        points = 0.5 * size * generator.normal(size=(generator.integers(4, 41), 3))
        lengths = size * generator.uniform(0.4, 2, 3)
        for kind, shape in (
            ("hull", ConvexHull(points)),
            ("large", ConvexHull(points * 1e3)),
            ("box", Box(lengths)),
            ("needle", ConvexHull(points * [1, SLIVER, SLIVER * 10.0 ** generator.uniform(0, 2)])),
            ("plate", ConvexHull(points * [1, 1, SLIVER])),
            ("tile", Box(lengths * [1, 1, SLIVER])),
            ("sphere", Sphere(size)),
        ):
            kinds.setdefault(kind, []).append(len(shapes))
            shapes.append(shape)
    corner_max = max(len(shape.core) for shape in shapes)
    corner = np.array([shape.core[np.arange(corner_max) % len(shape.core)] for shape in shapes])
    size = np.array([shape.bounding_radius for shape in shapes])
    return Library(
        shapes,
        {k: np.array(v) for k, v in kinds.items()},
        cores_of([(shape, AT_CENTRE) for shape in shapes]),
        corner,
        size,
    )


# --- rotations ----------------------------------------------------------------------------------------------------


def units(generator: np.random.Generator, count: int) -> Floats:
    """Return random unit vectors [count, 3]."""
    vectors = generator.normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1)[:, None]


def turns(generator: np.random.Generator, count: int) -> Floats:
    """Return random rotations [count, 3, 3]."""
    quaternions = generator.normal(size=(count, 4))
    return rotation_matrices(quaternions / np.linalg.norm(quaternions, axis=1)[:, None])


def tilts(generator: np.random.Generator, count: int) -> Floats:
    """Return rotations [count, 3, 3] by angles of 1e-14 to 1e-3 rad, or, half of them, by none."""
    half = 0.5 * 10.0 ** generator.uniform(-14, -3, count) * (generator.random(count) < 0.5)
    return rotation_matrices(np.column_stack([np.cos(half), np.sin(half)[:, None] * units(generator, count)]))


def frames(along: Floats, beside: Floats) -> Floats:
    """Return rotations [count, 3, 3] whose first column is `along` and whose second lies on the side of `beside`."""
    x = along / np.linalg.norm(along, axis=1)[:, None]
    z = np.cross(x, beside)
    z /= np.linalg.norm(z, axis=1)[:, None]
    return np.stack([x, np.cross(z, x), z], axis=2)


def onto(rotation: Floats, vector: Floats) -> Floats:
    """Return the vectors [count, 3] turned."""
    return np.einsum("nij,nj->ni", rotation, vector)


def top(shapes: Library, shape: Integers, rotation: Floats, direction: Floats) -> Floats:
    """Return the corner [count, 3] of each core, turned, that lies farthest along a direction of the world."""
    corners = np.einsum("nij,nkj->nki", rotation, shapes.corner[shape])
    return corners[np.arange(len(shape)), np.einsum("nki,ni->nk", corners, direction).argmax(axis=1)]


def pick(generator: np.random.Generator, start: Integers, shape: Integers) -> Integers:
    """Return one of the items start[shape] ... start[shape + 1] - 1 at random for each shape."""
    return start[shape] + (generator.random(len(shape)) * (start[shape + 1] - start[shape])).astype(np.int64)


# --- what meets: rotation of both, direction, and shift across it (in sizes of the smaller) -----------------------


def corners_meet(shapes: Library, generator: np.random.Generator, first: Integers, second: Integers) -> tuple:
    """Corner to corner, across a random direction."""
    n = len(first)
    rotation = np.stack([turns(generator, n), turns(generator, n)], axis=1)
    direction = units(generator, n)
    between = top(shapes, first, rotation[:, 0], direction) - top(shapes, second, rotation[:, 1], -direction)
    return rotation, direction, between


def corner_meets_face(shapes: Library, generator: np.random.Generator, first: Integers, second: Integers) -> tuple:
    """A face of the first, and whatever corner of the second comes to it."""
    n = len(first)
    rotation = np.stack([turns(generator, n), turns(generator, n)], axis=1)
    direction = onto(rotation[:, 0], shapes.cores.normal[pick(generator, shapes.cores.face_start, first)])
    return rotation, direction, slide(shapes, generator, first, second)


def faces_meet(shapes: Library, generator: np.random.Generator, first: Integers, second: Integers) -> tuple:
    """Face against face, parallel to rounding or tilted."""
    n = len(first)
    own, other = (shapes.cores.normal[pick(generator, shapes.cores.face_start, k)] for k in (first, second))
    rotation = turns(generator, n)
    direction = onto(rotation, own)
    aside, hence = frames(-direction, units(generator, n)), frames(other, units(generator, n))
    turned = np.einsum("nij,njk,nlk->nil", tilts(generator, n), aside, hence)
    return np.stack([rotation, turned], axis=1), direction, slide(shapes, generator, first, second)


def boxes_stand(shapes: Library, generator: np.random.Generator, first: Integers, second: Integers) -> tuple:
    """Boxes along the axes: their faces and edges are parallel to the last bit."""
    n = len(first)
    axis = generator.integers(0, 3, n)
    direction = np.eye(3)[axis] * generator.choice([-1.0, 1.0], n)[:, None]
    shift = slide(shapes, generator, first, second) * (generator.random((n, 1)) < 0.8)
    return np.tile(np.eye(3), (n, 2, 1, 1)), direction, shift


def edges_meet(shapes: Library, generator: np.random.Generator, first: Integers, second: Integers) -> tuple:
    """Edge along edge, parallel to rounding or tilted."""
    cores, n = shapes.cores, len(first)
    along, middle = [], []
    for shape in (first, second):
        edge = pick(generator, cores.edge_start, shape)
        share = generator.random((n, 1))
        left, right = (cores.normal[cores.face_start[shape] + cores.edge[edge, k]] for k in (2, 3))
        along.append(cores.edge_along[edge])
        middle.append(share * left + (1.0 - share) * right)
    rotation = turns(generator, n)
    direction = onto(rotation, middle[0])
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    aside, hence = frames(-direction, onto(rotation, along[0])), frames(middle[1], along[1])
    turned = np.einsum("nij,njk,nlk->nil", tilts(generator, n), aside, hence)
    between = top(shapes, first, rotation, direction) - top(shapes, second, turned, -direction)
    between += generator.uniform(-1, 1, (n, 1)) * onto(rotation, along[0])
    return np.stack([rotation, turned], axis=1), direction, between


def nothing_meets(shapes: Library, generator: np.random.Generator, first: Integers, second: Integers) -> tuple:
    """Random rotations about one place."""
    n = len(first)
    return np.stack([turns(generator, n), turns(generator, n)], axis=1), units(generator, n), np.zeros((n, 3))


def almost_itself(shapes: Library, generator: np.random.Generator, first: Integers, second: Integers) -> tuple:
    """The same rotation twice, or tilted."""
    n = len(first)
    rotation = turns(generator, n)
    return np.stack([rotation, tilts(generator, n) @ rotation], axis=1), units(generator, n), np.zeros((n, 3))


def slide(shapes: Library, generator: np.random.Generator, first: Integers, second: Integers) -> Floats:
    """Return shifts [count, 3] as large as the larger of two bodies, at most."""
    size = np.maximum(shapes.size[first], shapes.size[second])
    return size[:, None] * generator.uniform(-0.6, 0.6, (len(first), 3))


# --- gaps [m]; `touching` is how far the centroids stand apart along the direction where the cores touch -----------


def smaller(shapes: Library, first: Integers, second: Integers) -> Floats:
    """Return the bounding radius of the smaller of two bodies [m]."""
    return np.minimum(shapes.size[first], shapes.size[second])


def wide(shapes: Library, generator: np.random.Generator, first: Integers, second: Integers, _: Floats) -> Floats:
    """Apart by up to twice the smaller, or overlapping by half of it."""
    return smaller(shapes, first, second) * generator.uniform(-0.5, 2, len(first))


def fine(shapes: Library, generator: np.random.Generator, first: Integers, second: Integers, _: Floats) -> Floats:
    """Apart or overlapping by 1e-17 to 0.1 of the smaller, or by nothing."""
    n = len(first)
    return (
        smaller(shapes, first, second) * 10.0 ** generator.uniform(-17, -1, n) * generator.choice([-1, 0, 1, 1, 1], n)
    )


def deep(shapes: Library, generator: np.random.Generator, first: Integers, _: Integers, touching: Floats) -> Floats:
    """Overlapping by anything up to one centroid over the other."""
    return -touching * generator.random(len(first))


def centred(
    shapes: Library, generator: np.random.Generator, first: Integers, second: Integers, touching: Floats
) -> Floats:
    """Centroids apart by 1e-17 to 0.1 of the smaller, or by nothing."""
    return fine(shapes, generator, first, second, touching) - touching


def resting(shapes: Library, generator: np.random.Generator, first: Integers, second: Integers, _: Floats) -> Floats:
    """As bodies in contact: cores apart by up to one and a half times their roundings."""
    rounding = shapes.cores.rounding
    return 1.5 * (rounding[first] + rounding[second]) * generator.random(len(first))


ROUND, THIN = ("hull", "box"), ("needle", "plate", "tile")
EVERY = (*ROUND, *THIN)
FAMILIES = {
    "hulls": Family(("hull",), ("hull",), corners_meet, wide),
    "boxes": Family(("box",), ("box",), corners_meet, wide),
    "spheres and hulls": Family(("sphere",), ("sphere", *EVERY), corners_meet, wide),
    "slivers": Family(THIN, THIN, corners_meet, wide),
    "slivers on hulls": Family(THIN, ROUND, corner_meets_face, fine),
    "corners touch": Family(EVERY, EVERY, corners_meet, fine),
    "corner on face": Family(ROUND, ROUND, corner_meets_face, fine),
    "faces parallel": Family(("box",), ("box",), boxes_stand, fine),
    "faces askew": Family(ROUND, ROUND, faces_meet, fine),
    "faces of slivers": Family(THIN, THIN, faces_meet, fine),
    "edges parallel": Family(ROUND, ROUND, edges_meet, fine),
    "edges of slivers": Family(THIN, THIN, edges_meet, fine),
    "deep overlap": Family(EVERY, EVERY, corners_meet, deep),
    "nested": Family(("large",), (*EVERY, "sphere"), nothing_meets, centred),
    "nearly itself": Family(EVERY, ("same",), almost_itself, centred),
    "large, then small": Family(("large",), EVERY, corner_meets_face, fine),
    "small, then large": Family(EVERY, ("large",), corners_meet, wide),
    "1e5 m away": Family(EVERY, EVERY, corners_meet, fine, 1e5),
    "names kept": Family((*EVERY, "sphere"), (*EVERY, "sphere"), corners_meet, resting, asks="kept"),
    "names kept, faces": Family(EVERY, EVERY, faces_meet, resting, asks="kept"),
    "on a plane": Family((*EVERY, "sphere"), ("sphere",), nothing_meets, resting, asks="plane"),
}


def poses(shapes: Library, family: Family, generator: np.random.Generator, count: int) -> Poses:
    first = generator.choice(np.concatenate([shapes.kinds[kind] for kind in family.first]), count)
    same = family.second == ("same",)
    second = first if same else generator.choice(np.concatenate([shapes.kinds[k] for k in family.second]), count)
    rotation, direction, shift = family.meet(shapes, generator, first, second)
    bottom = top(shapes, second, rotation[:, 1], -direction)
    touching = np.einsum("ni,ni->n", top(shapes, first, rotation[:, 0], direction) - bottom, direction)
    gap = family.gap(shapes, generator, first, second, touching)
    across = shift - np.einsum("ni,ni->n", shift, direction)[:, None] * direction
    apart = (touching + gap)[:, None] * direction + across
    origin = family.origin * units(generator, count)
    return Poses(first, second, rotation, np.stack([origin, origin + apart], axis=1))
