"""Beds of equal spheres with rolling resistance, poured as the package pours hulls, for a landing as on any bed."""

from dataclasses import fields, replace
from typing import Any

import numpy as np

from lithobrake.dem import Material, Sphere, World
from lithobrake.touchdown import Bed, BedRecipe, pouring, settling
from lithobrake.touchdown.bed import ContactModel, boxed_world
from lithobrake.touchdown.landing import hull_about_centroid


class SphereBed(Bed):
    """A bed whose hulls are pictures of spheres: contacts are those of spheres, heights those of the pictures."""

    def world(
        self, material: Material, gravity: tuple[float, float, float], contact: ContactModel,
        tilted: tuple[float, float, float] | None = None,
    ) -> World:  # fmt: skip
        """Return a world with these spheres at rest, see Bed.world."""
        balls: Any = [Sphere(0.5 * diameter) for diameter in self.diameter]
        body = balls, self.position, self.orientation, self.width
        return boxed_world(*body, material, gravity, contact, self.sides, tilted)

    @classmethod
    def of(cls, bed: Bed) -> "SphereBed":
        """Return a bed of pictures as one of spheres."""
        return cls(**{one.name: getattr(bed, one.name) for one in fields(bed)})


def pour_spheres(recipe: BedRecipe) -> SphereBed:
    """Pour equal spheres on ground that repeats in the steps of pouring.pour_bed, and let them settle.

    Raises ValueError where the bed does not come to rest.
    """
    generator = np.random.default_rng(recipe.seed)
    diameter = recipe.sizes.draw(generator.random(recipe.grain_count))
    balls: Any = [Sphere(0.5 * one) for one in diameter]
    position, orientation = pouring.rain(generator, balls, recipe.width, recipe.period)
    down, inward = (0.0, 0.0, -recipe.pour_gravity), (0.0, 0.0, recipe.gravity[2])
    recorder = pouring.Recorder(float(diameter.mean()))
    quiet = replace(recipe.material, restitution=max(pouring.SETTLING_RESTITUTION, recipe.material.restitution))

    def resting(world: World, material: Material, gravity: tuple[float, float, float]) -> World:
        frame = recipe.width, material, gravity, recipe.contact, recipe.sides
        other = boxed_world(balls, world.position, world.orientation, *frame)
        other.time = world.time
        return other

    def silent(*_: object) -> None:
        return None

    world = boxed_world(balls, position, orientation, recipe.width, recipe.material, down, recipe.contact, recipe.sides)
    pouring.fall(world, recorder, recipe, silent)
    world = resting(world, quiet, down)
    pouring.lie(world, recorder, recipe, silent)
    world = resting(world, replace(quiet, friction=0.0), inward)
    pouring.loosen(world, recorder, recipe, silent)
    world = resting(world, quiet, recipe.gravity)
    pouring.lower(world, recorder, recipe, silent)
    pouring.settle(world, recorder, recipe, True, silent)
    assert recorder.at_rest, settling.restless(world)
    image = hull_about_centroid(balls[0])
    return SphereBed.of(pouring.finished(world, recorder, recipe, [image] * len(balls), diameter))
