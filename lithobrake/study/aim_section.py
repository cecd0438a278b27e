"""The table of the study file that says between which aims there is to choose."""

import re
from dataclasses import dataclass
from itertools import product
from typing import Annotated

from pydantic import Field

from lithobrake.study.quantity import Number, Whole
from lithobrake.study.section import Section
from lithobrake.vocabulary.limit_state import COMPARED
from lithobrake.vocabulary.outcomes import JourneyStatus

# What comes of an aim, and may be limited as the aim itself is.
SETTLED = JourneyStatus.SETTLED.value
AIM_RESULTS = (SETTLED, "missing", "distance_p95", "time_p95")
_LIMIT = re.compile(r"\s*([a-z_0-9.]+)\s*(<=|>=|<|>)\s*([-+.0-9eE]+)\s*")


class AimSection(Section):
    """Where to aim: speeds, angles and places to choose from, each tried with landers that go on until they rest.

    docs/aiming.md. With design.method = "drawn" only, and impact.speed and impact.incidence_deg uncertain."""

    grid: dict[str, list[Annotated[float, Number("")]]] = Field(default={})
    """What is chosen, by dotted key, and the values to try, ascending: one to three uncertain numbers of [impact], or
    latitude_deg, longitude_deg, heading_deg of [site]; all their combinations are aims. Everything else is drawn."""
    within: list[str] = Field(default=[])
    """What the best aim must keep, as in "incidence_deg < 45": a name of the grid without its table, or settled,
    missing (shares), distance_p95 [m], time_p95 [s]; compared with a number by <, <=, > or >=."""
    lander_count: Annotated[int, Whole("", at_least=2, at_most=10_000)] = 10
    """Landers at each aim for each of the 50 fits of the emulator to beds drawn anew."""

    def aims(self) -> list[dict[str, float]]:
        """All aims, the last name of the grid running fastest."""
        if not self.grid:
            return []
        return [dict(zip(self.grid, values, strict=True)) for values in product(*self.grid.values())]


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
