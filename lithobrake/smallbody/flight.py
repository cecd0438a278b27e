"""Flights from start states to the ground, to the end of the time, or away."""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.smallbody.acceleration import Dynamics, Forces, Orbit
from lithobrake.smallbody.attraction import Gravity
from lithobrake.smallbody.body import GRAVITATIONAL_CONSTANT, Body
from lithobrake.smallbody.facet_grid import near_heights
from lithobrake.smallbody.flight_results import ESCAPE_ORBITS, ESCAPE_RADII, STATUSES, Flights, StartStates
from lithobrake.smallbody.impact_search import ALOFT, ON_SURFACE, Ground
from lithobrake.smallbody.integration import FAILED, MOST_STEPS, FlightEnds, integrate_flights
from lithobrake.smallbody.rotation import into_frame, out_of_frame, refuse_beyond, turning_of
from lithobrake.smallbody.shape import Shape
from lithobrake.vocabulary.array_types import Floats, Integers
from lithobrake.vocabulary.given_numbers import finite_number, numbers, whole_number

CHUNK = 1024  # flights that a thread takes at a time
FARTHEST = 1e20  # of a start, in m and in m/s
LATEST = 1e12  # of a start [s]: its last digit is 1e-4 s, in which a body hardly turns
SPEED_OF_LIGHT = 299_792_458.0  # m/s


