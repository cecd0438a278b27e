"""The soil of a study: the materials that meet in a touchdown, and the sizes of the grains."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from lithobrake import touchdown
from lithobrake.study import Study
from lithobrake.study.ground_sections import Bell, Between, Constant, PowerLaw
from lithobrake.vocabulary.material_properties import PROPERTIES, SURFACE_PROPERTIES, Material

# The numbers that a touchdown reads, by dotted key, in the units of the study file.
Values = Mapping[str, float]


@dataclass(frozen=True)
class Soil:
    """The materials of a touchdown: of the grains, of the hull of the lander, and of its parts by their names.

    What a study does not give of the hull is that of the grains, and of a part that of the hull. The density of both is
    that of the grains, as the lander has its masses.
    """

    grain: Material
    hull: Material
    parts: Mapping[str, Material]

    @classmethod
    def of(cls, study: Study, values: Values) -> "Soil":
        """The soil of a touchdown; values with what was drawn. Raises ValueError for a property outside its range."""
        own = grain(values)
        hull = replace(own, **surface(values, "lander"))
        parts = {name: replace(hull, **surface(values, f"lander.part.{name}")) for name in study.lander.part}
        return cls(own, hull, parts)


def grain(values: Values) -> Material:
    """The material of the grains alone."""
    properties: dict[str, Any] = {name: values[f"grain.{name}"] for name in PROPERTIES}
    return Material(**properties)


def surface(values: Values, table: str) -> dict[str, Any]:
    """What is given of the material of a surface in a table of the study."""
    return {name: values[f"{table}.{name}"] for name in SURFACE_PROPERTIES if f"{table}.{name}" in values}


def grain_sizes(study: Study) -> "touchdown.GrainSizes":
    return sizes_of(study.bed.diameter)


def boulders(study: Study) -> "touchdown.Boulders | None":
    section = study.bed.boulders
    if section is None:
        return None
    return touchdown.Boulders(sizes=sizes_of(section.diameter), coverage=section.coverage, cover=section.cover)


def sizes_of(sizes: Constant | Between | Bell | PowerLaw) -> "touchdown.GrainSizes":
    if isinstance(sizes, Constant):
        return touchdown.GrainSizes(distribution="constant", lower=sizes.value, upper=sizes.value)
    if isinstance(sizes, PowerLaw):
        exponent = sizes.differential_exponent
        return touchdown.GrainSizes(distribution="power_law", lower=sizes.lower, upper=sizes.upper, exponent=exponent)
    return touchdown.GrainSizes(**sizes.model_dump())
