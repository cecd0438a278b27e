"""Does a lander that slides on a bed of hulls obey Coulomb's law with the friction of its contacts?

    python validation/sliding_law.py [--out validation]

docs/validation/sliding_law.md has the set-up. Writes sliding_law.csv, a line for each push as it ends, and
sliding_law.json with the law that fits them. Pushes that stand in the table are not made again: delete it to start
anew.
"""

import math
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.dem import Box, Material, World
from lithobrake.touchdown import Bed, BedRecipe, ContactModel, GrainSizes, Lander, Landing, pour_bed
from lithobrake.touchdown.bed import boxed_world
from lithobrake.touchdown.simulation import release

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row, add_row, command_line, origin, read_document, read_rows, write_document

DIAMETER, GRAINS, WIDTH = 0.09, 200, (1.5, 0.45)
DENSITY, GRAVITY, CONTACT = 2500.0, 0.02, ContactModel()
EDGES, MASS = (0.1, 0.1, 0.227), 2.0
# Over the edges, some pushes of smaller and larger landers.
SIZES = (0.5, 1.5)
# Over density, gravity and size.
STIFFNESS, STIFFER = 1e5, 1e6
NATURAL_TIME = math.sqrt(DIAMETER / GRAVITY)
# Of the lander: its kinetic energy over weight and grain size, below which for so many natural times it lies still.
STILL, STILL_TIMES, PATIENCE = 1e-4, 1.0, 60.0
LOOK = 0.02  # natural times between looks
START, ROOM = -0.45, 0.1  # m, where it is pushed off, and how near the end of the bed it is let go
BEDS, FRICTIONS = (1, 2, 3), (0.4, 0.8, 0.2)
# Slope and Froude number.
WAYS = ((0.0, 1.0), (0.0, 3.0), (0.2, 1.0), (0.4, 1.0))
HALF = math.sqrt(0.5)
# The long edge along, across and aslant the way, upright, and any way round; then it lies down as it will.
ATTITUDES = {
    "along": (HALF, 0.0, HALF, 0.0),
    "across": (HALF, HALF, 0.0, 0.0),
    "edge": (0.65328, 0.65328, 0.27060, 0.27060),
    "random": None,
}


@dataclass(frozen=True)
class Push:
    """One push: friction of the lander on grains, seed of the bed, attitude, tangent of the slope, Froude number
    v^2 / (g d), friction between grains, and the lander's edges over those of the study.
    """

    friction: float
    bed: int
    attitude: str
    slope: float
    froude: float
    grain_friction: float
    restitution: float = 0.5
    stiffness: float = STIFFNESS
    size: float = 1.0


PUSH = [each.name for each in fields(Push)]
LIKE = ("friction", "bed", "attitude", "slope", "froude")
USUAL = {"restitution": 0.5, "stiffness": STIFFNESS, "size": 1.0}
# Of captured landers, whose smallest edge is about a grain: all of their energy could not lift them by half of it.
CAPTURED_FROUDE = 1.0


def pushes() -> Iterator[Push]:
    """All pushes, bed by bed: what is there at any time is as even as it can be."""
    for bed in BEDS:
        for friction in FRICTIONS:
            for attitude in ATTITUDES:
                for slope, froude in WAYS if bed > 1 else (*WAYS, (0.0, 0.3)):
                    yield Push(friction, bed, attitude, slope, froude, friction)
        if bed == 1:
            for attitude in ATTITUDES:
                yield Push(0.4, bed, attitude, 0.0, 1.0, 0.4, restitution=0.8)
                yield Push(0.4, bed, attitude, 0.0, 1.0, 0.4, stiffness=STIFFER)
                for slope, froude in ((0.0, 1.0), (0.2, 1.0)):
                    yield Push(0.2, bed, attitude, slope, froude, 0.8)
                for size in SIZES:
                    yield Push(0.4, bed, attitude, 0.0, 1.0, 0.4, size=size)
                    yield Push(0.4, bed, attitude, 0.2, 1.0, 0.4, size=size)


def rock(push: Push, friction: float) -> Material:
    """Grains and lander are of one material, but for their friction."""
    modulus = push.stiffness * DENSITY * GRAVITY * DIAMETER
    return Material(
        young_modulus=modulus, poisson_ratio=0.25, restitution=push.restitution, friction=friction, density=DENSITY
    )


