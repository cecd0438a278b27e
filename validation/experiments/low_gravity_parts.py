"""What the tables of the experiments in low gravity say: rows of the page's table, and tables of their own."""

import math
import textwrap

import numpy as np
from draw_low_gravity import of_balls, of_packing, of_plates
from fits import Estimate, column, mean_of, powers
from sphere_bed import Row, read_rows
from table_lines import FIGURES, HERE, Lines, line

BENNU = 1190.0  # kg/m3, bulk density
SPEED_AFTER_6, DEPTH_AFTER_6 = 0.04, 0.39  # m/s; m, between .37 and .42 as the drag goes
PLAIN = ("dense_again", "dense_wider", "dense_deeper", "filled_0.58")
# Excess volume over that under Earth's gravity, in parts of it, and the gravity over Earth's.
KEULEN = {"glass": (0.0425, 0.25 / 9.81), "coarse basalt": (0.122, 0.15 / 9.81)}


def plate_part() -> tuple[Lines, str]:
    """Rows and a table of the plate that meets loose grains."""
    rows = read_rows(HERE / "plate_into_loose_grains.csv")
    plain = [row for row in rows if row["name"] in PLAIN]
    filled = [row for row in rows if str(row["name"]).startswith("filled_")]
    speed, density = column(filled, "speed_6"), column(filled, "bulk_density")
    needed = float(np.interp(-SPEED_AFTER_6, -speed, density))
    half = float(np.interp(0.5 * BENNU, density, speed))
    lines = [
        line("plate: speed 6 s after contact, .58 filled, no cohesion [m/s]", SPEED_AFTER_6,
             mean_of(list(column(plain, "speed_6"))), 0.25 * SPEED_AFTER_6),
        line("plate: depth then [m]", DEPTH_AFTER_6, mean_of(list(column(plain, "depth_6"))), 0.25 * DEPTH_AFTER_6),
        line("plate: speed 6 s after contact at half of Bennu's bulk density [m/s]", SPEED_AFTER_6,
             Estimate(half, math.nan, 2), 0.25 * SPEED_AFTER_6),
        line("plate: bulk density that leaves .04 m/s after 6 s [kg/m3]", 0.5 * BENNU,
             Estimate(needed, math.nan, len(filled)), 0.25 * 0.5 * BENNU, "half of 1190"),
    ]  # fmt: skip
    of_plates(rows, FIGURES / "plate_into_loose_grains.png")
    table = (
        "| run | grains | bulk density [kg/m3] | speed after 1 s [m/s] | after 6 s | depth after 6 s [m] "
        "| stopped after [s] |\n|---|---|---|---|---|---|---|"
    )
    for row in rows:
        stopped = "-" if math.isnan(row["stopped_after"]) else f"{row['stopped_after']:.1f}"
        table += (
            f"\n| {str(row['name']).replace('_', ' ')} | {int(row['grains'])} | {row['bulk_density']:.0f} "
            f"| {row['speed_1']:.3f} | {max(row['speed_6'], 0.0):.3f} | {row['depth_6']:.2f} | {stopped} |"
        )
    return lines, table


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
    """Rows and a table of what cohesion does to a packing."""
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
        lines.append(line(f"{kind}: excess volume in low gravity, no cohesion", measured, none, 0.25 * measured))
        if found.max() >= measured:
            pull = float(tried[int(np.argmax(found >= measured))])
            said.append(
                f"{kind[0].upper()}{kind[1:]} fills {measured:.1%} more under {share * 9.81:.2g} m/s2, as measured, "
                f"where a contact pulls {pull:.2g} of a grain's weight on Earth."
            )
        else:
            said.append(
                f"{kind[0].upper()}{kind[1:]} fills at most {found.max():.1%} more, whatever its contacts pull up to "
                f"{pulls.max() * share:.2g} of a grain's weight on Earth; {measured:.1%} was measured."
            )
    of_packing(rows, FIGURES / "packing_and_cohesion.png")
    table = "| kind | pull over weight | beds | solid fraction | contacts a grain |\n|---|---|---|---|---|"
    for kind in KEULEN:
        for pull in sorted({row["pull"] for row in rows if row["kind"] == kind}):
            own = [row for row in rows if row["kind"] == kind and row["pull"] == pull]
            table += (
                f"\n| {kind} | {pull:g} | {len(own)} | {column(own, 'solid_fraction').mean():.4f} "
                f"| {column(own, 'coordination').mean():.2f} |"
            )
    return lines, table + "\n\n" + "\n".join(textwrap.wrap(" ".join(said), 98))


def balls_part() -> tuple[Lines, str]:
    """Rows and a table of the ball on beads under several gravities."""
    rows = [row for row in read_rows(HERE / "ball_under_gravities.csv") if row["froude"] > 0.0]
    if len({row["share"] for row in rows}) < 2:
        return [], ""
    reach = column(rows, "depth") + column(rows, "touch_height")
    of_speed, of_gravity = powers(reach, column(rows, "froude"), column(rows, "share"))
    by_speed, by_gravity = powers(reach, column(rows, "speed"), column(rows, "share"))
    of_time = powers(column(rows, "duration_in_units"), column(rows, "share"))[0]
    lines = [
        line("ball: exponent of depth over gravity at one Froude number (Sunday)", 0.0, of_gravity, 0.05, "0"),
        line("ball: exponent of duration, in sqrt(D/g), over gravity (Sunday)", 0.0, of_time, 0.05, "0"),
        line("ball: exponent of depth over gravity at one speed (Murdoch)", 0.0, by_gravity, 0.05, "0"),
        line("ball: exponent of depth over speed at one gravity (Murdoch)", 1.0, by_speed, 0.05, "1"),
    ]
    assert math.isfinite(of_speed.value)
    of_balls(rows, FIGURES / "ball_under_gravities.png")
    table = (
        "![balls](experiments/ball_under_gravities.png)\n\n"
        "| gravity over Earth's | Froude number | speed [m/s] | depth below first touch [cm] "
        "| duration [sqrt(D/g)] | peak [g] |\n|---|---|---|---|---|---|"
    )
    for row, deep in zip(rows, reach, strict=True):
        table += (
            f"\n| {row['share']:g} | {row['froude']:g} | {row['speed']:.3g} | {100 * deep:.2f} "
            f"| {row['duration_in_units']:.2f} | {row['peak_deceleration_in_g']:.1f} |"
        )
    return lines, table
