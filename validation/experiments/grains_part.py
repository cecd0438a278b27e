"""What the rows of the grain shot at its own kind say: rows of the page's table, and its section."""

import math

import numpy as np
from draw import of_grains
from fits import Estimate, column, leaving, mean_of, speeds
from result_rows import read_rows
from table_lines import FIGURES, HERE, Lines, line, said, table

STAYED = "own kind: those that leave"


def grains_part() -> tuple[Lines, str]:
    """Return rows of the table, and the section's table."""
    every = read_rows(HERE / "grain_on_its_own_kind.csv")
    kinds = {name: [row for row in every if row["kind"] == name] for name in dict.fromkeys(r["kind"] for r in every)}
    base = kinds["basalt"]
    few = Estimate(float(np.mean(column(base, "risen_0.1") < 10)), math.nan, len(base))
    low = Estimate(float(np.mean(column(base, "median_rise") < 1.0)), math.nan, len(base))
    lines = [
        line("own kind: mean speed out over speed in, 0 where the grain stays", 0.2, mean_of(speeds(base)), 0.05,
             "about 0.20", STAYED),
        line("own kind: the same of those that leave upwards", 0.2, mean_of(leaving(base)), 0.05, "about 0.20"),
        line("own kind: share of impacts with fewer than 10 grains ejected", 1.0, few, 0.5, "typical",
             "own kind: restitution 0.5, rolling resistance"),
        line("own kind: share of impacts whose median grain rises less than its diameter", 1.0, low, 0.5, "typical"),
    ]  # fmt: skip
    of_grains(kinds, FIGURES / "grain_on_its_own_kind.png")
    heads = ("bed", "impacts", "mean speed ratio", "of those that leave", "share that stays", "rise > 0.1",
             "> 0.5", "> 1 grain", "fewer than 10 rise > 0.1", "median rise [grains]")  # fmt: skip
    cells = [
        (name, str(len(rows)), said(mean_of(speeds(rows))), said(mean_of(leaving(rows))),
         f"{1.0 - len(leaving(rows)) / len(rows):.2f}",
         *(f"{column(rows, f'risen_{rise}').mean():.2f}" for rise in ("0.1", "0.5", "1")),
         f"{np.mean(column(rows, 'risen_0.1') < 10):.2f}", f"{np.median(column(rows, 'median_rise')):.2f}")
        for name, rows in kinds.items()
    ]  # fmt: skip
    return lines, table(heads, cells)
