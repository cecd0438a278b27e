"""What landers at rest see of a body far away."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.journey_results import EndShare, RestQuantile


@dataclass(frozen=True)
class SkyResults:
    """What the landers at rest see of the Sun or of Earth over a day of the small body (sky.csv)."""

    day_fraction: RestQuantile
    """median over the landers at rest of the fraction of a day in which they see it, of 1"""
    day_fraction_q05: RestQuantile
    """5th percentile of it"""
    never: EndShare
    """landers at rest that never see it"""
    sides: Mapping[str, RestQuantile]
    """by the side of the lander, by its own axes: median fraction of a day in which it is seen and that side faces it;
    empty for a ball"""
    dark_sides: Mapping[str, EndShare]
    """by the side: landers at rest on which it never faces the body while that is seen; empty for a ball"""
