"""The shapes of a lander and of its parts as the engine has them, in the axes of the lander."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.study.lander_section import LanderSection, PartSection

if TYPE_CHECKING:
    from lithobrake.dem import Box, ConvexHull, Part, Sphere

    Array = np.ndarray


def main_shape(section: LanderSection, values: Mapping[str, float]) -> "Sphere | Box | ConvexHull":
    """The shape of the lander without its parts; values: of the study by dotted key."""
    from lithobrake.dem import Box, Sphere
    from lithobrake.touchdown import read_hull

    if section.edges is not None:
        return Box(section.edges)
    if section.file is not None:
        return read_hull(Path(section.file), section.unit)
    return Sphere(values["lander.diameter"] / 2)


def part_shape(section: PartSection) -> "Sphere | ConvexHull":
    from lithobrake.dem import Box, ConvexHull, Sphere, rotation_matrices
    from lithobrake.touchdown import read_hull

    if section.diameter is not None:
        return Sphere(section.diameter / 2, section.centre)
    own = Box(section.edges) if section.edges is not None else read_hull(Path(str(section.file)), section.unit)
    turn = np.array(section.orientation)
    rotation = rotation_matrices((turn / np.linalg.norm(turn))[None])[0]
    return ConvexHull(own.vertices @ rotation.T + np.array(section.centre))


def lander_parts(
    section: LanderSection, values: Mapping[str, float], properties: Mapping[str, float]
) -> "tuple[Part, ...]":
    """The parts of the lander; properties: of its own material, which a part has unless others are given."""
    from lithobrake.dem import Material, Part

    parts = []
    for name, part in section.part.items():
        shape = part_shape(part)
        density = part.density if part.mass is None else part.mass / shape.volume
        own: dict[str, Any] = {key: values.get(f"lander.part.{name}.{key}", value) for key, value in properties.items()}
        parts.append(Part(shape, Material(density=float(density or 0.0), **own)))
    return tuple(parts)


def given_centre(section: LanderSection, values: Mapping[str, float]) -> "Array | None":
    """The centre of mass [m], [3], where the study gives it."""
    if section.centre_of_mass is None:
        return None
    return np.array([values[f"lander.centre_of_mass.{axis}"] for axis in "xyz"])


def given_inertia(section: LanderSection) -> "Array | None":
    """The inertia [kg m2], [3, 3], where the study gives it."""
    if section.inertia is None:
        return None
    tensor = np.diag(section.inertia[:3])
    if len(section.inertia) == 6:
        for (i, j), element in zip(((0, 1), (0, 2), (1, 2)), section.inertia[3:], strict=True):
            tensor[i, j] = tensor[j, i] = element
    return tensor
