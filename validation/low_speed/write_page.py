"""Write docs/validation/low_speed.md, its figure and quantities.csv from the tables of the low-speed cases.

python validation/low_speed/write_page.py
"""

import math
import sys
from pathlib import Path

import numpy as np
from answers import CASES, Answer, answers_of, heap_slope_deg, rows_of, those
from fits import NOT_SHOWN, column
from matplotlib.axes import Axes
from philae_into_ice import DENT
from plate_sinkage import SHOWN
from rebounds_part import rebounds
from result_rows import HERE as EXPERIMENTS
from result_rows import Row

from lithobrake.report.figures.style import INPUT_COLOURS, QUIET

sys.path.append(str(EXPERIMENTS.parents[1] / "benchmarks"))
from drawing import figure
from harness import PAGES, read_document, write_rows
from page import made, table, write_page, yes

HERE = Path(__file__).parent
COLUMNS = ("case", "quantity", "measured", "here", "error", "tolerance", "agrees", "cause")
HEADS = ("quantity", "source", "here", "tolerance", "agrees", "cause shown by")
SUMMARY = ("case", "quantities", "agree", "disagree, cause shown", "disagree, cause not shown")
# Cases by their keys: name in the summary, and the table of simulations behind them.
SECTIONS = {
    "mascot": ("MASCOT on beds", "lander_on_beds"), "gravities": ("one soil, four gravities", "same_soil_gravities"),
    "shell": ("shell with grains", "filled_shell"), "philae": ("Philae into ice", "philae_into_ice"),
    "plate": ("plate pressed into grains", "plate_sinkage"),
}  # fmt: skip
KINDS = {"dry": "without cohesion", "cohesive": "with", "poured cohesive": "poured and pressed with"}


def number(value: float) -> str:
    """A number to three digits."""
    return "none" if math.isinf(value) else f"{value:.3g}"


def cells(one: Answer) -> tuple[str, ...]:
    here = number(one.found.value)
    if not math.isnan(one.found.error):
        here += f" +- {number(one.found.error)}"
    return one.claim.quantity, one.claim.measured, here, one.claim.tolerance, yes(one.agrees), one.cause


def counts(answers: list[Answer]) -> tuple[int, int, int, int]:
    agree, open_ones = sum(one.agrees for one in answers), sum(one.cause == NOT_SHOWN for one in answers)
    return len(answers), agree, len(answers) - agree - open_ones, open_ones


def note_quantities(answers: dict[str, list[Answer]]) -> None:
    """Write the quantities with numbers as they are, for tables over several pages."""
    write_rows(HERE / "quantities.csv", COLUMNS, (
        {
            "case": SECTIONS[case][0], "quantity": one.claim.quantity, "measured": one.claim.measured,
            "here": f"{one.found.value:.5g}",
            "error": "" if math.isnan(one.found.error) else f"{one.found.error:.3g}",
            "tolerance": one.claim.tolerance, "agrees": yes(one.agrees), "cause": one.cause,
        } for case, own in answers.items() for one in own
    ))  # fmt: skip


def settings_of(name: str, value: str) -> list[tuple[str, str, str, str, str]]:
    """Return of each setting its rows, and mean, standard deviation and range of a column."""
    rows, found = rows_of(name), []
    for setting in dict.fromkeys(row["setting"] for row in rows):
        own = column(those(rows, setting=setting), value)
        found.append((setting, str(len(own)), f"{own.mean():.3f}", f"{own.std(ddof=1):.3f}",
                      f"{own.min():.3f} to {own.max():.3f}"))  # fmt: skip
    return found


def gravity_cells() -> str:
    heads = ("gravity", "speed [cm/s]", "drops", "rebound", "with ejecta", "speed out / in", "depth [mm]",
             "ejecta speed / impact speed")  # fmt: skip
    rows, found = rows_of("same_soil_gravities"), []
    for share, speed in sorted({(row["share"], row["speed"]) for row in rows}, reverse=True):
        own = those(rows, share=share, speed=speed)
        thrown = [row["ejecta_speed"] for row in own if row["ejecta"] > 0]
        found.append((
            f"{share:g} g", f"{100 * speed:g}", str(len(own)), str(rebounds(own)), str(len(thrown)),
            f"{column(own, 'upward_out').mean():.3f}", f"{1e3 * column(own, 'depth').mean():.1f}",
            f"{np.mean(thrown):.3f}" if thrown else "-",
        ))  # fmt: skip
    return table(heads, found)


def ice_table() -> str:
    heads = ("ice", "cohesion [Pa]", "filled", "deepest [m]", "after [s]", "0.25 m deep after [s]")
    return table(heads, (
        (row["name"], f"{row['cohesion']:g}", f"{row['filled']:g}", f"{row['deepest']:.3f}",
         f"{row['time_of_deepest']:.2f}", "-" if math.isnan(row["time_of_dent"]) else f"{row['time_of_dent']:.2f}")
        for row in rows_of("philae_into_ice")
    ))  # fmt: skip


