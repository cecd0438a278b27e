"""The two pair tests of [Dosta-2024]: a ball that rebounds from a plane, and one that slides on it.

    python validation/nine_codes/pair_tests.py --work FOLDER --out FOLDER

Writes pair_tests.csv, a line a quantity and a time step, and pair_tests.json. work is not used.
"""

import sys
from pathlib import Path

from impact_bed import GRAIN, GRAIN_RADIUS, STEEL

from lithobrake.dem import Material, Sphere, World

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import add_row, command_line, origin, read_rows, timed, write_document

HERE = Path(__file__).parent
# Of M1 on steel restitution is 0.4 and friction 0.2, the smaller of both.
M1 = Material(restitution=0.5, friction=0.3, **GRAIN)
BALL = Material(restitution=0.4, friction=0.2, **STEEL)
STEP = 5e-7  # s, as published
RESTITUTION, FRICTION, PUSH = 0.4, 0.2, 5.0  # of M1 on steel; m/s2, along and into the plane
# Steps of the published one; MercuryDPM's ends last one step longer than they say.
HERTZ_STEPS, MINDLIN_STEPS = 121, 10001
# What MercuryDPM keeps in SelfTestData/OS*.restart; its restitution at a tenth of the step by its driver, run here.
MERCURY = {
    ("restitution", 1): 0.40107538074925, ("restitution", 10): 0.399947277166945,
    ("v_x", 1): 0.0200031141978808, ("omega_y", 1): 12.4983210042401, ("x", 1): 5.00201149456655e-05,
}  # fmt: skip
# Parts of the published step at which the rebound is followed.
PARTS = (1, 2, 5, 10, 50)


def hertz(part: int) -> dict[str, float]:
    """Return the restitution of M1 that falls on steel from z = 1.01 mm at 1 m/s, at a part of the published step."""
    world = World(time_step=STEP / part)
    world.add_body(Sphere(GRAIN_RADIUS), M1, (0, 0, 0.00101), velocity=(0, 0, -1.0))
    world.add_plane((0, 0, 0), (0, 0, 1), BALL)
    world.run(steps=HERTZ_STEPS * part)
    return {"restitution": float(world.velocity[0, 2])}


def mindlin() -> dict[str, float]:
    """Return speed, spin and path of a ball of steel that begins to slide on M1."""
    world = World((PUSH, 0.0, -PUSH), STEP)
    world.add_body(Sphere(GRAIN_RADIUS), BALL, (0, 0, GRAIN_RADIUS))
    world.add_plane((0, 0, 0), (0, 0, 1), M1)
    world.run(steps=MINDLIN_STEPS)
    return {"v_x": float(world.velocity[0, 0]), "omega_y": float(world.spin[0, 1]), "x": float(world.position[0, 0])}


def closed_forms() -> dict[str, float]:
    """Return what follows without a simulation: a ball that slides from the start, by Coulomb's law."""
    time, acceleration = MINDLIN_STEPS * STEP, PUSH * (1.0 - FRICTION)
    spin = 2.5 * FRICTION * PUSH / GRAIN_RADIUS * time
    return {
        "restitution": RESTITUTION, "v_x": acceleration * time, "omega_y": spin, "x": 0.5 * acceleration * time**2
    }  # fmt: skip


def main() -> None:
    options = command_line(__doc__, work=Path("."), out=HERE).parse_args()
    out, exact = options.out / "pair_tests.csv", closed_forms()
    if not read_rows(out, {"quantity": str, "mercury": str}):
        for part, work in [(part, lambda part=part: hertz(part)) for part in PARTS] + [(1, mindlin)]:
            found, seconds = timed(work)
            for name, value in found.items():
                theirs = MERCURY.get((name, part), "")
                row = {"quantity": name, "step_s": STEP / part, "closed_form": exact[name], "mercury": theirs}
                add_row(out, row | {"lithobrake": value, "cpu_s": seconds / len(found)}, digits=10)
    write_document(out.with_suffix(".json"), origin("validation/nine_codes/pair_tests.py"))


if __name__ == "__main__":
    main()
