"""What the tables of the experiments in low gravity say: rows of the page's table, and tables of their own."""

import math
import textwrap

import numpy as np
from ball_under_gravities import KINDS
from draw_low_gravity import of_balls, of_packing
from fits import Estimate, column, powers
from result_rows import Row, read_rows
from table_lines import FIGURES, HERE, NOT_SHOWN, Lines, line, table

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
    """Rows and a table of the ball on beads under several gravities."""
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
