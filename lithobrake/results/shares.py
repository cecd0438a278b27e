"""Shares and other numbers of a study with their intervals, and how its landings end."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lithobrake.results.json_values import INLINE
from lithobrake.vocabulary.screen import short_repr


@dataclass(frozen=True)
class Estimate:
    """A number with its interval, over beds and impact points that were not in the study."""

    value: float
    """the number, in the unit of its quantity"""
    lower: float | None
    """lower bound; null where there is none"""
    upper: float | None
    """upper bound; null where there is none"""


@dataclass(frozen=True)
class ShareInterval:
    """A share with its interval."""

    share: float
    """fraction of 1"""
    lower: float | None
    """lower bound; null where there is none"""
    upper: float | None
    """upper bound; null where there is none"""


@dataclass(frozen=True)
class CountedShare:
    """An outcome of landings, samples or journeys: how many have it, and which share that is."""

    count: int
    """number with this outcome, of sample_count"""
    share: float
    """fraction of all; landings of a drawn study without an outcome get the mean of those that left in flight across
    the edge of the bed"""
    lower: float | None
    """lower bound; for landings over beds and impact points not in the study and all possible ends of landings without
    an outcome; for samples over refits of the emulator to resampled beds; for journeys on hard ground from their
    number; null if there is none"""
    upper: float | None
    """upper bound"""
    upper_limit: float | None = None
    """95 % limit of the share of an outcome that no run had, with design.method = "paper" """


@dataclass(frozen=True)
class Level:
    """What the bounds of a table stand for."""

    level: float
    """probability that the bounds of this table stand for"""
    why: str | None
    """why the shares have no interval, in a sentence; null where they have one"""


@dataclass(frozen=True)
class ReturnFraction:
    """Return fraction: landings that impact again within flight.duration, or are captured where the site holds them."""

    share: float
    """return fraction over the input distributions of the study file: of the landings of a drawn study, where those
    without an outcome get the mean of those that left in flight across the edge of the bed; or of the samples of the
    expansion"""
    lower: float | None
    """lower bound, over beds and impact points not in the study, for all possible ends of the landings without an
    outcome; null if there is none (see why)"""
    upper: float | None
    """upper bound"""
    level: float
    """probability that the bounds of this table stand for"""
    from_: str
    """number of landings and beds, or of samples"""
    next_bed: tuple[float, float] | None
    """prediction interval for a new bed of the size of the study's: lower, upper; null where that is not known"""
    if_missing: tuple[float, float]
    """the fraction if none, and if all, of the landings without an outcome return, without sampling error"""
    missing: float
    """share of the landings, or samples, without an outcome"""
    emulator: float | None
    """the fraction from the emulator or the expansion, of the samples whose end is known"""
    why: str | None
    """why there is no interval, in a sentence; null where there is one"""


@dataclass(frozen=True)
class SampleShares:
    """Outcomes of the samples of a paper study, up to the last whose flight was computed. captured, left_sideways,
    time_limit, outside (with an impossible elevation or speed), impact, flying (at the end of flight.duration),
    escaped, partner. returns (impact, plus captured where the site holds the lander) and missing (left_sideways,
    time_limit, outside) are sums of some of these.
    """

    sample_count: int
    """samples up to the last that flew"""
    flight_count: int
    """of those, samples that flew"""
    outcomes: Mapping[str, CountedShare] = field(metadata=INLINE)
    why: str | None = None
    """why the shares have no interval, in a sentence"""
    __repr__ = short_repr


@dataclass(frozen=True)
class EmulatorShares:
    """Outcomes of the samples of the emulator of a drawn study, as fractions of all of them, for comparison."""

    sample_count: int
    """samples up to the last that flew"""
    flight_count: int
    """of those, samples that flew"""
    outcomes: Mapping[str, CountedShare] = field(metadata=INLINE)
    level: float
    """probability that the bounds of this table stand for"""
    why: str | None
    """why the shares have no interval, in a sentence; null where they have one"""


@dataclass(frozen=True)
class RunShares:
    """What became of the landings of a drawn study, by the flights of its runs, as estimates.json holds it."""

    sample_count: int
    """flights of all landings, 64 each, computed or not"""
    flight_count: int
    """of those, flights that were made"""
    level: float
    """probability that the bounds of this table stand for"""
    why: str | None
    """why the shares have no interval, in a sentence; null where they have one"""
    outcomes: Mapping[str, CountedShare] = field(metadata=INLINE)


@dataclass(frozen=True)
class LandingShares(RunShares):
    """Outcomes of the landings of a drawn study, from the flights of its runs. impact, flying (at the end of
    flight.duration), escaped, partner and captured add up to 1. returns: impact, plus captured where the site holds the
    lander. settled and lofted: captured where gravity and rotation hold the lander, or do not. missing: left_sideways,
    time_limit, failed.
    """

    emulator: EmulatorShares | None
    """null for a study of journeys, which has no emulator of single landings"""
    __repr__ = short_repr
