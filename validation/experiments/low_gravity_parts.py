"""What the tables of the experiments in low gravity say: rows of the page's table, and tables of their own."""

import math
import textwrap

import numpy as np
from ball_under_gravities import KINDS
from draw import of_balls, of_packing, of_plates
from fits import Estimate, Lines, column, line, mean_of, powers, said
from page import table, yes
from plate_into_loose_grains import SPEED
from quantities import NOT_SHOWN
from result_rows import FIGURES, HERE, Row, read_rows

BENNU = 1190.0  # kg/m3, bulk density
SPEED_AFTER_6, DEPTH_AFTER_6 = 0.04, 0.39  # m/s; m, between 0.37 and 0.42 as the drag goes
PLAIN = ("filled 0.58", "again 2", "again 3")
RESISTS = 0.1  # of its speed, that a plate has at most after six seconds where the bed resists
FRICTION_ANGLE, COHESION = 28.0, 50.0  # deg, Pa: [Ballouz-2021]
EXPONENT, BAR = 4 / 3, 0.15
# Excess volume over that under Earth's gravity, in parts of it, and the gravity over Earth's.
KEULEN = {"glass": (0.0425, 0.25 / 9.81), "coarse basalt": (0.122, 0.15 / 9.81)}


def packing_curve(rows: list[Row], kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Mean solid fraction of a kind over the pull of a contact in weights of a grain."""
    own = [row for row in rows if row["kind"] == kind]
    pulls = np.array(sorted({row["pull"] for row in own}))
    return pulls, np.array([np.mean([row["solid_fraction"] for row in own if row["pull"] == pull]) for pull in pulls])


def excess(pulls: np.ndarray, fractions: np.ndarray, pull: float, share: float) -> float:
    """Excess volume under a share of Earth's gravity of grains whose contacts pull so many weights under Earth's."""
    at = np.interp(np.log([pull, pull / share]), np.log(np.maximum(pulls, 1e-3)), fractions)
    return float(at[0] / at[1] - 1.0)


def packing_part() -> tuple[Lines, str]:
    rows = read_rows(HERE / "packing_and_cohesion.csv")
    lines, said = [], []
    for kind, (measured, share) in KEULEN.items():
        pulls, fractions = packing_curve(rows, kind)
        if len(pulls) < 4:
            continue
        tried = np.geomspace(1e-3, pulls.max() * share, 200)
        found = np.array([excess(pulls, fractions, float(pull), share) for pull in tried])
        count = sum(row["kind"] == kind for row in rows)
        # By similarity, whatever the gravity.
        none = Estimate(0.0, math.nan, count)
        cause = f"{kind} with cohesion" if found.max() >= measured else NOT_SHOWN
        lines.append(line(f"{kind}: volume in excess of that on Earth, no cohesion", measured, none, 0.25 * measured,
                          cause=cause))  # fmt: skip
        if found.max() >= measured:
            pull = float(tried[int(np.argmax(found >= measured))])
            said.append(
                f"{kind[0].upper()}{kind[1:]} takes the measured {100.0 * measured:g} % more volume at "
                f"{share * 9.81:.2g} m/s2 if the pull-off force of a contact is {pull:.2g} of the weight of a grain on "
                "Earth."
            )
        else:
            said.append(
                f"{kind[0].upper()}{kind[1:]} takes at most {100.0 * found.max():.1f} % more volume, for any pull-off "
                f"force up to {pulls.max() * share:.2g} of the weight of a grain on Earth. The measured excess is "
                f"{100.0 * measured:g} %."
            )
    of_packing(rows, FIGURES / "packing_and_cohesion.png")
    heads = ("grains", "pull-off force / weight of a grain", "beds", "solid fraction", "coordination number")
    cells = []
    for kind in KEULEN:
        for pull in sorted({row["pull"] for row in rows if row["kind"] == kind}):
            own = [row for row in rows if row["kind"] == kind and row["pull"] == pull]
            cells.append((kind, f"{pull:g}", str(len(own)), f"{column(own, 'solid_fraction').mean():.4f}",
                          f"{column(own, 'coordination').mean():.2f}"))  # fmt: skip
    return lines, table(heads, cells) + "\n\n" + "\n".join(textwrap.wrap(" ".join(said), 98))


def compared(every: list[Row]) -> list[Row]:
    """Return the drops that are held against the sources: under Earth's gravity those on stiffer beads."""
    return [row for row in every if row["kind"] == ("stiffer" if row["share"] == 1.0 else "plain")]


def balls_part() -> tuple[Lines, str]:
    every = read_rows(HERE / "ball_under_gravities.csv")
    rows = compared(every)
    reach = column(rows, "depth") + column(rows, "touch_height")
    of_gravity = powers(reach, column(rows, "froude"), column(rows, "share"))[1]
    by_speed, by_gravity = powers(reach, column(rows, "speed"), column(rows, "share"))
    of_time = powers(column(rows, "duration_in_units"), column(rows, "share"))[0]
    lines = [
        line("exponent of depth over gravity at one Froude number (Sunday)", 0.0, of_gravity, 0.05, "0"),
        line("exponent of duration in sqrt(D/g) over gravity (Sunday)", 0.0, of_time, 0.05, "0"),
        line("exponent of depth over gravity at one speed (Murdoch)", 0.0, by_gravity, 0.05, "0",
             "cohesive beads (4 drops)"),
        line("exponent of depth over speed at one gravity (Murdoch)", 1.0, by_speed, 0.05, "1",
             "cohesive beads (4 drops)"),
    ]  # fmt: skip
    of_balls(rows, FIGURES / "ball_under_gravities.png")
    heads = ("beads", "gravity / Earth's", "Froude number", "speed [m/s]", "depth below first touch [cm]",
             "duration [sqrt(D/g)]", "peak deceleration [g]", "rebound speed [m/s]")  # fmt: skip
    cells = (
        (str(row["kind"]).replace("pulling", "cohesive"), f"{row['share']:g}", f"{row['froude']:g}",
         f"{row['speed']:.3g}",
         f"{100 * (row['depth'] + row['touch_height']):.2f}", f"{row['duration_in_units']:.2f}",
         f"{row['peak_deceleration_in_g']:.1f}", f"{row['speed_out']:.3f}")
        for row in sorted(every, key=lambda row: list(KINDS).index(str(row["kind"])))
    )  # fmt: skip
    return lines, table(heads, cells)


def plate_part() -> tuple[Lines, str]:
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


def force_exponent(rows: list[Row]) -> Estimate:
    """Exponent of the mean force on the plate over its first speed."""
    return powers(column(rows, "mean_force"), column(rows, "speed"))[0]


def speed_table(every: list[Row]) -> str:
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
