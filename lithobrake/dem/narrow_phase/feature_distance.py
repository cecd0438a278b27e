"""Features of a pair as whole numbers, and closed forms of how far they are from each other."""

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Cores, Pairs
from lithobrake.dem.bodies.vectors import cross, dot, minus, plus, row, scaled
from lithobrake.vocabulary.array_types import Floats, Vector

# Two edges whose directions differ by less than this angle (squared) have no single closest point.
PARALLEL = 1e-12
# Kinds of features: a corner of the first on the second, of the second on the first (i, and one more than the number of
# the face below it, or 0), two edges (i and j), two spheres.
CORNER_OF_FIRST, CORNER_OF_SECOND, EDGES, SPHERES = 0, 1, 2, 3
KIND_BITS, INDEX_BITS = 40, 20
# Features that every pair has room for; few need more.
INLINE_FEATURES = 6
# In `feature_count`: the cores penetrate each other, and all their features are looked at.
ALL_FEATURES = -1


@kernel
def face_below(cores: Cores, shape: int, point: Vector, farthest: float) -> tuple[int, float]:
    """Return the face that a point of the body frame stands highest above, and that height.

    Stops with a face of -1 once the point is known to be farther from the core than `farthest`.
    """
    best, height = -1, 0.0
    for face in range(cores.face_start[shape], cores.face_start[shape + 1]):
        trial = dot(row(cores.normal, face), point) - cores.offset[face]
        # A point is at least as far from the core as from the plane of any face, so one face is enough to leave.
        if trial > farthest:
            return -1, trial
        if best < 0 or trial > height:
            best, height = face, trial
    return best, height


@kernel
def stands_above(cores: Cores, shape: int, face: int, point: Vector) -> tuple[float, bool]:
    """Return the height of a point over a face of a core, and whether that face is the closest of all to it.

    It is, where the foot of the point lies behind all faces across the edges of this one.
    """
    start = cores.face_start[shape]
    normal = row(cores.normal, start + face)
    height = dot(normal, point) - cores.offset[start + face]
    # Behind the face the point may be inside the core, where all faces count (`below_faces`).
    if height <= 0.0:
        return height, False
    foot = minus(point, scaled(height, normal))
    for k in range(cores.adjacent_start[start + face], cores.adjacent_start[start + face + 1]):
        other = start + cores.adjacent_face[k]
        if dot(row(cores.normal, other), foot) > cores.offset[other]:
            return height, False
    return height, True


@large_kernel
def point_to_core(cores: Cores, shape: int, point: Vector, farthest: float) -> tuple[float, Vector, bool, int]:
    """Return the signed distance of a point of the body frame to a core with faces, its gradient, whether it is nearer
    than `farthest` (if not, the rest is void), and the face where the closest point of the surface lies (-1: an edge).

    The gradient is the outward unit normal there; inside, see `below_faces`.
    """
    face, height = face_below(cores, shape, point, farthest)
    start = cores.face_start[shape]
    if face < 0:
        return height, point, False, -1
    normal = row(cores.normal, face)
    if height < 0.0:
        height, normal = below_faces(cores, shape, point, height)
        return height, normal, True, face - start
    if height == 0.0 or on_core(cores, shape, minus(point, scaled(height, normal)), face):
        return height, normal, True, face - start
    # The face that the point stands highest above need not be the nearest: an edge may be, or, below, another face.
    nearest, square = point_to_edges(cores, shape, point)
    if square == 0.0:
        return 0.0, normal, True, -1
    distance, found = square**0.5, -1
    normal = scaled(1.0 / distance, minus(point, nearest))
    for face in range(cores.face_start[shape], cores.face_start[shape + 1]):
        other = row(cores.normal, face)
        height = dot(other, point) - cores.offset[face]
        if 0.0 < height < distance and on_core(cores, shape, minus(point, scaled(height, other)), face):
            normal, distance, found = other, height, face - start
    return distance, normal, distance < farthest, found


@kernel
def below_faces(cores: Cores, shape: int, point: Vector, highest: float) -> tuple[float, Vector]:
    """Return the smooth signed distance of a point inside a core, and its gradient.

    1/d^8 = sum of 1/d_f^8 over the depths d_f below the faces (`highest`: minus the least of them): the depth below a
    face near that face, and without a kink where one face becomes nearer than another.
    """
    total, gradient = 0.0, (0.0, 0.0, 0.0)
    for face in range(cores.face_start[shape], cores.face_start[shape + 1]):
        normal = row(cores.normal, face)
        # Over the least depth, so that eighth powers neither overflow nor underflow.
        ratio = highest / (dot(normal, point) - cores.offset[face])
        fourth = ratio * ratio * ratio * ratio
        total += fourth * fourth
        gradient = plus(gradient, scaled(fourth * fourth * ratio, normal))
    root = ((total**0.5) ** 0.5) ** 0.5
    return highest / root, scaled(1.0 / (total * root), gradient)


@kernel
def on_core(cores: Cores, shape: int, foot: Vector, own: int) -> bool:
    """Whether a point in the plane of one face is behind all others, so that it lies on that face."""
    for face in range(cores.face_start[shape], cores.face_start[shape + 1]):
        if face != own and dot(row(cores.normal, face), foot) > cores.offset[face]:
            return False
    return True


