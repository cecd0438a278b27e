"""What a comparison of two studies found, as comparison.json holds it."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.vocabulary.screen import short_repr


@dataclass(frozen=True)
class ComparedNumber:
    """A number of one of the studies, from the pairs alone."""

    value: float | None
    """in the unit of the answer; null where no run has it"""
    lower: float | None
    """lower bound, over beds and impact points not in the study; null where there is none"""
    upper: float | None
    """upper bound"""


@dataclass(frozen=True)
class ComparedAnswer:
    """An answer of both studies, and the second less the first."""

    words: str
    """what it is"""
    unit: str
    """of all its numbers; empty for a fraction of 1 and for a count"""
    is_fraction: bool
    """whether it is a fraction of all landers"""
    first: ComparedNumber
    second: ComparedNumber
    difference: ComparedNumber
    """second less first; null where one of them is"""
    pairs: int
    """pairs of which both runs have an answer"""
    correlation: float | None
    """of the two runs of a pair; null where an answer does not vary"""
    landings_saved: float | None
    """how many times the landings an unpaired comparison takes for an interval as narrow; null without an interval"""


@dataclass(frozen=True)
class StudyComparison:
    """Two studies on the same beds, places, attitudes and headings, paired by number."""

    names: tuple[str, str]
    """folders of the first and the second study, as they were given"""
    titles: tuple[str, str]
    """their titles"""
    of: str
    """which pairs it describes, in words"""
    level: float
    """probability that each interval stands for"""
    settings: Mapping[str, tuple[str, str]]
    """keys of the study files, by their dotted names, that differ: first, second"""
    answers: Mapping[str, ComparedAnswer]
    note: str | None
    """what makes the pairs less alike than they could be, in a sentence; null where nothing does"""
    why: str | None
    """why there are no intervals, in a sentence; null where there are"""
    __repr__ = short_repr
