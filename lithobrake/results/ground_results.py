"""Results over the grounds that a study allows, and on each kind of ground."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.run_results import CountedShare, Number, Share
from lithobrake.vocabulary.plain_text import short_repr


@dataclass(frozen=True)
class OverGrounds:
    """Results for a body with one unknown ground: each value is that over all grounds of the study, and its bounds
    contain that of one ground with the probability of the level."""

    at_rest: Share
    """fraction of the landers that comes to rest"""
    time_s: Number
    """median time from the first touchdown to rest [s]"""
    distance_m: Number
    """median distance from the aim point of those at rest [m]"""
    faces: Mapping[str, Share]
    """by the side of the lander that is down: fraction of the landers at rest; empty for a sphere"""
    __repr__ = short_repr


@dataclass(frozen=True)
class FinerGround:
    """Ground whose grains are finer than any that are simulated: beds of the finest grains represent it."""

    finest_m: float
    """mean diameter of these beds [m]"""
    share: float
    """share of the ground, by the weights and sizes of the study file"""
    journeys: int = 0
    """journeys whose first touchdown is on one of these beds"""
    at_rest: CountedShare | None = None
    """fraction of these landers that comes to rest; null without any"""
    time_s: Number | None = None
    """median time from the first touchdown to rest of these landers [s]; null without any"""
    distance_m: Number | None = None
    """median distance from the aim point of those at rest [m]; null without any"""


@dataclass(frozen=True)
class GroundBed:
    """The journeys on one bed."""

    kind: str
    """kind of its ground"""
    grain_size_m: float
    """mean diameter of its grains [m]"""
    journeys: int
    """journeys on it"""
    at_rest: float
    """fraction of them at rest"""
    time_s: float | None
    """median time to rest of these [s]; null if none rests"""


@dataclass(frozen=True)
class GroundCurve:
    """How journeys end against the mean grain diameter of their beds: smooth curves, a value for each diameter; bounds
    hold over resampled beds."""

    grain_size_m: tuple[float, ...]
    """mean grain diameters [m]"""
    at_rest: tuple[Share, ...]
    """fraction of the landers that comes to rest"""
    time_s: tuple[Number, ...]
    """median time from the first touchdown to rest [s]"""
    axes: Mapping[str, tuple[Share, ...]]
    """by the axis of the lander that points up or down: fraction of the landers at rest; empty for a sphere"""
    beds: tuple[GroundBed, ...]
    """the beds that landers met, in the order of their numbers"""
    __repr__ = short_repr


@dataclass(frozen=True)
class GroundKindResults:
    """The journeys whose first touchdown is on one kind of ground, whichever they meet later."""

    weight: float
    """probability of the kind, by the study file"""
    beds: int
    """beds of this kind that landers met"""
    journeys: int
    """journeys on them"""
    grain_size_m: tuple[float, float]
    """smallest and largest mean grain diameter of the beds of this kind [m]"""
    at_rest: CountedShare
    """fraction of these landers that comes to rest"""
    time_s: Number
    """median time from the first touchdown to rest of these landers [s]"""
    distance_m: Number
    """median distance from the aim point of those at rest [m]"""
    faces: Mapping[str, CountedShare]
    """by the side of the lander that is down: fraction of the landers at rest; empty for a sphere"""
    __repr__ = short_repr
