"""Landings on slopes: ground that repeats, held by its rough floor, against beds of four times the area between walls.

    python validation/periodic_slopes.py [--beds FOLDER] [--out validation]

Grains and lander are those of periodic_ground.py but for their friction, which is less than the tangent of either
slope. The lander comes at 0.4 m/s, 30 degrees from the normal and downhill, in attitudes that are drawn once. Writes
periodic_slopes.csv, a line for each landing as it ends, and periodic_slopes.json with the means.
"""

import math
import sys
import tempfile
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
from periodic_ground import CONTACT, DIAMETER, GRAVITY, LANDER, ROCK, over_beds

from lithobrake.touchdown import Bed, BedRecipe, GrainSizes, Landing, land, pour_bed

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row, add_row, command_line, origin, read_rows, write_document

SOIL = replace(ROCK, friction=0.3)
# Sides, grains, width [m], beds, landings on each.
GROUNDS = {"periodic": (150, 0.7, 6, 12), "walls": (600, 1.4, 3, 24)}
SLOPES = (20.0, 30.0)
OUTPUTS = ("speed_out", "elevation_out", "spin_out", "penetration")
KINDS = dict.fromkeys(("sides", "status"), str) | dict.fromkeys(("bed", "landing"), int)


def gravity(slope_deg: float) -> tuple[float, float, float]:
    """Local gravity [m/s2], downhill along x."""
    slope, strength = math.radians(slope_deg), -GRAVITY[2]
    return strength * math.sin(slope), 0.0, -strength * math.cos(slope)


def bed(sides: str, slope_deg: float, number: int, folder: Path) -> Bed:
    """Return a bed, poured unless it lies in the folder."""
    path, (count, width, _, _) = folder / f"slope_{sides}_{slope_deg:g}_{number}.h5", GROUNDS[sides]
    if not path.exists():
        recipe = BedRecipe(
            grain_count=count, sizes=GrainSizes(distribution="constant", lower=DIAMETER, upper=DIAMETER),
            cloud_point_count=14, width=(width, width), material=SOIL, gravity=gravity(slope_deg), pour_gravity=0.5,
            seed=number, contact=CONTACT, sides=sides,
        )  # fmt: skip
        pour_bed(recipe).save(path)
    return Bed.load(path)


def land_on(sides: str, slope_deg: float, number: int, chosen: Row) -> None:
    """Make the landings on a bed that do not stand in the table."""
    table, (_, width, _, count) = chosen["out"] / "periodic_slopes.csv", GROUNDS[sides]
    here = (sides, slope_deg, number)
    rows = read_rows(table, KINDS)
    done = {row["landing"] for row in rows if (row["sides"], row["slope_deg"], row["bed"]) == here}
    ground, half = bed(*here, chosen["beds"]), 0.5 * width if sides == "periodic" else 0.25 * width
    for k in sorted(set(range(count)) - done):
        generator = np.random.default_rng([12, number * count + k])
        attitude = tuple(generator.normal(size=4))
        x, y = half * generator.uniform(-1.0, 1.0, size=2)
        one = Landing(
            grain=SOIL, speed=0.4, incidence=math.radians(30.0), azimuth=0.0, place=(float(x), float(y)),
            orientation=attitude, spin=(0.0, 0.0, 0.0), gravity=gravity(slope_deg), time_limit=60.0, contact=CONTACT,
        )  # fmt: skip
        outcome = land(ground, replace(LANDER, material=SOIL), one)
        row: Row = {"sides": sides, "slope_deg": slope_deg, "bed": number, "landing": k, "status": outcome.status.value}
        add_row(table, row | {key: outcome.outputs[key] for key in OUTPUTS}, 6)


def summary(out: Path) -> list[Row]:
    """What became of the lander, by slope and sides."""
    rows, result = read_rows(out / "periodic_slopes.csv", KINDS), []
    for slope_deg in SLOPES:
        for sides in GROUNDS:
            of = [row for row in rows if (row["sides"], row["slope_deg"]) == (sides, slope_deg)]
            outcomes = dict(Counter(str(row["status"]) for row in of))
            means = {key: over_beds(of, key) for key in OUTPUTS}
            result.append({"slope_deg": slope_deg, "sides": sides, "outcomes": outcomes, **means})
    return result


def main() -> None:
    chosen = command_line(__doc__, beds=Path(tempfile.gettempdir()), out=Path(__file__).parent).parse_args()
    chosen.beds.mkdir(parents=True, exist_ok=True)
    for sides, (_, _, bed_count, _) in GROUNDS.items():
        for slope_deg in SLOPES:
            for number in range(bed_count):
                land_on(sides, slope_deg, number, vars(chosen))
    document = {**origin("validation/periodic_slopes.py"), "friction": SOIL.friction, "slopes": summary(chosen.out)}
    write_document(chosen.out / "periodic_slopes.json", document)


if __name__ == "__main__":
    main()
