"""Regions of highest density of made-up places, against closed forms."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.path import Path as Outline

from lithobrake.analysis import highest_density
from lithobrake.analysis.equal_area import EqualAreaMap, latitude_longitude

sys.path.insert(0, str(Path(__file__).parents[2] / "validation"))
from density_regions import page_table

NORTH = np.array([0.0, 0.0, 1.0])


def frame(direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A unit vector along a direction, and two across it as rows."""
    unit = direction / np.linalg.norm(direction)
    return unit, np.linalg.svd(unit[None])[2][1:]


def cloud(
    count: int, direction: np.ndarray, spread: tuple[float, float], seed: int, radius: float = 100.0
) -> np.ndarray:
    """A normal cloud [m] on the plane that touches the sphere in a direction."""
    unit, across = frame(direction)
    return radius * unit + (np.random.default_rng(seed).normal(size=(count, 2)) * spread) @ across


def cap(count: int, direction: np.ndarray, angle: float, seed: int) -> np.ndarray:
    """Directions even over the cap within an angle [rad] of a direction."""
    random, (unit, across) = np.random.default_rng(seed), frame(direction)
    height, turn = random.uniform(math.cos(angle), 1.0, count), random.uniform(0.0, 2.0 * math.pi, count)
    level = np.sqrt(1.0 - height**2) * np.array([np.cos(turn), np.sin(turn)])
    return height[:, None] * unit + level.T @ across


@pytest.mark.parametrize("direction", [[1.0, 0.0, 0.0], [-1.0, 0.1, 0.2], [0.0, 0.0, 1.0]])
@pytest.mark.parametrize("spread", [(1.0, 1.0), (3.0, 0.5)])
def test_a_normal_cloud_has_the_regions_of_its_law(direction: list[float], spread: tuple[float, float]) -> None:
    """The share p of a normal law lies within -2 ln(1 - p) of its squared distance: an ellipse."""
    points = np.concatenate([cloud(800, np.array(direction), spread, seed) for seed in range(2)])
    found = highest_density(points)
    assert found.why is None
    for region in found.regions:
        square = -2.0 * math.log(1.0 - region.share)
        # Four standard deviations of the area of so many points (0.03), and its bias (0.01).
        assert region.area_m2 == pytest.approx(math.pi * square * spread[0] * spread[1], rel=0.13)
        assert region.largest_extent_m == pytest.approx(2.0 * max(spread) * math.sqrt(square), rel=0.13)


def test_the_region_holds_its_share_of_the_next_places() -> None:
    """Over 40 studies of 96 places; next places are counted inside the outline."""
    held = []
    for seed in range(40):
        points = cloud(96, np.array([1.0, 0.0, 0.0]), (4.0, 2.0), seed)
        following = latitude_longitude(cloud(500, np.array([1.0, 0.0, 0.0]), (4.0, 2.0), 1000 + seed))
        counts = [
            sum(Outline(outline).contains_points(following).astype(int) for outline in region.outlines)
            for region in highest_density(points).regions
        ]
        held.append([np.mean(np.minimum(count, 1)) for count in counts])
    # Standard errors are 0.01 and 0.005; a region with a hole, which is counted, holds a little less.
    assert np.mean(held, axis=0) == pytest.approx([0.5, 0.95], abs=0.03)


@pytest.mark.parametrize("angle_deg", [5.0, 60.0, 120.0, 180.0])
def test_an_even_cap_has_a_share_of_its_area(angle_deg: float) -> None:
    angle = math.radians(angle_deg)
    points = 100.0 * cap(1000, np.array([-1.0, 0.2, 0.5]), angle, 3)
    region = highest_density(points, [0.95]).regions[0]
    area = 0.95 * 2.0 * math.pi * (1.0 - math.cos(angle)) * 1e4
    # The density is blurred by a bandwidth at the edge of the cap: a few percent of the area.
    assert region.area_m2 == pytest.approx(area, rel=0.06)
    assert region.largest_extent_m == pytest.approx(200.0 * math.sin(min(angle, 0.5 * math.pi)), rel=0.1)


