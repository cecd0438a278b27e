"""A 10 cm ball on beads of 1 cm under gravities from Earth's to a thousandth of it (Y3, Y4, and X5 once more).

    python validation/experiments/ball_under_gravities.py --work FOLDER --out FOLDER [--kinds NAME ...]

Beads settle anew under each gravity, so that no similarity makes the answer; those that pull on each other settle under
Earth's, most of which is then taken off. Rows that stand in ball_under_gravities.csv are not run again. Sources:
[Sunday-2021], [Sunday-2022] (depth and duration follow the Froude number), [Murdoch-2017] (depth follows the speed).
"""

import itertools
import math
import time
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from ball_into_beads import SPREAD
from result_rows import Row, note, options_of, read_rows
from sphere_bed import Ball, Beads, bulk_density, dropped, kept

from lithobrake.dem import Material, World
from lithobrake.touchdown import settling

NAME = "ball_under_gravities.csv"
EARTH = 9.81  # m/s2
SHARES = (1.0, 0.1, 0.01, 0.001)  # of Earth's gravity
FROUDE = (0.25, 1.0, 2.5, 6.0)
DIAMETER, DENSITY = 0.1, 2700.0  # m; kg/m3, of the ball: aluminium
# Contact parameters could not be read; friction and restitution are of glass beads, the modulus is as soft as keeps
# what the ball presses in at a thousandth of its size.
GLASS = Material(young_modulus=3e6, poisson_ratio=0.24, restitution=0.8, friction=0.4, density=2500.0)
BED = Beads(
    diameters=tuple(round(0.01 * share, 6) for share in SPREAD), material=GLASS, gravity=EARTH, width=0.26, depth=0.14,
    seed=1, walls=True,
)  # fmt: skip
STIFFER = replace(GLASS, young_modulus=3e7)
STIFF = replace(BED, material=STIFFER, walls=False, tiles=2)
STEPS = 24.0  # in the shortest contact: a ball that lies in the bed has stiffer contacts than one that meets it
PACE = 0.01  # sqrt(D / g) between looks
PULL = 300.0  # Pa, of a contact over the square of a bead's diameter
PULLING = replace(BED, material=replace(GLASS, cohesion_force=PULL * BED.mean_diameter**2), walls=False, tiles=2)
PATIENCE = 200  # periods of a bead on another


class Kind(NamedTuple):
    """Beads; shares of Earth's gravity and Froude numbers of the drops; whether beads settle under all of it first."""

    beads: Beads
    cases: tuple[tuple[float, float], ...]
    eased: bool = False


KINDS = {
    "plain": Kind(BED, tuple(itertools.product(SHARES, FROUDE))),
    "stiffer": Kind(replace(BED, material=STIFFER), tuple((1.0, froude) for froude in FROUDE)),
    "stiffer, periodic": Kind(STIFF, ((1.0, 2.5), (1.0, 6.0))),
    # 0.157 and 0.626 m/s under both.
    "pulling": Kind(PULLING, ((0.1, 0.5), (0.1, 2.0), (0.025, 4.0), (0.025, 1.0)), eased=True),
}


def bed(work: Path, kind: str, share: float) -> World:
    """Return beads of a kind at rest under a share of Earth's gravity, from the work folder where they are there."""
    beads, path = KINDS[kind].beads, work / f"gravities_{kind}_{share:g}.h5"
    if not KINDS[kind].eased:
        return kept(replace(beads, gravity=EARTH * share), work)
    if not path.exists():
        eased(kept(beads, work), beads, EARTH * share).save(path)
    return World.load(path)


def eased(world: World, beads: Beads, gravity: float) -> World:
    """Return beads that were at rest, at rest under a smaller gravity [m/s2].

    Raises ValueError where they are not after their patience.
    """
    period = settling.rest_period(beads.material, beads.mean_diameter, gravity)
    world.drag = settling.contact_drag(period)
    settling.ramp(world, np.array([0.0, 0.0, -gravity]), period)
    for _ in range(PATIENCE):
        settling.run_quietly(world, period)
        calm = settling.kinetic_ratio(world, beads.mean_diameter, gravity) < settling.KINETIC_RATIO
        if calm and settling.unbalanced_force(world) < settling.UNBALANCED_FORCE:
            world.drag = 0.0
            return world
    raise ValueError(f"{beads.count} beads were not at rest under {gravity:g} m/s2: raise PATIENCE")


def drop(work: Path, kind: str, share: float, froude: float) -> Row:
    """Let the ball meet the bed at a Froude number under a share of Earth's gravity."""
    start = time.process_time()
    beads = replace(KINDS[kind].beads, gravity=EARTH * share)
    world = bed(work, kind, share)
    unit = math.sqrt(DIAMETER / beads.gravity)
    speed = froude * DIAMETER / unit
    bulk = bulk_density(world, beads)
    ball = Ball(DIAMETER, DENSITY)
    result, path = dropped(world, ball, beads.material, 0.0, PACE * unit, touch_speed=speed, steps=STEPS)
    np.save(work / f"gravities_{kind}_{share:g}_{froude:g}.npy", path)
    return {
        "kind": kind, "share": share, "froude": froude, "speed": speed, "beads": beads.count, "bulk_density": bulk,
        "depth": result["deepest"], "end_depth": result["depth"], "touch_height": result["touch_height"],
        "duration": result["stopping_time"], "duration_in_units": result["stopping_time"] / unit,
        "peak_deceleration_in_g": result["peak_deceleration"] / beads.gravity,
        "speed_out": max(-float(path[:, 2].min()), 0.0), "cpu_s": time.process_time() - start,
    }  # fmt: skip


def main() -> None:
    given = options_of(__doc__, kinds=tuple(KINDS))
    table = given.out / NAME
    ran = {(row["kind"], row["share"], row["froude"]) for row in read_rows(table)}
    for kind in given.kinds:
        for share, froude in KINDS[kind].cases:
            if (kind, share, froude) not in ran:
                note(table, drop(given.work, kind, share, froude))


if __name__ == "__main__":
    main()
