"""When two bodies in motion could touch: bounds on how soon a gap closes, of a pair and of its features."""

from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, Pairs, Planes, both_roundings, both_shapes, first_shape
from lithobrake.dem.bodies.vectors import cross, dot, minus, plus, row, scaled, times, way_between
from lithobrake.dem.local_stepping.free_motion import (
    Flight,
    Rules,
    relative_surge,
    spin_bound,
    spin_of,
    turning_speed,
)
from lithobrake.dem.narrow_phase.contact_patch import measure_feature, sphere_centres
from lithobrake.dem.narrow_phase.feature_distance import SPHERES, feature_indices, feature_kind, listed_feature
from lithobrake.dem.narrow_phase.feature_list import travelled
from lithobrake.vocabulary.array_types import Vector


@kernel
def time_to_close(gap: float, speed: float, acceleration: float) -> float:
    """Return the shortest time [s] in which a gap [m] closes at a speed [m/s] under an acceleration [m/s2]."""
    fastest = speed + (speed * speed + 2.0 * acceleration * gap) ** 0.5
    return 2.0 * gap / fastest if fastest > 0.0 else np.inf


class Approach(NamedTuple):
    gap: float  # m, of the feature that may touch first; not above 0 where one touches
    speed: float  # m/s, at which that one meets at most while the plans hold
    time: float  # s, before which none touches


@kernel
def closing_speed(bodies: Bodies, flight: Flight, first: int, second: int) -> float:
    """Return a bound on the speed at which the surfaces of two near each other while their plans hold [m/s]."""
    turning = turning_speed(bodies, flight, first)
    between, slack = row(bodies.velocity, first), flight.slack[first]
    if second >= 0:
        turning += turning_speed(bodies, flight, second)
        between = minus(between, row(bodies.velocity, second))
        slack += flight.slack[second]
    return dot(between, between) ** 0.5 + turning + slack


@kernel
def closing_acceleration(bodies: Bodies, flight: Flight, first: int, second: int, speed: float, rules: Rules) -> float:
    """Return a bound on how the speed at which a feature closes grows [m/s2]; speed: at which any closes at most [m/s].

    In the frame of a face: the fall, the turning of either's points, and what the turning of the face, and of the
    frame, adds.
    """
    spin = spin_bound(bodies, flight, first)
    acceleration = relative_surge(bodies, flight, first, second, rules) + 2.0 * rules.rate * speed
    acceleration += 2.0 * spin * (turning_speed(bodies, flight, first) + speed)
    if second < 0:
        return acceleration
    spin = spin_bound(bodies, flight, second)
    return acceleration + 2.0 * spin * (turning_speed(bodies, flight, second) + speed)


@kernel
def sooner(approach: Approach, gap: float, closing: float, slack: float, acceleration: float) -> Approach:
    """Return the sooner of an approach and of a feature at a gap [m] that closes at a speed and a slack [m/s]."""
    speed = max(closing, 0.0) + slack
    time = time_to_close(max(gap, 0.0), speed, acceleration)
    if gap > 0.0 and time >= approach.time:
        return approach
    return Approach(gap, speed + acceleration * time if time < np.inf else 0.0, time)


@kernel
def approach_of(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, flight: Flight, rules: Rules
) -> Approach:
    """Return how near a pair is to touching, from the features that are listed and the motion of either."""
    first, second = pairs.first[pair], pairs.second[pair]
    # What is not listed is farther away than the motion for which the list still serves.
    left, speed = pairs.wake[pair] - travelled(bodies, first, second), closing_speed(bodies, flight, first, second)
    acceleration = closing_acceleration(bodies, flight, first, second, speed, rules)
    if pairs.feature_count[pair] < 0 or left <= 0.0:
        return Approach(0.0, speed, 0.0)
    approach = sooner(Approach(left, 0.0, np.inf), left, speed, 0.0, acceleration)
    if second < 0:
        return approach_to_plane(pair, bodies, cores, planes, pairs, flight, acceleration, approach)
    return approach_to_body(pair, bodies, cores, pairs, flight, acceleration, approach)


@kernel
def approach_to_plane(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, flight: Flight,
    acceleration: float, approach: Approach,
) -> Approach:  # fmt: skip
    body, plane = pairs.first[pair], -1 - pairs.second[pair]
    shape, outward, spin = first_shape(pair, bodies, pairs), row(planes.normal, plane), spin_of(bodies, body)
    level = dot(outward, row(bodies.position, body)) - planes.offset[plane] - cores.rounding[shape]
    for k in range(pairs.feature_count[pair]):
        corner = row(cores.vertex, cores.vertex_start[shape] + feature_indices(listed_feature(pair, pairs, k))[0])
        arm = times(bodies.rotation, body, corner)
        closing = -dot(outward, plus(row(bodies.velocity, body), cross(spin, arm)))
        approach = sooner(approach, level + dot(outward, arm), closing, flight.slack[body], acceleration)
    return approach


@kernel
def approach_to_body(
    pair: int, bodies: Bodies, cores: Cores, pairs: Pairs, flight: Flight, acceleration: float, approach: Approach
) -> Approach:
    first, second = pairs.first[pair], pairs.second[pair]
    apart, shapes = way_between(bodies, first, second), both_shapes(pair, bodies, pairs)
    between = minus(row(bodies.velocity, second), row(bodies.velocity, first))
    slack, left = flight.slack[first] + flight.slack[second], approach.gap
    if feature_kind(pairs.feature[pair, 0]) == SPHERES:
        return approach_of_spheres(pair, bodies, cores, pairs, between, slack, acceleration, approach)
    reach = both_roundings(cores, shapes)
    spin, other_spin = spin_of(bodies, first), spin_of(bodies, second)
    for k in range(pairs.feature_count[pair]):
        feature = listed_feature(pair, pairs, k)
        on_first, normal, distance = measure_feature(
            bodies, cores, feature, (first, second), shapes, apart, reach + left
        )
        if distance < reach + left:
            on_second = minus(plus(on_first, scaled(distance, normal)), apart)
            moving = plus(between, minus(cross(other_spin, on_second), cross(spin, on_first)))
            approach = sooner(approach, distance - reach, -dot(moving, normal), slack, acceleration)
            if approach.gap <= 0.0:
                break
    return approach


@kernel
def approach_of_spheres(
    pair: int, bodies: Bodies, cores: Cores, pairs: Pairs, between: Vector, slack: float, acceleration: float,
    approach: Approach,
) -> Approach:  # fmt: skip
    """Return the sooner of an approach and of two spheres whose bodies move against each other, `between` [m/s]."""
    first, second = pairs.first[pair], pairs.second[pair]
    centre, apart, central = sphere_centres(pair, bodies, cores, pairs)
    # A ball about its centre of mass turns without moving its surface; one off the centre is carried round.
    if not central:
        arm = minus(centre, row(bodies.position, first))
        other_arm = minus(plus(arm, apart), way_between(bodies, first, second))
        turning = minus(cross(spin_of(bodies, second), other_arm), cross(spin_of(bodies, first), arm))
        between = plus(between, turning)
    distance = dot(apart, apart) ** 0.5
    radius = bodies.contact_radius
    gap = distance - radius[pairs.first_part[pair]] - radius[pairs.second_part[pair]]
    return sooner(approach, gap, -dot(between, apart) / distance if distance > 0.0 else 0.0, slack, acceleration)
