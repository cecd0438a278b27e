"""Each figure is made from plain arrays and shows what it is given."""

from dataclasses import replace

import matplotlib
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from lithobrake.analysis import dispersion_ellipses
from lithobrake.report.figures.aim_figure import aim_figure
from lithobrake.report.figures.bed_figure import bed_figure, three_moments
from lithobrake.report.figures.body_figure import body_figure, colour_ends, facet_density
from lithobrake.report.figures.count_figure import Design, count_figure
from lithobrake.report.figures.density import WHOLE, Window, close_window, draw_density, neighbour_count
from lithobrake.report.figures.error_figure import error_figure
from lithobrake.report.figures.hulls import Hull, Scene
from lithobrake.report.figures.landing_figure import instants, landing_figure
from lithobrake.report.figures.map_figure import Share, draw_shares, map_figure
from lithobrake.report.figures.map_marks import draw_ellipses, fitting, outline
from lithobrake.report.figures.rest_figure import RestMap, rest_figure
from lithobrake.report.figures.scatter_figure import scatter_figure
from lithobrake.report.figures.sobol_figure import sobol_figure
from lithobrake.report.figures.style import INK, figure_style
from lithobrake.report.page_data import DrawnPage
from lithobrake.report.pages.shared_plots import draw_map, draw_rest
from lithobrake.report.words.chance import follows_gaussian
from lithobrake.report.words.labels import PAPER_OUTPUTS, input_label
from lithobrake.results import MovingBodies
from lithobrake.results.aims import AimOnGround, AimResult, AimResults, BestAim
from lithobrake.results.dispersion import EllipseShare, LandingEllipses
from lithobrake.results.expansions import OutputErrors
from lithobrake.results.shares import Estimate, ShareInterval
from lithobrake.vocabulary.fate_colours import FATE_COLOURS


def ellipse(share: float, long: float, short: float) -> EllipseShare:
    return EllipseShare(share, (long, short), (10.0 * long, 10.0 * short))


ELLIPSES = LandingEllipses(10.0, 30.0, 20.0, (ellipse(0.5, 0.8, 0.4), ellipse(0.95, 1.6, 0.8)))
TETRAHEDRON = np.array([(1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)])
FACES = np.array([(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)])


def texts(figure: Figure) -> str:
    """All words of a figure."""
    found = [text.get_text() for text in figure.texts]
    found += [text.get_text() for axes in figure.axes for text in [*axes.texts, axes.title, axes.xaxis.label]]
    legends = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    return "\n".join([*found, *legends])


def falling(frame_count: int, box: tuple[float, float] | None = (0.6, 0.6)) -> Scene:
    """Five tetrahedra that sink."""
    bodies = (Hull(0.03 * TETRAHEDRON, FACES, "#aa9977"),) * 5
    start = np.column_stack([np.linspace(-0.2, 0.2, 5), np.zeros(5), np.linspace(0.3, 1.0, 5)])
    drop = np.linspace(0.0, 0.25, frame_count)[:, None]
    position = np.repeat(start[None], frame_count, axis=0)
    position[:, :, 2] -= drop
    orientation = np.zeros((frame_count, 5, 4))
    orientation[:, :, 0] = 1.0
    record = np.linspace(0.0, 4.0, 9)
    history = {"time": record, "kinetic_ratio": np.exp(-record), "unbalanced_force": np.exp(-record)}
    history["gravity"] = np.full(9, 1.0)
    shapes = (TETRAHEDRON,) * 5, (FACES,) * 5
    moving = MovingBodies(*shapes, np.linspace(0.0, 1.0, frame_count), position, orientation, {}, history)
    return Scene(bodies, moving, box)


def test_bed_figure_shows_three_moments_with_their_times() -> None:
    with figure_style():
        figure = bed_figure(falling(11), 0.1)
    words = texts(figure)
    assert "random cloud" in words
    assert "falling\n$t$ = 0.5 s" in words
    assert "settled" in words


def test_three_moments_of_a_bed_with_one_frame() -> None:
    assert three_moments(np.zeros((1, 4, 3))) == (0, 0, 0)


@pytest.mark.parametrize(
    ("height", "expected"),
    [
        (np.abs(np.arange(11.0) - 4.0), [0, 2, 4, 6, 8, 10]),
        (np.arange(3.0), [0, 1, 2]),
        (np.arange(11.0, 0.0, -1.0), [0, 2, 4, 6, 8, 10]),
    ],
    ids=["bounces", "few frames", "never comes up"],
)
def test_instants_hold_start_deepest_and_end(height: np.ndarray, expected: list[int]) -> None:
    assert instants(height) == expected


