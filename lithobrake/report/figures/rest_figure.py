"""Where landers rest after bounce upon bounce: on the soil, and beside it on hard ground."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from matplotlib.figure import Figure

from lithobrake.report.figures.density import cell_counts, density_norm
from lithobrake.report.figures.place_map import PlaceMap, Places, Regions, draw_local
from lithobrake.report.figures.shares import Share, draw_shares


@dataclass(frozen=True)
class RestMap:
    """One side of the figure: where landers rest, the regions that hold them, and shares.

    whole: what the shares are shares of.
    """

    title: str
    places: Places
    regions: Regions
    shares: list[Share]
    whole: str


def rest_figure(maps: Sequence[RestMap], aim: tuple[float, float], radius: float) -> Figure:
    """Draw the maps side by side, over one and the same part of the body, and what became of the landers below them.

    aim: latitude and longitude [deg]; radius: of the body there [m]. Where no lander rests, or places lie all around
    the body, the shares alone are drawn.
    """
    together = PlaceMap([one.places for one in maps], [one.regions for one in maps], aim, radius)
    panel = together.panel() if any(len(one.places.latitude) for one in maps) else None
    # In inches: the maps, a row for each bar, and the axis below the bars.
    rows, maps_height, row_height, below = max(len(one.shares) for one in maps), 4.5 if panel else 0.35, 0.2, 0.5
    height = maps_height + row_height * rows + below
    figure = Figure(figsize=(9.2, height))
    for side, one in enumerate(maps):
        figure.text(0.07 + 0.5 * side, 1.0 - 0.16 / height, one.title, weight="bold", fontsize=9.5, va="center")
        if panel:
            axes = figure.add_axes((0.07 + 0.5 * side, 1.0 - 3.85 / height, 0.38, 3.5 / height))
            places = (one.places.latitude, one.places.longitude)
            norm = density_norm([cell_counts(together.ground, places, panel)[0]])
            draw_local(axes, replace(together, places=[one.places], regions=[one.regions]), panel, norm)
        share = row_height * len(one.shares) / height
        bars = figure.add_axes((0.135 + 0.5 * side, 1.0 - maps_height / height - share, 0.18, share))
        draw_shares(bars, one.shares, one.whole)
    return figure
