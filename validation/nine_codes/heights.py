"""Heights of the ball in the runs of the benchmark's impact: read, extrapolated in free flight, and printed."""

import sys
import textwrap
from pathlib import Path

import numpy as np
from impact import FROM_START, LATER, RUNS
from impact_bed import GRAVITY, in_free_fall

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import read_rows

HERE = Path(__file__).parent
PAGES = HERE.parents[1] / "docs" / "validation"
CRITERION = 0.001  # m
ASKED, ADDED = (0.01, 0.02, 0.05, 0.1), (0.022, 0.025, 0.0275, 0.029, 0.03, 0.032)  # s
BOTTOM = 0.02925  # s: just before the ball meets the layer on the floor
# m/s2, by which an acceleration may differ from that of gravity in free flight; it is looked at over so many rows.
FREE, LAST = 0.1, 4
ROUNDING = 1e-6  # m, of heights in free fall, which are alike
PLACES = ("east", "north", "west", "south")  # impacts to a side
OURS = FROM_START  # the run of the benchmark's law, which is compared
IMPACTS = ("published", *PLACES, "nudged")
# Runs without a dashpot across the normal.
UNDAMPED = ("mercury", "lammps_no_dashpot", FROM_START, LATER)
Curve = tuple[np.ndarray, np.ndarray, np.ndarray]


def curves() -> dict[str, Curve]:
    """Return times [s], heights [m] and velocities upwards [m/s] of each run that was begun."""
    found = {}
    for name in (*(one.run for one in RUNS), "mercury", "lammps_no_dashpot", "lammps_dashpot"):
        rows = read_rows(HERE / f"impact_{name}.csv", {})
        if rows:
            time, z, speed = (np.array([row[column] for row in rows]) for column in ("time", "z", "v_z"))
            found[name] = time, z, speed
    return found


def flies_at_its_end(curve: Curve) -> bool:
    """Return whether the ball moves under gravity alone in the last rows."""
    time, _, speed = curve
    acceleration = np.diff(speed[-LAST:]) / np.diff(time[-LAST:])
    return bool(np.abs(acceleration + GRAVITY).max() < FREE)


def height(curve: Curve, time: float) -> float | None:
    """Return the height [m] at a time [s], none after the end of a curve in which the ball does not fly freely then.

    Before a curve begins, and after it ends, the height is that of free flight.
    """
    times, z, speed = curve
    if time < times[0]:
        return in_free_fall(time)[0]
    if time <= times[-1] + 1e-5:
        return float(np.interp(time, times, z))
    if not flies_at_its_end(curve):
        return None
    left = time - times[-1]
    return float(z[-1] + speed[-1] * left - 0.5 * GRAVITY * left**2)


def mm(value: float | None, digits: int = 2) -> str:
    """Return a length [m] in mm."""
    return "not run" if value is None else f"{1000.0 * value:.{digits}f}"


def paragraph(words: str) -> str:
    """Return words as lines of a page."""
    return "\n".join(textwrap.wrap(words, 100, break_long_words=False, break_on_hyphens=False))


def named(run: str) -> str:
    """Return the name of a run in words."""
    return run.replace("lammps", "LAMMPS").replace("_", " ")


def rebound(curve: Curve) -> float | None:
    """Return the speed [m/s] at which the ball leaves the bottom, none where it has not left."""
    return float(curve[2].max()) if curve[2].max() > 0.0 else None
