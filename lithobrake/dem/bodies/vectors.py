"""Products of vectors and matrices on scalars, and ways to the nearest image in a world that repeats."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Bodies, Period
from lithobrake.vocabulary.array_types import Floats, Vector
from lithobrake.vocabulary.field_errors import FieldError, field_numbers

NO_PERIOD = Period(0.0, 0.0, 0.0, 0.0)
# Over which bounding radii and skins of the two largest bodies a period extends at least.
IMAGES = 2.0


@kernel
def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@kernel
def plus(a: Vector, b: Vector) -> Vector:
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@kernel
def minus(a: Vector, b: Vector) -> Vector:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@kernel
def scaled(factor: float, a: Vector) -> Vector:
    return (factor * a[0], factor * a[1], factor * a[2])


@kernel
def tangential_part(vector: Vector, normal: Vector) -> Vector:
    return minus(vector, scaled(dot(vector, normal), normal))


@kernel
def row(array: Any, i: int) -> Vector:
    """Return row i of an array [count, 3]."""
    return (array[i, 0], array[i, 1], array[i, 2])


@kernel
def put(array: Any, i: int, a: Vector) -> None:
    """Write row i of an array [count, 3]."""
    array[i, 0], array[i, 1], array[i, 2] = a


@kernel
def add(array: Any, i: int, factor: float, a: Vector) -> None:
    """Add factor * a to row i of an array [count, 3]."""
    array[i, 0] += factor * a[0]
    array[i, 1] += factor * a[1]
    array[i, 2] += factor * a[2]


@kernel
def times(matrices: Any, i: int, a: Vector) -> Vector:
    """Return M a with M = matrices[i], from an array [count, 3, 3]."""
    m = matrices[i]
    return (
        m[0, 0] * a[0] + m[0, 1] * a[1] + m[0, 2] * a[2],
        m[1, 0] * a[0] + m[1, 1] * a[1] + m[1, 2] * a[2],
        m[2, 0] * a[0] + m[2, 1] * a[1] + m[2, 2] * a[2],
    )


@kernel
def transposed_times(matrices: Any, i: int, a: Vector) -> Vector:
    """Return M^T a with M = matrices[i], from an array [count, 3, 3]."""
    m = matrices[i]
    return (
        m[0, 0] * a[0] + m[1, 0] * a[1] + m[2, 0] * a[2],
        m[0, 1] * a[0] + m[1, 1] * a[1] + m[2, 1] * a[2],
        m[0, 2] * a[0] + m[1, 2] * a[1] + m[2, 2] * a[2],
    )


@kernel
def nearest(period: Period, way: Vector) -> Vector:
    """Return a way [m] to the nearest image of where it leads."""
    return (
        way[0] - period.x * np.rint(way[0] * period.inverse_x),
        way[1] - period.y * np.rint(way[1] * period.inverse_y),
        way[2],
    )


@kernel
def way_between(bodies: Bodies, first: int, second: int) -> Vector:
    """Return the way from the centroid of a body to the nearest image of another's [m]."""
    return nearest(bodies.period, minus(row(bodies.position, second), row(bodies.position, first)))


@kernel
def arm_to(bodies: Bodies, body: int, point: Vector) -> Vector:
    """Return the arm from the centroid of a body to the nearest image of a point [m]."""
    return nearest(bodies.period, minus(point, row(bodies.position, body)))


def folded(places: Floats, period: Period) -> Floats:
    """Return places [m], shape [..., 2 or 3], each moved by whole periods to the image nearest to the origin."""
    if period == NO_PERIOD:
        return places
    moved = places.copy()
    for axis, (length, inverse) in enumerate(((period.x, period.inverse_x), (period.y, period.inverse_y))):
        moved[..., axis] -= length * np.rint(places[..., axis] * inverse)
    return moved


def period_of(lengths: Sequence[float] | None) -> Period:
    """Return a period of lengths along x and y [m], or none. Raises ValueError for lengths that are not positive."""
    if lengths is None:
        return NO_PERIOD
    allowed = "are two finite lengths above 0 along x and y, or None"
    x, y = field_numbers("World.period", lengths, 2, allowed, "m")
    if min(x, y) <= 0.0:
        raise FieldError("World.period", lengths, allowed, unit="m")
    return Period(x, y, 1.0 / x, 1.0 / y)


def shortest_period(bounding_radius: Floats, skin: float) -> float:
    """Return the shortest period [m] in which no two bodies can be neighbours through two images.

    bounding_radius [m], shape [body_count]. An image other than the nearest is at least half a period away, and so at
    least two skins from touching: farther than any list of neighbours or features reaches.
    """
    largest = np.sort(bounding_radius)[-2:]
    return IMAGES * (float(largest.sum()) + 2.0 * skin)


def refuse_short_period(period: Period, bounding_radius: Floats, skin: float) -> None:
    """Raise ValueError where two bodies could meet through two images."""
    least = shortest_period(bounding_radius, skin)
    if period != NO_PERIOD and min(period.x, period.y) < least:
        raise FieldError(
            "World.period", (period.x, period.y),
            f"for its two largest bodies is at least {least:.4g} m along x and y, so that no two meet through two "
            "images",
            "make it longer, or the bodies smaller", "m",
        )  # fmt: skip


def refuse_tilted_plane(period: Period, normal: Floats) -> None:
    """Raise ValueError for a plane with a normal [3] that does not repeat with the period."""
    if period != NO_PERIOD and (normal[0] != 0.0 or normal[1] != 0.0):
        raise ValueError(
            f"add_plane normal is {normal.tolist()} in a world of period {(period.x, period.y)!r} m; allowed is one "
            "along z, as the plane must repeat with the world: tilt the gravity instead"
        )
