"""Shares and other numbers of the runs of a study with their intervals, and parts of the variance."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Annotated, Any

from lithobrake.vocabulary.estimate import INLINE, Estimate, Inlined, Keyed, Number, Share
from lithobrake.vocabulary.landing_fraction import LandingFraction
from lithobrake.vocabulary.plain_text import short_repr


@dataclass(frozen=True)
class MissingLandings:
    """The runs without an outcome: left the bed laterally, in contact at the time limit, or failed."""

    count: int
    """runs without an outcome"""
    share: float
    """the same as a share of all runs"""
    outcomes: Mapping[str, int]
    """of these, number of runs with each outcome; empty where every run has an outcome"""


@dataclass(frozen=True)
class SideRuns:
    """Results of the auxiliary runs (design.side_runs)."""

    soil_pairs: int
    """runs that were repeated on a second soil"""
    twins: int
    """runs that were repeated with a slightly shifted impact point"""
    twin_shift: float
    """that shift [m]"""
    soil_total_effect: Mapping[str, Share]
    """by output: share of its variance that the soil explains, including interactions with bed, impact point and
    attitude"""
    chaos_deviation: Mapping[str, Number]
    """by output: standard deviation due to chaos alone, in the output's unit"""


@dataclass(frozen=True)
class RunResults:
    """The first touchdowns of the landers, without auxiliary runs."""

    count: int
    """runs"""
    beds: int
    """beds of these runs"""
    outcomes: Mapping[str, int]
    """number of runs with this outcome; failed: runs without an outcome"""
    missing: MissingLandings
    warning: str | None
    """if more than 2 % of the runs have no outcome: how many, why, what this means for the results, and how to avoid
    it, in a sentence; otherwise null"""
    over_rim: int
    """runs that left across the edge of the bed in flight, moving up and touching nothing"""
    farther_than_period: int | None
    """runs in which the lander travelled farther in contact than the width of the bed, over ground that it may have
    disturbed; null if beds have walls"""
    side_runs: SideRuns | None
    """null without design.side_runs"""


@dataclass(frozen=True)
class OutputEstimate:
    """An output over the first touchdowns that have it, in its unit; bounds hold whatever became of those without an
    outcome, and are null where nothing limits what they may have."""

    mean: Number
    """mean"""
    quantiles: Mapping[str, Number]
    """by level, as "0.5" """
    standard_deviation: float
    """of the runs"""
    of: str
    """which landings it describes, in words"""


@dataclass(frozen=True)
class OutputDirection:
    """An output that is an angle around the circle, such as azimuth_out, over the runs that have it."""

    mean_direction: Number
    """direction of the mean of the unit vectors [rad]; its bounds may lie beyond pi"""
    resultant_length: Number
    """length of that mean: 0 if directions cancel, 1 if all are equal"""
    of: str
    """which landings it describes, in words"""


@dataclass(frozen=True)
class OutputRange:
    """Other outputs of the touchdowns, over the distinct runs that have them."""

    median: float
    """median over these runs"""
    smallest: float
    """smallest value"""
    largest: float
    """largest value"""
    unit: str
    """of the three numbers"""
    of: str
    """which landings have it, in words"""


@dataclass(frozen=True)
class VarianceParts:
    """Parts of the variance of an output (docs/estimates.md).

    null where the runs cannot show it. returns: the return fraction of each run over its flights.
    Each part lies within [0, 1]; its bounds hold whatever became of runs without an outcome.
    """

    soil: Share
    """part that inputs of grains, surface and the lander's contacts explain at least, by their terms"""
    soil_doubled: Share
    """the same with input distributions of the soil twice as wide, each on its own scale"""
    terms: str
    """degree of the terms of the inputs, in words"""
    soil_by_input: Mapping[str, Share]
    """part of one of these inputs alone"""
    arrival: Share | None
    """all other inputs, as speed, incidence and mass; null where none is uncertain"""
    attitude: Share | None
    """terms of second degree of the surface normal and the direction of travel, seen from the lander; null for a ball,
    for one attitude alone, and where the runs are too few"""
    bed: Share
    """part that landings on one bed have in common"""
    place: Share
    """everything else: impact point, lack of fit and interactions; for a journey also everything that is random in
    later touchdowns"""
    chaos: Share | None
    """part due to chaos, from perturbed runs; null without auxiliary runs"""
    of: str
    """which landings it describes, in words"""
    __repr__ = short_repr

    @classmethod
    def of_shares(cls, found: Any, of: str) -> "VarianceParts":
        """Those of an analysis (VarianceShares); of: which landings they describe."""
        return cls(**{one.name: getattr(found, one.name) for one in fields(cls) if one.name != "of"}, of=of)

    @property
    def parts(self) -> dict[str, Estimate]:
        """The parts that are known, by their keys; together they are the whole."""
        found = {
            "soil": self.soil, "arrival": self.arrival, "attitude": self.attitude, "bed": self.bed,
            "place": self.place, "chaos": self.chaos,
        }  # fmt: skip
        return {name: one for name, one in found.items() if one is not None}


