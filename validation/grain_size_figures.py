"""Draw what grain_size.py found, and write its page, docs/validation/grain_size.md.

    python validation/grain_size_figures.py

Reads grain_size.csv, grain_size_beds.csv and grain_size.json beside it; writes grain_size.png and grain_size.md to
docs/validation.
"""

import sys
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import numpy as np
from grain_size import DURATION, EDGES, FLIGHTS, GROUNDS, KINDS, MASS, ROLLING, WAYS
from numpy.typing import NDArray

from lithobrake.analysis import LEVEL
from lithobrake.report.figures.style import QUIET, TEST, TRAINING

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from drawing import figure
from harness import PAGES, Row, read_document, read_rows
from page import made, table, write_page

HERE = Path(__file__).parent
Floats = NDArray[np.float64]
OUTPUTS = {
    "speed_out": "rebound speed", "elevation_out": "rebound elevation", "spin_out": "rebound spin rate",
    "returns": "return fraction",
}  # fmt: skip
RESAMPLES, SEED = 4000, 41
FEW = 4  # blocks, below which no interval is given
SOIL, POINT, ATTITUDE = 1, 2, 3  # axes of a block's outputs
# How each part is drawn: label, colour, marker, and how far from its ratio.
PARTS = {
    "soil": ("soil", TRAINING, "o", 0.96), "point": ("bed and impact point", TEST, "s", 1.04),
    "attitude": ("attitude", QUIET, "x", 1.0),
}  # fmt: skip


class Estimate(NamedTuple):
    """A value with its interval."""

    value: float
    lower: float
    upper: float

    def __str__(self) -> str:
        return f"{self.value:.2f} ({self.lower:.2f}-{self.upper:.2f})"

    @property
    def share(self) -> "Estimate":
        """The same as a part of a whole: scatter may put it a little outside."""
        return Estimate(*(min(max(one, 0.0), 1.0) for one in self))


class Parts(NamedTuple):
    """Total effects over the whole variance, main effect of the soil, and soil over impact point."""

    soil: Estimate
    point: Estimate
    attitude: Estimate
    main: Estimate
    ratio: Estimate
    chaos: float
    blocks: int


def outputs_of(rows: list[Row], name: str) -> tuple[Floats, Floats]:
    """An output [block, soil, point, attitude], NaN where a landing has none, and of the twins [block]."""
    count = max(row["block"] for row in rows) + 1
    values, twins = np.full((count, 2, 2, 2), np.nan), np.full(count, np.nan)
    for row in rows:
        if row["twin"]:
            twins[row["block"]] = row[name]
        else:
            values[row["block"], row["soil"], row["point"], row["attitude"]] = row[name]
    return values, twins


def half_squares(values: Floats, *axes: int) -> Floats:
    """Sum over each block, and their number, of half the squares of differences between landings [2, block].

    The landings of a pair differ in these axes. Source: [Jansen-1999].
    """
    halves = 0.5 * (values - np.flip(values, axes)) ** 2
    return np.array([np.nansum(halves, axis=(1, 2, 3)), np.isfinite(halves).sum(axis=(1, 2, 3))])


def estimate(values: Floats) -> Estimate:
    """The first of values, and the interval of the others."""
    lower, upper = np.nanquantile(values[1:], [0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL])
    return Estimate(float(values[0]), float(lower), float(upper))


def parts(rows: list[Row], name: str) -> Parts:
    """Parts of the variance of an output, with intervals by the bootstrap over blocks."""
    values, twins = outputs_of(rows, name)
    count = len(values)
    generator = np.random.default_rng(SEED)
    weights = np.vstack([np.ones(count), generator.multinomial(count, np.full(count, 1.0 / count), RESAMPLES)])

    def mean(*axes: int) -> Floats:
        total, number = half_squares(values, *axes)
        with np.errstate(invalid="ignore"):
            found: Floats = (weights @ total) / (weights @ number)
        return found

    whole, soil, point = mean(SOIL, POINT, ATTITUDE), mean(SOIL), mean(POINT)
    chaos = float(np.nanmean(0.5 * (values[:, 0, 0, 0] - twins) ** 2)) / float(whole[0])
    shares = (soil / whole, point / whole, mean(ATTITUDE) / whole, 1.0 - mean(POINT, ATTITUDE) / whole)
    return Parts(*(estimate(one).share for one in shares), estimate(soil / point), chaos, count)


