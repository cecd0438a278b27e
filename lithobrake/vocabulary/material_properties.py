"""Materials: the one table of what a solid is to a contact. The study file, labels, documents and law read it."""

import math
from dataclasses import MISSING, dataclass, field, fields
from numbers import Real
from typing import Any

from lithobrake.vocabulary.field_errors import FieldError


@dataclass(frozen=True)
class MaterialProperty:
    """A property of a solid: its unit ("" for a pure number), words, meaning, allowed range and reader.

    above and below exclude the end of the range, at_least and at_most allow it. symbol: in figures. example: in a study
    file. law: the file of dem that reads it. is_shared: two touching materials have one value of it, by the rule of the
    world for pairs. default: where nothing is given; None where it must be.
    """

    unit: str
    words: str
    meaning: str
    law: str
    above: float = -math.inf
    at_least: float = -math.inf
    below: float = math.inf
    at_most: float = math.inf
    symbol: str = ""
    example: str | None = None
    is_shared: bool = False
    default: float | None = None

    @property
    def label(self) -> str:
        """Words and symbol, for a figure."""
        return f"{self.words} {self.symbol}".strip()

    @property
    def title(self) -> str:
        """Words as a sentence begins with them."""
        return self.words[0].upper() + self.words[1:]

    @property
    def limits(self) -> dict[str, float]:
        """The ends of the range that it has, by name."""
        ends = {name: getattr(self, name) for name in ("above", "at_least", "below", "at_most")}
        return {name: end for name, end in ends.items() if math.isfinite(end)}

    @property
    def range_words(self) -> str:
        """The range in words, as "a finite value above 0 Pa" or "0 <= value < 0.5"."""
        ends = self.limits
        if len(ends) == 1:
            ((name, end),) = ends.items()
            return f"a finite value {'above' if name == 'above' else 'of at least'} {end:g} {self.unit}".rstrip()
        lower = f"{self.above:g} <" if "above" in ends else f"{self.at_least:g} <="
        upper = f"< {self.below:g}" if "below" in ends else f"<= {self.at_most:g}"
        return f"{lower} value {upper}"

    def allows(self, value: float) -> bool:
        """Whether a value is finite and in the range."""
        if isinstance(value, bool) or not isinstance(value, Real):
            return False
        return math.isfinite(value) and self.above < value < self.below and self.at_least <= value <= self.at_most


def _property(unit: str, words: str, meaning: str, law: str, *, default: float | None = None, **rest: Any) -> Any:
    """The field of a material that has this property."""
    known = MaterialProperty(unit, words, meaning, law, default=default, **rest)
    return field(default=MISSING if default is None else default, metadata={"property": known})


@dataclass(frozen=True, kw_only=True)
class Material:
    """An isotropic elastic, frictional solid. Raises ValueError for a property outside its range.

    young_modulus [Pa] > 0, poisson_ratio [-] in [0, 0.5), restitution [-] in (0, 1], friction [-] >= 0, density
    [kg/m3] > 0. A rigid body is any large finite Young's modulus.

    rolling_friction, spinning_friction [-] >= 0: a contact resists rolling, and spinning about its normal, up to this
    times contact radius R* times normal force. Source: [Ai-2011], model C.

    cohesion_force [N] >= 0 and surface_energy [J/m2] >= 0: contacts pull with cohesion_force + 4 pi surface_energy R*
    while they last, not beyond. Source: [Derjaguin-1975]. Lunar soil has, by [Perko-2001], a pull
    of 0.036 S^2 R* newtons, S the cleanliness from 0 to 1: a surface energy of 0.0029 S^2 J/m2.

    yield_strength [Pa] >= 0 and restitution_speed [m/s] >= 0: restitution that falls with speed, by yielding or as of a
    viscoelastic solid that has its restitution at this speed; 0: none of it. Source: [Thornton-1998],
    [Brilliantov-1996].

    rough: contacts have its friction, whatever the other material and the rule for pairs; of two, the larger.
    """

    young_modulus: float = _property(
        "Pa", "Young's modulus", "Young's modulus; over decades use log_uniform.", "law/hertz_spring", symbol="$E$",
        above=0.0, example='{ distribution = "log_uniform", lower = 1e6, upper = 1e8 }',
    )  # fmt: skip
    poisson_ratio: float = _property(
        "", "Poisson's ratio", "Poisson's ratio.", "law/restitution", symbol=r"$\nu$",
        at_least=0.0, below=0.5, example='{ distribution = "uniform", lower = 0.15, upper = 0.35 }',
    )  # fmt: skip
    restitution: float = _property(
        "", "restitution", "Coefficient of restitution between grains.", "law/restitution", symbol="$e$",
        is_shared=True, above=0.0, at_most=1.0, example='{ distribution = "uniform", lower = 0.3, upper = 0.8 }',
    )  # fmt: skip
    friction: float = _property(
        "", "friction", "Coefficient of friction.", "law/coulomb_friction", symbol=r"$\mu$", is_shared=True,
        at_least=0.0, example='{ distribution = "uniform", lower = 0.3, upper = 0.9 }',
    )  # fmt: skip
    density: float = _property(
        "kg/m3", "density", "Density of the rock.", "bodies/rigid_body", symbol=r"$\rho$", above=0.0, example="2500.0"
    )
    rolling_friction: float = _property(
        "", "rolling friction",
        "Resistance to rolling: the largest couple of a contact divided by normal force and contact radius.",
        "law/rolling_resistance", at_least=0.0, is_shared=True, default=0.0,
    )  # fmt: skip
    spinning_friction: float = _property(
        "", "spinning friction", "Resistance to spinning about the contact normal, defined in the same way.",
        "law/coulomb_friction", at_least=0.0, is_shared=True, default=0.0,
    )  # fmt: skip
    cohesion_force: float = _property(
        "N", "cohesion", "Pull of every contact, whatever its size.", "law/hertz_spring",
        at_least=0.0, is_shared=True, default=0.0,
    )  # fmt: skip
    surface_energy: float = _property(
        "J/m2", "surface energy",
        "Pull of a contact in proportion to its radius R*: 4 pi surface_energy R*. For clean grains of lunar soil it "
        "is 0.0029.",
        "law/hertz_spring", at_least=0.0, is_shared=True, default=0.0,
    )  # fmt: skip
    yield_strength: float = _property(
        "Pa", "yield strength",
        "Strength at which contacts yield: above some speed the restitution falls, in the end as speed^-1/4. Of two "
        "materials the weaker counts. 0: contacts stay elastic.",
        "law/yielding", at_least=0.0, default=0.0,
    )  # fmt: skip
    restitution_speed: float = _property(
        "m/s", "speed of the restitution",
        "Speed at which a contact has the given restitution; below, it loses less, and above, more: viscoelastic, "
        "1 - restitution as speed^1/5 at first. Of two materials the larger counts. 0: the restitution is the same at "
        "all speeds.",
        "law/restitution", at_least=0.0, default=0.0,
    )  # fmt: skip
    rough: bool = False

    def __post_init__(self) -> None:
        for name, known in PROPERTIES.items():
            value = getattr(self, name)
            if not known.allows(value):
                raise FieldError(f"Material.{name}", value, f"is {known.range_words}")


PROPERTIES: dict[str, MaterialProperty] = {
    one.name: one.metadata["property"] for one in fields(Material) if "property" in one.metadata
}
# What a surface has of them, whose mass is given; and what two surfaces share.
SURFACE_PROPERTIES = tuple(name for name in PROPERTIES if name != "density")
SHARED_PROPERTIES = tuple(name for name, known in PROPERTIES.items() if known.is_shared)
