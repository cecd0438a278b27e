"""What walls do to beds and landings: the same soil and lander between walls of three widths, and on periodic ground.

    python validation/periodic_ground.py [--grounds NAME ...] [--beds FOLDER] [--out validation]

docs/validation/periodic_ground.md has the set-up. Heading and attitude of a landing are the same on all grounds. Writes
periodic_ground_beds.csv, a line for each bed, and periodic_ground.csv, a line for each landing, as they end. What
stands there already is not done again: delete both to start anew. periodic_ground.json has the means.
"""

import math
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import numpy as np

from lithobrake.dem import Box, Material
from lithobrake.touchdown import Bed, BedRecipe, ContactModel, GrainSizes, Lander, Landing, land, pour_bed
from lithobrake.touchdown.lander import smallest_bed

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row, add_row, command_line, origin, read_rows, timed, write_document

ROCK = Material(
    young_modulus=math.sqrt(5e5 * 5e6), poisson_ratio=0.25, restitution=0.6, friction=0.75, density=2500.0
)  # fmt: skip
GRAVITY, DIAMETER = (0.0, 0.0, -5e-5), 0.09
CONTACT = ContactModel(held_speed=0.03)
LANDER = Lander(shape=Box((0.1, 0.1, 0.227)), mass=2.0, material=ROCK)


class Ground(NamedTuple):
    """How beds are made: grain_count and width [m] along x and y; how many, and how many landings in a way on each."""

    sides: str
    grain_count: int
    width: float
    bed_count: int
    landing_count: int


GROUNDS = {
    "periodic 0.56 m": Ground("periodic", 96, 0.56, 8, 25),
    "periodic 0.7 m": Ground("periodic", 150, 0.7, 8, 25),
    "walls 0.7 m": Ground("walls", 150, 0.7, 8, 25),
    "periodic 1.0 m": Ground("periodic", 306, 1.0, 6, 34),
    "periodic 1.4 m": Ground("periodic", 600, 1.4, 6, 34),
    "walls 1.4 m": Ground("walls", 600, 1.4, 6, 34),
    "walls 2.8 m": Ground("walls", 2400, 2.8, 3, 67),
}
# Speed [m/s], incidence [deg], time limit [s].
WAYS = {"steep": (0.4, 15.0, 60.0), "flat": (0.4, 75.0, 60.0), "slow": (0.03, 75.0, 600.0)}
OUTPUTS = ("speed_out", "elevation_out", "spin_out", "penetration")
KINDS = dict.fromkeys(("ground", "way", "status"), str) | dict.fromkeys(("bed", "landing"), int)


def bed(name: str, number: int, folder: Path, out: Path) -> Bed:
    """Return a bed, poured and noted unless it lies in the folder."""
    ground, path = GROUNDS[name], folder / f"{name.replace(' ', '_')}_{number}.h5"
    if path.exists():
        return Bed.load(path)
    recipe = BedRecipe(
        grain_count=ground.grain_count, sizes=GrainSizes(distribution="constant", lower=DIAMETER, upper=DIAMETER),
        cloud_point_count=14, width=(ground.width, ground.width), material=ROCK, gravity=GRAVITY, pour_gravity=0.5,
        seed=number, contact=CONTACT, sides=ground.sides,
    )  # fmt: skip
    poured, cpu = timed(lambda: pour_bed(recipe))
    poured.save(path)
    row: Row = {
        "ground": name, "bed": number, "solid_fraction": poured.solid_fraction,
        "coordination_number": poured.coordination_number, "surface_height": poured.surface_height, "cpu_s": cpu,
    }  # fmt: skip
    add_row(out / "periodic_ground_beds.csv", row, 6)
    return poured


