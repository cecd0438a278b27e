"""A table of the study file, and a number in one: with its unit and its allowed range, and fixed or uncertain.

An uncertain number is written as a table in place of the number,
`young_modulus = { distribution = "log_uniform", lower = 1e6, upper = 1e8 }`. The allowed range holds for the whole
support of the distribution, so no sample can ever leave it.
"""

import math
import sys
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict
from pydantic_core import PydanticCustomError, core_schema

from lithobrake.vocabulary.constants import LEAST_PROBABILITY
from lithobrake.vocabulary.plain_text import closest, show

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution

# Parameters of each distribution; all are needed. mean and std of log_normal are those of ln x.
DISTRIBUTIONS: dict[str, tuple[str, ...]] = {
    "uniform": ("lower", "upper"),
    "log_uniform": ("lower", "upper"),
    "normal": ("mean", "std"),
    "log_normal": ("mean", "std"),
    "truncated_normal": ("mean", "std", "lower", "upper"),
    "beta": ("alpha", "beta", "lower", "upper"),
    "gamma": ("shape", "scale"),
    "exponential": ("rate",),
}
# Whatever parameters these have in their range, their samples lie in it.
ALWAYS_SAMPLED = ("uniform", "log_uniform")
# A normal law is unbounded, and an error of delivery is not: plausibility checks take the quantiles of one in a
# thousand on either side as its ends (docs/decisions/smallbody.md).
RARE = 1e-3
# Products of six numbers of a study, as in the inertia of a sphere, neither overflow nor vanish within these sizes.
LARGEST, LEAST = 1e50, 1e-50
_POSITIVE_PARAMETERS = ("std", "alpha", "beta", "shape", "scale", "rate")


@dataclass(frozen=True)
class Uncertain:
    """A distribution in place of a number; parameters in the unit of the quantity."""

    distribution: str
    parameters: dict[str, float]

    def support(self) -> tuple[float, float]:
        """Smallest and largest possible value; infinite where the distribution has no end."""
        if "lower" in self.parameters:
            return self.parameters["lower"], self.parameters["upper"]
        return (-math.inf if self.distribution == "normal" else 0.0), math.inf

    def to_chaos(self) -> "Distribution":
        from lithobrake.chaos import distribution

        return distribution(self.distribution, **self.parameters)


Scalar = float | Uncertain


def median(value: Scalar) -> float:
    return float(value.to_chaos().median) if isinstance(value, Uncertain) else value


def scaled(value: Scalar, factor: float) -> Scalar:
    """A factor above 0 times a number or, whatever its distribution, an uncertain one."""
    if not isinstance(value, Uncertain):
        return factor * value
    changed = dict(value.parameters)
    for name in changed:
        if value.distribution == "log_normal":
            changed[name] += math.log(factor) if name == "mean" else 0.0
        elif name in ("lower", "upper", "mean", "std", "scale"):
            changed[name] *= factor
        elif name == "rate":
            changed[name] /= factor
    return Uncertain(value.distribution, changed)


def reach(value: Scalar) -> tuple[float, float]:
    """Smallest and largest possible value; infinite where its distribution has no end."""
    return value.support() if isinstance(value, Uncertain) else (value, value)


def usual_reach(value: Scalar) -> tuple[float, float]:
    """The same, where a distribution without an end counts from RARE to 1 - RARE of its samples."""
    ends = reach(value)
    if isinstance(value, Uncertain) and not all(map(math.isfinite, ends)):
        distribution = value.to_chaos()
        return float(distribution.ppf(RARE)), float(distribution.ppf(1.0 - RARE))
    return ends


def uncertain(values: dict[str, Scalar]) -> dict[str, Uncertain]:
    """Those of the values that have a distribution, in their order."""
    return {name: value for name, value in values.items() if isinstance(value, Uncertain)}


def refuse(value: object, allowed: object, remedy: str) -> PydanticCustomError:
    return PydanticCustomError("quantity", "{text}", {"text": f"is {show(value)}; allowed: {allowed}; {remedy}"})


