"""Soil against impact point: how much each moves the rebound, for grains of 1/2 to 1/20 of a lander.

    python validation/grain_size.py [--grounds NAME ...] [--work FOLDER] [--out validation]

docs/validation/grain_size.md has the set-up. Samples of a block are the same on all grounds; width and depth of these
are at least those of smallest_bed.py. Writes grain_size_beds.csv, a line for each bed, and grain_size.csv, a line for
each landing, as they end. What stands there already is not done again: delete both to start anew. Beds are kept in the
work folder.
"""

import math
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from sphere_beds import SphereBed, pour_spheres

from lithobrake.dem import Box, Material
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.smallbody import didymos, fly
from lithobrake.study import read_study
from lithobrake.touchdown import Bed, BedRecipe, ContactModel, GrainSizes, Lander, Landing, Outcome, land, pour_bed
from lithobrake.touchdown.lander import smallest_bed

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, Row, add_row, command_line, origin, read_rows, timed, write_document

INPUTS = DrawnDesign(read_study(SCENARIOS / "first_bounce.toml")).inputs
MEDIANS = {name: float(law.ppf(np.array([0.5]))[0]) for name, law in INPUTS.items()}
CONTACT, GRAVITY = ContactModel(held_speed=0.03), (0.0, 0.0, -5e-5)
EDGES, MASS, DENSITY = (0.1, 0.1, 0.227), 2.0, 2500.0
SOLID_FRACTION = 0.6  # by which grains are counted
ROLLING = 0.1  # of spheres
LONGEST = 5.5  # grains in a width, at least: the longest of them meet no two images of one another
TWIN = 1e-4  # m
FLIGHTS, DURATION = 16, 43_200.0


class Ground(NamedTuple):
    """Kind of grain, lander's longest edge over grain, depth [m]; beds, blocks of a way; width over the smallest.

    paired: blocks on each pair of beds, so that more beds and blocks change none that stand; 0: all are on all beds.
    """

    grain: str
    ratio: float
    depth: float
    bed_count: int
    blocks: dict[str, int]
    wider: float = 1.0
    paired: int = 0


# Speed [m/s], incidence [deg].
WAYS = {"steep": (0.4, 15.0), "flat": (0.4, 60.0)}
GROUNDS = {
    "hulls 2": Ground("hull", 2.0, 0.227, 4, {"steep": 32, "flat": 32}),
    "spheres 2": Ground("sphere", 2.0, 0.227, 4, {"steep": 32}),
    "spheres 5": Ground("sphere", 5.0, 0.15, 4, {"steep": 32}),
    "hulls 2, larger": Ground("hull", 2.0, 0.34, 4, {"steep": 32}, 1.5),
    "spheres 5, larger": Ground("sphere", 5.0, 0.225, 4, {"steep": 32}, 1.5),
    "hulls 5": Ground("hull", 5.0, 0.15, 4, {"steep": 24, "flat": 12}),
    "hulls 10": Ground("hull", 10.0, 0.1, 4, {"steep": 12}, paired=8),
    "spheres 10": Ground("sphere", 10.0, 0.15, 6, {"steep": 12}, paired=4),
    "hulls 20": Ground("hull", 20.0, 0.06, 2, {"steep": 1}, paired=1),
}
OUTPUTS = ("speed_out", "elevation_out", "spin_out", "penetration")
KINDS = dict.fromkeys(("ground", "way", "status"), str) | dict.fromkeys(
    ("block", "soil", "point", "attitude", "twin", "bed"), int
)  # fmt: skip
Soil = tuple[Material, Lander]


def soil(values: dict[str, float], grain: str) -> Soil:
    rock = Material(
        density=DENSITY, rolling_friction=ROLLING if grain == "sphere" else 0.0,
        **{name.removeprefix("grain."): value for name, value in values.items() if name.startswith("grain.")},
    )  # fmt: skip
    return rock, Lander(shape=Box(EDGES), mass=MASS, material=replace(rock, restitution=values["lander.restitution"]))


def diameter(ground: Ground) -> float:
    """Diameter [m] of the grains."""
    return max(EDGES) / ground.ratio


def width(ground: Ground) -> float:
    """Length [m] after which the ground repeats."""
    rock, lander = soil(MEDIANS, ground.grain)
    least = smallest_bed(lander, rock, diameter(ground), WAYS["steep"][0])[0]
    return ground.wider * max(least + 2.0 * diameter(ground), LONGEST * diameter(ground))


def bed(name: str, ground: Ground, number: int, work: Path, table: Path) -> Bed:
    """Return a bed, poured and noted unless it lies in the folder."""
    path = work / f"{name.replace(' ', '_').replace(',', '')}_{number}.h5"
    if path.exists():
        kept = Bed.load(path)
        return SphereBed.of(kept) if ground.grain == "sphere" else kept
    across, size = width(ground), diameter(ground)
    recipe = BedRecipe(
        grain_count=round(SOLID_FRACTION * across**2 * ground.depth / (math.pi / 6.0 * size**3)),
        sizes=GrainSizes(distribution="constant", lower=size, upper=size), cloud_point_count=14,
        width=(across, across), material=soil(MEDIANS, ground.grain)[0], gravity=GRAVITY, pour_gravity=0.5,
        seed=number, contact=CONTACT, sides="periodic",
    )  # fmt: skip
    poured, cpu = timed(lambda: pour_spheres(recipe) if ground.grain == "sphere" else pour_bed(recipe))
    poured.save(path)
    row: Row = {
        "ground": name, "bed": number, "grains": recipe.grain_count, "width": across, "depth": poured.surface_height,
        "solid_fraction": poured.solid_fraction, "coordination_number": poured.coordination_number, "cpu_s": cpu,
    }  # fmt: skip
    add_row(table, row, 6)
    return poured


