"""Contact force of a pair: Hertz with damping that gives the entered restitution, cohesion, friction and rolling.

Source: the paper, Eqs (1) to (9), with Mindlin's (1949) shear modulus; the no-tension end of contact and the damping
that makes up for it, see material.restitution_of.
"""

from typing import NamedTuple

from lithobrake.compiled import kernel
from lithobrake.dem.arrays import Bodies, Cores, Floats, Laws, Pairs, Planes
from lithobrake.dem.couples import let_go, resist_rolling, resist_twisting
from lithobrake.dem.distance import Search
from lithobrake.dem.patch import touch_bodies, touch_plane
from lithobrake.dem.shares import EDGES_SUNK, spin_radii, spread
from lithobrake.dem.spring import across, hold, stored, turned_spring
from lithobrake.dem.stability import Grip, hold_body, tilting
from lithobrake.dem.vectors import Vector, add, cross, dot, minus, plus, put, row, scaled, times

DAMPING, FRICTION, ROLLING = 0, 1, 2
TOTALS = 3


class Step(NamedTuple):
    """What a step needs beside the arrays."""

    time_step: float  # s
    drag: float  # 1/s, viscous damping of all motion, 0 but in settling
    gravity: Vector  # m/s2
    paper_mass: bool  # damping with the reduced mass of the bodies, not the mass seen at the contact point


class Meeting(NamedTuple):
    """How the members of a pair move against each other, second against first, at their centre of pressure."""

    inverse_mass: float  # 1/kg, of the pair for a force along the normal
    curvature: float  # 1/m
    now: Vector  # m/s, predicted for the instant of the positions
    moved: Vector  # m/s, that made the last step
    spin: Vector  # rad/s, relative, that made the last step
    twist: float  # rad/s, mean spin about the normal


@kernel
def point_velocity(linear: Floats, spin: Floats, body: int, arm: Vector) -> Vector:
    """Return the velocity of the body's material at an arm from its centroid."""
    return plus(row(linear, body), cross(row(spin, body), arm))


@kernel
def inverse_mass_at(bodies: Bodies, body: int, arm: Vector, normal: Vector, paper_mass: bool) -> float:
    """Return one over the mass that a force along the normal meets at the contact point, n . W . n."""
    if paper_mass:
        return bodies.inverse_mass[body]
    turn = cross(arm, normal)
    return bodies.inverse_mass[body] + dot(turn, times(bodies.inverse_inertia, body, turn))


@kernel
def inverse_inertia_along(bodies: Bodies, first: int, second: int, normal: Vector) -> float:
    """Return what a couple along the normal meets of a pair, 1/(kg m2)."""
    inverse = dot(normal, times(bodies.inverse_inertia, first, normal))
    return inverse + dot(normal, times(bodies.inverse_inertia, second, normal)) if second >= 0 else inverse


@kernel
def inverse_inertia_across(bodies: Bodies, first: int, second: int, normal: Vector) -> float:
    """Return what a couple across the normal meets of a pair in the mean of all directions, 1/(kg m2)."""
    inverse = bodies.inverse_inertia
    trace = inverse[first, 0, 0] + inverse[first, 1, 1] + inverse[first, 2, 2]
    if second >= 0:
        trace += inverse[second, 0, 0] + inverse[second, 1, 1] + inverse[second, 2, 2]
    return 0.5 * (trace - inverse_inertia_along(bodies, first, second, normal))


@kernel
def meet(bodies: Bodies, first: int, second: int, point: Vector, normal: Vector, paper_mass: bool) -> Meeting:
    """Return how a body meets another, or a plane (second < 0)."""
    arm = minus(point, row(bodies.position, first))
    inverse_mass = inverse_mass_at(bodies, first, arm, normal, paper_mass)
    curvature = bodies.curvature[first]
    now = scaled(-1.0, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, first, arm))
    moved = scaled(-1.0, point_velocity(bodies.velocity, bodies.half_spin, first, arm))
    spin = scaled(-1.0, row(bodies.half_spin, first))
    twist = 0.5 * dot(row(bodies.half_spin, first), normal)
    if second >= 0:
        arm = minus(point, row(bodies.position, second))
        inverse_mass += inverse_mass_at(bodies, second, arm, normal, paper_mass)
        curvature += bodies.curvature[second]
        now = plus(now, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, second, arm))
        moved = plus(moved, point_velocity(bodies.velocity, bodies.half_spin, second, arm))
        spin = plus(spin, row(bodies.half_spin, second))
        twist += 0.5 * dot(row(bodies.half_spin, second), normal)
    return Meeting(inverse_mass, curvature, now, moved, spin, twist)


