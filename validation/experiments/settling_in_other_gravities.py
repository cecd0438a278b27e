"""A sphere released at the surface of a light granular bed under gravities from Earth's to a tenth of it (X5).

    python validation/experiments/settling_in_other_gravities.py --work FOLDER --out FOLDER

The bed falls and settles anew under each gravity, of the same modulus: no similarity makes the answer. Rows that stand
in settling_in_other_gravities.csv are not run again. Source: [Altshuler-2014].
"""

import math
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from ball_into_beads import SLOW, SPREAD
from result_rows import Row, note, options_of, read_rows
from sphere_bed import Ball, Beads, bulk_density, dropped, kept

from lithobrake.dem import Material

NAME = "settling_in_other_gravities.csv"
EARTH = 9.81  # m/s2
SHARES = (1.0, 0.4, 0.1)  # of Earth's gravity
# The source's grains and sphere could not be read. Light: an eighth of the sphere's density, so that it sinks by more
# than its diameter. The modulus is above 1e4 times density, gravity and diameter of the sphere under every gravity.
GRAINS = Material(young_modulus=5e6, poisson_ratio=0.24, restitution=0.9, friction=0.3, density=1000.0)
DENSITY, DIAMETER = 8000.0, 0.0105  # kg/m3, m, of the sphere
BED = Beads(
    diameters=tuple(round(0.0021 * share, 7) for share in SPREAD), material=GRAINS, gravity=EARTH,
    width=3.0 * DIAMETER, depth=3.5 * DIAMETER, seed=1, fall_speed=SLOW, tiles=2,
)  # fmt: skip
SOFT = 5e5  # Pa, of softer grains, to see what the modulus does
PLACES = ((0.0, 0.0), (0.25 * BED.width, 0.25 * BED.width))  # m, between and amid the tiles
STEPS = 24.0  # in the shortest contact: a ball that lies in the bed has stiffer contacts than one that meets it
PACE = 0.02  # sqrt(D / g) between looks


def settled(work: Path, bed: Beads, share: float, place: int) -> Row:
    start = time.process_time()
    beads = replace(bed, gravity=EARTH * share)
    world = kept(beads, work)
    bulk = bulk_density(world, beads)
    pace = PACE * math.sqrt(DIAMETER / beads.gravity)
    result, path = dropped(world, Ball(DIAMETER, DENSITY, PLACES[place]), beads.material, 0.0, pace, steps=STEPS)
    np.save(work / f"settling_{share:g}_{beads.seed}_{place}.npy", path)
    most = int(np.argmax(path[:, 1] >= path[0, 1] + 0.9 * (result["deepest"] - path[0, 1])))
    return {
        "share": share, "seed": beads.seed, "place": place, "beads": beads.count,
        "young_modulus": beads.material.young_modulus, "bulk_density": bulk, "touch_height": result["touch_height"],
        "depth": result["deepest"], "stopping_time": result["stopping_time"], "time_to_90": float(path[most, 0]),
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def cases() -> list[tuple[Beads, float, int]]:
    """Return what is run: bed, share of Earth's gravity, number of the place."""
    softer = replace(BED, material=replace(GRAINS, young_modulus=SOFT))
    return [
        (replace(bed, seed=seed), share, place)
        for seed in (1, 2) for bed in (BED, softer) for share in SHARES for place in range(len(PLACES))
    ]  # fmt: skip


def main() -> None:
    given = options_of(__doc__)
    table = given.out / NAME
    ran = {(row["young_modulus"], row["share"], row["seed"], row["place"]) for row in read_rows(table)}
    for bed, share, place in cases():
        if (bed.material.young_modulus, share, bed.seed, place) not in ran:
            note(table, settled(given.work, bed, share, place))


if __name__ == "__main__":
    main()