def plate_table() -> str:
    heads = ("bed", "solid fraction", *(f"{1e3 * one:g} mm [kPa]" for one in SHOWN), "exponent")
    return table(heads, (
        (row["name"], f"{row['solid_fraction']:.3f}",
         *(f"{1e-3 * row[f'pressure_{1e3 * one:g}mm']:.1f}" for one in SHOWN), f"{row['exponent']:.2f}")
        for row in rows_of("plate_sinkage") if not row["name"].startswith("heap")
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


def of_gravities(axis: Axes, rows: list[Row]) -> None:
    for k, speed in enumerate(sorted({row["speed"] for row in rows})):
        shares = sorted({row["share"] for row in rows})
        own = [those(rows, share=share, speed=speed) for share in shares]
        part = [rebounds(one) / len(one) for one in own]
        axis.plot(np.array(shares) * 1.12 ** (k - 1), part, "osD"[k] + "-", color=INPUT_COLOURS[k], ms=4,
                  label=f"{100 * speed:g} cm/s")  # fmt: skip
    axis.set(xscale="log", xlabel="gravity [g]", ylabel="fraction that rebounds", ylim=(-0.05, 1.05))
    axis.legend(fontsize=8)


def draw() -> None:
    """The five cases, each in a panel."""
    with figure(PAGES / "low_speed.png", 2, 3, (11.0, 7.4), dpi=150) as (_, axes):
        mascot, gravities, shell, philae, plate, empty = axes.flat
        names = list(dict.fromkeys(row["setting"] for row in rows_of("lander_on_beds")))
        of_settings(mascot, "lander_on_beds", "ratio", names)
        mascot.set(xlabel="speed ratio", title="MASCOT on beds")
        of_gravities(gravities, rows_of("same_soil_gravities"))
        gravities.set_title("Ball on one soil")
        names = list(dict.fromkeys(row["setting"] for row in rows_of("filled_shell")))
        of_settings(shell, "filled_shell", "energy_lost", names)
        shell.axvline(0.9, color=QUIET, ls="--", lw=1)
        shell.set(xlabel="energy lost in the first bounce", title="Shell with grains")
        ran = sorted((row for row in rows_of("philae_into_ice") if row["name"].endswith("Pa")),
                     key=lambda row: row["cohesion"])  # fmt: skip
        philae.plot(column(ran, "cohesion"), column(ran, "deepest"), "o-", color=INPUT_COLOURS[0])
        philae.axhline(DENT, color=QUIET, ls="--", lw=1)
        philae.set_xscale("symlog", linthresh=1.0)
        philae.set(xlabel="cohesion of the ice [Pa]", ylabel="dent [m]", title="Philae into ice", xlim=(-0.1, 200.0))
        for ink, (kind, words) in zip(INPUT_COLOURS, KINDS.items(), strict=False):
            own = [row for row in rows_of("plate_sinkage") if row["name"].split(",")[0] == kind]
            for row in own:
                plate.plot(1e3 * np.array(SHOWN), [1e-3 * row[f"pressure_{1e3 * one:g}mm"] for one in SHOWN], "o-",
                           color=ink, ms=4, label=words if row is own[0] else None)  # fmt: skip
        plate.set(xlabel="sinkage [mm]", ylabel="pressure [kPa]", title="Plate pressed into grains", ylim=(0.0, None))
        plate.legend(fontsize=8, title="cohesion", title_fontsize=8)
        empty.set_axis_off()


def main() -> None:
    answers = {case: answers_of(case) for case in CASES}
    note_quantities(answers)
    every = [one for own in answers.values() for one in own]
    count, agree, shown, open_ones = counts(every)
    summary = [(SECTIONS[case][0], *map(str, counts(own))) for case, own in answers.items()]
    summary.append(("**all**", *map(str, counts(every))))
    kept = {case: read_document(HERE / f"{name}.json") for case, (_, name) in SECTIONS.items()}
    heads = ("setting", "runs", "mean", "standard deviation", "range")
    write_page(
        "low_speed", count=count, agreeing=agree, shown=shown, open=open_ones, summary=table(SUMMARY, summary),
        **{f"lines_{case}": table(HEADS, map(cells, own)) for case, own in answers.items()},
        **{f"from_{case}": made(one, f"{one['cpu_s_of_rows']:.0f} s of CPU time") for case, one in kept.items()},
        ratios=table(heads, settings_of("lander_on_beds", "ratio")), gravity_cells=gravity_cells(),
        losses=table(heads, settings_of("filled_shell", "energy_lost")), ice=ice_table(), plates=plate_table(),
        slope=f"{heap_slope_deg():.1f}",
    )  # fmt: skip
    draw()
    print(f"{agree} of {count} agree, {shown} with a cause")


if __name__ == "__main__":
    main()