@kernel
def point_to_edges(cores: Cores, shape: int, point: Vector) -> tuple[Vector, float]:
    """Return the closest point of all edges of a core, and its squared distance."""
    nearest, square = point, -1.0
    for edge in range(cores.edge_start[shape], cores.edge_start[shape + 1]):
        begin, along = row(cores.edge_begin, edge), row(cores.edge_along, edge)
        fraction = min(max(dot(minus(point, begin), along) / dot(along, along), 0.0), 1.0)
        trial = plus(begin, scaled(fraction, along))
        away = minus(point, trial)
        if square < 0.0 or dot(away, away) < square:
            nearest, square = trial, dot(away, away)
    return nearest, square


@kernel
def edge_to_edge(a: Vector, along_a: Vector, b: Vector, along_b: Vector) -> tuple[Vector, Vector]:
    fraction, other, _ = closest_fractions(a, along_a, b, along_b)
    return plus(a, scaled(fraction, along_a)), plus(b, scaled(other, along_b))


@kernel
def closest_fractions(a: Vector, along_a: Vector, b: Vector, along_b: Vector) -> tuple[float, float, bool]:
    """Return where on two edges (0 at the begin, 1 at the end) they are closest, and whether they are parallel.

    Parallel ones meet amid their overlap.
    """
    between = minus(b, a)
    aa, bb, ab = dot(along_a, along_a), dot(along_b, along_b), dot(along_a, along_b)
    ad, bd = dot(along_a, between), dot(along_b, between)
    # The determinant is aa bb - ab^2, whose digits would cancel for nearly parallel edges; the square of the cross
    # product keeps them.
    turn = cross(along_a, along_b)
    determinant = dot(turn, turn)
    parallel = determinant <= PARALLEL * aa * bb
    if not parallel:
        fraction = (ad * bb - bd * ab) / determinant
        other = (fraction * ab - bd) / bb
        if 0.0 < fraction < 1.0 and 0.0 < other < 1.0:
            return fraction, other, False
        fraction = min(max(fraction, 0.0), 1.0)
    else:
        near, far = ad / aa, (ad + ab) / aa
        low, high = max(0.0, min(near, far)), min(1.0, max(near, far))
        fraction = min(max(0.5 * (low + high), 0.0), 1.0)
    # Beyond an end of one edge the closest point of the other is that to this end, and the first follows from it.
    other = min(max((fraction * ab - bd) / bb, 0.0), 1.0)
    fraction = min(max((other * ab + ad) / aa, 0.0), 1.0)
    return fraction, other, parallel


@kernel
def write_relative(rotation: Floats, first: int, second: int, relative: Floats) -> None:
    """Write the rotation [1, 3, 3] from the second body's frame to the first's. Writes to relative."""
    for i in range(3):
        for j in range(3):
            relative[0, i, j] = (
                rotation[first, 0, i] * rotation[second, 0, j]
                + rotation[first, 1, i] * rotation[second, 1, j]
                + rotation[first, 2, i] * rotation[second, 2, j]
            )


@kernel
def edge_of(cores: Cores, shape: int, edge: int) -> tuple[Vector, Vector]:
    """Return begin and direction (not of unit length) of an edge, in the body frame."""
    k = cores.edge_start[shape] + edge
    return row(cores.edge_begin, k), row(cores.edge_along, k)


@kernel
def lowest_height(cores: Cores, shape: int, direction: Vector) -> float:
    """Return the smallest height of a core's vertices along a direction of the body frame."""
    start = cores.vertex_start[shape]
    lowest = dot(row(cores.vertex, start), direction)
    for k in range(start + 1, cores.vertex_start[shape + 1]):
        lowest = min(lowest, dot(row(cores.vertex, k), direction))
    return lowest


@kernel
def encode_feature(kind: int, i: int, j: int) -> int:
    return (kind << KIND_BITS) + (i << INDEX_BITS) + j


@kernel
def feature_kind(feature: int) -> int:
    return feature >> KIND_BITS


@kernel
def feature_indices(feature: int) -> tuple[int, int]:
    lowest = (1 << INDEX_BITS) - 1
    return (feature >> INDEX_BITS) & lowest, feature & lowest


@kernel
def add_feature(pair: int, pairs: Pairs, kind: int, i: int, j: int) -> None:
    """Add a feature to the list of a pair; the count goes on where the list is full. Writes to pairs."""
    count, feature = pairs.feature_count[pair], encode_feature(kind, i, j)
    if count < feature_capacity(pair, pairs):
        if count < INLINE_FEATURES:
            pairs.feature[pair, count] = feature
        else:
            pairs.overflow[pairs.overflow_row[pair], count - INLINE_FEATURES] = feature
    pairs.feature_count[pair] = count + 1


@kernel
def feature_capacity(pair: int, pairs: Pairs) -> int:
    return INLINE_FEATURES + pairs.overflow.shape[1] if pairs.overflow_row[pair] >= 0 else INLINE_FEATURES


@kernel
def listed_feature(pair: int, pairs: Pairs, k: int) -> int:
    return (
        pairs.feature[pair, k] if k < INLINE_FEATURES else pairs.overflow[pairs.overflow_row[pair], k - INLINE_FEATURES]
    )
