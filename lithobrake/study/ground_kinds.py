"""The tables of the study file that say what the ground may be: kinds, each with its grains and its weight."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, Any, Literal

from pydantic import Field
from pydantic_core import PydanticCustomError

from lithobrake.study.ground_presets import GROUND_PRESETS
from lithobrake.study.ground_sections import BoulderSection, SoilGrainSection
from lithobrake.study.quantity import MaybeUncertain, Number, Scalar, Section
from lithobrake.vocabulary.plain_text import closest, show

Length = Annotated[Scalar, MaybeUncertain("m", above=0)]
# What stands in [bed] until the grains are known: its schema needs it.
PLACEHOLDER: Mapping[str, Any] = MappingProxyType(
    {"grain_count": 10, "width": (1.0, 1.0), "diameter": {"distribution": "constant", "value": 0.1}}
)


class GroundKind(Section):
    """A kind of ground. There may be any number of kinds, each in a table [ground.kind.NAME] of its own. Width, depth
    and number of grains of its beds follow from the grains and the lander; `lithobrake plan` prints them."""

    weight: Annotated[Scalar, MaybeUncertain("", above=0, at_most=1)] = Field(examples=["1.0"])
    """Probability of this kind. The weights of all kinds add up to 1. If one is uncertain, each body has weights of its
    own, divided by their sum."""
    grain_size: Length | None = Field(
        default=None, examples=['{ distribution = "log_uniform", lower = 0.06, upper = 0.4 }']
    )
    """Mean diameter of the grains of a bed, of the spheres of equal volume; if uncertain, it is sampled once for each
    bed, and at least ground.finest. Absent: of rock, three times the largest diameter of the lander."""
    size_ratio: Annotated[Scalar, MaybeUncertain("", at_least=1, at_most=20)] = 1.0
    """Largest diameter of the grains of a bed over the smallest; the diameters are uniform between. If uncertain, it is
    sampled once for each bed."""
    pour_friction: Annotated[Scalar, MaybeUncertain("", at_least=0)] | None = None
    """Packing of the grains, as bed.pour_friction; if uncertain, it is sampled once for each bed."""
    rock: bool = False
    """Bare rock: blocks far larger than the lander, which their weight holds in place. Its roughness is that of their
    faces and edges."""
    boulders: BoulderSection | None = None
    """Boulders among the grains, as bed.boulders."""
    grain: SoilGrainSection | None = None
    """Material of the grains of this kind where it differs from [grain]."""


class GroundSection(Section):
    """What the ground may be, in place of the sizes of [bed]: each bed is of a kind that is sampled by its weight, with
    grains of a size of its own. Results then hold over all grounds that the study allows, and their intervals include
    the uncertainty of the ground."""

    unknown: Literal["everywhere", "patchy", "both"] = "everywhere"
    """"everywhere": the body has one unknown ground: each bed represents one possible body, and a lander
    keeps its bed. "patchy": the ground differs from place to place, and a lander that flies farther than
    ground.patch meets another bed. "both": the body is patchy, with unknown fractions: each bed represents one possible
    body, whose patches have sampled weights; a ground.kind.weight is then uncertain."""
    patch: Annotated[float, Number("m", at_least=1e-3, at_most=1e6)] = Field(default=20.0, examples=["20.0"])
    """Distance over the ground after which a lander meets another bed, if ground.unknown is "patchy" or "both"."""
    finest: Annotated[float, Number("m", above=0)] | None = None
    """Smallest mean diameter of grains that are simulated: beds of this size represent finer ground, whose
    fraction the results state. Absent: a third of the largest diameter of the lander."""
    kind: dict[str, GroundKind] = Field(default={})


def ground_tables(tables: dict[str, Any]) -> dict[str, Any]:
    """The tables of a study, whose ground may be a name of GROUND_PRESETS, with a [bed] for the schema."""
    ground = tables.get("ground")
    if ground is None or not isinstance(bed := tables.get("bed", {}), Mapping):
        return tables
    if isinstance(ground, str):
        if ground.lower() not in GROUND_PRESETS:
            names = ", ".join(GROUND_PRESETS)
            text = f"ground is {show(ground)}; allowed: a table [ground], or a name out of {names}"
            raise PydanticCustomError("quantity", "{text}", {"text": f"{text}{closest(ground, GROUND_PRESETS)}"})
        ground = GROUND_PRESETS[ground.lower()]
    return tables | {"ground": ground, "bed": {**PLACEHOLDER, **bed}}
