"""Flights of chosen samples as states in steps of time, in the axes that they are passed on in."""

from collections import Counter
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from lithobrake.export.flown import Flown
from lithobrake.export.frames import RESOLUTION, Frame
from lithobrake.export.oem import Segment
from lithobrake.vocabulary.progress import Progress

STEPS = 100


def checked_step(flown: Flown, step: float | None) -> float:
    """The time between states [s]; absent: a hundredth of the longest flight. Raises ValueError out of range."""
    longest = float(flown.end_time.max())
    step = longest / STEPS if step is None else step
    if not 10.0 * RESOLUTION <= step <= longest:
        raise ValueError(f"step is {step} s; allowed: {10.0 * RESOLUTION:g} to {longest:.6g} s, the longest flight")
    return step


def flight_segments(chosen: Flown, axes: Frame, step: float, progress: Progress) -> dict[int, list[Segment]]:
    """By sample a segment for each flight, from its beginning to its end, in order; times count from the epoch."""
    keys = _keys(chosen)
    ends = axes.states(chosen, chosen.end_time, *chosen.ends()) if keys else np.empty((0, 6))
    last = dict(zip(keys, chosen.end_time.tolist(), strict=True))
    times: dict[tuple[int, int], list[float]] = {key: [] for key in keys}
    states: dict[tuple[int, int], list[NDArray[np.float64]]] = {key: [] for key in keys}
    for aloft in stepped(chosen, step, 1, progress, "flights of the chosen samples"):
        here = axes.states(aloft, aloft.time, aloft.position, aloft.velocity)
        for key, state in zip(_keys(aloft), here, strict=True):
            # The end is a state of its own, which must not stand twice.
            if last[key] - aloft.time > RESOLUTION:
                times[key].append(aloft.time)
                states[key].append(state)
    count = Counter(sample for sample, _ in keys)
    found: dict[int, list[Segment]] = {}
    for key, begin, end in zip(keys, chosen.begin.tolist(), ends, strict=True):
        sample, arc = key
        time = np.array([*times[key], last[key]])
        segment = Segment(
            *(f"SAMPLE_{sample}", axes.body, axes.name),
            *(begin + time, np.array([*states[key], end])),
            comments=[_sentence(sample, arc, count[sample])],
            # Hermite's polynomials take two numbers of each state; four states are plenty.
            interpolation_degree=2 * min(len(time), 4) - 1 if len(time) > 1 else None,
        )
        found.setdefault(sample, []).append(segment)
    return found


def stepped(flown: Flown, step: float, fewest: int, progress: Progress, what: str) -> Iterator[Flown]:
    """The flights that last at each step [s], as long as there are enough of them."""
    number, ends = 0, np.sort(flown.end_time)
    last = float(ends[-fewest]) if len(ends) >= fewest else 0.0
    while len(flown.sample) >= fewest:
        progress(min(flown.time / last, 1.0) if last > 0.0 else 1.0, what)
        yield flown
        number += 1
        flown = flown.at(number * step)


def _keys(flown: Flown) -> list[tuple[int, int]]:
    """Sample of each flight and its number in the journey of that."""
    return list(zip(flown.sample.tolist(), flown.arc.tolist(), strict=True))


def _sentence(sample: int, arc: int, count: int) -> str:
    words = "; between flights that do not follow at once the lander slid over the ground" if count > 1 else ""
    return f"Flight {arc + 1} of {count} that are known of sample {sample}; its last state is its end{words}."
