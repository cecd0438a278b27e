"""Flights of a study as Orbit Ephemeris Messages: those of chosen samples, and the mean of the cloud of first ones."""

import logging
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from lithobrake.export.flight_segments import checked_step, flight_segments, stepped
from lithobrake.export.flown import Flown
from lithobrake.export.frames import Frame
from lithobrake.export.oem import Segment, write_oem
from lithobrake.results import StudyResults
from lithobrake.vocabulary.progress import Progress, silent

log = logging.getLogger(__name__)

# Fewer flights have a covariance without full rank.
FEWEST = 7
# A line of text with a time and six numbers of 16 digits; six lines with the 21 of a covariance, and one with a time.
BYTES_OF_STATE, BYTES_OF_COVARIANCE, LARGE = 170.0, 540.0, 1e8


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

    samples   by their number in flights.csv, or of journeys
    frame     "inertial": axes that do not turn and are the body's at the epoch; "fixed": body-fixed axes; "icrf":
              through pole and meridian of the study
    epoch     at which all first touchdowns are [UTC]; absent: each lander at its own time after delivery.epoch of the
              study; where that has none, an epoch that stands for no date, and the file says so
    step      between states [s]; absent: a hundredth of the longest flight
    progress  told the fraction that is done of what is being done
    A warning says so where the files get larger than 100 MB. Raises ValueError for a frame, an epoch, a step or a
    sample that there is not, for ICRF without a pole, and where too few flights make a cloud.
    """
    axes, flown = Frame.of(results, frame, epoch), Flown.of(results)
    chosen = axes.timed(results, flown.journeys(results, list(dict.fromkeys(samples))))
    step = checked_step(flown, step)
    comments = [
        f"Flights of a study of lithobrake on {axes.body}. {axes.sentences}",
        axes.clock_sentence,
    ]
    _warn_of_size(flown, chosen, step)
    files = {"flight_mean": [_cloud(axes.timed_together(results, flown), axes, step, progress)]}
    files |= {f"flight_{sample}": found for sample, found in flight_segments(chosen, axes, step, progress).items()}
    written = {file: folder / f"{file}.oem" for file in flight_names(samples)}
    for file, path in written.items():
        progress(1.0, f"writing {path.name}")
        write_oem(path, files[file], axes.epoch, comments)
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


def _cloud(flown: Flown, axes: Frame, step: float, progress: Progress) -> Segment:
    """Mean and covariance of the flights that last, as long as there are enough of them."""
    if len(flown.sample) < FEWEST:
        raise ValueError(
            f"{len(flown.sample)} samples of the study fly; their covariance needs {FEWEST}: raise flight.flight_count"
        )
    times, means, covariances, counts = [], [], [], []
    for aloft in stepped(flown, step, FEWEST, progress, "mean of all flights"):
        state = axes.states(aloft, aloft.time, aloft.position, aloft.velocity)
        times.append(float(flown.begin[0]) + aloft.time)
        means.append(state.mean(axis=0))
        covariances.append(np.cov(state, rowvar=False))
        counts.append(len(state))
    return Segment(
        *("MEAN_OF_FLIGHTS", axes.body, axes.name),
        *(np.array(times), np.array(means), np.array(covariances)),
        comments=[
            f"Mean state of the flights that still last at each epoch, with the covariance of their states: of "
            f"{counts[0]} flights at the start, and of {counts[-1]} at the end. Flights that have ended count no more, "
            f"so this is no path of one lander; it ends before fewer than {FEWEST} flights are left."
        ],
    )
