"""Landers like MASCOT from their first contact, on a boulder or on grains alone, by simulated landings to rest.

    python validation/mascot/mascot.py --work FOLDER --out FOLDER [--setting NAME] [--count N]

Writes mascot.csv, a line per lander and setting, beds.csv, a line per bed, and mascot.json. A line that stands there is
not made again. Each impact is a landing at a fresh place of a bed, each high hop a parabola under the local gravity
with free rotation.

Facts: [Scholten-2019] (fall, times, contacts), [Durda-2011] (restitution of boulders), ground.py.
"""

import math
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.dem import Box, Material
from lithobrake.geometry.attitude import about_z, attitude_of, quaternion, spin_of
from lithobrake.pipeline.design.arrivals import turned_in_flight
from lithobrake.touchdown import ContactModel, Lander, Landing, Outcome, land

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from ground import COVER, DEEPEST, FLATTEST, INDEX, Ground, beds, coverage, recipe
from harness import Row, add_row, command_line, origin, read_rows, write_document

HERE = Path(__file__).parent
SEED = 663
EDGES, MASS = (0.275, 0.29, 0.195), 10.0  # m, kg
GRAVITY, SPEED, INCIDENCE = (1.5e-4, 1.63e-4), (0.143, 0.146), 25.0  # m/s2, m/s, deg at most
# It turned several times in the 350 s of its fall.
SPIN = 0.05  # rad/s, standard deviation about each axis
YOUNG, RESTITUTION, FRICTION = (5e5, 5e6), (0.3, 0.8), (0.5, 0.9)
HARD = (0.83, 0.06)  # mean and standard deviation: boulders of granite on each other
HOP_HEIGHT = 0.45  # m, a diameter of the lander; lower hops are part of a landing
LONGEST = 14_400.0  # s, of a journey
CONTACT = ContactModel(held_speed=0.1)
# Of the place at rest, within the accuracy of the observed path.
ACCURACY, FRAMES = 0.1, 40  # m
# What the first contact is on, and what landers and grains are of.
SETTINGS = {
    "at the surface": ("at the surface", "soil"),
    "below the surface": ("below the surface", "soil"),
    "grains alone": ("grains alone", "soil"),
    "at the surface, hard": ("at the surface", "hard"),
}
MEASURED = {"contacts": 4, "time_s": 663.0, "path_m": 17.0}


@dataclass
class Traveller:
    """A lander under way, in axes with x along the horizontal velocity of its present impact, z up."""

    generator: np.random.Generator
    lander: Lander
    soil: Material
    gravity: float  # m/s2
    velocity: np.ndarray  # m/s
    attitude: Rotation
    spin: np.ndarray  # rad/s
    time: float = 0.0  # s
    settled: float = 0.0  # s
    path: float = 0.0  # m
    heading: float = 0.0  # rad, of x
    place: np.ndarray = field(default_factory=lambda: np.zeros(2))  # m
    contacts: int = 0
    touchdowns: int = 0
    end: str = ""


def drawn(number: int, hard: bool) -> tuple[Traveller, float]:
    """A lander before its first contact, and the cumulative index of its boulders; alike in all settings."""
    generator = np.random.default_rng([SEED, number])
    young = float(np.exp(generator.uniform(*np.log(YOUNG))))
    grain, own = generator.uniform(*RESTITUTION, size=2).tolist()
    friction, gravity = float(generator.uniform(*FRICTION)), float(generator.uniform(*GRAVITY))
    speed, incidence = float(generator.uniform(*SPEED)), math.radians(float(generator.uniform(0.0, INCIDENCE)))
    index, of_rock = float(generator.uniform(FLATTEST, INDEX)), float(np.clip(generator.normal(*HARD), 0.0, 0.99))
    attitude, spin = Rotation.from_quat(generator.normal(size=4)), generator.normal(0.0, SPIN, size=3)
    grain, own = (of_rock, of_rock) if hard else (grain, own)
    common = {"young_modulus": young, "poisson_ratio": 0.25, "friction": friction, "density": 2000.0}
    soil, skin = Material(restitution=grain, **common), Material(restitution=own, **common)
    velocity = speed * np.array([math.sin(incidence), 0.0, -math.cos(incidence)])
    lander = Lander(shape=Box(EDGES), mass=MASS, material=skin)
    return Traveller(generator, lander, soil, gravity, velocity, attitude, spin), index


def touch_down(one: Traveller, ground: Ground, deepest: float) -> tuple[Outcome, float]:
    """Land at a random place of a bed, in a random direction; how far the boulder there stands out [m]."""
    place, out = ground.place(one.generator, deepest)
    azimuth = float(one.generator.uniform(0.0, 2.0 * math.pi))
    turn = about_z(azimuth)
    speed = float(np.linalg.norm(one.velocity))
    landing = Landing(
        grain=one.soil, speed=speed, incidence=math.atan2(one.velocity[0], -one.velocity[2]), azimuth=azimuth,
        place=place, orientation=quaternion(turn * one.attitude), spin=tuple(turn.apply(one.spin).tolist()),
        gravity=(0.0, 0.0, -one.gravity), time_limit=LONGEST - one.time, hop_height=HOP_HEIGHT, contact=CONTACT,
    )  # fmt: skip
    outcome = land(ground.bed, one.lander, landing, FRAMES)
    note(one, outcome)
    return outcome, out


