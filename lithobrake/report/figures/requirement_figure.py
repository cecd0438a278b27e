"""The admissible region of a requirement over its deliveries, with the edge and the interval of that."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from lithobrake.report.figures.style import INK, QUIET, TEST, TRAINING, WASH
from lithobrake.results.requirement_results import RequiredDelivery, Requirement
from lithobrake.statements.labels import input_label
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.number_words import at_level, number, percent
from lithobrake.vocabulary.requirement import Verdict

# Dark, middle and light, so that they are told apart in grey.
COLOURS = {Verdict.MET: TRAINING, Verdict.OPEN: TEST, Verdict.NOT_MET: WASH, Verdict.OUTSIDE: "white"}
WORDS = {
    Verdict.MET: "met",
    Verdict.OPEN: "open: the interval holds the required probability",
    Verdict.NOT_MET: "not met",
    Verdict.OUTSIDE: "outside the training range",
}
HATCH = "////"
# As wide as every other figure of the page [inches], and at most so many panels beside each other.
WIDTH, HEIGHT, MOST_PANELS = 9.2, 3.7, 3


def requirement_figure(found: Requirement) -> Figure:
    """Draw a curve over one parameter, a map over two, and a map for each value of a third."""
    if len(found.names) == 1:
        return _curve(found)
    panels = found.grid[2] if len(found.names) > 2 else (None,)
    rows, columns = -(-len(panels) // MOST_PANELS), min(len(panels), MOST_PANELS)
    height = HEIGHT if rows == 1 else 2.5 * rows + 0.5
    figure = Figure(figsize=(WIDTH, height + 0.5), layout="constrained")
    grid = np.atleast_2d(figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)).ravel()
    for axes, panel in zip(grid, panels, strict=False):
        _map(axes, found, [one for one in found.deliveries if panel is None or one.values[2] == panel])
        if panel is not None:
            axes.set_title(f"{input_label(found.names[2])} = {number(panel)} {found.units[2]}".rstrip())
    for axes in grid[len(panels) :]:
        axes.remove()
    for place, axes in enumerate(grid[: len(panels)]):
        if place + columns >= len(panels):
            axes.set_xlabel(_label(found, 0))
            axes.tick_params(labelbottom=True)
        if place % columns == 0:
            axes.set_ylabel(_label(found, 1))
    _legend(figure, found, is_map=True)
    return figure


def _map(axes: Axes, found: Requirement, deliveries: Sequence[RequiredDelivery]) -> None:
    """A cell for each delivery, and the edge by the probability and by both ends of its interval."""
    across, up = (np.array(values) for values in found.grid[:2])
    left, bottom = _borders(across), _borders(up)
    fields = np.full((3, len(up), len(across)), np.nan)
    for one in deliveries:
        column, row = int(np.argmin(abs(across - one.values[0]))), int(np.argmin(abs(up - one.values[1])))
        size = left[column + 1] - left[column], bottom[row + 1] - bottom[row]
        is_outside = one.verdict is Verdict.OUTSIDE
        axes.add_patch(
            Rectangle(
                (left[column], bottom[row]), *size, facecolor=COLOURS[one.verdict], edgecolor=QUIET if is_outside
                else "white", linewidth=0.0 if is_outside else 0.6, hatch=HATCH if is_outside else None,
            )
        )  # fmt: skip
        if not is_outside and one.probability.bounds is not None:
            fields[:, row, column] = one.probability.value, *one.probability.bounds
    for field, line in zip(fields, ("solid", "dashed", "dashed"), strict=True):
        # Without a crossing there is no line, and matplotlib would warn.
        if np.nanmin(field, initial=np.inf) < found.required <= np.nanmax(field, initial=-np.inf):
            width = 1.8 if line == "solid" else 1.1
            axes.contour(across, up, field, [found.required], colors=INK, linestyles=line, linewidths=width)
    axes.set(xlim=(left[0], left[-1]), ylim=(bottom[0], bottom[-1]))


def _curve(found: Requirement) -> Figure:
    """The probability over one parameter with its interval, in the colours of the verdicts."""
    figure = Figure(figsize=(WIDTH, HEIGHT), layout="constrained")
    axes = figure.subplots()
    x = np.array(found.grid[0])
    borders = _borders(x)
    for place, one in enumerate(found.deliveries):
        is_outside = one.verdict is Verdict.OUTSIDE
        axes.axvspan(
            borders[place], borders[place + 1], facecolor=COLOURS[one.verdict], alpha=0.4, linewidth=0.0,
            hatch=HATCH if is_outside else None, edgecolor=QUIET,
        )  # fmt: skip
    known = [one.probability if one.verdict is not Verdict.OUTSIDE else None for one in found.deliveries]
    value, lower, upper = (
        100.0 * np.array([np.nan if one is None or one.bounds is None else end(one) for one in known])
        for end in (lambda one: one.value, lambda one: one.lower, lambda one: one.upper)
    )
    axes.fill_between(x, lower, upper, facecolor="white", alpha=0.75, linewidth=0.0)
    for end in (lower, upper):
        axes.plot(x, end, color=INK, linewidth=1.1, linestyle="dashed")
    axes.plot(x, value, color=INK, linewidth=1.8)
    axes.axhline(100.0 * found.required, color=QUIET, linewidth=1.1, linestyle="dotted")
    axes.set(xlim=(borders[0], borders[-1]), ylim=(0.0, 102.0))
    axes.set_xlabel(_label(found, 0))
    axes.set_ylabel(f"probability of {found.name} [%]")
    _legend(figure, found, is_map=False)
    return figure


def _legend(figure: Figure, found: Requirement, *, is_map: bool) -> None:
    seen = {one.verdict for one in found.deliveries}
    handles: list[Patch | Line2D] = [
        Patch(
            facecolor=COLOURS[verdict], edgecolor=QUIET, linewidth=0.6, label=WORDS[verdict],
            hatch=HATCH if verdict is Verdict.OUTSIDE else None, alpha=1.0 if is_map else 0.6,
        )
        for verdict in COLOURS if verdict in seen
    ]  # fmt: skip
    what = f"probability of {percent(found.required)}" if is_map else "probability"
    handles += [
        Line2D([], [], color=INK, linewidth=1.8, label=what),
        Line2D([], [], color=INK, linewidth=1.1, linestyle="dashed", label=f"ends of its {at_level(found.level)}"),
    ]
    if not is_map:
        handles.append(Line2D([], [], color=QUIET, linewidth=1.1, linestyle="dotted", label="required"))
    figure.legend(handles=handles, loc="outside upper center", ncols=3)


def _label(found: Requirement, number_of: int) -> str:
    return input_label(found.names[number_of], found.units[number_of])


def _borders(values: Floats) -> Floats:
    """Borders of cells about values, [count + 1]."""
    middles = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[1.5 * values[0] - 0.5 * values[1]], middles, [1.5 * values[-1] - 0.5 * values[-2]]])
