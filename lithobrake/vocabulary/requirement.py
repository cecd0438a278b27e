"""What is found of a requirement, a probability that is to be reached: at one delivery, and where it ends to be met."""

import math
from dataclasses import dataclass
from enum import StrEnum


class Verdict(StrEnum):
    """Whether a delivery meets a requirement, by the interval of its probability."""

    MET = "met"
    NOT_MET = "not met"
    # The interval holds the probability that is required.
    OPEN = "open"
    # Too many landers have an impact that the emulator does not know.
    OUTSIDE = "outside"


@dataclass(frozen=True)
class AdmissibleEdge:
    """The value of a parameter at which a probability crosses the one that is required.

    falls: whether the probability falls with the parameter, so that smaller values are admissible; value: by the
    probability itself; sure, possible: by the end of its interval that is farther from, and nearer to, meeting the
    requirement. Infinite where there is no crossing within the values: on the side of these that is not admissible
    (math.inf where `falls`) all of them meet it, on the other none does. why: there is no edge, in a sentence. known:
    the least and the largest value with a result, of which alone all this speaks; None where fewer than two have one.
    """

    falls: bool
    value: float = math.nan
    sure: float = math.nan
    possible: float = math.nan
    why: str | None = None
    known: tuple[float, float] | None = None
