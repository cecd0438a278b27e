"""A journey on one sheet: the map of its way, and pictures of each touchdown below each other."""

import io
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from lithobrake.report.figures.hulls import scene
from lithobrake.report.figures.landing_figure import landing_figure
from lithobrake.report.figures.style import INK, figure_style
from lithobrake.report.figures.track_map import SIZE, track_map
from lithobrake.results import JourneyMotion
from lithobrake.vocabulary.plain_text import wrapped

# Of each touchdown.
PICTURES = 4
# Characters on a line of a caption, and its height [inch].
LINE, LINE_HEIGHT = 118, 0.2


def journey_sheet(motion: JourneyMotion) -> bytes:
    """The sheet as a PNG."""
    from PIL import Image

    track = motion.track
    with figure_style():
        figures = [caption(f"Journey {track.number}. {track.end_words}"), track_map(track)]
        for facts, bodies in zip(track.touchdowns, motion.bodies, strict=False):
            figures += [caption(facts.words), landing_figure(scene(bodies, has_lander=True), PICTURES)]
        strips = [picture(figure) for figure in figures]
    width = max(strip.shape[1] for strip in strips)
    padding = [((0, 0), (0, width - strip.shape[1]), (0, 0)) for strip in strips]
    whole = [np.pad(strip, pad, constant_values=255) for strip, pad in zip(strips, padding, strict=True)]
    memory = io.BytesIO()
    Image.fromarray(np.concatenate(whole)).save(memory, "PNG")
    return memory.getvalue()


def picture(figure: Figure, dpi: float | None = None) -> np.ndarray:
    """A figure as pixels, shape [height, width, 3]."""
    from PIL import Image

    memory = io.BytesIO()
    figure.savefig(memory, format="png", dpi=dpi or matplotlib.rcParams["savefig.dpi"])
    return np.asarray(Image.open(memory).convert("RGB"))


def caption(words: str, size: tuple[float, float] | None = None) -> Figure:
    """Words on a strip of a size [inch], or as wide as the figures and as high as they need."""
    text = wrapped(words[:1].upper() + words[1:], LINE)
    figure = Figure(figsize=size or (SIZE[0], LINE_HEIGHT * (text.count("\n") + 2)))
    style: dict[str, Any] = {"fontsize": 10, "color": INK, "va": "center"}
    figure.text(0.01, 0.45, text, **style)
    return figure
