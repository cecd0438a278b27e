"""A steel ball into 25 000 spheres at 5 m/s [Dosta-2024]: height of the ball against time, in this engine.

    python validation/nine_codes/impact.py --positions 25KParticles.txt --work FOLDER --out FOLDER

positions: the file of that name in Drivers/Papers/OSBenchmark/Penetration of MercuryDPM. The bed relaxes without the
ball while that falls freely, and is kept in the work folder. Writes impact.csv, a line a run; impact_<run>.csv, the
height of the ball's centre [m] against time [s], as the run goes on; impact.json. Runs that stand in impact.csv are not
made again. --until S ends all runs there at the latest; --only NAMES makes these alone.
"""

import contextlib
import math
import sys
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from impact_bed import BALL_RADIUS, GRAIN_RADIUS, Floats, add_ball, published_positions, world_of

from lithobrake.dem import StepTooLargeError, World

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import add_row, command_line, origin, read_rows, table, timed, write_document

HERE = Path(__file__).parent
# s: the ball is then 0.9 mm above the highest grain.
MEETS = 0.0205
BED_STEP = 1e-6  # s
LOOK = 2.5e-4  # s, from row to row of a curve
# m, of the blocks by which grains are numbered, so that neighbours lie close in memory.
BLOCK = 0.008


@dataclass(frozen=True)
class Impact:
    """A run: where the ball comes down [m], the longest time step [s] until a time [s], and when it ends [s].

    After that time the bed's step is the longest. Where contacts ask for shorter steps, they are taken.
    """

    run: str
    x: float
    y: float
    step: float
    step_until: float
    until: float


# The first is as published; the others come down elsewhere, or a billionth of a metre off, or without the tangential
# dashpot, which MercuryDPM lacks, or at half the step.
RUNS = (
    Impact("published", 0.0, 0.0, 5e-7, 0.032, 0.1),
    Impact("east", 0.005, 0.0, 5e-7, 0.032, 0.05),
    Impact("north", 0.0, 0.005, 5e-7, 0.032, 0.05),
    Impact("west", -0.005, 0.0, 5e-7, 0.032, 0.05),
    Impact("south", 0.0, -0.005, 5e-7, 0.032, 0.05),
    Impact("nudged", 1e-9, 0.0, 5e-7, 0.032, 0.05),
    Impact("no_dashpot", 0.0, 0.0, 5e-7, 0.032, 0.05),
    Impact("no_dashpot_later", 0.0, 0.0, 5e-7, 0.032, 0.05),
    Impact("half_step", 0.0, 0.0, 2.5e-7, 0.032, 0.05),
)
# Without a dashpot across the normal: from the start, and from when the ball comes near.
FROM_START, LATER = "no_dashpot", "no_dashpot_later"
# Of the largest step that the contacts allow; it is looked at anew after so many.
SHARE, STEPS = 0.9, 50


def in_blocks(positions: Floats) -> Floats:
    """Return positions in the order of the blocks that they are in."""
    block = np.floor((positions - positions.min(axis=0)) / BLOCK)
    return positions[np.lexsort(block.T)]


def relaxed_bed(positions: Path, work: Path, run: str = "published") -> World:
    """Return the bed of a run as it is when the ball has come near, from the work folder, made if it is not there."""
    dashpot = "none" if run == FROM_START else "mindlin"
    path = work / f"bed_{BED_STEP:g}_{MEETS:g}{'' if dashpot == 'mindlin' else '_no_dashpot'}.h5"
    if not path.exists():
        work.mkdir(parents=True, exist_ok=True)
        world = world_of(in_blocks(published_positions(positions)), BED_STEP, dashpot)
        advance(world, MEETS, BED_STEP)
        world.save(path)
    world = World.load(path)
    if run == LATER:
        # The engine of the world is made anew when the ball is added.
        world._state.options["tangential_dashpot"] = "none"
    return world


def advance(world: World, until: float, longest: float) -> int:
    """Run a world until a time [s] in steps of at most so long [s], and return their number."""
    taken = 0
    while (left := until - world.time) > 1e-6 * longest:
        count = math.ceil(left / min(longest, SHARE * world.largest_step) - 1e-6)
        world.time_step, before = left / count, world.time
        # Where a contact that was met asks for a smaller step, the next has it.
        with contextlib.suppress(StepTooLargeError):
            world.run(steps=min(count, STEPS))
        taken += round((world.time - before) / world.time_step)
    return taken


def follow(world: World, impact: Impact, path: Path) -> int:
    """Let the ball fall on until the run ends, write its height and its speed as it goes, and return the steps."""
    ball, taken = add_ball(world, (impact.x, impact.y)), 0
    looks = round((impact.until - MEETS) / LOOK)
    with table(path, ("time", "z", "v_z", "steps")) as add:
        for look in range(1, looks + 1):
            time = MEETS + look * LOOK
            taken += advance(world, time, impact.step if time < impact.step_until + 0.5 * LOOK else BED_STEP)
            z, speed = float(world.position[ball, 2]), float(world.velocity[ball, 2])
            add({"time": f"{world.time:.7g}", "z": f"{z:.9g}", "v_z": f"{speed:.6g}", "steps": taken})
    return taken


def measured(path: Path) -> dict[str, float]:
    """Return of a curve the lowest height of the centre [m], when [s], and the peak of the deceleration [m/s2]."""
    rows = read_rows(path, {})
    z, time, speed = (np.array([row[name] for row in rows]) for name in ("z", "time", "v_z"))
    return {
        "lowest_z": float(z.min()), "lowest_at": float(time[z.argmin()]), "last_z": float(z[-1]),
        "mean_deceleration": float(np.max(np.diff(speed)) / LOOK),
    }  # fmt: skip


def main() -> None:
    options = command_line(
        __doc__, positions=Path, work=Path("nine_codes_work"), out=HERE, only=tuple(one.run for one in RUNS), until=0.1
    ).parse_args()
    out = options.out / "impact.csv"
    done = {row["run"] for row in read_rows(out, {"run": str})}
    for named in RUNS:
        if named.run in done or named.run not in options.only:
            continue
        impact = replace(named, until=min(named.until, options.until))
        world = relaxed_bed(options.positions, options.work, impact.run)
        curve = options.out / f"impact_{impact.run}.csv"
        steps, seconds = timed(lambda world=world, impact=impact, curve=curve: follow(world, impact, curve))
        add_row(out, asdict(impact) | measured(curve) | {"steps": steps, "cpu_s": seconds}, digits=7)
    rows = read_rows(out, {"run": str})
    made = {"grain_radius": GRAIN_RADIUS, "ball_radius": BALL_RADIUS, "cpu_s_of_rows": sum(r["cpu_s"] for r in rows)}
    write_document(out.with_suffix(".json"), made | origin("validation/nine_codes/impact.py"))


if __name__ == "__main__":
    main()
