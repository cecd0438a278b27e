"""Write docs/validation/low_speed.md, its figure and its quantities from the tables of the low-speed cases.

python validation/low_speed/write_page.py
"""

import math
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from answers import (
    CASES,
    Answer,
    answers_of,
    bears,
    borne_by_closed_form,
    ejects,
    lands,
    rebounds,
    rolls,
    rows_of,
    those,
)
from fits import column
from footpad_on_ice import HELD_SLIP, HELD_SPEED, LOOSE, RESTITUTION
from matplotlib.axes import Axes
from philae_into_ice import DENT
from plate_sinkage import SHOWN, loosened
from result_rows import HERE as EXPERIMENTS
from result_rows import Row

from lithobrake.report.figures.style import INPUT_COLOURS, QUIET

sys.path.append(str(EXPERIMENTS.parents[1] / "benchmarks"))
from drawing import figure
from harness import PAGES, read_document
from page import made, table, write_page, yes
from quantities import CODE, EXPERIMENT, FLIGHT, NOT_SHOWN, Quantity, counts, keep_quantities

HERE = Path(__file__).parent
HEADS = ("quantity", "source", "here", "tolerance", "agrees", "cause shown by")
HEADINGS = {"kind": "grains and gravity", "name": "grains", "speed": "speed [m/s]"}
SUMMARY = ("case", "quantities", "agree", "disagree, cause shown", "disagree, cause not shown")
# Cases by their keys: name in the summary, the table of simulations behind them, and where the numbers are from.
SECTIONS = {
    "mascot": ("MASCOT on beds", "lander_on_beds", CODE),
    "gravities": ("one soil under several gravities", "same_soil_gravities", EXPERIMENT),
    "coarse": ("ball on coarse grains", "ball_on_coarse_grains", EXPERIMENT),
    "shell": ("shell with grains", "filled_shell", EXPERIMENT),
    "philae": ("Philae into ice", "philae_into_ice", FLIGHT), "footpad": ("footpad on ice", "footpad_on_ice", CODE),
    "plate": ("plate pressed into grains", "plate_sinkage", CODE),
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


def of_counts(rows: list[Row], true: Callable[[Row], bool]) -> str:
    return f"{sum(true(row) for row in rows)} of {len(rows)}"


def ball_table(name: str, *keys: str) -> str:
    """Return of the balls of each cell, named by some columns, how many rebound, roll and throw up grains."""
    rows, found = rows_of(name), []
    rows.sort(key=lambda row: (-row.get("share", 0.0), row[keys[0]], row["speed"]))
    for cell in dict.fromkeys(tuple(row[key] for key in keys) for row in rows):
        own = those(rows, **dict(zip(keys, cell, strict=True)))
        out = [row["ejecta_speed"] for row in own if ejects(row)]
        along = [f"{1e3 * column(own, 'way_along').mean():.1f}", of_counts(own, rolls)] if "way_along" in own[0] else []
        found.append((
            *(f"{one:g}" if isinstance(one, float) else one for one in cell), of_counts(own, rebounds),
            f"{column(own, 'upward_out').mean():.3f}", f"{1e3 * column(own, 'depth').mean():.1f}", *along,
            of_counts(own, ejects), f"{np.mean(out):.3f}" if out else "-",
        ))  # fmt: skip
    more = ("way along the surface [mm]", "roll") if "way_along" in rows[0] else ()
    heads = (*(HEADINGS[key] for key in keys), "rebound", "speed ratio, upwards", "depth [mm]", *more,
             "throw up grains", "their speed / impact speed")  # fmt: skip
    return table(heads, found)


def footpad_table() -> str:
    heads = ("slope [deg]", "sintering", "filled", "restitution", "pad", "borne", "lands", "depth [cm]",
             "way along the slope [cm]", "rebound speed [m/s]", "speed at the end [m/s]")  # fmt: skip
    return table(heads, (
        (f"{row['slope_deg']:g}", row["sintering"], f"{row['filled']:g}", f"{row['restitution']:g}", row["pad"],
         yes(bears(row)), yes(lands(row)), f"{1e2 * row['deepest']:.1f}", f"{1e2 * row['slip']:.1f}",
         f"{row['rebound_speed']:.2f}", f"{row['last_speed']:.2f}") for row in rows_of("footpad_on_ice")
    ))  # fmt: skip


def plate_table() -> str:
    heads = ("bed", "grains", "solid fraction", *(f"pressure at {1e3 * one:g} mm [kPa]" for one in SHOWN), "exponent",
             "slope of the heap [deg]")  # fmt: skip

    def told(value: float, form: str) -> str:
        return "-" if math.isnan(value) else format(value, form)

    return table(heads, (
        (row["name"], f"{row['grains']:.0f}", told(row["solid_fraction"], ".3f"),
         *(told(1e-3 * row[f"pressure_{1e3 * one:g}mm"], ".1f") for one in SHOWN), told(row["exponent"], ".2f"),
         told(row["slope_deg"], ".1f")) for row in rows_of("plate_sinkage")
    ))  # fmt: skip


def words() -> dict[str, str]:
    """Return the numbers of the sentences, by name."""
    soil = rows_of("same_soil_gravities")
    shares = sorted({row["share"] for row in soil}, reverse=True)
    slow, fast = min(row["speed"] for row in soil), max(row["speed"] for row in soil)
    balls = rows_of("ball_on_coarse_grains")
    pads = rows_of("footpad_on_ice")
    pulled = [row for row in pads if row["sintering"] != "none" and row["restitution"] == RESTITUTION]
    dry = those(rows_of("plate_sinkage"), name="dry")[0][f"pressure_{1e3 * SHOWN[-1]:g}mm"]
    return {
        "local_shear": f"{dry / borne_by_closed_form(loosened):.2f}",
        "slow_rebounds": ", ".join(
            f"{of_counts(those(soil, share=one, speed=slow), rebounds)} at {one:g}" for one in shares
        ),
        "fast_rebounds": of_counts(those(soil, share=shares[0], speed=fast), rebounds),
        "coarse_drops": str(len(those(balls, name="cm", speed=balls[0]["speed"]))),
        "coarse_count": str(len(balls)),
        "cm_rebound": of_counts(those(balls, name="cm"), rebounds),
        "mm_rebound": of_counts(those(balls, name="mm"), rebounds),
        "pads_flown": of_counts(pulled, lambda row: row["last_speed"] > HELD_SPEED),
        "pads_count": str(len(pads)),
        "damped_land": of_counts([row for row in pads if row["restitution"] != RESTITUTION], lands),
        "loose_sunk": of_counts([row for row in pads if row["sintering"] == "none" and row["filled"] == LOOSE],
                                lambda row: not bears(row)),
    }  # fmt: skip


def of_settings(axis: Axes, name: str, value: str, names: list[str]) -> None:
    """Each run as a dot, and the mean of each setting as a bar."""
    rows = rows_of(name)
    for k, setting in enumerate(names):
        own = column(those(rows, setting=setting), value)
        axis.plot(own, np.full(len(own), k), "o", color=INPUT_COLOURS[0], ms=3, alpha=0.6)
        axis.plot([own.mean()] * 2, [k - 0.3, k + 0.3], color=INPUT_COLOURS[1], lw=2)
    axis.set_yticks(range(len(names)), names)
    axis.invert_yaxis()


def of_ice(axis: Axes) -> None:
    """Depth of the dent over the cohesion of the ice."""
    ran = sorted((row for row in rows_of("philae_into_ice") if row["name"].endswith("Pa")),
                 key=lambda row: row["cohesion"])  # fmt: skip
    axis.plot(column(ran, "cohesion"), column(ran, "deepest"), "o-", color=INPUT_COLOURS[0])
    axis.axhline(DENT, color=QUIET, ls="--", lw=1)
    axis.set_xscale("symlog", linthresh=10.0)
    axis.set(xlabel="cohesion of the ice [Pa]", ylabel="dent [m]", title="Philae into ice", xlim=(-1.0, 2000.0))


def of_gravities(axis: Axes) -> None:
    """Fraction that rebounds over gravity, a line a speed."""
    rows = rows_of("same_soil_gravities")
    shares = sorted({row["share"] for row in rows})
    for k, speed in enumerate(sorted({row["speed"] for row in rows})):
        cells = [those(rows, share=share, speed=speed) for share in shares]
        part = [sum(map(rebounds, own)) / len(own) for own in cells]
        at = [share * 1.12 ** (k - 1) for share in shares]
        axis.plot(at, part, "o-", color=INPUT_COLOURS[k], label=f"{speed:g} m/s")
    axis.set_xscale("log")
    axis.legend()
    axis.set(xlabel="gravity / Earth's", ylabel="fraction that rebounds", title="One soil", ylim=(-0.05, 1.05))


def of_pads(axis: Axes) -> None:
    """Way of each pad along the slope, apart by sintering."""
    rows = rows_of("footpad_on_ice")
    for k, name in enumerate(dict.fromkeys(row["sintering"] for row in rows)):
        own = those(rows, sintering=name)
        axis.plot(column(own, "slope_deg") + 0.6 * (k - 1), 1e2 * column(own, "slip"), "o", ms=4, alpha=0.7,
                  color=INPUT_COLOURS[k], label=f"sintering: {name}")  # fmt: skip
    axis.axhline(1e2 * HELD_SLIP, color=QUIET, ls="--", lw=1)
    axis.legend()
    axis.set(xlabel="slope [deg]", ylabel="way along the slope [cm]", title="Footpad on ice")


def of_plates(axis: Axes) -> None:
    """Pressure over sinkage."""
    rows = [row for row in rows_of("plate_sinkage") if not row["name"].startswith("heap")]
    for k, name in enumerate(dict.fromkeys(row["name"].split(",")[0] for row in rows)):
        for row in rows:
            if row["name"].split(",")[0] == name:
                pressure = [1e-3 * row[f"pressure_{1e3 * one:g}mm"] for one in SHOWN]
                axis.plot([1e3 * one for one in SHOWN], pressure, "o-", color=INPUT_COLOURS[k],
                          label=name if row["name"] == name else None)  # fmt: skip
    axis.legend()
    axis.set(xlabel="sinkage [mm]", ylabel="pressure [kPa]", title="Plate pressed into grains")


def draw() -> None:
    """Six cases, each in a panel."""
    with figure(PAGES / "low_speed.png", 3, 2, (8.0, 10.5), dpi=150) as (_, axes):
        (mascot, gravities), (shell, philae), (pads, plates) = np.reshape(axes, (3, 2))
        names = list(dict.fromkeys(row["setting"] for row in rows_of("lander_on_beds")))
        of_settings(mascot, "lander_on_beds", "ratio", names)
        mascot.set(xlabel="speed ratio", title="MASCOT on beds")
        names = list(dict.fromkeys(row["setting"] for row in rows_of("filled_shell")))
        of_settings(shell, "filled_shell", "energy_lost", names)
        shell.axvline(0.9, color=QUIET, ls="--", lw=1)
        shell.set(xlabel="energy lost in the first bounce", title="Shell with grains")
        of_ice(philae)
        of_gravities(gravities)
        of_pads(pads)
        of_plates(plates)


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
        gravity_cells=ball_table("same_soil_gravities", "kind", "speed"),
        coarse_cells=ball_table("ball_on_coarse_grains", "name", "speed"),
        pads=footpad_table(), plates=plate_table(), **words(),
        ratios=table(heads, settings_of("lander_on_beds", "ratio")),
        losses=table(heads, settings_of("filled_shell", "energy_lost")), ice=ice_table(),
    )  # fmt: skip
    draw()
    print(f"{agree} of {count} agree, {shown} with a cause")


if __name__ == "__main__":
    main()
