"""Fit the runs of expansion_accuracy.py, draw them, and write their page, docs/validation/expansion_accuracy.md.

    python validation/expansion_accuracy_figures.py

Reads expansion_accuracy.csv and expansion_accuracy.json beside it; writes expansion_accuracy.png and
expansion_accuracy.md to docs/validation.
"""

import json
import sys
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from expansion_accuracy import CELLS, HOW, KEPT, KINDS, RANGES, SWEPT, Cell, designs, laws
from numpy.typing import NDArray
from page_text import broken
from paper_study_figures import PAPER_MAPE

from lithobrake.chaos import absolute_percentage_error, fit, term_count
from lithobrake.report.figures.style import INPUT_COLOURS, QUIET, STYLE

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import PAGES, read_rows

HERE = Path(__file__).parent
Floats = NDArray[np.float64]
Row = dict[str, Any]
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
    """Grains and ratio of a cell."""
    ground = HOW[cell.ground]
    return f"{ground.grain}s, {ground.ratio:g}"


def draw(found: dict[Cell, dict[str, Score]], swept: dict[Cell, Sweep]) -> None:
    """Sweeps above, a marker a bed, errors by range below."""
    grounds = sorted({cell.ground for cell in swept}, key=lambda name: (HOW[name].grain, HOW[name].ratio))
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=(9.6, 6.6), layout="constrained")
        upper, lower = figure.subfigures(2, 1)
        axes = upper.subplots(1, len(grounds), squeeze=False)[0]
        for axis, name in zip(axes, grounds, strict=True):
            for cell, one in swept.items():
                if cell.ground == name:
                    colour, label = INPUT_COLOURS[SWEPT.index(cell.kept)], cell.kept if cell.bed == 0 else None
                    axis.plot(one.part, 100.0 * one.speed, "osd^"[cell.bed], ms=2.5, color=colour, label=label)
            axis.set_title(f"{HOW[name].grain}s, {HOW[name].ratio:g}")
            axis.set_ylim(0.0, 1.1 * axis.get_ylim()[1])
        axes[0].legend(loc="lower right")
        axes[0].set_ylabel("rebound speed [cm/s]")
        upper.supxlabel("part of the full range of one property of the grains, all else at the medians", fontsize=9)
        axes = lower.subplots(1, len(OUTPUTS), squeeze=False, sharey=True)[0]
        kinds = list(dict.fromkeys((cell.ground, cell.bed, cell.kept) for cell in found))
        for axis, name in zip(axes, OUTPUTS, strict=True):
            for number, kind in enumerate(kinds):
                of = {cell: one for cell, one in found.items() if (cell.ground, cell.bed, cell.kept) == kind}
                label = f"{words(next(iter(of)))}, bed {kind[1]}" + ("" if kind[2] == "ours" else f", {kind[2]}")
                x = [list(RANGES).index(cell.range) for cell in of]
                y = [one[name].fresh for one in of.values()]
                axis.plot(x, y, "o-", ms=4, lw=1.0, color=INPUT_COLOURS[number], label=label)
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


def score_table(rows: list[Row], found: dict[Cell, dict[str, Score]]) -> list[str]:
    """A line a cell: errors on fresh points and on its own, Q2, error of twins, and which outputs reach the paper's."""
    heads = ["grains, ratio", "bed", "inputs", "range", "points, lost"]
    heads += [f"{TITLES[name]}: fresh, own, twins [%], Q2" for name in OUTPUTS] + ["reach the published error"]
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for cell, one in found.items():
        y = outputs_of(rows, cell, "grid")
        fine = [TITLES[name] for name in OUTPUTS if reached(one, name)]
        wide = cell.range if cell.range == "full" else f"±{cell.range}"
        cells = [words(cell), str(cell.bed), cell.kept, wide, f"{len(y)}, {int(np.isnan(y).any(axis=1).sum())}"]
        cells += [f"{s.fresh:.2g}, {s.own:.2g}, {s.twins:.2g}; {s.q2:.2f}" for s in one.values()]
        lines.append(f"| {' | '.join([*cells, ', '.join(fine) or 'none'])} |")
    return lines


