"""What a step of the soft-surface engine is made of, on settled beds: a line a part, also in step_parts.json.

    python benchmarks/step_parts.py BED_FOLDER [CASE ...] [--out FILE]

CASE is any of hull1000, hull2000, hull4000, sph4000 (none: hull1000 and sph4000), see grains_speed.py. Forces are
computed for one kind of pairs after the other, by the features listed for them. Medians of CPU times, one thread.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from grains_beds import bed, coordination, relaxed
from grains_speed import RELAX_STEPS, REPEATS
from harness import Row, command_line, cpu_seconds, origin, write_document

from lithobrake.dem import World
from lithobrake.dem.bodies.arrays import Pairs
from lithobrake.dem.bodies.motion import drift, kick
from lithobrake.dem.narrow_phase.feature_distance import EDGES, feature_kind
from lithobrake.dem.narrow_phase.feature_list import update_feature_lists
from lithobrake.dem.stepping.engine import NO_REACTIONS
from lithobrake.dem.stepping.time_loop import contact_forces
from lithobrake.dem.stepping.time_step_stability import LOOK_STEPS, largest_step

CALLS = 50
KINDS = (
    "nothing near", "one corner, or two spheres", "one pair of edges", "two features", "three or more", "all features",
    "a plane",
)  # fmt: skip


def kinds_of(pairs: Pairs) -> np.ndarray:
    """Number in KINDS of every pair."""
    count = pairs.feature_count
    edges = np.array([feature_kind.py_func(int(name)) == EDGES for name in pairs.feature[:, 0]])
    kind = np.select([count < 0, count == 0, count == 1, count == 2], [5, 0, 1 + edges, 3], 4)
    return np.where(pairs.second < 0, 6, kind)


def parts(world: World) -> Iterator[tuple[str, float, float]]:
    """Return name, number a body and CPU time a body [ns] of the parts of a step."""
    world.run(steps=20)
    still, count = world._step(0.0), len(world.bodies)
    engine = world._state.stepping_together(still)
    bodies, pairs = engine.bodies, engine.pairs
    held = (engine.cores, engine.planes)

    def nanoseconds(work: Any) -> float:
        work()
        return 1e9 * cpu_seconds(lambda: [work() for _ in range(CALLS)], REPEATS) / CALLS / count

    yield "two half kicks", 1.0, 2.0 * nanoseconds(lambda: kick(bodies, still, 0, count))
    yield "drift and rotation", 1.0, nanoseconds(lambda: drift(bodies, still, 0, count))
    whole = len(pairs.first)
    looks = nanoseconds(lambda: update_feature_lists(bodies, *held, pairs, engine.scratch, 0.0, 0, whole))
    yield "looks at margins", whole / count, looks
    kind = kinds_of(pairs)
    order = np.argsort(kind, kind="stable")
    sorted_pairs = Pairs(*(getattr(pairs, name)[order] for name in Pairs._fields[:-1]), pairs.overflow)
    ends = np.searchsorted(kind[order], np.arange(len(KINDS) + 1))
    for name, start, stop in zip(KINDS, ends[:-1], ends[1:], strict=True):
        if start < stop:
            system = engine.system(NO_REACTIONS)._replace(pairs=sorted_pairs)
            parts = (system, still, False, start, stop)
            spent = nanoseconds(lambda parts=parts: contact_forces(*parts))
            yield f"forces: {name}", (stop - start) / count, spent
    look = nanoseconds(lambda: largest_step(bodies, engine.planes, pairs, engine.laws, False))
    yield f"look at stability, every {LOOK_STEPS} steps", 1.0 / LOOK_STEPS, look / LOOK_STEPS


def main() -> None:
    parser = command_line(__doc__, "folder", out=Path(__file__).with_suffix(".json"))
    parser.add_argument("case", nargs="*", default=["hull1000", "sph4000"])
    chosen = parser.parse_args()
    cases: Row = {}
    for case in chosen.case:
        world = relaxed(bed(chosen.folder, case), RELAX_STEPS)
        rows = [{"part": name, "a_body": number, "ns_a_body": spent} for name, number, spent in parts(world)]
        cases[case] = {"coordination": coordination(world), "parts": rows}
        total = sum(row["ns_a_body"] for row in rows)
        for row in rows:
            print(f"{case}: {row['part']:45s} {row['a_body']:6.3f} a body {row['ns_a_body']:7.1f} ns a body "
                  f"{row['ns_a_body'] / total:6.1%}", flush=True)  # fmt: skip
    write_document(chosen.out, {**origin("benchmarks/step_parts.py BED_FOLDER"), "cases": cases})


if __name__ == "__main__":
    main()
