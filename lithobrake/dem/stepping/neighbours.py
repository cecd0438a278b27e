"""Pairs of bodies near enough to touch before the surface of any has moved half the skin."""

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, Flags, Floats, Integers, Pairs, Period, Planes
from lithobrake.dem.bodies.period import folded, nearest, way_between
from lithobrake.dem.bodies.vectors import Vector, dot, minus, row
from lithobrake.dem.narrow_phase.closest_points import find_closest_points
from lithobrake.dem.narrow_phase.feature_id import INLINE_FEATURES
from lithobrake.dem.narrow_phase.gjk import APART
from lithobrake.dem.narrow_phase.scratch import Scratch


@kernel
def sweep(
    order: Integers, low: Floats, position: Floats, reach: Floats, first: Integers, second: Integers, period: Period
) -> int:
    """Find pairs of bounding spheres that meet, sweeping along x; write as many as fit and return how many there are.

    position is folded; order [body_count] sorts low = x - reach; reach is the bounding radius and half the skin. Where
    the world repeats, the sweep goes on from the last to the images of those before.
    Writes to first and second.
    """
    count, n = 0, len(order)
    for i in range(n):
        a = order[i]
        for j in range(i + 1, n if period.x == 0.0 else i + n):
            b = order[j] if j < n else order[j - n]
            if (low[b] if j < n else low[b] + period.x) > position[a, 0] + reach[a]:
                break
            way = nearest(period, minus(row(position, a), row(position, b)))
            if dot(way, way) < (reach[a] + reach[b]) ** 2:
                if count < len(first):
                    first[count], second[count] = min(a, b), max(a, b)
                count += 1
    return count


@kernel
def are_near(
    bodies: Bodies, cores: Cores, scratch: Scratch, first: int, second: int, apart: Vector, way: float
) -> bool:  # fmt: skip
    """Tell whether two bodies, as they are turned now, are less than a way apart [m]; apart: from centroid to centroid.

    Writes to scratch.
    """
    shapes = (bodies.shape[first], bodies.shape[second])
    farthest = cores.rounding[shapes[0]] + cores.rounding[shapes[1]] + way
    found, _, _ = find_closest_points(
        cores, scratch.simplex, scratch.turned, scratch.relative, shapes, bodies.rotation, (first, second), apart,
        farthest,
    )  # fmt: skip
    return found != APART


@large_kernel
def mark_near(
    bodies: Bodies, cores: Cores, scratch: Scratch, first: Integers, second: Integers, skin: float, near: Flags
) -> None:
    """Note which pairs of bodies are less than the skin apart: fewer than half of those whose bounding spheres meet.

    Writes to scratch and near.
    """
    for pair in range(len(first)):
        apart = way_between(bodies, first[pair], second[pair])
        near[pair] = are_near(bodies, cores, scratch, first[pair], second[pair], apart, skin)


def neighbouring_pairs(
    bodies: Bodies, cores: Cores, planes: Planes, scratch: Scratch, skin: float
) -> tuple[Integers, Integers]:
    """Return first and second of all neighbouring pairs, ordered; plane k stands as second = -1 - k."""
    reach = bodies.bounding_radius + 0.5 * skin
    position = folded(bodies.position, bodies.period)
    low = position[:, 0] - reach
    order = np.argsort(low, kind="stable")
    capacity = 16 * len(order)
    while True:
        first, second = np.empty(capacity, dtype=np.int64), np.empty(capacity, dtype=np.int64)
        count = sweep(order, low, position, reach, first, second, bodies.period)
        if count <= capacity:
            break
        capacity = count
    near = np.zeros(count, dtype=np.bool_)
    mark_near(bodies, cores, scratch, first[:count], second[:count], skin, near)
    gap = planes.normal @ bodies.position.T - planes.offset[:, None] - reach
    plane, body = np.nonzero((gap < 0.0) & planes.meets)
    first = np.concatenate([first[:count][near], body])
    second = np.concatenate([second[:count][near], -1 - plane])
    sorting = np.lexsort((second, first))
    return first[sorting], second[sorting]


