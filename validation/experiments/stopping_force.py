"""The force that stops a ball in loose beads: paths of steel balls, and of a lighter and a heavier one.

    python validation/experiments/stopping_force.py --work FOLDER --out FOLDER [--beds NAME ...]

The beds are those of ball_into_beads.py. Their beads are coarser than the experiment's, with the packing and the slope
of a heap that the experiment states. The bed of 3 mm is compared; others show what the size and the modulus of the
beads do. Writes a row for each drop, and the looks at its path. Rows that stand in the table are not run again.

Source: [Katsuragi-2007].
"""

import time
from pathlib import Path

from ball_into_beads import BALL, FINE, HEAVY, LIGHT, LOOSE, PACE, causes, grains
from ball_into_beads import STIFF as STIFF_BEADS
from harness import write_rows
from result_rows import Row, note, options_of, read_rows
from sphere_bed import Ball, bulk_density, dropped, kept

NAME, PATHS = "stopping_force.csv", "stopping_force_paths.csv"
STEEL = 8070.0  # kg/m3
FALLS = (0.05, 0.1, 0.2)  # m
COMPARED, COARSE, STIFF = "3 mm", "5 mm", "5 mm, 70 MPa"
EVERY = causes() | grains()
BEDS = {COMPARED: EVERY[FINE], COARSE: EVERY[LOOSE], STIFF: EVERY[f"{LOOSE}, {STIFF_BEADS}"]}
# Falls [m] of balls by bed and density; the experiment's are 0 to 0.8 m.
DROPS = {
    (COMPARED, STEEL): (0.02, *FALLS, 0.4),
    (COMPARED, LIGHT): FALLS,
    (COMPARED, HEAVY): FALLS,
    (COARSE, STEEL): (*FALLS, 0.4),
    (STIFF, STEEL): (*FALLS, 0.4),
}
LOOK = ("time", "depth", "speed", "deceleration")


def drop(work: Path, out: Path, bed: str, density: float, fall: float) -> Row:
    start, beads = time.process_time(), BEDS[bed]
    world = kept(beads, work)
    bulk = bulk_density(world, beads)
    result, path = dropped(world, Ball(BALL, density), beads.material, fall, PACE)
    told = {"bed": bed, "density": density, "fall": fall}
    # A drop that was broken off before its row was written has left looks.
    rows = [row for row in read_rows(out / PATHS) if {key: row[key] for key in told} != told]
    rows += [told | {name: float(f"{value:.6g}") for name, value in zip(LOOK, look, strict=True)} for look in path]
    write_rows(out / PATHS, rows[0], rows)
    return {
        "bed": bed, "density": density, "fall": fall, "diameter": BALL, "beads": beads.count, "bulk_density": bulk,
        **result, "cpu_s": time.process_time() - start,
    }  # fmt: skip


def main() -> None:
    given = options_of(__doc__, beds=tuple(BEDS))
    ran = {(row["bed"], row["density"], row["fall"]) for row in read_rows(given.out / NAME)}
    for (bed, density), falls in DROPS.items():
        for fall in falls:
            if bed in given.beds and (bed, density, fall) not in ran:
                note(given.out / NAME, drop(given.work, given.out, bed, density, fall))


if __name__ == "__main__":
    main()
