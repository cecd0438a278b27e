"""The shapes that meet in a pair: those of one convex part of each of its bodies."""

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, Pairs


@kernel
def first_shape(pair: int, bodies: Bodies, pairs: Pairs) -> int:
    """Return the shape of the first of a pair."""
    return bodies.shape[pairs.first_part[pair]]


@kernel
def both_shapes(pair: int, bodies: Bodies, pairs: Pairs) -> tuple[int, int]:
    """Return the shapes of both of a pair of bodies."""
    return bodies.shape[pairs.first_part[pair]], bodies.shape[pairs.second_part[pair]]


@kernel
def both_roundings(cores: Cores, shapes: tuple[int, int]) -> float:
    """Return the sum of the rounding radii of two shapes [m]."""
    return cores.rounding[shapes[0]] + cores.rounding[shapes[1]]


@kernel
def curvature_of(pair: int, bodies: Bodies, pairs: Pairs) -> float:
    """Return the curvature at which the members of a pair meet [1/m]; a plane has none."""
    curvature = bodies.curvature[pairs.first_part[pair]]
    return curvature + bodies.curvature[pairs.second_part[pair]] if pairs.second[pair] >= 0 else curvature


@kernel
def contact_radii(pair: int, bodies: Bodies, pairs: Pairs) -> float:
    """Return the sum of the contact radii of the members of a pair [m]; a plane counts for nothing."""
    radius = bodies.contact_radius[pairs.first_part[pair]]
    return radius + (bodies.contact_radius[pairs.second_part[pair]] if pairs.second[pair] >= 0 else 0.0)
