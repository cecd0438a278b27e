"""What is wrong with the shapes, masses and inertia of a lander and its parts."""

import math
import os
import re
from collections.abc import Iterator

from lithobrake.study.lander_section import LanderSection, PartSection
from lithobrake.study.lander_solids import part_mass
from lithobrake.study.quantity import Uncertain, usual_reach
from lithobrake.vocabulary.plain_text import show

# Of what a user names.
NAME = r"[\w-]+"
# Thinner boxes are slips, and no equation of motion can be solved for them.
THINNEST = 1e-3
# Mass anywhere adds at most as much to one moment of inertia as to the other two; a plate may miss that by rounding.
ROUNDING = 1e-9
TAKES = {"box": "edges", "sphere": "diameter", "hull": "file"}


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
        if math.hypot(*part.orientation) == 0.0:
            yield f"{path}.orientation is [0, 0, 0, 0]; allowed: a quaternion other than zero; write [1, 0, 0, 0]"
    if lander.part and isinstance(lander.diameter, Uncertain):
        yield (
            "lander.diameter is uncertain, and the lander has parts, which stand at fixed places; allowed: one number; "
            "write it, or make a study for each"
        )


def mass_problems(lander: LanderSection) -> Iterator[str]:
    """Parts that are heavier than the lander. Raises ValueError for a mesh that is refused."""
    parts, least = sum(part_mass(part) for part in lander.part.values()), usual_reach(lander.mass)[0]
    if lander.part and parts >= least:
        yield (
            f"lander.mass is {least:.4g} kg at its least, and lander.part has {parts:.4g} kg; allowed: more than that, "
            "as it is the mass of all and the main shape has the rest; raise it, or make the parts lighter"
        )


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
    below = min(x, y, z) < -slack or min(minors) < -slack * half or volume < -slack * half * half
    if below or sum(minors) <= 0.0:
        shown = ", ".join(f"{moment:g}" for moment in lander.inertia)
        yield (
            f"lander.inertia is [{shown}] kg m2; allowed: principal moments each at most the sum of the other two, as "
            "every body has it; mend it, or leave it out for a homogeneous lander"
        )
