"""Bounded outputs and their coordinates."""

import numpy as np

from lithobrake.emulator.coordinates import from_coordinate, to_coordinate

LOWER = np.array([0.0, -1.0, -np.inf, -np.inf])
UPPER = np.array([0.4, np.inf, 2.0, np.inf])


def test_coordinates_and_outputs_are_each_others_inverse() -> None:
    y = np.array([[0.1, 3.0, -5.0, 7.0], [0.39, -0.999, 1.999, -7.0]])
    coordinate = to_coordinate(y, LOWER, UPPER)
    np.testing.assert_allclose(from_coordinate(coordinate, LOWER, UPPER), y, rtol=1e-12)
    np.testing.assert_allclose(coordinate[0], [np.log(0.1 / 0.3), np.log(4.0), -np.log(7.0), 7.0])


def test_larger_coordinates_are_larger_outputs() -> None:
    grid = np.linspace(-5.0, 5.0, 50)[:, None]
    assert (np.diff(from_coordinate(grid, LOWER, UPPER), axis=0) > 0.0).all()


def test_no_coordinate_reaches_a_bound() -> None:
    y = from_coordinate(np.array([[-1e6], [-40.0], [40.0], [1e6]]), LOWER, UPPER)
    assert ((y > LOWER) & (y < UPPER)).all()
    assert np.isfinite(y).all()
