"""What a study says of its limit states and delivery options, and of its difference to another study."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

from lithobrake.study.design_sections import SIDE
from lithobrake.vocabulary.estimate import INLINE, Estimate, Inlined, Keyed, Number, Share
from lithobrake.vocabulary.landing_fraction import LandingFraction
from lithobrake.vocabulary.plain_text import short_repr

Probability = Annotated[Estimate, Keyed("probability", has_level=True, has_reason=False)]


@dataclass(frozen=True)
class LimitStateInput(Inlined):
    """An input among the runs that meet a limit state; bounds of the distance are from resampled beds."""

    distance: Annotated[Estimate, Keyed("distance", has_reason=False)] = field(metadata=INLINE)
    """largest difference between the distribution function of the input among the runs that meet it and its input
    distribution"""
    luck: float
    """distance that, without any effect, any of the inputs exceeds in one of ten studies"""
    median: float
    """of the input among the runs that meet it, in its unit"""
    median_of_all: float
    """of its input distribution"""
    found: bool
    """whether the input is significant: the distance exceeds luck, or that of an input that goes together with it"""


@dataclass(frozen=True)
class LimitStateResult(Inlined):
    """A limit state of the study file (docs/reliability.md)."""

    condition: str
    """as in the study file"""
    probability: Probability = field(metadata=INLINE)
    """share of the landings that meet it, over the input distributions of the study file"""
    source: str
    """runs, or emulator if the probability is too close to 0 or 1 for the runs"""
    runs: LandingFraction
    """estimate from the runs, whichever source is used"""
    emulator: Share | None
    """estimate from the emulator; null if there is none"""
    tail_limit: float
    """upper limit of the probability of an event that occurred in none of these runs"""
    why: str | None
    """why there is no interval, in a sentence; null where there is one"""
    failing_runs: float
    """runs that meet it; a run whose flights meet it in part counts with that fraction"""
    inputs: Mapping[str, LimitStateInput]
    """by input; empty if no run meets it, or if there is only one bed"""
    statement: str
    """the result in a sentence"""
    of_journey: bool = False
    """whether it is of the whole journey of a lander, and not of its first touchdown; then `landings` above are
    journeys"""
    agrees: bool | None = None
    """of a journey: whether landings and emulator agree within their joint intervals; null without both, and where
    landings are followed for some touchdowns only (journey.touchdowns)"""
    radius_m: float | None = None
    """distance from the aim point within which a lander at rest meets it [m]; null for another condition"""
    if_aimed: Share | None = None
    """with such a distance: the probability if all places of rest moved by the mean miss (results.rest.miss), so that
    their mean were the aim point; with ground.unknown = "everywhere" or "both" its bounds hold that of one ground; null
    where this mean cannot be distinguished from the aim point"""
    over_grounds: Share | None = None
    """of a journey, with ground.unknown = "everywhere" or "both": the probability over all grounds, with bounds that
    hold that of one ground; null without"""
    grounds: Mapping[str, Share] = field(default_factory=dict)
    """of a journey, with ground.unknown = "everywhere": the probability on each kind of ground; empty without"""
    __repr__ = short_repr


@dataclass(frozen=True)
class RareLimitState(Inlined):
    """A rare limit state, by subset simulation with landings of its own (rare_*.json, docs/reliability.md)."""

    condition: str
    """as in the study file"""
    probability: Probability = field(metadata=INLINE)
    """of a landing that meets it; 0 where it was not reached"""
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


@dataclass(frozen=True)
class AimOnGround:
    """A delivery option on one ground: bounds over refits on soil, by the number of landers on hard ground."""

    settled: Share
    """share of the landers of known end at rest where the ground holds them, null where none is known; bounds hold
    whatever becomes of the others"""
    missing: float
    """share of the landers with an unknown outcome"""
    distance_p95: Number | None
    """95 % of those at rest lie within this distance over the ground [m]; null if none is at rest, and a bound is null
    if there are too few landers for it"""
    time_p95: Number | None
    """95 % of those at rest are at rest within this time [s]; null and bounds as for distance_p95"""
    allowed: bool
    """whether the option satisfies the conditions on this ground"""
    share_of_refits: float | None = None
    """fraction of the refits in which this option is the best allowed one, on soil"""
    limit_states: Mapping[str, Share] = field(default_factory=dict)
    """share of the landers of known end that meet each limit state of journeys, null where none is known; bounds hold
    whatever becomes of the others"""


@dataclass(frozen=True)
class AimResult:
    """A delivery option."""

    values: tuple[float, ...]
    """of the names, in the units of the study file"""
    soil: AimOnGround
    hard: AimOnGround | None
    """null with hard_ground.count = 0: landers are followed on the soil alone"""


@dataclass(frozen=True)
class BestAim:
    """The allowed option at which most landers are at rest, or meet the limit state aim.best; null where none is
    allowed, or no lander does."""

    aim: int
    """its index among the options, from 0"""
    share_of_refits: float | None
    """fraction of the refits in which it is the best, which is not the probability that it is the best; null on hard
    ground"""
    own: Share | None
    """its fraction of landers at rest, or that meet aim.best, without the selection bias, with the error over refits of
    all options that cannot be distinguished from it; null on hard ground, and if refits give none"""
    not_worse: tuple[int, ...] | None
    """indices of the other allowed options that cannot be distinguished from the best at the level, all of them
    together, whatever becomes of landers with an unknown outcome; null in the same cases"""
    next: int | None
    """place of the second best; null in the same cases"""
    difference: Number | None
    """its fraction minus that of the second, with bounds over refits that hold whatever becomes of landers with an
    unknown outcome; null if there is no second, and in the same cases"""


@dataclass(frozen=True)
class AimResults:
    """The delivery options of the study file (docs/aiming.md); the last name varies fastest."""

    names: tuple[str, ...]
    """keys of the options, dotted, in the order of aims.values"""
    units: tuple[str, ...]
    """of the names"""
    within: tuple[str, ...]
    """conditions that the best option must satisfy"""
    lander_count: int
    """landers at each option"""
    refit_count: int
    """refits of the emulator to resampled beds, which all options share"""
    level: float
    """probability that the bounds of this table stand for"""
    why: str | None
    """why there is no interval on soil, in a sentence; null if there is one"""
    aims: tuple[AimResult, ...]
    best_on_soil: BestAim | None
    best_on_hard: BestAim | None
    statement: str
    """the best option and its uncertainty, in sentences"""
    best: str | None = None
    """limit state that most landers meet at the best option; null: at which most are at rest"""
    sides: tuple[str, ...] = ()
    """with aim.sides: the sides in words; the values of that name are indices in this list"""
    __repr__ = short_repr

    def value_words(self, name: str, value: float) -> str:
        """A value of a name in words; a side by its name."""
        return self.sides[int(value)].partition(",")[0] if name == SIDE else f"{value:g}"


@dataclass(frozen=True)
class ComparedAnswer:
    """An answer of both studies, and the second less the first."""

    words: str
    """what it is"""
    unit: str
    """of all its numbers; empty for a fraction of 1 and for a count"""
    is_fraction: bool
    """whether it is a fraction of all landers"""
    first: Number
    """of the first study, from the pairs alone"""
    second: Number
    """of the second study, likewise"""
    difference: Number
    """second less first; null where one of them is; with is_ratio second over first less 1, without a unit"""
    pairs: int
    """pairs of which both runs have an answer"""
    missing: tuple[float, float]
    """share of the runs of each study of which it is not known what became of them: all bounds hold whatever did"""
    correlation: float | None
    """of the two runs of a pair; null where an answer does not vary"""
    landings_saved: float | None
    """how many times the landings an unpaired comparison takes for an interval as narrow; null without an interval"""
    is_ratio: bool = False
    """whether it is the typical ratio of pairs that have both, of which first and second are the geometric means"""


@dataclass(frozen=True)
class StudyComparison:
    """Two studies on the same beds, places, attitudes and headings, paired by number."""

    names: tuple[str, str]
    """folders of the first and the second study, as they were given"""
    titles: tuple[str, str]
    """their titles"""
    of: str
    """which pairs it describes, in words"""
    level: float
    """probability that each interval stands for"""
    settings: Mapping[str, tuple[str, str]]
    """keys of the study files, by their dotted names, that differ: first, second"""
    answers: Mapping[str, ComparedAnswer]
    note: str | None
    """what makes the pairs less alike than they could be, in a sentence; null where nothing does"""
    why: str | None
    """why there are no intervals, in a sentence; null where there are"""
    __repr__ = short_repr
