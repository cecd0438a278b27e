"""Flights from start states to the ground, to the end of the time, or away."""

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.smallbody.body import GRAVITATIONAL_CONSTANT, Body
from lithobrake.smallbody.impact import ALOFT, ON_SURFACE
from lithobrake.smallbody.nearest import near_heights
from lithobrake.smallbody.trajectory import FAILED, fly_lanes

STATUSES = np.array(["flying", "impact", "escaped"])
ESCAPE_RADII = 10.0  # radii of the body beyond which a flight with positive energy has escaped
CHUNK = 1024  # flights that a thread takes at a time


@dataclass(frozen=True)
class Flights:
    """How each flight ended; every array has one entry or row a flight.

    status          "impact", "flying" (still, at the end of the duration) or "escaped": farther from the origin than
                    ESCAPE_RADII times the farthest vertex, moving outwards, with positive two-body energy in the
                    inertial frame
    time            from the start to the end of the flight [s]
    position        [m], velocity [m/s], at that time in the body-fixed frame, shape [count, 3]
    latitude        planetocentric [deg], longitude east in (-180, 180] [deg], of that position
    impact_speed    relative to the turning ground [m/s]; nan where there was no impact
    incidence       angle between the incoming velocity and the facet's inward normal [rad]; nan likewise
    facet           index of the facet that was hit; -1 likewise
    step_count      steps that the integration tried
    """

    body: Body
    start_position: NDArray[np.float64]
    start_velocity: NDArray[np.float64]
    status: NDArray[np.str_]
    time: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    facet: NDArray[np.int64]
    step_count: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.status)

    @cached_property
    def latitude(self) -> NDArray[np.float64]:
        """Planetocentric latitude at the end [deg]."""
        return self.body.shape.latitude_longitude(self.position)[0]

    @cached_property
    def longitude(self) -> NDArray[np.float64]:
        """East longitude at the end, in (-180, 180] [deg]."""
        return self.body.shape.latitude_longitude(self.position)[1]

    @cached_property
    def impact_speed(self) -> NDArray[np.float64]:
        """Speed relative to the ground at the impact [m/s], nan without one."""
        return np.where(self.facet >= 0, np.linalg.norm(self.velocity, axis=1), np.nan)

    @cached_property
    def incidence(self) -> NDArray[np.float64]:
        """Angle of the incoming velocity from the facet's inward normal [rad], nan without an impact."""
        inward = -np.einsum("fi,fi->f", self.velocity, self.body.shape.normals[self.facet])
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.arccos(np.clip(inward / self.impact_speed, -1.0, 1.0))

    @cached_property
    def jacobi_drift(self) -> NDArray[np.float64]:
        """Change of the Jacobi constant from start to end [m2/s2]: the error of integration and gravity together."""
        return self.body.jacobi(self.position, self.velocity) - self.body.jacobi(
            self.start_position, self.start_velocity
        )


def fly(
    body: Body,
    position: ArrayLike,
    velocity: ArrayLike,
    duration: float,
    *,
    gravity: str = "exact",
    tolerance: float = 1e-7,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Flights:
    """Fly from start states to the first impact, the end of the duration [s], or escape.

    position, velocity   body-fixed (turning) frame [m], [m/s], shape [count, 3] or [3]; a velocity of zero turns with
                         the body
    gravity              "exact": the polyhedron's; "table": read from grids that are built once for a shape and kept
                         on disk, with the error shape.table_error
    tolerance            error that one step may make: this share of the body's radius in position, and the same share
                         of radius over dynamical time in velocity
    threads              defaults to the number of cores; the result does not depend on it
    progress             called with the finished share of the flights, from this thread

    A start on the surface (within a millionth of the radius, at most 1 mm) is no impact; the first meeting with the
    ground after the flight has left it is. A flight that starts on the surface and moves into it at once has its impact
    at time 0. Raises ValueError for starts below the surface and for values that are not finite or out of range.
    """
    starts = _starts(position, velocity)
    if not (math.isfinite(duration) and duration > 0.0):
        raise ValueError(f"duration is {duration} s; it must be finite and above 0.")
    if not 1e-13 <= tolerance <= 1e-3:
        raise ValueError(f"tolerance is {tolerance}; it must lie in 1e-13 to 1e-3.")
    if gravity not in ("exact", "table"):
        raise ValueError(f"gravity is {gravity!r}; allowed are 'exact' and 'table'.")
    shape = body.shape
    slack = min(1e-6 * shape.radius, 1e-3)
    ground = (shape.grid.arrays, shape.corners, shape.pseudonormals, slack)
    phase = _phases(body, starts, slack)
    source = shape.gravity if gravity == "exact" else shape.tabled_gravity
    forces = (source, GRAVITATIONAL_CONSTANT * body.density, body.spin_rate)
    dynamical_time = math.sqrt(shape.radius**3 / body.gravitational_parameter)
    length = tolerance * shape.radius
    limits = (
        *(length, length / dynamical_time, 0.02 * dynamical_time),
        *(ESCAPE_RADII * shape.radius, body.gravitational_parameter),
    )
    count = len(starts)
    status, time, final = np.zeros(count, dtype=np.int64), np.zeros(count), np.zeros((count, 6))
    facet, steps = np.full(count, -1), np.zeros(count, dtype=np.int64)

    def part(first: int) -> int:
        piece = slice(first, min(first + CHUNK, count))
        out = (status[piece], time[piece], final[piece], facet[piece], steps[piece])
        fly_lanes(starts[piece], phase[piece], float(duration), forces, ground, limits, out)
        return piece.stop

    _run(part, count, threads, progress)
    if (status == FAILED).any():
        flight = int(np.flatnonzero(status == FAILED)[0])
        raise FloatingPointError(
            f"flight {flight} from {starts[flight, :3]} m at {starts[flight, 3:]} m/s: the step size fell below the "
            f"resolution of time at {time[flight]} s; loosen tolerance ({tolerance})."
        )
    return Flights(
        body,
        starts[:, :3].copy(),
        starts[:, 3:].copy(),
        STATUSES[status],
        time,
        final[:, :3],
        final[:, 3:],
        facet,
        steps,
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


def _run(part: Callable[[int], int], count: int, threads: int | None, progress: Callable[[float], None] | None) -> None:
    """Do all parts, each of CHUNK flights, on threads."""
    workers = threads if threads is not None else os.cpu_count() or 1
    if workers < 1:
        raise ValueError(f"threads is {threads}; it must be 1 or more.")
    done = 0
    with ThreadPoolExecutor(workers) as pool:
        futures: list[Any] = [pool.submit(part, first) for first in range(0, count, CHUNK)]
        try:
            for number, future in enumerate(futures, 1):
                done = max(done, future.result())
                if progress:
                    progress(number / len(futures))
        finally:
            for future in futures:
                future.cancel()
