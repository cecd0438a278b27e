"""Regions of made-up places against closed forms: ellipses, highest density, and cells of equal area."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.path import Path as Outline

from lithobrake.analysis import EqualAreaCells, dispersion_ellipses, highest_density
from lithobrake.analysis.equal_area import EqualAreaMap, latitude_longitude

sys.path.insert(0, str(Path(__file__).parents[2] / "validation"))
from density_regions import page_table


def test_a_normal_cloud_gives_its_own_axes() -> None:
    """Spreads of 2 and 0.5 deg along and across a heading of 30 deg, at latitude 50, across the date line."""
    random = np.random.default_rng(0)
    along, across = 2.0 * random.normal(size=20_000), 0.5 * random.normal(size=20_000)
    c, s = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))
    north, east = c * along - s * across, s * along + c * across
    longitude = 180.0 + east / np.cos(np.radians(50.0))
    found = dispersion_ellipses(50.0 + north, np.where(longitude > 180.0, longitude - 360.0, longitude))
    assert found.latitude_deg == pytest.approx(50.0, abs=0.1)
    assert abs(found.longitude_deg) == pytest.approx(180.0, abs=0.1)
    assert found.heading_deg == pytest.approx(30.0, abs=2.0)
    # A normal cloud has a share of 1 - exp(-k**2 / 2) within k spreads.
    for share, axes in found.semi_axes_deg.items():
        k = math.sqrt(-2.0 * math.log(1.0 - share))
        assert axes == pytest.approx((2.0 * k, 0.5 * k), rel=0.05)


def test_a_heading_wraps_at_half_a_turn() -> None:
    random = np.random.default_rng(1)
    found = dispersion_ellipses(random.normal(size=500), 10.0 + 0.1 * random.normal(size=500))
    assert min(found.heading_deg, 180.0 - found.heading_deg) < 3.0


def test_an_ellipse_that_would_reach_round_half_the_body_is_left_out() -> None:
    random = np.random.default_rng(2)
    near, far = 5.0 * random.normal(size=(900, 2)), np.column_stack([np.zeros(100), np.linspace(-170.0, 170.0, 100)])
    found = dispersion_ellipses(*np.concatenate([near, far]).T, (0.5, 0.99))
    assert list(found.semi_axes_deg) == [0.5]


def test_few_places_and_places_all_around_have_no_ellipse() -> None:
    assert dispersion_ellipses([1.0] * 5, [2.0] * 5) is None
    around = np.linspace(-180.0, 170.0, 36)
    assert dispersion_ellipses(np.zeros(36), around) is None
    assert dispersion_ellipses([10.0] * 20, [20.0] * 20) is None
    with pytest.raises(ValueError, match="between 0 and 1"):
        dispersion_ellipses([1.0] * 20, [2.0] * 20, (0.5, 1.0))


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


@pytest.mark.parametrize("middle", [0.0, 180.0])
def test_an_outline_closes_across_the_date_line_as_elsewhere(middle: float) -> None:
    turned = math.cos(math.radians(middle)) * np.array([1.0, 0.0, 0.0])
    (whole,) = highest_density(cloud(200, turned, (3.0, 3.0), 2), [0.5]).regions[0].outlines
    assert whole[0] == pytest.approx(whole[-1])
    assert np.abs(whole[:, 1]).max() <= 180.0
    assert np.abs((whole[:, 1] - middle + 180.0) % 360.0 - 180.0).max() < 10.0


def test_a_region_knows_the_extent_of_each_of_its_islands() -> None:
    """A large and a small cloud, 53 m apart straight through a sphere of 100 m; a cloud alone is one island."""
    places = np.concatenate([cloud(count, np.array([1.0, y, 0.0]), (spread, spread), 3)
                             for count, y, spread in ((150, 0.0, 2.5), (50, 0.6, 2.0))])  # fmt: skip
    two, one = highest_density(places, [0.95]).regions[0], highest_density(places[:150], [0.5]).regions[0]
    assert len(two.island_extents_m) == 2
    assert two.island_extents_m[0] > two.island_extents_m[1]
    assert 53.0 < two.largest_extent_m < 54.0 + 0.5 * sum(two.island_extents_m)
    assert one.island_extents_m == pytest.approx((one.largest_extent_m,), rel=0.02)


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
