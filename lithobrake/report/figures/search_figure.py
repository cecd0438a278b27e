"""Places of rest by the image that shows them first, and where the images are pointed."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from lithobrake.report.figures.style import INK, QUIET, RULE
from lithobrake.vocabulary.array_types import Floats

# More windows than these have no number on the map.
NUMBERED = 12


def search_figure(latitude: Floats, longitude: Floats, first: np.ndarray, centre: Floats) -> Figure:
    """Draw places [deg], [count], in the colour of the window that shows each first, and the windows' centres [deg].

    first: number of the window, -1 for none, [count]; centre: latitude and longitude, [window_count, 2].
    """
    figure = Figure(figsize=(9.2, 4.9))
    axes = figure.add_axes((0.07, 0.12, 0.8, 0.82))
    never = first < 0
    axes.scatter(
        longitude[never], latitude[never], s=14, facecolor="none", edgecolor=QUIET, label="place of rest in no window"
    )
    drawn = axes.scatter(
        longitude[~never], latitude[~never], c=first[~never] + 1, s=16, cmap="viridis", vmin=1, vmax=len(centre),
        label="rests in a window",
    )  # fmt: skip
    axes.scatter(centre[:, 1], centre[:, 0], marker="+", s=60, color=INK, linewidth=1.1, label="centre of a window")
    for number, (north, east) in enumerate(centre[:NUMBERED]):
        axes.annotate(str(number + 1), (east, north), xytext=(5, 4), textcoords="offset points", weight="bold")
    axes.set(xlim=_around(longitude, 180.0), ylim=_around(latitude, 90.0))
    axes.set_xlabel("longitude, eastward [deg]")
    axes.set_ylabel("latitude [deg]")
    axes.grid(color=RULE, linewidth=0.5)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)
    scale = figure.colorbar(drawn, cax=figure.add_axes((0.89, 0.12, 0.018, 0.82)))
    scale.set_label("first window that shows it")
    scale.ax.yaxis.set_major_locator(MaxNLocator(integer=True))
    return figure


def _around(angles: Floats, most: float) -> tuple[float, float]:
    """Ends of an axis [deg] around places, within -most to most."""
    low, high = float(np.min(angles)), float(np.max(angles))
    margin = max(0.08 * (high - low), 1.0)
    return max(low - margin, -most), min(high + margin, most)
