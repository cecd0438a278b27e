"""Ellipses of landing places on a map of latitude and longitude."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from lithobrake.report.figures.density import Window, near
from lithobrake.report.figures.site_mark import ellipse_style
from lithobrake.report.figures.style import SITE

Array = NDArray[np.float64]
POINTS = 361
# Of half and 95 % of a Gaussian law in the plane: logarithm of the ratio of the squared sizes of their ellipses.
GAUSSIAN_RATIO = math.log(math.log(0.05) / math.log(0.5))
# Variance of that logarithm from a sample, times the number of places (delta method on two exponential quantiles).
RATIO_VARIANCE = 0.95 / 0.05 / math.log(0.05) ** 2 + 1.0 / math.log(0.5) ** 2 - 2.0 / (math.log(0.5) * math.log(0.05))
NINE_TENTHS = 1.645
# Departures of the ratio of both sizes by less than this are no matter [-].
TOLERANCE = 0.1


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


def follows_gaussian(ellipses: Mapping[str, Any] | None, count: int) -> bool:
    """Whether the ellipses of half and of 95 % of so many places have sizes as under a Gaussian law.

    Each holds its share by construction; a Gaussian law has one ratio of their sizes, 2.08, and where that of the
    places differs by more than 10 % and than chance (90 %), the larger holds another share than a Gaussian law says.
    Source: [Cramer-1946], chapter 28 (variances of sample quantiles).
    """
    sizes = {entry["share"]: entry["semi_axes_deg"][0] for entry in ellipses["shares"]} if ellipses else {}
    if not {0.5, 0.95} <= sizes.keys():
        return True
    departure = abs(2.0 * math.log(sizes[0.95] / sizes[0.5]) - GAUSSIAN_RATIO)
    return departure < max(2.0 * math.log1p(TOLERANCE), NINE_TENTHS * math.sqrt(RATIO_VARIANCE / count))


def fitting(ellipses: Mapping[str, Any] | None, window: Window) -> list[Mapping[str, Any]]:
    """The ellipses that a window of the map holds whole: none round a pole, or over an edge of a close view."""
    found = []
    for entry in ellipses["shares"] if ellipses else ():
        latitude, longitude = _on_map(ellipses, entry, window) if ellipses else (np.empty(0), np.empty(0))
        # The way once around the line ends a whole turn off where a pole is inside.
        turns = near(np.diff(longitude), 0.0).sum()
        inside = np.abs(latitude - window.latitude).max() <= window.half
        inside &= np.abs(longitude - window.longitude).max() <= window.half_longitude
        if abs(turns) < 180.0 and inside:
            found.append(entry)
    return found


def _on_map(ellipses: Mapping[str, Any], entry: Mapping[str, Any], window: Window) -> tuple[Array, Array]:
    """Latitude and longitude [deg] of the line of one ellipse, the latter within half a turn of a window."""
    middle = (ellipses["latitude_deg"], ellipses["longitude_deg"], ellipses["heading_deg"])
    latitude, longitude = outline(*middle, tuple(entry["semi_axes_deg"]))
    return latitude, near(longitude, window.longitude)


def draw_ellipses(axes: Axes, ellipses: Mapping[str, Any] | None, window: Window) -> None:
    """Draw the ellipses of the summary that a window of the map holds whole."""
    for entry in fitting(ellipses, window):
        assert ellipses is not None
        latitude, longitude = _on_map(ellipses, entry, window)
        # Where the line leaves the map on one side it comes back on the other, and must not be joined across.
        longitude[1:][np.abs(np.diff(longitude)) > 180.0] = np.nan
        style = ellipse_style(entry["share"])
        axes.plot(longitude, latitude, style, color="white", linewidth=2.6, zorder=4, alpha=0.8)
        axes.plot(longitude, latitude, style, color=SITE, linewidth=1.2, zorder=5)
