"""The force law of a ball in beads, an inertial drag and a friction that grows with depth, fitted to paths.

Deceleration = v^2 / d1 + (k / m) z - g: v the speed, z the depth below the mean surface, d1 the inertial length.

Source: [Katsuragi-2007].
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from fits import Estimate, column
from result_rows import Row
from scipy.optimize import brentq
from scipy.stats import t as student
from sphere_bed import Floats

GRAVITY = 9.81  # m/s2
FEWEST = 3  # drops that are still moving at a depth


class Law(NamedTuple):
    """Inertial length d1 [m] and friction over mass k / m [1/s2]."""

    length: float
    friction: float


LawOf = Callable[[list[Row]], Law]


def moving(looks: list[Row]) -> list[Row]:
    """Return the looks at balls below the mean surface that have not stopped yet."""
    return [row for row in looks if row["speed"] > 0.0 and row["depth"] > 0.0]


def along_paths(looks: list[Row]) -> Law:
    """Return the law that fits the decelerations along whole paths best, by least squares."""
    looks = moving(looks)
    columns = np.stack([column(looks, "speed") ** 2, column(looks, "depth")], axis=1)
    (drag, friction), *_ = np.linalg.lstsq(columns, column(looks, "deceleration") + GRAVITY, rcond=None)
    return Law(1.0 / float(drag), float(friction))


def at_depths(looks: list[Row], first: float, step: float) -> tuple[Law, Floats]:
    """Return the law from means over intervals of depth [m], as the source finds it, and its friction over mass there.

    In each interval the deceleration of all drops is a straight line of the squared speed: of one slope in all
    intervals, 1 / d1, and each with a friction of its own. Friction over depth is the slope of these through 0.
    Returns the law, and depth [m] and friction over mass [m/s2] of each interval in which FEWEST drops move, shape
    [intervals, 2].
    """
    looks = moving(looks)
    found = np.stack(
        [column(looks, "depth"), column(looks, "speed") ** 2, column(looks, "deceleration") + GRAVITY], axis=1
    )
    falls, numbers = column(looks, "fall"), np.floor((found[:, 0] - first) / step)
    kept = []
    for number in np.unique(numbers[numbers >= 0.0]):
        inside = numbers == number
        means = [found[inside & (falls == fall)].mean(axis=0) for fall in np.unique(falls[inside])]
        if len(means) >= FEWEST:
            kept.append(np.array(means))
    middles = np.array([means.mean(axis=0) for means in kept])
    off = np.concatenate([means - means.mean(axis=0) for means in kept])
    drag = float((off[:, 1] * off[:, 2]).sum() / (off[:, 1] ** 2).sum())
    depth, friction = middles[:, 0], middles[:, 2] - drag * middles[:, 1]
    law = Law(1.0 / drag, float((friction * depth).sum() / (depth**2).sum()))
    return law, np.stack([depth, friction], axis=1)


def with_intervals(looks: list[Row], law_of: LawOf) -> tuple[Estimate, Estimate]:
    """Return inertial length and friction over mass, each with its 95 % interval, drops left out in turn."""
    falls = sorted({row["fall"] for row in looks})
    without = np.array([law_of([row for row in looks if row["fall"] != fall]) for fall in falls])
    count = len(falls)
    spread = np.sqrt((count - 1) / count * ((without - without.mean(axis=0)) ** 2).sum(axis=0))
    half = student.ppf(0.975, count - 1) * spread
    length, friction = (Estimate(one, float(wide), count) for one, wide in zip(law_of(looks), half, strict=True))
    return length, friction


def squared_speed(depth: float | Floats, fall: float, law: Law) -> Floats:
    """Return the square of the speed [m2/s2] at a depth [m] of a ball that fell from a height [m] above the surface.

    Closed form: an exponential and a straight line. Below 0 where the ball has stopped.
    """
    slope = -law.friction * law.length
    level = law.length * (GRAVITY - 0.5 * slope)
    return (2.0 * GRAVITY * fall - level) * np.exp(-2.0 * np.asarray(depth) / law.length) + level + slope * depth


def law_time(fall: float, law: Law, still: float) -> float:
    """Return the time [s] from the surface until a ball is slower than a part of its impact speed."""
    least, deepest = still * (2.0 * GRAVITY * fall) ** 0.5, law_depth(fall, law)
    end = float(brentq(lambda depth: float(squared_speed(depth, fall, law)) - least**2, 0.5 * deepest, deepest))
    # In the root of the way that is left, the time is smooth where the ball is slow.
    root = np.linspace(0.0, (deepest**0.5), 20_001)
    depth = deepest - root**2
    inside = depth <= end
    speed = np.sqrt(np.maximum(squared_speed(depth[inside], fall, law), 1e-300))
    return float(np.trapezoid(2.0 * root[inside] / speed, root[inside]))


def law_depth(fall: float, law: Law) -> float:
    """Return the depth [m] at which a ball stops that falls from a height [m] above the surface."""
    deep = 0.01 * law.length
    while squared_speed(deep, fall, law) > 0.0:
        deep *= 2.0
    return float(brentq(squared_speed, 1e-9, deep, args=(fall, law)))
