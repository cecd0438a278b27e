"""A fraction of the landings, as the analysis gives it and results hold it."""

from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

from lithobrake.vocabulary.estimate import INLINE, Estimate, Inlined, Keyed, without_underscore


@dataclass(frozen=True)
class LandingFraction(Inlined):
    """A fraction of the landings over the input distributions, with what they show of it."""

    __pydantic_config__: ClassVar[dict[str, Any]] = {"alias_generator": without_underscore}

    share: Annotated[Estimate, Keyed("share", has_reason=False)] = field(metadata=INLINE)
    """fraction of the landings"""
    from_: str
    """number of landings and beds, or of samples"""
    next_bed: tuple[float, float] | None
    """prediction interval for a new bed of the size of the study's: lower, upper; null where that is not known"""
    if_missing: tuple[float, float]
    """the fraction if it is 0, and if it is 1, for all landings without an outcome, without sampling error"""
    missing: float
    """share of the landings, or samples, without an outcome"""
