"""What becomes of the landers by the side that faces the ground when they touch down."""

from dataclasses import dataclass

from lithobrake.results.journey_results import EndShare, RestQuantile


@dataclass(frozen=True)
class SideResults:
    """Landers whose first touchdown has this side toward the ground, and all touchdowns with it."""

    words: str
    """the side in words, of a box with the lengths of its face"""
    landings: int
    """first touchdowns in which this side faces the ground: its axis is the nearest to the normal"""
    speed_ratio: RestQuantile
    """median of rebound speed / impact speed of these landings"""
    returns: EndShare
    """return fraction of these landings; count: landings of which all flights return"""
    at_rest: EndShare | None = None
    """with [journey]: fraction of these landers that comes to rest"""
    time_s: RestQuantile | None = None
    """with [journey]: median time to rest of these landers [s]"""
    touchdowns: int | None = None
    """with [journey]: all touchdowns in which this side faces the ground"""
    rests: EndShare | None = None
    """with [journey]: fraction of these touchdowns in which the lander comes to rest"""
