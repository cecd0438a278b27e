"""What a study says of the delivery options of its file."""

from dataclasses import dataclass

from lithobrake.results.shares import Estimate, ShareInterval
from lithobrake.study.question_sections import SIDE
from lithobrake.vocabulary.screen import short_repr


@dataclass(frozen=True)
class AimOnGround:
    """A delivery option on one ground: bounds over refits on soil, by the number of landers on hard ground."""

    settled: ShareInterval
    """landers at rest where the ground holds them, after all bounces"""
    missing: float
    """share of the landers with an unknown outcome"""
    distance_p95: Estimate | None
    """95 % of those at rest lie within this distance over the ground [m]; null if none is at rest, and a bound is null
    if there are too few landers for it"""
    time_p95: Estimate | None
    """95 % of those at rest are at rest within this time [s]; null and bounds as for distance_p95"""
    allowed: bool
    """whether the option satisfies the conditions on this ground"""
    share_of_refits: float | None = None
    """fraction of the refits in which this option has most landers at rest, on soil"""


@dataclass(frozen=True)
class AimResult:
    """A delivery option."""

    values: tuple[float, ...]
    """of the names, in the units of the study file"""
    soil: AimOnGround
    hard: AimOnGround | None
    """null with [journey]: landers are followed on the soil alone"""


@dataclass(frozen=True)
class BestAim:
    """The allowed option at which most landers are at rest; null where none is allowed, or no lander is at rest."""

    aim: int
    """its index among the options, from 0"""
    share_of_refits: float | None
    """fraction of the refits in which it is the best, which is not the probability that it is the best; null on hard
    ground"""
    own: ShareInterval | None
    """its fraction of landers at rest without the selection bias, with the error over refits of all options that cannot
    be distinguished from it; null on hard ground, and if refits give none"""
    not_worse: tuple[int, ...] | None
    """indices of the other allowed options that cannot be distinguished from the best at the level, all of them
    together; null in the same cases"""
    next: int | None
    """place of the second best; null in the same cases"""
    difference: Estimate | None
    """its fraction minus that of the second, with bounds over refits; null if there is no second, and in the same
    cases"""


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
    sides: tuple[str, ...] = ()
    """with aim.sides: the sides in words; the values of that name are indices in this list"""
    __repr__ = short_repr

    def value_words(self, name: str, value: float) -> str:
        """A value of a name in words; a side by its name."""
        return self.sides[int(value)].partition(",")[0] if name == SIDE else f"{value:g}"
