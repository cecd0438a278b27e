"""Bounded outputs and their coordinates."""

import numpy as np

from lithobrake.emulator.training import from_coordinate, to_coordinate, with_slope

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


def test_slopes_are_derivatives_of_coordinates() -> None:
    y, step = np.array([[0.1, 3.0, -5.0, 7.0], [0.39, -0.5, 1.5, -7.0]]), 1e-5
    coordinate, slope = with_slope(y, LOWER, UPPER)
    np.testing.assert_array_equal(coordinate, to_coordinate(y, LOWER, UPPER))
    difference = (to_coordinate(y + step, LOWER, UPPER) - to_coordinate(y - step, LOWER, UPPER)) / (2.0 * step)
    np.testing.assert_allclose(slope, difference, rtol=1e-5)


def test_beyond_a_bound_coordinates_are_infinite_and_slopes_zero() -> None:
    y = np.array([[-9.0] * 4, [9.0] * 4])
    coordinate, slope = with_slope(y, LOWER, UPPER)
    beyond = (y <= LOWER) | (y >= UPPER)
    np.testing.assert_array_equal(coordinate[beyond], [-np.inf, -np.inf, np.inf, np.inf])
    assert (slope[beyond] == 0.0).all()
    assert np.isfinite(coordinate[~beyond]).all()
