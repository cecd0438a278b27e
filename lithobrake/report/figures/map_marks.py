"""Marks on a map of latitude and longitude: the landing site, ellipses of landing places, and the legend of both."""

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.patheffects import Normal, Stroke
from numpy.typing import NDArray

from lithobrake.report.figures.density import Window, near
from lithobrake.report.figures.style import INK, SITE
from lithobrake.results.dispersion import EllipseShare, LandingEllipses
from lithobrake.vocabulary.percentages import percent

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
    figure: Figure, ellipses: Sequence[EllipseShare], what: str, place: tuple[float, float], *, is_gaussian: bool = True
) -> None:
    """Say what mark and lines are, in one row with its lower left end at a place in parts of the figure.

    ellipses: of the summary, those that are drawn; what: what they hold, "impacts"; is_gaussian: whether these are
    spread by a Gaussian law.
    """
    law = "" if is_gaussian else " (not Gaussian)"
    handles = [Line2D([], [], linestyle="none", label="landing site", **SITE_STYLE)]
    for one in ellipses:
        words = f"ellipse that holds {percent(one.share)} of the {what}{law}"
        handles.append(Line2D([], [], linestyle=ellipse_style(one.share), color=SITE, linewidth=1.2, label=words))
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=place, ncols=3, columnspacing=1.8, borderpad=0.0)


Array = NDArray[np.float64]
POINTS = 361


def outline(
    latitude_deg: float, longitude_deg: float, heading_deg: float, semi_axes_deg: tuple[float, float]
) -> tuple[Array, Array]:
    """Latitude and longitude [deg] of a closed line round a middle, both of shape [POINTS].

    semi_axes_deg: the longer at heading_deg from north toward east, the shorter across, laid round the sphere along
    great circles from the middle. Source: [Snyder-1987], Eqs 20-14 and 20-15.
    """
    turn = np.linspace(0.0, 2.0 * np.pi, POINTS)
    along, across = (np.radians(axis) * wave(turn) for axis, wave in zip(semi_axes_deg, (np.cos, np.sin), strict=True))
    heading, latitude = np.radians(heading_deg), np.radians(latitude_deg)
    north = np.cos(heading) * along - np.sin(heading) * across
    east = np.sin(heading) * along + np.cos(heading) * across
    distance = np.maximum(np.hypot(north, east), 1e-300)
    sine, cosine = np.sin(distance), np.cos(distance)
    height = cosine * np.sin(latitude) + north / distance * sine * np.cos(latitude)
    away = np.arctan2(east / distance * sine, cosine * np.cos(latitude) - north / distance * sine * np.sin(latitude))
    return np.degrees(np.arcsin(np.clip(height, -1.0, 1.0))), longitude_deg + np.degrees(away)


def fitting(ellipses: LandingEllipses | None, window: Window) -> list[EllipseShare]:
    """The ellipses that a window of the map holds whole: none round a pole, or over an edge of a close view."""
    return [one for one in ellipses.shares if _fits(ellipses, one, window)] if ellipses else []


def _fits(ellipses: LandingEllipses, one: EllipseShare, window: Window) -> bool:
    latitude, longitude = _on_map(ellipses, one, window)
    # The way once around the line ends a whole turn off where a pole is inside.
    turns = near(np.diff(longitude), 0.0).sum()
    inside = np.abs(latitude - window.latitude).max() <= window.half
    inside &= np.abs(longitude - window.longitude).max() <= window.half_longitude
    return bool(abs(turns) < 180.0 and inside)


def _on_map(ellipses: LandingEllipses, one: EllipseShare, window: Window) -> tuple[Array, Array]:
    """Latitude and longitude [deg] of the line of one ellipse, the latter within half a turn of a window."""
    middle = (ellipses.latitude_deg, ellipses.longitude_deg, ellipses.heading_deg)
    latitude, longitude = outline(*middle, one.semi_axes_deg)
    return latitude, near(longitude, window.longitude)


def draw_ellipses(axes: Axes, ellipses: LandingEllipses | None, window: Window, colour: str = SITE) -> None:
    """Draw the ellipses of the summary that a window of the map holds whole."""
    if ellipses is None:
        return
    for one in fitting(ellipses, window):
        latitude, longitude = _on_map(ellipses, one, window)
        # Where the line leaves the map on one side it comes back on the other, and must not be joined across.
        longitude[1:][np.abs(np.diff(longitude)) > 180.0] = np.nan
        style = ellipse_style(one.share)
        axes.plot(longitude, latitude, style, color="white", linewidth=2.6, zorder=4, alpha=0.8)
        axes.plot(longitude, latitude, style, color=colour, linewidth=1.2, zorder=5)