@pytest.mark.parametrize("box", [(0.6, 0.6), None])
def test_landing_figure_has_one_picture_an_instant(box: tuple[float, float] | None) -> None:
    with figure_style():
        figure = landing_figure(falling(12, box))
    assert len(figure.axes) == 6
    # Twelve edges of the box and the way in its two colours, which ends in a dot.
    assert {len(axes.lines) for axes in figure.axes} == {15 if box else 3}


def test_count_figure_names_the_designs_with_their_runs() -> None:
    smolyak = np.array([[3.0, 5.0], [5.0, 13.0], [7.0, 25.0]])
    with figure_style():
        figure = count_figure([1, 2, 3], [1, 2], smolyak**2, smolyak, [Design("screening", 3, 2, 25)])
    assert "screening: 3 inputs, level 2, 25 runs" in texts(figure)


def test_sobol_figure_gives_the_rest_to_interactions() -> None:
    names = ("grain.friction", "grain.restitution")
    first = {name: np.array([0.5, 0.2]) for name in PAPER_OUTPUTS}
    with figure_style():
        figure = sobol_figure(names, first, dict.fromkeys(PAPER_OUTPUTS, 0.1), dict.fromkeys(PAPER_OUTPUTS))
    words = texts(figure)
    assert words.count("50 %") == 3
    assert words.count("30 %") == 3
    assert "interactions" in words


def test_sobol_figure_says_what_is_scatter_and_where_no_input_was_found() -> None:
    first = dict.fromkeys(PAPER_OUTPUTS, np.array([1.0])) | {"elevation_out": np.array([0.0])}
    spread = dict.fromkeys(PAPER_OUTPUTS, 0.1) | {"elevation_out": 0.0}
    with figure_style():
        figure = sobol_figure(("impact.speed",), first, spread, dict.fromkeys(PAPER_OUTPUTS, 0.7))
    words = texts(figure)
    assert words.count("100 %") == 2
    assert words.count("no input found\nthat decides it") == 1
    assert words.count("scatter: 70 % of\nthe runs' variance") == 3


def errors(ape: list[float], *, q2: float | None, std: float, mape: float, rmse: float) -> OutputErrors:
    """Errors without intervals."""
    none = (None, None)
    return OutputErrors(
        mape=mape, q2=q2, rrmse=None, rmse=rmse, std=std, ape=tuple(ape), mape_interval=none, rmse_interval=none,
        rrmse_interval=none, q2_interval=none,
    )  # fmt: skip


def test_error_figure_puts_q2_rmse_and_spread_beside_every_mape() -> None:
    score = errors([1.0, 2.0, 3.0], q2=0.75, std=0.02, mape=2.0, rmse=0.01)
    scores = dict.fromkeys(PAPER_OUTPUTS, score)
    with figure_style():
        figure = error_figure(scores, scores, scores)
    words = texts(figure)
    assert words.count("MAPE") == words.count("$Q^2$ 0.75") == words.count("at a spread of") == 9
    assert "RMSE 0.57 at a spread of 1.1 deg" in words


def test_error_figure_says_how_many_errors_lie_beyond_the_axis() -> None:
    wild = errors([*np.linspace(1.0, 2.0, 39).tolist(), 500.0], q2=0.5, std=0.2, mape=14.0, rmse=0.1)
    scores = dict.fromkeys(PAPER_OUTPUTS, wild)
    with figure_style():
        assert "1 beyond" in texts(error_figure(scores, scores, scores))


def test_error_figure_shows_a_q2_that_does_not_exist_as_such() -> None:
    score = errors([1.0], q2=None, std=0.0, mape=1.0, rmse=0.01)
    scores = dict.fromkeys(PAPER_OUTPUTS, score)
    with figure_style():
        assert "$Q^2$ undefined" in texts(error_figure(scores, scores, scores))


def test_scatter_figure_leaves_out_samples_that_stay() -> None:
    outputs = {name: np.linspace(0.0, 1.0, 20) for name in PAPER_OUTPUTS}
    leaves = np.arange(20) >= 5
    with figure_style():
        figure = scatter_figure(outputs, ("restitution", np.linspace(0.3, 0.8, 20)), leaves)
    assert [len(axes.collections[0].get_offsets()) for axes in figure.axes[:3]] == [15, 15, 15]


def test_an_outcome_that_no_run_had_shows_its_upper_limit_in_place_of_nothing() -> None:
    with figure_style():
        figure = map_figure(np.zeros(0), np.zeros(0), (0.0, 0.0), [Share("captured", 0.0, upper=0.0203)])
    words = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert "at most 2.0 %" in words
    assert not any("% interval" in axes.get_xlabel() for axes in figure.axes)


