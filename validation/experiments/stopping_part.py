"""What the paths of balls in beads say: rows of the page's table, its section and its verdict."""

import math
from functools import cache, partial
from typing import Any

import numpy as np
from ball_into_beads import BALL
from draw import of_forces
from fits import SHARE, Estimate, Line, Lines, line, mean_of, said, scale
from page import table
from result_rows import FIGURES, HERE, Row, read_rows
from stopping_force import BEDS, COMPARED, FALLS, NAME, PATHS, STEEL
from stopping_law import Law, along_paths, at_depths, law_depth, law_time, with_intervals

MEASURED = Law(0.087, 1040.0)  # of a steel ball of 25.4 mm in glass beads [Katsuragi-2007]
BULK = 1520.0  # kg/m3, of these beads
STILL = 0.02  # of the impact speed, below which a ball has stopped: what creeps on after that takes long
MM = 1e3
# From where the ball is in by half, and its section grows no more, in steps of a bead.
DEPTHS = partial(at_depths, first=0.5 * BALL, step=BEDS[COMPARED].mean_diameter)


def source_law(looks: list[Row]) -> Law:
    return DEPTHS(looks)[0]


@cache
def rows_of(name: str) -> list[Row]:
    return read_rows(HERE / name)


def drops(bed: str = COMPARED) -> list[Row]:
    """Return the drops into a bed, the lightest ball first and the slowest of each first."""
    rows = [row for row in rows_of(NAME) if row["bed"] == bed]
    return sorted(rows, key=lambda row: (row["density"], row["fall"]))


def steel(bed: str = COMPARED) -> list[Row]:
    """Return the drops of steel balls into a bed, the slowest first."""
    return [row for row in drops(bed) if row["density"] == STEEL]


def looks(density: float, bed: str = COMPARED) -> list[Row]:
    """Return the looks at the paths of balls of a density [kg/m3] in a bed."""
    return [row for row in rows_of(PATHS) if (row["bed"], row["density"]) == (bed, density)]


def densities() -> list[float]:
    """Return the densities of the balls [kg/m3]."""
    return sorted({row["density"] for row in drops()})


def in_mm(length: Estimate) -> Estimate:
    """Return a length [m] in millimetres."""
    return Estimate(MM * length.value, MM * length.half, length.rows)


def stopping_part() -> tuple[Lines, str]:
    length, friction = with_intervals(looks(STEEL), source_law)
    deep = mean_of([row["deepest"] / law_depth(row["fall"], MEASURED) for row in steel()])
    lines = [
        line("depth of a steel ball / depth by the measured force", 1.0, deep, SHARE),
        line("friction over mass k/m [1/s2]", MEASURED.friction, friction, SHARE * MEASURED.friction, "1040 +- 10"),
        line("inertial length d1 [mm]", MM * MEASURED.length, in_mm(length), SHARE * MM * MEASURED.length, "87 +- 7"),
        Line("stopping time, slowest to fastest steel ball [ms]", "decreases", times_said(COMPARED), len(steel()), "-",
             bool((np.diff(stopping_times(COMPARED)) < 0.0).all()), tolerance="each less than the one before"),
    ]  # fmt: skip
    of_forces(looks(STEEL), DEPTHS(looks(STEEL))[1], MEASURED, SHARE, FIGURES / "stopping_force.png")
    return lines, "\n\n".join((depth_table(), bed_table(), law_table()))


def stopping_times(bed: str) -> list[float]:
    """Return when each steel ball in a bed, the slowest first, is slower than STILL of its impact speed [s]."""
    paths, times = looks(STEEL, bed), []
    for row in steel(bed):
        least = STILL * row["impact_speed"]
        times.append(min(one["time"] for one in paths if one["fall"] == row["fall"] and one["speed"] < least))
    return times


def times_said(bed: str) -> str:
    """Return the stopping times of the steel balls in a bed [ms]."""
    return ", ".join(f"{MM * time:.0f}" for time in stopping_times(bed))


def forces() -> np.ndarray:
    """Return drag m/d1 [kg/m] and friction k [N/m] along the paths of each density, shape [densities, 2]."""
    found = []
    for density in densities():
        law = along_paths([row for row in looks(density) if row["fall"] in FALLS])
        mass = density * math.pi / 6.0 * BALL**3
        found.append((mass / law.length, mass * law.friction))
    return np.array(found)


def law_table() -> str:
    heads = ("density [kg/m3]", "drag m/d1 [kg/m]", "friction k [N/m]")
    return table(heads, (
        (f"{density:g}", f"{drag:.2f}", f"{rub:.1f}")
        for density, (drag, rub) in zip(densities(), forces(), strict=True)
    ))  # fmt: skip


def bed_table() -> str:
    """Return the table of what size and modulus of the beads do to the two coefficients and to the stopping times."""
    heads = ("beads", "d1 [mm]", "k/m [1/s2]", "falls [m]", "depths [cm]", "stopping times [ms]")
    cells = []
    for bed in BEDS:
        law, rows = source_law(looks(STEEL, bed)), steel(bed)
        falls = ", ".join(f"{row['fall']:g}" for row in rows)
        depths = ", ".join(f"{100.0 * row['deepest']:.2f}" for row in rows)
        cells.append((bed, f"{MM * law.length:.0f}", f"{law.friction:.0f}", falls, depths, times_said(bed)))
    return table(heads, cells)


def depth_table() -> str:
    heads = ("fall [m]", "impact speed [m/s]", "depth here [cm]", "by the measured force", "ratio",
             "stopping time here [ms]", "by the measured force", "prefactor by the measured force")  # fmt: skip
    cells = []
    for row, time in zip(steel(), stopping_times(COMPARED), strict=True):
        law = law_depth(row["fall"], MEASURED)
        cells.append((
            f"{row['fall']:g}", f"{row['impact_speed']:.2f}", f"{100.0 * row['deepest']:.2f}", f"{100.0 * law:.2f}",
            f"{row['deepest'] / law:.2f}", f"{MM * time:.0f}", f"{MM * law_time(row['fall'], MEASURED, STILL):.0f}",
            f"{law_prefactor(row, law):.3f}",
        ))  # fmt: skip
    return table(heads, cells)


def law_prefactor(row: Row, depth: float) -> float:
    """Return depth over (density / bulk density)^(1/2) D^(2/3) H^(1/3) of a depth [m] in the beads of the source."""
    return float((depth / scale([row | {"deepest": depth, "bulk_density": BULK}]))[0])


def measured_prefactor() -> Estimate:
    """Return the mean prefactor of the depths that the measured law gives steel balls from the heights of FALLS."""
    return mean_of([law_prefactor(row, law_depth(row["fall"], MEASURED)) for row in steel() if row["fall"] in FALLS])


def stopping_numbers() -> dict[str, Any]:
    """The numbers of the sentences about the paths."""
    here, reach = DEPTHS(looks(STEEL))
    length, friction = with_intervals(looks(STEEL), along_paths)
    short = [100.0 * (1.0 - law_depth(row["fall"], here) / row["deepest"]) for row in steel()]
    return {
        "lowest": 100.0 * reach[-1, 0], "least": min(short), "most": max(short), "length": said(in_mm(length)),
        "friction": said(friction),
    }  # fmt: skip