@dataclass(frozen=True)
class CountedShare(Inlined):
    """How many landings, samples or journeys have an outcome, and which share that is.

    Bounds are over beds and impact points not in the study, and over all possible ends of landings and journeys without
    an outcome; of samples over refits of the emulator to resampled beds; of journeys on hard ground from their number.
    """

    count: int
    """number with this outcome"""
    share: Share = field(metadata=INLINE)
    """fraction of all; landings without an outcome get the mean of those that left in flight across
    the edge of the bed, journeys that failed that of the others"""
    upper_limit: float | None = None
    """95 % limit of the share of an outcome that no run had, in samples of an expansion"""

    def within(self, lower: float | None, upper: float | None) -> "CountedShare":
        """The same with other bounds."""
        return replace(self, share=replace(self.share, lower=lower, upper=upper))


@dataclass(frozen=True)
class Level:
    """What the bounds of a table stand for."""

    level: float
    """probability that the bounds of this table stand for"""
    why: str | None
    """why the shares have no interval, in a sentence; null where they have one"""


@dataclass(frozen=True)
class ReturnFraction(LandingFraction):
    """Return fraction of the first touchdowns: landings that impact again within flight.duration, or are captured where
    the site holds them.

    Bounds are over beds and impact points not in the study, for all possible ends of the landings without an outcome.
    """

    share: Annotated[Estimate, Keyed("share", has_level=True, has_reason=False)] = field(metadata=INLINE)
    """return fraction over the input distributions of the study file: of the landers, where those without an
    outcome get the mean of those that left in flight across the edge of the bed; without landers, of the samples of
    the expansion"""
    emulator: float | None
    """the fraction from the emulator or the expansion, of the samples whose end is known"""
    why: str | None
    """why there is no interval, in a sentence; null where there is one"""

    @classmethod
    def of(cls, found: LandingFraction, emulator: float | None = None) -> "ReturnFraction":
        """The fraction that landings show, beside what an emulator has of it."""
        return cls(**vars(found), emulator=emulator, why=found.share.why_missing)


@dataclass(frozen=True)
class SampleShares(Inlined):
    """Outcomes of the samples, up to the last whose flight was computed, as fractions of all of them. captured,
    left_sideways, time_limit, outside (with an impossible elevation or speed), impact, flying (at the end of
    flight.duration), escaped, partner. returns (impact, plus captured where the site holds the lander) and missing
    (left_sideways, time_limit, outside) are sums of some of these.
    """

    sample_count: int
    """samples up to the last that flew"""
    flight_count: int
    """of those, samples that flew"""
    outcomes: Mapping[str, CountedShare] = field(metadata=INLINE)
    level: float
    """probability that the bounds of this table stand for"""
    why: str | None
    """why the shares have no interval, in a sentence; null where they have one"""
    __repr__ = short_repr


@dataclass(frozen=True)
class RunShares(Inlined):
    """Outcomes of the first touchdowns of the landers, from 64 flights of each. impact, flying (at the end of
    flight.duration), escaped, partner and captured add up to 1. returns: impact, plus captured where the site holds the
    lander. settled and lofted: captured where gravity and rotation hold the lander, or do not. missing: left_sideways,
    time_limit, failed.
    """

    sample_count: int
    """flights of all landings, 64 each, computed or not"""
    flight_count: int
    """of those, flights that were made"""
    level: float
    """probability that the bounds of this table stand for"""
    why: str | None
    """why the shares have no interval, in a sentence; null where they have one"""
    outcomes: Mapping[str, CountedShare] = field(metadata=INLINE)
    __repr__ = short_repr
