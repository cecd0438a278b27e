"""The tables of the study file that say what is asked: ends of a landing (limit states), and aims to choose from."""

import re
from dataclasses import dataclass
from itertools import product
from typing import Annotated, Any

from pydantic import BeforeValidator, ConfigDict, Field

from lithobrake.study.quantity import Number, Section, Whole, refuse
from lithobrake.vocabulary.limit_state import ALLOWED, COMPARED, EXAMPLE, LimitState, NoLimitStateError
from lithobrake.vocabulary.outcomes import JourneyEnd, JourneyStatus

# What comes of an aim, and may be limited as the aim itself is.
SETTLED, AT_REST = JourneyStatus.SETTLED.value, JourneyEnd.AT_REST.value
# The side that faces the ground, among the names of what is chosen.
SIDE = "aim.sides"
AIM_RESULTS = ("missing", "distance_p95", "time_p95")
_LIMIT = re.compile(r"\s*([a-z_0-9.]+)\s*(<=|>=|<|>)\s*([-+.0-9eE]+)\s*")


def aim_results(*, is_journey: bool) -> tuple[str, ...]:
    """What comes of an aim, by the names of its limits."""
    return (AT_REST if is_journey else SETTLED, *AIM_RESULTS)


def condition_text(given: object) -> str:
    """Give back the text of a condition; refuse what is none."""
    if not isinstance(given, str):
        raise refuse(given, ALLOWED, f"write it in quotation marks, as in {EXAMPLE}")
    try:
        return LimitState.of(given).text
    except NoLimitStateError as error:
        raise refuse(given, ALLOWED, str(error)) from error


class LimitStatesSection(Section):
    """Conditions whose probability the study estimates, by names of your own: fast = "speed_out > 0.1 and not returns".

    Outputs of the touchdown [SI] are compared with numbers; returns, captured, impact, flying, escaped and partner are
    true or false (docs/reliability.md). With design.method = "drawn" only."""

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, Annotated[str, BeforeValidator(condition_text)]] = Field(init=False)

    def conditions(self) -> dict[str, str]:
        """The conditions by their names."""
        given: dict[str, Any] = self.__pydantic_extra__ or {}
        return dict(given)


class AimSection(Section):
    """Delivery options to compare: speeds, angles and sites, each with landers that are followed to rest.

    See docs/aiming.md. With design.method = "drawn" only; without [journey], impact.speed and impact.incidence_deg must
    be uncertain."""

    grid: dict[str, list[Annotated[float, Number("")]]] = Field(default={})
    """Keys of the options, and their values in ascending order: one to three uncertain numbers of [impact], or
    latitude_deg, longitude_deg, heading_deg of [site]; with [journey], keys of [delivery]. All combinations are
    options. Everything else is sampled."""
    sides: list[str] = Field(default=[])
    """Sides of the lander that face the ground at the first touchdown, as further options; the lander is turned about
    the vertical at random, without a pointing error. For a box its axes, such as "z", or "x or y" where edges are
    equal; for a mesh "+x" to "-z". With [journey] only."""
    within: list[str] = Field(default=[])
    """Conditions that the best option must satisfy, such as "incidence_deg < 45": a name of the grid without its table,
    or settled (with [journey] at_rest), missing (fractions), distance_p95 [m], time_p95 [s]; compared with a number by
    <, <=, > or >=."""
    lander_count: Annotated[int, Whole("", at_least=2, at_most=10_000)] = 10
    """Landers of each option for each of the 50 refits of the emulator to resampled beds."""

    def aims(self) -> list[dict[str, float]]:
        """All aims, the last of the names running fastest; a side by its place among `sides`."""
        columns = [*self.grid.values(), *([list(map(float, range(len(self.sides))))] if self.sides else [])]
        return [dict(zip(self.names, values, strict=True)) for values in product(*columns)] if columns else []

    @property
    def names(self) -> tuple[str, ...]:
        """What is chosen, by dotted key."""
        return (*self.grid, *([SIDE] if self.sides else []))


@dataclass(frozen=True)
class AimLimit:
    """A limit that the best aim must keep, as `incidence_deg < 45`."""

    name: str
    sign: str
    number: float

    @classmethod
    def of(cls, text: str) -> "AimLimit | None":
        """Read one; None for a text that is none."""
        match = _LIMIT.fullmatch(text)
        try:
            return cls(match[1], match[2], float(match[3])) if match else None
        except ValueError:
            return None

    def keeps(self, value: float | None) -> bool:
        """Whether a value keeps it; what is not known does not."""
        return value is not None and bool(COMPARED[self.sign](value, self.number))
