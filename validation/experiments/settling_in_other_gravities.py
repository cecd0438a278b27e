"""A sphere released at the surface of a light granular bed under gravities from Earth's to 1e-4 of it (X5).

    python validation/experiments/settling_in_other_gravities.py --work FOLDER

The bed falls and settles anew under each gravity, of the same modulus: no similarity makes the answer. Rows that stand
in settling_in_other_gravities.csv are not run again.

Source: [Altshuler-2014].
"""

import itertools
import math
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from ball_into_beads import SPREAD
from sphere_bed import Beads, Row, bulk_density, dropped, kept, note, read_rows, work_folder

from lithobrake.dem import Material, Sphere

TABLE = Path(__file__).parent / "settling_in_other_gravities.csv"
COMMAND = "settling_in_other_gravities.py --work FOLDER"
SHARES = (1.0, 0.4, 0.1, 0.01, 1e-4)  # of Earth's gravity
# The source's grains and sphere could not be read. Light: a third of the sphere's density.
GRAINS = Material(young_modulus=2e5, poisson_ratio=0.24, restitution=0.9, friction=0.3, density=1000.0)
DENSITY, DIAMETER = 3000.0, 0.0105  # of the sphere
BED = Beads(
    diameters=tuple(round(0.003 * share, 7) for share in SPREAD), material=GRAINS, gravity=9.81, width=0.0255,
    depth=0.021, seed=1,
)  # fmt: skip
PLACES = ((0.0, 0.0), (0.0015, 0.0), (0.0, 0.0015))


def settled(work: Path, share: float, seed: int, place: int) -> Row:
    """Release the sphere at a place of a bed under a share of Earth's gravity."""
    start = time.process_time()
    beads = replace(BED, gravity=9.81 * share, seed=seed)
    world = kept(beads, work)
    mass = DENSITY * math.pi / 6.0 * DIAMETER**3
    pace = 0.02 * math.sqrt(DIAMETER / beads.gravity)
    bulk = bulk_density(world, beads)
    result, path = dropped(world, Sphere(0.5 * DIAMETER), GRAINS, mass, PLACES[place], 0.0, pace)
    np.save(work / f"settling_{share:g}_{seed}_{place}.npy", path)
    most = int(np.argmax(path[:, 1] >= path[0, 1] + 0.9 * (result["deepest"] - path[0, 1])))
    return {
        "share": share, "seed": seed, "place": place, "beads": beads.count, "bulk_density": bulk,
        "touch_height": result["touch_height"], "depth": result["deepest"],
        "stopping_time": result["stopping_time"], "time_to_90": float(path[most, 0]),
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def main() -> None:
    """Run what has no row yet, bed after bed."""
    work = work_folder(__doc__).parse_args().work
    work.mkdir(parents=True, exist_ok=True)
    ran = {(row["share"], row["seed"], row["place"]) for row in read_rows(TABLE)}
    for seed, share, place in itertools.product((1, 2, 3), SHARES, range(len(PLACES))):
        # Under the least gravity a bed and a drop cost forty times as much: one place, and last.
        if share >= 1e-3 and (share, seed, place) not in ran:
            note(TABLE, settled(work, share, seed, place), COMMAND)
    for seed in (1, 2):
        if (SHARES[-1], seed, 0) not in ran:
            note(TABLE, settled(work, SHARES[-1], seed, 0), COMMAND)


if __name__ == "__main__":
    main()
