"""The point of a simplex closest to the origin, as weights of its corners that add up to one."""

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.vectors import Vector, cross, dot, minus, plus, scaled

Weights = tuple[float, float, float, float]


@kernel
def segment_weights(a: Vector, b: Vector) -> tuple[float, float]:
    """Return the weights of the ends of a segment."""
    along = minus(b, a)
    length_squared = dot(along, along)
    if length_squared == 0.0:
        return (1.0, 0.0)
    fraction = min(max(-dot(a, along) / length_squared, 0.0), 1.0)
    return (1.0 - fraction, fraction)


@kernel
def triangle_weights(a: Vector, b: Vector, c: Vector) -> tuple[float, float, float]:
    """Return the weights of the corners of a triangle, which may be degenerate."""
    ab, ac = minus(b, a), minus(c, a)
    normal = cross(ab, ac)
    square = dot(normal, normal)
    if square > 0.0:
        weight_b = -dot(normal, cross(a, ac)) / square
        weight_c = -dot(normal, cross(ab, a)) / square
        weight_a = 1.0 - weight_b - weight_c
        if weight_a >= 0.0 and weight_b >= 0.0 and weight_c >= 0.0:
            return (weight_a, weight_b, weight_c)
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
    weight_a, weight_b, weight_c, weight_d = -1.0, -1.0, -1.0, -1.0
    if six_volume != 0.0:
        weight_b = -dot(a, cross(ac, ad)) / six_volume
        weight_c = -dot(a, cross(ad, ab)) / six_volume
        weight_d = -dot(a, cross(ab, ac)) / six_volume
        weight_a = 1.0 - weight_b - weight_c - weight_d
        if weight_a > 0.0 and weight_b > 0.0 and weight_c > 0.0 and weight_d > 0.0:
            return (weight_a, weight_b, weight_c, weight_d)
    best, nearest = (0.0, 0.0, 0.0, 0.0), -1.0
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