@kernel
def push(bodies: Bodies, first: int, second: int, point: Vector, force: Vector) -> None:
    """Apply a force at a point to the second body, and its opposite to the first."""
    add(bodies.force, first, -1.0, force)
    add(bodies.torque, first, -1.0, cross(minus(point, row(bodies.position, first)), force))
    if second >= 0:
        add(bodies.force, second, 1.0, force)
        add(bodies.torque, second, 1.0, cross(minus(point, row(bodies.position, second)), force))


@kernel
def turn(bodies: Bodies, first: int, second: int, couple: Vector) -> None:
    """Apply a couple to the second body, and its opposite to the first."""
    add(bodies.torque, first, -1.0, couple)
    if second >= 0:
        add(bodies.torque, second, 1.0, couple)


@kernel
def repel(share: float, elastic: float, dashpot: float, speed: float, step: Step, totals: Floats) -> float:
    """Return the repulsion at a point of a patch, which never pulls, and book what its dashpot takes."""
    force = share * max(0.0, elastic - dashpot * speed)
    totals[DAMPING] += (share * elastic - force) * speed * step.time_step
    return force


@kernel
def press(
    search: Search, count: int, bodies: Bodies, first: int, second: int, meeting: Meeting, normal: Vector,
    elastic: float, cohesion: float, dashpot: float, step: Step, totals: Floats,
) -> tuple[float, float, float]:  # fmt: skip
    """Apply the normal forces at the points of a patch: repulsion less cohesion.

    Returns the repulsion and the whole force along the normal, and what is left to apply at the centre: all of it,
    where the patch is one point.
    """
    if count == 1 and search.family[0] != EDGES_SUNK:
        repulsion = repel(search.share[0], elastic, dashpot, dot(meeting.now, normal), step, totals)
        total = repulsion - search.share[0] * cohesion
        return repulsion, total, total
    repulsion, total = 0.0, 0.0
    for k in range(count):
        point, outward = row(search.point, k), row(search.normal, k)
        arm = minus(point, row(bodies.position, first))
        now = scaled(-1.0, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, first, arm))
        if second >= 0:
            other_arm = minus(point, row(bodies.position, second))
            now = plus(now, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, second, other_arm))
        speed = dot(now, outward)
        if search.family[k] == EDGES_SUNK:
            turning = minus(row(bodies.spin_predicted, second), row(bodies.spin_predicted, first))
            speed += dot(turning, row(search.couple, k))
        force = repel(search.share[k], elastic, dashpot, speed, step, totals)
        along = dot(outward, normal)
        repulsion += force * along
        force -= search.share[k] * cohesion
        push(bodies, first, second, point, scaled(force, outward))
        if search.family[k] == EDGES_SUNK:
            turn(bodies, first, second, scaled(force, row(search.couple, k)))
        total += force * along
    return repulsion, total, 0.0


@kernel
def rub(
    pair: int, pairs: Pairs, normal: Vector, meeting: Meeting, limit: float, stiffness: float, dashpot: float,
    step: Step, totals: Floats,
) -> Vector:  # fmt: skip
    """Return the tangential force on the second body, within the Coulomb limit."""
    before = turned_spring(row(pairs.spring, pair), row(pairs.normal, pair), normal, meeting.twist * step.time_step)
    slip = scaled(step.time_step, across(meeting.moved, normal))
    held = hold(
        before, pairs.tangential_stiffness[pair], stiffness, slip, across(meeting.now, normal), dashpot, limit
    )  # fmt: skip
    put(pairs.spring, pair, held.spring)
    pairs.tangential_stiffness[pair] = stiffness
    totals[FRICTION] += held.slid
    totals[DAMPING] += held.damped * step.time_step
    return held.total


