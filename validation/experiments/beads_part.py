"""What the rows of the ball dropped into beads say: rows of the page's table, and its section."""

import itertools
import math
from collections.abc import Callable, Iterable

from ball_into_beads import BALL, FALL, FINE, FINER, HEAVY, LIGHT, LOOSE, OURS
from draw import of_drops
from fits import (
    NOT_SHOWN,
    SHARE,
    Lines,
    below_first_touch,
    below_mean_surface,
    density_exponent,
    diameter_exponent,
    drop_exponents,
    line,
    mean_of,
    said,
    scale,
    stopping,
)
from page import table
from result_rows import FIGURES, HERE, Row, read_rows
from sphere_bed import Floats

DepthOf = Callable[[list[Row]], Floats]
DENSITY, STEP = 0.5, 0.05  # measured exponent of the density, and the tolerance
# What changes from one bed to the next; beds that have no rows are left out.
STEPS = [
    ("beads of 5 instead of 8 mm", "8 mm, walls, dense", "5 mm, walls, dense"),
    ("beads of 3 instead of 5 mm, dense bed", "5 mm, walls, dense", OURS),
    ("periodic instead of walls", "5 mm, walls, dense", "5 mm, periodic as wide as the box"),
    ("6 instead of 3 ball diameters wide", "5 mm, periodic as wide as the box", "5 mm, periodic, 6 ball diameters"),
    ("loose instead of dense", "5 mm, periodic", "5 mm, periodic, loose"),
    ("110 instead of 85 mm deep", "5 mm, periodic, loose", LOOSE),
    ("beads of 3 instead of 5 mm, loose bed", LOOSE, FINE),
    ("friction 0.6 instead of 0.3", LOOSE, "5 mm, as the one before, friction 0.6"),
]
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
    where: str, depth_of: DepthOf, every: list[Row], law: float
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
    heads = ("density [kg/m3]", "diameter [mm]", "fall [m]", "depth below the mean surface [cm]",
             "below the first touch [cm]", "stopping time [d/v]")  # fmt: skip
    rows = sorted(of_bed(every, FINE), key=lambda row: (row["diameter"], row["density"], row["fall"]))
    return table(heads, (
        (f"{row['density']:g}", f"{1e3 * row['diameter']:g}", f"{row['fall']:g}", f"{100 * row['deepest']:.2f}",
         f"{100 * (row['deepest'] + row['touch_height']):.2f}", f"{stopping([row])[0]:.1f}") for row in rows
    ))  # fmt: skip


def steps_of_diameter(every: list[Row], depth_of: DepthOf) -> list[float]:
    """Return the exponents of the diameter between one ball and the next larger, in our beads."""
    sized = sorted(of_diameters(of_bed(every, FINE)), key=lambda row: row["diameter"])
    return [diameter_exponent(list(two), depth_of(list(two))).value for two in itertools.pairwise(sized)]


def cause_of_diameter(every: list[Row], depth_of: DepthOf) -> str:
    """Return that larger balls show the cause, where the exponent comes nearer to 2/3 from each ball to the next."""
    away = [abs(one - 2 / 3) for one in steps_of_diameter(every, depth_of)]
    nearer = all(after < before for before, after in itertools.pairwise(away))
    return "more beads across the ball" if nearer else NOT_SHOWN


def pairs(every: list[Row]) -> dict[str, tuple[Row, Row]]:
    """Return a light and a heavy drop of one ball from one height into each bed that has both, by its name."""
    found: dict[str, dict[float, Row]] = {}
    for row in every:
        if (row["diameter"], row["fall"]) == (BALL, FALL):
            found.setdefault(str(row["bed"]), {})[row["density"]] = row
    return {name: (own[LIGHT], own[HEAVY]) for name, own in found.items() if {LIGHT, HEAVY} <= own.keys()}


