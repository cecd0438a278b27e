"""Fit the runs of expansion_accuracy.py, draw them, and write their page, docs/validation/expansion_accuracy.md.

    python validation/expansion_accuracy_figures.py

Reads expansion_accuracy.csv and expansion_accuracy.json beside it; writes expansion_accuracy.png and
expansion_accuracy.md to docs/validation.
"""

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from expansion_accuracy import CELLS, HOW, KEPT, KINDS, RANGES, SWEPT, Cell, designs, laws
from numpy.typing import NDArray
from paper_study_figures import PAPER_MAPE

from lithobrake.chaos import absolute_percentage_error, fit, term_count
from lithobrake.report.figures.style import INPUT_COLOURS, QUIET

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from drawing import STYLE, plt
from harness import PAGES, Row, read_document, read_rows
from page import made, table, two_digits, write_page

HERE = Path(__file__).parent
Floats = NDArray[np.float64]
FROM_NORMAL = "from_normal"  # rad; the paper does not say from where it counts the direction
TITLES = {
    "speed_out": "rebound speed", "elevation_out": "rebound elevation", FROM_NORMAL: "angle from the normal",
    "spin_out": "rebound spin rate",
}  # fmt: skip
OUTPUTS = tuple(TITLES)
DIRECTIONS = ("elevation_out", FROM_NORMAL)
# Mean absolute errors [%] of the test runs of [Landings-PCE], "Results".
PAPER = PAPER_MAPE | {FROM_NORMAL: PAPER_MAPE["elevation_out"]}
DEGREE = 5
JUMP = 10.0  # median steps, above which a step of a sweep is a jump
MARKERS = {"o": "circles", "s": "squares", "d": "diamonds", "^": "triangles", "v": "inverted triangles"}
# The sets of inputs that vary, as a reader has them.
INPUTS = {"ours": "study", "paper's": "paper", "two": "first two"}


class Score(NamedTuple):
    """Mean absolute error on fresh points [%], on points of the fit [%], Q2 on fresh points, error of twins [%]."""

    fresh: float
    own: float
    q2: float
    twins: float


class Sweep(NamedTuple):
    """Part of the range and rebound speed [m/s] of a sweep, its jumps, steps, median and largest step over the mean."""

    part: Floats
    speed: Floats
    jumps: int
    steps: int
    median: float
    largest: float


def outputs_of(rows: list[Row], cell: Cell, design: str) -> Floats:
    """Outputs [count, 4] of the landings of a design in its order, NaN for a landing without them."""
    key = (cell.ground, cell.bed, cell.kept, cell.range, design)
    own = [row for row in rows if tuple(row[k] for k in ("ground", "bed", "kept", "range", "design")) == key]
    own = sorted(own, key=lambda row: int(row["number"]))
    angles = [0.5 * np.pi - row["elevation_out"] for row in own]
    rows = [[(row | {FROM_NORMAL: angle})[name] for name in OUTPUTS] for row, angle in zip(own, angles, strict=True)]
    return np.array(rows).reshape(-1, len(OUTPUTS))


def scores(rows: list[Row], cell: Cell) -> dict[str, Score] | None:
    """Scores of the expansion of a cell, by output; None where landings are missing."""
    points = designs(cell)
    y = {name: outputs_of(rows, cell, name) for name in points}
    if any(len(y[name]) < len(points[name]) for name in points):
        return None
    x, truth = points["grid"], y["test"]
    known, left = np.isfinite(y["grid"]).all(axis=1), np.isfinite(truth).all(axis=1)
    found = fit(laws(cell), x[known], y["grid"][known], degree=DEGREE, method="ols", output_names=OUTPUTS)
    here, own = found.score(points["test"][left], truth[left]), found.score(x[known], y["grid"][known])
    # Of two landings that only chance tells apart each is off their common mean by the difference over the root of 2.
    chance = np.nanmean(absolute_percentage_error(y["twin"], truth[: len(y["twin"])]), axis=0) / np.sqrt(2.0)
    return {
        name: Score(here[name]["mape"], own[name]["mape"], here[name]["q2"], float(chance[k]))
        for k, name in enumerate(OUTPUTS)
    }


def sweep(rows: list[Row], cell: Cell) -> Sweep | None:
    """What a sweep shows; None where its landings are missing."""
    x, y = designs(cell)["sweep"], outputs_of(rows, cell, "sweep")
    if len(y) < len(x):
        return None
    steps = np.abs(np.diff(y[:, 0]))
    steps = steps[np.isfinite(steps)]
    middle, mean = float(np.median(steps)), float(np.nanmean(y[:, 0]))
    part = np.linspace(0.0, 1.0, cell.steps + 1)
    return Sweep(part, y[:, 0], int((steps > JUMP * middle).sum()), len(steps), middle / mean, steps.max() / mean)


def words(cell: Cell) -> str:
    ground = HOW[cell.ground]
    return f"{ground.grain}s, {ground.ratio:g}"