@pytest.mark.parametrize("with_relief", [False, True])
def test_map_figure_shows_shares_with_intervals(with_relief: bool) -> None:
    generator = np.random.default_rng(3)
    latitude, longitude = generator.uniform(-40, 40, 300), generator.uniform(-180, 180, 300)
    vertices = generator.normal(size=(200, 3))
    vertices /= np.linalg.norm(vertices, axis=1)[:, None]
    shares = [Share("re-impact", 0.6, 0.55, 0.65), Share("escaped", 0.4, 0.35, 0.45)]
    with figure_style():
        figure = map_figure(latitude, longitude, (0.0, 10.0), shares, vertices if with_relief else None)
    words = texts(figure)
    assert "60 % (55-65 %)" in words
    assert "landing site" in words


def test_map_figure_without_any_impact_is_still_a_map() -> None:
    with figure_style():
        figure = map_figure(np.zeros(0), np.zeros(0), (0.0, 0.0), [Share("escaped", 1.0, 0.9, 1.0)])
    assert "no impact among the flights" in texts(figure)
    assert len(figure.axes) == 2


def test_map_figure_shows_impacts_near_the_site_in_a_close_view() -> None:
    generator = np.random.default_rng(4)
    latitude, longitude = 30 + generator.normal(size=200), 179 + generator.normal(size=200)
    longitude = np.where(longitude > 180, longitude - 360, longitude)
    window = close_window(latitude, longitude, (30.0, 179.0))
    assert window is not None
    assert window.longitude == pytest.approx(179.0, abs=1.0)
    assert window.half < 5.0
    with figure_style():
        figure = map_figure(latitude, longitude, (30.0, 179.0), [Share("impact", 1.0, 0.98, 1.0)], None, ELLIPSES)
    ends = (window.latitude - window.half, window.latitude + window.half)
    (view,) = figure.axes[0].child_axes
    assert view.get_ylim() == pytest.approx(ends)
    assert len(view.collections[0].get_offsets()) == 200


def test_ellipses_are_named_beside_the_map_and_not_on_it() -> None:
    generator = np.random.default_rng(8)
    latitude, longitude = 10 + generator.normal(size=50), 30 + generator.normal(size=50)
    with figure_style():
        figure = map_figure(latitude, longitude, (10.0, 30.0), [], None, ELLIPSES)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "landing site",
        "ellipse that holds 50 % of the impacts",
        "ellipse that holds 95 % of the impacts",
    ]
    FigureCanvasAgg(figure).draw()
    assert not any(legend.get_window_extent().overlaps(axes.get_window_extent()) for axes in figure.axes)
    axes = Figure().add_subplot()
    draw_ellipses(axes, ELLIPSES, WHOLE)
    draw_ellipses(axes, None, WHOLE)
    assert len(axes.lines) == 4
    assert not axes.texts


@pytest.mark.parametrize("longitude", [20.0, 380.0])
def test_the_mark_of_the_site_leaves_the_densest_place_in_sight(longitude: float) -> None:
    generator = np.random.default_rng(9)
    spread = generator.uniform(-60, 60, 12_000), generator.uniform(-180, 180, 12_000)
    # The peak of the density lies right at the site.
    places = [np.append(values, np.full(500, middle)) for values, middle in zip(spread, (10.0, 20.0), strict=True)]
    with figure_style():
        figure = map_figure(*places, (10.0, longitude), [Share("impact", 1.0)])
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    x, y = figure.axes[0].transData.transform((20.0, 10.0))
    pixels = np.asarray(canvas.buffer_rgba(), dtype=float)[:, :, :3] / 255
    peak = np.array(matplotlib.colormaps["viridis"](1.0)[:3])
    assert pixels[int(pixels.shape[0] - y), int(x)] == pytest.approx(peak, abs=0.02)
    # And the mark is there, to the right of it.
    beside = pixels[int(pixels.shape[0] - y), int(x) : int(x) + 15]
    assert np.abs(beside - matplotlib.colors.to_rgb(INK)).max(axis=1).min() < 0.1


def test_shares_end_at_the_whole_and_have_their_figures_beside_the_axis() -> None:
    axes = Figure().add_subplot()
    draw_shares(axes, [Share("down", 0.75, 0.7, 0.8), Share("captured", 0.25)], "all 100 000 samples")
    assert axes.get_xlim() == (0.0, 100.0)
    assert [text.get_text() for text in axes.texts] == ["75 % (70-80 %)", "25 %"]
    assert all(text.get_position()[0] > 1.0 for text in axes.texts)
    assert len(axes.lines) == 1
    assert axes.get_xlabel() == "share of all 100 000 samples [%], with 90 % interval"


