"""What the rows of the ball dropped into beads say: rows of the page's table, and its section."""

import itertools
import math
from collections.abc import Callable

from ball_into_beads import BALL, FALL, FINE, LIGHT
from bed_steps import cause_of_density, cause_of_prefactor, pairs
from draw import of_drops
from fits import (
    below_first_touch,
    below_mean_surface,
    diameter_exponent,
    drop_exponents,
    mean_of,
    scale,
    stopping,
)
from result_rows import Row, read_rows
from sphere_bed import Floats
from table_lines import FIGURES, HERE, NOT_SHOWN, SHARE, Lines, line, table

SURFACES = {"the mean surface": below_mean_surface, "the first touch": below_first_touch}


def of_bed(rows: list[Row], bed: str) -> list[Row]:
    """Return the drops into a bed."""
    return [row for row in rows if row["bed"] == bed]


def one_ball(rows: list[Row]) -> list[Row]:
    """Return the drops of the ball of the experiment's twelve."""
    return [row for row in rows if row["diameter"] == BALL]


def of_diameters(rows: list[Row]) -> list[Row]:
    """Return the drops of balls of several diameters at one density and fall."""
    return [row for row in rows if (row["density"], row["fall"]) == (LIGHT, FALL)]


def beads_part() -> tuple[Lines, str]:
    """Return rows of the table, and the section's table and verdict."""
    every = read_rows(HERE / "ball_into_beads.csv")
    slope = mean_of([math.tan(math.radians(row["angle_deg"])) for row in read_rows(HERE / "repose.csv")])
    drops = one_ball(of_bed(every, FINE))
    lines = []
    for where, depth_of in SURFACES.items():
        lines += surface_lines(where, depth_of, every, 0.14 / slope.value)
    lines.append(line("stopping time in d/v, mean of all drops", 3.0, mean_of(stopping(drops)), 0.75, "3"))
    of_drops(drops, pairs(every), slope, FIGURES / "ball_into_beads.png")
    return lines, drop_table(every)


def surface_lines(
    where: str, depth_of: Callable[[list[Row]], Floats], every: list[Row], law: float
) -> Lines:  # fmt: skip
    """Return the rows of the table for depths below one of the surfaces."""
    drops, sized = one_ball(of_bed(every, FINE)), of_diameters(of_bed(every, FINE))
    density, total = drop_exponents(drops, depth_of(drops))
    prefactor = mean_of(list(depth_of(drops) / scale(drops)))
    return [
        line(f"exponent of density, depth below {where}", 0.5, density, 0.05, "1/2", cause_of_density(every, depth_of)),
        line(f"exponent of the total drop distance, depth below {where}", 1 / 3, total, 0.05, "1/3"),
        line(f"prefactor, depth below {where}", law, prefactor, SHARE * law,
             f"0.14 / {0.14 / law:.2f} = {law:.3f}, unverified", cause_of_prefactor(every, law, depth_of)),
        line(f"exponent of diameter, depth below {where}", 2 / 3, diameter_exponent(sized, depth_of(sized)), 0.05,
             "2/3", cause_of_diameter(every, depth_of)),
    ]  # fmt: skip


def drop_table(every: list[Row]) -> str:
    """Return the table of the drops into our beads."""
    heads = ("density [kg/m3]", "diameter [mm]", "fall [m]", "depth below the mean surface [cm]",
             "below the first touch [cm]", "stopping time [d/v]")  # fmt: skip
    rows = sorted(of_bed(every, FINE), key=lambda row: (row["diameter"], row["density"], row["fall"]))
    return table(heads, (
        (f"{row['density']:g}", f"{1e3 * row['diameter']:g}", f"{row['fall']:g}", f"{100 * row['deepest']:.2f}",
         f"{100 * (row['deepest'] + row['touch_height']):.2f}", f"{stopping([row])[0]:.1f}") for row in rows
    ))  # fmt: skip


def steps_of_diameter(every: list[Row], depth_of: Callable[[list[Row]], Floats]) -> list[float]:
    """Return the exponents of the diameter between one ball and the next larger, in our beads."""
    sized = sorted(of_diameters(of_bed(every, FINE)), key=lambda row: row["diameter"])
    return [diameter_exponent(list(two), depth_of(list(two))).value for two in itertools.pairwise(sized)]


def cause_of_diameter(every: list[Row], depth_of: Callable[[list[Row]], Floats]) -> str:
    """Return that larger balls show the cause, where the exponent comes nearer to 2/3 from each ball to the next."""
    away = [abs(one - 2 / 3) for one in steps_of_diameter(every, depth_of)]
    nearer = all(after < before for before, after in itertools.pairwise(away))
    return "more beads across the ball" if nearer else NOT_SHOWN
