"""How far a lander of several parts reaches from its centre of mass, found before anything runs."""

import math
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import NamedTuple

from lithobrake.study.lander_section import LanderSection, PartSection
from lithobrake.study.quantity import reach, usual_reach

Place = tuple[float, float, float]


class Solid(NamedTuple):
    """A convex shape in the axes of the lander: all within a radius [m] of these points [m], its volume [m3] and its
    centroid [m].
    """

    points: list[Place]
    radius: float
    volume: float
    centroid: Place


def solid(section: LanderSection | PartSection, centre: Place = (0.0, 0.0, 0.0)) -> Solid:
    """The solid of a shape about a centre, in the axes of its own. Raises ValueError for a mesh that is refused."""
    if section.edges is not None:
        corners = [(x, y, z) for x, y, z in product(*((-0.5 * edge, 0.5 * edge) for edge in section.edges))]
        return Solid([added(corner, centre) for corner in corners], 0.0, math.prod(section.edges), centre)
    if section.diameter is not None:
        radius = reach(section.diameter)[1] / 2
        return Solid([centre], radius, 4.0 / 3.0 * math.pi * radius**3, centre)
    from lithobrake.touchdown import read_hull

    hull = read_hull(Path(str(section.file)), section.unit)
    points = [added(tuple(vertex), centre) for vertex in hull.vertices.tolist()]
    return Solid(points, 0.0, hull.volume, added(tuple(hull.centroid.tolist()), centre))


def part_solid(section: PartSection) -> Solid:
    """The solid of a part where it stands. Raises ValueError for a mesh that is refused."""
    own = solid(section)
    turned_points = [added(turned(point, section.orientation), section.centre) for point in own.points]
    centroid = added(turned(own.centroid, section.orientation), section.centre)
    return own._replace(points=turned_points, centroid=centroid)


def part_mass(section: PartSection) -> float:
    """Mass of a part [kg]. Raises ValueError for a mesh that is refused."""
    return section.mass if section.mass is not None else (section.density or 0.0) * part_solid(section).volume


def lander_radius(lander: LanderSection) -> float:
    """Largest distance of a point of the lander from its centre of mass [m], at most. Raises ValueError for a mesh that
    is refused.
    """
    own, parts = solid(lander), [part_solid(part) for part in lander.part.values()]
    return max(
        math.dist(point, centre) + one.radius
        for centre in _centres_of_mass(lander, own, parts)
        for one in (own, *parts)
        for point in one.points
    )


def main_radius(lander: LanderSection) -> float:
    """The same of its main shape alone, from its centroid [m]."""
    own = solid(lander)
    return max(math.dist(point, own.centroid) for point in own.points) + own.radius


def _centres_of_mass(lander: LanderSection, own: Solid, parts: list[Solid]) -> Iterator[Place]:
    """The centre of mass at the ends of what is uncertain of it."""
    if lander.centre_of_mass is not None:
        given = lander.centre_of_mass
        yield from product(*(usual_reach(getattr(given, axis)) for axis in "xyz"))
        return
    masses = [part_mass(part) for part in lander.part.values()]
    for whole in usual_reach(lander.mass):
        weights = [whole - sum(masses), *masses]
        x, y, z = (
            sum(weight * one.centroid[axis] for weight, one in zip(weights, (own, *parts), strict=True)) / whole
            for axis in range(3)
        )
        yield x, y, z


def added(one: Place, other: Place) -> Place:
    """The sum of two vectors."""
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]


def turned(point: Place, quaternion: tuple[float, float, float, float]) -> Place:
    """A vector turned by a quaternion w, x, y, z of any length."""
    size = math.hypot(*quaternion)
    w, x, y, z = (part / size for part in quaternion)
    a, b, c = point
    return (
        (1 - 2 * (y * y + z * z)) * a + 2 * (x * y - w * z) * b + 2 * (x * z + w * y) * c,
        2 * (x * y + w * z) * a + (1 - 2 * (x * x + z * z)) * b + 2 * (y * z - w * x) * c,
        2 * (x * z - w * y) * a + 2 * (y * z + w * x) * b + (1 - 2 * (x * x + y * y)) * c,
    )
