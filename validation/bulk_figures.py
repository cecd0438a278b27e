"""Draw what the bulk checks and the check of the bed's size found, and write bulk.md.

    python validation/bulk_figures.py

Reads every bulk_*.json and bed_size.json beside it that is there; a check that was not run is named as such. Page and
figures go to docs/validation.
"""

import math
import sys
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
from bulk import CHECKS

from lithobrake.report.figures.style import INK, INPUT_COLOURS, SITE, TRAINING

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from drawing import figure
from harness import PAGES, read_document
from page import made, table, write_page

HERE = Path(__file__).parent
Rows = list[dict[str, Any]]
# Outputs of the check of the bed's size: words and factor of the table. Impacts: speed, and angle from the normal.
OUTPUTS = {
    "speed_out": ("rebound speed [cm/s]", 100.0), "elevation_out": ("rebound elevation [deg]", math.degrees(1.0)),
    "spin_out": ("rebound spin rate [rad/s]", 1.0),
}  # fmt: skip
WAYS = {"steep": "0.4 m/s, 0 deg", "slanted": "0.4 m/s, 15 deg", "slow": "0.2 m/s, 30 deg"}


def grouped(rows: Rows, by: str, what: str) -> dict[Any, np.ndarray]:
    """Values of one column by those of another."""
    table: dict[Any, list[float]] = defaultdict(list)
    for row in rows:
        table[row[by]].append(row[what])
    return {key: np.array(values) for key, values in table.items()}


def lines(name: str, rows: Rows) -> str:
    by, columns = SHOWN[name]
    if name == "froude":
        rows = [row | {by: f"{row[by]:g}, {row['gravity']:g}"} for row in sorted(rows, key=lambda row: row[by])]
    first = grouped(rows, by, columns[0])
    cells = [[str(key), str(len(values))] for key, values in first.items()]
    heads = [HEADS[by], "simulations"]
    for column in columns:
        heads.append(HEADS[column])
        for place, values in enumerate(grouped(rows, by, column).values()):
            scatter = f" +- {values.std(ddof=1):.2g}" if len(values) > 1 else ""
            cells[place].append(f"{values.mean():.4g}{scatter}")
        if expected := EXPECTED.get((name, column)):
            heads.append("published")
            for place, value in enumerate(expected):
                cells[place].append(f"{value:g}")
    return table(heads, cells)


def draw_froude(rows: Rows) -> None:
    """Penetration and duration against the Froude number, by gravity."""
    with figure(PAGES / "bulk_froude.png", 1, 2, (8.0, 3.4)) as (_, axes):
        gravities = sorted({row["gravity"] for row in rows})
        for axis, column in zip(axes, ("penetration_over_diameter", "duration_scaled"), strict=True):
            for place, gravity in enumerate(gravities):
                table = grouped([row for row in rows if row["gravity"] == gravity], "froude", column)
                # Side by side, so that no bar hides another.
                beside = np.array(list(table)) * 1.04 ** (place - 1)
                mean = [values.mean() for values in table.values()]
                spread = [values.std(ddof=1) for values in table.values()]
                axis.errorbar(
                    beside, mean, spread, color=INPUT_COLOURS[place], marker="os^"[place], markersize=5, capsize=3,
                    label=f"g = {gravity:g} m/s²",
                )  # fmt: skip
            axis.set(xlabel=LABELS["froude"], ylabel=LABELS[column], xscale="log", ylim=(0.0, None))
            axis.set_xticks(list(table), [f"{number:g}" for number in table], minor=False)
            axis.minorticks_off()
        axes[0].legend(loc="lower right", title="bars: one standard deviation", title_fontsize=8)


EXPECTED = {
    ("repose", "angle_deg"): [25.0, 40.0], ("packing", "solid_fraction"): [0.51, 0.54, 0.52, 0.51, 0.50],
    ("compression", "solid_fraction"): [0.639, 0.593], ("compression", "coordination_without_rattlers"): [6.0, 4.5],
}  # fmt: skip
LABELS = {
    "froude": "Froude number $v / \\sqrt{g D}$", "penetration_over_diameter": "penetration / D",
    "duration_scaled": "duration $\\sqrt{g / D}$", "friction": "friction coefficient", "kind": "grains",
    "shape": "shape", "angle_deg": "angle of repose [deg]", "height_left": "height left / height filled",
    "solid_fraction": "solid fraction", "coordination": "contacts of a grain",
    "coordination_without_rattlers": "contacts of a grain that is held",
}  # fmt: skip


