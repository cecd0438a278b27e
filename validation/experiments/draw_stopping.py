"""Figure of the force that stops a ball in beads: speed over depth, and the friction at equal depths."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from draw import INK, MEASURED, WIDTH, legend_below
from fits import column
from result_rows import Row
from sphere_bed import Floats
from stopping_law import Law, squared_speed


def of_forces(looks: list[Row], friction: Floats, measured: Law, share: float, to: Path) -> None:
    """Speed of steel balls over depth, and friction over mass by depth, beside the measured law.

    friction: depth [m] and friction over mass [m/s2], shape [intervals, 2]. share: the tolerance of a measured value.
    """
    figure, (left, right) = plt.subplots(1, 2, figsize=(WIDTH, 4.4), layout="constrained")
    for fall, ink in zip(sorted({row["fall"] for row in looks}), [*INK, "0.2"], strict=False):
        own = [row for row in looks if row["fall"] == fall and row["speed"] > 0.0]
        left.plot(100.0 * column(own, "depth"), column(own, "speed"), ".", ms=3, color=ink, label=f"fall of {fall:g} m")
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
    figure.savefig(to)
    plt.close(figure)