def _refuse_size(value: object, allowed: object, *numbers: float) -> None:
    """Refuse a value with a number that arithmetic cannot carry; allowed: what the value may be."""
    if any(abs(one) > LARGEST or 0.0 < abs(one) < LEAST for one in numbers):
        raise refuse(
            value, f"{allowed}, and 0 or from {LEAST:g} to {LARGEST:g} in size", "write a number of such a size"
        )


@dataclass(frozen=True)
class Number:
    """A number in its unit ("" for a pure number) and range, or one given word in its place.

    `above` and `below` exclude the end of the range, `at_least` and `at_most` allow it.
    """

    unit: str
    above: float = -math.inf
    at_least: float = -math.inf
    below: float = math.inf
    at_most: float = math.inf
    word: str | None = None

    def __str__(self) -> str:
        ends = {"above": self.above, "at least": self.at_least, "below": self.below, "at most": self.at_most}
        words = " and ".join(f"{word} {end:g}" for word, end in ends.items() if math.isfinite(end))
        unit = f" [{self.unit}]" if self.unit else ""
        return f"{words or 'any number'}{unit}" + (f', or "{self.word}"' if self.word else "")

    def __get_pydantic_core_schema__(self, _source: object, _handler: object) -> core_schema.CoreSchema:
        # A plain validator takes the place of pydantic's own check of the annotated type, whose messages name neither
        # unit nor range.
        return core_schema.no_info_plain_validator_function(self.read)

    def allow(self, lower: float, upper: float, *, ends: bool = True) -> bool:
        """Tell whether the interval from lower to upper lies in the range; `ends` = it contains its own ends."""
        inside = self.at_least <= lower and upper <= self.at_most
        # An open end is never sampled: a gamma distribution, whose support begins at 0, fits "above 0", while a uniform
        # one from 0 does not.
        if ends:
            return inside and (lower > self.above) and (upper < self.below)
        return inside and lower >= self.above and upper <= self.below

    def read(self, value: Any) -> Any:
        return value if self.word is not None and value == self.word else self.check(value)

    def check(self, value: Any) -> Any:
        """Give back the number; refuse anything else, a distribution included."""
        if isinstance(value, dict):
            raise refuse(value, self, "it cannot be uncertain: write one number")
        if not is_number(value):
            unit = f", in {self.unit}" if self.unit else ""
            raise refuse(value, self, f"write a finite number without quotes{unit}")
        if not self.allow(value, value):
            raise refuse(value, self, "write a number in this range")
        _refuse_size(value, self, value)
        return float(value)


class Whole(Number):
    def check(self, value: Any) -> int:
        """Give back the whole number, also one written as 100.0; refuse anything else."""
        if not is_number(value) or value != int(value) or not self.allow(value, value):
            raise refuse(value, self, "write a whole number in this range")
        return int(value)


@dataclass(frozen=True)
class Numbers(Number):
    """A list of `count` numbers, each in the range; `ascending`: each larger than the one before."""

    count: int = 3
    ascending: bool = False

    def check(self, value: Any) -> tuple[float, ...]:
        if not isinstance(value, list | tuple) or len(value) != self.count or not all(map(is_number, value)):
            raise refuse(value, f"{self.count} numbers, each {self}", f"write {self.count} numbers in square brackets")
        if not all(self.allow(entry, entry) for entry in value):
            raise refuse(value, f"{self.count} numbers, each {self}", "write numbers in this range")
        _refuse_size(value, f"{self.count} numbers, each {self}", *value)
        if self.ascending and any(later <= earlier for earlier, later in pairwise(value)):
            raise refuse(value, f"{self.count} numbers, ascending", "write the smaller one first")
        return tuple(float(entry) for entry in value)


