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
    """95 % of those at rest lie within this distance over the ground [m]; null where none is at rest, a bound where so
    few landers do not show it"""
    time_p95: Estimate | None
    """95 % of those at rest are so within this time [s]; null likewise"""
    allowed: bool
    """whether the option keeps the limits on this ground"""
    share_of_refits: float | None = None
    """share of the refits in which most landers are at rest here, on soil"""


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
    """its place among the aims, from 0"""
    share_of_refits: float | None
    """share of the refits in which it is the best, no probability that it is; null on hard ground"""
    own: ShareInterval | None
    """its share of landers at rest less what its selection among the options adds, with the error that all options
    which cannot be distinguished from it have over refits; null on hard ground, and where refits give none"""
    not_worse: tuple[int, ...] | None
    """places of the other allowed options that cannot be distinguished from the best at the level, all of them
    together; null likewise"""
    next: int | None
    """place of the second best; null likewise"""
    difference: Estimate | None
    """its share less that of the second, with bounds over refits; null where there is no second, and likewise"""


@dataclass(frozen=True)
class AimResults:
    """The delivery options of the study file (docs/aiming.md), the last name running fastest."""

    names: tuple[str, ...]
    """what is chosen, by dotted key, in the order of aims.values"""
    units: tuple[str, ...]
    """of the names"""
    within: tuple[str, ...]
    """limits that the best option keeps"""
    lander_count: int
    """landers at each option"""
    refit_count: int
    """fits of the emulator to beds drawn with replacement that they share in"""
    level: float
    """probability that the bounds of this table stand for"""
    why: str | None
    """why the soil gives no interval, in a sentence; null where it gives one"""
    aims: tuple[AimResult, ...]
    best_on_soil: BestAim | None
    best_on_hard: BestAim | None
    statement: str
    """the best option and how sure it is, in sentences"""
    sides: tuple[str, ...] = ()
    """with aim.sides: the sides to choose from in words, of which the values of that name are places"""
    __repr__ = short_repr

    def value_words(self, name: str, value: float) -> str:
        """A value of a name in words; a side by its name."""
        return self.sides[int(value)].partition(",")[0] if name == SIDE else f"{value:g}"
