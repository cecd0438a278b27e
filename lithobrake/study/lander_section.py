"""The table of the study file of the lander: its shape, its mass, its sides, and parts fixed to it."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field

from lithobrake.geometry.attitude import alike
from lithobrake.study.ground_sections import Cohesion, Friction, PoissonRatio, Restitution, SurfaceEnergy, YoungModulus
from lithobrake.study.quantity import LengthUnit, MaybeUncertain, Number, Numbers, Scalar, Section, Tensor

if TYPE_CHECKING:
    from lithobrake.dem import Box, ConvexHull, Part, Sphere

    Array = np.ndarray

Along = Annotated[Scalar, MaybeUncertain("m")]


class CentreSection(Section):
    """A place in the axes of the lander."""

    x: Along = 0.0
    """Along x."""
    y: Along = 0.0
    """Along y."""
    z: Along = 0.0
    """Along z."""


class PartSection(Section):
    """A convex part that is fixed to the lander, such as a leg, a panel or a boom. There may be any number of parts,
    each in a table [lander.part.NAME] of its own. Parts may overlap, have no contact with each other and do not bend.
    Lengths and directions are along the axes of the lander, from the centre of a box or sphere, or from the origin of
    the file of a mesh."""

    shape: Literal["box", "sphere", "hull"] = Field(examples=['"box"'])
    """Shape: "box" takes edges, "sphere" takes diameter, "hull" takes file."""
    edges: Annotated[tuple[float, float, float], Numbers("m", count=3, above=0)] | None = Field(
        default=None, examples=["[1.5, 0.01, 0.01]"]
    )
    """Edge lengths of a box."""
    diameter: Annotated[float, Number("m", above=0)] | None = None
    """Diameter of a sphere."""
    file: str | None = None
    """Closed mesh (OBJ or STL) whose convex hull is the part; the path is relative to the study file."""
    unit: LengthUnit = "m"
    """Unit of the lengths in the mesh: "m", "km", "cm" or "mm"."""
    centre: Annotated[tuple[float, float, float], Numbers("m", count=3)] = Field(
        default=(0.0, 0.0, 0.0), examples=["[0.93, 0.0, 0.0]"]
    )
    """Position of the centre of the box or sphere, or of the origin of the mesh."""
    orientation: Annotated[tuple[float, float, float, float], Numbers("", count=4)] = (1.0, 0.0, 0.0, 0.0)
    """Rotation of the part about that point: a quaternion w, x, y, z."""
    mass: Annotated[float, Number("kg", above=0)] | None = Field(default=None, examples=["0.05"])
    """Its mass, which is part of lander.mass; or give density."""
    density: Annotated[float, Number("kg/m3", above=0)] | None = None
    """Its mass divided by its volume; or give mass."""
    young_modulus: Annotated[float, Number("Pa", above=0)] | None = None
    """Young's modulus of the part; absent: that of the lander."""
    poisson_ratio: Annotated[float, Number("", at_least=0, below=0.5)] | None = None
    """Poisson's ratio of the part; absent: that of the lander."""
    restitution: Restitution | None = None
    """Restitution of the part, low for a foot that is crushed or damped, high for one on a spring; absent: that of the
    lander."""
    friction: Friction | None = None
    """Friction of the part; absent: that of the lander."""
    rolling_friction: Friction | None = None
    """Rolling friction of the part; absent: that of the lander."""
    spinning_friction: Friction | None = None
    """Spinning friction of the part; absent: that of the lander."""
    cohesion_force: Annotated[float, Number("N", at_least=0)] | None = None
    """Cohesion of the part; absent: that of the lander."""
    surface_energy: Annotated[float, Number("J/m2", at_least=0)] | None = None
    """Surface energy of the part; absent: that of the lander."""


