"""Speed of the soft-surface engine on settled beds of hulls: one line a case.

    python benchmarks/grains_speed.py BED_FOLDER [CASE ...]

BED_FOLDER holds hull1000.txt, hull2000.txt, hull4000.txt and hull_library.txt (columns: radius, position, quaternion
w x y z, velocity, spin; see the README beside them). Each bed is relaxed for 20 000 steps with drag, then timed
over 1000 undamped ones, five times; the median counts. CPU time, one thread.
"""

import argparse
import platform
import statistics
import sys
import time
from pathlib import Path

import numpy as np

from lithobrake.dem import ConvexHull, Material, World

ROCK = Material(young_modulus=5e6, poisson_ratio=0.3, restitution=0.5, friction=0.5, density=2500.0)
WIDTH = {"hull1000": 1.0, "hull2000": 2.0, "hull4000": 2.0}
LIBRARY_PERIOD = {"hull1000": 1000, "hull2000": 500, "hull4000": 1000}
TIME_STEP, GRAVITY = 2e-4, 9.81e-3
RELAX_STEPS, TIMED_STEPS, REPEATS = 20_000, 1000, 5
LEAST_COORDINATION = 3.2


def library(path: Path) -> list[ConvexHull]:
    """Read the hulls: number of points, then their coordinates, a line each."""
    rows = [line.split() for line in path.read_text().splitlines() if line and not line.startswith("#")]
    return [ConvexHull(np.array(row[1:], dtype=float).reshape(int(row[0]), 3)) for row in rows]


def world_of(folder: Path, case: str) -> World:
    """Return the bed of a case in its open box."""
    hulls, width = library(folder / "hull_library.txt"), WIDTH[case]
    world = World((0.0, 0.0, -GRAVITY), TIME_STEP)
    for k, row in enumerate(np.loadtxt(folder / f"{case}.txt")):
        shape = hulls[k % LIBRARY_PERIOD[case] % 64]
        world.add_body(shape, ROCK, row[1:4], velocity=row[8:11], orientation=row[4:8], spin=row[11:14])
    world.add_plane((0, 0, 0), (0, 0, 1), ROCK)
    for normal in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)):
        world.add_plane(tuple(-0.5 * width * n for n in normal), normal, ROCK)
    return world


def measure(folder: Path, case: str) -> None:
    """Relax, time and print one case."""
    world = world_of(folder, case)
    world.drag = 2.0
    world.run(steps=RELAX_STEPS)
    world.drag = 0.0
    times = []
    for _ in range(REPEATS):
        start = time.process_time()
        world.run(steps=TIMED_STEPS)
        times.append(time.process_time() - start)
    count = len(world.bodies)
    coordination = 2.0 * int((world.contacts()["body_b"] >= 0).sum()) / count
    rate = count * TIMED_STEPS / statistics.median(times)
    verdict = "" if coordination >= LEAST_COORDINATION else f"  (below {LEAST_COORDINATION}: does not count)"
    print(
        f"{case}: {1e3 * statistics.median(times) / TIMED_STEPS:.3f} ms a step, {rate / 1e6:.2f} million "
        f"particle-steps per CPU second, coordination {coordination:.2f}{verdict}",
        flush=True,
    )


def main() -> None:
    """Measure the cases asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("case", nargs="*", default=[*WIDTH])
    chosen = parser.parse_args()
    print(f"# {platform.machine()}, {sys.platform}, Python {platform.python_version()}, one thread")
    for case in chosen.case:
        measure(chosen.folder, case)


if __name__ == "__main__":
    main()
