"""Grains: shapes, contact law, neighbours, narrow phase, motion, world. Knows nothing of landers or chaos."""

from lithobrake.dem.material import Material
from lithobrake.dem.shape import Box, ConvexHull, Shape, Sphere
from lithobrake.dem.world import World

__all__ = ["Box", "ConvexHull", "Material", "Shape", "Sphere", "World"]
