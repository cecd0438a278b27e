"""Pairs of bodies near enough to touch before the surface of any has moved half the skin.

Of bodies with several parts, each part has pairs of its own; parts of one body never meet.
"""

from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, Pairs, Period, Planes
from lithobrake.dem.bodies.vectors import dot, folded, minus, nearest, row, way_between
from lithobrake.dem.narrow_phase.feature_distance import INLINE_FEATURES
from lithobrake.dem.narrow_phase.gjk import APART
from lithobrake.dem.narrow_phase.penetration import find_closest_points
from lithobrake.dem.narrow_phase.scratch import Scratch
from lithobrake.vocabulary.array_types import Flags, Floats, Integers, Vector


@kernel
def sweep(
    order: Integers, low: Floats, position: Floats, reach: Floats, first: Integers, second: Integers, period: Period
) -> int:
    """Find pairs of bounding spheres that meet, sweeping along x; write as many as fit and return how many there are.

    low = x - reach is folded; order [body_count] sorts it; reach is the bounding radius and half the skin. Where
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
    bodies: Bodies, cores: Cores, scratch: Scratch, members: tuple[int, int], shapes: tuple[int, int], apart: Vector,
    way: float,
) -> bool:  # fmt: skip
    """Tell whether shapes of two bodies, as they are turned now, are less than a way apart [m].

    apart: from one body's centre of mass to the other's. Writes to scratch.
    """
    farthest = cores.rounding[shapes[0]] + cores.rounding[shapes[1]] + way
    found, _, _ = find_closest_points(
        cores, scratch.simplex, scratch.turned, scratch.relative, shapes, bodies.rotation, members, apart, farthest
    )
    return found != APART


@large_kernel
def mark_near(
    bodies: Bodies, cores: Cores, scratch: Scratch, first: Integers, second: Integers, parts: Integers, skin: float,
    near: Flags,
) -> None:  # fmt: skip
    """Note which pairs are less than the skin apart: fewer than half of those whose bounding spheres meet.

    first and second are bodies, parts [pair_count, 2] those of either. Writes to scratch and near.
    """
    for pair in range(len(first)):
        members, shapes = (first[pair], second[pair]), (bodies.shape[parts[pair, 0]], bodies.shape[parts[pair, 1]])
        apart = way_between(bodies, members[0], members[1])
        near[pair] = are_near(bodies, cores, scratch, members, shapes, apart, skin)


class Neighbours(NamedTuple):
    """Pairs of parts that are near each other, see Pairs."""

    first: Integers  # [pair_count]
    second: Integers  # [pair_count]
    first_part: Integers  # [pair_count]
    second_part: Integers  # [pair_count]


def neighbouring_pairs(bodies: Bodies, cores: Cores, planes: Planes, scratch: Scratch, skin: float) -> Neighbours:
    """Return all neighbouring pairs, ordered; plane k stands as second = -1 - k."""
    reach = bodies.bounding_radius + 0.5 * skin
    # Folded by their lower ends: every image then begins after all bodies, however large these are beside each other.
    lower = bodies.position - np.column_stack([reach, np.zeros((len(reach), 2))])
    position = bodies.position + (folded(lower, bodies.period) - lower)
    low = position[:, 0] - reach
    order = np.argsort(low, kind="stable")
    # In a poured bed some 11 pairs of bounding spheres a grain meet.
    capacity = 16 * len(order)
    while True:
        first, second = np.empty(capacity, dtype=np.int64), np.empty(capacity, dtype=np.int64)
        count = sweep(order, low, position, reach, first, second, bodies.period)
        if count <= capacity:
            break
        capacity = count
    met = pairs_of_parts(bodies.part_start, first[:count], second[:count])
    near = np.zeros(len(met.first), dtype=np.bool_)
    if len(near) > 0:
        parts = np.column_stack([met.first_part, met.second_part])
        mark_near(bodies, cores, scratch, met.first, met.second, parts, skin, near)
    gap = planes.normal @ bodies.position.T - planes.offset[:, None] - reach
    plane, body = np.nonzero((gap < 0.0) & planes.meets)
    on_plane = pairs_of_parts(bodies.part_start, body, -1 - plane)
    found = [np.concatenate([one[near], other]) for one, other in zip(met, on_plane, strict=True)]
    # Forces are summed in the order of the pairs, which so must not depend on how the pairs were found.
    sorting = np.lexsort(found[::-1])
    return Neighbours(*(column[sorting] for column in found))


def without_joined(between: Neighbours, leader: Integers) -> Neighbours:
    """Return the pairs but for those of bodies that are joined, which have one leader [body_count]."""
    apart = (between.second < 0) | (leader[between.first] != leader[np.maximum(between.second, 0)])
    return between if apart.all() else Neighbours(*(column[apart] for column in between))


def pairs_of_parts(part_start: Integers, first: Integers, second: Integers) -> Neighbours:
    """Return the pairs of all parts of first bodies with all of second ones, or with planes (second below 0)."""
    counts = np.diff(part_start)
    if (counts == 1).all():
        return Neighbours(first, second, first, second)
    theirs = np.where(second < 0, 1, counts[second])
    begin = np.where(second < 0, second, part_start[second])
    each = counts[first] * theirs
    place = np.arange(each.sum()) - np.repeat(np.cumsum(each) - each, each)
    number, other = np.divmod(place, np.repeat(theirs, each))
    return Neighbours(
        np.repeat(first, each), np.repeat(second, each), np.repeat(part_start[first], each) + number,
        np.repeat(begin, each) + other,
    )  # fmt: skip


def new_pairs(between: Neighbours) -> Pairs:
    n = len(between.first)
    return Pairs(
        *between, wake=np.zeros(n), overlap=np.zeros(n), deepest=np.zeros(n), normal=np.zeros((n, 3)),
        point=np.zeros((n, 3)), normal_force=np.zeros(n), elastic_force=np.zeros(n), cohesion=np.zeros(n),
        spring=np.zeros((n, 3)), tangential_force=np.zeros((n, 3)), tangential_stiffness=np.zeros(n),
        twist=np.zeros(n), twist_stiffness=np.zeros(n), roll=np.zeros((n, 3)), roll_stiffness=np.zeros(n),
        tilt_stiffness=np.zeros(n), lost=np.zeros((n, 3)), feature_count=np.zeros(n, dtype=np.int64),
        feature=np.zeros((n, INLINE_FEATURES), dtype=np.int64), overflow_row=np.full(n, -1),
        overflow=np.zeros((0, 1), dtype=np.int64),
    )  # fmt: skip


def free_slots(count: int) -> Neighbours:
    """Return so many slots for pairs, with nothing in them (first = -1)."""
    none, nothing = np.full(count, -1), np.zeros(count, dtype=np.int64)
    return Neighbours(none, nothing, none.copy(), nothing.copy())


def no_pairs() -> Pairs:
    return new_pairs(free_slots(0))


def carry_over(old: Pairs, between: Neighbours) -> Pairs:
    """Return pairs for a new list that carry on the history of those already in the old one.

    No contact is lost: what touches lies deep inside the reach of the list.
    """
    new = new_pairs(between)
    # Of parts there are at least as many as of bodies, and each is of one body.
    ours, theirs = (old.first_part, old.second_part), (between.first_part, between.second_part)
    span = 1 + max(int(np.abs(parts).max(initial=0)) for parts in (*ours, *theirs))
    key_old, key_new = (first * (2 * span) + second for first, second in (ours, theirs))
    _, here, there = np.intersect1d(key_new, key_old, assume_unique=True, return_indices=True)
    # Not the members, which the new list has, and not the overflow, whose rows are not one a pair.
    for name in Pairs._fields[len(between) : -1]:
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
