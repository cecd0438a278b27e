"""Flights of a study as Orbit Ephemeris Messages: chosen ones, and the mean of the cloud with its covariance."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lithobrake.export.flown import Flown, body_name
from lithobrake.export.oem import Segment, parsed_epoch, write_oem
from lithobrake.results import StudyResults

FRAMES = ("inertial", "fixed")
# An epoch that nobody takes for that of a landing.
NO_EPOCH = "2000-01-01T12:00:00"
# Fewer flights have a covariance without full rank.
FEWEST = 7
STEPS = 100
# The file has times in whole microseconds.
RESOLUTION = 1e-6


def write_ephemerides(
    results: StudyResults,
    folder: Path,
    samples: Sequence[int] = (),
    *,
    frame: str = "inertial",
    epoch: str | None = None,
    step: float | None = None,
) -> list[Path]:
    """Write flight_mean.oem, of all flights, and a file for each chosen sample; give their paths.

    The standard has one object in a file.

    samples   by their number in flights.csv
    frame     "inertial": axes that do not turn and are the body's at the epoch; "fixed": body-fixed axes
    epoch     at which all flights start [UTC]; absent: one that stands for no date, and the file says so
    step      between states [s]; absent: a hundredth of the longest flight
    Raises ValueError for a frame, an epoch, a step or a sample that there is not, and where too few flights make a
    cloud.
    """
    if frame not in FRAMES:
        raise ValueError(f"frame is {frame!r}; allowed: {', '.join(FRAMES)}")
    flown = Flown.of(results)
    chosen, longest = flown.of_samples(samples), float(flown.end_time.max())
    step = longest / STEPS if step is None else step
    if not 10.0 * RESOLUTION <= step <= longest:
        raise ValueError(f"step is {step} s; allowed: {10.0 * RESOLUTION:g} to {longest:.6g} s, the longest flight")
    name, start = body_name(results), parsed_epoch(NO_EPOCH if epoch is None else epoch)
    comments = [
        f"Flights of a study of lithobrake, from the touchdown to the next impact. {_frame_sentence(name, frame)}",
        "All flights start at the epoch of the frame"
        + (", which stands for no date: none was given." if epoch is None else "."),
    ]
    written = []
    for file, segment in (("flight_mean", _cloud(flown, name, frame, step)), *_paths(chosen, name, frame, step)):
        written.append(folder / f"{file}.oem")
        write_oem(written[-1], [segment], start, comments)
    return written


def _paths(flown: Flown, name: str, frame: str, step: float) -> Iterator[tuple[str, Segment]]:
    """The name of the file and the segment of each flight, from its start to its end."""
    ends = _states(flown, flown.end_time, *flown.ends(), frame) if len(flown.sample) else np.empty((0, 6))
    last = dict(zip(flown.sample.tolist(), flown.end_time.tolist(), strict=True))
    times: dict[int, list[float]] = {sample: [] for sample in flown.sample.tolist()}
    states: dict[int, list[NDArray[np.float64]]] = {sample: [] for sample in times}
    for aloft in _epochs(flown, step, fewest=1):
        for sample, state in zip(aloft.sample.tolist(), _here(aloft, frame), strict=True):
            # The end is a state of its own, which must not stand twice.
            if last[sample] - aloft.time > RESOLUTION:
                times[sample].append(aloft.time)
                states[sample].append(state)
    for (sample, end_time), end in zip(last.items(), ends, strict=True):
        segment = Segment(
            *(f"SAMPLE_{sample}", name, _frame_name(name, frame)),
            *(np.array([*times[sample], end_time]), np.array([*states[sample], end])),
            comments=[f"Sample {sample} of the study; the last state is the end of its flight."],
            # Hermite's polynomials of degree 7 go through four states.
            interpolation_degree=7 if len(times[sample]) >= 3 else None,
        )
        yield f"flight_{sample}", segment


def _cloud(flown: Flown, name: str, frame: str, step: float) -> Segment:
    """Mean and covariance of the flights that last, as long as there are enough of them."""
    if len(flown.sample) < FEWEST:
        raise ValueError(
            f"{len(flown.sample)} samples of the study fly; their covariance needs {FEWEST}: raise flight.flight_count"
        )
    times, means, covariances, counts = [], [], [], []
    for aloft in _epochs(flown, step, FEWEST):
        state = _here(aloft, frame)
        times.append(aloft.time)
        means.append(state.mean(axis=0))
        covariances.append(np.cov(state, rowvar=False))
        counts.append(len(state))
    return Segment(
        *("MEAN_OF_FLIGHTS", name, _frame_name(name, frame)),
        *(np.array(times), np.array(means), np.array(covariances)),
        comments=[
            f"Mean state of the flights that still last at each epoch, with the covariance of their states: of "
            f"{counts[0]} flights at the start, and of {counts[-1]} at the end. Flights that have ended count no more, "
            f"so this is no path of one lander; it ends before fewer than {FEWEST} flights are left."
        ],
    )


def _epochs(flown: Flown, step: float, fewest: int) -> Iterator[Flown]:
    """The flights that last at each step [s], as long as there are enough of them."""
    number = 0
    while len(flown.sample) >= fewest:
        yield flown
        number += 1
        flown = flown.at(number * step)


def _here(flown: Flown, frame: str) -> NDArray[np.float64]:
    return _states(flown, flown.time, flown.position, flown.velocity, frame)


def _states(
    flown: Flown,
    time: NDArray[np.float64] | float,
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    frame: str,
) -> NDArray[np.float64]:
    """Position [m] and velocity [m/s], [count, 6], in the frame, of body-fixed ones at times since the start [s]."""
    both = flown.inertial(time, position, velocity) if frame == "inertial" else (position, velocity)
    return np.concatenate(both, axis=1)


def _frame_name(name: str, frame: str) -> str:
    return f"{name}_{frame.upper()}"


def _frame_sentence(name: str, frame: str) -> str:
    fixed = f"{name}_FIXED turns with the body: z along its spin, x at longitude 0, origin at the origin of its shape."
    if frame == "fixed":
        return f"{fixed} Velocities are against these turning axes."
    return (
        f"{name}_INERTIAL has the axes that {name}_FIXED has at REF_FRAME_EPOCH, and does not turn; {fixed} Its origin "
        "moves with the body."
    )