class Block(NamedTuple):
    """Two of each: soils (values of the inputs by name), impact points in parts of the width, attitudes w, x, y, z."""

    soils: list[dict[str, float]]
    points: list[tuple[float, float]]
    attitudes: list[tuple[float, float, float, float]]


def block(number: int) -> Block:
    generator = np.random.default_rng([41, number])
    soils = [{name: float(law.ppf(generator.random(1))[0]) for name, law in INPUTS.items()} for _ in range(2)]
    points = [tuple(generator.uniform(-0.5, 0.5, size=2).tolist()) for _ in range(2)]
    return Block(soils, points, [tuple(generator.normal(size=4).tolist()) for _ in range(2)])


def landing(
    ground: Ground, way: str, rock: Material, place: tuple[float, float], attitude: tuple[float, float, float, float]
) -> Landing:  # fmt: skip
    """Return a landing at a place [m], along +x."""
    speed, incidence_deg = WAYS[way]
    return Landing(
        grain=rock, speed=speed, incidence=math.radians(incidence_deg), azimuth=0.0, place=place, orientation=attitude,
        spin=(0.0, 0.0, 0.0), gravity=GRAVITY, time_limit=60.0, contact=CONTACT,
    )  # fmt: skip


@cache
def site() -> tuple:  # type: ignore[type-arg]
    """Body, place [m], axes in rows of evenly spread headings, and when flights begin, evenly in an orbit [s]."""
    body = didymos()
    place, _ = body.local_frame(0.0, 0.0, 0.0)
    headings = 360.0 * (np.arange(FLIGHTS) + 0.5) / FLIGHTS
    axes = np.array([body.local_frame(0.0, 0.0, heading)[1] for heading in headings])
    # Odd steps through the orbit: neighbours in heading do not meet the partner alike.
    begin = 2.0 * math.pi / body.orbit.rate * (7 * np.arange(FLIGHTS) % FLIGHTS) / FLIGHTS
    return body, place, axes, begin


def returns(outcome: Outcome) -> float:
    """Share of flights that come down again within DURATION; NaN for a lander that does not leave."""
    out = outcome.outputs
    velocity = np.array([out["velocity_out_x"], out["velocity_out_y"], out["velocity_out_z"]])
    if not np.isfinite(velocity).all():
        return math.nan
    body, place, axes, begin = site()
    flown = fly(
        body, np.tile(place, (FLIGHTS, 1)), velocity @ axes, DURATION, gravity="table", start_time=begin, threads=1
    )
    return float(np.mean(flown.status == "impact"))


def bed_of(ground: Ground, number: int, point: int) -> int:
    """Return the number of the bed that an impact point of a block is on."""
    if ground.paired:
        return 2 * (number // ground.paired) + (number + point) % 2
    return (number + point) % ground.bed_count


def landed(ground: Ground, way: str, on: int, poured: Bed, number: int, key: tuple[int, int, int, int]) -> Row:
    """Return the row of one landing of a block on the bed of that number; key: soil, point, attitude, twin."""
    drawn, (one, point, attitude, twin) = block(number), key
    rock, lander = soil(drawn.soils[one], ground.grain)
    x, y = (part * poured.width[0] for part in drawn.points[point])
    given = landing(ground, way, rock, (x + twin * TWIN, y), drawn.attitudes[attitude])
    outcome, cpu = timed(lambda: land(poured, lander, given))
    row: Row = {"bed": on, "status": outcome.status.value, **{name: outcome.outputs[name] for name in OUTPUTS}}
    return row | {"returns": returns(outcome), "time": outcome.simulated_time, "cpu_s": cpu}


def landings_of(ground: Ground) -> Iterator[tuple[str, int, tuple[int, int, int, int]]]:
    """Yield way, number of the block and key of every landing on a ground."""
    keys = [(one, point, attitude, 0) for one in (0, 1) for point in (0, 1) for attitude in (0, 1)]
    keys.insert(1, (0, 0, 0, 1))
    for way, count in ground.blocks.items():
        yield from ((way, number, key) for number in range(count) for key in keys)


def main() -> None:
    here, work = Path(__file__).parent, Path(tempfile.gettempdir()) / "lithobrake_grain_size"
    given = command_line(__doc__, grounds=tuple(GROUNDS), work=work, out=here).parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    table, keys = given.out / "grain_size.csv", ("ground", "way", "block", "soil", "point", "attitude", "twin")
    for name in given.grounds:
        ground = GROUNDS[name]
        done = {tuple(row[key] for key in keys) for row in read_rows(table, KINDS)}
        beds: dict[int, Bed] = {}
        for way, number, key in landings_of(ground):
            if (name, way, number, *key) in done:
                continue
            on = bed_of(ground, number, key[1])
            if on not in beds:
                beds[on] = bed(name, ground, on, given.work, given.out / "grain_size_beds.csv")
            row = dict(zip(keys, (name, way, number, *key), strict=True))
            add_row(table, row | landed(ground, way, on, beds[on], number, key), 6)
        spent = sum(row["cpu_s"] for row in read_rows(table, KINDS))
        write_document(given.out / "grain_size.json", {**origin("validation/grain_size.py"), "cpu_s_of_rows": spent})
        print(name, flush=True)


if __name__ == "__main__":
    main()
