"""Draw what sliding_law.py found, and write sliding_law.md.

    python validation/sliding_law_figures.py

Reads sliding_law.json and sliding_law.csv beside it; writes sliding_law.png and sliding_law.md to docs/validation.
"""

import json
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from page_text import broken
from sliding_law import ATTITUDES, CAPTURED_FROUDE, Row, as_usual, noted

from lithobrake.report.figures.style import INK, INPUT_COLOURS, QUIET, SITE, STYLE

HERE = Path(__file__).parent
PAGES = HERE.parent / "docs" / "validation"
OTHERS = {
    "restitution": "restitution 0.8 instead of 0.5", "stiffness": "ten times as stiff",
    "grain_friction": "friction 0.8 between grains, 0.2 of the lander", "size=0.5": "half the edges",
    "size=1.5": "1.5 times the edges",
}  # fmt: skip
TEXT = """\
# Sliding on a bed of hulls

Does a captured lander slide by Coulomb's law with the friction of its contacts?

{answer}

![Effective friction](sliding_law.png)

## Set-up

The box of `scenarios/first_bounce.toml` (0.1 x 0.1 x 0.227 m, 2 kg) lies on beds of 200 hulls of 9 cm, all of one
material. Beds are 1.5 m long and two to three grains deep. The box is dropped from just above the grains, with its long
edge along the later direction of motion, across it, oblique to it ("edge"), or in any orientation, and comes to rest.
An instantaneous push then sets it in motion along the bed, level or down a slope.

The **effective friction** is the energy lost, potential energy included, until the box is at rest again or leaves the
bed, divided by the component of its weight normal to the bed and by the path of its centroid. Means are weighted by the
path.

Speeds are given as Froude numbers v² / (g d), where d is the grain diameter. By similarity only the Froude number,
friction, restitution and the stiffness E / (rho g d) matter. The stiffness is 1e5 here, from a gravity of 0.02 m/s2 and
E = 4.5e5 Pa; at 5e-5 m/s2 the same pushes correspond to E = 1.1e3 Pa. Real soils are stiffer: the overlap is a
thousandth of a grain here and smaller in a real soil. One row below has a stiffness of 1e6. A captured lander has
v² < g a, where a is its smallest edge, so its Froude number is below 1.1 here.

## Why the law differs

{reasons}

"Standard error" is that of the mean over beds. "Scatter" is the standard deviation from push to push, weighted by path.

## By speed, all slopes

{speeds}

## By slope

{slopes}

## By attitude

{attitudes}

## Other parameters

{others}

## Limits

All grains of a bed have one size, so nothing follows for finer or mixed grains. Many rows are based on 4 to 13 pushes.

## Reproduce this page

`python validation/sliding_law_figures.py` writes the page and its figure. The pushes: {made}.
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
        figure.savefig(PAGES / "sliding_law.png", dpi=150)


def table(groups: list[dict[str, Any]], name: str, words: str) -> list[str]:
    """A line a group."""
    lines = [f"| friction | {words} | pushes | effective friction | standard error | scatter | mean path [grains] |"]
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
    lines = ["| changed | pushes | effective friction | scatter | same pushes unchanged | scatter |", "|---" * 6 + "|"]
    for name, words in OTHERS.items():
        other, usual = found["others"][name]["other"], found["others"][name]["usual"]
        lines.append(
            f"| {words} | {other['pushes']} | {other['mean']:.2f} | {other['scatter']:.2f} | {usual['mean']:.2f} | "
            f"{usual['scatter']:.2f} |"
        )
    return lines


def answer(found: dict[str, Any]) -> str:
    """Return the law that the pushes give."""
    law = found["law"]
    return (
        f"No: the effective friction is {law['intercept']:.2f} + {law['slope']:.2f} μ for contacts of friction μ from "
        f"0.2 to 0.8, at Froude numbers up to {CAPTURED_FROUDE:g}. Pushes scatter by {law['scatter']:.2f} about this "
        f"line and by {law['scatter_about_coulomb']:.2f} about Coulomb's law with μ itself, which holds only near μ = "
        "0.8."
    )


def reasons(rows: list[Row]) -> str:
    """Return what holds or slows the lander besides its contacts."""
    usual = as_usual(rows)
    steep = [row for row in usual if row["friction"] < row["slope"]]
    stopped = sum(row["stopped"] for row in steep)
    return (
        "- **Smooth landers** are held by the grains that they lie among, not by the friction of their contacts. Of "
        f"{len(steep)} pushes down a slope steeper than that friction, {stopped} came to rest. By Coulomb's law none "
        "would.\n- **Scatter** depends on where the lander lies. One that catches an edge stops within half a grain at "
        "any friction.\n- **Faster pushes** lose more energy per path.\n- **Smaller landers** lie deeper among the "
        "grains and have more effective friction; larger ones have no less.\n- **More friction between grains** than "
        "at the lander increases the effective friction, too."
    )


def main() -> None:
    """Draw and write."""
    found, rows = json.loads((HERE / "sliding_law.json").read_text()), noted(HERE / "sliding_law.csv")
    draw(rows, found)
    page = TEXT.format(
        answer=answer(found), reasons=reasons(rows),
        speeds="\n".join(table(found["by_froude"], "froude", "Froude number")),
        slopes="\n".join(table(found["by_slope"], "slope", "tangent of the slope")),
        attitudes="\n".join(table(found["by_attitude"], "attitude", "long edge")),
        others="\n".join(other_table(found)),
        made=f"`{found['command']}`, {found['date']}, {found['machine']}, {found['cpu_s']} s of CPU time",
    )  # fmt: skip
    (PAGES / "sliding_law.md").write_text(broken(page) + "\n")


if __name__ == "__main__":
    main()
