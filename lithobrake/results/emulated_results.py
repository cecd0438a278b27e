"""How journeys by the emulator of a study's touchdowns end, beside its journeys of landings."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.journey_results import EndShare
from lithobrake.vocabulary.screen import short_repr


@dataclass(frozen=True)
class ControlVariate:
    """Effect of the emulator's predictions, as a control variate, on the fraction at rest."""

    is_used: bool
    """whether the fractions of the ends use this control variate: only if it narrows the interval of the fraction at
    rest"""
    half_width: float
    """half-width of the interval of the fraction at rest without it"""
    half_width_with: float
    """the same with it"""


@dataclass(frozen=True)
class EmulatedJourneys:
    """Landers that the emulator of all touchdowns followed from touchdown to touchdown (emulated.csv)."""

    why: str | None
    """why the touchdowns have no emulator, in a sentence; null where they have one"""
    count: int
    """landers"""
    landings: int
    """landings simulated outside the training range of the emulator"""
    most_landings: int
    """largest number of such landings"""
    unknown: float
    """fraction of the landers with unknown end: outside the training range when the largest number of landings was
    reached"""
    ends: Mapping[str, EndShare]
    """ends of the others, as in results.ends; bounds over refits to resampled beds, widened by the unknown fraction"""
    agrees: bool | None
    """whether the fractions of all ends agree with those of the journeys within their joint intervals; null without
    intervals"""
    control: ControlVariate | None
    """null where the emulator predicts nothing of the ends"""
    statement: str
    """whether the two agree, in a sentence; empty where no landers were followed"""
    __repr__ = short_repr
