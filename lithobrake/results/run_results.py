"""What the runs of a study say of themselves: outcomes, outputs, and parts of the variance."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.shares import Estimate
from lithobrake.vocabulary.percentages import part
from lithobrake.vocabulary.screen import short_repr


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
