"""Flights of a study as Orbit Ephemeris Messages: those of chosen samples, and the mean of the cloud of first ones."""

import logging
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lithobrake.export.flown import Flown, body_name
from lithobrake.export.oem import Segment, parsed_epoch, write_oem
from lithobrake.results import StudyResults
from lithobrake.vocabulary.progress import Progress, silent

log = logging.getLogger(__name__)

FRAMES = ("inertial", "fixed")
# An epoch that nobody takes for that of a landing.
NO_EPOCH = "2000-01-01T12:00:00"
# Fewer flights have a covariance without full rank.
FEWEST = 7
STEPS = 100
# A line of text with a time and six numbers of 16 digits; six lines with the 21 of a covariance, and one with a time.
BYTES_OF_STATE, BYTES_OF_COVARIANCE, LARGE = 170.0, 540.0, 1e8
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
    progress: Progress = silent,
) -> list[Path]:
    """Write flight_mean.oem, of all first flights, and a file for each chosen sample; give their paths.

    The standard has one object in a file. That of a sample has a segment for each of its flights over the bounces.

    samples   by their number in flights.csv
    frame     "inertial": axes that do not turn and are the body's at the epoch; "fixed": body-fixed axes
    epoch     at which all flights start [UTC]; absent: one that stands for no date, and the file says so
    step      between states [s]; absent: a hundredth of the longest flight
    progress  told the fraction that is done of what is being done
    A warning says so where the files get larger than 100 MB. Raises ValueError for a frame, an epoch, a step or a
    sample that there is not, and where too few flights make a cloud.
    """
    if frame not in FRAMES:
        raise ValueError(f"frame is {frame!r}; allowed: {', '.join(FRAMES)}")
    flown = Flown.of(results)
    chosen, longest = flown.journeys(results, list(dict.fromkeys(samples))), float(flown.end_time.max())
    step = longest / STEPS if step is None else step
    if not 10.0 * RESOLUTION <= step <= longest:
        raise ValueError(f"step is {step} s; allowed: {10.0 * RESOLUTION:g} to {longest:.6g} s, the longest flight")
    name, start = body_name(results), parsed_epoch(NO_EPOCH if epoch is None else epoch)
    comments = [
        f"Flights of a study of lithobrake on {name}. {_frame_sentence(name, frame)}",
        "All touchdowns are at the epoch of the frame"
        + (", which stands for no date: none was given." if epoch is None else "."),
    ]
    _warn_of_size(flown, chosen, step)
    files = {"flight_mean": [_cloud(flown, name, frame, step, progress)]}
    for sample, segment in _paths(chosen, name, frame, step, progress):
        files.setdefault(f"flight_{sample}", []).append(segment)
    written = {file: folder / f"{file}.oem" for file in flight_names(samples)}
    for file, path in written.items():
        progress(1.0, f"writing {path.name}")
        write_oem(path, files[file], start, comments)
    return list(written.values())


def flight_names(samples: Sequence[int]) -> list[str]:
    """Names of the files for chosen samples, without their ending."""
    return ["flight_mean", *(f"flight_{sample}" for sample in dict.fromkeys(samples))]


def _warn_of_size(flown: Flown, chosen: Flown, step: float) -> None:
    """Say so where the files get large: lines of states, and for each mean the six of a covariance."""
    means, states = float(flown.end_time.max()) / step, float(chosen.end_time.sum()) / step
    size = means * (BYTES_OF_STATE + BYTES_OF_COVARIANCE) + states * BYTES_OF_STATE
    if size > LARGE:
        log.warning(
            "The files will have some %.2g states and %.2g MB; a longer --step makes fewer.",
            means + states,
            1e-6 * size,
        )


def _paths(chosen: Flown, name: str, frame: str, step: float, progress: Progress) -> Iterator[tuple[int, Segment]]:
    """The sample and the segment of each flight, from its beginning to its end, those of a sample in order."""
    keys = _keys(chosen)
    ends = _states(chosen, chosen.end_time, *chosen.ends(), frame) if keys else np.empty((0, 6))
    last = dict(zip(keys, chosen.end_time.tolist(), strict=True))
    times: dict[tuple[int, int], list[float]] = {key: [] for key in keys}
    states: dict[tuple[int, int], list[NDArray[np.float64]]] = {key: [] for key in keys}
    for aloft in _epochs(chosen, step, 1, progress, "flights of the chosen samples"):
        for key, state in zip(_keys(aloft), _here(aloft, frame), strict=True):
            # The end is a state of its own, which must not stand twice.
            if last[key] - aloft.time > RESOLUTION:
                times[key].append(aloft.time)
                states[key].append(state)
    count = Counter(sample for sample, _ in keys)
    for key, begin, end in zip(keys, chosen.begin.tolist(), ends, strict=True):
        sample, arc = key
        time = np.array([*times[key], last[key]])
        yield (
            sample,
            Segment(
                *(f"SAMPLE_{sample}", name, _frame_name(name, frame)),
                *(begin + time, np.array([*states[key], end])),
                comments=[_path_sentence(sample, arc, count[sample])],
                # Hermite's polynomials take two numbers of each state; four states are plenty.
                interpolation_degree=2 * min(len(time), 4) - 1 if len(time) > 1 else None,
            ),
        )


def _keys(flown: Flown) -> list[tuple[int, int]]:
    """Sample of each flight and its number in the journey of that."""
    return list(zip(flown.sample.tolist(), flown.arc.tolist(), strict=True))


def _path_sentence(sample: int, arc: int, count: int) -> str:
    words = "; between flights that do not follow at once the lander slid over the ground" if count > 1 else ""
    return f"Flight {arc + 1} of {count} that are known of sample {sample}; its last state is its end{words}."


def _cloud(flown: Flown, name: str, frame: str, step: float, progress: Progress) -> Segment:
    """Mean and covariance of the flights that last, as long as there are enough of them."""
    if len(flown.sample) < FEWEST:
        raise ValueError(
            f"{len(flown.sample)} samples of the study fly; their covariance needs {FEWEST}: raise flight.flight_count"
        )
    times, means, covariances, counts = [], [], [], []
    for aloft in _epochs(flown, step, FEWEST, progress, "mean of all flights"):
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


def _epochs(flown: Flown, step: float, fewest: int, progress: Progress, what: str) -> Iterator[Flown]:
    """The flights that last at each step [s], as long as there are enough of them."""
    number, ends = 0, np.sort(flown.end_time)
    last = float(ends[-fewest]) if len(ends) >= fewest else 0.0
    while len(flown.sample) >= fewest:
        progress(min(flown.time / last, 1.0) if last > 0.0 else 1.0, what)
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
