"""The lander: a body of one convex part or several, fixed or on hinges, and the smallest bed for it."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lithobrake.dem import (
    Assembly,
    Box,
    ConvexHull,
    Material,
    Part,
    RigidBody,
    Shape,
    Sphere,
    checked_inertia,
    contact_duration,
    equivalent_radius,
    new_body,
    rest_of,
)
from lithobrake.touchdown.hinged_part import HingedPart
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.field_errors import FieldError

# Points at which a part is looked for above the ground: so many steps from its centroid to each of its vertices.
FOOTPRINT_STEPS = 4


@dataclass(frozen=True, kw_only=True, eq=False)
class Lander:
    """A lander of a mass [kg]: a main shape, and parts such as legs and booms, in its axes, fixed or on hinges.

    The mass is that of all; a part has its own by the density of its material, and the main shape has what is left.
    centre_of_mass [m, 3] and inertia [kg m2, 3 x 3, about the centre of mass] are those of all, no hinge bent, in the
    axes in which the shapes are given; None: those of homogeneous parts.

    Raises ValueError for a mass that is not positive or less than that of the parts, and for an inertia that no body
    has, or none that is left when the hinged parts are taken off.
    """

    shape: Sphere | Box | ConvexHull
    mass: float
    material: Material
    inertia: Floats | None = None
    parts: tuple[Part, ...] = ()
    centre_of_mass: Floats | None = None

    def __post_init__(self) -> None:
        if not 0.0 < self.mass < np.inf:
            raise FieldError("Lander.mass", self.mass, "is a finite value above 0", unit="kg")
        if self.inertia is not None:
            checked_inertia(self.inertia, "Lander.inertia")
        if self.own_mass <= 0.0:
            raise FieldError(
                "Lander.mass", self.mass,
                f"is more than the {self.mass - self.own_mass:.6g} kg of its parts, for its main shape",
                "raise it, or make the parts lighter", "kg",
            )  # fmt: skip
        if self.hinged:
            self.main_body  # noqa: B018  refused here, and not in the middle of a landing

    @property
    def own_mass(self) -> float:
        """Mass of the main shape [kg]."""
        return self.mass - sum(part.mass for part in self.parts)

    @cached_property
    def own_material(self) -> Material:
        """Material of the main shape, with the density that its mass asks for where there are parts."""
        if not self.parts:
            return self.material
        return replace(self.material, density=self.own_mass / self.shape.volume)

    @cached_property
    def body(self) -> RigidBody:
        """The body as a world has it: its parts, centre of mass, and inertia about that [kg m2, 3 x 3]."""
        return new_body(self.shape, self.own_material, self.mass, self.inertia, self.parts, self.centre_of_mass)

    @property
    def hinged(self) -> tuple[HingedPart, ...]:
        """Parts on hinges."""
        return tuple(part for part in self.parts if isinstance(part, HingedPart))

    @cached_property
    def main_body(self) -> RigidBody:
        """The body without the parts on hinges, which are bodies of their own."""
        whole = Assembly(self.mass, self.body.centre_of_mass, self.body.inertia)
        taken = [(part.mass, part.shape.centroid, part.body.inertia) for part in self.hinged]
        rest = rest_of(whole, [Assembly(*one) for one in taken])
        fixed = [part for part in self.parts if not isinstance(part, HingedPart)]
        try:
            return new_body(self.shape, self.own_material, rest.mass, rest.inertia, fixed, rest.centre)
        except FieldError as error:
            raise FieldError(
                "Lander.inertia", self.body.inertia.tolist(),
                f"is that of a body from which the {len(taken)} parts on hinges can be taken, and leaves not "
                f"{rest.inertia.tolist()} kg m2",
                "raise it, or make these parts lighter", "kg m2",
            ) from error  # fmt: skip

    @property
    def reach(self) -> float:
        """Distance of the farthest point from the centre of mass [m]."""
        return self.body.bounding_radius

    @cached_property
    def smallest_edge(self) -> float:
        """Smallest extent of the main shape [m]: the shortest edge of a box, the least width of a hull over a face."""
        if isinstance(self.shape, Box):
            return min(self.shape.lengths)
        if isinstance(self.shape, Sphere):
            return 2.0 * self.shape.radius
        # Over faces alone this is an upper bound of the least width, which may lie between two edges.
        heights = self.shape.polyhedron.face_normals @ self.shape.vertices.T
        return float((heights.max(axis=1) - heights.min(axis=1)).min())

    def lowest(self, position: Floats, rotation: Floats) -> float:
        """Return the height [m] of the lowest point of the body at a position and rotation matrix, body to world."""
        centre = self.body.centre_of_mass
        return float(position[2]) + min(lowest_of(part.shape, centre, rotation) for part in self.body.parts)

    def footprint(self, rotation: Floats) -> Floats:
        """Return points spread over the parts beside the main shape, seen from above [m], [point_count, 2], from the
        centre of mass.
        """
        points, steps = [np.zeros((0, 3))], np.linspace(0.0, 1.0, FOOTPRINT_STEPS + 1)[:, None, None]
        for shape in (part.shape for part in self.parts):
            corners = shape.bounding_radius * np.vstack([np.eye(3), -np.eye(3)])
            if isinstance(shape, ConvexHull):
                corners = shape.vertices - shape.centroid
            points.append((shape.centroid - self.body.centre_of_mass + steps * corners).reshape(-1, 3))
        across: Floats = (np.concatenate(points) @ rotation.T)[:, :2]
        return across


def lowest_of(shape: Shape, centre: Floats, rotation: Floats) -> float:
    """Return the height [m] of the lowest point of a shape over a centre of mass [m], in the axes of the shape.

    rotation: [3, 3], body to world.
    """
    if isinstance(shape, ConvexHull):
        return float(((shape.vertices - centre) @ rotation[2]).min())
    return float((shape.centroid - centre) @ rotation[2]) - shape.bounding_radius


def wave_speed(rock: Material, diameter: float, speed: float) -> float:
    """Return the speed [m/s] of the compression wave that an impact at `speed` [m/s] drives through grains.

    Loose grains carry no sound of their own: the stronger the blow, the faster the wave, (16/25)^(1/5) c^(4/5) v^(1/5)
    with c^2 = K d^(5/2) / m for Hertz contacts K overlap^(3/2) of grains of diameter d [m] and mass m.
    Source: [Nesterenko-1983], the solitary wave of an unloaded chain.
    """
    stiffness = 4.0 / 3.0 * 0.5 * rock.young_modulus / (1.0 - rock.poisson_ratio**2) * math.sqrt(0.25 * diameter)
    mass = rock.density * math.pi / 6.0 * diameter**3
    sound = math.sqrt(stiffness * diameter**2.5 / mass)
    return float((16.0 / 25.0) ** 0.2 * sound**0.8 * speed**0.2)


def smallest_bed(lander: Lander, rock: Material, diameter: float, speed: float) -> tuple[float, float]:
    """Return the smallest width and depth [m] of a bed of grains of a diameter [m] for an impact at a speed [m/s].

    The wave goes out with the first blow and must not be back before that blow, the Hertz collision of lander and
    grain, is over: the way to the floor and to a wall is at least half of wave speed times contact time, and the walls
    stand clear of the lander by that much on both sides. Ground that repeats sends the wave of each image of the lander
    instead of an echo, over the same way. Later blows meet a bed that is moving anyway.
    """
    grain = rock.density * math.pi / 6.0 * diameter**3
    mass = lander.mass * grain / (lander.mass + grain)
    radius = 1.0 / (1.0 / equivalent_radius(lander.shape) + 2.0 / diameter)
    modulus = 0.5 * rock.young_modulus / (1.0 - rock.poisson_ratio**2)
    way = wave_speed(rock, diameter, speed) * contact_duration(mass, radius, modulus, speed)
    return 2.0 * lander.reach + way, 0.5 * way