def sweep_table(swept: dict[Cell, Sweep]) -> list[str]:
    """A line a sweep."""
    heads = [
        "grains, ratio",
        "bed",
        "property",
        "steps",
        "jumps",
        "median step [% of the mean]",
        "largest step [% of the mean]",
    ]
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for cell, one in swept.items():
        cells = [
            words(cell),
            str(cell.bed),
            cell.kept,
            str(one.steps),
            f"{one.jumps} ({100.0 * one.jumps / one.steps:.0f} %)",
        ]
        lines.append(f"| {' | '.join([*cells, f'{100.0 * one.median:.2g}', f'{100.0 * one.largest:.0f}'])} |")
    return lines


def reached(one: dict[str, Score], *names: str) -> bool:
    """Whether one of these outputs has no more than the published error on fresh points."""
    return any(one[name].fresh <= PAPER[name] for name in names)


def verdict(found: dict[Cell, dict[str, Score]]) -> str:
    """Where the expansion reaches the published errors."""
    said = []
    for names, title in ((("speed_out",), "rebound speed"), (DIRECTIONS, "direction"), (("spin_out",), "spin rate")):
        cells = [cell for cell, one in found.items() if reached(one, *names)]
        where = [f"{words(cell)}, bed {cell.bed}, {'' if cell.range == 'full' else '±'}{cell.range}" for cell in cells]
        said.append(f"of the {title} in {len(cells)}" + (f" ({'; '.join(where)})" if 0 < len(where) <= 3 else ""))
    whole = sum(
        all(reached(one, *names) for names in (("speed_out",), DIRECTIONS, ("spin_out",))) for one in found.values()
    )
    every = f"of all three in {whole}"
    return (
        f"Of {len(found)} cells an expansion of order {DEGREE} reaches the published error {', '.join([*said, every])}."
    )


def skill(found: dict[Cell, dict[str, Score]]) -> str:
    """In how many of the cells that reach the published error of the speed the expansion explains little of it."""
    fine = [one["speed_out"].q2 for one in found.values() if reached(one, "speed_out")]
    return (
        f"Of the {len(fine)} cells with the published error of the speed, {sum(q2 < 0.5 for q2 in fine)} have Q2 < 0.5"
    )


def kinks(found: dict[Cell, dict[str, Score]], swept: dict[Cell, Sweep]) -> str:
    """Jumps of the sweeps on each bed with expansions, and how many of its ranges reach the error of the speed."""
    said = []
    for place in dict.fromkeys((cell.ground, cell.bed) for cell in found):
        steps = [one for cell, one in swept.items() if (cell.ground, cell.bed) == place]
        cells = [one for cell, one in found.items() if (cell.ground, cell.bed) == place and cell.kept != "paper's"]
        if steps and cells:
            share = 100.0 * sum(one.jumps for one in steps) / sum(one.steps for one in steps)
            count = sum(reached(one, "speed_out") for one in cells)
            said.append(f"{place[0]}, bed {place[1]}: {share:.0f} % of the steps, {count} of {len(cells)} ranges")
    return "; ".join(said)


