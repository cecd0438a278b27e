"""Cells that cover the sphere: equal areas, nearly square, and every place in one of them."""

import numpy as np
import pytest

from lithobrake.analysis import EqualAreaCells


@pytest.mark.parametrize("total", [4, 12, 37, 120, 1000])
def test_cells_have_one_area_and_cover_the_sphere(total: int) -> None:
    cells = EqualAreaCells.of(total)
    assert cells.total == total
    south, north, west, east = np.radians(cells.bounds_deg).T
    area = (np.sin(north) - np.sin(south)) * (east - west)
    assert area == pytest.approx(np.full(total, 4.0 * np.pi / total), rel=1e-12)


def test_most_cells_are_nearly_square() -> None:
    south, north, west, east = np.radians(EqualAreaCells.of(200).bounds_deg).T
    across = (east - west) * np.cos(0.5 * (south + north))
    ratio = across / (north - south)
    assert np.quantile(ratio, 0.05) > 0.6
    assert np.quantile(ratio, 0.95) < 1.6


def test_places_lie_in_the_cell_that_they_were_drawn_for() -> None:
    cells = EqualAreaCells.of(90)
    places = cells.places_deg(np.random.default_rng(1).random((90, 50, 2)))
    found = cells.cell_of(places[..., 0].ravel(), places[..., 1].ravel()).reshape(90, 50)
    assert (found == np.arange(90)[:, None]).all()
    turned = cells.cell_of(places[:, 0, 0], places[:, 0, 1] + 720.0)
    assert (turned == np.arange(90)).all()
    # Evenly over the sphere: the mean of each coordinate of their directions is 0, that of its square a third.
    latitude, longitude = np.radians(places.reshape(-1, 2)).T
    x, z = np.cos(latitude) * np.cos(longitude), np.sin(latitude)
    assert abs(z.mean()) < 0.01
    assert np.mean(z**2) == pytest.approx(1.0 / 3.0, abs=0.01)
    assert np.mean(x**2) == pytest.approx(1.0 / 3.0, abs=0.01)


def test_the_poles_and_the_date_line_have_cells() -> None:
    cells = EqualAreaCells.of(30)
    assert cells.cell_of([-90.0, 90.0], [0.0, 180.0]).tolist() == [int(cells.count[0] // 2), 30 - int(cells.count[-1])]
    with pytest.raises(ValueError, match="cells"):
        EqualAreaCells.of(3)
