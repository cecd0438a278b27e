"""Materials, and the law that a pair of them obeys."""

import math
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

from scipy.optimize import brentq

SHEAR_MODULUS_RULES = ("mindlin", "paper")
PAIR_RULES = ("smaller", "mean", "geometric")
DAMPING_MASSES = ("contact", "paper")


@dataclass(frozen=True, kw_only=True)
class Material:
    """An isotropic elastic, frictional solid.

    young_modulus [Pa] > 0, poisson_ratio [-] in [0, 0.5), restitution [-] in (0, 1], friction [-] >= 0, density
    [kg/m3] > 0. A rigid body is any large finite Young's modulus.

    rolling_friction, spinning_friction [-] >= 0: a contact resists rolling, and spinning about its normal, up to this
    times contact radius R* times normal force. Source: [Ai-2011], model C.

    cohesion_force [N] >= 0 and surface_energy [J/m2] >= 0: contacts pull with cohesion_force + 4 pi surface_energy R*
    while they last, not beyond. Source: [Derjaguin-1975]. Lunar soil has, by [Perko-2001], a pull
    of 0.036 S^2 R* newtons, S the cleanliness from 0 to 1: a surface energy of 0.0029 S^2 J/m2.

    Raises ValueError outside these ranges.
    """

    young_modulus: float
    poisson_ratio: float
    restitution: float
    friction: float
    density: float
    rolling_friction: float = 0.0
    spinning_friction: float = 0.0
    cohesion_force: float = 0.0
    surface_energy: float = 0.0

    def __post_init__(self) -> None:
        allowed = {
            "young_modulus": (0.0 < self.young_modulus < math.inf, "a finite value above 0 Pa"),
            "poisson_ratio": (0.0 <= self.poisson_ratio < 0.5, "0 <= value < 0.5"),
            "restitution": (0.0 < self.restitution <= 1.0, "0 < value <= 1"),
            "friction": (0.0 <= self.friction < math.inf, "a finite value of at least 0"),
            "density": (0.0 < self.density < math.inf, "a finite value above 0 kg/m3"),
            "rolling_friction": (0.0 <= self.rolling_friction < math.inf, "a finite value of at least 0"),
            "spinning_friction": (0.0 <= self.spinning_friction < math.inf, "a finite value of at least 0"),
            "cohesion_force": (0.0 <= self.cohesion_force < math.inf, "a finite value of at least 0 N"),
            "surface_energy": (0.0 <= self.surface_energy < math.inf, "a finite value of at least 0 J/m2"),
        }
        for name, (fine, text) in allowed.items():
            if not fine:
                raise ValueError(f"Material.{name} is {getattr(self, name)!r}; allowed is {text}: change it")


class PairLaw(NamedTuple):
    """What two touching materials have in common."""

    young_modulus: float  # effective, Pa
    shear_modulus: float  # effective, Pa
    damping_ratio: float  # of the normal contact, -
    shear_damping: float  # dashpot across the normal over that along it, -
    friction: float
    rolling_friction: float
    spinning_friction: float
    cohesion_force: float  # N
    cohesion_line: float  # N/m, to be multiplied by the contact radius


def contact_options(shear_modulus_rule: str, damping_mass: str, pair_rule: str) -> dict[str, str]:
    """Return the options of a world's contacts by name. Raises ValueError for a value that is not allowed."""
    options = {"shear_modulus_rule": shear_modulus_rule, "damping_mass": damping_mass, "pair_rule": pair_rule}
    for (name, value), allowed in zip(options.items(), (SHEAR_MODULUS_RULES, DAMPING_MASSES, PAIR_RULES), strict=True):
        if value not in allowed:
            raise ValueError(f"World {name} is {value!r}; allowed are {', '.join(allowed)}: choose one")
    return options


def restitution_of(damping_ratio: float) -> float:
    """Return the restitution of a Hertz contact with this damping ratio and no attraction.

    With w = sqrt(4 K / 5 m) overlap^(5/4) the damped Hertz collision is the linear oscillator w' = v,
    v' = -w - 2 zeta v, in its own time; contact ends where the total force w + 2 zeta v turns negative.
    Source: substitution of [Schwager-1998], with the no-tension end of [Schwager-2008].
    """
    zeta = damping_ratio
    if zeta == 0.0:
        return 1.0
    if zeta < 1.0:
        omega = math.sqrt(1.0 - zeta * zeta)
        angle = math.atan2(2.0 * zeta * omega, 2.0 * zeta * zeta - 1.0)
        return -math.exp(-zeta * angle / omega) * (math.cos(angle) - zeta * math.sin(angle) / omega)
    if zeta == 1.0:
        return math.exp(-2.0)
    omega = math.sqrt(zeta * zeta - 1.0)
    angle, slowness = 2.0 * math.log(zeta + omega), zeta / omega
    # cosh(angle) - slowness sinh(angle), with 1 - slowness written so that nothing cancels.
    rising = math.exp(angle * (1.0 - slowness)) / (omega * (omega + zeta))
    return 0.5 * (rising - math.exp(-angle * (1.0 + slowness)) * (1.0 + slowness))


@cache
def damping_ratio_of(restitution: float) -> float:
    """Return the damping ratio from which exactly this restitution comes out, at every speed."""
    if restitution == 1.0:
        return 0.0
    upper = 1.0
    while restitution_of(upper) > restitution:
        upper *= 2.0
    return float(brentq(lambda zeta: restitution_of(zeta) - restitution, 0.0, upper, xtol=1e-15, rtol=1e-14))


def pair_value(a: float, b: float, rule: str) -> float:
    """Combine a property of two materials: the smaller, the mean or the geometric mean."""
    if rule == "smaller":
        return min(a, b)
    return 0.5 * (a + b) if rule == "mean" else math.sqrt(a * b)


def pair_law(a: Material, b: Material, shear_modulus_rule: str = "mindlin", pair_rule: str = "smaller") -> PairLaw:
    """Return the effective moduli, damping ratio, frictions and cohesion of two materials.

    The "paper" rule takes the shear modulus as [Landings-PCE] prints it, 1.1 to 1.6 times too stiff.
    Source: [Hertz-1882]; [Mindlin-1949], 1/G* = sum 2 (2 - nu)(1 + nu)/E; [Landings-PCE], Eqs 7 and 8.
    """
    young = 1.0 / sum((1.0 - m.poisson_ratio**2) / m.young_modulus for m in (a, b))
    if shear_modulus_rule == "mindlin":
        shear = 1.0 / sum(2.0 * (2.0 - m.poisson_ratio) * (1.0 + m.poisson_ratio) / m.young_modulus for m in (a, b))
    else:
        shear = 1.0 / sum(2.0 * (2.0 + m.poisson_ratio) * (1.0 - m.poisson_ratio) / m.young_modulus for m in (a, b))
    shared = {
        name: pair_value(getattr(a, name), getattr(b, name), pair_rule)
        for name in (
            "restitution", "friction", "rolling_friction", "spinning_friction", "cohesion_force", "surface_energy"
        )
    }  # fmt: skip
    return PairLaw(
        young, shear, damping_ratio_of(shared["restitution"]), 2.0 * math.sqrt(shear / young), shared["friction"],
        shared["rolling_friction"], shared["spinning_friction"], shared["cohesion_force"],
        4.0 * math.pi * shared["surface_energy"],
    )  # fmt: skip