def lander_of(push: Push) -> Lander:
    """The lander, larger or smaller in proportion."""
    shape = Box(tuple(push.size * edge for edge in EDGES))
    return Lander(shape=shape, mass=MASS * push.size**3, inertia=None, material=rock(push, push.friction))


def bed_of(push: Push, folder: Path) -> Bed:
    """The bed of a push, poured unless it lies there."""
    path = folder / f"sliding_bed_{push.grain_friction:g}_{push.bed}_{push.restitution:g}_{push.stiffness:g}.h5"
    if not path.exists():
        recipe = BedRecipe(
            grain_count=GRAINS, sizes=GrainSizes(distribution="constant", lower=DIAMETER, upper=DIAMETER),
            cloud_point_count=14, width=WIDTH, material=rock(push, push.grain_friction), gravity=(0.0, 0.0, -GRAVITY),
            pour_gravity=10.0 * GRAVITY, seed=push.bed, contact=CONTACT,
        )  # fmt: skip
        pour_bed(recipe).save(path)
    return Bed.load(path)


@cache
def settled(push: Push, folder: Path) -> World:
    """A world in which the lander, its last body, has come to rest on a level bed; push: without slope and speed."""
    bed, random = bed_of(push, folder), np.random.default_rng([push.bed, *push.attitude.encode()])
    lander = lander_of(push)
    while True:
        aside, turn = float(random.uniform(-0.05, 0.05)), tuple(random.normal(size=4))
        landing = Landing(
            grain=rock(push, push.grain_friction), speed=0.01 * math.sqrt(GRAVITY * DIAMETER), incidence=0.0,
            azimuth=0.0, place=(START, aside), orientation=ATTITUDES[push.attitude] or turn, spin=(0.0, 0.0, 0.0),
            gravity=(0.0, 0.0, -GRAVITY), time_limit=1.0,
        )  # fmt: skip
        world = bed.world(landing.grain, landing.gravity, CONTACT)
        release(world, bed, lander, landing)
        # One that topples over the rim is dropped again at another place.
        if is_on_bed(until_still(world)[-1]):
            return world


def is_on_bed(place: np.ndarray) -> bool:
    """Whether a place [m] is within the bed: beyond a side the bare floor would follow."""
    return bool(abs(place[0]) < 0.5 * WIDTH[0] - ROOM and abs(place[1]) < 0.5 * WIDTH[1])


def until_still(world: World) -> list[np.ndarray]:
    """Run until the last body lies still or comes to the rim of the bed; give its places, a row a look."""
    energy, still, places = float(world.mass[-1]) * GRAVITY * DIAMETER, 0.0, [world.position[-1]]
    end = world.time + PATIENCE * NATURAL_TIME
    while still < STILL_TIMES and is_on_bed(places[-1]) and world.time < end:
        world.run_locally(LOOK * NATURAL_TIME, CONTACT.steps_per_contact)
        still = still + LOOK if world.kinetic_energy[-1] < STILL * energy else 0.0
        places.append(world.position[-1])
    return places


def pushed(push: Push, folder: Path) -> Row:
    """What comes of a push; lengths over the grain size, energies over that and the lander's weight."""
    at_rest, angle = settled(replace(push, slope=0.0, froude=0.0), folder), math.atan(push.slope)
    material = rock(push, push.grain_friction)
    gravity = GRAVITY * math.sin(angle), 0.0, -GRAVITY * math.cos(angle)
    place, turn = at_rest.position, at_rest.orientation
    hulls = [body.shape for body in at_rest.bodies[:-1]]
    world = boxed_world(hulls, place[:-1], turn[:-1], WIDTH, material, gravity, CONTACT)
    speed = math.sqrt(push.froude * GRAVITY * DIAMETER)
    lander = lander_of(push)
    world.add_body(lander.shape, lander.material, place[-1], (speed, 0.0, 0.0), turn[-1], mass=lander.mass)
    start = world.time
    places = np.array(until_still(world)) / DIAMETER
    step = np.diff(places, axis=0)
    last = float(world.kinetic_energy[-1]) / (lander.mass * GRAVITY * DIAMETER)
    lost = 0.5 * push.froude - last + (places[-1] - places[0]) @ gravity / GRAVITY
    way = float(np.hypot(step[:, 0], step[:, 1]).sum())
    return asdict(push) | {
        "stopped": last < STILL, "way": way, "advance": float(places[-1, 0] - places[0, 0]),
        "sunk": float(places[0, 2] - places[-1, 2]), "energy_left": last, "time": (world.time - start) / NATURAL_TIME,
        "effective_friction": float(lost) / (math.cos(angle) * way),
    }  # fmt: skip


