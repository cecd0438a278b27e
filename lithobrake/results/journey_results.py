"""Where journeys of landings end: by side, soil, sky and emulator."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.dispersion import LandingEllipses, RestRegion
from lithobrake.results.run_results import CountedShare
from lithobrake.vocabulary.estimate import Number, Share
from lithobrake.vocabulary.plain_text import short_repr


@dataclass(frozen=True)
class RestQuantiles:
    """A number of the landers at rest; bounds over beds not in the study."""

    median: Number
    q95: Number
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
class MeanMiss:
    """How far the landers at rest lie from the aim point in the mean, over the ground of a ball of the radius there.

    Bounds are over beds not in the study; those on one ground, with ground.unknown = "everywhere" or "both", hold the
    mean on one ground of those that the study allows."""

    east_m: Number
    """east of the aim point [m]"""
    north_m: Number
    """north of the aim point [m]"""
    east_on_one_ground_m: Number | None
    """the same on one ground; null where there is no such ground"""
    north_on_one_ground_m: Number | None
    """the same"""
    aim_latitude_deg: float
    """latitude of the corrected aim point, shifted by the mean in the opposite direction"""
    aim_longitude_deg: float
    """longitude of it"""
    latitude_deg: float
    """latitude of the mean"""
    longitude_deg: float
    """longitude of the mean"""
    is_distinct: bool
    """whether the mean differs significantly from the aim point: the 95 % interval of one of the two numbers (on one
    ground, where there is one) excludes 0; joint level 90 % (Bonferroni)"""
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
    faces: Mapping[str, CountedShare]
    """by the side of the lander that is down, by its own axes; empty for a sphere"""
    tilt_deg: RestQuantiles | None
    """angle between that side's axis and the plumb line [deg]; null for a sphere"""
    why_no_regions: str | None = None
    """why there are no regions, in a sentence"""
    miss: MeanMiss | None = None
    """the mean of where they lie relative to the aim point; null if none rests, or they lie all around the body"""
    __repr__ = short_repr


@dataclass(frozen=True)
class SideResults:
    """Landers whose first touchdown has this side toward the ground, and all touchdowns with it."""

    words: str
    """the side in words, of a box with the lengths of its face"""
    landings: int
    """first touchdowns in which this side faces the ground: its axis is the nearest to the normal"""
    speed_ratio: Number
    """median of rebound speed / impact speed of these landings"""
    returns: CountedShare
    """return fraction of these landings; count: landings of which all flights return"""
    at_rest: CountedShare | None = None
    """fraction of these landers that comes to rest"""
    time_s: Number | None = None
    """median time to rest of these landers [s]"""
    touchdowns: int | None = None
    """all touchdowns in which this side faces the ground"""
    rests: CountedShare | None = None
    """fraction of these touchdowns in which the lander comes to rest"""


@dataclass(frozen=True)
class SoilResults:
    """The touchdowns in a region of the body with a soil of its own, or elsewhere, on [grain]."""

    area_share: float
    """fraction of the surface of the body"""
    touchdowns: int
    """touchdowns in it"""
    rests: CountedShare | None
    """fraction of these touchdowns in which the lander comes to rest; null if there are none"""
    at_rest: CountedShare
    """fraction of all journeys that end at rest there"""
    outlines: tuple[tuple[tuple[float, float], ...], ...]
    """latitude and east longitude [deg] along its edges; none for the ground elsewhere"""
    __repr__ = short_repr


@dataclass(frozen=True)
class SkyResults:
    """Visibility of the Sun, Earth or the orbiter for the landers at rest (sky.csv). Fractions are of a day of the
    small body, of a span of dates, or of the times of the orbiter's states."""

    day_fraction: Number
    """median over the landers at rest of the fraction of the time in which they see it, of 1"""
    day_fraction_q05: Number
    """5th percentile of it"""
    least_day_fraction: Number
    """median over the landers at rest of that of their worst day in a span of dates"""
    probability: Share
    """probability that a lander at rest sees it at a random time: mean of the fraction of the time"""
    never: CountedShare
    """landers at rest that never see it"""
    sides: Mapping[str, Number]
    """by the side of the lander, by its own axes: median fraction of the time in which it is seen and that side faces
    it; empty for a sphere"""
    side_probabilities: Mapping[str, Share]
    """by side: probability that at a random time it is seen and the side faces it, so that a panel is lit or an antenna
    sees the orbiter; empty for a sphere"""
    dark_sides: Mapping[str, CountedShare]
    """by the side: landers at rest on which it never faces the body while that is seen; empty for a sphere"""


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
    ends: Mapping[str, CountedShare]
    """ends of the others, as in results.ends; bounds over refits to resampled beds, widened by the unknown fraction"""
    agrees: bool | None
    """whether the fractions of all ends agree with those of the journeys within their joint intervals; null without
    intervals"""
    control: ControlVariate | None
    """null where the emulator predicts nothing of the ends"""
    statement: str
    """whether the two agree, in a sentence; empty where no landers were followed"""
    __repr__ = short_repr
