"""Contact law: Hertz with damping that gives the entered restitution, and a Coulomb-limited tangential spring.

Source: the paper, Eqs (1) to (9), with the readings argued for in docs/validation; Mindlin (1949); the no-tension end of
contact and the damping that makes up for it, see material.restitution_of.
"""

from typing import NamedTuple

from lithobrake.compiled import kernel
from lithobrake.dem.arrays import Bodies, Cores, Floats, Laws, Pairs, Planes
from lithobrake.dem.distance import Search
from lithobrake.dem.geometry import touch_bodies, touch_plane
from lithobrake.dem.vectors import Vector, add, cross, dot, minus, plus, put, row, scaled, times

DAMPING, FRICTION, FREQUENCY_SQUARED = 0, 1, 2


class Step(NamedTuple):
    """What a step needs beside the arrays."""

    time_step: float  # s
    drag: float  # 1/s, viscous damping of all motion, 0 but in settling
    gravity: Vector  # m/s2
    paper_mass: bool  # damping with the reduced mass of the bodies, not the mass seen at the contact point


@kernel
def point_velocity(linear: Floats, spin: Floats, body: int, arm: Vector) -> Vector:
    """Return the velocity of the body's material at an arm from its centroid."""
    return plus(row(linear, body), cross(row(spin, body), arm))


@kernel
def inverse_mass_at(bodies: Bodies, body: int, arm: Vector, normal: Vector, paper_mass: bool) -> float:
    """Return one over the mass that a force along the normal meets at the contact point, n . W . n."""
    if paper_mass:
        return 1.0 / bodies.mass[body]
    turn = cross(arm, normal)
    return 1.0 / bodies.mass[body] + dot(turn, times(bodies.inverse_inertia, body, turn))


@kernel
def turned_spring(pairs: Pairs, pair: int, normal: Vector, twist: float) -> Vector:
    """Return the spring force carried along with the contact frame: turned with the normal and the mean spin about it."""
    spring = row(pairs.spring, pair)
    square = dot(spring, spring)
    if square == 0.0:
        return spring
    turn = plus(cross(row(pairs.normal, pair), normal), scaled(twist, normal))
    spring = plus(spring, cross(turn, spring))
    spring = minus(spring, scaled(dot(spring, normal), normal))
    left = dot(spring, spring)
    return scaled((square / left) ** 0.5, spring) if left > 0.0 else (0.0, 0.0, 0.0)


@kernel
def rescaled_spring(spring: Vector, stiffness_before: float, stiffness: float, totals: Floats) -> Vector:
    """Shrink the spring force with its stiffness on unloading, so that no cycle gains energy; book what is lost."""
    if stiffness_before == 0.0:
        return spring
    square = dot(spring, spring)
    if stiffness < stiffness_before:
        share = stiffness / stiffness_before
        totals[FRICTION] += 0.5 * square / stiffness_before * (1.0 - share)
        return scaled(share, spring)
    totals[FRICTION] += 0.5 * square * (1.0 / stiffness_before - 1.0 / stiffness)
    return spring


@kernel
def part(pairs: Pairs, pair: int, totals: Floats) -> None:
    """End a contact: the spring lets go."""
    if pairs.tangential_stiffness[pair] > 0.0:
        spring = row(pairs.spring, pair)
        totals[FRICTION] += 0.5 * dot(spring, spring) / pairs.tangential_stiffness[pair]
        put(pairs.spring, pair, (0.0, 0.0, 0.0))
        put(pairs.tangential_force, pair, (0.0, 0.0, 0.0))
    pairs.tangential_stiffness[pair] = 0.0
    pairs.overlap[pair] = 0.0
    pairs.normal_force[pair] = 0.0
    pairs.elastic_force[pair] = 0.0


