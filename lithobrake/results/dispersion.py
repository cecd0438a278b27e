"""Where the landers end: flights, ellipses, journeys until they rest, and regions that hold shares of them."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lithobrake.results.run_results import CountedShare, SampleShares
from lithobrake.vocabulary.estimate import INLINE, Inlined
from lithobrake.vocabulary.plain_text import short_repr


@dataclass(frozen=True)
class RestRegion:
    """The smallest region of the ground (highest density) that contains a fraction of the landers: at rest, or at an
    impact."""

    share: float
    """that it holds, of 1"""
    area_m2: float
    """its area"""
    largest_extent_m: float
    """largest distance between two of its points"""
    outlines: tuple[tuple[tuple[float, float], ...], ...]
    """latitude and east longitude [deg] along its edges, all closed; one that crosses the date line goes on from 180 at
    -180; they keep within a tenth of the bandwidth of the density of the edges that area and extents are of"""
    island_extents_m: tuple[float, ...] = ()
    """largest distance between two points of each of its separate parts, the one of the largest area first"""
    __repr__ = short_repr


@dataclass(frozen=True)
class ImpactNumber(Inlined):
    """A number of the flights that end on the body: of the landers, or of samples."""

    quantiles: Mapping[str, float] = field(metadata=INLINE)
    """by level, as "quantile_0.5" """
    intervals: Mapping[str, tuple[float, float] | None] | None = None
    """of landers: lower and upper bound (90 %) of each quantile over beds not in the study; null where there is
    none"""
    of: str | None = None
    """of landers: which landings it describes, in words"""


@dataclass(frozen=True)
class ImpactNumbers:
    """The flights that end on the body; without keys where none does."""

    time_s: ImpactNumber | None = None
    """time of flight [s]"""
    impact_speed: ImpactNumber | None = None
    """speed of the impact against the ground [m/s]"""
    impact_incidence_deg: ImpactNumber | None = None
    """angle of that velocity from the inward normal [deg]"""

    @property
    def known(self) -> dict[str, ImpactNumber]:
        """The numbers that there are, by their keys."""
        return {key: one for key, one in vars(self).items() if one is not None}


@dataclass(frozen=True)
class GravityTableError:
    """Errors of the table of gravity, divided by the mean gravity on the surface."""

    median: float
    """median over points"""
    p95: float
    """the same, 95th percentile"""
    largest: float
    """the same, largest"""
    point_count: int
    """number of points checked"""


@dataclass(frozen=True)
class FlightChecks:
    """How exact all flights are (flights.json)."""

    gravity: str
    """table or exact"""
    gravity_table_error: GravityTableError | None
    """null where the gravity is exact"""
    jacobi_flight_count: int
    """flights whose Jacobi constant was checked, without the partner"""
    jacobi_drift_median_m2_s2: float | None
    """median of its drift [m2/s2]; null without flights"""
    jacobi_drift_largest_m2_s2: float | None
    """the same, largest"""


@dataclass(frozen=True)
class FlightResults(Inlined):
    """The flights that end on the body, of the landers or of samples, and how exact all flights are."""

    impacts: ImpactNumbers = field(default=ImpactNumbers(), metadata=INLINE)
    checks: FlightChecks | None = field(default=None, metadata=INLINE)
    __repr__ = short_repr


@dataclass(frozen=True)
class EllipseShare:
    """An ellipse about the middle."""

    share: float
    """of the places inside"""
    semi_axes_deg: tuple[float, float]
    """longer and shorter half axis, as angles from the centre of the body"""
    semi_axes_m: tuple[float, float]
    """the same angles times the radius at the middle"""


@dataclass(frozen=True)
class LandingEllipses:
    """Ellipses that hold the places of the impacts, or of the landers at rest; null where there are too few."""

    latitude_deg: float
    """of the middle"""
    longitude_deg: float
    """of the middle"""
    heading_deg: float
    """of the longer axis, from north toward east"""
    shares: tuple[EllipseShare, ...]


@dataclass(frozen=True)
class WithoutScatter:
    """The samples of the expansion alone, without the scatter from run to run."""

    shares: SampleShares
    flights: ImpactNumbers
    ellipses: LandingEllipses | None


@dataclass(frozen=True, kw_only=True)
class FollowedLanders:
    """Ends of landers that were followed on other ground than that of the study (docs/flights.md). Quantiles are of the
    landers at rest, and empty if there are none.
    """

    count: int
    """landers followed"""
    ends: Mapping[str, CountedShare]
    """by end, as in results.ends"""
    unknown: float
    """fraction of the landers with unknown outcome"""
    slid: CountedShare
    """landers that slid along the ground, whatever their end"""
    time_s: Mapping[str, float]
    """time until rest [s], by level, as "quantile_0.5" """
    distance_m: Mapping[str, float]
    """distance from the aim point [m], by level"""
    path_length: Mapping[str, float]
    """sum of the straight lines between impacts [m], by level"""
    touchdowns: Mapping[str, float]
    """impacts, by level"""
    slid_length: Mapping[str, float]
    """distance along the ground, in contact with it [m], by level"""
    slid_time_s: Mapping[str, float]
    """duration of the sliding [s], part of time_s, by level"""
    ellipses: LandingEllipses | None
    regions: tuple[RestRegion, ...]
    """smallest regions that hold 50 and 95 % of the landers at rest; empty for fewer than five, or on one line"""
    of: str
    """which trajectories the table describes and what they depend on, in words"""
    level: float | None
    """probability that the bounds of the shares stand for; null where they have none"""
    why: str | None
    """why the shares have no interval, in a sentence; null where they have one"""
    __repr__ = short_repr
