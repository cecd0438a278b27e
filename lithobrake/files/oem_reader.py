"""States out of Orbit Ephemeris Messages of the Consultative Committee for Space Data Systems.

Source: [CCSDS-2009], section 5 (keyword = value text)
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from lithobrake.vocabulary.clock import Epoch

# What each segment has to say of its states.
NEEDED = ("CENTER_NAME", "REF_FRAME", "TIME_SYSTEM")


@dataclass(frozen=True)
class MessageState:
    """One line of a message with states.

    line       of the file, from 1
    epoch      an instant; its text is in the time system of its segment
    numbers    x, y, z [km] and their rates [km/s]
    segment    what its segment says, by keyword
    """

    line: int
    epoch: Epoch
    numbers: tuple[float, ...]
    segment: dict[str, str]


def is_message(text: str) -> bool:
    """Whether a text begins as a message does."""
    return text.lstrip("\ufeff \t\r\n").startswith("CCSDS_OEM_VERS")


def message_states(path: Path, text: str) -> Iterator[MessageState]:
    """All states of all segments in their order; covariances are passed over.

    Raises ValueError with file, line and remedy for a line that is no state, and a segment without frame or centre.
    """
    segment: dict[str, str] | None = None
    inside = ""
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split()
        if not words or words[0] == "COMMENT":
            continue
        if words[0] in ("META_START", "COVARIANCE_START"):
            inside = words[0].removesuffix("_START")
            segment = {} if inside == "META" else segment
        elif words[0] in ("META_STOP", "COVARIANCE_STOP"):
            inside = ""
            _refuse_lacking(path, number, segment or {})
        elif "=" in line:
            key, _, value = line.partition("=")
            if inside == "META" and segment is not None:
                segment[key.strip()] = value.strip()
        elif inside != "COVARIANCE":
            yield _state(path, number, words, segment)


def _refuse_lacking(path: Path, number: int, segment: dict[str, str]) -> None:
    lacking = [key for key in NEEDED if key not in segment]
    if lacking:
        raise ValueError(f"{path}, line {number}: the segment has no {', '.join(lacking)}; add it below META_START")


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
        epoch = Epoch.of(words[0], segment.get("TIME_SYSTEM", "UTC").upper())
    except ValueError as error:
        raise ValueError(f"{where}: the epoch {error}; mend the line") from error
    try:
        return MessageState(number, epoch, tuple(float(word) for word in words[1:7]), segment)
    except ValueError as error:
        raise ValueError(f"{where}: {error}; allowed: an epoch and numbers; mend the line") from error