def test_one_fate_has_one_colour_in_every_figure(drawn: DrawnPage) -> None:
    with figure_style():
        figures = draw_map(drawn), draw_rest(drawn)
    found: dict[str, set[str]] = {}
    for axes in (axes for figure in figures for axes in figure.axes if axes.patches and axes.get_yticklabels()):
        for label, bar in zip(axes.get_yticklabels(), axes.patches, strict=False):
            found.setdefault(label.get_text(), set()).add(matplotlib.colors.to_hex(bar.get_facecolor()))
    assert {"captured", "at rest", "unknown outcome"} <= found.keys()
    assert all(len(colours) == 1 for colours in found.values())
    assert found["captured"] == {FATE_COLOURS["captured"]}
    assert len(set(FATE_COLOURS.values())) == len(FATE_COLOURS)


def test_an_ellipse_over_the_edge_of_the_map_or_round_a_pole_is_not_drawn() -> None:
    at = LandingEllipses(85.0, 170.0, 0.0, (ellipse(0.5, 2.0, 1.0), ellipse(0.95, 20.0, 8.0)))
    assert [one.share for one in fitting(at, WHOLE)] == [0.5]
    assert [one.share for one in fitting(replace(at, latitude_deg=10.0), WHOLE)] == [0.5, 0.95]
    close = Window(latitude=10.0, longitude=170.0, half=5.0, half_longitude=5.0)
    assert [one.share for one in fitting(replace(at, latitude_deg=10.0), close)] == [0.5]
    assert fitting(None, WHOLE) == []


@pytest.mark.parametrize(("freedom", "is_gaussian"), [(np.inf, True), (2.0, False)])
def test_ellipses_of_heavy_tails_are_flagged(freedom: float, is_gaussian: bool) -> None:
    random = np.random.default_rng(1)
    places = random.standard_normal((2000, 2))
    if np.isfinite(freedom):
        places /= np.sqrt(random.chisquare(freedom, 2000) / freedom)[:, None]
    found = dispersion_ellipses(*(0.1 * places.T))
    assert found is not None
    shares = tuple(ellipse(share, *axes) for share, axes in found.semi_axes_deg.items())
    assert follows_gaussian(LandingEllipses(0.0, 0.0, 0.0, shares), 2000) is is_gaussian
    assert follows_gaussian(None, 0)


def test_aims_share_one_scale_and_have_colour_bars() -> None:
    def far(value: float) -> Estimate:
        return Estimate(value, 0.7 * value, 1.4 * value)

    def ground(share: float) -> AimOnGround:
        settled = ShareInterval(share, share - 0.1, share + 0.1)
        return AimOnGround(settled, 0.4, far(100.0 * share), far(3600.0), allowed=True)

    aims = tuple(AimResult((speed,), ground(share), ground(0.2)) for speed, share in ((0.1, 0.2), (0.2, 0.3)))
    best = BestAim(1, 0.9, None, (0,), 0, None)
    table = AimResults(("impact.speed",), ("m/s",), (), 100, 50, 0.9, None, aims, best, None, "")
    with figure_style():
        figure = aim_figure(table)
    maps = [axes.images[0] for axes in figure.axes if axes.images]
    assert len(maps) == 5
    assert [drawn.get_clim() for drawn in maps][::4] == [(0.0, 100.0)] * 2
    assert len({drawn.get_cmap().name for drawn in maps}) == 1
    assert len(figure.axes) == 10
    assert figure.get_figwidth() == 9.2
    assert {"20", "30"} <= {text.get_text() for text in figure.axes[0].texts}
    # The best is framed, and dotted what cannot be told from it.
    assert sorted(patch.get_linestyle() for patch in figure.axes[0].patches) == [":", "solid"]


def test_shares_without_intervals_speak_of_none() -> None:
    axes = Figure().add_subplot()
    draw_shares(axes, [Share("down", 0.75, None, None)], "the 200 followed")
    assert not axes.lines
    assert axes.get_xlabel() == "share of the 200 followed [%]"


