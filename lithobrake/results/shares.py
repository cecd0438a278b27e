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
    """of sample_count, those of which this is so"""
    share: float
    """of all; among landings of a drawn study those without an outcome count as like those that left in flight across
    the edge of the bed"""
    lower: float | None
    """lower bound: of landings over beds and impact points not in the study, whatever became of the landings without an
    outcome; of samples over refits of the emulator to other beds; of journeys on hard ground by their number; null
    where there is none"""
    upper: float | None
    """upper bound likewise"""
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
    """Of all landings those that impact again within flight.duration, or are captured where the site holds them."""

    share: float
    """over the input distributions of the study file: of the landings of a drawn study, those without an outcome as
    like those that left in flight across the edge of the bed, or of samples of the expansion"""
    lower: float | None
    """lower bound, over beds and impact points not in the study, whatever became of the landings without an outcome;
    null where why says that there is none"""
    upper: float | None
    """upper bound likewise"""
    level: float
    """probability that the bounds of this table stand for"""
    from_: str
    """of how many landings and beds, or samples"""
    next_bed: tuple[float, float] | None
    """prediction interval for a new bed of the size of the study's: lower, upper; null where that is not known"""
    if_missing: tuple[float, float]
    """the share if none, and if all, of the landings without an outcome return, without sampling error"""
    missing: float
    """share of the landings, or samples, without an outcome"""
    emulator: float | None
    """the share by the emulator or the expansion, of the samples whose end is known"""
    why: str | None
    """why there is no interval, in a sentence; null where there is one"""


@dataclass(frozen=True)
class SampleShares:
    """What became of the samples of a paper study, up to the last that flew.

    captured, left_sideways, time_limit, outside (with an elevation or speed that cannot be), impact, flying (at the end
    of the time), escaped, partner; returns (impact, and captured where the site holds) and missing (left_sideways,
    time_limit, outside) hold some of these.
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
    """The same by the samples of the emulator of a drawn study, as shares of all of these, for comparison."""

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
    """flights of all landings, 64 each, whether they could be made or not"""
    flight_count: int
    """of those, flights that were made"""
    level: float
    """probability that the bounds of this table stand for"""
    why: str | None
    """why the shares have no interval, in a sentence; null where they have one"""
    outcomes: Mapping[str, CountedShare] = field(metadata=INLINE)


@dataclass(frozen=True)
class LandingShares(RunShares):
    """What became of the landings of a drawn study, by the flights of its runs.

    impact, flying (at the end of the time), escaped, partner and captured add up to 1. returns: impact, and captured
    where the site holds; settled and lofted: captured where the ground holds, or lifts off; missing: left_sideways,
    time_limit, failed.
    """

    emulator: EmulatorShares | None
    """null for a study of journeys, which has no emulator of single landings"""
    __repr__ = short_repr
