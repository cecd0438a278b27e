"""What becomes of the landers by the side that faces the ground when they touch down."""

from dataclasses import dataclass

from lithobrake.results.journey_results import EndShare, RestQuantile


@dataclass(frozen=True)
class SideResults:
    """Landers that touch down first with one side toward the ground, and touchdowns with it."""

    words: str
    """the side in words, of a box with the lengths of its face"""
    landings: int
    """first touchdowns in which this side faces the ground: its axis is the nearest to the normal"""
    speed_ratio: RestQuantile
    """of these the median of the rebound speed over the impact speed"""
    returns: EndShare
    """of these the return fraction; count: landings of which all flights return"""
    at_rest: EndShare | None = None
    """with [journey]: of these landers the share that comes to rest in the end"""
    time_s: RestQuantile | None = None
    """with [journey]: of these landers the median time to rest [s]"""
    touchdowns: int | None = None
    """with [journey]: all touchdowns in which this side faces the ground"""
    rests: EndShare | None = None
    """with [journey]: of these the share in which the lander comes to rest"""
