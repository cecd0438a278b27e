"""The body with the impacts of landers on its facets."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter
from scipy.spatial import cKDTree

from lithobrake.report.figures.ground_map import SITE_STYLE, density_colours, mark_site
from lithobrake.report.figures.hulls import Camera, frame_axes
from lithobrake.report.figures.map_frames import draw_bar
from lithobrake.vocabulary.array_types import Array, Integers
from lithobrake.vocabulary.outcomes import FATE_COLOURS, FlightStatus

# Impacts are counted within this share of the body's radius, or on a facet alone where facets are larger.
REACH = 0.1
HECTARE = 1e4
BARE = np.array(to_rgb("#d9d5cc"))
COLOURS = density_colours(FATE_COLOURS[FlightStatus.IMPACT])
# Where the light comes from in every view: right, up, towards the viewer.
LIGHT = np.array([-0.5, 0.6, 0.62])


def body_figure(vertices: Array, faces: Integers, facet: Integers, site: Array) -> Figure:
    """Draw the body from above the site, from the other side, and along its axis.

    vertices [m], shape [vertex, 3]; faces [face, 3], counter-clockwise from outside; facet: the one that each impact
    hit, [impact]; site: on the surface [m], [3].
    """
    figure = Figure(figsize=(9.2, 2.55))
    corners = vertices[faces]
    density = facet_density(corners, facet)
    norm = LogNorm(*colour_ends(density))
    longitude = float(np.degrees(np.arctan2(site[1], site[0])))
    latitude = float(np.degrees(np.arctan2(site[2], np.hypot(site[0], site[1]))))
    views = {
        "above the site": (longitude, latitude),
        "the other side": (longitude + 180.0, -latitude),
        "from the north": (longitude, 90.0),
        "from the south": (longitude, -90.0),
    }
    reach = float(np.linalg.norm(vertices, axis=1).max())
    for number, (title, (azimuth, elevation)) in enumerate(views.items()):
        axes = figure.add_axes((0.005 + 0.227 * number, 0.02, 0.222, 0.88))
        camera = Camera((0.0, 0.0, 0.0), azimuth, elevation, 1e3 * reach)
        _paint(axes, corners, density, norm, camera)
        if number == 0 or site @ camera.axes()[2] > 0.3 * np.linalg.norm(site):
            mark_site(axes, *camera.project(site)[0])
        frame_axes(axes, (-1.04 * reach, 1.04 * reach), (-1.04 * reach, 1.04 * reach))
        axes.set_title(title, loc="center", fontsize=9)
        if number == len(views) - 1:
            draw_bar(axes, 2.08 * reach)
    mark = Line2D([], [], linestyle="none", label="aim point", **{**SITE_STYLE, "markersize": 11})
    figure.legend(handles=[mark], loc="lower left", bbox_to_anchor=(0.01, 0.01), borderpad=0.0)
    bar = figure.colorbar(ScalarMappable(norm, COLOURS), cax=figure.add_axes((0.915, 0.14, 0.013, 0.68)), format="%g")
    # Next to a single decade the ticks between would be named too, and push the label off the figure.
    bar.ax.yaxis.set_minor_formatter(NullFormatter())
    bar.set_label("impacts per hectare", labelpad=2.0)
    outline: Any = bar.outline
    outline.set_visible(False)
    return figure


def facet_density(corners: Array, facet: Integers) -> Array:
    """Impacts per area [1/ha] of each facet and what lies around it, shape [face].

    corners [m], shape [face, 3, 3]; facet: the one that each impact hit, [impact].
    """
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    count = np.bincount(facet, minlength=len(corners)).astype(float)
    middles = corners.mean(axis=1)
    around = cKDTree(middles).query_ball_point(middles, REACH * float(np.linalg.norm(middles, axis=1).max()))
    hits, ground = (np.array([given[near].sum() for near in around]) for given in (count, area))
    density: Array = hits / ground * HECTARE
    return density


def colour_ends(density: Array) -> tuple[float, float]:
    """Ends of the colour scale: from the rarest impact to the densest place, at least a decade."""
    hit = density[density > 0.0]
    if not len(hit):
        return 1.0, 10.0
    return min(float(hit.min()), 0.1 * float(hit.max())), float(hit.max())


def _paint(axes: Axes, corners: Array, density: Array, norm: LogNorm, camera: Camera) -> None:
    """Paint the facets that look at the viewer, from far to near, darker where they turn away from the light."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    turned = normals @ camera.axes().T
    seen = np.flatnonzero(turned[:, 2] > 0.0)
    order = seen[np.argsort((corners[seen].mean(axis=1) @ camera.axes()[2]), kind="stable")]
    hit = density[order] > 0.0
    colours = np.where(hit[:, None], COLOURS(norm(density[order]))[:, :3], BARE)
    # Weak, so that a colour can still be read off its bar.
    light = 0.78 + 0.22 * np.clip(turned[order] @ (LIGHT / np.linalg.norm(LIGHT)), 0.0, None)
    colours = colours * light[:, None]
    stack: Any = camera.project(corners[order])[0]
    axes.add_collection(PolyCollection(stack, facecolors=colours, edgecolors=colours, linewidths=0.3, rasterized=True))
