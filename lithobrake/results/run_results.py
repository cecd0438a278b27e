"""Shares and other numbers of the runs of a study with their intervals, and parts of the variance."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lithobrake.results.json_values import INLINE
from lithobrake.vocabulary.percentages import part
from lithobrake.vocabulary.plain_text import short_repr


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


@dataclass(frozen=True)
class VariancePart:
    """A part of the variance of an output."""

    share: float
    """of the variance, within [0, 1]"""
    lower: float
    """lower bound"""
    upper: float
    """upper bound"""

    def words(self, more: str = "") -> str:
        """The part with its interval in per cent; more: words behind that."""
        return part(self.share, self.lower, self.upper, more)


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
    soil_total_effect: Mapping[str, VariancePart]
    """by output: share of its variance that the soil explains, including interactions with bed, impact point and
    attitude"""
    chaos_deviation: Mapping[str, Estimate]
    """by output: standard deviation due to chaos alone, in the output's unit"""


@dataclass(frozen=True)
class RunResults:
    """The runs of a drawn study, without auxiliary ones."""

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
    """An output over the runs of a drawn study that have it, in its unit."""

    mean: Estimate
    """mean"""
    quantiles: Mapping[str, Estimate]
    """by level, as "0.5" """
    standard_deviation: float
    """of the runs"""
    of: str
    """which landings it describes, in words"""


@dataclass(frozen=True)
class OutputDirection:
    """An output that is an angle around the circle, such as azimuth_out, over the runs that have it."""

    mean_direction: Estimate
    """direction of the mean of the unit vectors [rad]; its bounds may lie beyond pi"""
    resultant_length: Estimate
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
    """Parts of the variance of an output of a drawn study (docs/estimates.md).

    null where the runs cannot show it, and in a paper study. returns: the return fraction of each run over its flights.
    """

    soil: VariancePart
    """part that inputs of grains, surface and the lander's contacts explain at least, by their terms"""
    soil_doubled: VariancePart
    """the same with input distributions of the soil twice as wide, each on its own scale"""
    terms: str
    """degree of the terms of the inputs, in words"""
    soil_by_input: Mapping[str, VariancePart]
    """part of one of these inputs alone"""
    arrival: VariancePart | None
    """all other inputs, as speed, incidence and mass; null where none is uncertain"""
    attitude: VariancePart | None
    """terms of second degree of the surface normal and the direction of travel, seen from the lander; null for a ball,
    for one attitude alone, and where the runs are too few"""
    bed: VariancePart
    """part that landings on one bed have in common"""
    place: VariancePart
    """everything else: impact point, lack of fit and interactions; for a journey also everything that is random in
    later touchdowns"""
    chaos: VariancePart | None
    """part due to chaos, from perturbed runs; null without auxiliary runs"""
    of: str
    """which landings it describes, in words"""
    __repr__ = short_repr

    @property
    def parts(self) -> dict[str, VariancePart]:
        """The parts that are known, by their keys; together they are the whole."""
        found = {
            "soil": self.soil, "arrival": self.arrival, "attitude": self.attitude, "bed": self.bed,
            "place": self.place, "chaos": self.chaos,
        }  # fmt: skip
        return {name: one for name, one in found.items() if one is not None}
