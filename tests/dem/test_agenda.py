"""The agenda gives the item that is due first, the smaller number first where two are due at once."""

import numpy as np

from lithobrake.compilation.compiled import large_kernel
from lithobrake.dem.local_stepping.agenda import Agenda, new_agenda, put_on, take_off


@large_kernel
def do(agenda: Agenda, item: int, time: float) -> None:
    if time >= 0.0:
        put_on(agenda, item, time)
    else:
        take_off(agenda, item)


def test_items_come_in_the_order_of_their_times_whatever_came_before() -> None:
    generator = np.random.default_rng(4)
    agenda, expected = new_agenda(40), {}
    for item, time in zip(
        generator.integers(40, size=3000).tolist(), generator.integers(-4, 12, size=3000), strict=True
    ):
        do(agenda, item, float(time))
        if time >= 0:
            expected[item] = float(time)
        else:
            expected.pop(item, None)
        assert agenda.size[0] == len(expected)
        if expected:
            assert agenda.heap[0] == min(expected, key=lambda one: (expected[one], one))
    while expected:
        first = int(agenda.heap[0])
        assert first == min(expected, key=lambda one: (expected[one], one))
        do(agenda, first, -1.0)
        del expected[first]
    assert agenda.size[0] == 0
