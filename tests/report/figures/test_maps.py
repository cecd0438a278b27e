"""Maps of the ground: true areas, metres from the aim point, graticule, poles, and nothing lost."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LogNorm, to_rgb
from matplotlib.figure import Figure

from lithobrake.analysis import highest_density
from lithobrake.pipeline.answer.run_answers import rest_regions
from lithobrake.report.figures.ground_map import (
    GroundMap,
    MapPanel,
    cell_counts,
    density_norm,
    draw_cells,
    fill_regions,
    mark_site,
    panel_around,
    step_of,
)
from lithobrake.report.figures.map_frames import degrees, frame_half, frame_local
from lithobrake.report.figures.place_map import (
    PlaceMap,
    Places,
    Regions,
    RestMap,
    local_figure,
    outcomes_figure,
    rest_figure,
)
from lithobrake.report.figures.share_figures import ShareBar
from lithobrake.report.figures.style import INK, figure_style
from lithobrake.results.dispersion import RestRegion
from lithobrake.vocabulary.estimate import Estimate

GREEN = "#2aa884"
NONE = np.empty(0)


def ring(latitude: float, longitude: float, half: float) -> tuple[tuple[float, float], ...]:
    """A closed square of latitudes and longitudes about a place."""
    ends = ((-1, -1), (-1, 1), (1, 1), (1, -1), (-1, -1))
    return tuple((latitude + half * up, longitude + half * along) for up, along in ends)


def shown(latitude: np.ndarray, longitude: np.ndarray, *regions: RestRegion) -> PlaceMap:
    return PlaceMap(
        [Places("at rest", GREEN, latitude, longitude)], [Regions("those at rest", GREEN, regions)], (10.0, 179.0), 80.0
    )  # fmt: skip


def words(figure: Figure) -> Iterator[str]:
    for axes in figure.axes:
        yield from (text.get_text() for text in axes.texts)
    for legend in figure.legends:
        yield from (text.get_text() for text in legend.get_texts())


def test_a_map_keeps_areas_and_is_undone() -> None:
    ground = GroundMap(-35.0, 170.0, 80.0)
    random = np.random.default_rng(1)
    latitude, longitude = np.degrees(np.arcsin(random.uniform(-1, 1, 500))), random.uniform(-180, 180, 500)
    east, north = ground.places(latitude, longitude)
    # Places that are even on the sphere are even on the disc: within a radius r of the map lies (r / 2 R)^2 of them.
    for angle in (60.0, 90.0, 120.0):
        inside = ground.facing(latitude, longitude) >= np.cos(np.radians(angle))
        reach = 2.0 * 80.0 * np.sin(np.radians(angle / 2.0))
        assert np.array_equal(inside, np.hypot(east, north) <= reach + 1e-9)
    back = ground.back(east, north)
    assert back[0] == pytest.approx(latitude, abs=1e-6)
    assert (back[1] - longitude + 180.0) % 360.0 - 180.0 == pytest.approx(np.zeros(500), abs=1e-5)


def test_metres_from_the_aim_point_are_those_on_the_ground() -> None:
    ground = GroundMap(60.0, 20.0, 80.0)
    east, north = ground.places(np.array([60.0, 61.0]), np.array([21.0, 20.0]))
    degree = np.radians(1.0) * 80.0
    assert (east[0], north[1]) == pytest.approx((0.5 * degree, degree), rel=1e-4)
    assert (abs(north[0]), abs(east[1])) < (0.02, 1e-9)


def test_a_panel_holds_its_places_across_the_date_line_and_gives_up_where_they_lie_apart() -> None:
    ground = GroundMap(10.0, 179.0, 80.0)
    latitude, longitude = np.array([12.0, 5.0]), np.array([178.0, -175.0])
    panel = panel_around(ground, [(latitude, longitude)])
    assert panel.holds(*ground.places(latitude, longitude)).all()
    assert panel.holds(np.zeros(1), np.zeros(1)).all()
    assert panel.half < 0.12 * 80.0
    assert panel_around(ground, [(np.array([10.0]), np.array([0.0]))]) is None


def test_a_graticule_has_some_four_round_steps() -> None:
    assert [step_of(width) for width in (0.05, 1.0, 38.0, 170.0)] == [0.01, 0.2, 10.0, 45.0]
    assert [degrees(value, "N", "S") for value in (12.5, -30.0, 0.0, -180.0)] == ["12.5° N", "30° S", "0°", "180°"]


def test_a_pole_is_a_point_where_it_lies() -> None:
    axes, ground = Figure().add_subplot(), GroundMap(85.0, 0.0, 100.0)
    frame_local(axes, ground, MapPanel(0.0, 0.0, 30.0))
    named = {text.get_text(): text.xy for text in axes.texts if hasattr(text, "xy")}
    assert named["N"] == pytest.approx((0.0, 200.0 * np.sin(np.radians(2.5))))
    assert "S" not in named
    assert any(text.get_text().endswith(" m") for text in axes.texts)
    half = Figure().add_subplot()
    frame_half(half, GroundMap(0.0, 50.0, 100.0), "")
    assert {"N", "S", "30° N"} <= {text.get_text() for text in half.texts}


def test_the_map_is_in_metres_with_its_regions_and_says_what_lies_outside() -> None:
    random = np.random.default_rng(2)
    latitude, longitude = 10 + random.normal(size=40), 179 + random.normal(size=40)
    latitude[0] = -60.0
    small, large = (
        RestRegion(share, 10.0, 5.0, (ring(10.0, 179.0, half),)) for share, half in ((0.5, 1.0), (0.95, 3.0))
    )
    with figure_style():
        figure = local_figure(shown(latitude, longitude, small, large))
    (axes,) = figure.axes
    assert axes.get_xlabel() == "east of the aim point [m]"
    assert axes.get_xlim()[1] - axes.get_xlim()[0] == pytest.approx(1.12 * np.radians(6.0) * 80.0, rel=0.05)
    found = list(words(figure))
    assert "1 outside" in found
    assert found[-4:] == [
        "at rest (40)", "smallest region with 50 % of those at rest", "smallest region with 95 % of those at rest",
        "aim point",
    ]  # fmt: skip
    FigureCanvasAgg(figure).draw()
    assert not figure.legends[0].get_window_extent().overlaps(axes.get_window_extent())


@pytest.mark.parametrize("middle", [60.0, 180.0])
def test_a_region_is_filled_whole_wherever_its_edge_crosses(middle: float) -> None:
    random, radius = np.random.default_rng(4), 80.0
    places = np.column_stack([np.full(60, radius), *(8.0 * random.standard_normal((2, 60)))])
    turn = np.radians(middle)
    around = np.array([[np.cos(turn), np.sin(turn), 0.0], [-np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
    (region,), axes = rest_regions(highest_density(places @ around, [0.95])), Figure().add_subplot()
    fill_regions(axes, [region], GroundMap(5.0, middle, radius), GREEN)
    (patch,) = axes.patches
    corners = [polygon.T for polygon in patch.get_path().to_polygons(closed_only=False)]
    filled = abs(sum(0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) for x, y in corners))
    # The map keeps areas; the sphere of the points is a little larger than that of the map.
    assert filled == pytest.approx(region.area_m2, rel=0.03)
    assert len(corners) == len(region.island_extents_m)


def test_places_all_around_the_body_are_on_both_its_halves() -> None:
    random = np.random.default_rng(3)
    latitude, longitude = random.uniform(-90, 90, 300), random.uniform(-180, 180, 300)
    with figure_style():
        figure = local_figure(shown(latitude, longitude))
    dots = [len(one.get_offsets()) for axes in figure.axes for one in axes.collections]
    assert sum(dots) == 300
    assert min(dots) > 100


def test_the_whole_body_is_beside_the_outcomes_only_where_the_first_map_leaves_places_out() -> None:
    region = RestRegion(0.95, 10.0, 5.0, (ring(10.0, 179.0, 3.0),))
    for far, discs in ((11.0, 0), (-60.0, 2)):
        with figure_style():
            figure = outcomes_figure(
                shown(np.array([10.0, far]), np.array([179.0, 178.0]), region),
                [ShareBar("at rest", Estimate(1.0, None, None))],
                "all",
            )
        assert len(figure.axes) == discs + 1


def test_no_place_of_many_is_lost_in_the_cells_of_both_halves() -> None:
    random = np.random.default_rng(6)
    places = random.uniform(-90, 90, 12_000), random.uniform(-180, 180, 12_000)
    ground = GroundMap(20.0, 30.0, 80.0)
    counts = [cell_counts(half, places, None)[0] for half in (ground, ground.opposite)]
    assert sum(float(one.sum()) for one in counts) == 12_000
    assert density_norm(counts).vmax == max(10.0, *(one.max() for one in counts))


def test_the_mark_of_the_aim_point_leaves_the_densest_place_in_sight() -> None:
    random = np.random.default_rng(9)
    ground, panel = GroundMap(10.0, 20.0, 80.0), MapPanel(0.0, 0.0, 20.0)
    # The peak of the density lies right at the aim point.
    places = [np.append(random.normal(middle, 3.0, 2000), np.full(500, middle)) for middle in (10.0, 20.0)]
    figure = Figure(figsize=(4.0, 4.0))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    draw_cells(axes, ground, (places[0], places[1]), panel, LogNorm(1.0, 500.0), GREEN)
    mark_site(axes, 0.0, 0.0)
    axes.set_xlim(-20.0, 20.0)
    axes.set_ylim(-20.0, 20.0)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba(), dtype=float)[:, :, :3] / 255
    y, x = 200, 200
    # Within the cell of the aim point the darkest colour, and strokes of ink to the right of it.
    near = pixels[y - 3 : y + 4, x - 3 : x + 4].reshape(-1, 3)
    assert np.abs(near - 0.3 * np.array(to_rgb(GREEN))).max(axis=1).min() < 0.02
    assert np.abs(pixels[y - 2 : y + 3, x : x + 20].reshape(-1, 3) - to_rgb(INK)).max(axis=1).min() < 0.1


def test_both_grounds_are_drawn_over_one_window() -> None:
    random = np.random.default_rng(7)
    latitude, longitude = 10 + random.normal(size=50), 179 + random.normal(size=50)
    maps = [
        RestMap(title, Places("at rest", GREEN, latitude + up, longitude), Regions("those at rest", GREEN, ()),
                [ShareBar("at rest", Estimate(share, share - 0.1, share + 0.1))], "the 50 followed")
        for title, up, share in (("On soil", 3.0, 0.5), ("On hard ground", 0.0, 0.8))
    ]  # fmt: skip
    with figure_style():
        figure = rest_figure(maps, (10.0, 179.0), 80.0)
        alone = rest_figure(maps[1:], (-10.0, -1.0), 80.0)
    panels = [axes for axes in figure.axes if axes.get_xlabel().startswith("east")]
    assert len(panels) == 2
    assert panels[0].get_ylim() == panels[1].get_ylim()
    assert "50 % (40-60 %)" in list(words(figure))
    # All lie on the other side of the body: the shares alone are drawn.
    assert [axes.get_xlabel()[:5] for axes in alone.axes] == ["share"]


def test_edges_of_soils_are_dotted_where_they_lie() -> None:
    many = shown(np.array([9.0, 10.0, 11.0]), np.array([178.0, 179.0, 180.0]))
    figure = local_figure(replace(many, soils={"ponds": [ring(10.0, 179.0, 1.0)], "elsewhere": []}))
    assert "edges of soils (ponds)" in words(figure)
    (edge,) = [line for line in figure.axes[0].lines if line.get_linestyle() == "--" and line.get_linewidth() == 1.1]
    # A degree on a ball of 80 m is 1.4 m.
    corners = np.abs(np.array([np.asarray(edge.get_xdata()), np.asarray(edge.get_ydata())]))
    assert corners[1] == pytest.approx(80.0 * np.pi / 180.0, rel=1e-2)
    assert corners[0] == pytest.approx(80.0 * np.pi / 180.0 * np.cos(np.radians(10.0)), rel=1e-2)
