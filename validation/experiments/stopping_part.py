"""What the paths of balls in beads say: rows of the page's table, its section and its verdict."""

import math
from functools import partial

import numpy as np
from ball_into_beads import BALL
from draw_stopping import of_forces
from fits import Estimate, mean_of, powers, scale
from result_rows import Row, read_rows
from stopping_force import BEDS, COARSE, COMPARED, FALLS, NAME, PATHS, STEEL, STIFF
from stopping_law import Law, along_paths, at_depths, law_depth, with_intervals
from table_lines import FIGURES, HERE, NOT_SHOWN, Line, Lines, line, said, table

MEASURED = Law(0.087, 1040.0)  # of a steel ball of 25.4 mm in glass beads [Katsuragi-2007]
BULK = 1520.0  # kg/m3, of these beads
SHARE = 0.25  # of a measured value: the tolerance of depths, times and prefactors
LIMIT = 0.05  # the tolerance of exponents
STILL = 0.02  # of the impact speed, below which a ball has stopped: what creeps on after that takes long
MM = 1e3
# From where the ball is in by half, and its section grows no more, in steps of a bead.
DEPTHS = partial(at_depths, first=0.5 * BALL, step=BEDS[COMPARED].mean_diameter)


def source_law(looks: list[Row]) -> Law:
    """Return the law as the source finds it."""
    return DEPTHS(looks)[0]


def drops(bed: str = COMPARED) -> list[Row]:
    """Return the drops into a bed, the lightest ball first and the slowest of each first."""
    rows = [row for row in read_rows(HERE / NAME) if row["bed"] == bed]
    return sorted(rows, key=lambda row: (row["density"], row["fall"]))


def steel(bed: str = COMPARED) -> list[Row]:
    """Return the drops of steel balls into a bed, the slowest first."""
    return [row for row in drops(bed) if row["density"] == STEEL]


def looks(density: float, bed: str = COMPARED) -> list[Row]:
    """Return the looks at the paths of balls of a density [kg/m3] in a bed."""
    return [row for row in read_rows(HERE / PATHS) if (row["bed"], row["density"]) == (bed, density)]


def densities() -> list[float]:
    """Return the densities of the balls [kg/m3]."""
    return sorted({row["density"] for row in drops()})


def in_mm(length: Estimate) -> Estimate:
    """Return a length [m] in millimetres."""
    return Estimate(MM * length.value, MM * length.half, length.rows)


def stopping_part() -> tuple[Lines, str]:
    """Return rows of the table, and the section's tables."""
    length, friction = with_intervals(looks(STEEL), source_law)
    deep = mean_of([row["deepest"] / law_depth(row["fall"], MEASURED) for row in steel()])
    drag, rub = (powers(forces()[:, k], np.array(densities()))[0] for k in (0, 1))
    lines = [
        line("depth of a steel ball / depth by the measured force", 1.0, deep, SHARE),
        line("friction over mass k/m [1/s2]", MEASURED.friction, friction, SHARE * MEASURED.friction, "1040 +- 10"),
        line("inertial length d1 [mm]", MM * MEASURED.length, in_mm(length), SHARE * MM * MEASURED.length, "87 +- 7",
             cause_of_length()),
        stops_sooner(),
        line("exponent of friction k over density of the ball", 0.5, rub, LIMIT, "1/2"),
        line("exponent of drag m/d1 over density of the ball", 0.0, drag, LIMIT, "0"),
    ]  # fmt: skip
    of_forces(looks(STEEL), DEPTHS(looks(STEEL))[1], MEASURED, FIGURES / "stopping_force.png")
    return lines, "\n\n".join((depth_table(), law_table(), bed_table()))


def stops_sooner() -> Line:
    """Return the row of the stopping time: each faster ball stops sooner than the one before."""
    ours, cause = times_said(COMPARED), "stiffer beads" if decreases(STIFF) and not decreases(COARSE) else NOT_SHOWN
    return Line("stopping time, slowest to fastest steel ball [ms]", "decreases", ours, len(steel()), "-",
                decreases(COMPARED), cause)  # fmt: skip


def stopping_times(bed: str) -> list[float]:
    """Return when each steel ball in a bed, the slowest first, is slower than STILL of its impact speed [s]."""
    paths, times = looks(STEEL, bed), []
    for row in steel(bed):
        least = STILL * row["impact_speed"]
        times.append(min(one["time"] for one in paths if one["fall"] == row["fall"] and one["speed"] < least))
    return times


def decreases(bed: str) -> bool:
    """Whether each faster steel ball stops sooner in a bed than the one before."""
    return bool((np.diff(stopping_times(bed)) < 0.0).all())


