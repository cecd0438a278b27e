"""What a study says of the limit states of its file."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.shares import ShareInterval
from lithobrake.vocabulary.screen import short_repr


@dataclass(frozen=True)
class LimitStateRuns:
    """A limit state by the runs, whichever source is used."""

    share: float
    """of the landings that meet it"""
    lower: float | None
    """lower bound, over beds and impact points not in the study; null where there is none"""
    upper: float | None
    """upper bound likewise"""
    from_: str
    """of how many landings and beds"""
    next_bed: tuple[float, float] | None
    """prediction interval for a new bed: lower, upper; null where that is not known"""
    if_missing: tuple[float, float]
    """the share if none, and if all, of the landings without an outcome meet it, without sampling error"""
    missing: float
    """share of the landings of which it is not known"""


@dataclass(frozen=True)
class LimitStateInput:
    """An input among the runs that meet a limit state."""

    distance: float
    """largest difference of the distribution functions of the input among the runs that meet it and over all"""
    lower: float
    """lower bound, by drawing beds with replacement"""
    upper: float
    """upper bound likewise"""
    luck: float
    """distance that chance alone passes in one of ten studies, all inputs together"""
    median: float
    """of the input among the runs that meet it, in its unit"""
    median_of_all: float
    """of its input distribution"""
    found: bool
    """whether the distance is above luck"""


@dataclass(frozen=True)
class LimitStateResult:
    """A limit state of the study file (docs/reliability.md)."""

    condition: str
    """as the study file has it"""
    probability: float
    """share of the landings that meet it, over the input distributions of the study file"""
    lower: float | None
    """lower bound, over beds and impact points not in the study; null where why says that there is none"""
    upper: float | None
    """upper bound likewise"""
    level: float
    """probability that the bounds of this table stand for"""
    source: str
    """runs, or the emulator where it is so rare (or so sure) that runs cannot tell"""
    runs: LimitStateRuns
    emulator: ShareInterval | None
    """the same by the emulator; null where it cannot tell"""
    tail_limit: float
    """largest probability of an event that no run on so many beds has met"""
    why: str | None
    """why there is no interval, in a sentence; null where there is one"""
    failing_runs: float
    """runs that meet it; of those whose flights meet it in part, their shares"""
    inputs: Mapping[str, LimitStateInput]
    """by input; empty where no run meets it, or all came down on one bed"""
    statement: str
    """all of it in a sentence"""
    __repr__ = short_repr


@dataclass(frozen=True)
class RareLimitState:
    """A rare limit state, by subset simulation with landings of its own (rare_*.json, docs/reliability.md)."""

    condition: str
    """as the study file has it"""
    probability: float
    """of a landing that meets it; 0 where it was not reached"""
    lower: float | None
    """lower bound; null where there is none"""
    upper: float | None
    """upper bound likewise"""
    level: float
    """probability that the bounds stand for"""
    origins: float
    """how many beds of one size the landings that meet it come from"""
    warning: str | None
    """that so few origins give no stable probability, in a sentence; null where they are enough"""
    reached: bool
    """whether a landing met it"""
    rarest: float
    """probability of the last level"""
    thresholds: tuple[float, ...]
    """of each level: distance from the limit, in standard deviations of the outputs of the first level"""
    shares: tuple[float, ...]
    """of each level: landings that lie within the next threshold"""
    landings: int
    """landings that were made"""
    beds: int
    """beds that they came down on"""
    statement: str
    """all of it in a sentence"""
    __repr__ = short_repr
