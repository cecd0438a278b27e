"""The lander of a study: its shapes, mass, inertia and materials."""

import math
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lithobrake import touchdown
from lithobrake.study import Study
from lithobrake.study.lander_section import HingeSection, LanderSection, PartSection
from lithobrake.touchdown.soil import Soil, Values
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.material_properties import Material

if TYPE_CHECKING:
    from lithobrake import dem


def lander(study: Study, values: Values) -> "touchdown.Lander":
    """The lander of a touchdown; values with what was drawn. Raises ValueError for one that no engine takes."""
    section, soil = study.lander, Soil.of(study, values)
    shape, mass = main_shape(section, values), values["lander.mass"]
    return touchdown.Lander(
        shape=shape,
        mass=mass,
        # The density of the material plays no part: the mass is given.
        material=replace(soil.hull, density=mass / shape.volume),
        inertia=given_inertia(section),
        parts=tuple(lander_part(part, soil.parts[name]) for name, part in section.part.items()),
        centre_of_mass=given_centre(section, values),
    )


def main_shape(section: LanderSection, values: Values) -> "dem.Sphere | dem.Box | dem.ConvexHull":
    """The shape of the lander without its parts."""
    from lithobrake import dem

    if section.edges is not None:
        return box(section.edges)
    if section.file is not None:
        return dem.read_hull(Path(section.file), section.unit)
    return dem.Sphere(values["lander.diameter"] / 2)


@lru_cache(maxsize=64)
def box(edges: tuple[float, float, float]) -> "dem.Box":
    """A box of these edges [m], made once: its hull takes longer than all else of a lander."""
    from lithobrake import dem

    return dem.Box(edges)


def lander_part(section: PartSection, surface: Material) -> "dem.Part":
    """A part of the lander with the mass or the density that it has; surface: its material but for the density."""
    from lithobrake import dem

    shape = part_shape(section)
    density = section.density if section.mass is None else section.mass / shape.volume
    part = dem.Part(shape, replace(surface, density=float(density or 0.0)))
    if section.hinge is None:
        return part
    return touchdown.HingedPart(shape, part.material, hinge=part_hinge(section.hinge, part))


def part_hinge(section: HingeSection, part: "dem.Part") -> "touchdown.Hinge":
    """The hinge of a part."""
    stiffness = section.stiffness
    if stiffness is None:
        stiffness = touchdown.hinge_stiffness(part, section.point, float(section.frequency or 0.0))
    return touchdown.Hinge(section.point, stiffness, section.damping_ratio, math.radians(section.limit_deg))


def part_shape(section: PartSection) -> "dem.Sphere | dem.ConvexHull":
    """The shape of a part where it stands, in the axes of the lander."""
    from lithobrake import dem

    if section.diameter is not None:
        return dem.Sphere(section.diameter / 2, section.centre)
    own = dem.Box(section.edges) if section.edges is not None else dem.read_hull(Path(str(section.file)), section.unit)
    turn = np.array(section.orientation)
    rotation = dem.rotation_matrices((turn / np.linalg.norm(turn))[None])[0]
    return dem.ConvexHull(own.vertices @ rotation.T + np.array(section.centre))


def given_centre(section: LanderSection, values: Values) -> Array | None:
    """The centre of mass [m], [3], where the study gives it."""
    if section.centre_of_mass is None:
        return None
    return np.array([values[f"lander.centre_of_mass.{axis}"] for axis in "xyz"])


def given_inertia(section: LanderSection) -> Array | None:
    """The inertia [kg m2], [3, 3], where the study gives it."""
    if section.inertia is None:
        return None
    tensor = np.diag(section.inertia[:3])
    if len(section.inertia) == 6:
        for (i, j), element in zip(((0, 1), (0, 2), (1, 2)), section.inertia[3:], strict=True):
            tensor[i, j] = tensor[j, i] = element
    return tensor
