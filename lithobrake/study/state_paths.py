"""States out of a file, and what they stand for: landers, a path of one of them, or parts of an orbiter's time."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

# Two states lie on one path where the way between them is the mean of their velocities times the time, within this part
# of it; of other landers it is off by its own size, and three in a row are no chance.
PATH_ERROR = 0.1


class StateSegment(NamedTuple):
    """What a file says of some of its states: the name of their object, whether they are to be interpolated, as states
    of one path are, and between which times they count [s]; a table says nothing."""

    name: str = ""
    is_path: bool = False
    begin: float = -math.inf
    end: float = math.inf


@dataclass(frozen=True)
class DeliveredStates:
    """States of landers, or of an orbiter, one row each, in one frame.

    source     where each stands, in words
    time       [s], [count]
    position   [m] and velocity [m/s], [count, 3]
    attitude   quaternions w, x, y, z that turn the lander's axes into those of the frame, [count, 4]; None: not known
    rates      angular velocity about the lander's own axes, against axes that do not turn [rad/s], [count, 3]
    segment    number of the segment that each is of, in the order of `segments`, [count]; None: the only one
    """

    source: Sequence[str]
    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    attitude: np.ndarray | None = None
    rates: np.ndarray | None = None
    segment: np.ndarray | None = None
    segments: Sequence[StateSegment] = (StateSegment(),)

    def rows(self, first: int, count: int) -> "DeliveredStates":
        return self.chosen(np.arange(len(self.time))[first : first + count])

    def chosen(self, rows: np.ndarray) -> "DeliveredStates":
        """Those of these numbers, in this order."""
        columns = ("time", "position", "velocity", "attitude", "rates", "segment")
        given: dict[str, Any] = {name: None if (one := getattr(self, name)) is None else one[rows] for name in columns}
        return replace(self, source=[self.source[row] for row in rows.tolist()], **given)

    @property
    def numbers(self) -> np.ndarray:
        """Number of the segment of each state, [count]."""
        return np.zeros(len(self.time), dtype=np.int64) if self.segment is None else self.segment


def useable(states: DeliveredStates) -> DeliveredStates:
    """Those that count, and are not there for interpolation alone."""
    begin, end = (np.array([getattr(one, key) for one in states.segments])[states.numbers] for key in ("begin", "end"))
    return states.chosen(np.flatnonzero((begin <= states.time) & (states.time <= end)))


def paths(states: DeliveredStates) -> np.ndarray:
    """Number of the path that each state lies on, [count], from 0 on: the states of one path are one delivery.

    A path is a segment that says how it is to be interpolated, with later segments of the same object; or states in a
    row that each follow from the one before by their velocities.
    """
    number = states.numbers
    within, is_path = number[1:] == number[:-1], np.array([one.is_path for one in states.segments])[number]
    follows = within & _follows(states)
    long = follows & (np.append(False, follows[:-1]) | np.append(follows[1:], False))
    names = np.array([one.name for one in states.segments])[number]
    later = (names[1:] == names[:-1]) & (states.time[1:] >= states.time[:-1])
    joined = long | (is_path[1:] & is_path[:-1] & (within | later))
    return np.append(0, np.cumsum(~joined)) if len(states.time) else np.zeros(0, dtype=np.int64)


def _follows(states: DeliveredStates) -> np.ndarray:
    """Whether each state but the first is where the one before leads, [count - 1]."""
    passed = np.diff(states.time)
    way, mean = np.diff(states.position, axis=0), 0.5 * (states.velocity[1:] + states.velocity[:-1])
    off = np.linalg.norm(way - mean * passed[:, None], axis=1)
    found: np.ndarray = (passed > 0.0) & (off < PATH_ERROR * np.linalg.norm(way, axis=1))
    return found


def path_warning(states: DeliveredStates) -> str | None:
    """What it means that several of the landers of a study are on one path; None where each is on its own."""
    number = paths(states)
    count, path_count = len(number), len(set(number.tolist()))
    if path_count == count:
        return None
    first = int(np.flatnonzero(np.diff(number) == 0)[0])
    last = int(np.flatnonzero(number == number[first])[-1])
    whole = "one path" if path_count == 1 else f"{path_count} paths"
    return (
        f"The {count} states of delivery.states lie on {whole} ({states.source[first]} to {states.source[last]}"
        f"{' are one' if path_count > 1 else ''}), and states along a path are one delivery: the {count} landers stand "
        f"for {path_count} {'delivery' if path_count == 1 else 'deliveries'}, and fractions and intervals hold for no "
        "other; give one state per lander, or the spread in [delivery.release]."
    )


def orbiter_path(states: DeliveredStates) -> tuple[DeliveredStates, np.ndarray]:
    """The states of an orbiter in time, and the part of the time that each stands for, [count].

    Within a segment it is half the time to either neighbour, as far as the segment counts; a gap between segments
    counts for none. Raises ValueError, without the key, for states of several objects, at one time, or of segments that
    overlap.
    """
    names = list(dict.fromkeys(one.name for one in states.segments))
    if len(names) > 1:
        raise ValueError(f"are of {' and '.join(names)}; allowed: those of one object; leave the others out")
    parts = [np.flatnonzero(states.numbers == number) for number in range(len(states.segments))]
    parts = [part[np.argsort(states.time[part], kind="stable")] for part in parts if len(part)]
    parts.sort(key=lambda part: float(states.time[part[0]]))
    spans = [_spans(states, part) for part in parts]
    for one, other, ends, begins in zip(parts, parts[1:], spans, spans[1:], strict=False):
        if begins[0] < ends[-1]:
            raise ValueError(
                f"have two segments at one time ({states.source[int(one[-1])]} and {states.source[int(other[0])]}); "
                "allowed: segments that end before the next begins; shorten one, or give it a USEABLE_STOP_TIME"
            )
    weight = np.concatenate([np.diff(one) for one in spans])
    if not weight.sum() > 0.0:
        raise ValueError(
            f"are all at {states.time[0]:g} s ({len(states.time)} of them); allowed: states at two times or more, over "
            "the time that counts; add some"
        )
    return states.chosen(np.concatenate(parts)), weight / weight.sum()


def _spans(states: DeliveredStates, part: np.ndarray) -> np.ndarray:
    """Times at which the states of a segment, in their order, begin and end to count [s], one more than states."""
    time, segment = states.time[part], states.segments[int(states.numbers[part[0]])]
    ends = np.concatenate([time[:1], 0.5 * (time[1:] + time[:-1]), time[-1:]])
    return np.clip(ends, segment.begin, segment.end)
