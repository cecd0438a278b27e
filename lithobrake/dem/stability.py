"""How stiffly its contacts hold a body: what the time step must be short against.

A mode of frequency w [rad/s] and damping rate c [1/s] is stepped stably by the scheme of motion.py while
c dt + (w dt)^2 / 4 <= 1: there the root of its recurrence, 2 z (z - 1)^2 + 2 (w dt)^2 z^2 + 2 c dt z (z - 1)
+ c dt (z - 1)^2 = 0, leaves the unit circle at z = -1. No mode of bodies joined by contacts is faster than what the
contacts of two that touch add up to.

Source: Anderson and Morley (1985), Linear and Multilinear Algebra 18, 141-145, for the bound by two neighbours.
"""

import math
from typing import NamedTuple

import numpy as np

from lithobrake.compiled import kernel
from lithobrake.dem.arrays import Bodies, Floats, Pairs
from lithobrake.dem.distance import Search
from lithobrake.dem.spring import across
from lithobrake.dem.vectors import Vector, cross, dot, minus, row, times

# Largest c dt + (w dt)^2 / 4 that is allowed; 1 is the limit of stability.
STABLE_SHARE = 0.8


class Grip(NamedTuple):
    """How a contact holds its bodies against small changes."""

    normal: float  # N/m
    shear: float  # N/m
    tilt: float  # N m
    normal_dashpot: float  # N s/m
    shear_dashpot: float  # N s/m
    tilt_dashpot: float  # N m s


@kernel
def inverse_masses(bodies: Bodies, body: int, arm: Vector, normal: Vector) -> tuple[float, float, float]:
    """Return what forces along and across (mean of both directions) the normal meet at an arm, 1/kg, and what couples
    across it meet in the mean, 1/(kg m2).
    """
    inverse = bodies.inverse_inertia
    trace = inverse[body, 0, 0] + inverse[body, 1, 1] + inverse[body, 2, 2]
    all_ways = trace * dot(arm, arm) - dot(arm, times(inverse, body, arm))
    lever = cross(arm, normal)
    along = dot(lever, times(inverse, body, lever))
    couple = 0.5 * (trace - dot(normal, times(inverse, body, normal)))
    return bodies.inverse_mass[body] + along, bodies.inverse_mass[body] + 0.5 * (all_ways - along), couple


@kernel
def tilting(search: Search, count: int, centre: Vector, normal: Vector, overlap: float, stiffness: float) -> float:
    """Return the stiffness [N m] of a patch against tilting about the stiffest axis through its centre.

    Second derivative of shares.spread's energy where the points move against each other: each has a share of the
    normal stiffness, 3/2 of the secant `stiffness` [N/m], and seven times the force over its own overlap.
    """
    if count == 1:
        return 0.0
    xx, yy, zz, xy, yz, zx = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(count):
        x, y, z = across(minus(row(search.point, k), centre), normal)
        weight = max(search.share[k], 0.0) * stiffness * (1.5 + 7.0 * overlap / search.depth[k])
        xx, yy, zz = xx + weight * x * x, yy + weight * y * y, zz + weight * z * z
        xy, yz, zx = xy + weight * x * y, yz + weight * y * z, zx + weight * z * x
    both = xx + yy + zz
    squares = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx)
    return 0.5 * (both + max(0.0, 2.0 * squares - both * both) ** 0.5)


@kernel
def held_rates(bodies: Bodies, body: int, point: Vector, normal: Vector, grip: Grip) -> tuple[float, float]:
    """Return what a contact adds to a body's w^2 and c, in the fastest of its directions."""
    arm = minus(point, row(bodies.position, body))
    along, sideways, couple = inverse_masses(bodies, body, arm, normal)
    square = max(grip.normal * along + grip.tilt * couple, grip.shear * sideways)
    return square, max(grip.normal_dashpot * along + grip.tilt_dashpot * couple, grip.shear_dashpot * sideways)


@kernel
def unsteadiness(time_step: float, rates: Floats, pairs: Pairs) -> float:
    """Return the largest c dt + (w dt)^2 / 4 of two that touch."""
    most = 0.0
    for pair in range(len(pairs.first)):
        if pairs.overlap[pair] > 0.0:
            first, second = pairs.first[pair], pairs.second[pair]
            square, damping = rates[first, 0], rates[first, 1]
            if second >= 0:
                square, damping = square + rates[second, 0], damping + rates[second, 1]
            most = max(most, damping * time_step + 0.25 * square * time_step * time_step)
    return most


def largest_step(rates: Floats, pairs: Pairs) -> float:
    """Return the largest safe time step [s], infinite where nothing touches; rates [body_count, 2]."""
    touching = pairs.overlap > 0.0
    first, second = pairs.first[touching], pairs.second[touching]
    both = rates[first] + np.where(second >= 0, 1.0, 0.0)[:, None] * rates[np.maximum(second, 0)]
    square, damping = both[:, 0], both[:, 1]
    most = float((damping + np.sqrt(damping * damping + STABLE_SHARE * square)).max(initial=0.0))
    return 2.0 * STABLE_SHARE / most if most > 0.0 else math.inf
