"""Flights of chosen samples as Orbit Ephemeris Messages, and as kernels of SPICE (SPK, PCK)."""

import logging
import os
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from lithobrake.export.flown import ExportOptions, Flown, flight_count, has_journeys
from lithobrake.export.oem import POLE, RESOLUTION, Frame, Segment, write_oem
from lithobrake.files.atomic import atomic_path, write_whole
from lithobrake.geometry.naif_kernels import NUMBERS, spice
from lithobrake.results import StudyResults
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.callbacks import Progress
from lithobrake.vocabulary.clock import Epoch
from lithobrake.vocabulary.constants import DAY

STEPS = 100
log = logging.getLogger(__name__)
# Fewer flights have a covariance without full rank.
FEWEST = 7
MEAN_FILE = "flight_mean.oem"
# A line of text with a time and six numbers of 16 digits; six lines with the 21 of a covariance, and one with a time.
BYTES_OF_STATE, BYTES_OF_COVARIANCE, LARGE = 170.0, 540.0, 1e8
# Number of lander N is FIRST - N: no spacecraft has one so low. Frames of users begin at the second.
FIRST, FRAME = -1_000_000, 1_400_000
# Of the name of a body: SPICE has 32 characters for a variable, of which FRAME_ and _FIXED take twelve.
LONGEST_NAME = 20


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
    states: dict[tuple[int, int], list[Array]] = {key: [] for key in keys}
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


def ephemeris_names(results: StudyResults, chosen: ExportOptions) -> list[str]:
    """Names of the files: of the mean, where it is made or nothing else is asked for, and of each chosen sample."""
    has_mean = flight_count(results) >= FEWEST or not chosen.samples
    return [*([MEAN_FILE] if has_mean else []), *(f"flight_{sample}.oem" for sample in chosen.samples)]


def write_ephemerides(results: StudyResults, paths: Sequence[Path], chosen: ExportOptions) -> None:
    """Write an ephemeris of the mean of all first flights, and a file for each chosen sample.

    The standard has one object in a file. That of a sample has a segment for each of its flights over the bounces.
    A warning says so where the files get larger than 100 MB, and where too few flights make a mean. Raises ValueError
    for a frame, an epoch, a step or a sample that there is not, for ICRF without a pole, and for a mean of too few
    flights where no sample is chosen.
    """
    axes, flown = Frame.of(results, chosen.frame, chosen.epoch), Flown.of(results)
    flights = axes.timed(results, flown.journeys(results, chosen.samples))
    step = checked_step(flown, chosen.step)
    comments = [f"Flights of a study of lithobrake on {axes.body}. {axes.sentences}", axes.clock_sentence]
    _warn_of_size(flown, flights, step)
    lacking = _lacking_flights(results, len(flown.sample))
    if lacking and not chosen.samples:
        raise ValueError(f"{lacking}; name single flights with --flight, or {_more_flights(results)}")
    if lacking:
        log.warning("%s is not written: %s; %s.", MEAN_FILE, lacking, _more_flights(results))
    clouds = [] if lacking else [[_cloud(axes.timed_together(results, flown), axes, step, chosen.progress)]]
    segments = flight_segments(flights, axes, step, chosen.progress)
    for path, parts in zip(paths, [*clouds, *(segments[sample] for sample in chosen.samples)], strict=True):
        chosen.progress(1.0, f"writing {path.name}")
        write_oem(path, parts, axes.epoch, comments)


def _lacking_flights(results: StudyResults, count: int) -> str:
    """Why so many flights have no mean, in words; empty where they have."""
    who = "lander" if has_journeys(results) else "sample"
    flew = f"{count} {who} has a flight" if count == 1 else f"{count} {who}s have flights"
    return f"{flew}, and the covariance of their mean needs {FEWEST}" if count < FEWEST else ""


def _more_flights(results: StudyResults) -> str:
    return f"raise {'journey.count' if has_journeys(results) else 'flight.flight_count'} for the mean"


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


