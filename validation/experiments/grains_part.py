"""What the rows of the sphere that settles and of the grain shot at its own kind say: rows of the page's table."""

import math

import numpy as np
from draw import of_grains, of_gravities
from fits import Estimate, Lines, column, gravity_exponents, leaving, line, mean_of, said, speeds
from page import table
from result_rows import FIGURES, HERE, read_rows
from settling_in_other_gravities import DIAMETER, EARTH, GRAINS

BAR = 0.03  # of the exponents of the sphere that settles
STAYED = "grains that leave the bed"


def grains_part() -> tuple[Lines, str]:
    every = read_rows(HERE / "grain_on_its_own_kind.csv")
    kinds = {name: [row for row in every if row["kind"] == name] for name in dict.fromkeys(r["kind"] for r in every)}
    base = kinds["basalt"]
    few = Estimate(float(np.mean(column(base, "risen_0.1") < 10)), math.nan, len(base))
    low = Estimate(float(np.mean(column(base, "median_rise") < 1.0)), math.nan, len(base))
    lines = [
        line("rebound speed / impact speed, mean of all grains, 0 for those that stay", 0.2, mean_of(speeds(base)),
             0.05, "about 0.20", STAYED),
        line("rebound speed / impact speed, mean of the grains that leave the bed", 0.2, mean_of(leaving(base)), 0.05,
             "about 0.20"),
        line("fraction of impacts that eject fewer than 10 grains", 1.0, few, 0.5, "typical",
             "restitution 0.5; rolling resistance"),
        line("fraction of impacts whose ejected grains rise, in the median, by less than a diameter", 1.0, low,
             0.5, "typical"),
    ]  # fmt: skip
    of_grains(kinds, FIGURES / "grain_on_its_own_kind.png")
    heads = ("bed", "impacts", "mean speed ratio, all +- 95 %", "mean speed ratio, leaving +- 95 %",
             "fraction that stays", "grains that rise by > 0.1 d", "> 0.5 d", "> 1 d",
             "impacts with fewer than 10 above 0.1 d", "median rise [d]")  # fmt: skip
    cells = [
        (name, str(len(rows)), said(mean_of(speeds(rows))), said(mean_of(leaving(rows))),
         f"{1.0 - len(leaving(rows)) / len(rows):.2f}",
         *(f"{column(rows, f'risen_{rise}').mean():.2f}" for rise in ("0.1", "0.5", "1")),
         f"{np.mean(column(rows, 'risen_0.1') < 10):.2f}", f"{np.median(column(rows, 'median_rise')):.2f}")
        for name, rows in kinds.items()
    ]  # fmt: skip
    return lines, table(heads, cells)


def settling_part() -> tuple[Lines, str]:
    every = read_rows(HERE / "settling_in_other_gravities.csv")
    rows = [row for row in every if row["young_modulus"] == GRAINS.young_modulus]
    found = gravity_exponents(rows)
    lines = [
        line("exponent of depth over gravity", 0.0, found["depth"], BAR, "0"),
        line("exponent of the time until it stops, over gravity", -0.5, found["stopping_time"], BAR, "-1/2"),
        line("exponent of the time to 90 % of the depth, over gravity", -0.5, found["time_to_90"], BAR, "-1/2"),
    ]
    of_gravities(rows, DIAMETER, FIGURES / "settling_in_other_gravities.png")
    heads = ("Young's modulus [Pa]", "gravity / Earth's", "simulations", "depth / diameter, mean +- standard deviation",
             "time until it stops [sqrt(D/g)], mean +- standard deviation", "time to 90 % of the depth [sqrt(D/g)]",
             "solid fraction")  # fmt: skip
    cells = []
    for modulus, share in sorted({(row["young_modulus"], row["share"]) for row in every}, reverse=True):
        own = [row for row in every if (row["young_modulus"], row["share"]) == (modulus, share)]
        unit = math.sqrt(DIAMETER / (EARTH * share))
        depth, stop, most = (column(own, name) for name in ("depth", "stopping_time", "time_to_90"))
        cells.append((
            f"{modulus:.0e}".replace("e+0", "e"), f"{share:g}", str(len(own)),
            f"{depth.mean() / DIAMETER:.3f} +- {depth.std() / DIAMETER:.3f}",
            f"{stop.mean() / unit:.3f} +- {stop.std() / unit:.3f}", f"{most.mean() / unit:.3f}",
            f"{column(own, 'bulk_density').mean() / 1000.0:.4f}",
        ))  # fmt: skip
    return lines, table(heads, cells)