@kernel
def part(pairs: Pairs, pair: int, totals: Floats) -> None:
    """End a contact, if there was one: the springs let go."""
    if pairs.overlap[pair] == 0.0:
        return
    spring = row(pairs.spring, pair)
    twisted, rolled = let_go(pair, pairs)
    totals[FRICTION] += stored(dot(spring, spring), pairs.tangential_stiffness[pair]) + twisted
    totals[ROLLING] += rolled
    put(pairs.spring, pair, (0.0, 0.0, 0.0))
    put(pairs.tangential_force, pair, (0.0, 0.0, 0.0))
    pairs.tangential_stiffness[pair] = 0.0
    pairs.overlap[pair] = 0.0
    pairs.normal_force[pair], pairs.elastic_force[pair], pairs.cohesion[pair] = 0.0, 0.0, 0.0


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
        count, sunk, slope = touch_bodies(pair, bodies, cores, pairs, search)
    else:
        count, sunk, slope = touch_plane(pair, bodies, cores, planes, pairs, search), 0.0, 0.0
    if count == 0:
        part(pairs, pair, totals)
        return
    overlap, point, normal = spread(search, count, sunk, slope)
    meeting = meet(bodies, first, second, point, normal, step.paper_mass)
    here, there = bodies.material[first], bodies.material[second] if is_body else planes.material[-1 - second]
    damping_ratio = laws.damping_ratio[here, there]
    # The root is taken of the product: a length scaled by a power of two then scales every bit.
    root = (overlap / meeting.curvature) ** 0.5
    stiffness = 4.0 / 3.0 * laws.young_modulus[here, there] * root
    shear_stiffness = 8.0 * laws.shear_modulus[here, there] * root
    dashpot = 2.0 * damping_ratio * (1.25 * stiffness / meeting.inverse_mass) ** 0.5
    elastic = stiffness * overlap
    cohesion = laws.cohesion_force[here, there] + laws.cohesion_line[here, there] / meeting.curvature
    force, total, left = press(
        search, count, bodies, first, second, meeting, normal, elastic, cohesion, dashpot, step, totals
    )  # fmt: skip
    shear_dashpot = dashpot * laws.shear_damping[here, there]
    limit = laws.friction[here, there] * force
    tangential = rub(pair, pairs, normal, meeting, limit, shear_stiffness, shear_dashpot, step, totals)
    push(bodies, first, second, point, plus(scaled(left, normal), tangential))

    lever = laws.spinning_friction[here, there] / meeting.curvature
    square, mean = spin_radii(search, count, point, normal)
    square += lever * lever
    if square > 0.0 or pairs.twist_stiffness[pair] > 0.0:
        couple, slid, damped = resist_twisting(
            pair, pairs, dot(meeting.spin, normal), limit * mean + force * lever, shear_stiffness * square,
            damping_ratio, inverse_inertia_along(bodies, first, second, normal), step.time_step,
        )  # fmt: skip
        turn(bodies, first, second, scaled(couple, normal))
        totals[FRICTION] += slid
        totals[DAMPING] += damped
    tilt = tilting(search, count, point, normal, overlap, stiffness)
    tilt_dashpot = dashpot * tilt / (8.5 * stiffness)
    lever = laws.rolling_friction[here, there] / meeting.curvature
    if lever > 0.0:
        rolling, lost, rolling_dashpot = resist_rolling(
            pair, pairs, normal, meeting.spin, meeting.twist, lever, force, stiffness, damping_ratio,
            inverse_inertia_across(bodies, first, second, normal), step.time_step,
        )  # fmt: skip
        turn(bodies, first, second, rolling)
        totals[ROLLING] += lost
        tilt += pairs.roll_stiffness[pair]
        tilt_dashpot += rolling_dashpot
    grip = Grip(1.5 * stiffness, shear_stiffness, tilt, dashpot, shear_dashpot, tilt_dashpot)
    hold_body(bodies, first, point, normal, grip)
    if is_body:
        hold_body(bodies, second, point, normal, grip)
    pairs.overlap[pair], pairs.normal_force[pair], pairs.elastic_force[pair] = overlap, total, elastic
    pairs.cohesion[pair] = cohesion
    put(pairs.normal, pair, normal)
    put(pairs.point, pair, point)
    put(pairs.tangential_force, pair, tangential)
