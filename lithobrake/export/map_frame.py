"""Latitudes and longitudes of a body for programs that know those of planets: a sphere of its own, in their words."""

import math
from dataclasses import dataclass

from lithobrake.export.flown import body_name
from lithobrake.geometry.mesh import volume_of
from lithobrake.results import StudyResults

WORDS = "latitude planetocentric, longitude east positive, both of the body-fixed frame"


@dataclass(frozen=True)
class MapFrame:
    """A geographic frame on the sphere that has the volume of a body.

    On a sphere alone the latitude of a map is the planetocentric one, which an ellipsoid's is not.
    """

    body: str
    radius: float  # [m]

    @classmethod
    def of(cls, results: StudyResults) -> "MapFrame":
        """That of the body of a study."""
        volume = volume_of(*results.body_shape)
        return cls(body_name(results), (0.75 * volume / math.pi) ** (1.0 / 3.0))

    @property
    def name(self) -> str:
        """Name of the frame."""
        return f"{self.body} sphere, planetocentric, east positive"

    @property
    def wkt(self) -> str:
        """The frame as well-known text."""
        return (
            f'GEOGCS["{self.name}",DATUM["{self.body}",SPHEROID["{self.body} sphere",{self.radius!r},0]],'
            f'PRIMEM["Longitude 0 of {self.body}_FIXED",0],UNIT["degree",0.017453292519943295]]'
        )