class Tensor(Number):
    """The moments of a symmetric tensor, three numbers above 0, or all of it: those and its elements xy, xz and yz."""

    def __str__(self) -> str:
        return f"three moments above 0, or these and the elements xy, xz, yz [{self.unit}]"

    def check(self, value: Any) -> tuple[float, ...]:
        if not isinstance(value, list | tuple) or len(value) not in (3, 6) or not all(map(is_number, value)):
            raise refuse(value, self, "write 3 or 6 numbers in square brackets")
        if min(value[:3]) <= 0.0:
            raise refuse(value, self, "write moments above 0")
        _refuse_size(value, self, *value)
        return tuple(float(entry) for entry in value)


class MaybeUncertain(Number):
    """A number in its range, or a distribution whose whole support lies in it."""

    def check(self, value: Any) -> Scalar:
        if isinstance(value, Uncertain):
            return value
        return self._uncertain(value) if isinstance(value, dict) else super().check(value)

    def _uncertain(self, table: dict[str, Any]) -> Uncertain:
        given = dict(table)
        kind = given.pop("distribution", None)
        if not isinstance(kind, str) or kind not in DISTRIBUTIONS:
            names = ", ".join(DISTRIBUTIONS)
            remedy = f"give it a distribution out of {names}{closest(kind, DISTRIBUTIONS)}"
            raise refuse(table, self, f"{remedy}; discrete choices are not supported: make one study for each")
        needed = DISTRIBUTIONS[kind]
        if set(given) != set(needed) or not all(map(is_number, given.values())):
            raise refuse(table, self, f"{kind} takes exactly the numbers {', '.join(needed)}")
        positive = [name for name in needed if name in _POSITIVE_PARAMETERS]
        if any(given[name] <= 0 for name in positive):
            raise refuse(table, self, f"{', '.join(positive)} must be above 0")
        uncertain = Uncertain(kind, {name: float(given[name]) for name in needed})
        lower, upper = uncertain.support()
        if lower >= upper or (kind == "log_uniform" and lower <= 0):
            raise refuse(table, self, "lower must be less than upper, and above 0 for log_uniform")
        if not self.allow(lower, upper, ends=math.isfinite(upper)):
            allowed = f"{self}, and it reaches from {lower:g} to {upper:g}"
            raise refuse(table, allowed, "bound it within the range (uniform, log_uniform, beta, truncated_normal)")
        _refuse_size(table, self, *uncertain.parameters.values())
        # The support can lie in the range and the samples can still leave it: a gamma law of a tiny shape underflows to
        # 0.
        if kind not in ALWAYS_SAMPLED:
            self._refuse_extreme(table, uncertain)
        return uncertain

    def _refuse_extreme(self, table: dict[str, Any], uncertain: Uncertain) -> None:
        """Refuse a law that no arithmetic can sample: its tails underflow to 0 or overflow, or it is no law at all."""
        import numpy as np

        try:
            with np.errstate(all="ignore"):
                ends = [float(uncertain.to_chaos().ppf(u)) for u in (LEAST_PROBABILITY, 0.5, 1.0 - LEAST_PROBABILITY)]
        except ValueError as error:
            raise refuse(table, self, str(error)) from error
        if not all(math.isfinite(end) and self.allow(end, end) for end in ends):
            words = ", ".join(f"{end:.3g}" for end in ends)
            raise refuse(table, self, f"its samples (least, median, largest: {words}) leave that range; narrow it")


def is_number(value: object) -> bool:
    """Tell whether a value read from TOML is a number that a float can hold (true, false and infinity are not)."""
    # bool is a subclass of int. TOML has nan, which fails both comparisons, inf, and integers of any length, on which
    # float() would raise OverflowError.
    largest = sys.float_info.max
    return isinstance(value, int | float) and not isinstance(value, bool) and -largest <= value <= largest


Angle = Annotated[Scalar, MaybeUncertain("deg", at_least=-360, at_most=360)]
LengthUnit = Literal["m", "km", "cm", "mm"]


class Section(BaseModel):
    """One table of the study file; a key that it does not know is refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True, defer_build=True)
