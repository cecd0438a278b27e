"""The table of the study file of the lander: its shape, its mass, and what it is made of."""

from typing import Annotated, Literal

from pydantic import Field

from lithobrake.study.material_sections import (
    Cohesion,
    Friction,
    PoissonRatio,
    Restitution,
    SurfaceEnergy,
    YoungModulus,
)
from lithobrake.study.quantity import LengthUnit, MaybeUncertain, Numbers, Scalar, Section


class LanderSection(Section):
    """The lander: a rigid convex body."""

    shape: Literal["box", "sphere", "hull"] = Field(examples=['"box"'])
    """Shape: "box" takes edges, "sphere" takes diameter, "hull" takes file."""
    mass: Annotated[Scalar, MaybeUncertain("kg", above=0)] = Field(examples=["2.6"])
    """Mass."""
    edges: Annotated[tuple[float, float, float], Numbers("m", count=3, above=0)] | None = Field(
        default=None, examples=["[0.1, 0.1, 0.227]"]
    )
    """Edge lengths of a box."""
    diameter: Annotated[Scalar, MaybeUncertain("m", above=0)] | None = None
    """Diameter of a sphere."""
    file: str | None = None
    """Closed mesh (OBJ or STL) whose convex hull is the lander; the path counts from the study file."""
    unit: LengthUnit = "m"
    """Unit of the lengths in the mesh: "m", "km", "cm" or "mm"."""
    inertia: Annotated[tuple[float, float, float], Numbers("kg m2", count=3, above=0)] | None = None
    """Moments of inertia about the axes of the shape, each at most the sum of the other two; absent: those of the
    homogeneous body."""
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
