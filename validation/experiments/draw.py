"""Figures of the three experiments: what was measured as a line or band, and our points."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from fits import (
    Estimate,
    below_first_touch,
    below_mean_surface,
    column,
    density_exponent,
    leaving,
    mean_of,
    scale,
    speeds,
)
from matplotlib.axes import Axes
from result_rows import Row

from lithobrake.report.figures.style import STYLE

plt.rcParams.update(STYLE)
INK = ("#1b6ca8", "#d1495b", "#3a7d44", "#8d5fa8")
MEASURED = "0.45"
WIDTH = 9.2  # inch of every figure of three panels, so that the letters are those of the other figures


def legend_below(axis: Axes) -> None:
    """Put the legend of a panel where it hides no point."""
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2))


def of_drops(rows: list[Row], beds: dict[str, tuple[Row, Row]], slope: Estimate, to: Path) -> None:
    """Depth against the experiment's law, stopping time, and the exponent of density in other beds.

    rows: drops into our beads. beds: a light and a heavy drop into each bed.
    """
    figure, (left, middle, last) = plt.subplots(1, 3, figsize=(WIDTH, 4.4), layout="constrained")
    draw_depths(left, rows, 0.14 / slope.value)
    for density, ink in zip(sorted({row["density"] for row in rows}), INK, strict=False):
        own = [row for row in rows if row["density"] == density]
        middle.plot(column(own, "deepest") / column(own, "impact_speed") * 1e3, column(own, "stopping_time") * 1e3, "o",
                    color=ink)  # fmt: skip
    far = np.array([0.0, middle.get_xlim()[1]])
    middle.plot(far, 3.0 * far, color=MEASURED, label="3 d/v, measured")
    middle.set(xlabel="depth / impact speed [ms]", ylabel="stopping time [ms]")
    legend_below(middle)
    draw_exponents(last, beds)
    figure.savefig(to)
    plt.close(figure)


def draw_depths(axis: Axes, rows: list[Row], prefactor: float) -> None:
    """Depth, from either surface, against the experiment's law with a prefactor."""
    law = prefactor * scale(rows)
    reach = np.array([0.8 * law.min(), 1.2 * law.max()]) * 100
    axis.plot(reach, reach, color=MEASURED, label="published law")
    axis.fill_between(reach, 0.75 * reach, 1.25 * reach, color=MEASURED, alpha=0.2, lw=0, label="±25 %")
    for density, ink in zip(sorted({row["density"] for row in rows}), INK, strict=False):
        own = [row for row in rows if row["density"] == density]
        across = prefactor * scale(own) * 100
        axis.plot(across, below_mean_surface(own) * 100, "o", color=ink, label=f"simulated, {density:g} kg/m$^3$")
        axis.plot(across, below_first_touch(own) * 100, "o", color=ink, mfc="none")
    axis.plot([], [], "o", color="0.3", mfc="none", label="below the first touch")
    axis.set(xlabel=r"$(0.14/\mu)\,(\rho/\rho_b)^{1/2} D^{2/3} H^{1/3}$ [cm]", ylabel="depth [cm]")
    axis.set_title(f"beads of {1e3 * rows[0]['bead_size']:g} mm")
    legend_below(axis)


def draw_exponents(axis: Axes, beds: dict[str, tuple[Row, Row]]) -> None:
    """Exponent of density that a light and a heavy ball give in each bed, from either surface."""
    axis.axvspan(0.45, 0.55, color=MEASURED, alpha=0.25, lw=0, label="measured, ±0.05")
    at = np.arange(len(beds))[::-1]
    for depth_of, ink, face, text in (
        (below_mean_surface, INK[0], INK[0], "from the mean surface"),
        (below_first_touch, INK[0], "none", "from the first touch"),
    ):
        found = [density_exponent(light, heavy, depth_of) for light, heavy in beds.values()]
        axis.plot(found, at, "o", color=ink, mfc=face, label=text)
    axis.set_yticks(at, [short(name) for name in beds], fontsize=7)
    axis.set(xlabel="exponent of density", xlim=(0.4, 1.0))
    legend_below(axis)


