"""Does a ball bounce or roll on irregular grains of millimetres and centimetres, below 2 m/s, in microgravity?

    python validation/low_speed/ball_on_coarse_grains.py --work FOLDER --out FOLDER [--drops 2] [--names NAME ...]

Grains and drops are made as in ../experiments/who_rebounds.py: a quartz ball of 2 cm on convex hulls. Rows that stand
in ball_on_coarse_grains.csv are not run again. Source: [Brisset-2020]; sizes of grains and ball, their contacts,
gravity and speeds are ours.
"""

import itertools
import math
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.extend([str(Path(__file__).parents[1] / "experiments"), str(Path(__file__).parents[2] / "benchmarks")])
import who_rebounds
from result_rows import Row, note, options_of, read_rows
from who_rebounds import BEDS, DIAMETER, EARTH, PEBBLES, Ejecta, aimed, bed, followed

HERE = Path(__file__).parent
NAME = "ball_on_coarse_grains.csv"
SHARE = 1e-4  # of Earth's gravity: what the free-floating boxes of [Brisset-2018] stayed below
SPEEDS = (0.1, 0.4, 1.6)  # m/s: the source's are below 2
CENTIMETRES = replace(PEBBLES, share=SHARE)
GRAINS = {
    "cm": CENTIMETRES,
    "mm": replace(CENTIMETRES, grain=0.006, width=0.06, depth=0.02),
}


def dropped(work: Path, name: str, speed: float, number: int) -> Row:
    """Let one ball meet a bed, and return its row: lengths [m] as they are, speeds over the ball's at first touch."""
    start = time.process_time()
    kind = who_rebounds.KINDS[name] = GRAINS[name]
    froude = speed / math.sqrt(EARTH * SHARE * DIAMETER)
    fast, seed = kind.scaled(froude)[0], number % BEDS + 1
    world = bed(work, name, froude, seed)
    generator = np.random.default_rng([20, number])
    x, y = (float(at) for at in generator.uniform(0.0, kind.width, 2))
    ejecta = Ejecta(world)
    ball = aimed(world, kind, (x, y), fast)
    row = followed(world, ball, fast, kind.steps)
    way = world.position[ball, :2] - (x, y)
    return {
        "name": name, "speed": speed, "drop": number, "bed": seed, "grains": ball, **row,
        "way_along": float(np.linalg.norm(way)), **ejecta.told(world, kind.grain, fast),
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def main() -> None:
    given = options_of(__doc__, HERE, drops=2, names=tuple(GRAINS))
    ran = {(row["name"], row["speed"], row["drop"]) for row in read_rows(given.out / NAME)}
    for name, number, speed in itertools.product(given.names, range(given.drops), SPEEDS):
        if (name, speed, number) not in ran:
            note(given.out / NAME, dropped(given.work, name, speed, number))


if __name__ == "__main__":
    main()
