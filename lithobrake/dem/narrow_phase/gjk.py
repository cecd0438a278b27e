"""Distance of two convex cores by GJK, and the point of a simplex closest to the origin."""

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Cores
from lithobrake.dem.bodies.vectors import cross, dot, minus, plus, put, row, scaled, times, transposed_times
from lithobrake.dem.narrow_phase.scratch import Simplex
from lithobrake.vocabulary.array_types import Floats, Vector

Weights = tuple[float, float, float, float]
# Squared distance still to be gained, over the squared distance, at which the search ends.
CONVERGED = 1e-14
# Distance over the size of the pair that may still be gained where the search cannot go on.
EXACT = 1e-13
# Distance over the size of the pair below which cores are taken as touching.
TOUCHING = 1e-13
ITERATIONS = 100
APART, CLOSE, PENETRATING, UNSURE = 0, 1, 2, 3


@kernel
def segment_weights(a: Vector, b: Vector) -> tuple[float, float]:
    along = minus(b, a)
    length_squared = dot(along, along)
    # Both ends at one place, as where two pairs of vertices have the same difference: each is the closest point.
    if length_squared == 0.0:
        return (1.0, 0.0)
    fraction = min(max(-dot(a, along) / length_squared, 0.0), 1.0)
    return (1.0 - fraction, fraction)


@kernel
def triangle_weights(a: Vector, b: Vector, c: Vector) -> tuple[float, float, float]:
    ab, ac = minus(b, a), minus(c, a)
    normal = cross(ab, ac)
    square = dot(normal, normal)
    if square > 0.0:
        weight_b = -dot(normal, cross(a, ac)) / square
        weight_c = -dot(normal, cross(ab, a)) / square
        weight_a = 1.0 - weight_b - weight_c
        if weight_a >= 0.0 and weight_b >= 0.0 and weight_c >= 0.0:
            return (weight_a, weight_b, weight_c)
    # The foot of the origin lies outside, or the triangle has no area: the closest point is on an edge.
    ab_a, ab_b = segment_weights(a, b)
    bc_b, bc_c = segment_weights(b, c)
    ca_c, ca_a = segment_weights(c, a)
    on_ab = plus(scaled(ab_a, a), scaled(ab_b, b))
    on_bc = plus(scaled(bc_b, b), scaled(bc_c, c))
    on_ca = plus(scaled(ca_c, c), scaled(ca_a, a))
    square_ab, square_bc, square_ca = dot(on_ab, on_ab), dot(on_bc, on_bc), dot(on_ca, on_ca)
    if square_ab <= square_bc and square_ab <= square_ca:
        return (ab_a, ab_b, 0.0)
    if square_bc <= square_ca:
        return (0.0, bc_b, bc_c)
    return (ca_a, 0.0, ca_c)


@kernel
def tetrahedron_weights(a: Vector, b: Vector, c: Vector, d: Vector) -> Weights:
    """Return the weights of the corners of a tetrahedron; all are positive where it holds the origin."""
    ab, ac, ad = minus(b, a), minus(c, a), minus(d, a)
    six_volume = dot(ab, cross(ac, ad))
    # A tetrahedron without volume holds nothing, so with these weights all of its faces are tried.
    weight_a, weight_b, weight_c, weight_d = -1.0, -1.0, -1.0, -1.0
    if six_volume != 0.0:
        weight_b = -dot(a, cross(ac, ad)) / six_volume
        weight_c = -dot(a, cross(ad, ab)) / six_volume
        weight_d = -dot(a, cross(ab, ac)) / six_volume
        weight_a = 1.0 - weight_b - weight_c - weight_d
        if weight_a > 0.0 and weight_b > 0.0 and weight_c > 0.0 and weight_d > 0.0:
            return (weight_a, weight_b, weight_c, weight_d)
    best, nearest = (0.0, 0.0, 0.0, 0.0), -1.0
    # Only a face that parts the origin from the opposite corner can carry the closest point.
    if weight_a <= 0.0:
        u, v, w = triangle_weights(b, c, d)
        point = plus(plus(scaled(u, b), scaled(v, c)), scaled(w, d))
        best, nearest = (0.0, u, v, w), dot(point, point)
    if weight_b <= 0.0:
        u, v, w = triangle_weights(a, c, d)
        point = plus(plus(scaled(u, a), scaled(v, c)), scaled(w, d))
        if nearest < 0.0 or dot(point, point) < nearest:
            best, nearest = (u, 0.0, v, w), dot(point, point)
    if weight_c <= 0.0:
        u, v, w = triangle_weights(a, b, d)
        point = plus(plus(scaled(u, a), scaled(v, b)), scaled(w, d))
        if nearest < 0.0 or dot(point, point) < nearest:
            best, nearest = (u, v, 0.0, w), dot(point, point)
    if weight_d <= 0.0:
        u, v, w = triangle_weights(a, b, c)
        point = plus(plus(scaled(u, a), scaled(v, b)), scaled(w, c))
        if nearest < 0.0 or dot(point, point) < nearest:
            best, nearest = (u, v, w, 0.0), dot(point, point)
    return best


@kernel
def simplex_weights(count: int, a: Vector, b: Vector, c: Vector, d: Vector) -> Weights:
    """Return the weights for the first `count` corners; the others are not read and weigh nothing."""
    if count == 1:
        return (1.0, 0.0, 0.0, 0.0)
    if count == 2:
        weight_a, weight_b = segment_weights(a, b)
        return (weight_a, weight_b, 0.0, 0.0)
    if count == 3:
        weight_a, weight_b, weight_c = triangle_weights(a, b, c)
        return (weight_a, weight_b, weight_c, 0.0)
    return tetrahedron_weights(a, b, c, d)


