"""What two materials have in common, and the damping ratio from which their restitution comes out."""

import math
from collections.abc import Callable, Sequence
from functools import cache
from typing import NamedTuple

from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Bodies, Laws, Pairs, Planes
from lithobrake.vocabulary.field_errors import FieldError
from lithobrake.vocabulary.material_properties import SHARED_PROPERTIES, Material

SHEAR_MODULUS_RULES = ("mindlin", "paper")
PAIR_RULES = ("smaller", "mean", "geometric")
DAMPING_MASSES = ("contact", "paper")
TANGENTIAL_DASHPOTS = ("mindlin", "none")
# Pressure at the middle of a contact over the strength of what yields there. Source: [Johnson-1985], chapter 6.
YIELD_PRESSURE = 1.6


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
    return _damping_of(restitution, restitution_of, 1e-15, 1e-14)


def _damping_of(restitution: float, law: Callable[[float], float], xtol: float, rtol: float) -> float:
    """Return the damping from which a restitution comes out by a law that falls from 1 towards 0 without end."""
    if restitution == 1.0:
        return 0.0
    # No bound serves for all.
    upper = 1.0
    while law(upper) > restitution:
        upper *= 2.0
    return float(brentq(lambda damping: law(damping) - restitution, 0.0, upper, xtol=xtol, rtol=rtol))


def viscous_restitution_of(viscosity: float) -> float:
    """Return the restitution of a viscoelastic Hertz contact without attraction.

    viscosity: A (K / m)^(2/5) v^(1/5) of a force K (D^(3/2) + 3/2 A D^(1/2) dD/dt) at a speed v. With overlaps in units
    of (m v^2 / K)^(2/5) and speeds in units of v, x'' = -x^(3/2) - 3/2 viscosity x^(1/2) x', until the force turns
    negative.
    Source: [Brilliantov-1996]; the end of the contact of [Schwager-2008].
    """

    def moving(time: float, state: Sequence[float]) -> tuple[float, float]:
        x, speed = max(state[0], 0.0), state[1]
        return speed, -math.sqrt(x) * (x + 1.5 * viscosity * speed)

    def lets_go(time: float, state: Sequence[float]) -> float:
        return float(state[0] + 1.5 * viscosity * state[1])

    lets_go.terminal, lets_go.direction = True, -1  # type: ignore[attr-defined]
    begin = 1e-9
    found = solve_ivp(moving, (0.0, 1e6), (begin, 1.0), events=lets_go, rtol=1e-10, atol=1e-13, method="LSODA")
    return -float(found.y[1, -1])


@cache
def viscosity_ratio_of(restitution: float) -> float:
    """Return the viscosity from which this restitution comes out."""
    return _damping_of(restitution, viscous_restitution_of, 1e-9, 1e-9)


def viscosity(young_modulus: float, restitution: float, speed: float) -> float:
    """Return PairLaw.viscosity of an effective modulus [Pa] whose restitution is that of a speed [m/s]; 0: of all."""
    if speed == 0.0:
        return 0.0
    stiffness = 4.0 / 3.0 * young_modulus
    return 1.5 * viscosity_ratio_of(restitution) * float(speed**-0.2 * stiffness**-0.4)


class PairLaw(NamedTuple):
    young_modulus: float  # effective, Pa
    shear_modulus: float  # effective, Pa
    damping_ratio: float  # of the normal contact, -
    shear_damping: float  # dashpot across the normal over that along it, -
    friction: float
    rolling_friction: float
    spinning_friction: float
    cohesion_force: float  # N
    cohesion_line: float  # N/m, to be multiplied by the contact radius
    yield_pressure: float  # Pa, at the middle of a contact; 0: it does not yield
    # Dashpot over secant [s] of a viscoelastic contact, over (mass / root of the contact radius)^0.4; 0: the damping
    # ratio holds at all speeds.
    viscosity: float


def contact_options(
    shear_modulus_rule: str, damping_mass: str, pair_rule: str, tangential_dashpot: str = "mindlin"
) -> dict[str, str]:
    """Return the options of a world's contacts by name. Raises ValueError for a value that is not allowed."""
    options = {
        "shear_modulus_rule": shear_modulus_rule, "damping_mass": damping_mass, "pair_rule": pair_rule,
        "tangential_dashpot": tangential_dashpot,
    }  # fmt: skip
    every = (SHEAR_MODULUS_RULES, DAMPING_MASSES, PAIR_RULES, TANGENTIAL_DASHPOTS)
    for (name, value), allowed in zip(options.items(), every, strict=True):
        if value not in allowed:
            raise FieldError(f"World.{name}", value, f"are {', '.join(allowed)}", "choose one")
    return options


def pair_value(a: float, b: float, rule: str) -> float:
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
    shared = {name: pair_value(getattr(a, name), getattr(b, name), pair_rule) for name in SHARED_PROPERTIES}
    # A rough floor holds a bed on a slope that is steeper than the friction of its grains, against any rule for pairs.
    if a.rough or b.rough:
        shared["friction"] = max(one.friction for one in (a, b) if one.rough)
    return PairLaw(
        young, shear, damping_ratio_of(shared["restitution"]), 2.0 * math.sqrt(shear / young), shared["friction"],
        shared["rolling_friction"], shared["spinning_friction"], shared["cohesion_force"],
        4.0 * math.pi * shared["surface_energy"],
        YIELD_PRESSURE * min((m.yield_strength for m in (a, b) if m.yield_strength), default=0.0),
        viscosity(young, shared["restitution"], max(a.restitution_speed, b.restitution_speed)),
    )  # fmt: skip


@kernel
def law_between(pair: int, bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws) -> PairLaw:
    here, other = bodies.material[pairs.first_part[pair]], pairs.second_part[pair]
    there = bodies.material[other] if other >= 0 else planes.material[-1 - other]
    return PairLaw(
        laws.young_modulus[here, there], laws.shear_modulus[here, there], laws.damping_ratio[here, there],
        laws.shear_damping[here, there], laws.friction[here, there], laws.rolling_friction[here, there],
        laws.spinning_friction[here, there], laws.cohesion_force[here, there], laws.cohesion_line[here, there],
        laws.yield_pressure[here, there], laws.viscosity[here, there],
    )  # fmt: skip
