"""Contact law: Hertz with damping that gives the entered restitution, and a Coulomb-limited tangential spring.

Source: the paper, Eqs (1) to (9), with Mindlin's (1949) shear modulus; the no-tension end of contact and the damping
that makes up for it, see material.restitution_of.
"""

from typing import NamedTuple

import numpy as np

from lithobrake.compiled import kernel
from lithobrake.dem.arrays import Bodies, Cores, Floats, Laws, Pairs, Planes
from lithobrake.dem.distance import Search
from lithobrake.dem.patch import spin_radii, spread, touch_bodies, touch_plane
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
    """Return the spring force turned with the contact frame: with the normal, and with the mean spin about it."""
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
def unloaded(stiffness_before: float, stiffness: float) -> float:
    """Return what is left of a spring's force when its stiffness falls: so no cycle of loading gains energy."""
    return min(1.0, stiffness / stiffness_before) if stiffness_before > 0.0 else 1.0


@kernel
def stored(force_squared: float, stiffness: float) -> float:
    """Return the energy of a spring under a force."""
    return 0.5 * force_squared / stiffness if stiffness > 0.0 else 0.0


@kernel
def part(pairs: Pairs, pair: int, totals: Floats) -> None:
    """End a contact: the spring lets go."""
    if pairs.tangential_stiffness[pair] > 0.0:
        spring = row(pairs.spring, pair)
        totals[FRICTION] += stored(dot(spring, spring), pairs.tangential_stiffness[pair])
        put(pairs.spring, pair, (0.0, 0.0, 0.0))
        put(pairs.tangential_force, pair, (0.0, 0.0, 0.0))
    totals[FRICTION] += stored(pairs.twist[pair] ** 2, pairs.twist_stiffness[pair])
    pairs.twist[pair], pairs.twist_stiffness[pair] = 0.0, 0.0
    pairs.tangential_stiffness[pair] = 0.0
    pairs.overlap[pair] = 0.0
    pairs.normal_force[pair] = 0.0
    pairs.elastic_force[pair] = 0.0


@kernel
def press(
    search: Search, count: int, bodies: Bodies, first: int, second: int, elastic: float, dashpot: float, step: Step,
    totals: Floats,
) -> float:  # fmt: skip
    """Apply the normal forces at the points of a patch, none of them pulling; return their sum."""
    total = 0.0
    for k in range(count):
        point, normal = row(search.point, k), row(search.normal, k)
        arm = minus(point, row(bodies.position, first))
        now = scaled(-1.0, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, first, arm))
        if second >= 0:
            other_arm = minus(point, row(bodies.position, second))
            now = plus(now, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, second, other_arm))
        speed = dot(now, normal)
        force = search.share[k] * max(0.0, elastic - dashpot * speed)
        totals[DAMPING] += (search.share[k] * elastic - force) * speed * step.time_step
        push(bodies, first, second, point, scaled(force, normal))
        total += force
    return total


@kernel
def push(bodies: Bodies, first: int, second: int, point: Vector, force: Vector) -> None:
    """Apply a force at a point to the second body, and its opposite to the first."""
    add(bodies.force, first, -1.0, force)
    add(bodies.torque, first, -1.0, cross(minus(point, row(bodies.position, first)), force))
    if second >= 0:
        add(bodies.force, second, 1.0, force)
        add(bodies.torque, second, 1.0, cross(minus(point, row(bodies.position, second)), force))


@kernel
def rub(
    pair: int, pairs: Pairs, normal: Vector, moved: Vector, now: Vector, twist: float, limit: float, stiffness: float,
    dashpot: float, step: Step, totals: Floats,
) -> Vector:  # fmt: skip
    """Return the tangential force on the second body: a spring with history and a dashpot, within the Coulomb limit.

    Friction is booked as what the spring was given and did not keep: by sliding, and by changes of its stiffness.
    """
    before, stiffness_before = (
        turned_spring(pairs, pair, normal, twist * step.time_step),
        pairs.tangential_stiffness[pair],
    )
    slip = scaled(step.time_step, minus(moved, scaled(dot(moved, normal), normal)))
    spring = minus(scaled(unloaded(stiffness_before, stiffness), before), scaled(stiffness, slip))
    stretch = dot(spring, spring) ** 0.5
    if stretch > limit:
        spring = scaled(limit / stretch, spring)
    given = stored(dot(before, before), stiffness_before) - 0.5 * dot(plus(before, spring), slip)
    totals[FRICTION] += given - stored(dot(spring, spring), stiffness)
    put(pairs.spring, pair, spring)
    pairs.tangential_stiffness[pair] = stiffness
    sliding = minus(now, scaled(dot(now, normal), normal))
    tangential = minus(spring, scaled(dashpot, sliding))
    pull = dot(tangential, tangential) ** 0.5
    if pull > limit:
        tangential = scaled(limit / pull, tangential)
    totals[DAMPING] += dot(minus(spring, tangential), sliding) * step.time_step
    return tangential


