"""A ball dropped into loose dry beads (X1): depth against density, fall height and diameter of the ball.

    python validation/experiments/ball_into_beads.py --work FOLDER --out FOLDER [--series NAME ...]

Series: drops and diameters are held against the experiment; walls are the same drops in a box; causes drops a light and
a heavy ball into beds that differ step by step; sizes drops other balls into some of them; repose is the slope of a
heap. Rows that stand in the tables are not run again. Sources: [Uehara-2003]; [Ambroso-2005]; [Ambroso-2005b]; for the
set-up DEM-Engine's DEMdemo_BallDrop.cpp.
"""

import time
from dataclasses import replace
from pathlib import Path

from repose import angle_of_repose
from result_rows import Row, note, options_of, read_rows
from sphere_bed import DROP_STEPS, Ball, Beads, bulk_density, dropped, kept

from lithobrake.dem import Material

NAME = "ball_into_beads.csv"
GRAVITY, BALL = 9.81, 0.0254  # m/s2, m
SPREAD = tuple((25 + k) / 30 for k in range(11))  # eleven sizes from 5/6 to 7/6 of the mean
# As in DEM-Engine's demonstration, but for the modulus: there 7e7 Pa.
GLASS = Material(young_modulus=1e7, poisson_ratio=0.24, restitution=0.9, friction=0.3, density=2500.0)
PACE = 5e-4  # s between looks at the ball
LIGHT, HEAVY, FALL = 2200.0, 15000.0, 0.1
OURS, LOOSE, FINE = "3 mm, walls, dense", "5 mm, periodic, loose, deeper", "3 mm, periodic, loose, deeper"
FINER = "2 mm, periodic, loose, deeper"
STIFF = "Young's modulus 70 MPa"
ROLLING_STIFF = f"rolling friction 0.1 and {STIFF}"
DIAMETERS = (0.0127, 0.018, 0.036)
SLOW = 0.6  # sqrt(g d), at which beads fall for a loose bed: the experiment's beds are loose
SERIES = ("drops", "diameters", "walls", "causes", "sizes", "repose")


def bed_of(size: float, width: float = 3.0 * BALL, depth: float = 0.11, **other: float) -> Beads:
    """Return a loose bed of a mean bead size [m] on ground that repeats after three ball diameters, 4.3 deep.

    other: width and depth [m], fall_speed, walls, tiles, least_steps, or a value of the material.
    """
    sizes = tuple(round(share * size, 7) for share in SPREAD)
    plain = Beads(
        diameters=sizes, material=GLASS, gravity=GRAVITY, width=width, depth=depth, seed=1, fall_speed=SLOW, tiles=2
    )
    ours = {key: value for key, value in other.items() if key in Beads.__dataclass_fields__}
    stuff = {key: value for key, value in other.items() if key not in ours}
    return replace(plain, material=replace(GLASS, **stuff), **ours)


def boxed(size: float) -> Beads:
    """Return a bed of a mean bead size [m] between walls, three ball diameters wide, of beads that fell fast."""
    return bed_of(size, depth=0.085, walls=True, tiles=1, fall_speed=Beads.fall_speed)


def causes() -> dict[str, Beads]:
    """Return beds by name, from coarse beads between walls to a loose bed on wide ground, a step at a time."""
    walled = boxed(0.005)
    wide = replace(walled, width=4.0 * BALL, walls=False, tiles=2)
    return {
        "8 mm, walls, dense": boxed(0.008),
        "5 mm, walls, dense": walled,
        "5 mm, periodic as wide as the box": replace(walled, walls=False),
        "5 mm, periodic": wide,
        "5 mm, periodic, 6 ball diameters": replace(wide, width=6.0 * BALL, tiles=3),
        "5 mm, periodic, loose": replace(wide, fall_speed=SLOW),
        LOOSE: replace(wide, fall_speed=SLOW, depth=0.11),
    }


