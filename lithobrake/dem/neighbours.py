"""Pairs of bodies near enough to touch before any body has moved half the skin."""

import numpy as np

from lithobrake.compiled import kernel
from lithobrake.dem.arrays import Bodies, Floats, Integers, Pairs, Planes

# Room for names of features near each other that a pair starts with; doubled when some pair needs more.
TERM_MAX = 16


@kernel
def sweep(order: Integers, low: Floats, position: Floats, reach: Floats, first: Integers, second: Integers) -> int:
    """Find pairs of bounding spheres that meet, sweeping along x; write as many as fit and return how many there are.

    order [body_count] sorts low = x - reach; reach is the bounding radius and half the skin.
    """
    count = 0
    for i in range(len(order)):
        a = order[i]
        for j in range(i + 1, len(order)):
            b = order[j]
            if low[b] > position[a, 0] + reach[a]:
                break
            square = 0.0
            for axis in range(3):
                square += (position[a, axis] - position[b, axis]) ** 2
            if square < (reach[a] + reach[b]) ** 2:
                if count < len(first):
                    first[count], second[count] = min(a, b), max(a, b)
                count += 1
    return count


def neighbours(bodies: Bodies, planes: Planes, skin: float) -> tuple[Integers, Integers]:
    """Return first and second of all neighbouring pairs, ordered; plane k stands as second = -1 - k."""
    reach = bodies.bounding_radius + 0.5 * skin
    low = bodies.position[:, 0] - reach
    order = np.argsort(low, kind="stable")
    capacity = 16 * len(order)
    while True:
        first, second = np.empty(capacity, dtype=np.int64), np.empty(capacity, dtype=np.int64)
        count = sweep(order, low, bodies.position, reach, first, second)
        if count <= capacity:
            break
        capacity = count
    gap = planes.normal @ bodies.position.T - planes.offset[:, None] - reach
    plane, body = np.nonzero((gap < 0.0) & planes.meets)
    first = np.concatenate([first[:count], body])
    second = np.concatenate([second[:count], -1 - plane])
    sorting = np.lexsort((second, first))
    return first[sorting], second[sorting]


def pairs_of(first: Integers, second: Integers, term_max: int = TERM_MAX) -> Pairs:
    """Return pairs without any history, with room for so many names of features each."""
    n = len(first)
    return Pairs(
        first=first, second=second, wake=np.zeros(n), overlap=np.zeros(n), normal=np.zeros((n, 3)),
        point=np.zeros((n, 3)), normal_force=np.zeros(n), elastic_force=np.zeros(n), cohesion=np.zeros(n),
        spring=np.zeros((n, 3)), tangential_force=np.zeros((n, 3)), tangential_stiffness=np.zeros(n),
        twist=np.zeros(n), twist_stiffness=np.zeros(n), roll=np.zeros((n, 3)), roll_stiffness=np.zeros(n),
        tilt_stiffness=np.zeros(n), lost=np.zeros((n, 3)), term_count=np.zeros(n, dtype=np.int64),
        term=np.zeros((n, term_max), dtype=np.int64),
    )  # fmt: skip


def renewed(old: Pairs, first: Integers, second: Integers) -> Pairs:
    """Return pairs for a new list that carry on the history of those already in the old one.

    No contact is lost: what touches lies deep inside the reach of the list.
    """
    new = pairs_of(first, second, old.term.shape[1])
    span = 1 + max(int(first.max(initial=0)), int(old.first.max(initial=0)), int(np.abs(second).max(initial=0)),
                   int(np.abs(old.second).max(initial=0)))  # fmt: skip
    key_old, key_new = old.first * (2 * span) + old.second, first * (2 * span) + second
    _, here, there = np.intersect1d(key_new, key_old, assume_unique=True, return_indices=True)
    for name in Pairs._fields[2:]:
        getattr(new, name)[here] = getattr(old, name)[there]
    return new


def roomier(old: Pairs, term_max: int) -> Pairs:
    """Return the same pairs with room for more names; they are all to be listed anew."""
    term = np.zeros((len(old.first), term_max), dtype=np.int64)
    return old._replace(term=term, wake=np.zeros_like(old.wake))
