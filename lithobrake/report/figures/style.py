"""How every figure looks: colours that colour-blind readers tell apart, one type size, names and units of outputs."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib
import numpy as np
from numpy.typing import NDArray

INK = "#1c2733"
QUIET = "#66717d"
RULE = "#c9ced4"
WASH = "#f5f7f9"
GRAIN = "#c9b699"
LANDER = "#3f83c8"
TRAINING = "#2f6fb0"
TEST = "#e2a13b"
TEST_ALL = "#8b8f96"
SITE = "#c8442b"
# Okabe and Ito's set in an order that keeps neighbours apart; grey is left to the interactions.
INPUT_COLOURS = (
    "#2f6fb0",
    "#e69f00",
    "#1f9e78",
    "#c8553d",
    "#a8659a",
    "#6fb7e0",
    "#d9cb3f",
    "#7a5c3e",
    "#31465a",
    "#98b06f",
)
INTERACTIONS = "#d5d8dc"

# Any: the names of the settings are a type of their own in some versions of matplotlib and plain words in others.
STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.edgecolor": QUIET,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": False,
    "axes.axisbelow": True,
    "grid.color": "#e6e9ec",
    "grid.linewidth": 0.6,
    "xtick.color": QUIET,
    "ytick.color": QUIET,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "text.color": INK,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "figure.dpi": 100,
    "savefig.dpi": 170,
    "mathtext.fontset": "dejavusans",
    # Names inside an SVG file are made of this and the content, not of chance.
    "svg.hashsalt": "lithobrake",
}


def input_colours(names: tuple[str, ...]) -> dict[str, str]:
    """One colour an input, the same in every figure of the page."""
    return {name: INPUT_COLOURS[index % len(INPUT_COLOURS)] for index, name in enumerate(names)}


def shade(colour: str, light: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colour times light, shape [count, 3]; light above 1 moves towards white instead of clipping to a flat patch."""
    base = np.array(matplotlib.colors.to_rgb(colour))
    dark = base[None, :] * np.minimum(light, 1.0)[:, None]
    glow = np.clip(light - 1.0, 0.0, 1.0)[:, None]
    result: NDArray[np.float64] = np.clip(dark + (1.0 - dark) * glow, 0.0, 1.0)
    return result


@contextmanager
def figure_style() -> Iterator[None]:
    """Apply the look while a figure is made; the caller's own settings of matplotlib stay untouched."""
    with matplotlib.rc_context(STYLE):
        yield