class LanderSection(Section):
    """The lander: a rigid convex body, to which parts may be fixed."""

    shape: Literal["box", "sphere", "hull"] = Field(examples=['"box"'])
    """Shape: "box" takes edges, "sphere" takes diameter, "hull" takes file."""
    mass: Annotated[Scalar, MaybeUncertain("kg", above=0)] = Field(examples=["2.6"])
    """Mass, including that of the parts."""
    edges: Annotated[tuple[float, float, float], Numbers("m", count=3, above=0)] | None = Field(
        default=None, examples=["[0.1, 0.1, 0.227]"]
    )
    """Edge lengths of a box."""
    diameter: Annotated[Scalar, MaybeUncertain("m", above=0)] | None = None
    """Diameter of a sphere."""
    file: str | None = None
    """Closed mesh (OBJ or STL) whose convex hull is the lander; the path is relative to the study file."""
    unit: LengthUnit = "m"
    """Unit of the lengths in the mesh: "m", "km", "cm" or "mm"."""
    centre_of_mass: CentreSection | None = None
    """Centre of mass in the axes of the lander; absent: that of homogeneous shape and parts."""
    inertia: Annotated[tuple[float, ...], Tensor("kg m2")] | None = None
    """Inertia about the centre of mass, in the axes of the lander. Either three moments, each at most the sum of the
    other two, or six elements of the tensor: Ixx, Iyy, Izz, Ixy, Ixz, Iyz, where Ixy is minus the sum of mass x y.
    Absent: that of homogeneous shape and parts."""
    young_modulus: YoungModulus | None = None
    """Young's modulus of the lander; absent: that of the grains."""
    poisson_ratio: PoissonRatio | None = None
    """Poisson's ratio of the lander; absent: that of the grains."""
    restitution: Restitution | None = Field(
        default=None, examples=['{ distribution = "uniform", lower = 0.4, upper = 0.9 }']
    )
    """Restitution of the lander's hull; absent: that of the grains."""
    friction: Friction | None = None
    """Friction of the lander's hull; absent: that of the grains."""
    rolling_friction: Friction | None = None
    """Rolling friction of the lander's hull; absent: that of the grains."""
    spinning_friction: Friction | None = None
    """Spinning friction of the lander's hull; absent: that of the grains."""
    cohesion_force: Cohesion | None = None
    """Cohesion of the lander's hull; absent: that of the grains."""
    surface_energy: SurfaceEnergy | None = None
    """Surface energy of the lander's hull; absent: that of the grains."""
    part: dict[str, PartSection] = Field(default={})
    """Parts that are fixed to the lander."""

    @property
    def is_ball(self) -> bool:
        """Whether it is the same from all sides: a sphere alone, about its centre."""
        return self.shape == "sphere" and not self.part and self.centre_of_mass is None

    @property
    def is_plain_box(self) -> bool:
        """Whether it has the symmetry of a box: no parts, and the centre of mass amid it."""
        # Six elements of the tensor have products of inertia, which take the mirror planes of the box away; three have
        # not.
        return self.edges is not None and not self.part and self.centre_of_mass is None and len(self.inertia or ()) < 6


SIDES = ("+x", "-x", "+y", "-y", "+z", "-z")


def sides_down(lander: "LanderSection", normal: "np.ndarray") -> "np.ndarray":
    """Which side of the lander faces the ground most, [count]; "" for a ball. normal: seen from the lander [count, 3].

    Of a box by the axis that stands most upright, "z", or by those whose edges are alike, "x or y"; of a mesh one of
    "+x" to "-z", by its own axes.
    """
    import numpy as np

    axis = np.abs(normal).argmax(axis=1)
    if lander.edges is not None:
        words = np.array([_alike(lander.edges, one) for one in range(3)])
        found: np.ndarray = words[axis]
        return found
    if lander.shape == "sphere":
        return np.full(len(normal), "")
    upward = np.take_along_axis(normal, axis[:, None], axis=1)[:, 0] > 0.0
    sides: np.ndarray = np.array(SIDES)[2 * axis + upward]
    return sides


def directions_of_sides(lander: "LanderSection") -> dict[str, list[list[float]]]:
    """The sides of the lander, named as by `sides_down`, each with the directions of it that may face the ground."""
    found: dict[str, list[list[float]]] = {}
    for side in SIDES if lander.shape != "sphere" else ():
        axis = "xyz".index(side[1])
        name = side if lander.edges is None else _alike(lander.edges, axis)
        down = [(1.0 if side[0] == "+" else -1.0) * (one == axis) for one in range(3)]
        found.setdefault(name, []).append(down)
    return found


def side_words(lander: "LanderSection", side: str) -> str:
    """A side in words: of a box with the lengths of its face [m]."""
    if lander.edges is None:
        return side
    first, second = (length for axis, length in enumerate(lander.edges) if axis != "xyz".index(side[0]))
    return f"{side}, {first:g} m x {second:g} m"


def _alike(edges: tuple[float, float, float], axis: int) -> str:
    """The axes of a box whose faces are like those of one."""
    names = [name for name, edge in zip("xyz", edges, strict=True) if alike(edge, edges[axis])]
    return " or ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


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
