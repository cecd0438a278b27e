"""What a study says of the limit states of its file."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.shares import ShareInterval
from lithobrake.vocabulary.screen import short_repr


@dataclass(frozen=True)
class LimitStateRuns:
    """A limit state estimated from the runs, whichever source is used."""

    share: float
    """of the landings that meet it"""
    lower: float | None
    """lower bound, over beds and impact points not in the study; null where there is none"""
    upper: float | None
    """upper bound"""
    from_: str
    """of how many landings and beds"""
    next_bed: tuple[float, float] | None
    """prediction interval for a new bed: lower, upper; null where that is not known"""
    if_missing: tuple[float, float]
    """the fraction if none, and if all, of the landings without an outcome meet it, without sampling error"""
    missing: float
    """fraction of the landings for which it is unknown"""


@dataclass(frozen=True)
class LimitStateInput:
    """An input among the runs that meet a limit state."""

    distance: float
    """largest difference between the distribution function of the input among the runs that meet it and its input
    distribution"""
    lower: float
    """lower bound, from resampled beds"""
    upper: float
    """upper bound"""
    luck: float
    """distance that, without any effect, any of the inputs exceeds in one of ten studies"""
    median: float
    """of the input among the runs that meet it, in its unit"""
    median_of_all: float
    """of its input distribution"""
    found: bool
    """whether the input is significant: the distance exceeds luck"""


@dataclass(frozen=True)
class LimitStateResult:
    """A limit state of the study file (docs/reliability.md)."""

    condition: str
    """as in the study file"""
    probability: float
    """share of the landings that meet it, over the input distributions of the study file"""
    lower: float | None
    """lower bound, over beds and impact points not in the study; null where why says that there is none"""
    upper: float | None
    """upper bound"""
    level: float
    """probability that the bounds of this table stand for"""
    source: str
    """runs, or emulator if the probability is too close to 0 or 1 for the runs"""
    runs: LimitStateRuns
    emulator: ShareInterval | None
    """estimate from the emulator; null if there is none"""
    tail_limit: float
    """upper limit of the probability of an event that occurred in no run on this number of beds"""
    why: str | None
    """why there is no interval, in a sentence; null where there is one"""
    failing_runs: float
    """runs that meet it; a run whose flights meet it in part counts with that fraction"""
    inputs: Mapping[str, LimitStateInput]
    """by input; empty if no run meets it, or if there is only one bed"""
    statement: str
    """the result in a sentence"""
    __repr__ = short_repr


@dataclass(frozen=True)
class RareLimitState:
    """A rare limit state, by subset simulation with landings of its own (rare_*.json, docs/reliability.md)."""

    condition: str
    """as in the study file"""
    probability: float
    """of a landing that meets it; 0 where it was not reached"""
    lower: float | None
    """lower bound; null where there is none"""
    upper: float | None
    """upper bound"""
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
    """beds of these runs"""
    statement: str
    """the result in a sentence"""
    __repr__ = short_repr
