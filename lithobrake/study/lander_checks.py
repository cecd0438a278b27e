"""What is wrong with the shapes, masses and inertia of a lander, and how far its parts reach."""

import math
import os
import re
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import NamedTuple

from lithobrake.study.lander_section import LanderSection, PartSection
from lithobrake.study.quantity import Uncertain, reach, usual_reach
from lithobrake.vocabulary.plain_text import show

Place = tuple[float, float, float]
# Of what a user names.
NAME = r"[\w-]+"
# Thinner boxes are slips, and no equation of motion can be solved for them.
THINNEST = 1e-3
# Mass anywhere adds at most as much to one moment of inertia as to the other two; a plate may miss that by rounding.
ROUNDING = 1e-9
# An attitude is scaled to length 1; one so much longer or shorter is a slip, and its square may not be a number.
LONGEST_QUATERNION = 1e3
TAKES = {"box": "edges", "sphere": "diameter", "hull": "file"}


class Solid(NamedTuple):
    """A convex shape in the axes of the lander: all within a radius [m] of these points [m], its volume [m3] and its
    centroid [m].
    """

    points: list[Place]
    radius: float
    volume: float
    centroid: Place


def solid(section: LanderSection | PartSection) -> Solid:
    """The solid of a shape about its centre, in the axes of its own. Raises ValueError for a mesh that is refused."""
    centre = (0.0, 0.0, 0.0)
    if section.edges is not None:
        corners = [(x, y, z) for x, y, z in product(*((-0.5 * edge, 0.5 * edge) for edge in section.edges))]
        return Solid(corners, 0.0, math.prod(section.edges), centre)
    if section.diameter is not None:
        radius = reach(section.diameter)[1] / 2
        return Solid([centre], radius, 4.0 / 3.0 * math.pi * radius**3, centre)
    from lithobrake.dem import read_hull

    hull = read_hull(Path(str(section.file)), section.unit)
    return Solid(list(map(tuple, hull.vertices.tolist())), 0.0, hull.volume, tuple(hull.centroid.tolist()))


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
        # The distance of a point is a convex function of the centre, so its largest value is at a corner of the box of
        # centres.
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


def shape_problems(path: str, section: LanderSection | PartSection) -> Iterator[str]:
    """Keys that do not go with a shape, and a file that is not there; path: dotted name of the table."""
    needed = TAKES[section.shape]
    for key in TAKES.values():
        if (getattr(section, key) is None) == (key == needed):
            verb = "is missing" if key == needed else "does not go with this shape"
            yield f'{path}.{key} {verb}; allowed: shape = "{section.shape}" takes {needed} and no other of these'
    if section.shape == "hull" and section.file is not None and not os.path.isfile(section.file):
        yield f"{path}.file is {show(section.file)}; no such file; give the path of an OBJ or STL mesh"
    if section.unit != "m" and section.file is None:
        yield f'{path}.unit is "{section.unit}", and there is no {path}.file; a unit goes with a mesh: leave it out'
    if section.edges is not None and min(section.edges) < THINNEST * max(section.edges):
        shown = ", ".join(f"{edge:g}" for edge in section.edges)
        yield (
            f"{path}.edges is [{shown}] m; allowed: the shortest at least {THINNEST:g} of the longest, "
            f"{THINNEST * max(section.edges):g} m; thicken the box"
        )


def part_problems(lander: LanderSection) -> Iterator[str]:
    """Parts without a shape, an attitude or a mass, each by itself."""
    for name, part in lander.part.items():
        path = f"lander.part.{name}"
        if not re.fullmatch(NAME, name):
            yield f"{path} is no name; allowed: letters, digits, _ and -; rename it"
        yield from shape_problems(path, part)
        if (part.mass is None) == (part.density is None):
            both = "both are" if part.mass is not None else "neither is"
            yield f"{path} takes mass or density, and {both} given; keep one of the two"
        yield from quaternion_problems(f"{path}.orientation", part.orientation)
        if part.hinge is not None and (part.hinge.frequency is None) == (part.hinge.stiffness is None):
            both = "both are" if part.hinge.stiffness is not None else "neither is"
            yield f"{path}.hinge takes frequency or stiffness, and {both} given; keep one of the two"
    if lander.part and isinstance(lander.diameter, Uncertain):
        yield (
            "lander.diameter is uncertain, and the lander has parts, which stand at fixed places; allowed: one number; "
            "write it, or make a study for each"
        )


def quaternion_problems(key: str, quaternion: Sequence[float]) -> Iterator[str]:
    """A quaternion that is scaled to length 1, and whose own is far from that."""
    length = math.hypot(*quaternion)
    if not 1.0 / LONGEST_QUATERNION <= length <= LONGEST_QUATERNION:
        yield (
            f"{key} is {show(quaternion)}, a quaternion of length {length:.3g}; allowed: {1.0 / LONGEST_QUATERNION:g} "
            f"to {LONGEST_QUATERNION:g}, which is then made 1; write [1, 0, 0, 0] for no rotation"
        )


