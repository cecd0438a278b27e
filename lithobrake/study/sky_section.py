"""The table of the study file that asks what landers at rest see of the sky."""

from typing import Annotated

from lithobrake.study.quantity import MaybeUncertain, Number, Scalar, Section

Latitude = Annotated[Scalar, MaybeUncertain("deg", at_least=-90, at_most=90)]


class SkySection(Section):
    """Whether a lander at rest has sunlight and sees Earth, over a day of the body; with [journey] only.

    A body far away stands over one latitude for a day, and over another in another season: a distribution of latitudes
    asks for a year, each lander draws its own. The shape hides what is behind it; the partner of a binary does not.
    """

    sun_latitude_deg: Latitude | None = None
    """Latitude over which the Sun stands; absent: sunlight is not asked for."""
    earth_latitude_deg: Latitude | None = None
    """Latitude over which Earth stands; absent: it is not asked for."""
    mask_deg: Annotated[float, Number("deg", at_least=0, below=90)] = 0.0
    """Height above the plane of the ground below which Earth is not seen."""

    @property
    def bodies(self) -> dict[str, Scalar]:
        """Latitudes that are asked for, by the name of the body."""
        given = {"sun": self.sun_latitude_deg, "earth": self.earth_latitude_deg}
        return {name: latitude for name, latitude in given.items() if latitude is not None}

    def mask_of(self, body: str) -> float:
        """Least height above the ground [deg]; the Sun is seen down to the ground."""
        return self.mask_deg if body == "earth" else 0.0
