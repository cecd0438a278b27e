"""What became of the landers by the soil of the regions that they came down in."""

from dataclasses import dataclass

from lithobrake.results.journey_results import EndShare
from lithobrake.vocabulary.screen import short_repr


@dataclass(frozen=True)
class SoilResults:
    """The touchdowns in a region of the body with a soil of its own, or elsewhere, on [grain]."""

    area_share: float
    """fraction of the surface of the body"""
    touchdowns: int
    """touchdowns in it"""
    rests: EndShare | None
    """fraction of these touchdowns in which the lander comes to rest; null if there are none"""
    at_rest: EndShare
    """fraction of all journeys that end at rest there"""
    outlines: tuple[tuple[tuple[float, float], ...], ...]
    """latitude and east longitude [deg] along its edges; none for the ground elsewhere"""
    __repr__ = short_repr
