"""States out of Orbit Ephemeris Messages of the Consultative Committee for Space Data Systems.

Source: [CCSDS-2009], section 5 (keyword = value text)
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from lithobrake.vocabulary.clock import Epoch

# What each segment has to say of its states.
NEEDED = ("CENTER_NAME", "REF_FRAME", "TIME_SYSTEM")
# Ends of the time in which its states count; either may be absent.
USEABLE = ("USEABLE_START_TIME", "USEABLE_STOP_TIME")


@dataclass(frozen=True)
class MessageState:
    """One line of a message with states.

    line       of the file, from 1
    epoch      an instant; its text is in the time system of its segment
    numbers    x, y, z [km] and their rates [km/s]
    segment    what its segment says, by keyword; all states of a segment have the same object
    """

    line: int
    epoch: Epoch
    numbers: tuple[float, ...]
    segment: dict[str, str]


def message_states(path: Path, text: str) -> Iterator[MessageState]:
    """All states of all segments in their order; covariances are passed over.

    Raises ValueError with file, line and remedy for a line that is no state, a block that has no end, and a segment
    without frame or centre.
    """
    segment: dict[str, str] | None = None
    inside, number = "", 0
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split()
        if not words or words[0] == "COMMENT":
            continue
        if words[0] in ("META_START", "COVARIANCE_START"):
            _refuse_open(path, number, inside)
            inside = words[0].removesuffix("_START")
            segment = {} if inside == "META" else segment
        elif words[0] in ("META_STOP", "COVARIANCE_STOP"):
            inside = ""
            _refuse_lacking(path, number, segment or {})
        elif "=" in line:
            if inside == "META" and segment is not None:
                _add_keyword(path, number, line, segment)
        elif inside != "COVARIANCE":
            _refuse_open(path, number, inside)
            yield _state(path, number, words, segment)
    _refuse_open(path, number, inside)


def _refuse_open(path: Path, number: int, inside: str) -> None:
    """Raise ValueError at a line that stands in a block where none may, as its end is missing."""
    if inside:
        raise ValueError(f"{path}, line {number}: the block {inside}_START has no {inside}_STOP before it; write it")


def _add_keyword(path: Path, number: int, line: str, segment: dict[str, str]) -> None:
    key, _, value = (part.strip() for part in line.partition("="))
    if key in segment:
        raise ValueError(f"{path}, line {number}: {key} stands twice in its segment; keep one")
    segment[key] = value


def _refuse_lacking(path: Path, number: int, segment: dict[str, str]) -> None:
    lacking = [key for key in NEEDED if not segment.get(key)]
    if lacking:
        raise ValueError(f"{path}, line {number}: the segment has no {', '.join(lacking)}; add it below META_START")
    ends = []
    for key in USEABLE:
        try:
            ends.append(useable_time(segment, key))
        except ValueError as error:
            raise ValueError(f"{path}, line {number}: {key} {error}; mend it") from error
    begin, end = ends
    # All its states would be passed over without a word.
    if begin is not None and end is not None and end.since(begin) < 0.0:
        raise ValueError(
            f"{path}, line {number}: USEABLE_STOP_TIME {segment[USEABLE[1]]} is before USEABLE_START_TIME "
            f"{segment[USEABLE[0]]}; swap them"
        )


def useable_time(segment: dict[str, str], key: str) -> Epoch | None:
    """An end of the time in which the states of a segment count, out of USEABLE; None where it has none.

    States beyond stand for interpolation alone. Source: [CCSDS-2009], section 5.2.3
    """
    return _epoch(segment[key], segment) if segment.get(key) else None


def _epoch(text: str, segment: dict[str, str]) -> Epoch:
    return Epoch.of(text, segment["TIME_SYSTEM"].upper())


def _state(path: Path, number: int, words: list[str], segment: dict[str, str] | None) -> MessageState:
    """The state of a line: an epoch and six numbers, to which three of an acceleration may be added."""
    where = f"{path}, line {number}"
    if segment is None:
        raise ValueError(f"{where}: a state stands before the first META_START; put its segment before it")
    if len(words) not in (7, 10):
        raise ValueError(
            f"{where} has {len(words)} words; allowed: an epoch and six numbers, x, y, z in km and their rates in "
            "km/s; mend the line"
        )
    try:
        epoch = _epoch(words[0], segment)
    except ValueError as error:
        raise ValueError(f"{where}: the epoch {error}; mend the line") from error
    try:
        return MessageState(number, epoch, tuple(float(word) for word in words[1:7]), segment)
    except ValueError as error:
        raise ValueError(f"{where}: {error}; allowed: an epoch and numbers; mend the line") from error
