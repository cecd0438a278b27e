"""What the rows of the plate on loose grains say: rows of the page's table, the corners and exponents, its section."""

import math

import numpy as np
from draw_low_gravity import of_plates
from fits import Estimate, column, mean_of, powers
from plate_into_loose_grains import SPEED
from result_rows import Row, read_rows
from table_lines import FIGURES, HERE, Lines, line, said, table

BENNU = 1190.0  # kg/m3, bulk density
SPEED_AFTER_6, DEPTH_AFTER_6 = 0.04, 0.39  # m/s; m, between 0.37 and 0.42 as the drag goes
PLAIN = ("filled 0.58", "again 2", "again 3")
RESISTS = 0.1  # of its speed, that a plate has at most after six seconds where the bed resists
FRICTION_ANGLE, COHESION = 28.0, 50.0  # deg, Pa: [Ballouz-2021]
EXPONENT, BAR = 4 / 3, 0.15


def plate_part() -> tuple[Lines, str]:
    """Return rows of the table, and the section's tables."""
    every = read_rows(HERE / "plate_into_loose_grains.csv")
    rows = [row for row in every if row["series"] == "flight"]
    plain = [row for row in rows if row["name"] in PLAIN]
    filled = [row for row in rows if str(row["name"]).startswith("filled ")]
    filled.sort(key=lambda row: row["filled"])
    speed, density = column(filled, "speed_6"), column(filled, "bulk_density")
    needed = float(np.interp(-SPEED_AFTER_6, -speed, density))
    half = float(np.interp(0.5 * BENNU, density, speed))
    cause = "grains of half the density"
    lines = [
        line("speed 6 s after contact, packing fraction 0.58, no cohesion [m/s]", SPEED_AFTER_6,
             mean_of(list(column(plain, "speed_6"))), 0.25 * SPEED_AFTER_6, cause="packing fraction 0.6"),
        line("depth 6 s after contact [m]", DEPTH_AFTER_6, mean_of(list(column(plain, "depth_6"))),
             0.25 * DEPTH_AFTER_6),
        line("speed 6 s after contact at half of Bennu's bulk density [m/s]", SPEED_AFTER_6,
             Estimate(half, math.nan, 2), 0.25 * SPEED_AFTER_6, cause=cause),
        line("bulk density at which 0.04 m/s are left after 6 s [kg/m3]", 0.5 * BENNU,
             Estimate(needed, math.nan, len(filled)), 0.25 * 0.5 * BENNU, "half of 1190", cause),
    ]  # fmt: skip
    of_plates(every, FIGURES / "plate_into_loose_grains.png")
    return lines, "\n\n".join((flight_table(rows), corner_table(every), speed_table(every)))


def flight_table(rows: list[Row]) -> str:
    """Return the table of the flight's plate on beds that differ."""
    heads = ("simulation", "grains", "packing fraction", "bulk density [kg/m3]", "speed after 1 s [m/s]",
             "speed after 6 s [m/s]", "depth after 6 s [m]")  # fmt: skip
    return table(heads, (
        (named(str(row["name"])), f"{int(row['grains'])}", f"{row['filled']:g}", f"{row['bulk_density']:.0f}",
         f"{row['speed_1']:.3f}", f"{max(row['speed_6'], 0.0):.3f}", f"{row['depth_6']:.2f}") for row in rows
    ))  # fmt: skip


def named(name: str) -> str:
    """Return the name of a simulation of the flight, as a reader has it."""
    for kept, words in (("filled ", "packing fraction "), ("again ", "packing fraction 0.58, seed ")):
        name = name.replace(kept, words) if name.startswith(kept) else name
    return name.replace("half density ", "half the grain density, packing fraction ")


def slope_of(kind: str) -> Estimate:
    """Return the slope of heaps of the grains of a kind [deg]."""
    return mean_of([row["angle_deg"] for row in read_rows(HERE / "plate_slopes.csv") if row["kind"] == kind])


def corner_table(every: list[Row]) -> str:
    """Return the table of the corners of packing, friction and cohesion."""
    heads = ("packing fraction", "slope of a heap [deg]", "cohesion [Pa]", "speed after 6 s [m/s]",
             "depth after 6 s [m]", "stops the plate", "stops it in [Ballouz-2021]")  # fmt: skip
    cells = []
    for row in (row for row in every if row["series"] == "corners"):
        slope = slope_of("smooth" if "smooth" in row["name"] else "rough").value
        dense = row["filled"] >= 0.6
        expected = dense and (slope >= FRICTION_ANGLE or row["cohesion"] >= COHESION)
        cells.append((
            f"{row['filled']:g}", f"{slope:.1f}", f"{row['cohesion']:g}", f"{max(row['speed_6'], 0.0):.3f}",
            f"{row['depth_6']:.2f}", yes(row["speed_6"] < RESISTS * SPEED),
            yes(expected) if dense else "drag only",
        ))  # fmt: skip
    return table(heads, cells)


def yes(answer: bool) -> str:
    """Return an answer as a word."""
    return "yes" if answer else "no"


def force_exponent(rows: list[Row]) -> Estimate:
    """Exponent of the mean force on the plate over its first speed."""
    return powers(column(rows, "mean_force"), column(rows, "speed"))[0]


def speed_table(every: list[Row]) -> str:
    """Return the table of mean forces over speeds, with the exponents."""
    own = [row for row in every if row["series"] == "speeds"]
    speeds = sorted({row["speed"] for row in own})
    heads = (
        "cohesion [Pa]",
        *(f"mean force at {speed:g} m/s [N]" for speed in speeds),
        "exponent of speed, +- 95 %",
        "within 4/3 +- 0.15",
    )
    cells = []
    for pull in sorted({row["cohesion"] for row in own}):
        rows = sorted((row for row in own if row["cohesion"] == pull), key=lambda row: row["speed"])
        found = force_exponent(rows)
        cells.append((f"{pull:g}", *(f"{row['mean_force']:.3g}" for row in rows), said(found),
                      yes(abs(found.value - EXPONENT) <= BAR)))  # fmt: skip
    return table(heads, cells)
