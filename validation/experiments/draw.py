"""Figures of the experiments: what was measured as a line or band, and our points."""

import sys
from pathlib import Path

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
from sphere_bed import Floats
from stopping_law import Law, squared_speed

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from drawing import figure

INK = ("#1b6ca8", "#d1495b", "#3a7d44", "#8d5fa8")
MEASURED = "0.45"
WIDTH = 9.2  # inch of every figure of three panels, so that the letters are those of the other figures


def legend_below(axis: Axes) -> None:
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2))


def of_drops(rows: list[Row], beds: dict[str, tuple[Row, Row]], slope: Estimate, to: Path) -> None:
    """Depth against the experiment's law, stopping time, and the exponent of density in other beds.

    rows: drops into our beads. beds: a light and a heavy drop into each bed.
    """
    with figure(to, 1, 3, (WIDTH, 4.4)) as (_, (left, middle, last)):
        draw_depths(left, rows, 0.14 / slope.value)
        for density, ink in zip(sorted({row["density"] for row in rows}), INK, strict=False):
            own = [row for row in rows if row["density"] == density]
            at = column(own, "deepest") / column(own, "impact_speed") * 1e3
            middle.plot(at, column(own, "stopping_time") * 1e3, "o", color=ink)
        far = np.array([0.0, middle.get_xlim()[1]])
        middle.plot(far, 3.0 * far, color=MEASURED, label="3 d/v, measured")
        middle.set(xlabel="depth / impact speed [ms]", ylabel="stopping time [ms]")
        legend_below(middle)
        draw_exponents(last, beds)


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
    axis.set_yticks(at, [short(name) for name in beds], fontsize=8)
    axis.set(xlabel="exponent of density", xlim=(0.4, 1.0))
    legend_below(axis)


def short(bed: str) -> str:
    """Return the name of a bed without what the loose, deep beds have in common."""
    for long, brief in ((", periodic, loose, deeper", ""), ("Young's modulus ", ""), ("rolling friction", "rolling")):
        bed = bed.replace(long, brief)
    return bed


def of_gravities(rows: list[Row], diameter: float, to: Path) -> None:
    """Depth and settling time against gravity."""
    with figure(to, 1, 2, (8.0, 4.2)) as (_, (left, right)):
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


def of_grains(kinds: dict[str, list[Row]], to: Path) -> None:
    """Speeds at which the grain leaves, how many others rise, and the mean speeds on each kind of bed."""
    with figure(to, 1, 3, (WIDTH, 4.2)) as (_, (left, right, last)):
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
        for shift, chosen, ink, text in (
            (0.1, speeds, INK[0], "all impacts"),
            (-0.1, leaving, INK[1], "those that leave"),
        ):
            means = [mean_of(chosen(rows)) for rows in kinds.values()]
            at, bars = [shift - k for k in range(len(kinds))], [mean.half for mean in means]
            last.errorbar([mean.value for mean in means], at, xerr=bars, fmt="o", color=ink, capsize=3, label=text)
        last.set(xlabel="mean of rebound / impact speed", xlim=(0.0, None), ylim=(0.5 - len(kinds), 0.5))
        last.set_yticks([-k for k in range(len(kinds))], [name.replace("_", " ") for name in kinds])
        legend_below(last)


