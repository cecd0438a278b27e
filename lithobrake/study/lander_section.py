"""The table of the study file of the lander: its shape, its mass, its sides, and parts fixed to it."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from lithobrake.geometry.bed_limits import alike
from lithobrake.study import ground_sections
from lithobrake.study.quantity import LengthUnit, MaybeUncertain, Number, Numbers, Scalar, Section, Tensor
from lithobrake.vocabulary.material_properties import SURFACE_PROPERTIES, MaterialProperty
from lithobrake.vocabulary.quantities import SIDES

if TYPE_CHECKING:
    import numpy as np

Along = Annotated[Scalar, MaybeUncertain("m")]
# Outward, by the lander's own axes, in the order of SIDES.
OUTWARD = tuple(tuple((1.0 if side[0] == "+" else -1.0) * (axis == side[1]) for axis in "xyz") for side in SIDES)


class CentreSection(Section):
    """A place in the axes of the lander."""

    x: Along = 0.0
    """Along x."""
    y: Along = 0.0
    """Along y."""
    z: Along = 0.0
    """Along z."""


class HingeSection(Section):
    """An elastic hinge of a part, which may stand for the bending of a boom."""

    point: Annotated[tuple[float, float, float], Numbers("m", count=3)] = Field(examples=["[0.56, 0.0, 0.0]"])
    """Position of the hinge."""
    frequency: Annotated[float, Number("Hz", above=0)] | None = Field(default=None, examples=["6.7"])
    """Frequency at which the part swings while the lander is held; or give stiffness. The shorter the period, the
    longer a landing takes: time steps follow it."""
    stiffness: Annotated[float, Number("N m/rad", above=0)] | None = None
    """Stiffness about every axis; or give frequency."""
    damping_ratio: Annotated[float, Number("", at_least=0, at_most=1)] = Field(examples=["0.01"])
    """Damping of that swing over critical damping."""
    limit_deg: Annotated[float, Number("deg", above=0, at_most=90)] = 90.0
    """Bend at which an elastic stop begins to act."""


class _PartBody(Section):
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
    density: Annotated[float, ground_sections.allowed("density", Number)] | None = None
    """Its mass divided by its volume; or give mass."""
    hinge: HingeSection | None = None
    """Hinge on which it hangs; absent: it is fixed. Only with contact.stepping = "local"."""


def _of_part(known: MaterialProperty) -> str:
    """What a property of a part is."""
    foot = ", low for a foot that is crushed or damped, high for one on a spring"
    more = foot if known.words == "restitution" else ""
    return f"{known.title} of the part{more}; absent: that of the lander."


_PartProperties: Any = ground_sections.with_properties(
    _PartBody,
    SURFACE_PROPERTIES,
    _of_part,
    fixed=("young_modulus", "poisson_ratio", "cohesion_force", "surface_energy"),
)


class PartSection(_PartProperties, _PartBody):
    """A convex part of the lander, such as a leg, a panel or a boom, fixed or on a hinge. There may be any number of
    parts, each in a table [lander.part.NAME] of its own. Parts may overlap and have no contact with each other.
    Lengths and directions are along the axes of the lander, from the centre of a box or sphere, or from the origin of
    the file of a mesh."""


class _LanderBody(Section):
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


def _of_hull(known: MaterialProperty) -> str:
    """What a property of the lander is."""
    return f"{known.title} of the lander's hull; absent: that of the grains."


_LanderProperties: Any = ground_sections.with_properties(
    _LanderBody,
    SURFACE_PROPERTIES,
    _of_hull,
    examples={"restitution": '{ distribution = "uniform", lower = 0.4, upper = 0.9 }'},
)


class LanderSection(_LanderProperties, _LanderBody):
    """The lander: a rigid convex body, to which parts may be fixed or hinged."""

    part: dict[str, PartSection] = Field(default={})
    """Parts of the lander beside its main shape."""

    @property
    def is_ball(self) -> bool:
        """Whether it is the same from all sides: a sphere alone, about its centre."""
        return self.shape == "sphere" and not self.part and self.centre_of_mass is None

    @property
    def is_hinged(self) -> bool:
        """Whether a part hangs on a hinge."""
        return any(part.hinge is not None for part in self.part.values())

    @property
    def is_plain_box(self) -> bool:
        """Whether it has the symmetry of a box: no parts, and the centre of mass amid it."""
        # Six elements of the tensor have products of inertia, which take the mirror planes of the box away; three have
        # not.
        return self.edges is not None and not self.part and self.centre_of_mass is None and len(self.inertia or ()) < 6


def side_toward(direction: "np.ndarray") -> "np.ndarray":
    """Which side of the lander, as its place among SIDES, faces a direction most; [count], of directions [count, 3] in
    the lander's own axes.
    """
    import numpy as np

    axis = np.abs(direction).argmax(axis=1)
    along = np.take_along_axis(direction, axis[:, None], axis=1)[:, 0]
    found: np.ndarray = 2 * axis + (along < 0.0)
    return found


def sides_down(lander: "LanderSection", normal: "np.ndarray") -> "np.ndarray":
    """Which side of the lander faces the ground most, [count]; "" for a ball. normal: seen from the lander [count, 3].

    Of a box by the axis that stands most upright, "z", or by those whose edges are alike, "x or y"; of a mesh one of
    "+x" to "-z", by its own axes.
    """
    import numpy as np

    if lander.shape == "sphere":
        return np.full(len(normal), "")
    found: np.ndarray = np.array([_named(lander, side) for side in SIDES])[side_toward(-normal)]
    return found


def directions_of_sides(lander: "LanderSection") -> dict[str, list[list[float]]]:
    """The sides of the lander, named as by `sides_down`, each with the directions of it that may face the ground."""
    found: dict[str, list[list[float]]] = {}
    for side, outward in zip(SIDES, OUTWARD, strict=True) if lander.shape != "sphere" else ():
        found.setdefault(_named(lander, side), []).append(list(outward))
    return found


def side_words(lander: "LanderSection", side: str) -> str:
    """A side in words: of a box with the lengths of its face [m]."""
    if lander.edges is None:
        return side
    first, second = (length for axis, length in enumerate(lander.edges) if axis != "xyz".index(side[0]))
    return f"{side}, {first:g} m x {second:g} m"


def _named(lander: "LanderSection", side: str) -> str:
    """A side as results have it: of a box the axes whose faces are like it."""
    if lander.edges is None:
        return side
    own = lander.edges["xyz".index(side[1])]
    names = [name for name, edge in zip("xyz", lander.edges, strict=True) if alike(edge, own)]
    return " or ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)