def times_said(bed: str) -> str:
    """Return the stopping times of the steel balls in a bed [ms]."""
    return ", ".join(f"{MM * time:.0f}" for time in stopping_times(bed))


def fastest_law(bed: str) -> Law:
    """Return the law along the path of the fastest steel ball in a bed."""
    fall = max(row["fall"] for row in steel())
    return along_paths([row for row in looks(STEEL, bed) if row["fall"] == fall])


def cause_of_length() -> str:
    """Return that coarse beads are the cause, where finer ones bring the length nearer to the measured one."""
    coarse, fine = (fastest_law(bed).length for bed in (COARSE, COMPARED))
    return "beads of 3 instead of 5 mm" if coarse < fine < MEASURED.length else NOT_SHOWN


def forces() -> np.ndarray:
    """Return drag m/d1 [kg/m] and friction k [N/m] along the paths of each density, shape [densities, 2]."""
    found = []
    for density in densities():
        law, mass = along_paths(looks(density)), density * math.pi / 6.0 * BALL**3
        found.append((mass / law.length, mass * law.friction))
    return np.array(found)


def law_table() -> str:
    """Return the table of drag and friction along the paths, by density."""
    heads = ("density [kg/m3]", "drops", "drag m/d1 [kg/m]", "friction k [N/m]")
    counts = [sum(row["density"] == density for row in drops()) for density in densities()]
    return table(heads, (
        (f"{density:g}", str(count), f"{drag:.2f}", f"{rub:.1f}")
        for density, count, (drag, rub) in zip(densities(), counts, forces(), strict=True)
    ))  # fmt: skip


def bed_table() -> str:
    """Return the table of what size and modulus of the beads do to the fastest ball and to the stopping times."""
    heads = ("beads", "d1 along the path of the fastest ball [mm]", "k/m [1/s2]", "its depth [cm]",
             "falls [m]", "stopping times [ms]")  # fmt: skip
    cells = []
    for bed in BEDS:
        law, rows = fastest_law(bed), steel(bed)
        falls = ", ".join(f"{row['fall']:g}" for row in rows)
        cells.append((bed, f"{MM * law.length:.0f}", f"{law.friction:.0f}", f"{100.0 * rows[-1]['deepest']:.2f}",
                      falls, times_said(bed)))  # fmt: skip
    return table(heads, cells)


def depth_table() -> str:
    """Return the table of the depths of steel balls, and of what the measured force law gives."""
    heads = ("fall [m]", "impact speed [m/s]", "depth here [cm]", "depth by the measured force [cm]", "ratio",
             "prefactor of the depth by the measured force")  # fmt: skip
    cells = []
    for row in steel():
        law = law_depth(row["fall"], MEASURED)
        cells.append((
            f"{row['fall']:g}", f"{row['impact_speed']:.2f}", f"{100.0 * row['deepest']:.2f}", f"{100.0 * law:.2f}",
            f"{row['deepest'] / law:.2f}", f"{law_prefactor(row, law):.3f}",
        ))  # fmt: skip
    return table(heads, cells)


def law_prefactor(row: Row, depth: float) -> float:
    """Return depth over (density / bulk density)^(1/2) D^(2/3) H^(1/3) of a depth [m] in the beads of the source."""
    return float((depth / scale([row | {"deepest": depth, "bulk_density": BULK}]))[0])


def measured_prefactor() -> Estimate:
    """Return the mean prefactor of the depths that the measured law gives steel balls from the experiment's heights."""
    return mean_of([law_prefactor(row, law_depth(row["fall"], MEASURED)) for row in steel() if row["fall"] in FALLS])


def stopping_words() -> str:
    """Say what the paths show."""
    whole = with_intervals(looks(STEEL), along_paths)
    return (
        "The agreement in depth holds for beads of 3 mm: in finer ones balls sink deeper (section before).\n\n"
        f"Fitted along whole paths instead of at equal depths, d1 is {said(in_mm(whole[0]))} mm and k/m "
        f"{said(whole[1])} 1/s2 for the steel balls: shocks of single beads then count more.\n\n"
        "Why the inertial length disagrees: the beads are coarse. Along the path of the fastest ball it is "
        f"{MM * fastest_law(COARSE).length:.0f} mm in beads of 5 mm and {MM * fastest_law(COMPARED).length:.0f} mm in "
        "beads of 3 mm; those of the experiment are ten times smaller. The ball is slowed down most by the first beads "
        "that it meets.\n\n"
        "Why faster balls do not always stop sooner: the beads are soft. The fastest balls, after a strong "
        "deceleration, move on at nearly constant speed for a centimetre (figure). In beads of 5 mm seven times as "
        f"stiff (70 MPa) they do not, and the stopping times decrease: {times_said(STIFF)} ms instead of "
        f"{times_said(COARSE)} ms."
    )
