"""The table of the study file of the lander: its shape, its mass, its sides, and parts fixed to it."""

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from lithobrake.geometry.attitude import alike
from lithobrake.study.ground_sections import Cohesion, Friction, PoissonRatio, Restitution, SurfaceEnergy, YoungModulus
from lithobrake.study.quantity import LengthUnit, MaybeUncertain, Number, Numbers, Scalar, Section, Tensor

if TYPE_CHECKING:
    import numpy as np

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
