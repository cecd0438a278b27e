"""The tables of the study file that say what grains and lander are made of, and what shape the lander has."""

from typing import Annotated, Literal

from pydantic import Field

from lithobrake.study.quantity import LengthUnit, MaybeUncertain, Numbers, Scalar, Section

Density = Annotated[Scalar, MaybeUncertain("kg/m3", above=0)]
YoungModulus = Annotated[Scalar, MaybeUncertain("Pa", above=0)]
PoissonRatio = Annotated[Scalar, MaybeUncertain("", at_least=0, below=0.5)]
Restitution = Annotated[Scalar, MaybeUncertain("", above=0, at_most=1)]
Friction = Annotated[Scalar, MaybeUncertain("", at_least=0)]
Cohesion = Annotated[Scalar, MaybeUncertain("N", at_least=0)]
SurfaceEnergy = Annotated[Scalar, MaybeUncertain("J/m2", at_least=0)]


class GrainSection(Section):
    """The rock of the grains."""

    density: Density = Field(examples=["2500.0"])
    """Density of the rock."""
    young_modulus: YoungModulus = Field(examples=['{ distribution = "log_uniform", lower = 1e6, upper = 1e8 }'])
    """Young's modulus; expand it over decades with log_uniform."""
    poisson_ratio: PoissonRatio = Field(examples=['{ distribution = "uniform", lower = 0.15, upper = 0.35 }'])
    """Poisson's ratio."""
    restitution: Restitution = Field(examples=['{ distribution = "uniform", lower = 0.3, upper = 0.8 }'])
    """Coefficient of restitution between grains."""
    friction: Friction = Field(examples=['{ distribution = "uniform", lower = 0.3, upper = 0.9 }'])
    """Coefficient of friction."""
    rolling_friction: Friction = 0.0
    """Resistance to rolling: a contact's largest couple over normal force and contact radius."""
    spinning_friction: Friction = 0.0
    """Resistance to spinning about the contact normal, likewise."""
    cohesion_force: Cohesion = 0.0
    """Pull of every contact, whatever its size."""
    surface_energy: SurfaceEnergy = 0.0
    """Pull of a contact in proportion to its radius R*: 4 pi surface_energy R*; lunar soil 0.0029 for clean grains."""


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
