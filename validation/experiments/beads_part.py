"""What the rows of the ball dropped into beads say: rows of the page's table, and its section."""

import itertools
import math
from collections.abc import Callable

from ball_into_beads import BALL, FALL, FINE, HEAVY, LIGHT
from draw import of_drops
from fits import (
    Estimate,
    below_first_touch,
    below_mean_surface,
    density_exponent,
    diameter_exponent,
    drop_exponents,
    mean_of,
    scale,
    stopping,
)
from result_rows import Row, read_rows
from sphere_bed import Floats
from table_lines import FIGURES, HERE, Lines, line, said, table

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


def pair(rows: list[Row], heavy: float) -> tuple[Row, Row]:
    """Return the drops of a light and a heavy ball from one height."""
    by_density = {row["density"]: row for row in one_ball(rows) if row["fall"] == FALL}
    return by_density[LIGHT], by_density[heavy]


def beads_part() -> tuple[Lines, str]:
    """Return rows of the table, and the section's table and verdict."""
    every = read_rows(HERE / "ball_into_beads.csv")
    slope = mean_of([math.tan(math.radians(row["angle_deg"])) for row in read_rows(HERE / "repose.csv")])
    drops, sized = one_ball(of_bed(every, FINE)), of_diameters(of_bed(every, FINE))
    lines = []
    for where, depth_of in SURFACES.items():
        lines += surface_lines(where, depth_of, drops, sized, 0.14 / slope.value)
    lines.append(line("ball into beads: stopping time over depth / impact speed", 3.0, mean_of(stopping(drops)), 0.75,
                      "3"))  # fmt: skip
    of_drops(drops, causes_of(every), slope, FIGURES / "ball_into_beads.png")
    return lines, "\n\n".join((drop_table(every), bed_table(every)))


def surface_lines(
    where: str, depth_of: Callable[[list[Row]], Floats], drops: list[Row], sized: list[Row], law: float
) -> Lines:  # fmt: skip
    """Return the rows of the table for depths below one of the surfaces."""
    density, total = drop_exponents(drops, depth_of(drops))
    prefactor = mean_of(list(depth_of(drops) / scale(drops)))
    name = f"ball into beads, below {where}"
    return [
        line(f"{name}: exponent of the ball's density", 0.5, density, 0.05, "1/2"),
        line(f"{name}: exponent of the total drop distance", 1 / 3, total, 0.05, "1/3"),
        line(f"{name}: prefactor", law, prefactor, 0.25 * law, f"0.14 / {0.14 / law:.2f} = {law:.3f}, unverified"),
        line(f"{name}: exponent of the ball's diameter", 2 / 3, diameter_exponent(sized, depth_of(sized)), 0.05, "2/3",
             "ball into beads: 12.7 to 36 mm"),
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


def causes_of(every: list[Row]) -> dict[str, tuple[Row, Row]]:
    """Return a light and a heavy drop from one height into each bed, by its name."""
    heavy = [row for row in every if (row["density"], row["fall"]) == (HEAVY, FALL)]
    return {name: pair(of_bed(every, name), HEAVY) for name in dict.fromkeys(str(row["bed"]) for row in heavy)}


def bed_table(every: list[Row]) -> str:
    """Return the table of beds: what each changes of the exponents."""
    heads = ("bed", "beads", "filled", "depth of 2200 kg/m3 [cm]", "of 15000 kg/m3",
             "exponent of density, from the mean surface", "from the first touch", "of diameter, from the mean surface",
             "from the first touch", "prefactor of the two", "stopping time of 2200 kg/m3 [d/v]")  # fmt: skip
    rows = []
    for name, (light, heavy) in causes_of(every).items():
        sized = of_diameters(of_bed(every, name))
        rows.append([*bed_cells(name, light), f"{100 * heavy['deepest']:.2f}",
                     *(f"{density_exponent(light, heavy, depth_of):.2f}" for depth_of in SURFACES.values()),
                     *diameter_cells(sized), f"{mean_prefactor([light, heavy]):.2f}",
                     f"{stopping([light])[0]:.1f}"])  # fmt: skip
    return table(heads, rows)


def bed_cells(name: str, light: Row) -> list[str]:
    """Return the first cells of a bed: name, beads, solid fraction and depth of the light ball."""
    return [name, f"{int(light['beads'])}", f"{light['bulk_density'] / 2500.0:.3f}", f"{100 * light['deepest']:.2f}"]


def diameter_cells(sized: list[Row]) -> list[str]:
    """Return the exponent of the diameter from both surfaces, where there are balls of several."""
    if len({row["diameter"] for row in sized}) < 3:
        return ["-", "-"]
    found: list[Estimate] = [diameter_exponent(sized, depth_of(sized)) for depth_of in SURFACES.values()]
    return [said(one) if len(sized) > 3 else f"{one.value:.2f}" for one in found]


def mean_prefactor(rows: list[Row]) -> float:
    """Return the mean prefactor of some drops, from the mean surface."""
    return float((below_mean_surface(rows) / scale(rows)).mean())


def steps_of_diameter(every: list[Row], depth_of: Callable[[list[Row]], Floats]) -> list[float]:
    """Return the exponents of the diameter between one ball and the next larger, in our beads."""
    sized = sorted(of_diameters(of_bed(every, FINE)), key=lambda row: row["diameter"])
    return [diameter_exponent(list(two), depth_of(list(two))).value for two in itertools.pairwise(sized)]