def draw(found: dict[Cell, dict[str, Score]], swept: dict[Cell, Sweep]) -> None:
    """Draw the sweeps above, a marker for each bed, and the errors by range below."""
    grounds = sorted({cell.ground for cell in swept}, key=lambda name: (HOW[name].grain, HOW[name].ratio))
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=(9.6, 6.6), layout="constrained")
        upper, lower = figure.subfigures(2, 1)
        axes = upper.subplots(1, len(grounds), squeeze=False)[0]
        for axis, name in zip(axes, grounds, strict=True):
            for cell, one in swept.items():
                if cell.ground == name:
                    colour, label = INPUT_COLOURS[SWEPT.index(cell.kept)], cell.kept if cell.bed == 0 else None
                    marker = list(MARKERS)[cell.bed % len(MARKERS)]
                    axis.plot(one.part, 100.0 * one.speed, marker, ms=2.5, color=colour, label=label)
            axis.set_title(f"{HOW[name].grain}s, {HOW[name].ratio:g}")
            axis.set_ylim(0.0, 1.1 * axis.get_ylim()[1])
        axes[0].legend(loc="lower right")
        axes[0].set_ylabel("rebound speed [cm/s]")
        upper.supxlabel("position in the full range of one soil parameter, all others at their medians", fontsize=9)
        axes = lower.subplots(1, len(OUTPUTS), squeeze=False, sharey=True)[0]
        kinds = list(dict.fromkeys((cell.ground, cell.bed, cell.kept) for cell in found))
        for axis, name in zip(axes, OUTPUTS, strict=True):
            for number, kind in enumerate(kinds):
                of = {cell: one for cell, one in found.items() if (cell.ground, cell.bed, cell.kept) == kind}
                others = "" if kind[2] == "ours" else f", {INPUTS[kind[2]]}"
                label = f"{words(next(iter(of)))}, bed {kind[1]}{others}"
                x = [list(RANGES).index(cell.range) for cell in of]
                y = [one[name].fresh for one in of.values()]
                axis.plot(x, y, "o-", ms=4, lw=1.0, color=INPUT_COLOURS[number % len(INPUT_COLOURS)], label=label)
            axis.axhline(PAPER[name], color=QUIET, ls="--", lw=1.0, label="published")
            axis.set_yscale("log")
            axis.set_yticks([0.5, 1, 2, 5, 10, 20, 50, 100], ["0.5", "1", "2", "5", "10", "20", "50", "100"])
            axis.minorticks_off()
            axis.set_xticks(range(len(RANGES)), [one if one == "full" else f"±{one}" for one in RANGES])
            axis.set_title(TITLES[name])
        axes[0].set_ylabel("mean absolute error [%]")
        handles, labels = axes[0].get_legend_handles_labels()
        lower.legend(handles, labels, loc="outside right upper", fontsize=7)
        lower.supxlabel("range of the inputs around their medians", fontsize=9)
        figure.savefig(PAGES / "expansion_accuracy.png", dpi=150)
        plt.close(figure)


def head_cells(cell: Cell) -> list[str]:
    """Return grains and ratio, bed, inputs and range of a cell."""
    wide = cell.range if cell.range == "full" else f"±{cell.range}"
    return [words(cell), str(cell.bed), INPUTS[cell.kept], wide]


def error_table(rows: list[Row], found: dict[Cell, dict[str, Score]]) -> str:
    """Return a line a cell: errors on fresh points, and which outputs reach the published error."""
    heads = ["grains, ratio", "bed", "inputs", "range", "grid points", "lost"]
    heads += [f"{TITLES[name]} [%]" for name in OUTPUTS] + ["reach the published error"]
    lines = []
    for cell, one in found.items():
        y = outputs_of(rows, cell, "grid")
        fine = ", ".join(TITLES[name] for name in OUTPUTS if reached(one, name))
        counts = [str(len(y)), str(int(np.isnan(y).any(axis=1).sum()))]
        lines.append([*head_cells(cell), *counts, *(two_digits(s.fresh) for s in one.values()), fine or "none"])
    return table(heads, lines)


def fit_table(found: dict[Cell, dict[str, Score]]) -> str:
    """Return a line a cell: errors on points of the fit, errors due to chaos, and Q2 on fresh points."""
    heads = ["grains, ratio", "bed", "inputs", "range"]
    heads += [f"{TITLES[name]}: training [%], chaos [%]; Q2" for name in OUTPUTS]
    return table(heads, (
        [*head_cells(cell),
         *(f"{two_digits(s.own)}, {two_digits(s.twins)}; {s.q2:.2f}" for s in one.values())]
        for cell, one in found.items()
    ))  # fmt: skip


def sweep_table(swept: dict[Cell, Sweep]) -> str:
    heads = ["grains, ratio", "bed", "parameter", "steps", "jumps", "median step [% of the mean]",
             "largest step [% of the mean]"]  # fmt: skip
    return table(heads, (
        [words(cell), str(cell.bed), cell.kept, str(one.steps), f"{one.jumps} ({100.0 * one.jumps / one.steps:.0f} %)",
         two_digits(100.0 * one.median), f"{100.0 * one.largest:.0f}"]
        for cell, one in swept.items()
    ))  # fmt: skip


