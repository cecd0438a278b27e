"""What the table of the ball on coarse grains says: rows of the page's table, a table of its own, and its figure."""

import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from draw import INK, MEASURED
from fits import column, mean_of
from sphere_bed import Row, read_rows
from table_lines import FIGURES, HERE, Lines, line

from lithobrake.analysis import wilson_interval

EARTH, DIAMETER = 9.81, 0.02  # m/s2, m
RISEN = 5e-4  # m above its deepest place, from which a ball counts as rebounding
LOWEST = "below 1e-4 g, lowest energies, here 1-10 cm/s (PRIME-3)"
# What the sources say: gravity over Earth's, speeds [m/s] from and to, and whether the ball rebounds. The lowest
# energies below 1e-4 of Earth's gravity have no number; up to .1 m/s is our reading, where ejecta begin.
SAID = {
    "1e-3 g, 1-20 cm/s (COLLIDE-2)": (1e-3, 0.01, 0.2, 0.0),
    "1e-3 g, 25-100 cm/s (COLLIDE-2)": (1e-3, 0.25, 1.0, 1.0),
    "1e-2 g, 4-230 cm/s (PRIME)": (1e-2, 0.04, 2.3, 0.0),
    LOWEST: (1e-4, 0.01, 0.1, 1.0),
}
SHOWN = ("sand", "coarser", "softer", "pebbles", "gravel", "lunar_0.0001")
SPHERES = ("sand", "coarser")


def froude(share: float, speed: float) -> float:
    """Return the Froude number of the ball at a speed [m/s] under a share of Earth's gravity."""
    return speed / math.sqrt(EARTH * share * DIAMETER)


def rebounds(rows: list[Row]) -> int:
    """Return how many balls rebound."""
    return int((column(rows, "rise") >= RISEN).sum())


def share_line(quantity: str, measured: str, expected: float, rows: list[Row]) -> tuple[str, bool]:
    """Return a row of the table for a share: it agrees where most of ours do what was seen."""
    count, total = rebounds(rows), len(rows)
    low, high = wilson_interval(count, total)
    agrees = abs(count / total - expected) < 0.5
    return (
        f"| {quantity} | {measured} | {count / total:.2f} ({low:.2f} to {high:.2f}) | {total} | - "
        f"| {'yes' if agrees else 'no'} |",
        agrees,
    )


def rebounds_part() -> tuple[Lines, str]:
    """Rows and a table of the balls on coarse grains."""
    every = read_rows(HERE / "who_rebounds.csv")
    if not every:
        return [], ""
    sand = [row for row in every if row["kind"] in SPHERES]
    lines = []
    for text, (share, slow, fast, expected) in SAID.items():
        low, high = froude(share, slow), froude(share, fast)
        own = [row for row in sand if low <= row["froude"] <= high]
        lines.append(share_line(f"ball: rebounds, {text}", "rebounds" if expected else "stays", expected, own))
    share, low, high, expected = SAID[LOWEST]
    pulling = [
        row for row in every
        if row["kind"] == "lunar_0.0001" and froude(share, low) <= row["froude"] <= froude(share, high)
    ]  # fmt: skip
    if pulling:
        lines.append(share_line("ball: the same, grains that pull as lunar soil", "rebounds", expected, pulling))
    slow = [row for row in sand if froude(1e-3, 0.01) <= row["froude"] <= froude(1e-3, 0.2)]
    lines.append(line("ball: speed out over speed in, 1e-3 g, 1-20 cm/s (COLLIDE-1)", 0.05,
                      mean_of(list(column(slow, "upward_out"))), 0.025, "order of .05"))  # fmt: skip
    thrown = [row for row in sand if row["froude"] == 30.0 and row["ejecta"] > 0]
    speed = mean_of(list(column(thrown, "ejecta_speed")))
    lines.append(line("ball: mean ejecta speed over speed in, Froude number 30 (COLLIDE-2)", 0.0, speed, 0.10,
                      "below .10"))  # fmt: skip
    for name in ("gravel", "pebbles"):
        own = [row for row in every if row["kind"] == name]
        if own:
            lines.append(share_line(f"ball: rebounds from irregular grains, {name}", "often", 1.0, own))
    of_rebounds(every, FIGURES / "who_rebounds.png")
    return lines, cells(every)