def new_pairs(first: Integers, second: Integers) -> Pairs:
    """Return pairs without any history."""
    n = len(first)
    return Pairs(
        first=first, second=second, wake=np.zeros(n), overlap=np.zeros(n), normal=np.zeros((n, 3)),
        point=np.zeros((n, 3)), normal_force=np.zeros(n), elastic_force=np.zeros(n), cohesion=np.zeros(n),
        spring=np.zeros((n, 3)), tangential_force=np.zeros((n, 3)), tangential_stiffness=np.zeros(n),
        twist=np.zeros(n), twist_stiffness=np.zeros(n), roll=np.zeros((n, 3)), roll_stiffness=np.zeros(n),
        tilt_stiffness=np.zeros(n), lost=np.zeros((n, 3)), feature_count=np.zeros(n, dtype=np.int64),
        feature=np.zeros((n, INLINE_FEATURES), dtype=np.int64), overflow_row=np.full(n, -1),
        overflow=np.zeros((0, 1), dtype=np.int64),
    )  # fmt: skip


def no_pairs() -> Pairs:
    """Return the pairs of a world in which nothing has met."""
    return new_pairs(np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64))


def carry_over(old: Pairs, first: Integers, second: Integers) -> Pairs:
    """Return pairs for a new list that carry on the history of those already in the old one.

    No contact is lost: what touches lies deep inside the reach of the list.
    """
    new = new_pairs(first, second)
    span = 1 + max(int(first.max(initial=0)), int(old.first.max(initial=0)), int(np.abs(second).max(initial=0)),
                   int(np.abs(old.second).max(initial=0)))  # fmt: skip
    key_old, key_new = old.first * (2 * span) + old.second, first * (2 * span) + second
    _, here, there = np.intersect1d(key_new, key_old, assume_unique=True, return_indices=True)
    for name in Pairs._fields[2:-1]:
        getattr(new, name)[here] = getattr(old, name)[there]
    return with_overflow_rows(new, old.overflow, old.overflow.shape[1])


def with_overflow_rows(pairs: Pairs, overflow: Integers, width: int) -> Pairs:
    """Return the pairs with rows of so many features for those that have one in `overflow`, moved up."""
    using = np.flatnonzero(pairs.overflow_row >= 0)
    rows = np.zeros((len(using), width), dtype=np.int64)
    known = pairs.overflow_row[using] < len(overflow)
    rows[known, : overflow.shape[1]] = overflow[pairs.overflow_row[using[known]]]
    pairs.overflow_row[using] = np.arange(len(using))
    return pairs._replace(overflow=rows)


def with_more_overflow(pairs: Pairs) -> Pairs:
    """Return the pairs with room for as many features as they ask for."""
    lacking = pairs.feature_count > np.where(
        pairs.overflow_row < 0, INLINE_FEATURES, INLINE_FEATURES + pairs.overflow.shape[1]
    )
    pairs.overflow_row[lacking & (pairs.overflow_row < 0)] = len(pairs.overflow)
    return with_overflow_rows(
        pairs, pairs.overflow, max(pairs.overflow.shape[1], int(pairs.feature_count.max()) - INLINE_FEATURES)
    )


def with_overflow_for_all(pairs: Pairs) -> Pairs:
    """Return the pairs, each with a row for twice as many features as any asks for: so they seldom ask again."""
    roomy = with_more_overflow(pairs)
    width = roomy.overflow.shape[1]
    rows = np.zeros((len(pairs.first), 2 * width), dtype=np.int64)
    using = np.flatnonzero(roomy.overflow_row >= 0)
    rows[using, :width] = roomy.overflow[roomy.overflow_row[using]]
    roomy.overflow_row[:] = np.arange(len(rows))
    return roomy._replace(overflow=rows)


def with_overflow_where_used(pairs: Pairs) -> Pairs:
    """Return the pairs with rows only for those whose features do not stand in line."""
    pairs.overflow_row[pairs.feature_count <= INLINE_FEATURES] = -1
    return with_overflow_rows(pairs, pairs.overflow, pairs.overflow.shape[1])