HEAD = """# Where the published expansion is accurate

Written by `python validation/expansion_accuracy_figures.py`.

The published method fits an expansion of order {degree} to landings on one bed, at one impact point,
in one attitude, and reports mean absolute errors of {speed:g} % for the rebound speed,
{elevation:g} % for the direction and {spin:g} % for the spin rate on fresh runs ([Landings-PCE],
Figure 5). Its input ranges and grains are not published. Over which ranges, and on which grains, are
such errors reached?

**{verdict}**

![Sweeps and errors](expansion_accuracy.png)

Above, each marker is a bed (circles 0, squares 1, diamonds 2, triangles 3); below, errors on fresh points.

## Method

Lander, medians and full ranges are those of `scenarios/one_place.toml`, its impact at 15 degrees
and its attitude too; the impact point is the middle of a tile that repeats, as in
[soil against impact point](grain_size.md). The ratio is the lander's longest edge over the
diameter of the grains. Three inputs vary, by a part of their medians to both sides or over their
full ranges: {ours}, which [the study at full size](paper_study.md) keeps, or {papers}, which the
paper keeps; "two" are the first two of ours, where landings cost most. The screening that chooses
them is not repeated. {terms} terms, {few} for two inputs, are fitted by least squares to a Smolyak
grid of level 5 (441 points, the order of the paper) or 4 (177, and 65 for two inputs), and scored on
30 to 50 fresh points. "Lost" landings did not leave. "Twins" is the error of a
law without error beside chance: from landings 0.1 mm aside. The paper does not state from where it
counts the direction of the velocity: both ways are tried.

## Errors

A mean absolute error is small, too, where an output hardly varies over its range. Q2 is the part of
the variance on fresh points that the expansion explains. {skill}.

"""
SWEEPS = """

## Kinks

Friction, or the restitution of the grains, alone over its full range, in equal steps. A jump is a
step of more than {jump:g} median steps. Where every step is large, chance is as large as the steps,
and jumps do not stand out: look at the median step. No polynomial of order {degree} follows either.

Jumps of all sweeps of a bed, and how many ranges of our inputs reach the published error of the
speed there: {kinks}.

"""
LIMITS = """

## What this leaves out

- One impact point and one attitude a bed; errors differ from bed to bed.
- {missing}
"""


def not_run(cells: list[Cell]) -> str:
    """A sentence about cells that are missing."""
    kinds: dict[str, list[str]] = {}
    for cell in cells:
        kinds.setdefault(f"{words(cell)}, bed {cell.bed}, {cell.kept}", []).append(cell.range)
    named = "; ".join(f"{kind} ({', '.join(ranges)})" for kind, ranges in kinds.items())
    beyond = "Expansions on hulls at 10, and on anything at 20, cost too much"
    return f"{beyond}; also not run: {named}." if cells else f"{beyond}."


def page(rows: list[Row], origin: Row) -> str:
    """The text of the page."""
    found = {cell: one for cell in CELLS if cell.level is not None and (one := scores(rows, cell))}
    swept = {cell: one for cell in CELLS if cell.level is None and (one := sweep(rows, cell))}
    draw(found, swept)
    speed, elevation, _, spin = (PAPER[name] for name in OUTPUTS)
    ours, papers = (", ".join(f"`{name}`" for name in KEPT[kind]) for kind in ("ours", "paper's"))
    head = HEAD.format(
        degree=DEGREE, speed=speed, elevation=elevation, spin=spin, verdict=verdict(found), ours=ours, papers=papers,
        terms=term_count(len(KEPT["ours"]), DEGREE), few=term_count(len(KEPT["two"]), DEGREE), skill=skill(found),
    )  # fmt: skip
    missing = not_run([cell for cell in CELLS if cell not in found and cell not in swept])
    middle = SWEEPS.format(jump=JUMP, degree=DEGREE, kinks=kinks(found, swept))
    lines = [head, *score_table(rows, found), middle, *sweep_table(swept)]
    spent = sum(row["cpu_s"] for row in rows) / 60.0
    made = f"`{origin['command']}`, {origin['date']}, {origin['machine']}, one thread, load {origin['load']:.0f}."
    return broken("\n".join([*lines, LIMITS.format(missing=missing), f"{made} {spent:.0f} min of CPU."])) + "\n"


def main() -> None:
    """Fit, draw, write."""
    rows = read_rows(HERE / "expansion_accuracy.csv", KINDS)
    content = page(rows, json.loads((HERE / "expansion_accuracy.json").read_text()))
    (PAGES / "expansion_accuracy.md").write_text(content, encoding="utf-8")


if __name__ == "__main__":
    main()
