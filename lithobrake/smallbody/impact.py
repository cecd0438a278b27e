"""When and where a flight meets the ground within one step of its integration.

The curve of a step is cut into chords that leave it by no more than five times `slack`. Far from the surface the chords
are as long as the distance allows; near it each is tried against the facets around it, for entries from outside only. A
flight that starts on the surface is watched by its height instead, until it has risen by more than `slack`.

The ground may be that of a partner: the curve is then looked at from the partner's frame (motion, see partner; its
distance is zero for the body itself).
"""

from typing import Any

import numpy as np

from lithobrake.compiled import kernel, large_kernel
from lithobrake.smallbody.crossing import first_entry
from lithobrake.smallbody.dormand_prince import along
from lithobrake.smallbody.grid import clearance
from lithobrake.smallbody.nearest import height_near
from lithobrake.smallbody.partner import into_partner

ON_SURFACE, ALOFT = 0, 1
BISECTIONS = 48
SAGITTA = 5.0  # slacks by which a chord may leave the curve: a graze not deeper than that may be passed over


@kernel
def _place(curve: Any, share: float, motion: Any, point: Any) -> None:
    """Write the position [m] at a share of the step, in the frame of the ground."""
    for i in range(3):
        point[i] = along(curve, share, i)
    into_partner(point, motion, share)


@kernel
def _bounds(curve: Any, slope: Any, step: float, j: int, motion: Any) -> Any:
    """Larger speed of the two ends [m/s], and a bound of the acceleration [m/s2], over lane j's step of `step` [s].

    Half as much again as the largest of seven stages stands for the largest acceleration.
    """
    push = 0.0
    for m in range(len(slope)):
        push = max(push, slope[m, 3, j] ** 2 + slope[m, 4, j] ** 2 + slope[m, 5, j] ** 2)
    push = 1.5 * np.sqrt(push)
    pace = reach = 0.0
    distance, angle, rate, swing = motion[0], motion[1], motion[2] / step, motion[4] / step
    for share in (0.0, 1.0):
        x, y, u, v = along(curve, share, 0), along(curve, share, 1), along(curve, share, 3), along(curve, share, 4)
        if distance > 0.0:
            # Against the partner's ground: less the motion of its centre, less the turning about it.
            place = angle + share * motion[2]
            centre_x, centre_y = distance * np.cos(place), distance * np.sin(place)
            x, y = x - centre_x, y - centre_y
            u, v = u + rate * centre_y + swing * y, v - rate * centre_x - swing * x
        pace = max(pace, u * u + v * v + along(curve, share, 5) ** 2)
        reach = max(reach, x * x + y * y)
    pace = np.sqrt(pace)
    if distance > 0.0:
        # Between the ends place and speed are those there and what the acceleration may add.
        reach = np.sqrt(reach) + 0.125 * push * step * step
        push += distance * rate * rate + abs(swing) * (2.0 * pace + abs(swing) * reach)
        push *= 1.0 + abs(swing) * step
    return pace, push


@kernel
def _pass_by(here: Any, there: Any) -> float:
    """Smallest distance [m] of the straight line between two points from the origin."""
    along_line = square = 0.0
    for i in range(3):
        along_line -= here[i] * (there[i] - here[i])
        square += (there[i] - here[i]) ** 2
    share = min(max(along_line / square, 0.0), 1.0) if square > 0.0 else 0.0
    nearest = 0.0
    for i in range(3):
        nearest += (here[i] + share * (there[i] - here[i])) ** 2
    return np.sqrt(nearest)


@large_kernel
def _onto_plane(curve: Any, ground: Any, motion: Any, facet: int, point: Any, low: float, high: float) -> float:
    """Share between low and high at which the curve passes the plane of a facet."""
    corner, outward = ground[1], ground[2]
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        _place(curve, middle, motion, point)
        height = 0.0
        for i in range(3):
            height += outward[facet, 0, i] * (point[i] - corner[facet, 0, i])
        if height > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@large_kernel
def _onto_surface(curve: Any, ground: Any, motion: Any, point: Any, low: float, high: float) -> Any:
    """Share between low (above) and high (below) at which the height is zero, and the facet there."""
    grid, corner, outward = ground[0], ground[1], ground[2]
    facet = -1
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        _place(curve, middle, motion, point)
        height, facet = height_near(grid, corner, outward, point)
        if height > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high), facet


@large_kernel
def find_impact(curve: Any, slope: Any, step: float, j: int, phase: int, ground: Any, motion: Any, room: Any) -> Any:
    """Share of lane j's step [step s] at which it meets the ground, the facet (-1: it does not), and the phase after
    it.

    ground: (grid arrays, corners [facet_count, 3, 3], pseudonormals [facet_count, 7, 3], slack [m], radius [m]).
    room [3, 3] is scratch.
    """
    grid, corner, outward, slack, radius = ground
    here, there, chord = room[0], room[1], room[2]
    pace, push = _bounds(curve, slope, step, j, motion)
    _place(curve, 0.0, motion, here)
    if phase == ALOFT:
        _place(curve, 1.0, motion, there)
        if _pass_by(here, there) > radius + 0.125 * push * step * step:
            return 1.0, -1, phase
    fastest = pace + 0.5 * push * step
    # Half a cell keeps a chord among few cells; the sagitta of a chord of time t is at most push t**2 / 8.
    longest = min(
        np.sqrt(8.0 * SAGITTA * slack / push) if push > 0.0 else step,
        0.5 * grid[1] / fastest if fastest > 0.0 else step,
    )
    stride = min(longest, 4.0 * slack / pace) if pace > 0.0 else longest
    time, height = 0.0, 0.0
    if phase == ON_SURFACE:
        height = height_near(grid, corner, outward, here)[0]
    while time < step:
        if phase == ON_SURFACE:
            until = min(time + stride, step)
            _place(curve, until / step, motion, there)
            height_there, facet = height_near(grid, corner, outward, there)
            if height_there < -slack:
                if height > 0.0:
                    share, facet = _onto_surface(curve, ground, motion, there, time / step, until / step)
                    return share, facet, phase
                return time / step, facet, phase
            if height_there > slack:
                phase = ALOFT
            height = height_there
            stride = min(2.0 * stride, longest)
        else:
            gap = clearance(grid, here[0], here[1], here[2])
            until = min(time + (gap / fastest if gap > 0.0 else longest), step)
            _place(curve, until / step, motion, there)
            if gap == 0.0:
                for i in range(3):
                    chord[i] = there[i] - here[i]
                _, facet = first_entry(grid, corner, here, chord)
                if facet >= 0:
                    share = _onto_plane(curve, ground, motion, facet, there, time / step, until / step)
                    return share, facet, phase
        time = until
        for i in range(3):
            here[i] = there[i]
    return 1.0, -1, phase
