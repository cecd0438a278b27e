"""Orbit Ephemeris Messages, and the axes and epochs in which flights are passed on."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np

from lithobrake.export.flown import Flown, body_name, has_journeys, study_body
from lithobrake.files.atomic import write_whole
from lithobrake.geometry.attitude import axes_in_icrf
from lithobrake.results import StudyResults, Table
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.clock import Epoch

VERSION = "2.0"
# Of a line; the standard allows 254 characters.
LINE = 100
FRAMES = ("inertial", "fixed", "icrf")
# An epoch that nobody takes for that of a landing.
NO_EPOCH = "2000-01-01T12:00:00"
# Files have times in whole microseconds [s].
RESOLUTION = 1e-6
POLE = ("pole_right_ascension_deg", "pole_declination_deg", "meridian_deg")


@dataclass(frozen=True)
class Segment:
    """A part of an ephemeris: one object, one frame, without a jump.

    time         since the epoch of the message [s], ascending, [count]
    state        position [m] and velocity [m/s], [count, 6]
    covariance   of the state [SI], [count, 6, 6], or None
    comments     sentences
    interpolation_degree   of Hermite's polynomials between states, or None where states are no one path
    """

    object_name: str
    center_name: str
    frame: str
    time: Array
    state: Array
    covariance: Array | None = None
    comments: Sequence[str] = ()
    interpolation_degree: int | None = None


def write_oem(path: Path, segments: Iterable[Segment], epoch: Epoch, comments: Sequence[str] = ()) -> None:
    """Write segments whose times count from an epoch; lengths in km, as the standard has them."""
    lines = header_lines(f"CCSDS_OEM_VERS = {VERSION}", comments)
    for segment in segments:
        lines += _segment_lines(segment, epoch)
    write_whole(path, "\n".join(lines), "ascii")


def header_lines(version: str, comments: Sequence[str]) -> list[str]:
    made = datetime.now(UTC).replace(tzinfo=None, microsecond=0)
    return [version, *comment_lines(comments), f"CREATION_DATE = {made.isoformat()}", "ORIGINATOR = LITHOBRAKE", ""]


def epoch_texts(epoch: Epoch, time: Array) -> list[str]:
    """Dates and times (UTC) so many seconds after an epoch, in whole microseconds."""
    return [epoch.after(one).text() for one in time.tolist()]


def _segment_lines(segment: Segment, epoch: Epoch) -> Iterator[str]:
    times = epoch_texts(epoch, segment.time)
    yield "META_START"
    yield from comment_lines(segment.comments)
    yield f"OBJECT_NAME = {segment.object_name}"
    yield f"OBJECT_ID = {segment.object_name}"
    yield f"CENTER_NAME = {segment.center_name}"
    yield f"REF_FRAME = {segment.frame}"
    if segment.frame != "ICRF":
        yield f"REF_FRAME_EPOCH = {epoch.text()}"
    yield "TIME_SYSTEM = UTC"
    yield f"START_TIME = {times[0]}"
    yield f"STOP_TIME = {times[-1]}"
    if segment.interpolation_degree is not None:
        yield "INTERPOLATION = HERMITE"
        yield f"INTERPOLATION_DEGREE = {segment.interpolation_degree}"
    yield from ("META_STOP", "")
    for time, state in zip(times, segment.state * 1e-3, strict=True):
        yield f"{time} {number_texts(state)}"
    yield ""
    if segment.covariance is not None:
        yield "COVARIANCE_START"
        for time, covariance in zip(times, segment.covariance * 1e-6, strict=True):
            yield f"EPOCH = {time}"
            yield from (number_texts(covariance[row, : row + 1]) for row in range(6))
        yield from ("COVARIANCE_STOP", "")


def comment_lines(sentences: Sequence[str]) -> Iterator[str]:
    for sentence in sentences:
        yield from (f"COMMENT {line}" for line in wrap(sentence, LINE - len("COMMENT ")))


def number_texts(values: Array) -> str:
    """Numbers with all their digits."""
    return " ".join(f"{value:.16e}" for value in values.tolist())


@dataclass(frozen=True)
class Frame:
    """Axes with their origin at that of the body's shape, and the clock of the states in them.

    kind    fixed: turn with the body; inertial: those that the body has at the epoch; icrf
    body    name of the body, as body_name gives it
    epoch   from which times count
    clock   of the study: each lander at its own time after the epoch, that of the study; given: all first touchdowns
            are at an epoch that the user gave; none: at one that stands for no date
    axes    the body's axes at the epoch along the frame, in rows, [3, 3]
    """

    kind: str
    body: str
    epoch: Epoch
    clock: str
    axes: Array

    @classmethod
    def of(cls, results: StudyResults, kind: str, epoch: str | None) -> "Frame":
        """That of a study. Raises ValueError for a kind or an epoch that there is not, and for ICRF without a pole."""
        if kind not in FRAMES:
            raise ValueError(f"frame is {kind!r}; allowed: {', '.join(FRAMES)}")
        own = (results.study.get("delivery") or {}).get("epoch")
        clock = "given" if epoch is not None else "none" if own is None else "study"
        axes = _icrf_axes(results, clock, own) if kind == "icrf" else np.eye(3)
        try:
            start = Epoch.of((own if clock == "study" else epoch) or NO_EPOCH)
        except ValueError as error:
            raise ValueError(f"epoch {error}") from error
        return cls(kind, body_name(results), start, clock, axes)

    @property
    def name(self) -> str:
        """As a file names it."""
        return "ICRF" if self.kind == "icrf" else f"{self.body}_{self.kind.upper()}"

    @property
    def sentences(self) -> str:
        """What the axes are, in words."""
        fixed = f"{self.body}_FIXED turns with the body: z along its spin, x at longitude 0, origin at the origin of "
        fixed += "its shape."
        if self.kind == "fixed":
            return f"{fixed} Velocities are against these turning axes."
        if self.kind == "icrf":
            return f"The origin is that of the shape of {self.body}, and moves with the body."
        return (
            f"{self.name} has the axes that {self.body}_FIXED has at REF_FRAME_EPOCH, and does not turn; {fixed} Its "
            "origin moves with the body."
        )

    @property
    def clock_sentence(self) -> str:
        """When the flights are, in words."""
        if self.clock == "study":
            return "Each lander is at its own time, counted from delivery.epoch of the study."
        end = "." if self.clock == "given" else ", which stands for no date: none was given."
        return f"All touchdowns are at the epoch of the frame{end}"

    def timed(self, results: StudyResults, flown: Flown) -> Flown:
        """Flights whose beginnings count from the epoch. Raises ValueError where the study does not tell when."""
        if self.clock != "study":
            return flown
        starts = _first_arcs(results)
        offset = dict(zip(starts["sample"].tolist(), _state_times(results, starts) - starts["begin_s"], strict=True))
        return replace(flown, begin=flown.begin + np.array([offset[one] for one in flown.sample.tolist()]))

    def timed_together(self, results: StudyResults, flown: Flown) -> Flown:
        """First flights that all begin at one time: that of their states, or the epoch where these have many."""
        if self.clock != "study":
            return flown
        times = _state_times(results, _first_arcs(results))
        return replace(flown, begin=np.full_like(flown.begin, times[0] if np.ptp(times) <= RESOLUTION else 0.0))

    def states(self, flown: Flown, time: Array | float, position: Array, velocity: Array) -> Array:
        """Position [m] and velocity [m/s], [count, 6], along these axes, of body-fixed ones at times in flight [s]."""
        both = (position, velocity) if self.kind == "fixed" else flown.inertial(time, position, velocity)
        return np.concatenate([one @ self.axes for one in both], axis=1)


def _icrf_axes(results: StudyResults, clock: str, own: str | None) -> Array:
    """The body's axes at the epoch along ICRF, in rows. Raises ValueError where they are not known."""
    site = results.study["site"]
    lacking = [key for key in POLE if site.get(key) is None]
    if lacking:
        raise ValueError(
            f'frame is "icrf" and the study has no site.{lacking[0]}; write pole and meridian into its file, or choose '
            "another frame"
        )
    if clock == "none":
        raise ValueError('frame is "icrf", and its axes need an epoch: give the one at which site.meridian_deg holds')
    if clock == "given" and own is not None:
        raise ValueError(
            f'frame is "icrf" and epoch given; the study has {own}, at which site.meridian_deg holds: leave epoch out'
        )
    right_ascension, declination, meridian = (float(site[key]) for key in POLE)
    return np.asarray(axes_in_icrf(right_ascension, declination, np.radians(meridian)))


