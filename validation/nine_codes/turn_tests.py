"""What changes the speed of a ball that leaves the last grains above a floor: dashpot, order, wall, damping or step?

    python validation/nine_codes/turn_tests.py --work FOLDER --out FOLDER [--only NAME ...]

A stand-in for the impact of [Dosta-2024]: its ball and materials, a layer of a few grains on the floor of a small box,
and about the speed that the ball has there. Each setting runs from places that lie a billionth of a metre apart: what
they differ by is rounding. Writes turn_tests.csv, a line a run; rows that stand there are not run again.
"""

import math
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from impact import advance
from impact_bed import BALL_RADIUS, GRAIN_RADIUS, GRAVITY, M1, STEEL, STEEL_OF_BALL, STEEL_OF_GRAINS, Floats

from lithobrake.dem import Material, Sphere, World
from lithobrake.dem.law.restitution import restitution_of

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import add_row, command_line, origin, read_rows, write_document

HERE = Path(__file__).parent
HALF, DEEP, FILLED = 0.015, 0.006, 0.58  # m, m: of the box, and the share that grains take of the layer
SPEED = 2.5  # m/s, of the ball above the layer
SETTLING, FOLLOWED, LOOK = 0.02, 0.008, 1e-4  # s
NUDGES = (0.0, 1e-9, -1e-9)  # m
STEP = 5e-7  # s
SMOOTH = Material(restitution=0.3, friction=0.0, **STEEL)


def with_ratios(grain: Material, steel: Material) -> tuple[Material, Material]:
    """Return both materials with the damping ratios that MercuryDPM has for their restitutions.

    It takes the closed form of a contact whose damping may pull as it ends; here that damping loses less.
    """
    alike, unlike = (
        restitution_of(-math.log(e) / math.hypot(math.log(e), math.pi))
        for e in (grain.restitution, 0.5 * (grain.restitution + steel.restitution))
    )
    return replace(grain, restitution=alike), replace(steel, restitution=2.0 * unlike - alike)


LESS_DAMPED = with_ratios(M1, STEEL_OF_GRAINS)


@dataclass(frozen=True)
class Setting:
    """What is changed."""

    dashpot: str = "none"
    backwards: bool = False  # grains numbered from the last to the first
    grain: Material = M1
    steel: Material = STEEL_OF_GRAINS  # of the ball, as the grains meet it
    floor: Material = STEEL_OF_GRAINS
    step: float = STEP


SETTINGS = {
    "as MercuryDPM": Setting(),
    "tangential dashpot": Setting(dashpot="mindlin"),
    "pairs in another order": Setting(backwards=True),
    "floor and walls without friction": Setting(floor=SMOOTH),
    "damping ratios of MercuryDPM": Setting(grain=LESS_DAMPED[0], steel=LESS_DAMPED[1], floor=LESS_DAMPED[1]),
    "half the step": Setting(step=0.5 * STEP),
    "twice the step": Setting(step=2.0 * STEP),
    "a quarter of the step": Setting(step=0.25 * STEP),
}


def box_of(places: Floats, setting: Setting) -> World:
    """Return grains at places [m] in the box."""
    world = World((0.0, 0.0, -GRAVITY), setting.step, pair_rule="mean", tangential_dashpot=setting.dashpot)
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (len(places), 1))
    grains = world.add_bodies([Sphere(GRAIN_RADIUS)] * len(places), setting.grain, places, upright)
    walled(world, setting.floor, grains)
    return world


def walled(world: World, material: Material, bodies: range) -> None:
    world.add_plane((0, 0, 0), (0, 0, 1), material, bodies=bodies)
    for axis in (0, 1):
        for sign in (1.0, -1.0):
            normal = np.zeros(3)
            normal[axis] = sign
            world.add_plane(-HALF * normal, normal, material, bodies=bodies)


def layer(work: Path) -> Floats:
    """Return places [m] of grains at rest in the box, from the work folder where they are there."""
    path = work / "layer.npy"
    if not path.exists():
        generator, pitch = np.random.default_rng(1), 2.2 * GRAIN_RADIUS
        row = int(2.0 * HALF / pitch)
        count = round(FILLED * (2.0 * HALF) ** 2 * DEEP / (4.0 / 3.0 * math.pi * GRAIN_RADIUS**3))
        k = np.arange(count)
        cells = np.stack([k % row, k // row % row, k // row**2], axis=1) + 0.5
        places = cells * pitch - [HALF, HALF, 0.0] + 0.08 * GRAIN_RADIUS * generator.uniform(-1.0, 1.0, cells.shape)
        world = box_of(places, Setting(dashpot="mindlin"))
        world.drag = 100.0
        advance(world, SETTLING, 1e-6)
        np.save(path, world.position)
    return np.asarray(np.load(path))


def rebound(places: Floats, setting: Setting, nudge: float) -> tuple[float, float]:
    """Let the ball fall on the layer; return the fastest it goes up [m/s] and its lowest point above the floor [m]."""
    world = box_of(places[::-1] if setting.backwards else places, setting)
    height = float(places[:, 2].max()) + GRAIN_RADIUS + BALL_RADIUS + 5e-4
    ball = world.add_body(Sphere(BALL_RADIUS), setting.steel, (nudge, 0.0, height), (0.0, 0.0, -SPEED))
    walled(world, STEEL_OF_BALL, range(ball, ball + 1))
    lowest, fastest = height, -math.inf
    while world.time < FOLLOWED:
        advance(world, world.time + LOOK, setting.step)
        lowest = min(lowest, float(world.position[ball, 2]))
        fastest = max(fastest, float(world.velocity[ball, 2]))
        if world.position[ball, 2] > height:
            break
    return fastest, lowest - BALL_RADIUS


def main() -> None:
    given = command_line(__doc__, work=Path("turn_tests_work"), out=HERE, only=tuple(SETTINGS)).parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    out = given.out / "turn_tests.csv"
    done = {(row["setting"], row["nudge"]) for row in read_rows(out, {"setting": str})}
    places = layer(given.work)
    for name in given.only:
        for nudge in NUDGES:
            if (name, nudge) not in done:
                start = time.process_time()
                fastest, lowest = rebound(places, SETTINGS[name], nudge)
                row = {"setting": name, "nudge": nudge, "grains": len(places), "rebound_speed": fastest,
                       "lowest": lowest, "cpu_s": time.process_time() - start}  # fmt: skip
                add_row(out, row, digits=7)
                print(row, flush=True)
    spent = sum(row["cpu_s"] for row in read_rows(out, {"setting": str}))
    write_document(out.with_suffix(".json"), {
        "layer_depth": DEEP, "speed": SPEED, "cpu_s_of_rows": spent, **origin("validation/nine_codes/turn_tests.py"),
    })  # fmt: skip


if __name__ == "__main__":
    main()