def test_names_of_curves_and_legends_of_many_inputs_cover_nothing() -> None:
    counts = np.outer(np.arange(1.0, 15.0), [3.0, 9.0])
    first = {name: np.full(10, 0.1) for name in PAPER_OUTPUTS}
    with figure_style():
        curves = count_figure(list(range(1, 15)), [1, 2], counts**2, counts, [])
        names = tuple(f"grain.input_{number}" for number in range(10))
        rings = sobol_figure(names, first, dict.fromkeys(PAPER_OUTPUTS, 0.1), dict.fromkeys(PAPER_OUTPUTS))
    for figure in (curves, rings):
        FigureCanvasAgg(figure).draw()
    for axes in curves.axes:
        boxes = [text.get_window_extent() for text in axes.texts]
        assert len(boxes) > 1
        assert not any(one.overlaps(other) for index, one in enumerate(boxes) for other in boxes[:index])
    assert all(rings.legends[0].get_window_extent().y1 <= axes.get_window_extent().y0 for axes in rings.axes)


def test_an_ellipse_lies_as_far_from_its_middle_as_it_is_long() -> None:
    latitude, longitude = outline(60.0, 170.0, 90.0, (10.0, 4.0))
    places, middle = (
        np.stack([np.cos(a) * np.cos(b), np.cos(a) * np.sin(b), np.sin(a)], axis=-1)
        for a, b in (np.radians([latitude, longitude]), np.radians([60.0, 170.0]))
    )
    away = np.degrees(np.arccos(places @ middle))
    assert (away.max(), away.min()) == pytest.approx((10.0, 4.0), abs=1e-3)
    # Its longer axis heads east.
    assert longitude[0] > 180.0
    assert latitude[90] < 57.0 or latitude[90] > 63.0


def test_density_on_the_body_counts_each_impact_over_the_area_around_it() -> None:
    corners = 1e3 * TETRAHEDRON[FACES]
    area = 2.0 * np.sqrt(3.0) * 1e6
    density = facet_density(corners, np.array([2, 2, 2, 0]))
    assert density * area / 1e4 == pytest.approx([1.0, 0.0, 3.0, 0.0])
    assert colour_ends(density)[1] == density.max()
    with figure_style():
        figure = body_figure(1e3 * TETRAHEDRON, FACES, np.array([2, 2, 2, 0]), np.array([300.0, 300.0, 300.0]))
    assert "from the south" in texts(figure)


def test_rest_figure_shows_both_grounds_over_one_window_or_says_why_not() -> None:
    generator = np.random.default_rng(7)
    latitude, longitude = 10 + generator.normal(size=50), 30 + generator.normal(size=50)
    hard = RestMap("On hard ground", latitude, longitude, ELLIPSES, [Share("at rest", 0.9, 0.85, 0.95)])
    soil = RestMap("On soil", latitude + 3.0, longitude, None, [Share("at rest", 0.5, 0.4, 0.6)])
    with figure_style():
        figure = rest_figure([soil, hard], (10.0, 30.0))
        silent = rest_figure(
            [RestMap("On soil", latitude[:0], latitude[:0], None, [], "not asked"), hard], (10.0, 30.0)
        )
    maps = [axes for axes in figure.axes if axes.get_title(loc="left").startswith("On ")]
    assert maps[0].get_ylim() == maps[1].get_ylim()
    assert "50 % (40-60 %)" in texts(figure)
    assert "not asked" in texts(silent)


def test_no_impact_is_lost_on_the_map_of_the_whole_body() -> None:
    generator = np.random.default_rng(6)
    latitude, longitude = generator.uniform(-90, 90, 12_000), generator.uniform(-180, 180, 12_000)
    drawn, words = draw_density(Figure().add_subplot(), latitude, longitude, WHOLE, 9.0)
    assert drawn.get_array().sum() == 12_000
    assert words == "impacts per cell of 3 deg"


def test_impacts_all_over_the_body_have_no_close_view() -> None:
    assert close_window(np.linspace(-60, 60, 50), np.linspace(-180, 180, 50), (0.0, 0.0)) is None


def test_neighbours_are_counted_across_the_date_line() -> None:
    count = neighbour_count(np.zeros(3), np.array([-179.0, 179.0, 90.0]), 5.0)
    assert count.tolist() == [2.0, 2.0, 1.0]


def test_the_look_leaves_the_settings_of_others_alone() -> None:
    before = dict(matplotlib.rcParams)
    with figure_style():
        pass
    assert dict(matplotlib.rcParams) == before


def test_an_input_without_a_label_keeps_its_key_in_words() -> None:
    assert input_label("lander.solar_panel_area") == "lander: solar panel area"
    assert input_label("solver.inputs.plate_tilt_deg", "deg") == "plate tilt [deg]"
    assert input_label("grain.friction") == r"friction $\mu$, grains"
    assert input_label("grain.density", "kg/m3") == r"density $\rho$, grains [kg/m$^3$]"
