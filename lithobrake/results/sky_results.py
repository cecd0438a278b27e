"""What landers at rest see of the Sun, of Earth and of an orbiter."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.journey_results import EndShare, RestQuantile


@dataclass(frozen=True)
class Probability:
    """A mean over the landers at rest of a fraction of the time: the probability for one of them at any time."""

    share: float
    """of 1"""
    lower: float | None
    """lower bound of its 90 % interval, over beds not in the study; null where there is none"""
    upper: float | None
    """upper bound"""
    why: str | None = None
    """why there is no interval, in a sentence"""


@dataclass(frozen=True)
class SkyResults:
    """Visibility of the Sun, Earth or the orbiter for the landers at rest (sky.csv). Fractions are of a day of the
    small body, of a span of dates, or of the times of the orbiter's states."""

    day_fraction: RestQuantile
    """median over the landers at rest of the fraction of the time in which they see it, of 1"""
    day_fraction_q05: RestQuantile
    """5th percentile of it"""
    least_day_fraction: RestQuantile
    """median over the landers at rest of that of their worst day in a span of dates"""
    probability: Probability
    """probability that a lander at rest sees it at a random time"""
    never: EndShare
    """landers at rest that never see it"""
    sides: Mapping[str, RestQuantile]
    """by the side of the lander, by its own axes: median fraction of the time in which it is seen and that side faces
    it; empty for a sphere"""
    side_probabilities: Mapping[str, Probability]
    """by side: probability that at a random time it is seen and the side faces it, so that a panel is lit or an antenna
    sees the orbiter; empty for a sphere"""
    dark_sides: Mapping[str, EndShare]
    """by the side: landers at rest on which it never faces the body while that is seen; empty for a sphere"""
