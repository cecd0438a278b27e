"""A grain shot at 0.8 m/s onto a bed of its own kind, under Earth's gravity (X2).

    python validation/experiments/grain_on_its_own_kind.py --work FOLDER --out FOLDER

Basalt spheres of 150 um, at random points of several beds. Rows that stand in grain_on_its_own_kind.csv are not run
again. Source: [Bogdan-2020].
"""

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from ball_into_beads import SLOW
from result_rows import Row, note, options_of, read_rows
from sphere_bed import Ball, Beads, kept, steps_for, touch_height

from lithobrake.dem import Material, Sphere, World

NAME = "grain_on_its_own_kind.csv"
GRAIN, SPEED, GRAVITY = 150e-6, 0.8, 9.81
# A little apart in size, so that the bed does not order. Restitution and friction of basalt grains are not in the
# source's abstract: 0.8 is near what rock spheres have ([Durda-2011]: 0.83).
BASALT = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=0.8, friction=0.5, density=2900.0)
BED = Beads(
    diameters=(0.95 * GRAIN, GRAIN, 1.05 * GRAIN), material=BASALT, gravity=GRAVITY, width=8 * GRAIN,
    depth=8 * GRAIN, seed=1,
)  # fmt: skip
SEEDS = (1, 2, 3, 4)
FOLLOWED, LOOK = 1.5e-3, 5e-5  # s
STEPS = 15.0  # in the shortest contact
RISES = (0.1, 0.5, 1.0)  # grain diameters above where a grain lay


def kinds() -> dict[str, tuple[Beads, int]]:
    """Return the beds by name, and the impacts on each of its seeds."""
    return {
        "basalt": (BED, 25),
        "restitution 0.5": (replace(BED, material=replace(BASALT, restitution=0.5)), 5),
        "restitution 0.95": (replace(BED, material=replace(BASALT, restitution=0.95)), 5),
        "friction 0.2": (replace(BED, material=replace(BASALT, friction=0.2)), 5),
        "loose": (replace(BED, fall_speed=SLOW), 5),
        "rolling resistance": (replace(BED, material=replace(BASALT, rolling_friction=0.2)), 5),
    }


def shot(world: World, material: Material, point: tuple[float, float]) -> int:
    """Put a grain just above the bed over a point, on its way down; return its number."""
    height = touch_height(world, Ball(GRAIN, material.density, point)) + 0.52 * GRAIN
    body = world.add_body(Sphere(0.5 * GRAIN), material, (*point, height), velocity=(0.0, 0.0, -SPEED))
    world.time_step = world.shortest_contact(SPEED) / steps_for(material, STEPS)
    return body


def impact(work: Path, name: str, beads: Beads, number: int) -> Row:
    """Follow one impact for 1.5 ms; return how fast the grain leaves, and how high the others fly.

    A rise is that of a grain's centre above where it lay, in free flight, by the time it would be on top. The grain
    leaves at the last look at which it touched something; it is trapped where it still does at the end.
    """
    start = time.process_time()
    world = kept(beads, work)
    lay = world.position
    x, y = np.random.default_rng([beads.seed, number]).uniform(0.0, beads.width, 2)
    body = shot(world, beads.material, (float(x), float(y)))
    begun, struck = world.time, False
    highest = np.zeros(len(lay))
    out = np.zeros(3)
    while world.time - begun < FOLLOWED:
        world.run(duration=LOOK)
        contacts = world.contacts()
        touching = np.zeros(len(lay) + 1, dtype=bool)
        touching[contacts["body_a"]] = True
        touching[contacts["body_b"][contacts["body_b"] >= 0]] = True
        velocity, position = world.velocity, world.position
        struck = struck or bool(touching[body])
        if touching[body] or not out.any():
            out = velocity[body] if struck and not touching[body] else np.zeros(3)
        apex = position[:-1, 2] - lay[:, 2] + np.maximum(velocity[:-1, 2], 0.0) ** 2 / (2.0 * GRAVITY)
        highest = np.maximum(highest, np.where(touching[:-1], 0.0, apex))
    flying = highest[highest > RISES[0] * GRAIN] / GRAIN
    return {
        "kind": name, "seed": beads.seed, "impact": number, "beads": len(lay),
        "speed_ratio": float(np.linalg.norm(out)) / SPEED, "vertical_ratio": float(out[2]) / SPEED,
        **{f"risen_{rise:g}": int((highest > rise * GRAIN).sum()) for rise in RISES},
        "mean_rise": float(flying.mean()) if len(flying) else 0.0,
        "median_rise": float(np.median(flying)) if len(flying) else 0.0,
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def main() -> None:
    given = options_of(__doc__)
    table = given.out / NAME
    ran = {(row["kind"], row["seed"], row["impact"]) for row in read_rows(table)}
    for name, (beads, count) in kinds().items():
        for seed in SEEDS:
            for number in range(count):
                if (name, seed, number) not in ran:
                    note(table, impact(given.work, name, replace(beads, seed=seed), number))


if __name__ == "__main__":
    main()
