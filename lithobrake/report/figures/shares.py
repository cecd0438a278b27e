"""Shares of outcomes as bars, with their intervals."""

from dataclasses import dataclass
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes

from lithobrake.report.figures.style import INK, TRAINING
from lithobrake.vocabulary.percentages import LEVEL, percent, with_interval

# Letters of a line below the axis: it is narrow, and stands at the edge of some figures.
LONGEST = 56


@dataclass(frozen=True)
class Share:
    """A share of the samples with its interval, if it has one, all in [0, 1]; upper alone: no run had it.

    level: probability that the interval stands for; colour: of its bar; digits: of its figure in per cent where it has
    no interval.
    """

    name: str
    share: float
    lower: float | None = None
    upper: float | None = None
    level: float = LEVEL
    colour: str = TRAINING
    digits: int = 0

    @property
    def words(self) -> str:
        """The share in per cent, with its interval or its limit."""
        if self.lower is None and self.upper is not None:
            return f"at most {percent(self.upper, 1)}"
        return with_interval(self, self.digits)


def draw_shares(axes: Axes, shares: list[Share], whole: str) -> None:
    """One bar an outcome, the interval of a share that has one, and in the margin to the right its figure in per cent.

    whole: what they are shares of, "all samples".
    """
    place = np.arange(len(shares))[::-1]
    words = f"share of {whole} [%]"
    for y, share in zip(place, shares, strict=True):
        axes.barh(y, 100 * share.share, color=share.colour, height=0.68)
        if share.upper is not None:
            ends = [100 * (share.lower or 0.0), 100 * share.upper]
            # At the very ends of the axis a clipped line would look as if there were no interval.
            axes.plot(ends, [y, y], color=INK, linewidth=1.4, solid_capstyle="butt", clip_on=False)
        if share.lower is not None:
            words = f"share of {whole} [%], with {percent(share.level)} interval"
        axes.text(1.025, y, share.words, transform=axes.get_yaxis_transform(), va="center_baseline", fontsize=8)
    axes.set_yticks(place, [share.name for share in shares])
    axes.set_xlim(0, 100)
    axes.set_xticks(range(0, 101, 20))
    axes.set_xlabel(fill(words, LONGEST))
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
