"""Thinned outlines against shapes whose corners, areas and shares are known."""

import math
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.path import Path as Outline

from lithobrake.analysis import highest_density, regions
from lithobrake.analysis.outlines import thinned, to_the_tolerance


def circle(radius: float, count: int) -> np.ndarray:
    """A closed circle, [count + 1, 2]."""
    turn = np.linspace(0.0, 2.0 * math.pi, count + 1)
    line = radius * np.column_stack([np.cos(turn), np.sin(turn)])
    line[-1] = line[0]
    return line


def away(points: np.ndarray, line: np.ndarray) -> float:
    """The largest distance of points from a closed line, by points along it."""
    dense = np.concatenate([np.linspace(a, b, 200) for a, b in pairwise(line)])
    return max(float(np.linalg.norm(dense - point, axis=1).min()) for point in points)


def area(line: np.ndarray) -> float:
    x, y = line.T
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def test_a_square_with_many_points_on_its_sides_keeps_its_corners() -> None:
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]])
    sides = [np.linspace(a, b, 50)[:-1] for a, b in pairwise(corners)]
    assert thinned(np.concatenate([*sides, corners[:1]]), 0.01).tolist() == corners.tolist()


@pytest.mark.parametrize("tolerance", [0.3, 0.1, 0.01])
def test_no_point_of_a_circle_lies_farther_from_its_outline_than_the_tolerance(tolerance: float) -> None:
    """A chord with a sagitta of h needs pi / acos(1 - h) sides at least; halving the parts takes twice that at most."""
    line = circle(1.0, 720)
    few = thinned(line, tolerance)
    fewest = math.pi / math.acos(1.0 - tolerance)
    assert fewest <= len(few) - 1 <= 2.0 * fewest + 2.0
    assert away(line, few) <= tolerance + 1e-3
    assert few[0].tolist() == few[-1].tolist()


def test_a_line_smaller_than_the_tolerance_stays_whole() -> None:
    line = circle(0.01, 12)
    assert thinned(line, 0.1) is line


def test_rounding_moves_a_place_by_a_hundredth_of_the_tolerance_at_most() -> None:
    places = np.random.default_rng(0).uniform([-90.0, -180.0], [90.0, 180.0], (500, 2))
    for tolerance in (1e-3, 0.02, 0.4):
        found = to_the_tolerance(places, tolerance)
        assert 0.0 < np.abs(found - places).max() <= 0.01 * math.degrees(tolerance)
    east = to_the_tolerance(np.array([[10.0, -179.9999]]), 0.1)[0, 1]
    assert east == 180.0


@pytest.mark.parametrize(("count", "spread"), [(20, (4.0, 2.0)), (96, (30.0, 20.0)), (1000, (4.0, 2.0))])
def test_thinned_outlines_keep_area_and_share(
    count: int, spread: tuple[float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A tenth of the points or fewer, areas within 4 %, and nearly the same share of the next places inside.

    The share P of a normal law changes by (1 - P) ln(1 / (1 - P)) of the relative change of the area of its region, for
    a half 0.35: 4 % are 1.4 points.
    """
    points = np.column_stack([np.random.default_rng(count).normal(size=(count, 2)) * spread, np.full(count, 100.0)])
    following = np.column_stack([np.random.default_rng(1).normal(size=(20_000, 2)) * spread, np.full(20_000, 100.0)])
    thin = highest_density(points)
    monkeypatch.setattr(regions, "thinned", lambda line, _: line)
    whole = highest_density(points)
    for few, many in zip(thin.regions, whole.regions, strict=True):
        assert (few.area_m2, few.largest_extent_m, few.island_extents_m) == (
            many.area_m2, many.largest_extent_m, many.island_extents_m
        )  # fmt: skip
        # From above the pole, where the cloud lies; the plane keeps areas.
        edges, full = ([_flat(line) for line in one.outlines] for one in (few, many))
        assert sum(map(len, edges)) < 0.1 * sum(map(len, full))
        assert sum(map(area, edges)) == pytest.approx(sum(map(area, full)), rel=0.04)
        share, known = (_share(lines, _flat(_angles(following))) for lines in (edges, full))
        assert share == pytest.approx(known, abs=0.014)


def _angles(points: np.ndarray) -> np.ndarray:
    x, y, z = points.T
    return np.degrees(np.column_stack([np.arctan2(z, np.hypot(x, y)), np.arctan2(y, x)]))


def _flat(places: np.ndarray) -> np.ndarray:
    """Latitude and longitude [deg] on Lambert's equal-area map about the pole, of a sphere of radius 1."""
    latitude, longitude = np.radians(places).T
    size = np.sqrt(2.0 * (1.0 - np.sin(latitude)))
    return size[:, None] * np.column_stack([np.cos(longitude), np.sin(longitude)])


def _share(lines: list[np.ndarray], points: np.ndarray) -> float:
    """The share of points inside an odd number of lines."""
    return float(np.mean(np.sum([Outline(line).contains_points(points).astype(int) for line in lines], axis=0) % 2))
