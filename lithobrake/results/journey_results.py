"""Where journeys of landings end: shares of their ends, and where, when and how the landers rest."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.dispersion import GroundResults, LandingEllipses
from lithobrake.results.regions import RestRegion
from lithobrake.vocabulary.screen import short_repr


@dataclass(frozen=True)
class EndShare:
    """Journeys that ended in one way."""

    count: int
    """of the journeys"""
    share: float
    """of 1; the shares of all ends add up to 1"""
    lower: float | None
    """lower bound, over beds and impact points not in the study; null where there is none"""
    upper: float | None
    """upper bound"""
    why: str | None = None
    """why there is no interval, in a sentence"""


@dataclass(frozen=True)
class RestQuantile:
    """A quantile over the landers at rest."""

    value: float | None
    """in the unit of its quantity; null where no lander rests"""
    lower: float | None
    """lower bound of its 90 % interval, over beds not in the study; null where there is none"""
    upper: float | None
    """upper bound"""
    why: str | None = None
    """why a bound is missing, in a sentence"""


@dataclass(frozen=True)
class RestQuantiles:
    """A number of the landers at rest."""

    median: RestQuantile
    q95: RestQuantile
    """95th percentile"""


@dataclass(frozen=True)
class DeliveryResults:
    """Place and state of the first impacts (touchdowns.csv): the delivery, before any effect of the ground."""

    count: int
    """landers that touch down"""
    of: int
    """journeys"""
    speed: tuple[float, float, float]
    """speed of the first impact relative to the ground: quantiles of 5, 50 and 95 % over the landers [m/s]"""
    incidence_deg: tuple[float, float, float]
    """the same of the angle of that velocity from the inward normal [deg]"""
    descent_s: tuple[float, float, float] | None
    """the same of the time from the state to the first impact [s]; null where landers are not flown to the ground"""
    ellipse: LandingEllipses | None
    """ellipses that hold half and 95 % of the first impacts; null for few, or for places all around the body"""
    regions: tuple[RestRegion, ...]
    """smallest regions (highest density) that hold 50 and 95 % of them; empty where why_no_regions says why"""
    why_no_regions: str | None = None
    """why there are no regions, in a sentence"""
    __repr__ = short_repr


@dataclass(frozen=True)
class JourneyRest:
    """Places, times and attitudes of the landers at rest (journeys.csv)."""

    of: str
    """which journeys it describes, in words"""
    time_s: RestQuantiles
    """time from the first touchdown to rest [s]"""
    contacts: RestQuantiles
    """contacts with the ground"""
    distance_m: RestQuantiles
    """distance over the ground from the aim point [m]"""
    regions: tuple[RestRegion, ...]
    """regions that hold 50 and 95 %; empty where why_no_regions says why"""
    faces: Mapping[str, EndShare]
    """by the side of the lander that is down, by its own axes; empty for a sphere"""
    tilt_deg: RestQuantiles | None
    """angle between that side's axis and the plumb line [deg]; null for a sphere"""
    why_no_regions: str | None = None
    """why there are no regions, in a sentence"""
    __repr__ = short_repr

    @property
    def grounds(self) -> dict[str, GroundResults]:
        """No samples of the emulator were followed, on any ground."""
        return {}