def write_spk(results: StudyResults, paths: Sequence[Path], chosen: ExportOptions) -> None:
    """Write an SPK, with a segment for each flight of the chosen samples, and constants of the body.

    Segments are of type 13 (Hermite) in the axes J2000, those of ICRF within a tenth of an arc second, about the body,
    in the time of SPICE (TDB); they are named "SAMPLE N FLIGHT K". Lander N has the number -1000000 - N. The constants
    have pole, angle of longitude 0 and spin of the body, its name, and its axes as the frame NAME_FIXED.
    Raises ValueError for a body without a number, and as write_ephemerides does; ImportError without spiceypy.
    """
    if not chosen.samples:
        raise ValueError("no sample is chosen whose flights are passed on; name some with --flight, from 0")
    number = _number(results) if chosen.body_number is None else chosen.body_number
    # SPICE takes its own axes alone, whatever the other files are in.
    axes, flown = Frame.of(results, "icrf", chosen.epoch), Flown.of(results)
    flights = axes.timed(results, flown.journeys(results, chosen.samples))
    segments = flight_segments(flights, axes, checked_step(flown, chosen.step), chosen.progress)
    orbits, constants = paths
    with atomic_path(orbits) as draft:
        _write_segments(draft, segments, number, axes.epoch)
    period = float(np.median(flown.spin_period))
    write_whole(constants, _constants(results, axes, number, period, list(segments)), "ascii")


def _number(results: StudyResults) -> int:
    site = results.study["site"]
    if site["body"] in NUMBERS:
        return NUMBERS[site["body"]]
    try:
        return int(site.get("kernel_body") or "")
    except ValueError:
        raise ValueError(
            f"the body {Path(site['body']).name} has no number in SPICE; give it with --body-number, or write it as "
            "site.kernel_body"
        ) from None


def _write_segments(path: Path, segments: dict[int, list[Segment]], number: int, epoch: Epoch) -> None:
    """Write segments whose times count from an epoch."""
    library = spice()
    handle = library.spkopn(os.fspath(path), "lithobrake", 0)
    for sample, parts in segments.items():
        for flight, part in enumerate(parts):
            # A flight that ends as it begins has no way between states.
            if part.interpolation_degree is None:
                continue
            times, states = _overlapping(part, epoch)
            name = f"SAMPLE {sample} FLIGHT {flight}"
            ends, degree = (times[0], times[-1]), part.interpolation_degree
            library.spkw13(
                handle, FIRST - sample, number, "J2000", *ends, name, degree, len(times), states.tolist(), times
            )
    library.spkcls(handle)


def _overlapping(part: Segment, epoch: Epoch) -> tuple[Array, Array]:
    """Times of SPICE [s], [count], and states [km], [count, 6], with ends that overlap by RESOLUTION the epochs of OEM.

    SPICE itself turns an epoch into a time that is known to some of its last digits, and refuses it outside of a
    segment.
    """
    times = np.array([epoch.after(one).ephemeris_time for one in part.time.tolist()])
    states = part.state * 1e-3
    for end, sign in ((0, -1.0), (-1, 1.0)):
        margin = sign * max(RESOLUTION, 4.0 * float(np.spacing(abs(times[end]))))
        times[end] += margin
        states[end, :3] += margin * states[end, 3:]
    return times, np.ascontiguousarray(states)


def spice_name(body: str) -> str:
    """The name of a body as SPICE takes it: not too long, and no number, which it would take for that of another."""
    name = body if not body.isdigit() else f"BODY_{body}"
    return name[:LONGEST_NAME].rstrip("_")


def _constants(results: StudyResults, axes: Frame, number: int, spin_period: float, samples: Sequence[int]) -> str:
    """Text of the constants; site.meridian_deg holds at the epoch."""
    right_ascension, declination, meridian = (float(results.study["site"][key]) for key in POLE)
    at_j2000 = (meridian - 360.0 * axes.epoch.ephemeris_time / spin_period) % 360.0
    frame, name = FRAME + abs(number) % 100_000, spice_name(axes.body)
    assigned = [(name, number), *((f"SAMPLE_{sample}", FIRST - sample) for sample in samples)]
    names = "".join(
        f"NAIF_BODY_NAME += ( '{one}' )\nNAIF_BODY_CODE += ( {code} )\n" for one, code in assigned
    )  # fmt: skip
    return (
        "KPL/PCK\n\n"
        f"Pole, angle of longitude 0 and spin of {axes.body}, from a study of lithobrake; the spin period is the\n"
        f"median of its samples, {spin_period!r} s. Its axes are the frame {name}_FIXED.\n\n"
        "\\begindata\n"
        f"BODY{number}_POLE_RA = ( {right_ascension!r} 0. 0. )\n"
        f"BODY{number}_POLE_DEC = ( {declination!r} 0. 0. )\n"
        f"BODY{number}_PM = ( {at_j2000!r} {360.0 * DAY / spin_period!r} 0. )\n"
        f"FRAME_{name}_FIXED = {frame}\n"
        f"FRAME_{frame}_NAME = '{name}_FIXED'\nFRAME_{frame}_CLASS = 2\n"
        f"FRAME_{frame}_CLASS_ID = {number}\nFRAME_{frame}_CENTER = {number}\n"
        f"{names}\\begintext\n"
    )