def draw(name: str, rows: Rows, by: str, columns: list[str]) -> None:
    """Means, scatter and single runs of the first two columns; crosses: what is expected."""
    with figure(PAGES / f"bulk_{name}.png", 1, 2, (8.0, 3.1)) as (drawn, axes):
        for axis, column in zip(axes, columns, strict=False):
            table = grouped(rows, by, column)
            for place, values in enumerate(table.values()):
                (single,) = axis.plot([place] * len(values), values, "o", color=TRAINING, alpha=0.6, mew=0.0)
                mean = axis.errorbar(
                    place, values.mean(), values.std(ddof=1) if len(values) > 1 else None, fmt="_", color=INK,
                    markersize=18, capsize=4,
                )  # fmt: skip
            handles = {"one run": single, "mean and standard deviation": mean}
            expected = EXPECTED.get((name, column), [])
            if expected:
                (handles["published"],) = axis.plot(range(len(expected)), expected, "x", color=SITE, markersize=7)
            # Names in two lines stand beside each other.
            names = [str(key).replace(", ", "\n").replace("hedron", "-\nhedron") for key in table]
            axis.set_xticks(range(len(table)), names)
            axis.set(xlabel=LABELS[by], ylabel=LABELS[column], xlim=(-0.5, len(table) - 0.5))
            if axis is axes[0]:
                drawn.legend(handles.values(), handles, loc="outside lower center", ncols=3)


# Of each check: column that tells its rows apart, columns of the table, and the one to compare with published values.
SHOWN = {
    "repose": ("kind", ["angle_deg", "height_left", "stayed"]),
    "compression": ("friction", ["solid_fraction", "coordination_without_rattlers"]),
    "friction": ("friction", ["solid_fraction", "coordination"]),
    "packing": ("shape", ["solid_fraction", "coordination"]),
    "froude": ("froude", ["penetration_over_diameter", "duration_scaled"]),
}
HEADS = {
    "kind": "grains", "friction": "friction", "shape": "shape", "froude": "Froude number, gravity [m/s2]",
    "angle_deg": "angle of repose [deg]", "height_left": "height left / height filled", "stayed": "grains left",
    "solid_fraction": "solid fraction", "coordination": "coordination number",
    "coordination_without_rattlers": "coordination number without rattlers",
    "penetration_over_diameter": "penetration / D", "duration_scaled": "duration [sqrt(D/g)]",
}  # fmt: skip


ALTS = {
    "compression": "Solid fraction and contacts of pressed spheres by friction",
    "friction": "Solid fraction and contacts of poured hulls by friction",
    "repose": "Angle of repose and height left, spheres and hulls",
    "packing": "Solid fraction and contacts of the Platonic solids",
    "froude": "Penetration and duration of an impact by Froude number at three gravities",
}


def section(name: str) -> str:
    """Return the table and origin of a check, drawn where it has run."""
    path, (by, columns) = HERE / f"bulk_{name}.json", SHOWN[name]
    if not path.exists():
        return "Not run."
    found = read_document(path)
    draw_froude(found["rows"]) if name == "froude" else draw(name, found["rows"], by, columns)
    cost = made(found, f"{found['cpu_s']} s of CPU time.")
    return "\n\n".join([lines(name, found["rows"]), f"![{ALTS[name]}](bulk_{name}.png)", cost])


def gravities() -> str:
    """Return how far the means at one Froude number are apart between gravities, against their scatter."""
    rows: Rows = read_document(HERE / "bulk_froude.json")["rows"]
    apart = []
    for column in SHOWN["froude"][1]:
        scores = []
        for number in sorted({row["froude"] for row in rows}):
            groups = list(grouped([row for row in rows if row["froude"] == number], "gravity", column).values())
            several = [values for values in groups if len(values) > 1]
            scatter = np.sqrt(np.mean([values.var(ddof=1) for values in several]))
            means = [values.mean() for values in several]
            scores.append((max(means) - min(means)) / scatter)
        apart.append(f"{min(scores):.1f} to {max(scores):.1f} ({HEADS[column].split(' [')[0]})")
    return " and ".join(apart)


def bed_size(found: dict[str, Any]) -> dict[str, str]:
    """Return the table of means on a bed and on one twice as wide and deep, the rule, and the largest difference."""
    heads = ["impact", "output", "plain beds (number)", "double beds (number)", "difference [standard errors]"]
    cells, apart, parts = [], [], []
    for way, entry in found["landings"].items():
        for output, (words, factor) in OUTPUTS.items():
            value = entry[output]
            means = [f"{factor * value[size]:.4g} +- {factor * value['scatter'][size]:.2g} ({value['beds'][size]})"
                     for size in ("plain", "double")]  # fmt: skip
            cells.append([WAYS[way], words, *means, f"{value['difference_in_standard_errors']:.2g}"])
            apart.append(value["difference_in_standard_errors"])
            parts.append((abs(value["double"] / value["plain"] - 1.0), f"{words.split(' [')[0]}, {WAYS[way]}"))
    rule = {f"{w:.3g} m wide and {d:.3g} m deep" for w, d in found["smallest_width_and_depth_m"].values()}
    return {
        "made": made(found, f"{found['cpu_s']} s of CPU time"), "beds": table(heads, cells),
        "rule": " or ".join(sorted(rule)), "count": str(len(apart)),
        "largest": f"{100.0 * max(parts)[0]:.0f} %", "which": max(parts)[1],
        "most": f"{max(apart, key=abs):.1f}", "below": str(sum(one < 0.0 for one in apart)),
    }  # fmt: skip


def main() -> None:
    write_page(
        "bulk", **{name: section(name) for name in CHECKS}, gravities=gravities(),
        **bed_size(read_document(HERE / "bed_size.json")),
    )  # fmt: skip


if __name__ == "__main__":
    main()
