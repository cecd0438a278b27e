"""Does a landing feel the walls and the floor? The same landings on a bed and on one twice as wide and deep.

    python validation/bed_size.py [--placements 10] [--out validation]

Several beds of each size, since one bed differs from the next. Writes bed_size.csv, a line for each landing as it ends,
and bed_size.json with the means and their standard errors, anew after each bed. Places and attitudes are drawn once,
and are the same on all beds. Landings that stand in bed_size.csv already are not run again: delete it to start anew.
"""

import math
import sys
import time
from collections import Counter
from functools import cache
from pathlib import Path

import numpy as np

from lithobrake.dem import Box, Material
from lithobrake.touchdown import Bed, BedRecipe, ContactModel, GrainSizes, Lander, Landing, land, pour_bed
from lithobrake.touchdown.lander import smallest_bed

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row, add_row, command_line, origin, read_rows, write_document

ROCK = Material(young_modulus=1.5e6, poisson_ratio=0.25, restitution=0.5, friction=0.7, density=2500.0)
GRAVITY, DIAMETER, CONTACT = 5e-5, 0.09, ContactModel(steps_per_contact=30.0)
BEDS = {"plain": (150, 0.7), "double": (1200, 1.4)}  # number of grains, width [m]
SEEDS = {"plain": (3, 4, 5, 6, 7, 8), "double": (3, 4, 5)}
LANDINGS = {"steep": (0.4, 0.0), "slanted": (0.4, 15.0), "slow": (0.2, 30.0)}  # m/s, deg from the normal
LANDER = Lander(shape=Box((0.1, 0.1, 0.1)), mass=1.3, inertia=None, material=ROCK)
OUTPUTS = ("speed_out", "elevation_out", "spin_out")
KINDS = {"bed": str, "seed": int, "landing": str, "placement": int, "status": str}


@cache
def bed(name: str, seed: int, folder: Path) -> Bed:
    """Return a bed, poured unless it lies there."""
    path = folder / f"bed_size_{name}_{seed}.h5"
    if not path.exists():
        count, width = BEDS[name]
        sizes = GrainSizes(distribution="constant", lower=DIAMETER, upper=DIAMETER)
        recipe = BedRecipe(
            grain_count=count, sizes=sizes, cloud_point_count=14, width=(width, width), material=ROCK,
            gravity=(0.0, 0.0, -GRAVITY), pour_gravity=0.1, seed=seed, contact=CONTACT,
        )  # fmt: skip
        pour_bed(recipe).save(path)
    return Bed.load(path)


def landings(name: str, seed: int, placements: int, folder: Path) -> list[Row]:
    """Land at each place in each way on a bed, and note it in the table; what stands there is done."""
    table = folder / "bed_size.csv"
    noted = [row for row in read_rows(table, KINDS) if (row["bed"], row["seed"]) == (name, seed)]
    done = {(row["landing"], row["placement"]): row for row in noted}
    rows: list[Row] = []
    generator = np.random.default_rng(11)
    for placement in range(placements):
        place = tuple(generator.uniform(-0.1, 0.1, size=2))
        attitude = tuple(generator.normal(size=4))
        azimuth = float(generator.uniform(-math.pi, math.pi))
        for way, (speed, incidence_deg) in LANDINGS.items():
            if (way, placement) in done:
                rows.append(done[way, placement])
                continue
            landing = Landing(
                grain=ROCK, speed=speed, incidence=math.radians(incidence_deg), azimuth=azimuth, place=place,
                orientation=attitude, spin=(0.0, 0.0, 0.0), gravity=(0.0, 0.0, -GRAVITY), time_limit=60.0,
                contact=CONTACT,
            )  # fmt: skip
            outcome = land(bed(name, seed, folder), LANDER, landing)
            rows.append(
                {"bed": name, "seed": seed, "landing": way, "placement": placement, "status": outcome.status}
                | {key: outcome.outputs[key] for key in OUTPUTS}
            )
            add_row(table, rows[-1])
    return rows


def bed_means(rows: list[Row], name: str, way: str, key: str) -> np.ndarray:
    """Mean of an output over the landings that left upward, one for each bed of a size."""
    of = [row for row in rows if row["bed"] == name and row["landing"] == way and row["status"] == "clear"]
    return np.array([np.mean([row[key] for row in of if row["seed"] == seed]) for seed in {row["seed"] for row in of}])


def summary(rows: list[Row]) -> Row:
    """Means over beds, their scatter, and the difference of the sizes in standard errors of beds."""
    result: Row = {}
    for way in LANDINGS:
        entry: Row = {
            "outcomes": {
                name: dict(Counter(str(r["status"]) for r in rows if r["bed"] == name and r["landing"] == way))
                for name in BEDS
            }
        }
        for key in OUTPUTS:
            means = {name: bed_means(rows, name, way, key) for name in BEDS}
            if min(len(values) for values in means.values()) < 2:
                continue
            error = math.sqrt(sum(values.var(ddof=1) / len(values) for values in means.values()))
            entry[key] = {name: float(values.mean()) for name, values in means.items()} | {
                "scatter": {name: float(values.std(ddof=1)) for name, values in means.items()},
                "beds": {name: len(values) for name, values in means.items()},
                "difference_in_standard_errors": float((means["double"].mean() - means["plain"].mean()) / error),
            }
        result[way] = entry
    return result


def main() -> None:
    chosen = command_line(__doc__, placements=10, out=Path(__file__).parent).parse_args()
    start, rows = time.process_time(), []
    rule = {way: smallest_bed(LANDER, ROCK, DIAMETER, speed) for way, (speed, _) in LANDINGS.items()}
    turns = [(name, seed) for k in range(6) for name in BEDS for seed in SEEDS[name][k : k + 1]]
    for name, seed in turns:
        rows += landings(name, seed, chosen.placements, chosen.out)
        document = {
            **origin(f"validation/bed_size.py --placements {chosen.placements}"),
            "cpu_s": round(time.process_time() - start), "smallest_width_and_depth_m": rule, "landings": summary(rows),
        }  # fmt: skip
        write_document(chosen.out / "bed_size.json", document)
        print(f"{name} {seed}: {document['cpu_s']} s of CPU time", flush=True)


if __name__ == "__main__":
    main()
