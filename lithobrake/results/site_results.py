"""The beds of a study, and the body and the site that it lands on."""

from dataclasses import dataclass

from lithobrake.vocabulary.screen import short_repr


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
    __repr__ = short_repr

    @property
    def sentences(self) -> list[str]:
        """How the body rotates, and why the site does not hold landers at rest; empty where there is neither."""
        return [said for said in (self.rotation, self.warning) if said]

    @property
    def holds(self) -> bool:
        """Whether the ground holds what lies there."""
        return self.effective_acceleration_outward < 0.0
