"""Grains: shapes, contact law, neighbours, narrow phase, motion, world. Knows nothing of landers or chaos.

Other parts use this one by the names that stand here.
"""

from lithobrake.dem.bodies.mesh_hull import read_hull
from lithobrake.dem.bodies.rigid_body import (
    Assembly,
    Part,
    RigidBody,
    checked_inertia,
    inertia_about,
    new_body,
    rest_of,
)
from lithobrake.dem.bodies.shape import Box, ConvexHull, Shape, Sphere, equivalent_radius
from lithobrake.dem.bodies.vectors import folded, period_of
from lithobrake.dem.law.restitution import pair_law
from lithobrake.dem.observables import BodyMotion
from lithobrake.dem.stepping.engine import rotation_matrices
from lithobrake.dem.stepping.time_step_stability import contact_duration
from lithobrake.dem.world import StepTooLargeError, World
from lithobrake.vocabulary.material_properties import Material

__all__ = [
    "Assembly", "BodyMotion", "Box", "ConvexHull", "Material", "Part", "RigidBody", "Shape", "Sphere",
    "StepTooLargeError", "World", "checked_inertia", "contact_duration", "equivalent_radius", "folded",
    "inertia_about", "new_body", "pair_law", "period_of", "read_hull", "rest_of", "rotation_matrices",
]  # fmt: skip