def test_a_cloud_is_the_same_wherever_it_lies_and_however_large_it_is() -> None:
    plain = highest_density(cloud(96, NORTH, (4.0, 2.0), 1))
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    moved = highest_density(3.0 * cloud(96, NORTH, (4.0, 2.0), 1) @ turn.T)
    for one, other in zip(plain.regions, moved.regions, strict=True):
        assert other.area_m2 == pytest.approx(9.0 * one.area_m2, rel=1e-6)
        assert other.largest_extent_m == pytest.approx(3.0 * one.largest_extent_m, rel=0.02)


def test_a_few_places_far_off_leave_the_middle_as_it_is() -> None:
    near = cloud(90, NORTH, (2.0, 2.0), 6)
    far = cloud(6, NORTH, (40.0, 40.0), 7)
    alone, both = highest_density(near), highest_density(np.concatenate([near, far]))
    assert both.regions[0].area_m2 == pytest.approx(alone.regions[0].area_m2, rel=0.3)
    assert both.regions[1].largest_extent_m > alone.regions[1].largest_extent_m


def test_places_on_both_sides_of_the_body_are_not_torn() -> None:
    """Two clouds opposite each other: both have outlines of their own, near themselves."""
    sides = [
        cloud(count, sign * np.array([1.0, 0.5, 0.2]), (5.0, 5.0), count) for count, sign in ((60, 1.0), (40, -1.0))
    ]
    region = highest_density(np.concatenate(sides), [0.9]).regions[0]
    assert region.largest_extent_m == pytest.approx(200.0, rel=0.02)
    assert region.area_m2 < 0.15 * 4.0 * math.pi * 1e4


def test_outlines_stop_at_the_date_line_and_close_elsewhere() -> None:
    across = highest_density(cloud(200, np.array([-1.0, 0.0, 0.0]), (3.0, 3.0), 2), [0.5]).regions[0]
    assert len(across.outlines) > 1
    for line in across.outlines:
        assert np.abs(np.diff(line[:, 1])).max(initial=0.0) < 180.0
    (whole,) = highest_density(cloud(200, np.array([1.0, 0.0, 0.0]), (3.0, 3.0), 2), [0.5]).regions[0].outlines
    assert whole[0] == pytest.approx(whole[-1])
    assert np.abs(whole).max() < 10.0


def test_the_map_keeps_areas_and_gives_places_back() -> None:
    points = 70.0 * cap(500, NORTH, math.radians(175.0), 8)
    flat_map = EqualAreaMap.of(points)
    flat = flat_map.laid_flat(points)
    assert 70.0 * flat_map.directions(flat) == pytest.approx(points, abs=1e-9)
    # A small square anywhere keeps its area.
    step = 1e-4 * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    corner, along, across = (70.0 * flat_map.directions(flat + one) for one in step)
    areas = np.linalg.norm(np.cross(along - corner, across - corner), axis=1)
    assert areas == pytest.approx(1e-8, rel=1e-3)


def test_too_few_places_and_places_on_a_line_say_why() -> None:
    points = cloud(4, NORTH, (1.0, 1.0), 0)
    assert "4 places are too few" in str(highest_density(points).why)
    assert "one line" in str(highest_density(np.tile(points[:1], (9, 1))).why)
    assert highest_density(points).regions == ()
    assert len(highest_density(cloud(5, NORTH, (1.0, 1.0), 0)).regions) == 2
    for wrong, words in ((points[:, :2], "shape"), (np.zeros((9, 3)), "origin"), (points * np.nan, "finite")):
        with pytest.raises(ValueError, match=words):
            highest_density(wrong)
    with pytest.raises(ValueError, match="between 0 and 1"):
        highest_density(points, [1.0])


def test_the_page_has_the_table_that_was_made() -> None:
    page = Path(__file__).parents[2] / "docs" / "estimates.md"
    assert page_table() in page.read_text(encoding="utf-8")
