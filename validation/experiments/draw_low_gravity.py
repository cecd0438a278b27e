"""Figures of the experiments in low gravity: what was measured as a line or band, and our points."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from draw import INK, MEASURED
from fits import column
from sphere_bed import Row


def of_plates(rows: list[Row], to: Path) -> None:
    """Speed and depth 6 s after contact over bulk density."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.0), layout="constrained")
    groups = {
        "no cohesion": (INK[0], "o", lambda name: name.startswith("filled_")),
        "10 Pa": (INK[1], "s", lambda name: "_10Pa" in name),
        "100 Pa": (INK[1], "^", lambda name: "_100Pa" in name),
        "friction .2": (INK[2], "v", lambda name: "smooth" in name),
        "no rolling resistance": (INK[2], "D", lambda name: "round" in name),
        "finer": (INK[3], "P", lambda name: "finer" in name),
        "stiffer": (INK[3], "X", lambda name: "stiffer" in name),
        "wider, deeper, anew": ("0.3", ".", lambda name: name.split("_")[1] in ("wider", "deeper", "again")),
    }
    for axis, name, text, measured in (
        (axes[0], "speed_6", "speed after 6 s [m/s]", (0.04, 0.04)),
        (axes[1], "depth_6", "depth after 6 s [m]", (0.37, 0.42)),
    ):
        axis.axhspan(0.98 * measured[0], 1.02 * measured[1], color=MEASURED, alpha=0.5, lw=0, label="OSIRIS-REx")
        axis.axvline(0.5 * 1190.0, color=MEASURED, ls=":", label="half of Bennu's bulk density")
        for label, (ink, mark, chosen) in groups.items():
            own = [row for row in rows if chosen(str(row["name"]))]
            style = "-" if label == "no cohesion" else ""
            if own:
                axis.plot(column(own, "bulk_density"), np.maximum(column(own, name), 0.0), mark + style, color=ink,
                          label=label)  # fmt: skip
        axis.set(xlabel="bulk density [kg/m$^3$]", ylabel=text)
    axes[0].legend(fontsize=8)
    figure.savefig(to, dpi=110)
    plt.close(figure)


def of_packing(rows: list[Row], to: Path) -> None:
    """Solid fraction over the pull of a contact in weights of a grain."""
    figure, axis = plt.subplots(figsize=(5.6, 3.8), layout="constrained")
    for kind, ink in zip(dict.fromkeys(row["kind"] for row in rows), INK, strict=False):
        own = [row for row in rows if row["kind"] == kind]
        axis.plot(np.maximum(column(own, "pull"), 0.03), column(own, "solid_fraction"), "o", color=ink, label=kind)
    axis.set(xscale="log", xlabel="pull of a contact over the weight of a grain (.03: none)", ylabel="solid fraction")
    axis.legend()
    figure.savefig(to, dpi=110)
    plt.close(figure)


def of_balls(rows: list[Row], to: Path) -> None:
    """Depth over Froude number and over speed, and duration."""
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.9), layout="constrained")
    for share, ink in zip(sorted({row["share"] for row in rows}, reverse=True), INK, strict=False):
        own = sorted((row for row in rows if row["share"] == share), key=lambda row: row["froude"])
        deep = 100.0 * (column(own, "depth") + column(own, "touch_height"))
        axes[0].plot(column(own, "froude"), deep, "o-", color=ink, label=f"{share:g} of Earth's gravity")
        axes[1].plot(column(own, "speed"), deep, "o-", color=ink)
        axes[2].plot(column(own, "froude"), column(own, "duration_in_units"), "o-", color=ink)
    axes[0].set(xlabel="Froude number", ylabel="depth below the first touch [cm]", title="[Sunday-2022]: one curve")
    axes[1].set(xlabel="speed [m/s]", xscale="log", title="[Murdoch-2017]: one straight line")
    axes[2].set(xlabel="Froude number", ylabel="duration over sqrt(D/g)", ylim=(0.0, None))
    axes[0].axvline(1.5, color=MEASURED, ls=":")
    axes[0].legend(fontsize=8)
    figure.savefig(to, dpi=110)
    plt.close(figure)