def note(one: Traveller, outcome: Outcome) -> None:
    """Go where a landing ended."""
    outputs, frames = outcome.outputs, outcome.frames
    assert frames is not None
    if outcome.status == "captured":
        one.end = "at rest"
        way = np.linalg.norm(frames["position"][:, -1] - frames["position"][-1, -1], axis=1)
        one.settled = one.time + float(frames["time"][way > ACCURACY].max(initial=0.0))
    elif outcome.status != "clear":
        one.end = "under way"
    move(one, np.array([outputs["displacement_x"], outputs["displacement_y"]]))
    one.time += outputs["duration"]
    one.contacts += round(outputs["contacts"])
    one.touchdowns += 1


def move(one: Traveller, way: np.ndarray) -> None:
    """Go a horizontal way [m], [2], from the present axes."""
    c, s = math.cos(one.heading), math.sin(one.heading)
    one.place = one.place + np.array([c * way[0] - s * way[1], s * way[0] + c * way[1]])
    one.path += math.hypot(*way)


def hop(one: Traveller, outcome: Outcome) -> None:
    """Fly a parabola to ground of the same height, and come down."""
    outputs = outcome.outputs
    velocity = np.array([outputs[f"velocity_out_{axis}"] for axis in "xyz"])
    duration = 2.0 * float(velocity[2]) / one.gravity
    inertia = one.lander.shape.inertia_per_density * (MASS / one.lander.shape.volume)
    attitude, spin = turned_in_flight(inertia, attitude_of(outputs), spin_of(outputs), math.inf, duration)
    move(one, velocity[:2] * duration)
    one.time += duration
    turn = math.atan2(velocity[1], velocity[0])
    back = about_z(-turn)
    one.heading += turn
    one.velocity = np.array([math.hypot(*velocity[:2]), 0.0, -velocity[2]])
    one.attitude, one.spin = back * attitude, back.apply(spin)
    if one.time >= LONGEST:
        one.end = "under way"


def journey(setting: str, number: int, ground: dict[str, list[Ground]]) -> Row:
    first, material = SETTINGS[setting]
    one, index = drawn(number, material == "hard")
    speed, chance = float(np.linalg.norm(one.velocity)), coverage(index)
    # Beds of a kind in turn, so that each has as many first contacts.
    bed = number % len(ground[first])
    outcome, out = touch_down(one, ground[first][bed], DEEPEST.get(first, 0.0))
    row: Row = {
        "setting": setting, "lander": number, "bed": bed, "boulder_m": ground[first][bed].boulder, "stands_out_m": out,
        "first_speed": speed, "gravity": one.gravity, "young_modulus": one.soil.young_modulus,
        "restitution": min(one.soil.restitution, one.lander.material.restitution), "friction": one.soil.friction,
        "rebound_speed": outcome.outputs["speed_out"],
        "rebound_elevation_deg": math.degrees(outcome.outputs["elevation_out"]),
    }  # fmt: skip
    on_boulders = 0
    while not one.end:
        hop(one, outcome)
        if one.end:
            break
        kind = first if first in COVER and one.generator.random() < chance else "grains alone"
        on_boulders += kind in COVER
        among = ground[kind]
        outcome, _ = touch_down(one, among[one.generator.integers(len(among))], DEEPEST.get(kind, 0.0))
    return row | {
        "end": one.end, "time_s": one.time, "settled_s": one.settled, "contacts": one.contacts, "path_m": one.path,
        "distance_m": float(np.linalg.norm(one.place)), "touchdowns": one.touchdowns, "boulders_later": on_boulders,
    }  # fmt: skip


def note_beds(table: Path, ground: dict[str, list[Ground]]) -> None:
    """Write what beds came of their recipes."""
    known = {(row["kind"], row["bed"]) for row in read_rows(table, {"kind": str})}
    for kind, among in ground.items():
        for number, one in enumerate(among):
            if (kind, number) not in known:
                add_row(table, {"kind": kind, "bed": number, **of_bed(kind, number, one)}, 4)


def of_bed(kind: str, number: int, one: Ground) -> Row:
    """Size of a bed, and how deep the top of its boulder was to lie under the grains, and lies [m]."""
    rocks, bed = recipe(kind, number)[0].boulders, one.bed
    top = math.nan
    if bed.boulder_count:
        top = float(bed.position[0, 2] + (bed.grains[0].vertices - bed.grains[0].centroid)[:, 2].max())
    return {
        "boulder_m": one.boulder, "width_m": bed.width[0], "grains": len(bed.grains) - bed.boulder_count,
        "depth_m": one.surface, "solid_fraction": bed.solid_fraction,
        "cover_asked_m": rocks.cover[0] if rocks else math.nan, "cover_m": one.surface - top,
    }  # fmt: skip


def main() -> None:
    parser = command_line(__doc__, work=Path, out=HERE, setting="all", count=150)
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    options.out.mkdir(parents=True, exist_ok=True)
    wanted = list(SETTINGS) if options.setting == "all" else [options.setting]
    ground = {kind: beds(options.work, kind) for kind in ("grains alone", *{SETTINGS[name][0] for name in wanted})}
    note_beds(options.out / "beds.csv", ground)
    table = options.out / "mascot.csv"
    known = {(row["setting"], row["lander"]) for row in read_rows(table, {"setting": str, "end": str})}
    for setting in wanted:
        for number in range(options.count):
            if (setting, number) not in known:
                start = time.process_time()
                row = journey(setting, number, ground)
                add_row(table, row | {"cpu_s": time.process_time() - start}, 5)
    rows = read_rows(table, {"setting": str, "end": str})
    write_document(
        options.out / "mascot.json",
        {
            **origin("validation/mascot/mascot.py --work FOLDER --out FOLDER"), "measured": MEASURED,
            "landers": {name: sum(row["setting"] == name for row in rows) for name in SETTINGS},
            "cpu_s_of_rows": round(sum(row["cpu_s"] for row in rows), 1),
        },
    )  # fmt: skip


if __name__ == "__main__":
    main()