def landing(name: str, way: str, number: int, first: int) -> Landing:
    """Return a landing of a ground; first: its number among all of the ground, by which it is drawn."""
    ground, (speed, incidence_deg, time_limit) = GROUNDS[name], WAYS[way]
    generator = np.random.default_rng([11, list(WAYS).index(way), first + number])
    attitude, azimuth = tuple(generator.normal(size=4)), float(generator.uniform(-math.pi, math.pi))
    half = 0.5 * ground.width
    if ground.sides == "walls":
        half = min(0.5 * half, half - 0.5 * smallest_bed(LANDER, ROCK, DIAMETER, speed)[0])
    x, y = half * generator.uniform(-1.0, 1.0, size=2)
    return Landing(
        grain=ROCK, speed=speed, incidence=math.radians(incidence_deg), azimuth=azimuth, place=(float(x), float(y)),
        orientation=attitude, spin=(0.0, 0.0, 0.0), gravity=GRAVITY, time_limit=time_limit, contact=CONTACT,
    )  # fmt: skip


def land_on(name: str, number: int, folder: Path, out: Path) -> None:
    """Make the landings of a bed that do not stand in the table."""
    table, count = out / "periodic_ground.csv", GROUNDS[name].landing_count
    done = {(r["way"], r["landing"]) for r in read_rows(table, KINDS) if (r["ground"], r["bed"]) == (name, number)}
    ground = bed(name, number, folder, out)
    for way in WAYS:
        for k in range(count):
            if (way, k) in done:
                continue
            one = landing(name, way, k, number * count)
            outcome, cpu = timed(lambda one=one: land(ground, LANDER, one))  # type: ignore[misc]
            row: Row = {"ground": name, "bed": number, "way": way, "landing": k, "status": outcome.status.value}
            row |= {key: outcome.outputs[key] for key in OUTPUTS}
            row |= {"periods_travelled": outcome.outputs.get("periods_travelled", math.nan), "cpu_s": cpu}
            add_row(table, row, 6)


def over_beds(rows: list[Row], key: str) -> Row | None:
    """Mean of all rows, and its standard error by the ratio estimator over beds.

    Source: [Cochran-1977], section 2.12.
    """
    rows = [row for row in rows if math.isfinite(row[key])]
    numbers = {row["bed"] for row in rows}
    if len(numbers) < 2:
        return None
    mean = math.fsum(row[key] for row in rows) / len(rows)
    residuals = [math.fsum(row[key] - mean for row in rows if row["bed"] == number) for number in numbers]
    error = math.sqrt(len(numbers) / (len(numbers) - 1) * math.fsum(r * r for r in residuals)) / len(rows)
    return {"mean": mean, "standard_error": error, "standard_deviation": float(np.std([r[key] for r in rows], ddof=1))}


def summary(out: Path) -> Row:
    """Say for each ground how its beds lie, and for each way what became of the lander."""
    beds = read_rows(out / "periodic_ground_beds.csv", KINDS)
    rows, result = read_rows(out / "periodic_ground.csv", KINDS), {}
    for name in GROUNDS:
        of = [row for row in beds if row["ground"] == name]
        result[name] = {"beds": len(of)} | {
            key: {
                "mean": float(np.mean([row[key] for row in of])),
                "standard_deviation": float(np.std([row[key] for row in of], ddof=1)),
            }
            for key in ("solid_fraction", "coordination_number", "cpu_s")
            if len(of) > 1
        }
        for way in WAYS:
            ways = [row for row in rows if (row["ground"], row["way"]) == (name, way)]
            travelled = [row["periods_travelled"] for row in ways if math.isfinite(row["periods_travelled"])]
            result[name][way] = {
                "landings": len(ways), "outcomes": dict(Counter(str(row["status"]) for row in ways)),
                "farther_than_period": sum(way > 1.0 for way in travelled) if travelled else None,
                **{key: over_beds(ways, key) for key in (*OUTPUTS, "cpu_s")},
            }  # fmt: skip
    return result


def main() -> None:
    here = Path(__file__).parent
    options = command_line(__doc__, grounds=tuple(GROUNDS), beds=Path(tempfile.gettempdir()), out=here).parse_args()
    options.beds.mkdir(parents=True, exist_ok=True)
    for name in options.grounds:
        for number in range(GROUNDS[name].bed_count):
            land_on(name, number, options.beds, options.out)
            document = {**origin("validation/periodic_ground.py"), "grounds": summary(options.out)}
            write_document(options.out / "periodic_ground.json", document)
            print(name, number, flush=True)


if __name__ == "__main__":
    main()
