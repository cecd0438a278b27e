"""One drop at two gravities in exact similarity: (g, E, v) -> (L^2 g, L^2 E, L v), times 1/L as long."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from sphere_bed import Beads, Row, walled_world

from lithobrake.dem import Sphere, World

LOOKS, STEPS_A_LOOK = 20, 250
SHARE = 1.0 / 128.0  # L: gravity becomes 1/16384 of Earth's, 6e-4 m/s2


def scaled(world: World, beads: Beads, ball: Sphere, density: float, speed: float, step: float, share: float) -> World:
    """Return beads at the places of a settled bed, with a ball above their middle, in units of time 1/share as long.

    The springs of the contacts begin at zero in every copy alike.
    """
    stuff = replace(beads.material, young_modulus=beads.material.young_modulus * share**2)
    copy = walled_world(replace(beads, material=stuff, gravity=beads.gravity * share**2))
    for body, place in zip(world.bodies, world.position, strict=True):
        copy.add_body(body.shape, stuff, place)
    top = float(world.position[:, 2].max()) + max(beads.diameters)
    copy.add_body(
        ball, replace(stuff, density=density), (0.0, 0.0, top + ball.radius), velocity=(0.0, 0.0, -speed * share)
    )
    copy.time_step = step / share
    return copy


def similar_drops(world: World, beads: Beads, ball: Sphere, density: float, fall: float) -> Iterator[Row]:
    """Drop a ball at two gravities; yield for each look by how much the paths differ, in ball diameters and bits."""
    speed = (2.0 * beads.gravity * fall) ** 0.5
    step = world.shortest_contact(speed) / 15.0
    pair = [scaled(world, beads, ball, density, speed, step, share) for share in (1.0, SHARE)]
    for look in range(1, LOOKS + 1):
        for copy in pair:
            copy.run(steps=STEPS_A_LOOK)
        apart = float(np.abs(pair[0].position - pair[1].position).max())
        yield {
            "steps": look * STEPS_A_LOOK, "gravity": float(-pair[1].gravity[2]), "beads": beads.count,
            "ball_height": float(pair[0].position[-1, 2]), "ball_height_scaled": float(pair[1].position[-1, 2]),
            "largest_difference": apart / (2.0 * ball.radius),
            "same_bits": str(np.array_equal(pair[0].position, pair[1].position)),
        }  # fmt: skip
