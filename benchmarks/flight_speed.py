"""Speed of gravity and flights around the built-in Didymos: sums over facets, table, and flights of up to 12 h.

CPU time of all threads, and wall time on an otherwise quiet machine. The published case is Didymos alone, starts at
latitude and longitude 0 at 0.01 to 0.4 m/s within 60 deg of the vertical. Beside the package stands polyhedral-gravity
where it is installed. Results go into flight_speed.json beside this file.
Usage: python benchmarks/flight_speed.py [--table 25000 50000 100000] [--exact 2500 5000 10000] [--threads 2]
"""

import os
import platform
import sys
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from harness import Row, command_line, origin, write_document

from lithobrake.smallbody import Body, didymos, fly
from lithobrake.smallbody.attraction import field

RESULTS = Path(__file__).with_suffix(".json")
DURATION = 12 * 3600.0


def timed(work: Callable[[], Any], repeats: int = 1) -> tuple[float, float, Any]:
    """Smallest CPU time and smallest wall time of several calls [s], and what the last gave."""
    cpu, wall = [], []
    for _ in range(repeats):
        start = time.process_time(), time.perf_counter()
        result = work()
        cpu.append(time.process_time() - start[0])
        wall.append(time.perf_counter() - start[1])
    return min(cpu), min(wall), result


def cone(
    body: Body, count: int, seed: np.random.Generator | int = 1, speeds: tuple[float, float] = (0.01, 0.4)
) -> tuple[np.ndarray, np.ndarray]:
    """Start states at latitude and longitude 0: even in speed [m/s] and in solid angle within 60 deg of the normal."""
    random = np.random.default_rng(seed)
    place, axes = body.local_frame(0.0, 0.0, 0.0)
    turn = random.uniform(0.0, 2.0 * np.pi, count)
    up = random.uniform(0.5, 1.0, count)
    across = np.sqrt(1.0 - up**2)
    local = random.uniform(*speeds, count)[:, None] * np.stack([across * np.cos(turn), across * np.sin(turn), up], 1)
    return np.tile(place, (count, 1)), local @ axes


def gravity_rows(body: Body) -> list[Row]:
    """Evaluations a second on one thread, at points from the surface out to two radii."""
    random = np.random.default_rng(0)
    directions = random.normal(size=(32_768, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    points = directions * (body.shape.radius * random.uniform(1.01, 2.0, len(directions)))[:, None]
    facets, rows = len(body.shape.faces), []
    far = np.tile(points, (30, 1))
    calls: list[tuple[str, int, Callable[[], Any]]] = [
        ("sum over the facets", len(points), lambda: body.acceleration(points)),
        ("table", len(far), lambda: field(far, body.shape.tabled_gravity)),
    ]
    if find_spec("polyhedral_gravity"):
        import polyhedral_gravity as library

        polyhedron = library.Polyhedron(
            polyhedral_source=(body.shape.vertices, body.shape.faces),
            density=body.density,
            normal_orientation=library.NormalOrientation.OUTWARDS,
            integrity_check=library.PolyhedronIntegrity.DISABLE,
        )
        few = points[:1000]
        calls.append(("polyhedral-gravity, serial", 1000, lambda: library.evaluate(polyhedron, few, parallel=False)))
    for name, count, call in calls:
        call()
        cpu, _, _ = timed(call, 3)
        rate = count / cpu
        row = {"gravity": name, "points": count, "evaluations_per_s": rate, "facets": facets}
        if name != "table":
            row["facets_per_s"] = rate * facets
        print(f"{name}: {rate:.3g} evaluations/s" + ("" if name == "table" else f", {rate * facets:.3g} facets/s"))
        rows.append(row)
    return rows


def flight_rows(body: Body, gravity: str, counts: list[int], threads: int) -> list[Row]:
    """Flights of rising number, so that the growth is seen; the last also on another number of threads, bit by bit."""
    rows: list[Row] = []
    fly(body, *cone(body, 64), DURATION, gravity=gravity)
    for count in counts:
        start = cone(body, count)
        cpu, wall, flights = timed(lambda start=start: fly(body, *start, DURATION, gravity=gravity, threads=threads))
        steps = int(flights.step_count.sum())
        row: Row = {"gravity": gravity, "partner": body.partner is not None, "flights": count, "threads": threads}
        row |= {"cpu_s": cpu, "wall_s": wall, "cpu_us_per_flight": 1e6 * cpu / count, "steps_per_flight": steps / count}
        row["shares"] = {name: float((flights.status == name).mean()) for name in np.unique(flights.status).tolist()}
        print(
            f"{gravity}, partner {row['partner']}, {count} flights: {cpu:.1f} s CPU, {wall:.1f} s wall, {row['shares']}"
        )
        rows.append(row)
    other = fly(body, *cone(body, counts[0]), DURATION, gravity=gravity, threads=1 if threads > 1 else 2)
    again = fly(body, *cone(body, counts[0]), DURATION, gravity=gravity, threads=threads)
    same = all(np.array_equal(getattr(other, name), getattr(again, name)) for name in ("time", "position", "velocity"))
    rows[0]["same_bits_on_1_and_more_threads"] = same
    return rows


def processor() -> str:
    """Name of the processor, where the system tells it."""
    path = Path("/proc/cpuinfo")
    lines = path.read_text().splitlines() if path.is_file() else []
    return next(
        (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.processor()
    )


def main() -> None:
    options = command_line(
        __doc__, table=[25_000, 50_000, 100_000], exact=[2_500, 5_000, 10_000], threads=2
    ).parse_args()
    alone, both = didymos(partner=False), didymos()
    error = alone.shape.table_error._asdict()
    result = {
        **origin(" ".join(["benchmarks/flight_speed.py", *sys.argv[1:]])),
        "processor": processor(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        "table_error": error,
    }
    rows = gravity_rows(alone)
    for body in (alone, both):
        rows += flight_rows(body, "table", options.table, options.threads)
        rows += flight_rows(body, "exact", options.exact, options.threads)
    result["rows"] = rows
    write_document(RESULTS, result)


if __name__ == "__main__":
    main()