@kernel
def wring(
    pair: int, pairs: Pairs, spin: float, limit: float, stiffness: float, dashpot: float, step: Step, totals: Floats
) -> float:
    """Return the couple about the normal on the second body: a spring with history and a dashpot, within a limit.

    A patch of more than one point resists twisting as its points would, each with its share of the tangential spring.
    """
    before, stiffness_before = pairs.twist[pair], pairs.twist_stiffness[pair]
    turn = spin * step.time_step
    couple = min(max(unloaded(stiffness_before, stiffness) * before - stiffness * turn, -limit), limit)
    given = stored(before * before, stiffness_before) - 0.5 * (before + couple) * turn
    totals[FRICTION] += given - stored(couple * couple, stiffness)
    pairs.twist[pair], pairs.twist_stiffness[pair] = couple, stiffness
    total = min(max(couple - dashpot * spin, -limit), limit)
    totals[DAMPING] += (couple - total) * spin * step.time_step
    return total


@kernel
def act(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, search: Search,
    totals: Floats,
) -> None:  # fmt: skip
    """Compute the contact force of one pair and add it to its members."""
    first, second = pairs.first[pair], pairs.second[pair]
    is_body = second >= 0
    if pairs.term_count[pair] == 0:
        part(pairs, pair, totals)
        return
    if is_body:
        count = touch_bodies(pair, bodies, cores, pairs, search)
        rounding = cores.rounding[bodies.shape[first]] + cores.rounding[bodies.shape[second]]
    else:
        count, rounding = touch_plane(pair, bodies, cores, planes, pairs, search), np.inf
    if count == 0:
        part(pairs, pair, totals)
        return
    overlap, point, normal = spread(search, count, rounding)
    arm = minus(point, row(bodies.position, first))
    inverse_mass = inverse_mass_at(bodies, first, arm, normal, step.paper_mass)
    curvature = 1.0 / bodies.contact_radius[first]
    now = scaled(-1.0, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, first, arm))
    moved = scaled(-1.0, point_velocity(bodies.velocity, bodies.half_spin, first, arm))
    twist = 0.5 * dot(row(bodies.half_spin, first), normal)
    if is_body:
        arm = minus(point, row(bodies.position, second))
        inverse_mass += inverse_mass_at(bodies, second, arm, normal, step.paper_mass)
        curvature += 1.0 / bodies.contact_radius[second]
        now = plus(now, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, second, arm))
        moved = plus(moved, point_velocity(bodies.velocity, bodies.half_spin, second, arm))
        twist += 0.5 * dot(row(bodies.half_spin, second), normal)
    here, there = bodies.material[first], bodies.material[second] if is_body else planes.material[-1 - second]
    damping_ratio = laws.damping_ratio[here, there]
    # The root is taken of the product: a length scaled by a power of two then scales every bit.
    root = (overlap / curvature) ** 0.5
    stiffness = 4.0 / 3.0 * laws.young_modulus[here, there] * root
    shear_stiffness = 8.0 * laws.shear_modulus[here, there] * root
    rate = 1.5 * stiffness * inverse_mass * max(1.0, 2.0 * damping_ratio) ** 2
    totals[FREQUENCY_SQUARED] = max(totals[FREQUENCY_SQUARED], rate)

    dashpot = 2.0 * damping_ratio * (1.25 * stiffness / inverse_mass) ** 0.5
    elastic = stiffness * overlap
    force = press(search, count, bodies, first, second, elastic, dashpot, step, totals)
    shear_dashpot = 2.0 * damping_ratio * (5.0 / 6.0 * shear_stiffness / inverse_mass) ** 0.5
    limit = laws.friction[here, there] * max(0.0, force)
    tangential = rub(pair, pairs, normal, moved, now, twist, limit, shear_stiffness, shear_dashpot, step, totals)
    push(bodies, first, second, point, tangential)
    square, mean = spin_radii(search, count, point, normal)
    if square > 0.0 or pairs.twist_stiffness[pair] > 0.0:
        turn = -dot(row(bodies.half_spin, first), normal)
        if is_body:
            turn += dot(row(bodies.half_spin, second), normal)
        couple = wring(pair, pairs, turn, limit * mean, shear_stiffness * square, shear_dashpot * square, step, totals)
        add(bodies.torque, first, -couple, normal)
        if is_body:
            add(bodies.torque, second, couple, normal)
    pairs.overlap[pair], pairs.normal_force[pair], pairs.elastic_force[pair] = overlap, force, elastic
    put(pairs.normal, pair, normal)
    put(pairs.point, pair, point)
    put(pairs.tangential_force, pair, tangential)
