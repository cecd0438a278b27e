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
    """of these, runs that ended so; empty where every run has an outcome"""


@dataclass(frozen=True)
class SideRuns:
    """What auxiliary runs show (design.side_runs)."""

    soil_pairs: int
    """runs that were repeated on a second soil"""
    twins: int
    """runs that were repeated with an impact point a little beside"""
    twin_shift: float
    """how far beside [m]"""
    soil_total_effect: Mapping[str, VariancePart]
    """by output: share of its variance that goes with the soil, interactions with bed, impact point and attitude
    included"""
    chaos_deviation: Mapping[str, Estimate]
    """by output: standard deviation that chaos alone gives, in the output's unit"""


@dataclass(frozen=True)
class RunResults:
    """The runs of a drawn study, without auxiliary ones."""

    count: int
    """runs"""
    beds: int
    """beds that they came down on"""
    outcomes: Mapping[str, int]
    """runs that ended so; failed: runs without an outcome"""
    missing: MissingLandings
    warning: str | None
    """where more than 2 % of the runs have no outcome: how many, why, what they leave undescribed, and how to avoid it,
    in a sentence; else null"""
    over_rim: int
    """of those that left: runs that crossed the edge of the bed in flight, touching nothing and going up"""
    farther_than_period: int | None
    """runs in which the lander travelled farther in contact than the bed's period, over ground that it may have
    disturbed; null where beds have walls"""
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
    """An output that has neither beginning nor end, as azimuth_out, over the runs that have it."""

    mean_direction: Estimate
    """direction of the mean of the unit vectors [rad]; its bounds may lie beyond pi"""
    resultant_length: Estimate
    """length of that mean: 0 where directions cancel, 1 where all are alike"""
    of: str
    """which landings it describes, in words"""


@dataclass(frozen=True)
class OutputRange:
    """What else the touchdowns gave, over distinct runs that have it."""

    median: float
    """in the unit beside it"""
    smallest: float
    """likewise"""
    largest: float
    """likewise"""
    unit: str
    """of the three numbers"""
    of: str
    """which landings have it, in words"""


@dataclass(frozen=True)
class VarianceParts:
    """Where the scatter of an output of a drawn study comes from (docs/estimates.md).

    null where the runs cannot tell, and in a paper study. returns: of the share of its flights for which a run returns.
    """

    soil: VariancePart
    """inputs of grains and surface, and of the lander's contacts: at least so much, by its terms"""
    soil_doubled: VariancePart
    """at least so much with input distributions of the soil twice as wide, each on its own scale"""
    terms: str
    """of which degree the terms of inputs are, in words"""
    soil_by_input: Mapping[str, VariancePart]
    """one of them alone"""
    arrival: VariancePart | None
    """all other inputs, as speed, incidence and mass; null where none is uncertain"""
    attitude: VariancePart | None
    """terms of second degree of the surface normal and the direction of travel, seen from the lander; null for a ball,
    for one attitude alone, and where the runs are too few"""
    bed: VariancePart
    """what landings on one bed have in common"""
    place: VariancePart
    """everything else: impact point, lack of fit and interactions; of a journey all that its later touchdowns draw"""
    chaos: VariancePart | None
    """what twins differ in; null without auxiliary runs"""
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