@kernel
def act(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, search: Search,
    totals: Floats,
) -> None:  # fmt: skip
    """Compute the contact force of one pair and add it to its members."""
    first, second = pairs.first[pair], pairs.second[pair]
    is_body = second >= 0
    if is_body:
        overlap, normal, point = touch_bodies(bodies, cores, pairs, pair, search)
    else:
        overlap, normal, point = touch_plane(bodies, cores, planes, first, -1 - second)
    if overlap <= 0.0:
        part(pairs, pair, totals)
        return
    arm = minus(point, row(bodies.position, first))
    inverse_mass = inverse_mass_at(bodies, first, arm, normal, step.paper_mass)
    curvature = 1.0 / bodies.contact_radius[first]
    now = scaled(-1.0, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, first, arm))
    moved = scaled(-1.0, point_velocity(bodies.velocity, bodies.half_spin, first, arm))
    twist = 0.5 * dot(row(bodies.half_spin, first), normal)
    other_arm = arm
    if is_body:
        other_arm = minus(point, row(bodies.position, second))
        inverse_mass += inverse_mass_at(bodies, second, other_arm, normal, step.paper_mass)
        curvature += 1.0 / bodies.contact_radius[second]
        now = plus(now, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, second, other_arm))
        moved = plus(moved, point_velocity(bodies.velocity, bodies.half_spin, second, other_arm))
        twist += 0.5 * dot(row(bodies.half_spin, second), normal)
    here, there = bodies.material[first], bodies.material[second] if is_body else planes.material[-1 - second]
    damping_ratio, friction = laws.damping_ratio[here, there], laws.friction[here, there]
    # The root is taken of the product: a length scaled by a power of two then scales every bit.
    root = (overlap / curvature) ** 0.5
    stiffness = 4.0 / 3.0 * laws.young_modulus[here, there] * root
    shear_stiffness = 8.0 * laws.shear_modulus[here, there] * root
    totals[FREQUENCY_SQUARED] = max(totals[FREQUENCY_SQUARED], 1.5 * stiffness * inverse_mass)

    elastic = stiffness * overlap
    speed = dot(now, normal)
    force = max(0.0, elastic - 2.0 * damping_ratio * (1.25 * stiffness / inverse_mass) ** 0.5 * speed)
    totals[DAMPING] += (elastic - force) * speed * step.time_step

    spring = turned_spring(pairs, pair, normal, twist * step.time_step)
    spring = rescaled_spring(spring, pairs.tangential_stiffness[pair], shear_stiffness, totals)
    slip = minus(moved, scaled(dot(moved, normal), normal))
    spring = minus(spring, scaled(shear_stiffness * step.time_step, slip))
    limit, stretch = friction * force, dot(spring, spring) ** 0.5
    if stretch > limit:
        totals[FRICTION] += limit * (stretch - limit) / shear_stiffness
        spring = scaled(limit / stretch, spring)
    sliding = minus(now, scaled(speed, normal))
    dashpot = 2.0 * damping_ratio * (5.0 / 6.0 * shear_stiffness / inverse_mass) ** 0.5
    tangential = minus(spring, scaled(dashpot, sliding))
    pull = dot(tangential, tangential) ** 0.5
    if pull > limit:
        tangential = scaled(limit / pull, tangential)
    totals[DAMPING] += dot(minus(spring, tangential), sliding) * step.time_step

    pairs.overlap[pair], pairs.normal_force[pair], pairs.elastic_force[pair] = overlap, force, elastic
    pairs.tangential_stiffness[pair] = shear_stiffness
    put(pairs.normal, pair, normal)
    put(pairs.point, pair, point)
    put(pairs.spring, pair, spring)
    put(pairs.tangential_force, pair, tangential)
    total = plus(scaled(force, normal), tangential)
    add(bodies.force, first, -1.0, total)
    add(bodies.torque, first, -1.0, cross(arm, total))
    if is_body:
        add(bodies.force, second, 1.0, total)
        add(bodies.torque, second, 1.0, cross(other_arm, total))