def grains() -> dict[str, Beads]:
    """Return beds that differ from the last of the causes in the law of their contacts, or in the size of the beads."""
    wide, both = {"width": 4.0 * BALL}, {"rolling_friction": 0.1, "young_modulus": 7e7}
    return {
        "5 mm, as the one before, friction 0.6": bed_of(0.005, **wide, friction=0.6),
        f"{LOOSE}, restitution 0.5": bed_of(0.005, **wide, restitution=0.5, least_steps=60.0),
        f"{LOOSE}, rolling friction 0.1": bed_of(0.005, **wide, rolling_friction=0.1),
        f"{LOOSE}, poured at a third of the speed": bed_of(0.005, **wide, fall_speed=SLOW / 3.0),
        f"{LOOSE}, {STIFF}": bed_of(0.005, **wide, young_modulus=7e7),
        f"{LOOSE}, {ROLLING_STIFF}": bed_of(0.005, **wide, **both),
        f"{LOOSE}, second pour": bed_of(0.005, **wide, seed=2),
        f"{LOOSE}, third pour": bed_of(0.005, **wide, seed=3),
        FINE: bed_of(0.003),
        f"{FINE}, second pour": bed_of(0.003, seed=2),
        f"{FINE}, {ROLLING_STIFF}": bed_of(0.003, **both),
        FINER: bed_of(0.002),
    }


def drops() -> dict[str, list[tuple[str, Beads, Ball, float]]]:
    """Return by series what is dropped: name of the bed, bed, ball, fall [m]."""
    light, every = Ball(BALL, LIGHT), causes() | grains()
    return {
        "drops": twelve(FINE, every[FINE]),
        "diameters": [(FINE, every[FINE], light._replace(diameter=d), FALL) for d in DIAMETERS],
        "walls": twelve(OURS, boxed(0.003))
        + [(OURS, boxed(0.003), light._replace(diameter=d), FALL) for d in DIAMETERS],
        "causes": [(name, bed, Ball(BALL, density), FALL) for name, bed in every.items() for density in (LIGHT, HEAVY)],
        "sizes": [
            (name, every[name], light._replace(diameter=d), FALL)
            for name in ("5 mm, walls, dense", LOOSE) for d in DIAMETERS
        ],
    }  # fmt: skip


def twelve(name: str, bed: Beads) -> list[tuple[str, Beads, Ball, float]]:
    """Return the drops of the experiment: four balls from three heights."""
    return [
        (name, bed, Ball(BALL, density), fall)
        for fall in (FALL, 0.05, 0.2) for density in (LIGHT, HEAVY, 7800.0, 3800.0)
    ]  # fmt: skip


def drop_row(work: Path, name: str, beads: Beads, ball: Ball, fall: float) -> Row:
    start = time.process_time()
    world = kept(beads, work)
    bulk = bulk_density(world, beads)
    result, _ = dropped(world, ball, beads.material, fall, PACE, steps=max(DROP_STEPS, beads.least_steps))
    return {
        "bed": name, "density": ball.density, "fall": fall, "diameter": ball.diameter,
        "bead_size": beads.mean_diameter, "beads": beads.count, "width": beads.width, "bed_depth": beads.depth,
        "walls": str(beads.walls), "tiles": beads.tiles, "fall_speed": beads.fall_speed,
        "young_modulus": beads.material.young_modulus, "bulk_density": bulk, **result,
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def run_drops(series: str, work: Path, out: Path) -> None:
    ran = {(row["bed"], row["density"], row["diameter"], row["fall"]) for row in read_rows(out / NAME)}
    for name, beads, ball, fall in drops()[series]:
        if (name, ball.density, ball.diameter, fall) not in ran:
            note(out / NAME, drop_row(work, name, beads, ball, fall))


def main() -> None:
    given = options_of(__doc__, series=SERIES)
    for series in given.series:
        if series == "repose":
            heaps = given.out / "repose.csv"
            for seed in range(1 + len(read_rows(heaps)), 3):
                note(heaps, angle_of_repose(bed_of(0.005), seed))
        else:
            run_drops(series, given.work, given.out)


if __name__ == "__main__":
    main()
