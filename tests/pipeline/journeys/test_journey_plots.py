"""Figures of a study of journeys one by one: on axes of the caller, with the numbers of the summary."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from lithobrake.report.figures.ground_map import GroundMap
from lithobrake.results import StudyResults
from lithobrake.vocabulary.outcomes import JourneyEnd

NAMES = ("map", "ends", "times", "distances", "touchdowns", "contacts", "tilts", "sides", "variance", "rebounds")


@pytest.mark.parametrize("name", NAMES)
def test_a_figure_is_drawn_on_the_axes_that_are_given(name: str, journeys: StudyResults) -> None:
    axes = Figure().subplots()
    assert getattr(journeys.plot, name)(ax=axes) is axes
    assert axes.has_data()
    # The half of a body has a title in place of axes.
    assert axes.get_xlabel() or (name == "map" and axes.get_title())
    assert f"{name}()" in repr(journeys.plot)


def test_bars_of_the_ends_are_their_shares(journeys: StudyResults) -> None:
    axes = journeys.plot.ends(Figure().subplots())
    found = journeys.results.ends
    bars = dict(zip([label.get_text() for label in axes.get_yticklabels()], axes.patches, strict=True))
    for end, share in found.items():
        assert bars[JourneyEnd(end).label].get_width() == pytest.approx(100 * share.share.value)


def test_every_lander_on_the_ground_is_on_the_map(journeys: StudyResults) -> None:
    axes = journeys.plot.map(Figure().subplots())
    at_rest = journeys.journeys.where(journeys.journeys["end"] == "at_rest")
    drawn = np.concatenate([dots.get_offsets() for dots in axes.collections])
    site = journeys.results.site
    ground = GroundMap(site.latitude_deg, site.longitude_deg, float(np.linalg.norm(site.place_m)))
    for east, north in zip(*ground.places(at_rest["latitude_deg"], at_rest["longitude_deg"]), strict=True):
        assert np.min(np.hypot(drawn[:, 0] - east, drawn[:, 1] - north)) == pytest.approx(0.0, abs=1e-6)


def test_the_median_is_marked_where_half_of_the_landers_are_at_rest(journeys: StudyResults) -> None:
    axes = journeys.plot.distances(Figure().subplots())
    marks = [line.get_xydata()[0].tolist() for line in axes.lines if line.get_marker() == "o"]
    rest = journeys.results.rest.distance_m
    assert marks == [pytest.approx([rest.median.value, 50.0]), pytest.approx([rest.q95.value, 95.0])]


def test_bars_of_the_sides_that_are_down_are_their_shares(journeys: StudyResults) -> None:
    axes = journeys.plot.sides(Figure().subplots())
    widths = dict(zip((label.get_text() for label in axes.get_yticklabels()), axes.patches, strict=True))
    assert {name: bar.get_width() for name, bar in widths.items()} == pytest.approx(
        {name: 100 * one.share.value for name, one in journeys.results.rest.faces.items()}
    )