def short(bed: str) -> str:
    """Return the name of a bed without what the loose, deep beds have in common."""
    for long, brief in ((", periodic, loose, deeper", ""), ("Young's modulus ", ""), ("rolling friction", "rolling")):
        bed = bed.replace(long, brief)
    return bed


def of_gravities(rows: list[Row], diameter: float, to: Path) -> None:
    """Depth and settling time against gravity."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.0, 4.2), layout="constrained")
    share = column(rows, "share")
    reach = np.array([0.5 * share.min(), 2.0 * share.max()])
    depth = column(rows, "depth") / diameter
    left.plot(reach, np.full(2, np.exp(np.log(depth).mean())), color=MEASURED, label="independent of g, measured")
    left.plot(share, depth, "o", color=INK[0], alpha=0.7, label="simulated")
    left.set(xscale="log", ylim=(0.0, 1.4 * depth.max()), xlabel="gravity / Earth's", ylabel="depth / diameter")
    left.axvspan(0.4, 1.2, color="0.9", zorder=0, label="gravities of the experiment")
    legend_below(left)
    for name, ink, text in (
        ("stopping_time", INK[1], "until it stops"),
        ("time_to_90", INK[2], "to 90 % of the depth"),
    ):
        times = column(rows, name)
        right.plot(share, times, "o", color=ink, alpha=0.7, label=f"simulated, {text}")
        middle = np.exp((np.log(times) + 0.5 * np.log(share)).mean())
        right.plot(reach, middle * reach**-0.5, color=MEASURED)
    right.plot([], [], color=MEASURED, label="$g^{-1/2}$, measured")
    right.set(xscale="log", yscale="log", xlabel="gravity / Earth's", ylabel="time [s]")
    legend_below(right)
    figure.savefig(to)
    plt.close(figure)


def of_grains(kinds: dict[str, list[Row]], to: Path) -> None:
    """Speeds at which the grain leaves, how many others rise, and the mean speeds on each kind of bed."""
    figure, (left, right, last) = plt.subplots(1, 3, figsize=(WIDTH, 4.2), layout="constrained")
    base = kinds["basalt"]
    left.hist(speeds(base), bins=np.arange(0.0, 0.75, 0.04), color=INK[0], alpha=0.8, label="simulated")
    left.axvspan(0.15, 0.25, color=MEASURED, alpha=0.25, lw=0, label="measured mean, about 0.20 ± 0.05")
    left.axvline(np.mean(speeds(base)), color=INK[1], label="mean of all grains")
    left.axvline(np.mean(leaving(base)), color=INK[1], ls="--", label="mean of those that leave")
    left.set(xlabel="rebound speed / impact speed", ylabel="impacts")
    legend_below(left)
    counts = np.arange(0, 1 + int(column(base, "risen_0.1").max()))
    for rise, ink in (("0.1", INK[0]), ("0.5", INK[1]), ("1", INK[2])):
        risen = column(base, f"risen_{rise}")
        right.plot(counts, [(risen >= least).mean() for least in counts], color=ink, drawstyle="steps-post",
                   label=f"rise > {rise} diameters")  # fmt: skip
    right.axvline(10, color=MEASURED, label="measured: typically fewer than 10")
    right.set(xlabel="grains ejected, at least", ylabel="fraction of impacts", ylim=(-0.05, 1.05))
    legend_below(right)
    last.axvspan(0.15, 0.25, color=MEASURED, alpha=0.25, lw=0)
    for shift, chosen, ink, text in ((0.1, speeds, INK[0], "all impacts"), (-0.1, leaving, INK[1], "those that leave")):
        means = [mean_of(chosen(rows)) for rows in kinds.values()]
        last.errorbar(
            [mean.value for mean in means], [shift - k for k in range(len(kinds))], xerr=[mean.half for mean in means],
            fmt="o", color=ink, capsize=3, label=text,
        )  # fmt: skip
    last.set(xlabel="mean of rebound / impact speed", xlim=(0.0, None), ylim=(0.5 - len(kinds), 0.5))
    last.set_yticks([-k for k in range(len(kinds))], [name.replace("_", " ") for name in kinds])
    legend_below(last)
    figure.savefig(to)
    plt.close(figure)
