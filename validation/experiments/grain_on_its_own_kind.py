"""A grain shot at .8 m/s onto a bed of its own kind, under Earth's gravity (X2).

    python validation/experiments/grain_on_its_own_kind.py --work FOLDER [--impacts 100]

Basalt spheres of 150 um, at random points of the bed. Rows that stand in grain_on_its_own_kind.csv are not run again.

Source: [Bogdan-2020].
"""

import math
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from sphere_bed import Beads, Row, kept, note, read_rows, steps_for, work_folder

from lithobrake.dem import Material, Sphere, World

TABLE = Path(__file__).parent / "grain_on_its_own_kind.csv"
GRAIN, SPEED, GRAVITY = 150e-6, 0.8, 9.81
# A little apart in size, so that the bed does not order. Restitution and friction of basalt grains are not in the
# source's abstract: .8 is near what rock spheres have ([Durda-2011]: .83).
BASALT = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=0.8, friction=0.5, density=2900.0)
BED = Beads(
    diameters=(0.95 * GRAIN, GRAIN, 1.05 * GRAIN), material=BASALT, gravity=GRAVITY, width=10 * GRAIN,
    depth=8 * GRAIN, seed=1,
)  # fmt: skip
FOLLOWED, LOOK = 1.5e-3, 5e-5  # s
REACH = 2.5  # grains from the middle within which a point is hit
STEPS = 15.0  # in the shortest contact
RISES = (0.1, 0.5, 1.0)  # grain diameters above where a grain lay


def kinds() -> dict[str, tuple[Beads, float]]:
    """Return the beds by name, and the share of the impacts that each gets."""
    return {
        "basalt": (BED, 1.0),
        "restitution_0.5": (replace(BED, material=replace(BASALT, restitution=0.5)), 0.4),
        "friction_0.2": (replace(BED, material=replace(BASALT, friction=0.2)), 0.4),
        "stiffer": (replace(BED, material=replace(BASALT, young_modulus=1e8)), 0.2),
        "wider_and_deeper": (replace(BED, width=14 * GRAIN, depth=12 * GRAIN), 0.4),
    }


def shot(world: World, material: Material, point: tuple[float, float]) -> tuple[int, World]:
    """Put a grain just above the bed over a point, on its way down; return its number and the world."""
    offset = world.position[:, :2] - point
    radius = np.array([body.shape.bounding_radius for body in world.bodies])
    span = (0.5 * GRAIN + radius) ** 2 - (offset**2).sum(axis=1)
    height = float((world.position[:, 2] + np.sqrt(np.maximum(span, 0.0)))[span > 0.0].max()) + 0.02 * GRAIN
    body = world.add_body(Sphere(0.5 * GRAIN), material, (*point, height), velocity=(0.0, 0.0, -SPEED))
    world.time_step = world.shortest_contact(SPEED) / steps_for(material, STEPS)
    return body, world


def impact(work: Path, name: str, beads: Beads, number: int) -> Row:
    """Follow one impact for 1.5 ms; return how fast the grain leaves, and how high the others fly.

    A rise is that of a grain's centre above where it lay, in free flight, by the time it would be on top. The grain
    leaves at the last look at which it touched something; it is trapped where it still does at the end.
    """
    start = time.process_time()
    world = kept(beads, work)
    lay = world.position
    point = np.random.default_rng(number).uniform(-REACH, REACH, 2) * GRAIN
    body, world = shot(world, beads.material, (float(point[0]), float(point[1])))
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
        "kind": name, "impact": number, "beads": len(lay), "speed_ratio": float(np.linalg.norm(out)) / SPEED,
        "vertical_ratio": float(out[2]) / SPEED,
        **{f"risen_{rise:g}": int((highest > rise * GRAIN).sum()) for rise in RISES},
        "mean_rise": float(flying.mean()) if len(flying) else 0.0,
        "median_rise": float(np.median(flying)) if len(flying) else 0.0,
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def main() -> None:
    """Run what has no row yet."""
    given = work_folder(__doc__, impacts=100).parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    ran = {(row["kind"], row["impact"]) for row in read_rows(TABLE)}
    for name, (beads, share) in kinds().items():
        for number in range(math.ceil(share * given.impacts)):
            if (name, number) not in ran:
                note(TABLE, impact(given.work, name, beads, number), "grain_on_its_own_kind.py --work FOLDER")


if __name__ == "__main__":
    main()
