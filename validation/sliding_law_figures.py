"""Draw what sliding_law.py found, and write sliding_law.md.

    python validation/sliding_law_figures.py

Reads sliding_law.json and sliding_law.csv beside it; writes sliding_law.png and sliding_law.md to docs/validation.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from sliding_law import ATTITUDES, CAPTURED_FROUDE, Row, as_usual, noted

from lithobrake.report.figures.style import INK, INPUT_COLOURS, QUIET, SITE

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from drawing import figure
from harness import PAGES, read_document
from page import made, table, write_page

HERE = Path(__file__).parent
OTHERS = {
    "restitution": "restitution 0.8 instead of 0.5", "stiffness": "ten times as stiff",
    "grain_friction": "friction 0.8 between grains, 0.2 of the lander", "size=0.5": "half the edges",
    "size=1.5": "1.5 times the edges",
}  # fmt: skip


def draw(rows: list[Row], found: dict[str, Any]) -> None:
    """Effective friction against that of the contacts, and against the Froude number."""
    with figure(PAGES / "sliding_law.png", 1, 2, (9.2, 3.9), dpi=150, sharey=True) as (_, (left, right)):
        slow = [row for row in as_usual(rows) if row["froude"] <= CAPTURED_FROUDE]
        random = np.random.default_rng(1)
        for number, attitude in enumerate(ATTITUDES):
            colour, offset = INPUT_COLOURS[number], 0.02 * number - 0.03
            of = [row for row in slow if row["attitude"] == attitude]
            x = np.array([row["friction"] for row in of]) + offset + random.uniform(-0.006, 0.006, len(of))
            size = [12.0 * row["way"] for row in of]
            left.scatter(x, [row["effective_friction"] for row in of], size, color=colour, alpha=0.75, label=attitude)
        law, ends = found["law"], np.array([0.15, 0.85])
        line = law["intercept"] + law["slope"] * ends
        left.plot(ends, line, color=INK, lw=1.4, label="fit, and its scatter")
        left.fill_between(ends, line - law["scatter"], line + law["scatter"], color=QUIET, alpha=0.2, lw=0)
        left.plot(ends, ends, "--", color=SITE, lw=1.2, label="Coulomb's law, contacts")
        left.set(xlabel="friction of the contacts", ylabel="effective friction", ylim=(0.0, 2.0))
        left.set_title("At the speed of captured landers; area: path")
        left.legend(fontsize=7.5, loc="upper left", ncols=2)
        for friction, colour in zip((0.2, 0.4, 0.8), INPUT_COLOURS, strict=False):
            of = [one for one in found["by_froude"] if one["friction"] == friction]
            x = np.array([one["froude"] for one in of]) * (1.0 + 0.06 * (friction - 0.4))
            right.errorbar(x, [one["mean"] for one in of], [one["scatter"] for one in of], fmt="-o", color=colour,
                           capsize=3, ms=4.5, label=f"friction {friction:g}")  # fmt: skip
        right.set(xlabel="Froude number v² / (g d) of the push", xscale="log")
        right.set_xticks([0.3, 1.0, 3.0], ["0.3", "1", "3"])
        right.minorticks_off()
        right.set_title("By speed; bars: scatter from push to push")
        right.legend()


def group_table(groups: list[dict[str, Any]], name: str, words: str) -> str:
    lines = []
    for one in groups:
        value = one[name] if isinstance(one[name], str) else f"{one[name]:g}"
        error = "" if one["standard_error"] is None else f"{one['standard_error']:.2f}"
        cells = (f"{one['mean']:.2f}", error, f"{one['scatter']:.2f}", f"{one['way']:.1f}")
        lines.append((f"{one['friction']:g}", value, str(one["pushes"]), *cells))
    heads = ("pushes", "effective friction", "standard error", "scatter", "mean path [grains]")
    return table(("friction", words, *heads), lines)


def other_table(found: dict[str, Any]) -> str:
    """Other settings beside the like pushes."""
    lines = []
    for name, words in OTHERS.items():
        other, usual = found["others"][name]["other"], found["others"][name]["usual"]
        cells = (f"{one[key]:.2f}" for one in (other, usual) for key in ("mean", "scatter"))
        lines.append((words, str(other["pushes"]), *cells))
    heads = ("changed", "pushes", "effective friction", "scatter", "same pushes unchanged", "scatter")
    return table(heads, lines)


def main() -> None:
    found, rows = read_document(HERE / "sliding_law.json"), noted(HERE / "sliding_law.csv")
    draw(rows, found)
    steep = [row for row in as_usual(rows) if row["friction"] < row["slope"]]
    write_page(
        "sliding_law", law=found["law"], froude=CAPTURED_FROUDE, steep=len(steep),
        stopped=sum(row["stopped"] for row in steep),
        speeds=group_table(found["by_froude"], "froude", "Froude number"),
        slopes=group_table(found["by_slope"], "slope", "tangent of the slope"),
        attitudes=group_table(found["by_attitude"], "attitude", "long edge"), others=other_table(found),
        made=made(found, f"{found['cpu_s']} s of CPU time"),
    )  # fmt: skip


if __name__ == "__main__":
    main()
