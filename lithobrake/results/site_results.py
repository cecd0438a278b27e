"""The body and the site that a study lands on, its beds, and what a map of sites holds."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lithobrake.vocabulary.estimate import Number, Share
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.plain_text import short_repr

# Names of SiteEnds.
SHARES = tuple(end.value for end in (JourneyEnd.AT_REST, JourneyEnd.PARTNER, JourneyEnd.ESCAPED, JourneyEnd.UNDER_WAY))
MEDIANS = ("time_s", "distance_m")
# A site has no result where more of its landers have an impact that the emulator does not know.
MOST_UNKNOWN = 0.1


@dataclass(frozen=True)
class BedNumbers:
    """A bed, in the order of the files; none where a program or function of the user's own makes the touchdowns."""

    solid_fraction: float
    """fraction of the volume that grains fill"""
    coordination_number: float
    """mean number of contacts of a grain"""
    surface_height_m: float
    """mean height of the surface above the floor [m]"""
    mean_diameter_m: float
    """mean diameter of the grains, as spheres of equal volume [m]"""
    smallest_width_m: float
    """smallest width without boundary reflections during the first impact [m]"""
    smallest_depth_m: float
    """smallest depth without boundary reflections during the first impact [m]"""
    large_enough: bool
    """whether the bed has that width and depth"""
    ground: str | None = None
    """kind of ground; null without [ground]"""


@dataclass(frozen=True)
class KernelNumbers:
    """What was read from kernels of SPICE; null without any."""

    spin_period_s: float
    """time of a turn [s], from the constants (PCK), as are the next three"""
    pole_right_ascension_deg: float
    """right ascension of the axis about which it turns counter-clockwise (J2000)"""
    pole_declination_deg: float
    """declination of that axis (J2000)"""
    prime_meridian_deg: float
    """where longitude 0 is at the epoch J2000, as the constants count it"""
    partner_longitude_deg: float | None = None
    """east longitude over which the partner is at site.epoch, from the ephemeris (SPK), as are the next three; none
    without site.epoch"""
    partner_latitude_deg: float | None = None
    """latitude over which it is; in the flights it is in the plane of the equator"""
    partner_distance_m: float | None = None
    """between the centres [m]; flights have partner_distance_m of results.site"""
    partner_period_s: float | None = None
    """period of a circle at its angular speed at that time [s]"""


@dataclass(frozen=True)
class SiteResults:
    """The body, and a point at rest on the ground of the site; what is uncertain at its median."""

    body: str
    """name of the built-in body, or mesh"""
    product_id: str | None
    """product of an archive that the mesh is, and its version, by its label; null without one"""
    mass_kg: float
    """mass of the body [kg]"""
    bulk_density_kg_m3: float
    """mass divided by the volume of the shape [kg/m3]"""
    spin_period_s: float
    """time of a turn [s]"""
    kernels: KernelNumbers | None
    """what was read from kernels of SPICE; null without any"""
    extents_m: tuple[float, float, float]
    """along x, y and z [m]"""
    facet_count: int
    """facets of the shape"""
    centroid_m: tuple[float, float, float]
    """of the shape, from the origin of its file [m]"""
    partner: str | None
    """name of the other body of a binary, or null"""
    partner_distance_m: float | None
    """between the two centres [m], or null"""
    latitude_deg: float
    """planetocentric latitude of the aim point"""
    longitude_deg: float
    """east longitude of the aim point"""
    heading_deg: float | None
    """of the incoming horizontal velocity, from north toward east; null where it has no median"""
    place_m: tuple[float, float, float]
    """of the aim on the shape, body-fixed [m]"""
    effective_acceleration_outward: float
    """gravity and rotation along the outward normal [m/s2]; above 0: lifts"""
    effective_acceleration_along_heading: float | None
    """the same along the heading [m/s2]; null without heading"""
    escape_speed_m_s: float
    """from the site, in axes that do not turn, from this body alone [m/s]"""
    warning: str | None
    """why the site does not hold landers at rest, in a sentence; null where it holds them"""
    rotation: str | None
    """how far the body turns away from uniform rotation, in a sentence; null where it turns uniformly"""
    gravity_warning: str | None
    """how touchdowns and site differ in acceleration, in a sentence; null if they agree"""
    cautions: tuple[str, ...] = ()
    """what the study leaves out, or takes for many where it is one, in sentences"""
    __repr__ = short_repr

    @property
    def sentences(self) -> list[str]:
        """How the body rotates, and why the site does not hold landers at rest; empty where there is neither."""
        return [said for said in (self.rotation, self.warning) if said]

    @property
    def holds(self) -> bool:
        """Whether the ground holds what lies there."""
        return self.effective_acceleration_outward < 0.0


@dataclass(frozen=True)
class SiteSpread:
    """A number that differs over a site: its mean, and the ends between which it is on 90 % of the area."""

    mean: float
    """over the site"""
    low: float
    """5 % of the area has less"""
    high: float
    """5 % of the area has more"""