def cells(rows: list[Row]) -> str:
    """Return a table of all cells."""
    table = (
        "![who rebounds](experiments/who_rebounds.png)\n\n"
        "| grains | Froude number | speed at 1e-4, 1e-3, 1e-2 g [cm/s] | drops | rebound, 95 % interval "
        "| speed out over in | depth [mm] | throw grains | their speed over the ball's |\n"
        "|---|---|---|---|---|---|---|---|---|"
    )
    for kind in dict.fromkeys(row["kind"] for row in rows):
        for number in sorted({row["froude"] for row in rows if row["kind"] == kind}):
            own = [row for row in rows if row["kind"] == kind and row["froude"] == number]
            low, high = wilson_interval(rebounds(own), len(own))
            out, speeds = column(own, "upward_out"), [row["ejecta_speed"] for row in own if row["ejecta"] > 0]
            at = ", ".join(f"{100 * number * math.sqrt(EARTH * g * DIAMETER):.2g}" for g in (1e-4, 1e-3, 1e-2))
            table += (
                f"\n| {str(kind).replace('_', ' ')} | {number:g} | {at} | {len(own)} "
                f"| {rebounds(own) / len(own):.2f} ({low:.2f} to {high:.2f}) | {out.mean():.3f} +- {out.std():.3f} "
                f"| {1e3 * column(own, 'depth').mean():.1f} | {len(speeds)} "
                f"| {f'{np.mean(speeds):.3f}' if speeds else '-'} |"
            )
    return table


def of_rebounds(rows: list[Row], to: Path) -> None:
    """Share that rebounds and speed out over in, over the Froude number."""
    figure, axes = plt.subplots(1, 2, figsize=(12, 4.4), layout="constrained")
    for k, (text, (share, slow, fast, expected)) in enumerate(SAID.items()):
        level = expected + (0.05 + 0.03 * k) * (1.0 if expected else -1.0)
        ends = [froude(share, slow), froude(share, fast)]
        axes[0].plot(ends, [level, level], "|-", color=MEASURED, lw=2)
        axes[0].text(ends[0], level + (0.01 if expected else -0.045), text.split(" (")[0], fontsize=7, color=MEASURED)
    marks = dict(zip(SHOWN, ("o", "s", "^", "D", "v", "P"), strict=True))
    for k, kind in enumerate(name for name in SHOWN if any(row["kind"] == name for row in rows)):
        numbers = sorted({row["froude"] for row in rows if row["kind"] == kind})
        parts = [[row for row in rows if row["kind"] == kind and row["froude"] == number] for number in numbers]
        share = np.array([rebounds(part) / len(part) for part in parts])
        ends = np.array([wilson_interval(rebounds(part), len(part)) for part in parts]).T
        at, ink = np.array(numbers) * 1.06 ** (k - 2), (*INK, "0.2", "#c98a1b")[k]
        axes[0].errorbar(at, share, np.abs(ends - share), fmt=marks[kind] + "-", color=ink, lw=1, capsize=2,
                         label=kind.replace("_", " "))  # fmt: skip
        out = [column(part, "upward_out") for part in parts]
        axes[1].errorbar(at, [o.mean() for o in out], [o.std() for o in out], fmt=marks[kind], color=ink, capsize=2)
    needed = np.geomspace(0.8, 400.0, 50)
    axes[1].plot(needed, math.sqrt(2.0 * RISEN / DIAMETER) / needed, ":", color=MEASURED)
    axes[1].text(1.7, 0.16, "rises by .5 mm\nabove this line", fontsize=7, color=MEASURED)
    axes[1].axhline(0.05, color=MEASURED, lw=2)
    axes[1].text(100.0, 0.053, "COLLIDE-1, order of", fontsize=7, color=MEASURED)
    axes[0].set(xscale="log", xlabel="Froude number v / sqrt(g D)", ylabel="share that rebounds", ylim=(-0.25, 1.25))
    axes[1].set(xscale="log", xlabel="Froude number v / sqrt(g D)", ylabel="speed out over speed in", ylim=(-0.01, 0.2))
    axes[1].legend(*axes[0].get_legend_handles_labels(), fontsize=7, loc="upper right")
    figure.savefig(to, dpi=110)
    plt.close(figure)
