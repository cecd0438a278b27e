"""Ellipses of landing places on a map of latitude and longitude."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from lithobrake.report.density import Window, near
from lithobrake.report.site_mark import ellipse_style
from lithobrake.report.style import SITE

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


def draw_ellipses(axes: Axes, ellipses: Mapping[str, Any] | None, window: Window) -> None:
    """Draw the ellipses of the summary into a window of the map; none where there are none."""
    if ellipses is None:
        return
    middle = (ellipses["latitude_deg"], ellipses["longitude_deg"], ellipses["heading_deg"])
    for entry in ellipses["shares"]:
        latitude, longitude = outline(*middle, tuple(entry["semi_axes_deg"]))
        longitude = near(longitude, window.longitude)
        # Where the line leaves the map on one side it comes back on the other, and must not be joined across.
        longitude[1:][np.abs(np.diff(longitude)) > 180.0] = np.nan
        style = ellipse_style(entry["share"])
        axes.plot(longitude, latitude, style, color="white", linewidth=2.6, zorder=4, alpha=0.8)
        axes.plot(longitude, latitude, style, color=SITE, linewidth=1.2, zorder=5)
