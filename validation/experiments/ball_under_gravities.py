"""A 10 cm ball on beads of 1 cm under gravities from Earth's to a thousandth of it (Y3, Y4, and X5 once more).

    python validation/experiments/ball_under_gravities.py --work FOLDER [--froude 0 0.5 ...] [--shares 1 0.1 ...]

The beads are of one modulus under every gravity and settle anew under each, so that no similarity makes the answer.
Froude number: speed at the first touch over sqrt(g D), D the ball's diameter. Rows that stand in
ball_under_gravities.csv are not run again.

Sources: [Sunday-2021], [Sunday-2022] (depth and duration follow the Froude number), [Murdoch-2017] (depth follows the
speed and no gravity).
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

TABLE = Path(__file__).parent / "ball_under_gravities.csv"
SHARES = (1.0, 0.1, 0.01, 0.001)  # of Earth's gravity
FROUDE = (0.0, 0.25, 0.5, 1.0, 1.5, 2.5, 4.0, 6.0)
DIAMETER, DENSITY = 0.1, 2700.0  # m; kg/m3, of the ball: aluminium
# Contact parameters could not be read; friction and restitution are of glass beads, the modulus is as soft as keeps
# what the ball presses in at a thousandth of its size.
GLASS = Material(young_modulus=3e6, poisson_ratio=0.24, restitution=0.8, friction=0.4, density=2500.0)
BED = Beads(
    diameters=tuple(round(0.01 * share, 6) for share in SPREAD), material=GLASS, gravity=9.81, width=0.26, depth=0.14,
    seed=1,
)  # fmt: skip
STEPS = 24.0  # in the shortest contact: a ball that lies in the bed has stiffer contacts than one that meets it
PACE = 0.01  # sqrt(D / g) between looks


def drop(work: Path, share: float, froude: float) -> Row:
    """Let the ball meet the bed at a Froude number under a share of Earth's gravity."""
    beads = replace(BED, gravity=9.81 * share)
    world = kept(beads, work)
    start = time.process_time()
    unit = math.sqrt(DIAMETER / beads.gravity)
    speed = froude * DIAMETER / unit
    mass = DENSITY * math.pi / 6.0 * DIAMETER**3
    bulk = bulk_density(world, beads)
    result, path = dropped(
        world, Sphere(0.5 * DIAMETER), GLASS, mass, (0.0, 0.0), 0.0, PACE * unit, touch_speed=speed, steps=STEPS
    )  # fmt: skip
    np.save(work / f"gravities_{share:g}_{froude:g}.npy", path)
    return {
        "share": share, "froude": froude, "speed": speed, "beads": beads.count, "bulk_density": bulk,
        "depth": result["deepest"], "end_depth": result["depth"], "touch_height": result["touch_height"],
        "duration": result["stopping_time"], "duration_in_units": result["stopping_time"] / unit,
        "peak_deceleration_in_g": result["peak_deceleration"] / beads.gravity,
        "speed_out": max(-float(path[:, 2].min()), 0.0), "cpu_s": time.process_time() - start,
    }  # fmt: skip


def main() -> None:
    """Run what has no row yet."""
    parser = work_folder(__doc__)
    parser.add_argument("--froude", type=float, nargs="*", default=FROUDE)
    parser.add_argument("--shares", type=float, nargs="*", default=SHARES)
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    ran = {(row["share"], row["froude"]) for row in read_rows(TABLE)}
    for share, froude in itertools.product(given.shares, given.froude):
        if (share, froude) not in ran:
            note(TABLE, drop(given.work, share, froude), "ball_under_gravities.py --work FOLDER")


if __name__ == "__main__":
    main()
