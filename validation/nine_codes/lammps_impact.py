"""The impact of [Dosta-2024] in LAMMPS: height of the ball, and CPU time of a step next to this engine's.

    python validation/nine_codes/lammps_impact.py --positions 25KParticles.txt --work FOLDER --out FOLDER

Needs the Python package lammps. Begins with the bed as impact.py keeps it, relaxed by this engine, so that both have
the same spheres at the same places; LAMMPS makes the springs of friction anew. Writes impact_lammps_<run>.csv, height
[m] against time [s], lammps.csv, a line a run, and lammps_times.csv, both engines in turn on the same bed.
"""

import sys
from pathlib import Path

import numpy as np
from impact import HERE, LOOK, MEETS, advance, relaxed_bed
from impact_bed import add_ball
from lammps_bed import engine_of, state_of, write_data

from lithobrake.dem import World

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import add_row, command_line, origin, read_rows, table, timed, write_document

STEP = 5e-7  # s
UNTIL = 0.032  # s: the ball has left the bottom
# Dashpot across the normal over that along it: none, as MercuryDPM, and nearly as this engine (2 sqrt(G*/E*)).
DASHPOTS = {"no_dashpot": 0.0, "dashpot": 0.94}
# s: the ball is then in the bed. Steps a turn, and turns.
TIMED_AT, TIMED_STEPS, TURNS = 0.0215, 300, 3


def write_world(world: World, path: Path) -> None:
    """Write the spheres of a world, the ball last, for LAMMPS."""
    write_data(path, world.position, world.velocity, world.spin)


def follow(world: World, dashpot: float, work: Path, path: Path) -> None:
    """Let LAMMPS follow the ball from the state of a world, and write its height as it goes."""
    add_ball(world, (0.0, 0.0))
    count, data = len(world.position), work / "impact.data"
    write_world(world, data)
    engine = engine_of(data, STEP, count, dashpot)
    with table(path, ("time", "z", "v_z")) as add:
        for look in range(1, round((UNTIL - MEETS) / LOOK) + 1):
            engine.command(f"run {round(LOOK / STEP)} post no")
            height, speed = engine.extract_variable("height"), engine.extract_variable("speed")
            add({"time": f"{MEETS + look * LOOK:.7g}", "z": f"{height:.9g}", "v_z": f"{speed:.6g}"})
    engine.close()


def times(world: World, work: Path) -> list[dict[str, float]]:
    """Return CPU times of a step [s] of both engines in turn, from the same state of the impact."""
    add_ball(world, (0.0, 0.0))
    advance(world, TIMED_AT, STEP)
    world.time_step = STEP
    count, data = len(world.position), work / "timed.data"
    write_world(world, data)
    engine = engine_of(data, STEP, count, DASHPOTS["dashpot"])
    engine.command("run 100 post no")
    world.run(steps=100)
    rows = []
    for turn in range(TURNS):
        _, theirs = timed(lambda: engine.command(f"run {TIMED_STEPS} pre no post no"))
        _, ours = timed(lambda: world.run(steps=TIMED_STEPS))
        rows.append({"turn": turn, "lammps": theirs / TIMED_STEPS, "lithobrake": ours / TIMED_STEPS})
    apart = float(np.abs(state_of(engine, count)[0][-1] - world.position[-1]).max())
    return [row | {"steps": TIMED_STEPS, "spheres": count, "ball_apart": apart} for row in rows]


def main() -> None:
    """Make the runs that are not there."""
    options = command_line(
        __doc__, positions=Path, work=Path("nine_codes_work"), out=HERE, only=("times", *DASHPOTS)
    ).parse_args()
    clock, out = options.out / "lammps_times.csv", options.out / "lammps.csv"
    if "times" in options.only and not clock.exists():
        for row in times(relaxed_bed(options.positions, options.work), options.work):
            add_row(clock, row, digits=5)
    done = {row["run"] for row in read_rows(out, {"run": str})}
    for name, dashpot in DASHPOTS.items():
        if name in done or name not in options.only:
            continue
        world, curve = relaxed_bed(options.positions, options.work), options.out / f"impact_lammps_{name}.csv"
        _, seconds = timed(
            lambda world=world, dashpot=dashpot, curve=curve: follow(world, dashpot, options.work, curve)
        )
        add_row(out, {"run": name, "dashpot": dashpot, "step": STEP, "until": UNTIL, "cpu_s": seconds}, digits=7)
    write_document(options.out / "lammps.json", origin("validation/nine_codes/lammps_impact.py"))


if __name__ == "__main__":
    main()