def mass_problems(lander: LanderSection) -> Iterator[str]:
    """Parts that are heavier than the lander. Raises ValueError for a mesh that is refused."""
    parts, least = sum(part_mass(part) for part in lander.part.values()), usual_reach(lander.mass)[0]
    if lander.part and parts >= least:
        yield (
            f"lander.mass is {least:.4g} kg at its least, and lander.part has {parts:.4g} kg; allowed: more than that, "
            "as it is the mass of all and the main shape has the rest; raise it, or make the parts lighter"
        )


def hinge_problems(lander: LanderSection, radius: float, stepping: str) -> Iterator[str]:
    """Hinges that are out of reach or that no engine takes, and a main body without the inertia of one.

    radius: of the lander [m]. Raises ValueError for a mesh that is refused.
    """
    if lander.is_hinged:
        yield from _main_body_problems(lander)
    hinges = {name: part.hinge for name, part in lander.part.items() if part.hinge is not None}
    if hinges and stepping != "local":
        yield (
            f'contact.stepping is "{stepping}" with lander.part.{next(iter(hinges))}.hinge; allowed with hinges: '
            '"local"; leave it out'
        )
    for name, hinge in hinges.items():
        away = math.hypot(*hinge.point)
        if away > 2.0 * radius:
            yield (
                f"lander.part.{name}.hinge.point is {show(hinge.point)} m, {away:.3g} m from the origin of the lander; "
                f"allowed: at most {2.0 * radius:.3g} m, twice the lander's reach; give it in the axes of the lander"
            )


def _main_body_problems(lander: LanderSection) -> Iterator[str]:
    """Mass, centre of mass and inertia from which parts on hinges cannot be taken, at the ends of what is uncertain."""
    if lander.inertia is None:
        return
    import numpy as np

    from lithobrake.dem import Assembly, ConvexHull, Sphere, rest_of

    taken = []
    for part in lander.part.values():
        if part.hinge is not None:
            one, mass = part_solid(part), part_mass(part)
            shape = Sphere(one.radius, one.centroid) if one.radius > 0.0 else ConvexHull(np.array(one.points))
            taken.append(Assembly(mass, shape.centroid, shape.inertia_per_density * (mass / shape.volume)))
    tensor = np.diag(lander.inertia[:3])
    for (i, j), element in zip(((0, 1), (0, 2), (1, 2)), lander.inertia[3:], strict=False):
        tensor[i, j] = tensor[j, i] = element
    own, parts = solid(lander), [part_solid(part) for part in lander.part.values()]
    for mass, centre in product(usual_reach(lander.mass), _centres_of_mass(lander, own, parts)):
        moments = np.linalg.eigvalsh(rest_of(Assembly(mass, np.array(centre), tensor), taken).inertia)
        if moments[0] <= 0.0 or moments[2] > (moments[0] + moments[1]) * (1.0 + ROUNDING):
            shown, left = (", ".join(f"{one:.4g}" for one in some) for some in (lander.inertia, moments))
            yield (
                f"lander.inertia is [{shown}] kg m2 with parts on hinges, which leave the main body moments of {left} "
                f"kg m2 at {mass:.4g} kg; allowed: above 0, each at most the sum of the other two; raise it, or make "
                "these parts lighter"
            )
            return


def inertia_problems(lander: LanderSection) -> Iterator[str]:
    """Moments of inertia that no body has: the sum of mass x x^T over its points has no eigenvalue below 0, and at most
    one that is 0.
    """
    if lander.inertia is None:
        return
    (a, b, c), (ab, ac, bc) = lander.inertia[:3], lander.inertia[3:] or (0.0, 0.0, 0.0)
    half = 0.5 * (a + b + c)
    x, y, z, slack = half - a, half - b, half - c, ROUNDING * half
    minors = (x * y - ab * ab, x * z - ac * ac, y * z - bc * bc)
    volume = x * (y * z - bc * bc) - ab * (ab * z + bc * ac) - ac * (ab * bc + ac * y)
    # A semi-definite matrix needs all of its principal minors at or above 0, not the leading ones alone.
    below = min(x, y, z) < -slack or min(minors) < -slack * half or volume < -slack * half * half
    # The sum of the minors is that of the products of two eigenvalues: 0 where two of these are 0, as of mass along a
    # line, which has no moment about it.
    if below or sum(minors) <= 0.0:
        shown = ", ".join(f"{moment:g}" for moment in lander.inertia)
        yield (
            f"lander.inertia is [{shown}] kg m2; allowed: principal moments each at most the sum of the other two, as "
            "every body has it; mend it, or leave it out for a homogeneous lander"
        )
