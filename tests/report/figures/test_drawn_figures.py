"""The figures of a drawn study show what they are given: bars that add up, counts, and what luck does not explain."""

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure

from lithobrake.report.figures.model_figures import calibration_figure
from lithobrake.report.figures.run_figures import LandingsOfRuns, pieces, runs_figure, variance_figure
from lithobrake.report.figures.style import TEST, TRAINING, figure_style
from lithobrake.report.words.captions import band_luck, luck
from lithobrake.results.model_results import OutputScore
from lithobrake.results.run_results import VarianceParts
from lithobrake.vocabulary.estimate import Estimate


def part(share: float) -> Estimate:
    return Estimate(share, max(share - 0.05, 0.0), min(share + 0.05, 1.0))


RECORD = VarianceParts(
    soil=part(0.12), soil_doubled=part(0.35), terms="terms of first degree",
    soil_by_input={"grain.friction": part(0.15), "grain.density": part(-0.01)}, arrival=part(0.2),
    attitude=part(0.08), bed=part(0.0), place=part(0.6), chaos=None, of="the landings",
)  # fmt: skip


def words_of(figure: Figure) -> list[str]:
    """All words of a figure."""
    found = [text.get_text() for axes in figure.axes for text in [*axes.texts, *axes.get_yticklabels()]]
    return found + [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def test_the_pieces_of_a_bar_add_up_to_the_whole_and_none_is_below_0() -> None:
    found = pieces(RECORD, {"grain.friction": "red", "grain.density": "blue"})
    assert sum(piece.share for piece in found) == pytest.approx(1.0)
    alone = {piece.name: piece.share for piece in found}
    assert min(alone.values()) == 0.0
    # Inputs alone are no more than the soil is.
    assert (alone["grain.friction"], alone["interactions"]) == pytest.approx((0.12, 0.0))
    assert "chaos" not in alone
    with figure_style():
        figure = variance_figure({"speed_out": RECORD}, {}, 0.9)
    bars = figure.axes[0].patches
    assert max(bar.get_x() + bar.get_width() for bar in bars) == pytest.approx(1.0)


def test_every_part_has_its_interval_and_an_output_that_is_not_known_says_so() -> None:
    with figure_style():
        figure = variance_figure({"speed_out": RECORD, "returns": None}, {"returns": "return fraction"}, 0.9)
    words = words_of(figure)
    assert "not separable from these runs" in words
    assert "return fraction" in words
    for found in ("12 % (7-17 %)", "20 % (15-25 %)", "not detected (0-5 %)", "60 % (55-65 %)", "8 % (3-13 %)"):
        assert found in words
    # On the left of its interval, and in the legend.
    assert words.count("everything else, chaos") == 1
    assert "everything else (impact point, interactions, chaos)" in words
    assert "chaos" not in words


def test_bars_beyond_luck_have_another_colour() -> None:
    scores = {"speed_out": OutputScore(0.1, 0.7, (30, 5, 9, 10, 10, 10, 10, 10, 6, 0))}
    with figure_style():
        figure = calibration_figure(scores)
    low, high = luck([10] * 10)
    assert (low, high) == pytest.approx((10 - 1.645 * 3.0, 10 + 1.645 * 3.0))
    beyond = matplotlib.colors.to_rgb(TEST)
    bars = [bar for bar in figure.axes[0].patches if bar.get_width() == pytest.approx(0.1)]
    assert [bar.get_facecolor()[:3] == beyond for bar in bars] == [True, True, *[False] * 7, True]
    assert len(figure.axes) == 2
    dots = [line.get_color() for line in figure.axes[1].lines if line.get_marker() == "o"]
    assert dots == [TEST]
    assert "$V^+$: 70 %" in words_of(figure)


def test_a_band_that_luck_explains_is_as_it_should_be() -> None:
    scores = {"spin_out": OutputScore(0.1, 0.88, (10,) * 10)}
    with figure_style():
        figure = calibration_figure(scores)
    assert [line.get_color() for line in figure.axes[1].lines if line.get_marker() == "o"] == [TRAINING]
    assert band_luck(100) == pytest.approx((0.9 - 1.645 * 0.03, 0.9 + 1.645 * 0.03))


def landings() -> LandingsOfRuns:
    """Six landers on two beds, of which one was captured and two have no answer; one left over the rim in flight."""
    return LandingsOfRuns(
        speed=np.array([0.05, 0.08, 0.2, np.nan, np.nan, np.nan]),
        elevation=np.radians([30.0, 40.0, 10.0, np.nan, np.nan, np.nan]),
        outcome=np.array(["clear", "clear", "clear", "captured", "time_limit", "failed"]),
        over_rim=np.array([False, False, True, False, False, False]),
        bed=np.array([0, 1, 1, 0, 1, 1]),
    )


def test_every_landing_is_a_dot_or_is_counted() -> None:
    quantiles = {name: {"0.05": 0.04, "0.5": 0.08, "0.95": 0.2} for name in ("speed_out", "elevation_out")}
    with figure_style():
        figure = runs_figure(landings(), quantiles)
    left, right = figure.axes
    dots, rings = left.collections
    np.testing.assert_allclose(dots.get_offsets(), [(0.05, 30.0), (0.08, 40.0), (0.2, 10.0)])
    np.testing.assert_allclose(rings.get_offsets(), [(0.2, 10.0)])
    assert [text.get_text() for text in right.texts] == ["captured", "1", "unknown\noutcome", "2"]
    assert [text.get_position()[1] for text in right.texts if text.get_text() in "12"] == [0, 1]
    # Three lines of the speed in both panels, three of the elevation, and one where a speed is 0.
    assert (len(left.lines), len(right.lines)) == (6, 4)
    assert words_of(figure).count("median") == 2


def test_landings_of_which_none_leaves_are_counted_without_a_column_that_is_empty() -> None:
    none = landings()
    captured = LandingsOfRuns(none.speed * np.nan, none.elevation, np.full(6, "captured"), none.over_rim, none.bed)
    with figure_style():
        figure = runs_figure(captured, {})
    assert [text.get_text() for text in figure.axes[1].texts] == ["captured", "2", "4"]
