"""How fast does MASCOT leave a bed of 30 cm: noise, a boulder in it, a slope, and other angles.

    python validation/low_speed/lander_on_beds.py --work FOLDER --out FOLDER [--count 12] [--settings NAME ...]

Every setting has the same places, headings and attitudes. Rows that stand in lander_on_beds.csv are not run again.
Source: [Thuillet-2021]. Its grains are spheres of centimetres; ours are hulls of 10 cm.
"""

import itertools
import math
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.dem import Box, Material
from lithobrake.geometry.attitude import quaternion
from lithobrake.geometry.bed_limits import BOULDER_REACH
from lithobrake.touchdown import Bed, BedRecipe, ContactModel, GrainSizes, Lander, Landing, land, pour_bed
from lithobrake.touchdown.grains import Boulders

sys.path.extend([str(Path(__file__).parents[1] / "experiments"), str(Path(__file__).parents[2] / "benchmarks")])
from result_rows import Row, note, options_of, read_rows

HERE = Path(__file__).parent
NAME = "lander_on_beds.csv"
EDGES, MASS, REACH = (0.275, 0.29, 0.195), 10.0, 0.223  # m, kg, m: MASCOT
GRAVITY, SPEED = 1.565e-4, 0.145  # m/s2, m/s: Ryugu, and what a fall from 41 m gives
GRAIN, BOULDER, BEDS = 0.1, 0.5, 2  # m, m, number
WIDTH = 2.0 * 1.05 * (BOULDER_REACH * BOULDER + REACH)  # m, after which the ground repeats
# Depth of a boulder's top under the mean surface of the grains [m].
COVERS = {"at the surface": 0.0, "below the surface": 0.1}
CONTACT = ContactModel(held_speed=0.1)  # as for the landers of ../mascot
NUDGE = 1e-7  # m
TIME_LIMIT = 3600.0  # s
ROCK = Material(density=2000.0, young_modulus=1.6e6, poisson_ratio=0.25, restitution=0.55, friction=0.7)


@dataclass(frozen=True)
class Setting:
    """What a landing follows from, beside its place and attitude."""

    boulder: str = ""
    depth: float = 0.3  # m
    incidence_deg: float = 30.0  # from the normal
    speed: float = SPEED  # m/s
    slope_deg: float = 0.0  # down along the horizontal velocity
    noise: bool = False  # all of one place and attitude, but for 0.1 um


GRAINS = Setting()
SETTINGS = {
    "grains": GRAINS,
    **{name: replace(GRAINS, boulder=name) for name in COVERS},
    "noise": replace(GRAINS, noise=True),
    "slope 20 deg": replace(GRAINS, slope_deg=20.0),
    "0 deg": replace(GRAINS, incidence_deg=0.0),
    "60 deg": replace(GRAINS, incidence_deg=60.0),
}


def recipe(boulder: str, depth: float, number: int) -> BedRecipe:
    """Return what a bed follows from."""
    sizes, rocks, share = GrainSizes(distribution="uniform", lower=0.8 * GRAIN, upper=1.2 * GRAIN), None, 0.0
    if boulder:
        one = GrainSizes(distribution="constant", lower=BOULDER, upper=BOULDER)
        share = 0.25 * math.pi * (BOULDER / WIDTH) ** 2
        rocks = Boulders(sizes=one, coverage=share, cover=(COVERS[boulder], COVERS[boulder]))
    volume = math.pi / 6.0 * GRAIN**3 * 1.04  # the mean cube of 0.8 to 1.2 is 1.04
    return BedRecipe(
        grain_count=round(0.6 * WIDTH**2 * (1.0 - 0.7 * share) * depth / volume), sizes=sizes, cloud_point_count=14,
        width=(WIDTH, WIDTH), material=ROCK, gravity=(0.0, 0.0, -GRAVITY), pour_gravity=0.5, seed=300 + number,
        sides="periodic", boulders=rocks,
    )  # fmt: skip


def bed(work: Path, boulder: str, depth: float, number: int) -> Bed:
    """Return a bed, from the work folder where it is there."""
    path = work / f"mascot_{boulder.replace(' ', '_') or 'grains'}_{depth:g}_{number}.h5"
    if not path.exists():
        pour_bed(recipe(boulder, depth, number)).save(path)
    return Bed.load(path)


def landing_of(one: Setting, ground: Bed, number: int) -> Landing:
    """Return a landing: place, heading and attitude are those of its number, in every setting."""
    generator = np.random.default_rng([2021, 0 if one.noise else number])
    attitude = Rotation.from_quat(generator.normal(size=4))
    azimuth, around = (float(angle) for angle in generator.uniform(0.0, 2.0 * math.pi, 2))
    away = 0.25 * BOULDER * math.sqrt(float(generator.uniform()))
    place = np.array([away * math.cos(around), away * math.sin(around)])
    if ground.boulder_count:
        place += ground.position[0, :2]
    place += [NUDGE * number * one.noise, 0.0]
    slope = math.radians(one.slope_deg)
    down = GRAVITY * np.array([math.sin(slope) * math.cos(azimuth), math.sin(slope) * math.sin(azimuth),
                               -math.cos(slope)])  # fmt: skip
    return Landing(
        grain=ROCK, speed=one.speed, incidence=math.radians(one.incidence_deg), azimuth=azimuth,
        place=(float(place[0]), float(place[1])), orientation=quaternion(attitude), spin=(0.0, 0.0, 0.0),
        gravity=(float(down[0]), float(down[1]), float(down[2])), time_limit=TIME_LIMIT, contact=CONTACT,
    )  # fmt: skip


def landed(work: Path, name: str, number: int) -> Row:
    """Land once and return the row; the speed ratio of a lander that does not leave is 0."""
    one = SETTINGS[name]
    ground = bed(work, one.boulder, one.depth, 0 if one.noise else number % BEDS)
    start = time.process_time()
    outcome = land(ground, Lander(shape=Box(EDGES), mass=MASS, material=ROCK), landing_of(one, ground, number))
    out = outcome.outputs["speed_out"]
    return {
        "setting": name, "landing": number, "bed": 0 if one.noise else number % BEDS, "grains": len(ground.grains),
        "status": outcome.status.value, "ratio": 0.0 if math.isnan(out) else out / one.speed,
        "elevation_deg": math.degrees(outcome.outputs["elevation_out"]), "simulated_time": outcome.simulated_time,
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def main() -> None:
    given = options_of(__doc__, HERE, count=12, settings=tuple(SETTINGS))
    ran = {(row["setting"], row["landing"]) for row in read_rows(given.out / NAME)}
    for name, number in itertools.product(given.settings, range(given.count)):
        if (name, number) not in ran:
            note(given.out / NAME, landed(given.work, name, number))


if __name__ == "__main__":
    main()