def noted(table: Path) -> list[Row]:
    return read_rows(table, {"attitude": str, "stopped": lambda word: word == "True", "bed": int})


def mean_friction(rows: list[Row]) -> dict[str, float | None]:
    """Mean friction over the way of pushes, with its standard error over beds, and scatter from push to push."""
    way, friction, bed = (np.array([row[name] for row in rows]) for name in ("way", "effective_friction", "bed"))
    mean = float(np.average(friction, weights=way))
    sums = np.array([np.sum((way * (friction - mean))[bed == one]) for one in np.unique(bed)])
    count = len(sums)
    error = math.sqrt(count / (count - 1.0) * float(np.sum(sums**2))) / way.sum() if count > 1 else None
    scatter = math.sqrt(float(np.average((friction - mean) ** 2, weights=way)))
    return {"pushes": len(rows), "mean": mean, "standard_error": error, "scatter": scatter, "way": float(way.mean())}


def law(rows: list[Row]) -> dict[str, float]:
    """The line a + b mu through pushes as slow as captured landers, weighed by their way, and Coulomb's beside it."""
    slow = [row for row in rows if row["froude"] <= CAPTURED_FROUDE]
    way, friction, effective = (
        np.array([row[name] for row in slow]) for name in ("way", "friction", "effective_friction")
    )
    slope, intercept = np.polyfit(friction, effective, 1, w=np.sqrt(way)).tolist()
    scatter, of_coulomb = (
        math.sqrt(float(np.average((effective - told) ** 2, weights=way)))
        for told in (intercept + slope * friction, friction)
    )
    return {"intercept": intercept, "slope": slope, "scatter": scatter, "scatter_about_coulomb": of_coulomb}


def as_usual(rows: list[Row]) -> list[Row]:
    """Pushes in which nothing but friction, bed, attitude, slope and speed differs."""
    return [
        row
        for row in rows
        if row["grain_friction"] == row["friction"] and all(row[name] == value for name, value in USUAL.items())
    ]


def summary(rows: list[Row]) -> dict[str, Any]:
    """The law, and friction by group; pushes that try another setting stand beside their like."""
    usual = as_usual(rows)
    found: dict[str, Any] = {"law": law(usual)} if len({row["friction"] for row in usual}) > 1 else {}
    for name in ("friction", "froude", "slope", "attitude"):
        found[f"by_{name}"] = [
            {"friction": key[0], name: key[1]}
            | mean_friction([row for row in usual if (row["friction"], row[name]) == key])
            for key in sorted({(row["friction"], row[name]) for row in usual})
        ]
    others = {name: [row for row in rows if row[name] != value] for name, value in USUAL.items() if name != "size"}
    others["grain_friction"] = [row for row in rows if row["grain_friction"] != row["friction"]]
    others |= {f"size={size:g}": [row for row in rows if row["size"] == size] for size in SIZES}
    found["others"] = {}
    for name, other in others.items():
        like = [row for row in usual if any(all(row[key] == one[key] for key in LIKE) for one in other)]
        if like:
            found["others"][name] = {"usual": mean_friction(like), "other": mean_friction(other)}
    return found


def main() -> None:
    chosen = command_line(__doc__, out=Path(__file__).parent).parse_args()
    begin = time.process_time()
    table, told = chosen.out / "sliding_law.csv", chosen.out / "sliding_law.json"
    rows, spent = noted(table), read_document(told, {"cpu_s": 0})["cpu_s"]
    done = [{key: row[key] for key in PUSH} for row in rows]
    to_do = [push for push in pushes() if asdict(push) not in done]
    for number, push in enumerate(to_do, start=1):
        rows.append(pushed(push, chosen.out))
        add_row(table, rows[-1])
        print(f"{number} of {len(to_do)}: {rows[-1]['effective_friction']:.3f}", flush=True)
        document = {
            **origin("validation/sliding_law.py"), "cpu_s": spent + round(time.process_time() - begin),
            **summary(rows),
        }  # fmt: skip
        write_document(told, document)


if __name__ == "__main__":
    main()
