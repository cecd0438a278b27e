"""Areas of limit states on maps: circles about the aim point, bounds of latitude and longitude, and their parts."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from lithobrake.report.figures.ground_map import GroundMap, MapPanel
from lithobrake.report.figures.limit_areas import circles, draw_areas
from lithobrake.vocabulary.limit_state import LimitState

AIM, RADIUS = (10.0, -60.0), 80.0
GROUND = GroundMap(*AIM, RADIUS)


def edge(text: str, half: float = 60.0) -> tuple[np.ndarray, np.ndarray]:
    """Latitudes and longitudes [deg] along the edge that is drawn; none where it lies outside of the map."""
    axes = Figure().subplots()
    draw_areas(axes, {"one": LimitState.of(text)}, AIM, GROUND, MapPanel(0.0, 0.0, half))
    lines = [path.vertices for drawn in axes.collections for path in drawn.get_paths() if len(path.vertices)]
    places = np.concatenate(lines) if lines else np.empty((0, 2))
    return GROUND.back(*places.T)


def distance(latitude: np.ndarray, longitude: np.ndarray) -> np.ndarray:
    """Arcs from the aim point on the ball [m]."""
    return RADIUS * np.arccos(GROUND.facing(latitude, longitude))


@pytest.mark.parametrize(
    "text", ["distance < 20", "not distance < 20", "distance < 20 and face == +z", "20 < distance"]
)
def test_the_edge_of_a_distance_is_a_circle(text: str) -> None:
    latitude, longitude = edge(text)
    assert len(latitude) > 100
    assert distance(latitude, longitude) == pytest.approx(20.0, abs=0.01)


def test_a_region_has_its_bounds() -> None:
    latitude, longitude = edge("-5 < latitude_deg < 30 and -70 < longitude_deg < -40")
    away = [np.abs(latitude + 5.0), np.abs(latitude - 30.0), np.abs(longitude + 70.0), np.abs(longitude + 40.0)]
    assert np.min(away, axis=0).max() < 0.1
    assert all(one.min() < 0.1 for one in away)


def test_either_of_two_may_be_anywhere_in_both() -> None:
    """Of `or` the union: the smaller circle within the larger is no edge, and what no place decides has none."""
    assert distance(*edge("distance < 20 or distance < 35")) == pytest.approx(35.0, abs=0.01)
    assert len(edge("distance < 20 or face == +z")[0]) == 0
    assert len(edge("time_s < 20")[0]) == 0
    assert len(edge("distance < 150")[0]) == 0


def test_a_map_holds_circles_that_are_not_much_larger_than_it() -> None:
    states = [LimitState.of(text) for text in ("distance < 20", "distance < 200", "latitude_deg > 3")]
    (found,) = circles(states, GROUND, MapPanel(0.0, 0.0, 30.0))
    assert distance(*found) == pytest.approx(20.0)
