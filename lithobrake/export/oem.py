"""Orbit Ephemeris Messages of the Consultative Committee for Space Data Systems, as keyword = value text.

Source: [CCSDS-2009]
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from textwrap import wrap

import numpy as np
from numpy.typing import NDArray

from lithobrake.files.atomic import atomic_path

VERSION = "2.0"
# Of a line; the standard allows 254 characters.
LINE = 100
# Of an epoch.
YEARS = (1900, 2999)


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
    time: NDArray[np.float64]
    state: NDArray[np.float64]
    covariance: NDArray[np.float64] | None = None
    comments: Sequence[str] = ()
    interpolation_degree: int | None = None


def parsed_epoch(text: str) -> datetime:
    """The epoch [UTC] of a text like 2026-11-22T12:00:00. Raises ValueError for another, or another time of history."""
    allowed = f"allowed: a UTC date and time of the years {YEARS[0]} to {YEARS[1]} such as 2026-11-22T12:00:00"
    try:
        found = datetime.fromisoformat(text)
    except ValueError as error:
        raise ValueError(f"epoch is {text!r}; {allowed}") from error
    # Before it is moved to UTC, or a flight is added: neither has room at the ends of the calendar.
    if not YEARS[0] <= found.year <= YEARS[1]:
        raise ValueError(f"epoch is {text!r}; {allowed}")
    return found.replace(tzinfo=None) if found.tzinfo is None else found.astimezone(UTC).replace(tzinfo=None)


def write_oem(path: Path, segments: Iterable[Segment], epoch: datetime, comments: Sequence[str] = ()) -> None:
    """Write segments whose times count from an epoch [UTC]; lengths in km, as the standard has them."""
    lines = header_lines(f"CCSDS_OEM_VERS = {VERSION}", comments)
    for segment in segments:
        lines += _segment_lines(segment, epoch)
    with atomic_path(path) as draft:
        draft.write_text("\n".join(lines), encoding="ascii")


def header_lines(version: str, comments: Sequence[str]) -> list[str]:
    """The first lines of a message."""
    made = datetime.now(UTC).replace(tzinfo=None, microsecond=0)
    return [version, *comment_lines(comments), f"CREATION_DATE = {made.isoformat()}", "ORIGINATOR = LITHOBRAKE", ""]


def epoch_texts(epoch: datetime, time: NDArray[np.float64]) -> list[str]:
    """Dates and times [UTC] so many seconds after an epoch, in whole microseconds."""
    return [(epoch + timedelta(seconds=one)).isoformat(timespec="microseconds") for one in time.tolist()]


def _segment_lines(segment: Segment, epoch: datetime) -> Iterator[str]:
    times = epoch_texts(epoch, segment.time)
    yield "META_START"
    yield from comment_lines(segment.comments)
    yield f"OBJECT_NAME = {segment.object_name}"
    yield f"OBJECT_ID = {segment.object_name}"
    yield f"CENTER_NAME = {segment.center_name}"
    yield f"REF_FRAME = {segment.frame}"
    if segment.frame != "ICRF":
        yield f"REF_FRAME_EPOCH = {epoch.isoformat(timespec='microseconds')}"
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
    """Sentences as comments of a message."""
    for sentence in sentences:
        yield from (f"COMMENT {line}" for line in wrap(sentence, LINE - len("COMMENT ")))


def number_texts(values: NDArray[np.float64]) -> str:
    """Numbers with all their digits."""
    return " ".join(f"{value:.16e}" for value in values.tolist())
