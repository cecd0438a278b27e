"""The table of the study file that says what the grains are made of; properties that the lander has as well."""

from typing import Annotated

from pydantic import Field

from lithobrake.study.quantity import MaybeUncertain, Scalar, Section

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
    """Young's modulus; over decades use log_uniform."""
    poisson_ratio: PoissonRatio = Field(examples=['{ distribution = "uniform", lower = 0.15, upper = 0.35 }'])
    """Poisson's ratio."""
    restitution: Restitution = Field(examples=['{ distribution = "uniform", lower = 0.3, upper = 0.8 }'])
    """Coefficient of restitution between grains."""
    friction: Friction = Field(examples=['{ distribution = "uniform", lower = 0.3, upper = 0.9 }'])
    """Coefficient of friction."""
    rolling_friction: Friction = 0.0
    """Resistance to rolling: the largest couple of a contact divided by normal force and contact radius."""
    spinning_friction: Friction = 0.0
    """Resistance to spinning about the contact normal, defined in the same way."""
    cohesion_force: Cohesion = 0.0
    """Pull of every contact, whatever its size."""
    surface_energy: SurfaceEnergy = 0.0
    """Pull of a contact in proportion to its radius R*: 4 pi surface_energy R*. For clean grains of lunar soil it is
    0.0029."""
