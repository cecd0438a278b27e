"""Where journeys of landings end: shares of their ends, and where, when and how the landers rest."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.dispersion import GroundResults


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
    """upper bound likewise"""
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
    """upper bound likewise"""
    why: str | None = None
    """why a bound is missing, in a sentence"""


@dataclass(frozen=True)
class RestQuantiles:
    """A number of the landers at rest."""

    median: RestQuantile
    q95: RestQuantile
    """95th percentile"""


@dataclass(frozen=True)
class RestRegion:
    """The smallest region of the ground (highest density) that holds a share of the landers at rest."""

    share: float
    """that it holds, of 1"""
    area_m2: float
    """its area"""
    largest_extent_m: float
    """largest distance between two of its points"""
    outlines: tuple[tuple[tuple[float, float], ...], ...]
    """latitude and east longitude [deg] along its edges"""


@dataclass(frozen=True)
class JourneyRest:
    """Where, when and how the landers rest that came to rest (journeys.csv)."""

    of: str
    """which journeys it describes, in words"""
    time_s: RestQuantiles
    """time from the first touchdown to rest [s]"""
    contacts: RestQuantiles
    """contacts with the ground"""
    distance_m: RestQuantiles
    """way over the ground from the aim point [m]"""
    regions: tuple[RestRegion, ...]
    """regions that hold 50 and 95 %; empty where why_no_regions says why"""
    faces: Mapping[str, EndShare]
    """by the side of the lander that is down, by its own axes; empty for a ball"""
    tilt_deg: RestQuantiles | None
    """angle between that side's axis and the plumb line [deg]; null for a ball"""
    why_no_regions: str | None = None
    """why there are no regions, in a sentence"""

    @property
    def grounds(self) -> dict[str, GroundResults]:
        """No samples of the emulator were followed, on any ground."""
        return {}
