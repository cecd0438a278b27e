"""Draw what sliding_law.py found, and write sliding_law.md.

    python validation/sliding_law_figures.py

Reads sliding_law.json and sliding_law.csv beside it; writes sliding_law.png and sliding_law.md to docs/validation.
"""

import json
import textwrap
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from sliding_law import ATTITUDES, CAPTURED_FROUDE, Row, as_usual, noted

from lithobrake.report.figures.style import INK, INPUT_COLOURS, QUIET, SITE, STYLE

HERE = Path(__file__).parent
PAGES = HERE.parent / "docs" / "validation"
OTHERS = {
    "restitution": "restitution 0.8 in place of 0.5", "stiffness": "ten times as stiff",
    "grain_friction": "friction 0.8 between grains, 0.2 of the lander", "size=0.5": "half the edges",
    "size=1.5": "1.5 times the edges",
}  # fmt: skip
HEAD = """# Sliding on a bed of hulls

Written by `python validation/sliding_law_figures.py`.

A captured lander slides on by Coulomb's law, with the friction of hull and grain. Does it? The box
of the quick study (0.1 x 0.1 x 0.227 m, 2 kg) lies on beds of 200 hulls of 9 cm, 1.5 m long and two to
three grains deep, all of one material. It came to rest there by itself, dropped from just above the
grains with its long edge along the way, across it, aslant, or any way round. Then it is pushed
along the bed, level or down a slope, by an instant speed. What it has lost of its energy, height
included, when it lies still again or leaves the bed, over its weight on the bed and the way of its
centroid, is its effective friction. Means are over the way: energy lost by all, over weight and way
of all.

Speeds are Froude numbers v² / (g d). By similarity nothing but these, friction, restitution and
E / (rho g d) counts. The last is 1e5 here, by a gravity of 0.02 m/s2 with E = 4.5e5 Pa: on an
asteroid of 5e-5 m/s2 the same pushes are those of 1.1e3 Pa. Real soils are stiffer, by which a step
is shorter and the overlap, a thousandth of a grain here, smaller; a row below has 1e6. A captured
lander, v² < g a with its smallest edge a, has a Froude number below 1.1 here.
"""


def draw(rows: list[Row], found: dict[str, Any]) -> None:
    """Effective friction against that of the contacts, and against the Froude number."""
    with plt.rc_context(STYLE):
        figure, (left, right) = plt.subplots(1, 2, figsize=(9.2, 3.9), constrained_layout=True, sharey=True)
        slow = [row for row in as_usual(rows) if row["froude"] <= CAPTURED_FROUDE]
        random = np.random.default_rng(1)
        for number, attitude in enumerate(ATTITUDES):
            colour, offset = INPUT_COLOURS[number], 0.02 * number - 0.03
            of = [row for row in slow if row["attitude"] == attitude]
            x = np.array([row["friction"] for row in of]) + offset + random.uniform(-0.006, 0.006, len(of))
            size = [12.0 * row["way"] for row in of]
            left.scatter(x, [row["effective_friction"] for row in of], size, color=colour, alpha=0.75, label=attitude)
        law, ends = found["law"], np.array([0.15, 0.85])
        told = law["intercept"] + law["slope"] * ends
        left.plot(ends, told, color=INK, lw=1.4, label="law, and its scatter")
        left.fill_between(ends, told - law["scatter"], told + law["scatter"], color=QUIET, alpha=0.2, lw=0)
        left.plot(ends, ends, "--", color=SITE, lw=1.2, label="Coulomb's, of the contacts")
        left.set(xlabel="friction of the contacts", ylabel="effective friction", ylim=(0.0, 2.0))
        left.set_title("As slow as captured landers; areas: way")
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
        figure.savefig(PAGES / "sliding_law.png", dpi=150)


def table(groups: list[dict[str, Any]], name: str, words: str) -> list[str]:
    """A line a group."""
    lines = [f"| friction | {words} | pushes | effective friction | error over beds | scatter | mean way [grains] |"]
    lines.append("|---" * 7 + "|")
    for one in groups:
        value = one[name] if isinstance(one[name], str) else f"{one[name]:g}"
        lines.append(f"| {one['friction']:g} | {value} | {cells(one)} |")
    return lines


def cells(one: dict[str, Any]) -> str:
    """Number of pushes, friction with error and scatter, and way."""
    error = "" if one["standard_error"] is None else f"{one['standard_error']:.2f}"
    return f"{one['pushes']} | {one['mean']:.2f} | {error} | {one['scatter']:.2f} | {one['way']:.1f}"


def other_table(found: dict[str, Any]) -> list[str]:
    """Other settings beside the like pushes."""
    lines = ["| changed | pushes | effective friction | scatter | like pushes unchanged | scatter |", "|---" * 6 + "|"]
    for name, words in OTHERS.items():
        other, usual = found["others"][name]["other"], found["others"][name]["usual"]
        lines.append(
            f"| {words} | {other['pushes']} | {other['mean']:.2f} | {other['scatter']:.2f} | {usual['mean']:.2f} | "
            f"{usual['scatter']:.2f} |"
        )
    return lines


def findings(found: dict[str, Any], rows: list[Row]) -> str:
    """What the pushes say, in a paragraph."""
    law, usual = found["law"], as_usual(rows)
    steep = [row for row in usual if row["friction"] < row["slope"]]
    stopped = sum(row["stopped"] for row in steep)
    words = (
        f"Effective friction is {law['intercept']:.2f} + {law['slope']:.2f} μ for contacts of friction μ, from 0.2 to 0"
        f".8, at Froude numbers of {CAPTURED_FROUDE:g} and less. Pushes scatter by {law['scatter']:.2f} about that "
        f"line, by {law['scatter_about_coulomb']:.2f} about Coulomb's law with μ itself, which holds about 0.8 alone: "
        "smooth landers are held by the stones that they lie among and not by their contacts. Of "
        f"{len(steep)} pushes down a slope that is steeper than the friction of the contacts {stopped} came to rest, "
        "where Coulomb's law lets all go on. Scatter is where the lander lies: one that catches an edge stops within "
        "half a grain whatever its friction. Faster pushes lose more over their way. Smaller landers lie deeper among "
        "the stones and are held more, larger ones no less; more friction between grains than of the lander holds it "
        "more too. All beds are of equal grains, so of finer or mixed ones nothing is said."
    )
    return "\n".join(textwrap.wrap(words, 100, break_long_words=False, break_on_hyphens=False))


def main() -> None:
    """Draw and write."""
    found, rows = json.loads((HERE / "sliding_law.json").read_text()), noted(HERE / "sliding_law.csv")
    draw(rows, found)
    made = f"`{found['command']}`, {found['date']}, {found['machine']}, {found['cpu_s']} s of CPU time."
    parts = [
        HEAD, "## What comes out\n", findings(found, rows), "\n![Effective friction](sliding_law.png)\n", made,
        "\nErrors are those of the mean over beds; scatter is from push to push; both weigh a push by its way.",
        "\n## By speed, all slopes\n", *table(found["by_froude"], "froude", "Froude number"),
        "\n## By slope\n", *table(found["by_slope"], "slope", "tangent of the slope"),
        "\n## By attitude\n", *table(found["by_attitude"], "attitude", "long edge"),
        "\n## What else counts\n", *other_table(found),
    ]  # fmt: skip
    (PAGES / "sliding_law.md").write_text("\n".join(parts) + "\n")


if __name__ == "__main__":
    main()