def reached(one: dict[str, Score], *names: str) -> bool:
    """Whether one of these outputs has no more than the published error on fresh points."""
    return any(one[name].fresh <= PAPER[name] for name in names)


def verdict(found: dict[Cell, dict[str, Score]]) -> str:
    asked = {"rebound speed": ("speed_out",), "direction": DIRECTIONS, "spin rate": ("spin_out",)}
    parts = []
    for title, names in asked.items():
        cells = [cell for cell, one in found.items() if reached(one, *names)]
        where = [f"{words(cell)}, bed {cell.bed}, {head_cells(cell)[-1]}" for cell in cells]
        parts.append(f"{len(cells)} ({title}{f': {where[0]}' if len(where) == 1 else ''})")
    whole = sum(all(reached(one, *names) for names in asked.values()) for one in found.values())
    return (
        f"An expansion of order {DEGREE} was fitted to {len(found)} combinations of grains, bed, inputs and range. It "
        f"reaches the published error in {', '.join(parts)} of them, and all three errors in {whole}."
    )


def skill(found: dict[Cell, dict[str, Score]]) -> str:
    fine = [one["speed_out"].q2 for one in found.values() if reached(one, "speed_out")]
    return (
        f"Of the {len(fine)} combinations with the published error of the speed, {sum(q2 < 0.5 for q2 in fine)} have "
        "Q2 < 0.5"
    )


def kink_table(found: dict[Cell, dict[str, Score]], swept: dict[Cell, Sweep]) -> str:
    """Return a line a bed with sweeps and expansions: its jumps, and the ranges that reach the error of the speed."""
    lines = []
    for place in dict.fromkeys((cell.ground, cell.bed) for cell in found):
        steps = [one for cell, one in swept.items() if (cell.ground, cell.bed) == place]
        here = {cell: one for cell, one in found.items() if (cell.ground, cell.bed) == place}
        cells = {cell: one for cell, one in here.items() if cell.kept != "paper's"}
        if steps and cells:
            share = 100.0 * sum(one.jumps for one in steps) / sum(one.steps for one in steps)
            rough = 100.0 * max(one.median for one in steps)
            count = sum(reached(one, "speed_out") for one in cells.values())
            lines.append([words(next(iter(cells))), str(place[1]), f"{share:.0f}", two_digits(rough),
                          f"{count} of {len(cells)}"])  # fmt: skip
    heads = ["grains, ratio", "bed", "jumps [% of the steps]", "largest median step [% of the mean]",
             "ranges with the published error of the speed"]  # fmt: skip
    return table(heads, lines)


def not_run(cells: list[Cell], found: Iterable[Cell]) -> str:
    """Return a sentence about cells that are missing."""
    kinds: dict[str, list[str]] = {}
    for cell in cells:
        kinds.setdefault(f"{words(cell)}, bed {cell.bed}, {INPUTS.get(cell.kept, cell.kept)}", []).append(cell.range)
    named = "; ".join(f"{kind} ({', '.join(ranges)})" for kind, ranges in kinds.items())
    beyond = f"No expansion was fitted above a ratio of {max(HOW[cell.ground].ratio for cell in found):g}."
    return f"{beyond} Not run: {named}." if cells else beyond


def place_of(cell: Cell) -> tuple[str, float, int]:
    return HOW[cell.ground].grain, HOW[cell.ground].ratio, cell.bed


def markers(swept: Iterable[Cell]) -> str:
    """Return which marker a bed has in the figure."""
    beds = sorted({cell.bed for cell in swept})
    return ", ".join(f"{list(MARKERS.values())[bed % len(MARKERS)]} {bed}" for bed in beds)


def main() -> None:
    rows = read_rows(HERE / "expansion_accuracy.csv", KINDS)
    kept = read_document(HERE / "expansion_accuracy.json")
    found = {cell: one for cell in CELLS if cell.level is not None and (one := scores(rows, cell))}
    swept = {cell: one for cell in CELLS if cell.level is None and (one := sweep(rows, cell))}
    draw(found, swept)
    found = {cell: found[cell] for cell in sorted(found, key=place_of)}
    speed, elevation, _, spin = (PAPER[name] for name in OUTPUTS)
    ours, papers = (", ".join(f"`{name}`" for name in KEPT[kind]) for kind in ("ours", "paper's"))
    spent = sum(row["cpu_s"] for row in rows) / 60.0
    write_page(
        "expansion_accuracy", degree=DEGREE, speed=speed, elevation=elevation, spin=spin, verdict=verdict(found),
        ours=ours, papers=papers, terms=term_count(len(KEPT["ours"]), DEGREE),
        few=term_count(len(KEPT["two"]), DEGREE), skill=skill(found), markers=markers(swept),
        errors=error_table(rows, found), fits=fit_table(found), jump=JUMP, kinks=kink_table(found, swept),
        sweeps=sweep_table(swept),
        missing=not_run([cell for cell in CELLS if cell not in found and cell not in swept], found),
        made=made(kept, "one thread", f"load {kept['load']:.0f}", f"{spent:.0f} min of CPU time"),
    )  # fmt: skip


if __name__ == "__main__":
    main()
