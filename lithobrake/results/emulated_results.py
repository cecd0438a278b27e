"""How journeys by the emulator of a study's touchdowns end, beside its journeys of landings."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.journey_results import EndShare
from lithobrake.vocabulary.screen import short_repr


@dataclass(frozen=True)
class ControlVariate:
    """What the emulator's prediction of each journey does to the share at rest."""

    is_used: bool
    """whether the shares of the ends have it taken off: only where that narrows the interval of those at rest"""
    half_width: float
    """half width of the interval of the share at rest without it"""
    half_width_with: float
    """the same with it"""


@dataclass(frozen=True)
class EmulatedJourneys:
    """Landers that the emulator of all touchdowns took from touchdown to touchdown (emulated.csv)."""

    why: str | None
    """why the touchdowns have no emulator, in a sentence; null where they have one"""
    count: int
    """landers"""
    landings: int
    """simulated landings where the emulator had no answer"""
    most_landings: int
    """the most that would have been made"""
    unknown: float
    """share of the landers whose end is unknown: no answer, and no landing left to be made"""
    ends: Mapping[str, EndShare]
    """how the others ended, as results.ends; bounds over refits to beds drawn with replacement, wider by the unknown"""
    agrees: bool | None
    """whether the shares of all ends differ from those of the journeys by no more than their intervals together; null
    without intervals"""
    control: ControlVariate | None
    """null where the emulator predicts nothing of the ends"""
    statement: str
    """whether the two agree, in a sentence; empty where no landers were followed"""
    __repr__ = short_repr