def fly(
    body: Body,
    position: ArrayLike,
    velocity: ArrayLike,
    duration: ArrayLike,
    *,
    gravity: str = "exact",
    frame: str = "body",
    start_time: ArrayLike = 0.0,
    mass: ArrayLike | None = None,
    spin_period: ArrayLike | None = None,
    tolerance: float | None = None,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Flights:
    """Fly from start states to the first impact, the end of the duration [s] (one, or one a flight), or escape.

    position, velocity   [m], [m/s], shape [count, 3] or [3], in the frame
    frame                "body": body-fixed, turning; a velocity of zero turns with the body. "inertial": axes that do
                         not turn and that are the body's at time 0; a lander at rest on the ground has the velocity of
                         the ground, spin_rate z cross position
    start_time           when each flight begins [s], one or one a flight: how far the body has then turned against the
                         inertial axes, and where its partner is
    gravity              "exact": the polyhedron's; "table": read from grids that are built once for a shape and kept
                         on disk, with the error shape.table_error; those of the partner are coarser, except for a
                         flight that begins on it
    mass, spin_period    [kg], [s], of the body in each flight, in place of its own: for a body that is not well known
    tolerance            error that one step may make: this part of the body's radius in position, and the same part
                         of radius over dynamical time in velocity; by default 3e-7 (impacts within centimetres), with
                         the table 3e-6, whose own error is larger
    threads              defaults to the number of cores; the result does not depend on it
    progress             called with the finished fraction of the flights, from this thread

    A body that does not turn uniformly (Body.rotation) turns as its history has it from start_time on; inertial axes
    are then those at time 0 of the frame that its attitudes are against, and spin_period is that of the body.

    A start on the surface (within a millionth of the radius, at most 1 mm) is no impact; the first meeting with the
    ground after the flight has left it is. A flight that starts on the surface and moves into it at once has its impact
    at time 0. The body's partner, if it has one, attracts and may be hit. Results are body-fixed whatever the frame of
    the starts. Raises ValueError for starts below the surface and for values that are not finite or out of range (a
    mass or a spin for which speeds at the surface reach that of light), FloatingPointError for a flight of more than
    a million steps, some 40 000 circuits near the surface at the default tolerance.
    """
    starts = _starts(position, velocity)
    begin = _one_each("start_time", start_time, len(starts), most=LATEST)
    times = _durations(duration, len(starts))
    tolerance = _checked_choices(frame, gravity, tolerance)
    count = len(starts)
    masses = _one_each("mass", body.mass if mass is None else mass, count, "kg")
    periods = _one_each("spin_period", body.spin_period if spin_period is None else spin_period, count, infinite=True)
    dynamics = _dynamics(body, masses, periods, tolerance)
    refuse_beyond(body.rotation, body.spin_period, periods, begin, begin + times)
    fixed, starts = _in_both_frames(body, starts, frame, dynamics.spin_rate, begin)
    phase, grounds = _phases(body, fixed, starts, dynamics.orbit, begin)
    ends, turning = FlightEnds.of_count(count), turning_of(body.rotation)
    sources, pieces = _pieces(body, gravity, phase)

    def part(which: Integers) -> None:
        forces = Forces(*sources[phase[which[0], 1]], dynamics.of_flights(which), turning)
        out = FlightEnds.of_count(len(which))
        integrate_flights(starts[which], begin[which], times[which], phase[which], forces, grounds, out)
        ends.put(which, out)

    _run(part, pieces, threads, progress)
    _refuse_failed(starts, ends, tolerance)
    begins = StartStates(begin, fixed[:, :3].copy(), fixed[:, 3:].copy(), masses, periods)
    place, rate = out_of_frame(body.rotation, ends.state[:, :3], ends.state[:, 3:], begin + ends.time)
    return Flights(body, begins, STATUSES[ends.status], ends.time, place, rate, ends.facet, ends.step_count)


def _checked_choices(frame: str, gravity: str, tolerance: float | None) -> float:
    """The tolerance, by default that of the gravity. Raises ValueError for a word or a number that is not allowed."""
    if frame not in ("body", "inertial"):
        raise ValueError(f"frame is {frame!r}; allowed are 'body' and 'inertial'.")
    if gravity not in ("exact", "table"):
        raise ValueError(f"gravity is {gravity!r}; allowed are 'exact' and 'table'.")
    if tolerance is None:
        return 3e-7 if gravity == "exact" else 3e-6
    return finite_number("tolerance", tolerance, at_least=1e-13, at_most=1e-3)


def _pieces(
    body: Body, gravity: str, phase: NDArray[np.int64]
) -> tuple[dict[int, tuple[Gravity, Gravity]], list[Integers]]:
    """What flights read of gravity, by their phase at the partner, and numbers of those that a thread takes at a time.

    A flight that begins on the partner is near it for long, and reads its gravity from the finer table. All flights of
    one piece begin on it, or none.
    """
    by_phase = {one: np.flatnonzero(phase[:, 1] == one) for one in np.unique(phase[:, 1]).tolist()}
    pieces = [which[first : first + CHUNK] for which in by_phase.values() for first in range(0, len(which), CHUNK)]
    return {one: _sources(body, gravity, near_partner=one == ON_SURFACE) for one in by_phase}, pieces


def _sources(body: Body, gravity: str, *, near_partner: bool) -> tuple[Gravity, Gravity]:
    """What attraction.attract reads of the body and of its partner; without one the body stands in, and is not asked.

    Kernels take both as one type, so a partner's table is coarser where flights are rarely near but is a table too.
    """
    own = body.shape.gravity if gravity == "exact" else body.shape.tabled_gravity
    if body.partner is None:
        return own, own
    other = body.partner.body.shape
    if gravity == "exact":
        return own, other.gravity
    return own, other.tabled_gravity if near_partner else other.distant_gravity


def _dynamics(body: Body, mass: NDArray[np.float64], spin_period: NDArray[np.float64], tolerance: float) -> Dynamics:
    if not ((mass > 0.0).all() and (spin_period > 0.0).all()):
        raise ValueError("mass and spin_period must be above 0 in every flight.")
    radius = body.shape.radius
    _refuse_relativistic(radius, mass, spin_period)
    parameter, spin_rate = GRAVITATIONAL_CONSTANT * mass, 2.0 * np.pi / spin_period
    orbit = body.orbit_with(parameter, spin_rate)
    dynamical_time = np.sqrt(radius**3 / parameter)
    other = None if body.partner is None else body.partner.body
    return Dynamics(
        strength=parameter / body.shape.volume,
        spin_rate=spin_rate,
        partner_strength=np.full(len(mass), 0.0 if other is None else GRAVITATIONAL_CONSTANT * other.density),
        # Far out both masses hold a flight back.
        parameter=parameter if other is None else parameter + other.gravitational_parameter,
        escape_radius=np.maximum(ESCAPE_RADII * radius, ESCAPE_ORBITS * orbit.distance),
        first_step=0.02 * dynamical_time,
        length_tolerance=np.full(len(mass), tolerance * radius),
        speed_tolerance=tolerance * radius / dynamical_time,
        orbit=Orbit(*(np.array(np.broadcast_to(entry, len(mass))) for entry in orbit)),
    )


def _refuse_relativistic(radius: float, mass: NDArray[np.float64], spin_period: NDArray[np.float64]) -> None:
    """Raise ValueError for a body that nothing slower than light escapes, or whose surface turns as fast as light.

    radius [m], masses [kg] and periods [s]. Newton's laws hold for neither, and squares of such speeds may be infinite.
    """
    heaviest = 0.5 * SPEED_OF_LIGHT**2 * radius / GRAVITATIONAL_CONSTANT
    shortest = 2.0 * np.pi * radius / SPEED_OF_LIGHT
    for name, number, unit, fine, allowed in (
        ("mass", mass.max(initial=0.0), "kg", "below", heaviest),
        ("spin_period", spin_period.min(initial=np.inf), "s", "above", shortest),
    ):
        if not (number < allowed if fine == "below" else number > allowed):
            raise ValueError(
                f"{name} is {number:g} {unit}; it must be {fine} {allowed:.3g} {unit}, where speeds on a body of "
                f"{radius:.4g} m radius reach that of light."
            )


def _one_each(
    name: str, given: ArrayLike, count: int, unit: str = "s", *, infinite: bool = False, most: float = np.inf
) -> NDArray[np.float64]:
    """A number a flight. Raises ValueError where there is another count of them, or one is not finite, or too large."""
    values = numbers(name, given)
    if values.shape not in ((), (1,), (count,)):
        raise ValueError(f"{name} has shape {values.shape} for {count} flights; give one number, or one a flight.")
    if not (~np.isnan(values) if infinite else np.isfinite(values)).all():
        raise ValueError(f"{name} is {given!r} {unit}; it must be finite.")
    if (np.abs(values) > most).any():
        raise ValueError(f"{name} is {given!r} {unit}; it must be from {-most:g} to {most:g} {unit}.")
    # A copy, since kernels would be compiled anew for an array of other strides that cannot be written.
    return np.array(np.broadcast_to(values, count))


def _durations(duration: ArrayLike, count: int) -> NDArray[np.float64]:
    """A duration [s] of each flight. Raises ValueError for one that is not above 0."""
    times = _one_each("duration", duration, count)
    if not (times > 0.0).all():
        raise ValueError(f"duration is {duration!r} s; it must be finite and above 0.")
    return times


def _in_both_frames(
    body: Body, starts: NDArray[np.float64], frame: str, spin_rate: NDArray[np.float64], begin: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Start states [count, 6] body-fixed, and in the frame that turns uniformly."""
    if frame == "inertial":
        starts = _into_turning_frame(starts, spin_rate, begin)
        return np.concatenate(out_of_frame(body.rotation, starts[:, :3], starts[:, 3:], begin), axis=1), starts
    return starts, np.concatenate(into_frame(body.rotation, starts[:, :3], starts[:, 3:], begin), axis=1)


def _into_turning_frame(
    starts: NDArray[np.float64], spin_rate: NDArray[np.float64], begin: NDArray[np.float64]
) -> NDArray[np.float64]:
    """States [count, 6] of the inertial axes as the turning body sees them: the ground's velocity is taken off."""
    c, s = np.cos(spin_rate * begin), np.sin(spin_rate * begin)
    result = starts.copy()
    for x, y in ((0, 1), (3, 4)):
        result[:, x], result[:, y] = c * starts[:, x] + s * starts[:, y], c * starts[:, y] - s * starts[:, x]
    result[:, 3] += spin_rate * result[:, 1]
    result[:, 4] -= spin_rate * result[:, 0]
    return result


def _refuse_failed(starts: NDArray[np.float64], ends: FlightEnds, tolerance: float) -> None:
    """Raise FloatingPointError for the first flight whose integration came to a halt."""
    failed = np.flatnonzero(ends.status == FAILED)
    if not len(failed):
        return
    flight = int(failed[0])
    which = f"flight {flight} from {starts[flight, :3]} m at {starts[flight, 3:]} m/s"
    if ends.step_count[flight] >= MOST_STEPS:
        raise FloatingPointError(
            f"{which}: it took {MOST_STEPS} steps in {ends.time[flight]:.6g} s, the most of a flight; shorten duration "
            f"or loosen tolerance ({tolerance})."
        )
    raise FloatingPointError(
        f"{which}: the step size fell below the resolution of time at {ends.time[flight]} s; loosen tolerance "
        f"({tolerance})."
    )


def _starts(position: ArrayLike, velocity: ArrayLike) -> NDArray[np.float64]:
    where, rate = (np.atleast_2d(one) for one in (numbers("position", position), numbers("velocity", velocity)))
    if where.shape != rate.shape or where.ndim != 2 or where.shape[1] != 3:
        raise ValueError(f"position has shape {where.shape} and velocity {rate.shape}; both must be [count, 3].")
    starts = np.concatenate([where, rate], axis=1)
    # The square of a much larger number is infinite, and such a flight would never end.
    far = ~(np.abs(starts) < FARTHEST).all(axis=1)
    if far.any():
        flight = int(np.flatnonzero(far)[0])
        raise ValueError(
            f"flight {flight} starts from {starts[flight]}; positions and velocities must be finite, and below "
            f"{FARTHEST:g} m and m/s."
        )
    return starts


def _phases(
    body: Body,
    fixed: NDArray[np.float64],
    starts: NDArray[np.float64],
    orbit: Orbit[Floats],
    begin: NDArray[np.float64],
) -> tuple[NDArray[np.int64], tuple[Ground, Ground]]:
    """ON_SURFACE or ALOFT of each start for the body and its partner, [count, 2], and the grounds of both.

    fixed: the starts body-fixed; starts: in the turning frame. Raises ValueError for starts below a surface.
    """
    slack = min(1e-6 * body.shape.radius, 1e-3)
    phase = np.full((len(starts), 2), ALOFT)
    phase[:, 0] = _phase(body.shape, fixed[:, :3], slack, body.name)
    ground = _ground(body.shape, slack)
    if body.partner is None:
        return phase, (ground, ground)
    other = body.partner.body
    position, _ = orbit.seen_from_partner(starts[:, :3], starts[:, 3:], begin)
    phase[:, 1] = _phase(other.shape, position, slack, other.name)
    return phase, (ground, _ground(other.shape, slack))


def _ground(shape: Shape, slack: float) -> Ground:
    return Ground(shape.grid, shape.corners, shape.pseudonormals, slack, shape.radius)


def _phase(shape: Shape, position: NDArray[np.float64], slack: float, name: str) -> NDArray[np.int64]:
    """ON_SURFACE or ALOFT for positions [count, 3] in the frame of a shape; raises for those below its surface."""
    height = np.empty(len(position))
    position, facet = np.ascontiguousarray(position), np.empty(len(position), dtype=np.int64)
    near_heights(shape.grid, shape.corners, shape.pseudonormals, position, height, facet)
    far = np.flatnonzero(np.isinf(height))
    # Heights are looked for within a cell of the surface; beyond that the solid angle tells on which side a start lies.
    height[far[shape.contains(position[far])]] = -np.inf
    if (height < -slack).any():
        flight = int(np.flatnonzero(height < -slack)[0])
        depth = -float(shape.height(position[flight]))
        raise ValueError(
            f"flight {flight} starts {depth:.6g} m below the surface of {name}, at {position[flight]} m; "
            f"start on it or above it ({slack:.2g} m are forgiven)."
        )
    return np.where(np.abs(height) <= slack, ON_SURFACE, ALOFT)


def _run(
    part: Callable[[Integers], None],
    pieces: list[Integers],
    threads: int | None,
    progress: Callable[[float], None] | None,
) -> None:
    workers = os.cpu_count() or 1 if threads is None else whole_number("threads", threads, 1)
    if min(workers, len(pieces)) <= 1:
        for number, piece in enumerate(pieces, 1):
            part(piece)
            if progress:
                progress(number / len(pieces))
        return
    with ThreadPoolExecutor(workers) as pool:
        futures: list[Any] = [pool.submit(part, piece) for piece in pieces]
        try:
            for number, future in enumerate(futures, 1):
                future.result()
                if progress:
                    progress(number / len(futures))
        finally:
            # After an error, or an interrupt, parts that have not begun are not flown any more.
            for future in futures:
                future.cancel()
