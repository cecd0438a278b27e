"""The landing site and the legend of a map: an open mark, and words beside the map, so that no impact is hidden."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.patheffects import Normal, Stroke

from lithobrake.report.figures.style import INK, SITE

# Four strokes that point at the place and leave it open: a site is where impacts may be densest.
CROSSHAIR = Path(
    [(0.4, 0.0), (1.0, 0.0), (-0.4, 0.0), (-1.0, 0.0), (0.0, 0.4), (0.0, 1.0), (0.0, -0.4), (0.0, -1.0)],
    [Path.MOVETO, Path.LINETO] * 4,
)
# The white rim keeps the thin strokes readable on dark and on bright places alike.
SITE_STYLE: dict[str, Any] = {
    "marker": CROSSHAIR,
    "markersize": 17,
    "fillstyle": "none",
    "markeredgecolor": INK,
    "markeredgewidth": 1.6,
    "path_effects": [Stroke(linewidth=3.4, foreground="white"), Normal()],
}


def mark_site(axes: Axes, x: float, y: float) -> None:
    """Mark the landing site; what lies there stays in sight."""
    axes.plot(x, y, zorder=6, **SITE_STYLE)


def ellipse_style(share: float) -> Literal["-", "--"]:
    """Style of the line of an ellipse that holds this share of the places."""
    return "-" if share < 0.9 else "--"


def draw_legend(
    figure: Figure,
    ellipses: Sequence[Mapping[str, Any]],
    what: str,
    place: tuple[float, float],
    *,
    is_gaussian: bool = True,
) -> None:
    """Say what mark and lines are, in one row with its lower left end at a place in parts of the figure.

    ellipses: of the summary, those that are drawn; what: what they hold, "impacts"; is_gaussian: whether these are
    spread by a Gaussian law.
    """
    law = "" if is_gaussian else " (not Gaussian)"
    handles = [Line2D([], [], linestyle="none", label="landing site", **SITE_STYLE)]
    for entry in ellipses:
        words = f"ellipse that holds {100 * entry['share']:.0f} % of the {what}{law}"
        handles.append(Line2D([], [], linestyle=ellipse_style(entry["share"]), color=SITE, linewidth=1.2, label=words))
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=place, ncols=3, columnspacing=1.8, borderpad=0.0)