def of_forces(looks: list[Row], friction: Floats, measured: Law, share: float, to: Path) -> None:
    """Speed of steel balls over depth, and friction over mass by depth, beside the measured law.

    friction: depth [m] and friction over mass [m/s2], shape [intervals, 2]. share: the tolerance of a measured value.
    """
    with figure(to, 1, 2, (WIDTH, 4.4)) as (_, (left, right)):
        for fall, ink in zip(sorted({row["fall"] for row in looks}), [*INK, "0.2"], strict=False):
            own = [row for row in looks if row["fall"] == fall and row["speed"] > 0.0]
            left.plot(
                100.0 * column(own, "depth"), column(own, "speed"), ".", ms=3, color=ink, label=f"fall of {fall:g} m"
            )
            depth = np.linspace(0.0, 1.2 * column(own, "depth").max(), 400)
            speed = np.sqrt(np.maximum(squared_speed(depth, fall, measured), 0.0))
            left.plot(100.0 * depth[speed > 0.0], speed[speed > 0.0], color=ink, lw=0.8)
        left.plot([], [], color="0.4", lw=0.8, label="measured force")
        left.set(xlabel="depth [cm]", ylabel="speed [m/s]", ylim=(0.0, None), xlim=(-0.3, None))
        legend_below(left)
        reach = np.array([0.0, 1.1 * friction[:, 0].max()])
        right.plot(100.0 * reach, measured.friction * reach, color=MEASURED, label="measured")
        low, high = ((1.0 + sign * share) * measured.friction * reach for sign in (-1.0, 1.0))
        right.fill_between(
            100.0 * reach, low, high, color=MEASURED, alpha=0.2, lw=0, label=f"±{100.0 * share:.0f} %"
        )  # fmt: skip
        right.plot(100.0 * friction[:, 0], friction[:, 1], "o", color=INK[0], label="simulated, steel balls")
        right.set(xlabel="depth [cm]", ylabel="friction / mass [m/s$^2$]", xlim=(0.0, None), ylim=(0.0, None))
        legend_below(right)


def of_plates(rows: list[Row], to: Path) -> None:
    """Speed 6 s after contact over bulk density and in the corners, and mean force over speed."""
    with figure(to, 1, 3, (WIDTH, 4.4)) as (_, axes):
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
            axes[2].plot(
                column(own, "speed"), column(own, "mean_force"), "o-", color=ink, label=f"cohesion {pull:g} Pa"
            )
        reach = np.array([0.05, 0.4])
        middle = float(np.median([row["mean_force"] for row in rows if row["series"] == "speeds"]))
        axes[2].plot(reach, middle * (reach / 0.14) ** (4 / 3), "--", color=MEASURED, label="exponent 4/3")
        axes[2].set(xscale="log", yscale="log", xlabel="speed at contact [m/s]", ylabel="mean force [N]")
        axes[2].set_xticks([0.05, 0.1, 0.2, 0.4], ["0.05", "0.1", "0.2", "0.4"])
        axes[2].set_xticks([], minor=True)
        legend_below(axes[2])


def of_packing(rows: list[Row], to: Path) -> None:
    """Solid fraction over the pull of a contact in weights of a grain."""
    with figure(to, 1, 1, (5.0, 3.4)) as (_, axis):
        for kind, ink in zip(dict.fromkeys(row["kind"] for row in rows), INK, strict=False):
            own = [row for row in rows if row["kind"] == kind]
            axis.plot(np.maximum(column(own, "pull"), 0.03), column(own, "solid_fraction"), "o", color=ink, label=kind)
        axis.set(xscale="log", xlabel="pull-off force / weight of a grain (0.03: none)", ylabel="solid fraction")
        axis.legend()


def of_balls(rows: list[Row], to: Path) -> None:
    """Depth over Froude number and over speed, and duration."""
    with figure(to, 1, 3, (WIDTH, 4.2)) as (_, axes):
        for share, ink in zip(sorted({row["share"] for row in rows}, reverse=True), INK, strict=False):
            own = sorted((row for row in rows if row["share"] == share), key=lambda row: row["froude"])
            deep = 100.0 * (column(own, "depth") + column(own, "touch_height"))
            axes[0].plot(column(own, "froude"), deep, "o-", color=ink, label=f"{share:g} g")
            axes[1].plot(column(own, "speed"), deep, "o-", color=ink)
            axes[2].plot(column(own, "froude"), column(own, "duration_in_units"), "o-", color=ink)
        axes[0].set(
            xlabel="Froude number", ylabel="depth below the first touch [cm]", title="[Sunday-2022]:\none curve"
        )
        axes[1].set(xlabel="speed [m/s]", xscale="log", title="[Murdoch-2017]:\none straight line")
        axes[2].set(xlabel="Froude number", ylabel=r"duration / $\sqrt{D / g}$", ylim=(0.0, None))
        axes[0].axvline(1.5, color=MEASURED, ls=":")
        legend_below(axes[0])
