"""What the rows of the grain shot at its own kind say: rows of the page's table, and its section."""

import math

import numpy as np
from draw import of_grains
from fits import Estimate, column, leaving, mean_of, speeds
from result_rows import read_rows
from table_lines import FIGURES, HERE, Lines, line, said, table

STAYED = "grains that leave the bed"


def grains_part() -> tuple[Lines, str]:
    """Return rows of the table, and the section's table."""
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
