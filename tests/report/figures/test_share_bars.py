"""Bars of shares: which are folded into one, and the room that each takes."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from lithobrake.report.figures.share_figures import ShareBar, draw_shares, folded, row_count
from lithobrake.vocabulary.estimate import Estimate


def bar(name: str, value: float, upper: float | None = 0.05, lower: float | None = 0.0) -> ShareBar:
    return ShareBar(name, Estimate(value, lower, upper))


def test_empty_bars_of_one_figure_are_one_and_come_last() -> None:
    bars = [bar("escaped", 0.0), bar("at rest", 1.0, 1.0, 0.95), bar("failed", 0.0), bar("lost", 0.0, 0.2)]
    found = folded(bars)
    assert [one.name for one in found] == ["at rest", "lost", "each of escaped, failed"]
    assert [one.words for one in found] == ["100 % (95-100 %)", "0 % (0-20 %)", "0 % (0-5 %)"]
    # A share that is not 0 stays, however small, and so does one that is 0 alone.
    few = [bar("escaped", 0.004), bar("failed", 0.0)]
    assert folded(few) == few


def test_a_name_of_several_lines_has_room_above_the_axis() -> None:
    ends = [bar(name, 0.0) for name in ("escaped", "at rest on Didymos", "under way", "failed")]
    bars = folded([bar("at rest", 1.0, 1.0, 0.95), *ends])
    lines = bars[-1].name.count("\n") + 1
    assert lines == 3
    assert row_count(bars) == pytest.approx(2.0 + 0.75 * (lines - 1))
    axes = Figure(figsize=(9.2, 0.75 + 0.2 * row_count(bars))).add_axes((0.2, 0.4, 0.6, 0.4))
    draw_shares(axes, bars, "all journeys")
    low, high = axes.get_ylim()
    assert high - low == pytest.approx(row_count(bars))
    first, last = axes.get_yticks()
    # Rows do not overlap: half of each lies between their middles.
    assert first - last == pytest.approx(0.5 * (1.0 + row_count([bars[-1]])))
    assert np.isclose(last - low, 0.5 * row_count([bars[-1]]))
