"""Regions of the ground that hold shares of the landers."""

from dataclasses import dataclass

from lithobrake.vocabulary.screen import short_repr


@dataclass(frozen=True)
class RestRegion:
    """The smallest region of the ground (highest density) that contains a fraction of the landers: at rest, or at an
    impact."""

    share: float
    """that it holds, of 1"""
    area_m2: float
    """its area"""
    largest_extent_m: float
    """largest distance between two of its points"""
    outlines: tuple[tuple[tuple[float, float], ...], ...]
    """latitude and east longitude [deg] along its edges"""
    __repr__ = short_repr
