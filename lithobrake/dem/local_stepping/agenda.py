"""What is to be done next: a binary heap of items by the time at which each is due.

Items are numbers; of two that are due at one time the smaller comes first, so the order never depends on history.
"""

from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Floats, Integers


class Agenda(NamedTuple):
    """A heap of items 0 to before capacity."""

    due: Floats  # [capacity], s
    heap: Integers  # [capacity], items, the first due in front
    place: Integers  # [capacity], where in the heap an item stands, -1: not in it
    size: Integers  # [1]


def new_agenda(capacity: int) -> Agenda:
    """Return an empty agenda."""
    return Agenda(np.zeros(capacity), np.zeros(capacity, np.int64), np.full(capacity, -1), np.zeros(1, np.int64))


@kernel
def comes_before(agenda: Agenda, one: int, other: int) -> bool:
    """Tell whether an item comes before another."""
    a, b = agenda.due[one], agenda.due[other]
    return a < b or (a == b and one < other)


@kernel
def move_up(agenda: Agenda, item: int, place: int) -> int:
    """Move an item up from a place until what stands above comes before it; return its place. Writes to agenda."""
    while place > 0:
        above = (place - 1) >> 1
        other = agenda.heap[above]
        if comes_before(agenda, other, item):
            break
        agenda.heap[place], agenda.place[other] = other, place
        place = above
    agenda.heap[place], agenda.place[item] = item, place
    return place


@kernel
def move_down(agenda: Agenda, item: int, place: int) -> None:
    """Move an item down from a place until it comes before what stands below. Writes to agenda."""
    size = agenda.size[0]
    while True:
        below = 2 * place + 1
        if below >= size:
            break
        if below + 1 < size and comes_before(agenda, agenda.heap[below + 1], agenda.heap[below]):
            below += 1
        other = agenda.heap[below]
        if comes_before(agenda, item, other):
            break
        agenda.heap[place], agenda.place[other] = other, place
        place = below
    agenda.heap[place], agenda.place[item] = item, place


@kernel
def put_on(agenda: Agenda, item: int, time: float) -> None:
    """Make an item due at a time [s], whether it is on the agenda or not. Writes to agenda."""
    place = agenda.place[item]
    agenda.due[item] = time
    if place < 0:
        place = agenda.size[0]
        agenda.size[0] = place + 1
    if move_up(agenda, item, place) == place:
        move_down(agenda, item, place)


@kernel
def take_off(agenda: Agenda, item: int) -> None:
    """Take an item off the agenda, if it is on it. Writes to agenda."""
    place = agenda.place[item]
    if place < 0:
        return
    agenda.place[item] = -1
    last = agenda.size[0] - 1
    agenda.size[0] = last
    other = agenda.heap[last]
    if other != item and move_up(agenda, other, place) == place:
        move_down(agenda, other, place)