def groups(rows: list[Row]) -> dict[tuple[str, str], list[Row]]:
    """Landings of each ground and way, whole blocks alone, by way, kind of grain and ratio."""
    found: dict[tuple[str, str], list[Row]] = {}
    for way in WAYS:
        for name in sorted(GROUNDS, key=lambda one: (GROUNDS[one].grain, GROUNDS[one].ratio)):
            of = [row for row in rows if (row["ground"], row["way"]) == (name, way)]
            whole = {block for block, number in Counter(row["block"] for row in of).items() if number == 9}
            if whole:
                found[name, way] = [row for row in of if row["block"] in whole]
    return found


def of_steep(found: dict[tuple[str, str], dict[str, Parts]]) -> dict[str, dict[str, Parts]]:
    """Parts of steep impacts on the smallest grounds, where there are blocks enough for an interval."""
    return {
        name: of for (name, way), of in found.items()
        if way == "steep" and GROUNDS[name].wider == 1.0 and of["speed_out"].blocks >= FEW
    }  # fmt: skip


def draw(found: dict[tuple[str, str], dict[str, Parts]]) -> None:
    """Total effects of soil and impact point by ratio: rows of grains, columns of outputs, steep impacts."""
    kinds = {"hull": "hulls", "sphere": "spheres"}
    ratios = sorted({GROUNDS[name].ratio for name in of_steep(found)})
    path, count = PAGES / "grain_size.png", len(OUTPUTS)
    with figure(path, 2, count, (9.6, 5.3), dpi=150, sharey=True, sharex=True) as (drawn, axes):
        for row, (grain, word) in zip(axes, kinds.items(), strict=True):
            for axis, (name, title) in zip(row, OUTPUTS.items(), strict=True):
                for part, (label, colour, marker, shift) in PARTS.items():
                    known = [(GROUNDS[g], p[name]) for g, p in of_steep(found).items()]
                    points = [(g.ratio * shift, getattr(p, part)) for g, p in known if g.grain == grain]
                    x, y = [x for x, _ in points], [e.value for _, e in points]
                    ends = np.array([[max(e.value - e.lower, 0.0), max(e.upper - e.value, 0.0)] for _, e in points]).T
                    axis.errorbar(x, y, ends, color=colour, marker=marker, ms=4.5, capsize=3, lw=1.0, label=label)
                axis.set_xscale("log")
                axis.set_xticks(ratios, [f"{ratio:g}" for ratio in ratios])
                axis.minorticks_off()
                axis.set_xlim(0.8 * ratios[0], 1.3 * ratios[-1])
                axis.set_ylim(0.0, 1.05)
                axis.grid(axis="y", color=QUIET, lw=0.2)
                if grain == "hull":
                    axis.set_title(title)
            row[0].set_ylabel(f"{word}\ntotal effect / variance")
        drawn.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
        drawn.supxlabel("longest edge of the lander over diameter of the grains", fontsize=9)


def words(name: str) -> str:
    return f"{GROUNDS[name].grain}s{', larger bed' if GROUNDS[name].wider > 1.0 else ''} | {GROUNDS[name].ratio:g}"


def part_tables(found: dict[tuple[str, str], dict[str, Parts]]) -> str:
    """Return a table for each output: a line for each ground and way."""
    heads = ["grains", "ratio", "impact angle [deg]", "soil", "soil alone", "bed and impact point", "attitude"]
    heads += ["soil / impact point", "chaos", "blocks"]
    tables = []
    for key, title in OUTPUTS.items():
        rows = []
        for (name, way), of in found.items():
            p = of[key]
            effects = [with_interval(one, p.blocks) for one in (p.soil, p.main, p.point, p.attitude, p.ratio)]
            rows.append([words(name), f"{WAYS[way][1]:g}", *effects, f"{p.chaos:.3f}", str(p.blocks)])
        tables.append(f"### {title.capitalize()}\n\n{table(heads, rows)}")
    return "\n\n".join(tables)


def with_interval(one: Estimate, blocks: int) -> str:
    """Return a value with its interval, or alone where there are too few blocks for one."""
    return str(one) if blocks >= FEW else f"{one.value:.2f}"


