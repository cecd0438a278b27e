"""Figures of the experiments in low gravity: what was measured as a line or band, and our points."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from draw import INK, MEASURED, WIDTH, legend_below
from fits import column
from result_rows import Row


def of_plates(rows: list[Row], to: Path) -> None:
    """Speed 6 s after contact over bulk density and in the corners, and mean force over speed."""
    figure, axes = plt.subplots(1, 3, figsize=(WIDTH, 4.4), layout="constrained")
    flight = [row for row in rows if row["series"] == "flight"]
    groups = {
        "grains of 2000 kg/m$^3$": (INK[0], "o-", lambda name: name.startswith("filled ")),
        "repeats": ("0.3", ".", lambda name: name.startswith("again")),
        "lighter grains": (INK[1], "s", lambda name: name.startswith("half density")),
    }
    axes[0].axhspan(0.039, 0.041, color=MEASURED, alpha=0.5, lw=0, label="OSIRIS-REx")
    axes[0].axvline(0.5 * 1190.0, color=MEASURED, ls=":", label="half of Bennu's bulk density")
    for label, (ink, style, chosen) in groups.items():
        own = sorted((row for row in flight if chosen(str(row["name"]))), key=lambda row: row["filled"])
        axes[0].plot(
            column(own, "bulk_density"), np.maximum(column(own, "speed_6"), 0.0), style, color=ink, label=label
        )
    axes[0].set(xlabel="bulk density [kg/m$^3$]", ylabel="speed after 6 s [m/s]")
    legend_below(axes[0])
    corners = [row for row in rows if row["series"] == "corners"]
    at = np.arange(len(corners))[::-1]
    axes[1].barh(at, 100.0 * np.maximum(column(corners, "speed_6"), 0.0), color=INK[0])
    axes[1].set_yticks(at, [str(row["name"]).removeprefix("corner ") for row in corners])
    axes[1].axvline(1.0, color=MEASURED, ls=":")
    axes[1].set(xlabel="speed after 6 s [cm/s]; left of the line: stopped")
    for pull, ink in zip(sorted({row["cohesion"] for row in rows if row["series"] == "speeds"}), INK, strict=False):
        own = [row for row in rows if row["series"] == "speeds" and row["cohesion"] == pull]
        own.sort(key=lambda row: row["speed"])
        axes[2].plot(column(own, "speed"), column(own, "mean_force"), "o-", color=ink, label=f"cohesion {pull:g} Pa")
    reach = np.array([0.05, 0.4])
    middle = float(np.median([row["mean_force"] for row in rows if row["series"] == "speeds"]))
    axes[2].plot(reach, middle * (reach / 0.14) ** (4 / 3), "--", color=MEASURED, label="exponent 4/3")
    axes[2].set(xscale="log", yscale="log", xlabel="speed at contact [m/s]", ylabel="mean force [N]")
    axes[2].set_xticks([0.05, 0.1, 0.2, 0.4], ["0.05", "0.1", "0.2", "0.4"])
    axes[2].set_xticks([], minor=True)
    legend_below(axes[2])
    figure.savefig(to)
    plt.close(figure)


def of_packing(rows: list[Row], to: Path) -> None:
    """Solid fraction over the pull of a contact in weights of a grain."""
    figure, axis = plt.subplots(figsize=(5.0, 3.4), layout="constrained")
    for kind, ink in zip(dict.fromkeys(row["kind"] for row in rows), INK, strict=False):
        own = [row for row in rows if row["kind"] == kind]
        axis.plot(np.maximum(column(own, "pull"), 0.03), column(own, "solid_fraction"), "o", color=ink, label=kind)
    axis.set(xscale="log", xlabel="pull-off force / weight of a grain (0.03: none)", ylabel="solid fraction")
    axis.legend()
    figure.savefig(to)
    plt.close(figure)


def of_balls(rows: list[Row], to: Path) -> None:
    """Depth over Froude number and over speed, and duration."""
    figure, axes = plt.subplots(1, 3, figsize=(WIDTH, 4.2), layout="constrained")
    for share, ink in zip(sorted({row["share"] for row in rows}, reverse=True), INK, strict=False):
        own = sorted((row for row in rows if row["share"] == share), key=lambda row: row["froude"])
        deep = 100.0 * (column(own, "depth") + column(own, "touch_height"))
        axes[0].plot(column(own, "froude"), deep, "o-", color=ink, label=f"{share:g} g")
        axes[1].plot(column(own, "speed"), deep, "o-", color=ink)
        axes[2].plot(column(own, "froude"), column(own, "duration_in_units"), "o-", color=ink)
    axes[0].set(xlabel="Froude number", ylabel="depth below the first touch [cm]", title="[Sunday-2022]:\none curve")
    axes[1].set(xlabel="speed [m/s]", xscale="log", title="[Murdoch-2017]:\none straight line")
    axes[2].set(xlabel="Froude number", ylabel=r"duration / $\sqrt{D / g}$", ylim=(0.0, None))
    axes[0].axvline(1.5, color=MEASURED, ls=":")
    legend_below(axes[0])
    figure.savefig(to)
    plt.close(figure)
