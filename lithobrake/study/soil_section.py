"""The tables of the study file that give regions of the body a soil of their own."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from lithobrake.study.material_sections import (
    Cohesion,
    Density,
    Friction,
    PoissonRatio,
    Restitution,
    SurfaceEnergy,
    YoungModulus,
)
from lithobrake.study.quantity import Numbers, Scalar, Section, Uncertain
from lithobrake.vocabulary.plain_text import show

Ends = tuple[float, float]


class SoilGrainSection(Section):
    """Material of the grains of a region where it differs from [grain]; the sizes are those of [bed] everywhere."""

    density: Density | None = None
    """Density of the rock. If this or a property below is absent, it is that of [grain]."""
    young_modulus: YoungModulus | None = None
    """Young's modulus."""
    poisson_ratio: PoissonRatio | None = None
    """Poisson's ratio."""
    restitution: Restitution | None = None
    """Coefficient of restitution between grains."""
    friction: Friction | None = Field(default=None, examples=['{ distribution = "uniform", lower = 0.2, upper = 0.4 }'])
    """Coefficient of friction."""
    rolling_friction: Friction | None = None
    """Resistance to rolling."""
    spinning_friction: Friction | None = None
    """Resistance to spinning about the contact normal."""
    cohesion_force: Cohesion | None = None
    """Pull of every contact, whatever its size."""
    surface_energy: SurfaceEnergy | None = None
    """Pull of a contact in proportion to its radius."""

    def values(self) -> dict[str, Scalar]:
        """The numbers that differ, by their names in [grain]."""
        given = {name: getattr(self, name) for name in type(self).model_fields}
        return {name: value for name, value in given.items() if isinstance(value, float | Uncertain)}


class SoilSection(Section):
    """The soil of a region of the body; with [journey] only. There may be any number of regions, each in a table
    [soil.NAME] of its own. A region is the ground within all of its bounds. Where regions overlap, the first in the
    file applies; where there is none, [grain] applies. All beds are those of [bed] and [grain]: a touchdown in the
    region uses one of them with the region's materials. The soil of each region is sampled once for each lander."""

    latitude_deg: Annotated[Ends, Numbers("deg", at_least=-90, at_most=90, count=2, ascending=True)] | None = None
    """Smallest and largest planetocentric latitude. If this or a bound below is absent, it does not limit the
    region."""
    longitude_deg: Annotated[Ends, Numbers("deg", at_least=-360, at_most=360, count=2)] | None = None
    """First longitude and, eastward of it, the last one; [170, -170] crosses 180."""
    slope_deg: Annotated[Ends, Numbers("deg", at_least=0, at_most=180, count=2, ascending=True)] | None = None
    """Smallest and largest slope of its facets, at their centres, against gravity, rotation and the partner's tide at
    the medians of [site]. Above 90 an object at rest leaves the ground."""
    facets: str | None = Field(default=None, examples=['"ponds.csv"'])
    """Text file, relative to the study file, with the numbers of its facets in the shape of the body, from 0, one per
    line."""
    grain: SoilGrainSection

    @model_validator(mode="before")
    @classmethod
    def _refuse_sizes(cls, table: Any) -> Any:
        """Say of sizes why a region has none; all else that is wrong is left for the fields to refuse."""
        grain = table.get("grain") if isinstance(table, Mapping) else None
        if isinstance(table, Mapping) and ("bed" in table or (isinstance(grain, Mapping) and "diameter" in grain)):
            words = "gives sizes of grains; allowed: materials alone, as beds are poured once for all of the body"
            raise PydanticCustomError("quantity", "{text}", {"text": f"{words}; make a study for each of the sizes"})
        return table

    @property
    def has_bounds(self) -> bool:
        """Whether anything says where it lies."""
        return any(one is not None for one in (self.latitude_deg, self.longitude_deg, self.slope_deg, self.facets))


def facet_numbers(path: Path) -> tuple[int, ...]:
    """The numbers in a file of facets. Raises ValueError for a line that is none, or no number at all; OSError."""
    found = []
    for number, line in enumerate(path.read_text(encoding="utf-8-sig").splitlines(), start=1):
        text = line.strip()
        if text and not re.fullmatch(r"\d{1,9}", text, re.ASCII):
            raise ValueError(f"line {number} is {show(text)}; allowed: a whole number from 0; mend that line")
        found += [int(text)] if text else []
    if not found:
        raise ValueError("it has no facet; write their numbers, from 0, one a line")
    return tuple(found)