@dataclass(frozen=True)
class SiteEnds:
    """What becomes of the landers of a site, by the emulator of the touchdowns.

    Shares are those of the landers of known end; their bounds hold whatever becomes of the others, over other beds and
    other landers.
    """

    at_rest: Share
    """landers at rest within the longest journey"""
    partner: Share
    """landers at rest on the partner"""
    escaped: Share
    """landers that escape"""
    under_way: Share
    """landers still under way at its end"""
    time_s: Number | None
    """median time from the first touchdown to rest [s]; null where none rests"""
    distance_m: Number | None
    """median way over the ground from the aim point to rest [m]; null where none rests"""
    limit_states: Mapping[str, Share] = field(default_factory=dict)
    """landers that meet each limit state of journeys that names distance, time_s or ends alone"""


@dataclass(frozen=True)
class SiteCell:
    """A site: a cell of equal area with aim points all over it, and the landers that are delivered there."""

    latitude_deg: float
    """of its middle"""
    longitude_deg: float
    """of its middle"""
    south_deg: float
    """latitude of its southern border"""
    north_deg: float
    """latitude of its northern border"""
    west_deg: float
    """longitude of its western border"""
    east_deg: float
    """longitude of its eastern border"""
    unknown: float
    """fraction of its landers with an impact that the emulator does not know"""
    beyond: str
    """what such impacts are beyond the touchdowns of the study, the most frequent first; empty where there are none"""
    ends: SiteEnds | None
    """null where so many ends are unknown that the site is not answered"""
    not_worse: bool
    """whether it cannot be told from the site of most landers at rest"""
    slope_deg: SiteSpread
    """of the facets against gravity, rotation and the partner's tide"""
    gravity: SiteSpread
    """acceleration of what rests there [m/s2]"""
    light: Mapping[str, SiteSpread]
    """fraction of a day in which "sun" and "earth" are seen, over area and seasons; those that [sky] asks for"""
    journeys: int
    """journeys of the study with their first touchdown there"""

    @property
    def bounds_deg(self) -> tuple[float, float, float, float]:
        """South, north, west and east."""
        return self.south_deg, self.north_deg, self.west_deg, self.east_deg

    @property
    def row(self) -> dict[str, Any]:
        """The site as a row of sites.csv; None where it has no such number."""
        own = ("latitude_deg", "longitude_deg", "south_deg", "north_deg", "west_deg", "east_deg")
        row: dict[str, Any] = {name: getattr(self, name) for name in own}
        row |= {"answered": int(self.ends is not None), "unknown": self.unknown, "beyond": self.beyond}
        for name in (*SHARES, *MEDIANS):
            found = None if self.ends is None else getattr(self.ends, name)
            numbers = (None, None, None) if found is None else (found.value, found.lower, found.upper)
            row |= dict(zip((name, f"{name}_lower", f"{name}_upper"), numbers, strict=True))
        states = {} if self.ends is None else self.ends.limit_states
        for name, one in states.items():
            ends = {"": one.value, "_lower": one.lower, "_upper": one.upper}
            row |= {f"limit_state.{name}{end}": value for end, value in ends.items()}
        row["not_worse"] = int(self.not_worse)
        for name, spread in {"slope_deg": self.slope_deg, "gravity": self.gravity, **self.light}.items():
            row |= {name: spread.mean, f"{name}_5": spread.low, f"{name}_95": spread.high}
        return row | {"journeys": self.journeys}


@dataclass(frozen=True)
class SiteAgreement:
    """Landers at rest among the journeys of the study with their first touchdown in a region, by landings and by the
    emulator, whose refits have not seen the bed of the journey that they follow."""

    latitude_deg: float | None
    """of the middle of the region; null for the whole body"""
    longitude_deg: float | None
    """of the middle of the region; null for the whole body"""
    journeys: int
    """how many"""
    landings: Share
    """by landings"""
    emulator: Share
    """by the emulator"""
    difference: Share
    """emulator less landings, of the same landers"""

    @property
    def agrees(self) -> bool | None:
        """Whether the interval of the difference holds 0; None without an interval."""
        bounds = self.difference.bounds
        return None if bounds is None else bounds[0] <= 0.0 <= bounds[1]


@dataclass(frozen=True)
class SiteMap:
    """What becomes of landers that are delivered in one way to every site of a body."""

    title: str
    """of the study"""
    body: str
    """name of the body"""
    statement: str
    """what the map says, in sentences"""
    of: str
    """which landers the numbers hold over, in a sentence"""
    level: float
    """probability that each interval stands for"""
    why: str | None
    """why there are no intervals, in a sentence; null where there are"""
    duration_s: float
    """longest journey [s]"""
    landers: int
    """landers of each site, the same in all"""
    refits: int
    """refits of the emulator to beds drawn with replacement, of which each lander keeps one"""
    beds: int
    """beds that the emulator was fitted to"""
    touchdowns: int
    """touchdowns that it was fitted to"""
    area_m2: float
    """of a site, on the ball of the body's volume"""
    at_rest: Share | None
    """landers at rest over all answered sites, as large as each other; null where none is answered"""
    cells: tuple[SiteCell, ...]
    agreement: tuple[SiteAgreement, ...]
    """with the journeys of the study: over the whole body, then in regions with enough of them"""

    @property
    def answered(self) -> int:
        """How many sites are answered."""
        return sum(cell.ends is not None for cell in self.cells)
