"""Write docs/validation/low_speed.md, its figure and its quantities from the tables of the low-speed cases.

python validation/low_speed/write_page.py
"""

import math
import sys
from pathlib import Path

import numpy as np
from answers import CASES, Answer, answers_of, rows_of, those
from fits import column
from matplotlib.axes import Axes
from philae_into_ice import DENT
from result_rows import HERE as EXPERIMENTS

from lithobrake.report.figures.style import INPUT_COLOURS, QUIET

sys.path.append(str(EXPERIMENTS.parents[1] / "benchmarks"))
from drawing import figure
from harness import PAGES, read_document
from page import made, table, write_page, yes
from quantities import CODE, EXPERIMENT, FLIGHT, NOT_SHOWN, Quantity, counts, keep_quantities

HERE = Path(__file__).parent
HEADS = ("quantity", "source", "here", "tolerance", "agrees", "cause shown by")
SUMMARY = ("case", "quantities", "agree", "disagree, cause shown", "disagree, cause not shown")
# Cases by their keys: name in the summary, the table of simulations behind them, and where the numbers are from.
SECTIONS = {
    "mascot": ("MASCOT on beds", "lander_on_beds", CODE), "shell": ("shell with grains", "filled_shell", EXPERIMENT),
    "philae": ("Philae into ice", "philae_into_ice", FLIGHT),
}  # fmt: skip


def number(value: float) -> str:
    """A number to three digits."""
    return "none" if math.isinf(value) else f"{value:.3g}"


def cells(one: Answer) -> tuple[str, ...]:
    here = number(one.found.value)
    if not math.isnan(one.found.error):
        here += f" +- {number(one.found.error)}"
    return one.claim.quantity, one.claim.measured, here, one.claim.tolerance, yes(one.agrees), one.cause


def quantity_of(case: str, one: Answer) -> Quantity:
    """An answer as a quantity of the table of all pages."""
    _, made_by, kind = SECTIONS[case]
    _, measured, here, tolerance, _, cause = cells(one)
    return Quantity(kind, one.claim.quantity, measured, here, "", tolerance, one.agrees, made_by, cause or NOT_SHOWN)


def settings_of(name: str, value: str) -> list[tuple[str, str, str, str, str]]:
    """Return of each setting its rows, and mean, standard deviation and range of a column."""
    rows, found = rows_of(name), []
    for setting in dict.fromkeys(row["setting"] for row in rows):
        own = column(those(rows, setting=setting), value)
        found.append((setting, str(len(own)), f"{own.mean():.3f}", f"{own.std(ddof=1):.3f}",
                      f"{own.min():.3f} to {own.max():.3f}"))  # fmt: skip
    return found


def ice_table() -> str:
    heads = ("ice", "cohesion [Pa]", "filled", "deepest [m]", "after [s]", "0.25 m deep after [s]")
    return table(heads, (
        (row["name"], f"{row['cohesion']:g}", f"{row['filled']:g}", f"{row['deepest']:.3f}",
         f"{row['time_of_deepest']:.2f}", "-" if math.isnan(row["time_of_dent"]) else f"{row['time_of_dent']:.2f}")
        for row in rows_of("philae_into_ice")
    ))  # fmt: skip


def of_settings(axis: Axes, name: str, value: str, names: list[str]) -> None:
    """Each run as a dot, and the mean of each setting as a bar."""
    rows = rows_of(name)
    for k, setting in enumerate(names):
        own = column(those(rows, setting=setting), value)
        axis.plot(own, np.full(len(own), k), "o", color=INPUT_COLOURS[0], ms=3, alpha=0.6)
        axis.plot([own.mean()] * 2, [k - 0.3, k + 0.3], color=INPUT_COLOURS[1], lw=2)
    axis.set_yticks(range(len(names)), names)
    axis.invert_yaxis()


def draw() -> None:
    """The three cases, each in a panel."""
    with figure(PAGES / "low_speed.png", 1, 3, (11.0, 3.9), dpi=150) as (_, (mascot, shell, philae)):
        names = list(dict.fromkeys(row["setting"] for row in rows_of("lander_on_beds")))
        of_settings(mascot, "lander_on_beds", "ratio", names)
        mascot.set(xlabel="speed ratio", title="MASCOT on beds")
        names = list(dict.fromkeys(row["setting"] for row in rows_of("filled_shell")))
        of_settings(shell, "filled_shell", "energy_lost", names)
        shell.axvline(0.9, color=QUIET, ls="--", lw=1)
        shell.set(xlabel="energy lost in the first bounce", title="Shell with grains")
        ran = sorted((row for row in rows_of("philae_into_ice") if row["name"].endswith("Pa")),
                     key=lambda row: row["cohesion"])  # fmt: skip
        philae.plot(column(ran, "cohesion"), column(ran, "deepest"), "o-", color=INPUT_COLOURS[0])
        philae.axhline(DENT, color=QUIET, ls="--", lw=1)
        philae.set_xscale("symlog", linthresh=10.0)
        philae.set(xlabel="cohesion of the ice [Pa]", ylabel="dent [m]", title="Philae into ice", xlim=(-1.0, 2000.0))


def main() -> None:
    answers = {case: answers_of(case) for case in CASES}
    quantities = {case: [quantity_of(case, one) for one in own] for case, own in answers.items()}
    keep_quantities("low_speed", {SECTIONS[case][0]: own for case, own in quantities.items()})
    every = [one for own in quantities.values() for one in own]
    count, agree, shown, open_ones = counts(every)
    summary = [(SECTIONS[case][0], *map(str, counts(own))) for case, own in quantities.items()]
    summary.append(("**all**", *map(str, counts(every))))
    kept = {case: read_document(HERE / f"{name}.json") for case, (_, name, _) in SECTIONS.items()}
    heads = ("setting", "runs", "mean", "standard deviation", "range")
    write_page(
        "low_speed", count=count, agreeing=agree, shown=shown, open=open_ones, summary=table(SUMMARY, summary),
        **{f"lines_{case}": table(HEADS, map(cells, own)) for case, own in answers.items()},
        **{f"from_{case}": made(one, f"{one['cpu_s_of_rows']:.0f} s of CPU time") for case, one in kept.items()},
        ratios=table(heads, settings_of("lander_on_beds", "ratio")),
        losses=table(heads, settings_of("filled_shell", "energy_lost")), ice=ice_table(),
    )  # fmt: skip
    draw()
    print(f"{agree} of {count} agree, {shown} with a cause")


if __name__ == "__main__":
    main()
