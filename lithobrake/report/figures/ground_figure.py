"""How journeys end against the size of the grains, with the grounds that the study allows below."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lithobrake.report.figures.share_figures import AT_REST
from lithobrake.report.figures.style import INK, QUIET
from lithobrake.results.ground_results import GroundCurve
from lithobrake.results.run_results import Share
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.outcomes import END_COLOURS, FATE_COLOURS, FlightStatus, JourneyEnd

# Of kinds of ground, and of the axes of the lander.
MARKERS = "osD^vP"
COLOURS = (END_COLOURS[JourneyEnd.AT_REST], FATE_COLOURS[FlightStatus.IMPACT], FATE_COLOURS[FlightStatus.ESCAPED])
TICKS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)
# Areas of the marker of a bed, for one journey [points2].
AREA = 9.0


def ground_figure(
    curve: GroundCurve, ranges: Mapping[str, tuple[float, float]], unit: str, factor: float
) -> Figure:  # fmt: skip
    """Draw fraction at rest, median time and sides down against the mean grain diameter.

    ranges: from where to where the sizes of each kind reach [m]; unit: of times, which are factor seconds.
    """
    height = 2.9 + 0.2 * len(ranges)
    figure = Figure(figsize=(9.2, height))
    below = (0.62 + 0.2 * len(ranges)) / height
    size = np.array(curve.grain_size_m)
    titles = ("at rest [%]", f"median time to rest [{unit}]", "upright axis [% of those at rest]")
    panels = [figure.add_axes((0.065 + 0.325 * place, below, 0.27, 1.0 - below - 0.3 / height)) for place in range(3)]
    for axes, title in zip(panels, titles, strict=True):
        axes.set_xscale("log")
        axes.set_title(title, fontsize=9, loc="left")
        axes.grid(visible=True)
        axes.set_xlim(size[0] / 1.12, size[-1] * 1.12)
        ticks = [one for one in TICKS if size[0] / 1.12 <= one <= size[-1] * 1.12]
        axes.set_xticks(ticks, [f"{one:g}" for one in ticks])
        axes.xaxis.set_minor_formatter("")
    _line(panels[0], size, curve.at_rest, 100.0)
    _line(panels[1], size, curve.time_s, 1.0 / factor)
    for (axis, one), colour in zip(sorted(curve.axes.items()), COLOURS, strict=False):
        _line(panels[2], size, one, 100.0, colour, axis)
    for number, kind in enumerate(ranges):
        own = [bed for bed in curve.beds if bed.kind == kind]
        at, area = [bed.grain_size_m for bed in own], [AREA * bed.journeys for bed in own]
        times = [np.nan if bed.time_s is None else bed.time_s / factor for bed in own]
        for axes, values in ((panels[0], [100.0 * bed.at_rest for bed in own]), (panels[1], times)):
            axes.scatter(
                at, values, area, marker=MARKERS[number % len(MARKERS)], facecolor="none", edgecolor=QUIET,
                linewidth=0.9, zorder=2,
            )  # fmt: skip
    panels[0].set_ylim(-3.0, 104.0)
    panels[1].set_ylim(bottom=0.0)
    panels[2].set_ylim(-3.0, 104.0)
    if curve.axes:
        panels[2].legend(fontsize=8, loc="best", ncols=3)
    for axes in panels:
        _draw_ranges(axes, ranges, curve)
    figure.text(0.5, 0.06 / height, "mean diameter of the grains [m]", ha="center", fontsize=9)
    return figure


def _line(
    axes: Axes, size: Array, curve: tuple[Share, ...], factor: float, colour: str = AT_REST, label: str | None = None
) -> None:
    """A curve, and its bounds as a band."""
    lower, value, upper = (
        [np.nan if end is None else factor * end for end in ends]
        for ends in zip(*((one.lower, one.value, one.upper) for one in curve), strict=True)
    )
    axes.fill_between(size, lower, upper, color=colour, alpha=0.16, linewidth=0.0)
    axes.plot(size, value, color=colour, linewidth=1.6, label=label)


def _draw_ranges(axes: Axes, ranges: Mapping[str, tuple[float, float]], curve: GroundCurve) -> None:
    """Below an axis the sizes that each kind allows, a line each with the beds on it as marks."""
    for number, (kind, (low, high)) in enumerate(ranges.items()):
        place = -0.19 - 0.1 * number
        trans = axes.get_xaxis_transform()
        axes.plot([low, high], [place, place], color=INK, linewidth=1.2, transform=trans, clip_on=False)
        own = [bed.grain_size_m for bed in curve.beds if bed.kind == kind]
        axes.plot(
            own, np.full(len(own), place), "|", color=INK, markersize=6, markeredgewidth=1.0, transform=trans,
            clip_on=False,
        )  # fmt: skip
        if axes is axes.figure.axes[0]:
            axes.text(-0.02, place, kind, ha="right", va="center_baseline", fontsize=8, transform=axes.transAxes)