@kernel
def support(cores: Cores, shape: int, direction: Vector) -> int:
    """Return the core vertex of a shape that lies farthest along a direction of the body frame."""
    start, end = cores.vertex_start[shape], cores.vertex_start[shape + 1]
    best, farthest = start, dot(row(cores.vertex, start), direction)
    for k in range(start + 1, end):
        height = dot(row(cores.vertex, k), direction)
        if height > farthest:
            best, farthest = k, height
    return best - start


@kernel
def place_corner(
    cores: Cores, simplex: Simplex, k: int, shapes: tuple[int, int], rotation: Floats, members: tuple[int, int],
    apart: Vector,
) -> None:  # fmt: skip
    """Compute corner k of the simplex from its two vertices. Writes to simplex."""
    first = times(rotation, members[0], row(cores.vertex, cores.vertex_start[shapes[0]] + simplex.vertex[k, 0]))
    second = times(rotation, members[1], row(cores.vertex, cores.vertex_start[shapes[1]] + simplex.vertex[k, 1]))
    second = plus(second, apart)
    put(simplex.on_first, k, first)
    put(simplex.on_second, k, second)
    put(simplex.difference, k, minus(first, second))


@kernel
def weighted(array: Floats, weight: Floats, count: int) -> Vector:
    total = scaled(weight[0], row(array, 0))
    for k in range(1, count):
        total = plus(total, scaled(weight[k], row(array, k)))
    return total


@kernel
def reduce_simplex(simplex: Simplex, count: int, closest_before: float) -> tuple[int, bool]:
    """Drop the corners that do not carry the closest point; refuse a step that comes no closer (second value False).

    Writes to simplex.
    """
    d = simplex.difference
    a, b, c, e = row(d, 0), row(d, 1), row(d, 2), row(d, 3)
    weights = simplex_weights(count, a, b, c, e)
    point = plus(plus(scaled(weights[0], a), scaled(weights[1], b)), plus(scaled(weights[2], c), scaled(weights[3], e)))
    # A step that comes no closer is due to rounding; with it the search would go round in circles.
    if closest_before >= 0.0 and dot(point, point) >= closest_before:
        return count - 1, False
    kept = 0
    for k in range(count):
        if weights[k] > 0.0:
            simplex.weight[kept] = weights[k]
            simplex.vertex[kept, 0], simplex.vertex[kept, 1] = simplex.vertex[k, 0], simplex.vertex[k, 1]
            put(simplex.on_first, kept, row(simplex.on_first, k))
            put(simplex.on_second, kept, row(simplex.on_second, k))
            put(d, kept, row(d, k))
            kept += 1
    return kept, True


@large_kernel
def closest_simplex(
    cores: Cores, simplex: Simplex, shapes: tuple[int, int], rotation: Floats, members: tuple[int, int], apart: Vector,
    margin: float,
) -> tuple[int, int, float]:  # fmt: skip
    """Search for the simplex of differences that carries the closest points of the cores.

    Returns what was found (APART: farther than the margin; CLOSE: points in `simplex`; PENETRATING; UNSURE: rounding
    ended the search without proof), the number of corners, and a lower bound of the distance where they are apart.
    Writes to simplex.
    """
    # Any pair of vertices will do: beginning along the line of centres saves 3 % of a search, and nothing of a step.
    simplex.vertex[0, 0], simplex.vertex[0, 1] = 0, 0
    place_corner(cores, simplex, 0, shapes, rotation, members, apart)
    count, _ = reduce_simplex(simplex, 1, -1.0)
    for step in range(ITERATIONS):
        simplex.steps[0] = step + 1
        closest = weighted(simplex.difference, simplex.weight, count)
        square, size = dot(closest, closest), largest(simplex.difference, count)
        if square <= TOUCHING * TOUCHING * size:
            return PENETRATING, count, 0.0
        # All four corners carry the closest point, so it is the origin, which TOUCHING denies: the tetrahedron is flat
        # to rounding.
        if count == 4:
            return UNSURE, count, 0.0
        backward = scaled(-1.0, closest)
        simplex.vertex[count, 0] = support(cores, shapes[0], transposed_times(rotation, members[0], backward))
        simplex.vertex[count, 1] = support(cores, shapes[1], transposed_times(rotation, members[1], closest))
        corner = find_corner(simplex, count)
        if corner == count:
            place_corner(cores, simplex, count, shapes, rotation, members, apart)
        # All of the difference set lies beyond the plane across `closest` through this corner, so its distance is a
        # lower bound: the proof that the search is over.
        bound = dot(closest, row(simplex.difference, corner))
        if bound > 0.0 and bound * bound > margin * margin * square:
            return APART, count, bound / square**0.5
        if square - bound <= CONVERGED * square:
            return CLOSE, count, 0.0
        closer = False
        if corner == count:
            count, closer = reduce_simplex(simplex, count + 1, square)
        if not closer:
            # Rounding leaves no way to go on: what is missing yet counts by the size, as rounding does.
            gain = (square - bound) / square**0.5
            return CLOSE if gain <= EXACT * size**0.5 else UNSURE, count, 0.0
    return UNSURE, count, 0.0


@kernel
def find_corner(simplex: Simplex, count: int) -> int:
    """Return which corner has the same vertices as the one after the first `count`: that one, if no other has."""
    for k in range(count):
        if simplex.vertex[k, 0] == simplex.vertex[count, 0] and simplex.vertex[k, 1] == simplex.vertex[count, 1]:
            return k
    return count


@kernel
def largest(array: Floats, count: int) -> float:
    """Return the largest square of the first `count` rows."""
    square = 0.0
    for k in range(count):
        square = max(square, dot(row(array, k), row(array, k)))
    return square
