"""Each figure is made from plain arrays and shows what it is given."""

from collections.abc import Iterable

import matplotlib
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from lithobrake.report.figures.body_figures import body_figure, colour_ends, facet_density
from lithobrake.report.figures.expansion_figures import Design, count_figure, scatter_figure, sobol_figure
from lithobrake.report.figures.hulls import Hull, Scene
from lithobrake.report.figures.landing_figure import bed_figure, instants, landing_figure, three_moments
from lithobrake.report.figures.model_figures import error_figure
from lithobrake.report.figures.option_figures import aim_figure
from lithobrake.report.figures.share_figures import ShareBar, draw_shares
from lithobrake.report.figures.style import figure_style
from lithobrake.report.pages.study_page import study_content
from lithobrake.results import MovingBodies
from lithobrake.results.model_results import OutputErrors
from lithobrake.results.page_data import PageData
from lithobrake.results.questions import AimOnGround, AimResult, AimResults, BestAim
from lithobrake.statements.labels import PAPER_OUTPUTS, input_label
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.outcomes import END_COLOURS, FATE_COLOURS

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


@pytest.mark.parametrize(("height", "expected"), [
    (np.abs(np.arange(11.0) - 4.0), [0, 2, 4, 6, 8, 10]),
    (np.arange(3.0), [0, 1, 2]),
    (np.arange(11.0, 0.0, -1.0), [0, 2, 4, 6, 8, 10]),
], ids=["bounces", "few frames", "never comes up"])  # fmt: skip
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
    assert words.count("no significant\ninput") == 1
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


def test_shares_end_at_the_whole_and_have_their_figures_beside_the_axis() -> None:
    axes = Figure().add_subplot()
    draw_shares(
        axes,
        [ShareBar("down", Estimate(0.75, 0.7, 0.8)), ShareBar("captured", Estimate(0.25, None, None))],
        "all 100 000 samples",
    )
    assert axes.get_xlim() == (0.0, 100.0)
    assert [text.get_text() for text in axes.texts] == ["75 % (70-80 %)", "25 %"]
    assert all(text.get_position()[0] > 1.0 for text in axes.texts)
    assert len(axes.lines) == 1
    assert axes.get_xlabel() == "share of all 100 000 samples [%], with 90 % interval"


def test_one_fate_has_one_colour_in_every_figure(first: PageData) -> None:
    plots = {plot.name: plot for plot in study_content(first).plots}
    with figure_style():
        figures = plots["outcomes"].draw(), plots["hard_ground"].draw()
    found: dict[str, set[str]] = {}
    assert figures[1] is not None
    for axes in (axes for figure in figures if figure for axes in figure.axes if axes.get_xlabel().startswith("share")):
        for label, bar in zip(axes.get_yticklabels(), axes.patches, strict=False):
            found.setdefault(label.get_text(), set()).add(matplotlib.colors.to_hex(bar.get_facecolor()))
    assert {"captured", "at rest", "under way"} <= found.keys()
    assert all(len(colours) == 1 for colours in found.values())
    assert found["captured"] == {FATE_COLOURS["captured"]}
    assert len(set(FATE_COLOURS.values())) == len(FATE_COLOURS)


# What is left of linear red, green and blue without the cones for long or for middle wavelengths [Machado-2009].
BLIND = {
    "protanopia": [(0.152286, 1.052583, -0.204868), (0.114503, 0.786281, 0.099216), (-0.003882, -0.048116, 1.051998)],
    "deuteranopia": [(0.367322, 0.860646, -0.227968), (0.280085, 0.672501, 0.047413), (-0.011820, 0.042940, 0.968881)],
}
TO_XYZ = np.array([(0.4124, 0.3576, 0.1805), (0.2126, 0.7152, 0.0722), (0.0193, 0.1192, 0.9505)])


def seen(colours: Iterable[str], matrix: list[tuple[float, ...]]) -> np.ndarray:
    """CIE L*a*b* of colours as such an eye has them, [count, 3]."""
    rgb = np.array([matplotlib.colors.to_rgb(colour) for colour in colours])
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    xyz = np.clip(linear @ np.array(matrix).T, 0.0, 1.0) @ TO_XYZ.T / (TO_XYZ @ np.ones(3))
    x, y, z = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16.0 / 116.0).T
    return np.stack([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)], axis=1)


@pytest.mark.parametrize("eye", BLIND)
@pytest.mark.parametrize(("colours", "least"), [(END_COLOURS, 25.0), (FATE_COLOURS, 12.0)], ids=["ends", "all"])
def test_colour_blind_readers_tell_outcomes_apart(eye: str, colours: dict[str, str], least: float) -> None:
    lab = seen(colours.values(), BLIND[eye])
    apart = np.linalg.norm(lab[:, None] - lab[None], axis=2)
    assert apart[np.triu_indices(len(lab), 1)].min() > least


def test_aims_share_one_scale_and_have_colour_bars() -> None:
    def far(value: float) -> Estimate:
        return Estimate(value, 0.7 * value, 1.4 * value)

    def ground(share: float) -> AimOnGround:
        settled = Estimate(share, share - 0.1, share + 0.1)
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


def test_scatter_figure_has_every_sample_in_a_cell_and_the_runs_on_top() -> None:
    generator = np.random.default_rng(5)
    samples = {name: generator.uniform(0.0, 1.0, 400) for name in PAPER_OUTPUTS}
    with figure_style():
        figure = scatter_figure(samples, {name: values[:7] for name, values in samples.items()})
    assert [float(axes.collections[0].get_array().sum()) for axes in figure.axes[:3]] == [400.0] * 3
    assert [len(axes.lines[0].get_xdata()) for axes in figure.axes[:3]] == [7] * 3


def test_an_outcome_that_no_run_had_shows_its_upper_limit_in_place_of_nothing() -> None:
    axes = Figure().add_subplot()
    draw_shares(axes, [ShareBar("captured", Estimate(0.0, None, 0.0203))], "all samples")
    assert [text.get_text() for text in axes.texts] == ["at most 2.0 %"]
    assert "% interval" not in axes.get_xlabel()


def test_shares_without_intervals_speak_of_none() -> None:
    axes = Figure().add_subplot()
    draw_shares(axes, [ShareBar("down", Estimate(0.75, None, None))], "the 200 followed")
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


def test_density_on_the_body_counts_each_impact_over_the_area_around_it() -> None:
    corners = 1e3 * TETRAHEDRON[FACES]
    area = 2.0 * np.sqrt(3.0) * 1e6
    density = facet_density(corners, np.array([2, 2, 2, 0]))
    assert density * area / 1e4 == pytest.approx([1.0, 0.0, 3.0, 0.0])
    assert colour_ends(density)[1] == density.max()
    with figure_style():
        figure = body_figure(1e3 * TETRAHEDRON, FACES, np.array([2, 2, 2, 0]), np.array([300.0, 300.0, 300.0]))
    assert "from the south" in texts(figure)


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
