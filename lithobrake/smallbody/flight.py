"""Flights from start states to the ground, to the end of the time, or away."""

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.smallbody.body import GRAVITATIONAL_CONSTANT, Body
from lithobrake.smallbody.flights import ESCAPE_RADII, STATUSES, Flights
from lithobrake.smallbody.impact import ALOFT, ON_SURFACE
from lithobrake.smallbody.nearest import near_heights
from lithobrake.smallbody.trajectory import FAILED, fly_lanes

CHUNK = 1024  # flights that a thread takes at a time


def fly(
    body: Body,
    position: ArrayLike,
    velocity: ArrayLike,
    duration: ArrayLike,
    *,
    gravity: str = "exact",
    tolerance: float | None = None,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Flights:
    """Fly from start states to the first impact, the end of the duration [s] (one, or one a flight), or escape.

    position, velocity   body-fixed (turning) frame [m], [m/s], shape [count, 3] or [3]; a velocity of zero turns with
                         the body
    gravity              "exact": the polyhedron's; "table": read from grids that are built once for a shape and kept
                         on disk, with the error shape.table_error
    tolerance            error that one step may make: this share of the body's radius in position, and the same share
                         of radius over dynamical time in velocity; by default 1e-7, with the table 1e-6, whose own
                         error is larger
    threads              defaults to the number of cores; the result does not depend on it
    progress             called with the finished share of the flights, from this thread

    A start on the surface (within a millionth of the radius, at most 1 mm) is no impact; the first meeting with the
    ground after the flight has left it is. A flight that starts on the surface and moves into it at once has its impact
    at time 0. Raises ValueError for starts below the surface and for values that are not finite or out of range.
    """
    starts = _starts(position, velocity)
    times = np.array(np.broadcast_to(np.asarray(duration, dtype=np.float64), len(starts)))
    if not (np.isfinite(times) & (times > 0.0)).all():
        raise ValueError(f"duration is {duration!r} s; it must be finite and above 0.")
    if gravity not in ("exact", "table"):
        raise ValueError(f"gravity is {gravity!r}; allowed are 'exact' and 'table'.")
    if tolerance is None:
        tolerance = 1e-7 if gravity == "exact" else 1e-6
    if not 1e-13 <= tolerance <= 1e-3:
        raise ValueError(f"tolerance is {tolerance}; it must lie in 1e-13 to 1e-3.")
    shape, count = body.shape, len(starts)
    slack = min(1e-6 * shape.radius, 1e-3)
    ground = (shape.grid.arrays, shape.corners, shape.pseudonormals, slack)
    phase = _phases(body, starts, slack)
    source = shape.gravity if gravity == "exact" else shape.tabled_gravity
    forces = (source, GRAVITATIONAL_CONSTANT * body.density, body.spin_rate)
    status, time, final = np.zeros(count, dtype=np.int64), np.zeros(count), np.zeros((count, 6))
    facet, steps = np.full(count, -1), np.zeros(count, dtype=np.int64)

    def part(first: int) -> None:
        piece = slice(first, first + CHUNK)
        out = (status[piece], time[piece], final[piece], facet[piece], steps[piece])
        fly_lanes(starts[piece], phase[piece], times[piece], forces, ground, _limits(body, tolerance), out)

    _run(part, count, threads, progress)
    _refuse_failed(starts, status, time, tolerance)
    where, rate = starts[:, :3].copy(), starts[:, 3:].copy()
    return Flights(body, where, rate, STATUSES[status], time, final[:, :3], final[:, 3:], facet, steps)


def _limits(body: Body, tolerance: float) -> tuple[float, ...]:
    """Errors of a step in position [m] and velocity [m/s], first step [s], escape radius [m], G mass [m3/s2]."""
    radius = body.shape.radius
    dynamical_time = math.sqrt(radius**3 / body.gravitational_parameter)
    length = tolerance * radius
    errors = length, length / dynamical_time
    return *errors, 0.02 * dynamical_time, ESCAPE_RADII * radius, body.gravitational_parameter


def _refuse_failed(
    starts: NDArray[np.float64], status: NDArray[np.int64], time: NDArray[np.float64], tolerance: float
) -> None:
    """Raise FloatingPointError for the first flight whose integration came to a halt."""
    if (status == FAILED).any():
        flight = int(np.flatnonzero(status == FAILED)[0])
        raise FloatingPointError(
            f"flight {flight} from {starts[flight, :3]} m at {starts[flight, 3:]} m/s: the step size fell below the "
            f"resolution of time at {time[flight]} s; loosen tolerance ({tolerance})."
        )


def _starts(position: ArrayLike, velocity: ArrayLike) -> NDArray[np.float64]:
    """Start states, shape [count, 6]."""
    where, rate = (np.atleast_2d(np.asarray(given, dtype=np.float64)) for given in (position, velocity))
    if where.shape != rate.shape or where.ndim != 2 or where.shape[1] != 3:
        raise ValueError(f"position has shape {where.shape} and velocity {rate.shape}; both must be [count, 3].")
    starts = np.concatenate([where, rate], axis=1)
    if not np.isfinite(starts).all():
        flight = int(np.flatnonzero(~np.isfinite(starts).all(axis=1))[0])
        raise ValueError(f"flight {flight} starts from {starts[flight]}; positions and velocities must be finite.")
    return starts


def _phases(body: Body, starts: NDArray[np.float64], slack: float) -> NDArray[np.int64]:
    """ON_SURFACE or ALOFT for each start; raises for those below the surface."""
    shape = body.shape
    height = np.empty(len(starts))
    position, facet = np.ascontiguousarray(starts[:, :3]), np.empty(len(starts), dtype=np.int64)
    near_heights(shape.grid.arrays, shape.corners, shape.pseudonormals, position, height, facet)
    far = np.flatnonzero(np.isinf(height))
    height[far[shape.contains(starts[far, :3])]] = -np.inf
    if (height < -slack).any():
        flight = int(np.flatnonzero(height < -slack)[0])
        depth = -float(shape.height(starts[flight, :3]))
        raise ValueError(
            f"flight {flight} starts {depth:.6g} m below the surface of {body.name}, at {starts[flight, :3]} m; "
            f"start on it or above it ({slack:.2g} m are forgiven)."
        )
    return np.where(np.abs(height) <= slack, ON_SURFACE, ALOFT)


def _run(
    part: Callable[[int], None], count: int, threads: int | None, progress: Callable[[float], None] | None
) -> None:
    """Do all parts, each of CHUNK flights, on threads."""
    workers = threads if threads is not None else os.cpu_count() or 1
    if workers < 1:
        raise ValueError(f"threads is {threads}; it must be 1 or more.")
    firsts = range(0, count, CHUNK)
    if min(workers, len(firsts)) <= 1:
        for number, first in enumerate(firsts, 1):
            part(first)
            if progress:
                progress(number / len(firsts))
        return
    with ThreadPoolExecutor(workers) as pool:
        futures: list[Any] = [pool.submit(part, first) for first in firsts]
        try:
            for number, future in enumerate(futures, 1):
                future.result()
                if progress:
                    progress(number / len(futures))
        finally:
            for future in futures:
                future.cancel()
