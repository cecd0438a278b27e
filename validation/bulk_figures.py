"""Draw what the bulk checks and the check of the bed's size found, and write bulk.md.

    python validation/bulk_figures.py

Reads every bulk_*.json and bed_size.json beside it that is there; a check that was not run is named as such. Page and
figures go to docs/validation.
"""

import json
import textwrap
from collections import defaultdict
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from bulk import CHECKS

from lithobrake.report.figures.style import INK, INPUT_COLOURS, SITE, STYLE, TRAINING

HERE = Path(__file__).parent
PAGES = HERE.parent / "docs" / "validation"
Rows = list[dict[str, Any]]
WHOLE_WORDS: dict[str, Any] = {"break_long_words": False, "break_on_hyphens": False}


def grouped(rows: Rows, by: str, what: str) -> dict[Any, np.ndarray]:
    """Values of one column by those of another."""
    table: dict[Any, list[float]] = defaultdict(list)
    for row in rows:
        table[row[by]].append(row[what])
    return {key: np.array(values) for key, values in table.items()}


def lines(rows: Rows, by: str, columns: list[str]) -> list[str]:
    """A table of means and scatter."""
    head = [f"| {by} | runs | " + " | ".join(columns) + " |", "|" + "---|" * (2 + len(columns))]
    for key, first in grouped(rows, by, columns[0]).items():
        cells = [grouped(rows, by, column)[key] for column in columns]
        scatter = [f"{c.mean():.4g} +- {c.std(ddof=1):.2g}" if len(c) > 1 else f"{c.mean():.4g}" for c in cells]
        head.append(f"| {key} | {len(first)} | " + " | ".join(scatter) + " |")
    return head


def draw_froude(rows: Rows) -> None:
    """Penetration and duration against the Froude number, by gravity."""
    figure, axes = plt.subplots(1, 2, figsize=(8.0, 3.4), constrained_layout=True)
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
    figure.savefig(PAGES / "bulk_froude.png")


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
    figure, axes = plt.subplots(1, 2, figsize=(8.0, 3.1), constrained_layout=True)
    for axis, column in zip(axes, columns, strict=False):
        table = grouped(rows, by, column)
        for place, values in enumerate(table.values()):
            (single,) = axis.plot([place] * len(values), values, "o", color=TRAINING, alpha=0.6, markeredgewidth=0.0)
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
            figure.legend(handles.values(), handles, loc="outside lower center", ncols=3)
    figure.savefig(PAGES / f"bulk_{name}.png")


SHOWN = {
    "compression": ("friction", ["solid_fraction", "coordination_without_rattlers"],
                    "Spheres pressed from six sides; expected 0.639 and 0.593, 6 and 4.5 (Agnolin, Roux 2007)."),
    "friction": ("friction", ["solid_fraction", "coordination"], "Poured beds of 150 hulls."),
    "repose": ("kind", ["angle_deg", "height_left", "stayed"],
               "Slope left when one end opens; about 25 deg rounded, 40 angular (Kleinhans 2011). Of the height filled,"
               " less than all is left: the slope reaches the back."),
    "packing": ("shape", ["solid_fraction", "coordination"],
                "The Platonic solids, poured at 2 m/s, friction 0.5. Plastic dice: 0.51, 0.54, 0.52, 0.51, 0.50 settled"
                " in a flow, 0.64, 0.67, 0.64, 0.63, 0.59 shaken, +-0.01 (Baker, Kudrolli 2010)."),
    "froude": ("froude", ["penetration_over_diameter", "duration_scaled"],
               "A sphere dropped into beds at three gravities; equal Froude numbers should give equal values."),
}  # fmt: skip


ALTS = {
    "compression": "Solid fraction and contacts of pressed spheres by friction",
    "friction": "Solid fraction and contacts of poured hulls by friction",
    "repose": "Angle of repose and height left, spheres and hulls",
    "packing": "Solid fraction and contacts of the Platonic solids",
    "froude": "Penetration and duration of an impact by Froude number at three gravities",
}


def main() -> None:
    """Write the page and the figure."""
    page = [
        "# Bulk checks",
        "",
        "Written by `python validation/bulk_figures.py`. Means and standard deviations.",
        "",
    ]
    for name in CHECKS:
        by, columns, text = SHOWN[name]
        path = HERE / f"bulk_{name}.json"
        page += [f"## {name}", "", text, ""]
        if not path.exists():
            page += ["Not run yet.", ""]
            continue
        found = json.loads(path.read_text())
        page += [*lines(found["rows"], by, columns), "", *([found["note"], ""] if "note" in found else [])]
        page += [f"`{found['command']}`, {found['date']}, {found['machine']}, {found['cpu_s']} s of CPU time.", ""]
        with plt.rc_context(STYLE):
            draw_froude(found["rows"]) if name == "froude" else draw(name, found["rows"], by, columns)
        page += [f"![{ALTS[name]}](bulk_{name}.png)", ""]
    path = HERE / "bed_size.json"
    page += ["## Size of the bed", "", *(bed_size(json.loads(path.read_text())) if path.exists() else ["Not run yet."])]
    # Tables and pictures stay on their lines.
    page = [line if line.startswith(("|", "!", "`")) else textwrap.fill(line, 100, **WHOLE_WORDS) for line in page]
    (PAGES / "bulk.md").write_text("\n".join(page) + "\n", encoding="utf-8")


def bed_size(found: dict[str, Any]) -> list[str]:
    """Means on a bed and on one twice as wide and deep."""
    text = [
        "Means of several beds of each size, +- the scatter between beds.",
        "",
        "| landing | output | plain beds | double beds | difference in standard errors |",
        "|---|---|---|---|---|",
    ]
    for way, entry in found["landings"].items():
        for output in ("speed_out", "elevation_out", "spin_out"):
            value = entry[output]
            cells = [f"{value[size]:.4g} +- {value['scatter'][size]:.2g} ({value['beds'][size]})"
                     for size in ("plain", "double")]  # fmt: skip
            text.append(f"| {way} | {output} | {' | '.join(cells)} | {value['difference_in_standard_errors']:.2g} |")
    rule = ", ".join(f"{way} {w:.3g} and {d:.3g} m" for way, (w, d) in found["smallest_width_and_depth_m"].items())
    return [*text, "", f"Smallest width and depth by the rule: {rule}. {found['command']}, {found['date']}, "
            f"{found['machine']}, {found['cpu_s']} s of CPU time since it was last started."]  # fmt: skip


if __name__ == "__main__":
    main()
