"""What all journeys of a study have in common: the body they are on, its flights, and where they come down on a bed."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.free_rotation import lander_inertia
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.site import Site
from lithobrake.study.touchdown_model import PLACE
from lithobrake.vocabulary.quantities import SOIL

if TYPE_CHECKING:
    from lithobrake.smallbody import Body, Flights, Shape

# Steps toward the nearest ground: each leaves at most the sine of the angle between two facets of the way.
PROJECTIONS = 8


@dataclass(frozen=True, eq=False)
class JourneyModel:
    """The site and the design of a study that follows journeys."""

    design: DrawnDesign
    site: Site

    @cached_property
    def body(self) -> "Body":
        """The body with its partner."""
        return self.site.body

    @property
    def seed(self) -> int:
        """Of the study."""
        return self.design.study.seed

    @property
    def duration(self) -> float:
        """Longest journey [s]."""
        assert self.design.study.journey is not None
        return self.design.study.journey.duration

    @property
    def is_ball(self) -> bool:
        """Whether the lander has no sides."""
        return self.design.study.lander.is_ball

    def inertia(self, row: Mapping[str, float]) -> np.ndarray:
        """Inertia of the lander of a journey about its centre of mass [kg m2], [3, 3]."""
        return lander_inertia(self.design.study, row)

    def place(self, x: float, y: float, row: Mapping[str, float]) -> tuple[float, float]:
        """Where on its bed a lander comes down [m], of two uniform numbers; always at one place without a region."""
        if self.design.region is None:
            return row[PLACE[0]], row[PLACE[1]]
        (west, east), (south, north) = self.design.region
        return west + x * (east - west), south + y * (north - south)

    @cached_property
    def soils(self) -> Soils:
        """The soils of the regions of the body."""
        return Soils(self.site)

    def soil(self, journey: int, place: np.ndarray) -> dict[str, float]:
        """The numbers of the grains that a lander meets at a place [m], [3], by dotted key; none where no region has a
        soil of its own, and all ground is what the lander met first.
        """
        if not self.design.study.soil:
            return {}
        own = self.design.own_soil(journey)
        (met,) = self.soils.on_soil([own | {"journey": float(journey)}], place[None])
        return {key: met[key] for key in own}

    def soil_column(self, place: np.ndarray) -> dict[str, str]:
        """The region of a touchdown at a place [m], [3], as its table has it; nothing where there are no regions."""
        return dict(zip(SOIL, self.soils.at(place[None]), strict=True)) if self.design.study.soil else {}

    def fly(
        self, position: np.ndarray, velocity: np.ndarray, left: float, start: float, mass: float, spin_period: float
    ) -> "Flights":
        """Fly one lander to its next impact, for at most `left` [s]."""
        from lithobrake.smallbody import fly

        return fly(
            self.body, position, velocity, left, gravity=self.design.study.flight.gravity, start_time=start,
            mass=np.array([mass]), spin_period=np.array([spin_period]), threads=1,
        )  # fmt: skip


def on_ground(shape: "Shape", point: np.ndarray) -> np.ndarray:
    """The place on the ground [m], [3], nearest to a point beside it."""
    place = point
    for _ in range(PROJECTIONS):
        height, facet = shape.nearest(place)
        place = place - height * shape.normals[facet]
    if shape.height(place) >= 0.0:
        return place
    # Below the ground no flight begins: a point next to an edge, of which the outermost along the radius is taken.
    return shape.surface_point(*shape.latitude_longitude(point))