def steps(beds: Iterable[str]) -> list[tuple[str, str, str]]:
    """Return what changes, the bed before and the bed after, of the steps whose beds are there."""
    beds = list(beds)
    finer = [("beads of 2 instead of 3 mm, loose bed", FINE, FINER)]
    others = [
        (name.removeprefix(f"{before}, ") + ("" if before == LOOSE else ", 3 mm"), before, name)
        for before in (LOOSE, FINE) for name in beds if name.startswith(f"{before}, ")
    ]  # fmt: skip
    return [step for step in [*STEPS, *others, *finer] if step[1] in beds and step[2] in beds]


def is_pour(bed: str) -> bool:
    """Whether a bed is but another pour, which is no cause."""
    return bed.endswith(" pour")


def pours(beds: Iterable[str], bed: str) -> list[str]:
    """Return the names of a bed and of its other pours."""
    return [name for name in beds if name == bed or (name.startswith(f"{bed}, ") and is_pour(name))]


def agrees(drops: tuple[Row, Row], depth_of: DepthOf) -> bool:
    """Whether two drops have the measured exponent of density."""
    return abs(density_exponent(*drops, depth_of) - DENSITY) <= STEP


def cause_of_density(every: list[Row], depth_of: DepthOf) -> str:
    """Return the changes of the bed compared, or of its coarser twin, that bring the exponent within the tolerance."""
    beds = pairs(every)
    shown = [
        words for words, before, after in steps(beds)
        if before in (LOOSE, FINE) and not agrees(beds[before], depth_of) and agrees(beds[after], depth_of)
        and not is_pour(after)
    ]  # fmt: skip
    return "; ".join(shown) or NOT_SHOWN


def cause_of_prefactor(every: list[Row], law: float, depth_of: DepthOf) -> str:
    """Return the changes of the bed compared that bring the mean prefactor of its two drops within the tolerance."""
    beds = pairs(every)
    away = {name: abs(mean_prefactor(two, depth_of) - law) / law for name, two in beds.items()}
    shown = [
        words for words, before, after in steps(beds)
        if before == FINE and away[before] > SHARE >= away[after] and not is_pour(after)
    ]  # fmt: skip
    return "; ".join(shown) or NOT_SHOWN


def step_table(every: list[Row]) -> str:
    beds = pairs(every)
    heads = ("change", "exponent, mean surface: before", "after", "exponent, first touch: before", "after")
    return table(heads, (
        (words, *(f"{density_exponent(*beds[name], depth_of):.2f}"
                  for depth_of in (below_mean_surface, below_first_touch) for name in (before, after)))
        for words, before, after in steps(beds)
    ))  # fmt: skip


def bed_table(every: list[Row]) -> str:
    """Return the table of beds: beads, packing, depths of the light and the heavy ball, and their mean prefactor."""
    heads = ("bed", "beads", "solid fraction", "depth of 2200 kg/m3 [cm]", "depth of 15000 kg/m3 [cm]",
             "prefactor of the two", "stopping time of 2200 kg/m3 [d/v]")  # fmt: skip
    return table(heads, (
        (name, f"{int(light['beads'])}", f"{light['bulk_density'] / 2500.0:.3f}", f"{100 * light['deepest']:.2f}",
         f"{100 * heavy['deepest']:.2f}", f"{mean_prefactor((light, heavy)):.2f}", f"{stopping([light])[0]:.1f}")
        for name, (light, heavy) in pairs(every).items()
    ))  # fmt: skip


def diameter_table(every: list[Row]) -> str:
    """Return the table of the exponents of diameter, in the beds with balls of three diameters or more."""
    heads = ("bed", "balls", "exponent of diameter, mean surface +- 95 %", "exponent of diameter, first touch +- 95 %")
    cells = []
    for name in dict.fromkeys(str(row["bed"]) for row in every):
        own = [row for row in every if (row["bed"], row["density"], row["fall"]) == (name, LIGHT, FALL)]
        if len(own) >= 3:
            found = (said(diameter_exponent(own, of(own))) for of in (below_mean_surface, below_first_touch))
            cells.append((name, str(len(own)), *found))
    return table(heads, cells)


def mean_prefactor(drops: tuple[Row, Row], depth_of: DepthOf = below_mean_surface) -> float:
    """Return the mean prefactor of two drops, by default from the mean surface."""
    return float((depth_of(list(drops)) / scale(list(drops))).mean())
