"""When and where a flight meets the ground within one step of its integration.

The curve of a step is cut into chords that leave it by no more than five times `slack`. Far from the surface the chords
are as long as the distance allows; near it each is tried against the facets around it, for entries from outside only. A
flight that starts on the surface is watched by its height instead, until it has risen by more than `slack`.
"""

from typing import Any

import numpy as np

from lithobrake.compiled import compiled
from lithobrake.smallbody.crossing import first_entry
from lithobrake.smallbody.dormand_prince import along
from lithobrake.smallbody.grid import clearance
from lithobrake.smallbody.nearest import height_near

ON_SURFACE, ALOFT = 0, 1
BISECTIONS = 48
SAGITTA = 5.0  # slacks by which a chord may leave the curve: a graze not deeper than that may be passed over


@compiled
def _place(curve: Any, share: float, point: Any) -> None:
    """Write the position [m] at a share of the step."""
    for i in range(3):
        point[i] = along(curve, share, i)


@compiled
def _bounds(curve: Any, slope: Any, j: int) -> Any:
    """Larger speed of the two ends [m/s], and a bound of the acceleration [m/s2], over lane j's step.

    Half as much again as the largest of seven stages stands for the largest acceleration.
    """
    push = 0.0
    for m in range(len(slope)):
        push = max(push, slope[m, 3, j] ** 2 + slope[m, 4, j] ** 2 + slope[m, 5, j] ** 2)
    pace = 0.0
    for share in (0.0, 1.0):
        pace = max(pace, along(curve, share, 3) ** 2 + along(curve, share, 4) ** 2 + along(curve, share, 5) ** 2)
    return np.sqrt(pace), 1.5 * np.sqrt(push)


@compiled
def _onto_plane(curve: Any, corner: Any, outward: Any, facet: int, low: float, high: float) -> float:
    """Share between low and high at which the curve passes the plane of a facet."""
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        height = 0.0
        for i in range(3):
            height += outward[facet, 0, i] * (along(curve, middle, i) - corner[facet, 0, i])
        if height > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@compiled
def _onto_surface(curve: Any, ground: Any, point: Any, low: float, high: float) -> Any:
    """Share between low (above) and high (below) at which the height is zero, and the facet there."""
    grid, corner, outward, _ = ground
    facet = -1
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        _place(curve, middle, point)
        height, facet = height_near(grid, corner, outward, point)
        if height > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high), facet


@compiled
def find_impact(curve: Any, slope: Any, step: float, j: int, phase: int, ground: Any) -> Any:
    """Share of lane j's step [step s] at which it meets the ground, the facet (-1: it does not), and the phase after
    it.

    ground: (grid arrays, corners [facet_count, 3, 3], pseudonormals [facet_count, 7, 3], slack [m]).
    """
    grid, corner, outward, slack = ground
    pace, push = _bounds(curve, slope, j)
    fastest = pace + 0.5 * push * step
    # Half a cell keeps a chord among few cells; the sagitta of a chord of time t is at most push t**2 / 8.
    longest = min(
        np.sqrt(8.0 * SAGITTA * slack / push) if push > 0.0 else step,
        0.5 * grid[1] / fastest if fastest > 0.0 else step,
    )
    stride = min(longest, 4.0 * slack / pace) if pace > 0.0 else longest
    here, there, chord = np.empty(3), np.empty(3), np.empty(3)
    time, height = 0.0, 0.0
    _place(curve, 0.0, here)
    if phase == ON_SURFACE:
        height = height_near(grid, corner, outward, here)[0]
    while time < step:
        if phase == ON_SURFACE:
            until = min(time + stride, step)
            _place(curve, until / step, there)
            height_there, facet = height_near(grid, corner, outward, there)
            if height_there < -slack:
                if height > 0.0:
                    share, facet = _onto_surface(curve, ground, there, time / step, until / step)
                    return share, facet, phase
                return time / step, facet, phase
            if height_there > slack:
                phase = ALOFT
            height = height_there
            stride = min(2.0 * stride, longest)
        else:
            gap = clearance(grid, here[0], here[1], here[2])
            until = min(time + (gap / fastest if gap > 0.0 else longest), step)
            _place(curve, until / step, there)
            if gap == 0.0:
                for i in range(3):
                    chord[i] = there[i] - here[i]
                _, facet = first_entry(grid, corner, here, chord)
                if facet >= 0:
                    return _onto_plane(curve, corner, outward, facet, time / step, until / step), facet, phase
        time = until
        for i in range(3):
            here[i] = there[i]
    return 1.0, -1, phase
