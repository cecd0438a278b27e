"""Which inputs matter, as rings of first-order Sobol indices."""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from lithobrake.report.figures.style import INTERACTIONS, QUIET, input_colours
from lithobrake.report.words.labels import PAPER_OUTPUTS, input_label, output
from lithobrake.report.words.numbers import number

Array = NDArray[np.float64]


def sobol_figure(
    input_names: tuple[str, ...],
    sobol_first: dict[str, Array],
    spread: Mapping[str, float],
    scatter: dict[str, float | None],
) -> Figure:
    """Draw one ring an output; what is left of the whole belongs to interactions.

    sobol_first: output name to indices, shape [input]; spread: output name to standard deviation of the expansion [SI];
    scatter: output name to the share of the runs' variance that is scatter, None where that is not known.
    """
    names = [name for name in PAPER_OUTPUTS if name in sobol_first]
    colours = input_colours(input_names)
    handles = [Patch(color=colours[key], label=input_label(key)) for key in input_names]
    handles.append(Patch(color=INTERACTIONS, label="interactions"))
    columns = 3 if len(handles) > 4 else len(handles)
    # In inches: the rings with their titles, and a row of the legend for every three inputs.
    legend = 0.16 + 0.172 * -(-len(handles) // columns)
    height = 3.34 + legend
    figure = Figure(figsize=(9.2, height))
    for column, name in enumerate(names):
        place = (0.01 + column / len(names), legend / height, 0.98 / len(names), 3.0 / height)
        axes = figure.add_axes(place)
        _ring(axes, name, sobol_first[name], [colours[key] for key in input_names], spread[name])
        share = scatter[name]
        if share is not None:
            words = f"scatter: {100 * share:.0f} % of\nthe runs' variance"
            axes.text(0, -0.27, words, ha="center", va="top", fontsize=7, color=QUIET)
    figure.legend(handles=handles, loc="lower center", ncols=columns, handlelength=1.0, handleheight=1.0)
    return figure


def _ring(axes: Axes, name: str, first: Array, colours: list[str], spread: float) -> None:
    """One ring with the share in per cent on every piece that has room for it."""
    shown = output(name)
    axes.set_title(f"{shown.words} {shown.symbol}".strip(), loc="center")
    if spread == 0.0:
        axes.set(aspect="equal", xlim=(-1.05, 1.05), ylim=(-1.05, 1.05))
        axes.axis("off")
        axes.text(0, 0, "no significant\ninput", ha="center", va="center", color=QUIET)
        return
    shares = np.append(np.clip(first, 0.0, None), max(0.0, 1.0 - float(np.sum(first))))
    wedges, *_ = axes.pie(
        shares,
        colors=[*colours, INTERACTIONS],
        startangle=90,
        counterclock=False,
        radius=1.0,
        wedgeprops={"width": 0.40, "edgecolor": "white", "linewidth": 1.2},
    )
    for wedge, share in zip(wedges, shares / shares.sum(), strict=True):
        if share < 0.035:
            continue
        angle = np.radians(0.5 * (wedge.theta1 + wedge.theta2))
        dark = sum(wedge.get_facecolor()[k] * weight for k, weight in enumerate((0.3, 0.59, 0.11))) < 0.62
        axes.text(
            0.8 * np.cos(angle),
            0.8 * np.sin(angle),
            f"{100 * share:.0f} %",
            ha="center",
            va="center",
            fontsize=8,
            fontweight="bold",
            color="white" if dark else "#1c2733",
        )
    axes.text(0, 0.06, number(spread * shown.factor, 2), ha="center", va="center", fontsize=12, fontweight="bold")
    axes.text(0, -0.16, f"{shown.unit} spread", ha="center", va="center", fontsize=7.5, color=QUIET)
    # A pie sets limits of its own.
    axes.set(xlim=(-1.05, 1.05), ylim=(-1.05, 1.05))
