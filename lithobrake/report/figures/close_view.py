"""A close view of a part of the map: what it holds, its frame, a bar of lengths, and where on the body it is."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from lithobrake.report.figures.density import WHOLE, Window, near
from lithobrake.report.figures.map_figure import draw_relief
from lithobrake.report.figures.style import INK, SITE

Array = NDArray[np.float64]
# The bar of lengths is at most this part of the map's width.
LONGEST_BAR = 0.3
# A close view has so much more than what it holds, at least half of this height [deg], and none beyond these.
MARGIN, SMALLEST_DEG = 1.1, 1e-3
WIDEST_DEG, HIGHEST_DEG = 60.0, 85.0


def view_around(latitude: Array, longitude: Array, aim: tuple[float, float]) -> Window | None:
    """The part of the map that holds these places and the aim point [deg], as wide as high on the ground.

    None where they lie too far apart or too near a pole for one.
    """
    latitude, longitude = np.append(latitude, aim[0]), np.append(longitude, aim[1])
    east = near(longitude, aim[1])
    middle = 0.5 * float(latitude.min() + latitude.max())
    shrink = float(np.cos(np.radians(middle)))
    half = max(MARGIN * 0.5 * float(max(np.ptp(latitude), shrink * np.ptp(east))), SMALLEST_DEG)
    if abs(middle) + half > HIGHEST_DEG or half > WIDEST_DEG:
        return None
    return Window(middle, 0.5 * float(east.min() + east.max()), half, half / shrink)


def frame_view(axes: Axes, window: Window) -> None:
    """Limits, labels and grid of a part of the map."""
    axes.set_xlim(window.longitude - window.half_longitude, window.longitude + window.half_longitude)
    axes.set_ylim(window.latitude - window.half, window.latitude + window.half)
    axes.set_aspect("equal" if window is WHOLE else window.half_longitude / window.half)
    axes.set_xlabel("longitude, east [deg]")
    axes.set_ylabel("latitude [deg]")
    axes.grid(visible=True)
    for spine in axes.spines.values():
        spine.set_visible(True)
    if window is WHOLE:
        axes.set_xticks(range(-180, 181, 45))
        axes.set_yticks(range(-90, 91, 30))
    else:
        axes.locator_params(nbins=6)


def whole_body(axes: Axes, window: Window, vertices: Array) -> None:
    """The whole map in small, with a frame where the close view is."""
    draw_relief(axes, vertices)
    axes.set_xlim(-180, 180)
    axes.set_ylim(-90, 90)
    axes.set_aspect("equal")
    middle = float(near(np.array([window.longitude]), 0.0)[0])
    for turn in (-360.0, 0.0, 360.0):
        corner = (middle + turn - window.half_longitude, window.latitude - window.half)
        size = (2.0 * window.half_longitude, 2.0 * window.half)
        axes.add_patch(Rectangle(corner, *size, fill=False, edgecolor=SITE, linewidth=1.5))
    axes.set_xticks(range(-180, 181, 90))
    axes.set_yticks(range(-90, 91, 45))
    axes.set_title("the view on the whole body [deg]", fontsize=8, fontweight="normal")
    axes.tick_params(labelsize=7)


def draw_bar(axes: Axes, window: Window, radius: float) -> None:
    """A bar of a round length on the ground, in the lower left corner."""
    metres = 2.0 * np.radians(window.half) * radius
    length = round_length(LONGEST_BAR * metres)
    part = length / metres
    style: dict[str, Any] = {"transform": axes.transAxes, "zorder": 7}
    axes.add_patch(Rectangle((0.025, 0.022), part + 0.03, 0.078, color="white", alpha=0.85, linewidth=0.0, **style))
    axes.plot([0.04, 0.04 + part], [0.04, 0.04], color=INK, linewidth=2.5, solid_capstyle="butt", **style)
    axes.text(0.04 + 0.5 * part, 0.052, f"{length:g} m", ha="center", va="bottom", fontsize=8, **style)


def round_length(most: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not more."""
    power = 10.0 ** np.floor(np.log10(most))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= most * (1.0 + 1e-12)))