def _first_arcs(results: StudyResults) -> Table:
    """The first flight of each journey: from its state to the ground."""
    assert has_journeys(results), "an epoch of delivery goes with journeys"
    return results.arcs.where(results.arcs["arc"] == 0.0)


def _state_times(results: StudyResults, starts: Table) -> Array:
    """Times of the states after delivery.epoch [s], for first flights that begin with them."""
    delivery: dict[str, Any] = results.study["delivery"]
    if delivery.get("release"):
        return np.full(starts.row_count, float(delivery["release"]["time"]))
    body = study_body(results, *(float(np.median(starts[f"site_{name}"])) for name in ("mass", "spin_period")))
    if body.partner is None:
        return starts["clock_s"]
    longitude = results.study["site"].get("partner_longitude_deg")
    # Over a body that always shows its partner the same face it stands at longitude 0 unless the study says so.
    if longitude is None and body.partner.period == body.spin_period:
        longitude = 0.0
    if not isinstance(longitude, int | float):
        raise ValueError(
            "the study tells no time of its states, as it draws where the partner stands; give an epoch, at which all "
            "first touchdowns are then, with another frame than icrf"
        )
    there = np.full(starts.row_count, float(longitude))
    return starts["clock_s"] - body.partner_time(there, starts["site_spin_period"])