def landing_table(rows: dict[tuple[str, str], list[Row]], beds: list[Row]) -> str:
    heads = ["grains", "ratio", "impact angle [deg]", "grains in a bed", "width [m]", "depth [cm]", "beds", "landings"]
    heads += ["captured", "time limit", "rebound speed [cm/s]", "penetration, 90 % quantile [cm]"]
    heads += ["CPU time of a bed [s]", "CPU time of a landing [s]"]
    lines = []
    for (name, way), of in rows.items():
        own, ends = [bed for bed in beds if bed["ground"] == name], Counter(row["status"] for row in of)
        speed = 100.0 * np.array([row["speed_out"] for row in of])
        deep = 100.0 * np.quantile([row["penetration"] for row in of], 0.9)
        cells = [words(name), f"{WAYS[way][1]:g}", f"{own[0]['grains']:.0f}", f"{own[0]['width']:.2f}"]
        cells += [f"{100.0 * np.mean([bed['depth'] for bed in own]):.1f}", f"{len(own)}", f"{len(of)}"]
        cells += [str(ends["captured"]), str(ends["time_limit"])]
        cells += [f"{np.nanmean(speed):.1f} ± {np.nanstd(speed, ddof=1):.1f}", f"{deep:.1f}"]
        cells += [f"{np.mean([bed['cpu_s'] for bed in own]):.1f}", f"{np.mean([row['cpu_s'] for row in of]):.2f}"]
        lines.append(cells)
    return table(heads, lines)


def verdict(found: dict[tuple[str, str], dict[str, Parts]]) -> str:
    """Return at which ratios the soil moves the rebound speed more than bed and impact point do, by kind of grain."""
    sentences = []
    for grain in ("hull", "sphere"):
        of = sorted((GROUNDS[g].ratio, p["speed_out"].ratio) for g, p in of_steep(found).items() if g.startswith(grain))
        groups = {
            "the impact point moves it more than the soil": [ratio for ratio, one in of if one.upper < 1.0],
            "the two effects cannot be distinguished": [ratio for ratio, one in of if one.lower <= 1.0 <= one.upper],
            "the soil moves it more than the impact point": [ratio for ratio, one in of if one.lower > 1.0],
        }
        shown = "; ".join(f"at {' and '.join(f'{one:g}' for one in ratios)} {text}"
                          for text, ratios in groups.items() if ratios)  # fmt: skip
        listed = ", ".join(f"{one} at {ratio:g}" for ratio, one in of)
        sentences.append(
            f"- **{grain.capitalize()}s**: {shown}. The total effect of the soil over that of the impact point is "
            f"{listed}."
        )
    name, finest = next((g, p) for g, p in reversed(of_steep(found).items()) if g.startswith("hull"))
    effect = f"at {GROUNDS[name].ratio:g} on hulls its total effect is {finest['speed_out'].attitude} of the variance."
    return "\n".join([*sentences, f"- **Attitude**: {effect}"])


def main() -> None:
    rows, beds = (read_rows(HERE / name, KINDS) for name in ("grain_size.csv", "grain_size_beds.csv"))
    kept, of = read_document(HERE / "grain_size.json"), groups(rows)
    found = {key: {name: parts(own, name) for name in OUTPUTS} for key, own in of.items()}
    draw(found)
    names = {name for name, _ in found}
    absent = [f'"{name}"' for name in GROUNDS if name not in names]
    spent = sum(row["cpu_s"] for row in (*rows, *beds)) / 60.0
    counts = Counter(bed["ground"] for bed in beds if bed["ground"] in names).values()
    write_page(
        "grain_size", edges=" x ".join(f"{edge:g}" for edge in EDGES), mass=MASS, edge=max(EDGES), level=100 * LEVEL,
        resamples=RESAMPLES, rolling=ROLLING, speed=WAYS["steep"][0], steep=WAYS["steep"][1], flat=WAYS["flat"][1],
        verdict=verdict(found), tables=part_tables(found), few=FEW, landings=landing_table(of, beds), flights=FLIGHTS,
        hours=DURATION / 3600.0, fewest=min(counts), most=max(counts),
        missing=f"Not run: {', '.join(absent)}." if absent else "All beds of the script were run.",
        made=made(kept, "one thread", f"load {kept['load']:.0f}", f"{spent:.0f} min of CPU time"),
    )  # fmt: skip


if __name__ == "__main__":
    main()
