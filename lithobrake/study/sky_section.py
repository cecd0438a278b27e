"""The table of the study file that asks what landers at rest see of the sky."""

from typing import Annotated, Literal

from pydantic import Field

from lithobrake.study.quantity import MaybeUncertain, Number, Scalar, Section

Latitude = Annotated[Scalar, MaybeUncertain("deg", at_least=-90, at_most=90)]
Turn = Annotated[float, Number("deg", at_least=-360, at_most=360)]
SkyBody = Literal["sun", "earth", "orbiter"]


class OrbitSection(Section):
    """Heliocentric orbit of the body, or of the binary that it is in, by osculating elements (ecliptic and equinox of
    J2000), as a catalogue of small bodies has them. The examples are those of Didymos [SBDB-Didymos]."""

    semi_major_axis_au: Annotated[float, Number("", above=0)] = Field(examples=["1.64271"])
    """Semi-major axis in astronomical units."""
    eccentricity: Annotated[float, Number("", at_least=0, below=1)] = Field(examples=["0.383123"])
    """Eccentricity."""
    inclination_deg: Annotated[float, Number("deg", at_least=0, at_most=180)] = Field(examples=["3.41388"])
    """Inclination."""
    node_deg: Turn = Field(examples=["72.9858"])
    """Longitude of the ascending node."""
    perihelion_deg: Turn = Field(examples=["319.5807"])
    """Argument of perihelion."""
    mean_anomaly_deg: Turn = Field(examples=["260.861"])
    """Mean anomaly at `epoch`."""
    epoch: str = Field(examples=['"2026-06-09T00:00:00"'])
    """Date and time at which these elements hold (UTC)."""


class OrbiterSection(Section):
    """An orbiter that landers talk to, in one of three ways: a circle (`altitude`, `inclination_deg`), over any phase
    of it and of the body's turn; a table of body-fixed places (`states`); or SPICE (`kernel_name`) from sky.date to
    sky.until."""

    altitude: Annotated[float, Number("m", above=0)] | None = Field(default=None, examples=["2000.0"])
    """Height of the circle above the sphere around the body that touches its highest point."""
    inclination_deg: Annotated[float, Number("deg", at_least=0, at_most=180)] | None = Field(
        default=None, examples=["90.0"]
    )
    """Inclination of the circle to the body's equator; absent: 90, over the poles."""
    states: str | None = Field(default=None, examples=['"orbiter.csv"'])
    """Body-fixed states, in the format of delivery.states, which counts from the study file; each stands for half the
    time to its neighbours."""
    kernel_name: str | None = Field(default=None, examples=['"HERA"'])
    """Name or number, as text, of the orbiter in site.kernels."""

    @property
    def ways(self) -> list[str]:
        """In which ways it is given."""
        return [key for key in ("altitude", "states", "kernel_name") if getattr(self, key) is not None]


class SkySection(Section):
    """What a lander at rest sees of the Sun, of Earth and of an orbiter, and which of its sides face them; with
    [journey] only.

    A body far away stands over one latitude for a day of the small body, and over another in another season. Either the
    latitudes are given (a distribution asks for a year: each lander draws its own), or `date` tells them, through
    site.pole_right_ascension_deg and site.pole_declination_deg and the heliocentric orbit, or through site.kernels. The
    shape hides what is behind it, and so does the partner of a binary, as a spheroid of its extents.
    """

    sun_latitude_deg: Latitude | None = None
    """Latitude over which the Sun stands; absent: sunlight is not asked for, unless `date` is given."""
    earth_latitude_deg: Latitude | None = None
    """Latitude over which Earth stands; absent: it is not asked for, unless `date` is given."""
    date: str | None = None
    """UTC date and time, "2027-04-20T00:00:00": Sun and Earth stand where they are then."""
    until: str | None = None
    """End of a span of time from `date` on, say a year: fractions are means over 24 of its days, and `sky.csv` has that
    of the worst of them."""
    orbit: OrbitSection | None = None
    orbiter: OrbiterSection | None = None
    mask_deg: Annotated[float, Number("deg", at_least=0, below=90)] = 0.0
    """Height above the plane of the ground below which Earth and the orbiter are not seen."""
    beam_deg: Annotated[float, Number("deg", above=0, at_most=90)] = 90.0
    """Half the opening of an antenna's beam about the normal of its side, for Earth and the orbiter."""

    @property
    def latitudes(self) -> dict[SkyBody, Scalar]:
        """Latitudes that are given, by body."""
        given: dict[SkyBody, Scalar | None] = {"sun": self.sun_latitude_deg, "earth": self.earth_latitude_deg}
        return {name: latitude for name, latitude in given.items() if latitude is not None}

    @property
    def bodies(self) -> tuple[SkyBody, ...]:
        """What is asked for."""
        far: tuple[SkyBody, ...] = tuple(self.latitudes) if self.date is None else ("sun", "earth")
        return far if self.orbiter is None else (*far, "orbiter")

    def mask_of(self, body: SkyBody) -> float:
        """Least height above the ground [deg]; the Sun is seen down to the ground."""
        return 0.0 if body == "sun" else self.mask_deg

    def beam_of(self, body: SkyBody) -> float:
        """Largest angle from the normal of a side that faces the body [deg]; a panel has light from all of its sky."""
        return 90.0 if body == "sun" else self.beam_deg
