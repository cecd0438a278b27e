"""Figures of studies one by one."""

from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import lithobrake
from lithobrake.report.figures.ground_map import GroundMap
from lithobrake.report.figures.style import STYLE
from lithobrake.results import StudyResults
from lithobrake.statements.labels import end_words


@pytest.fixture(scope="module")
def study(asked_folder: Path) -> StudyResults:
    return lithobrake.open_study(asked_folder)


def test_what_becomes_of_the_landings_is_that_of_the_summary(first_folder: Path) -> None:
    results = lithobrake.open_study(first_folder)
    axes = results.plot.ends(Figure().subplots())
    assert widths(axes)["captured"] == pytest.approx(100 * results.results.shares.outcomes["captured"].share.value)
    landings = results.plot.rebounds(Figure().subplots()).collections[0].get_offsets()
    assert len(landings) == results.results.runs.outcomes["clear"]


def test_a_figure_of_its_own_has_the_look_of_the_report(first_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(matplotlib.rcParams, "axes.edgecolor", "red")
    plot = lithobrake.open_study(first_folder).plot
    axes = plot.map()
    assert axes.spines["left"].get_edgecolor() == matplotlib.colors.to_rgba(STYLE["axes.edgecolor"])
    assert plot.sensitivity(Figure().subplots()).spines["bottom"].get_edgecolor() == matplotlib.colors.to_rgba("red")
    pyplot.close(axes.figure)


def test_a_figure_that_a_study_lacks_is_refused_with_those_it_has(paper_folder: Path, tmp_path: Path) -> None:
    plot = lithobrake.open_study(paper_folder).plot
    assert dir(plot) == ["ends", "map", "sobol"]
    assert plot.map(Figure().subplots()).has_data()
    has = r"; it has plot\.map, plot\.ends, plot\.sobol$"
    with pytest.raises(ValueError, match=rf"^plot\.times shows landers at rest, which .* has none of{has}"):
        plot.times()
    with pytest.raises(ValueError, match=rf"^plot\.sensitivity shows parts of a variance, which .*{has}"):
        plot.sensitivity()
    with pytest.raises(AttributeError, match=r"^plot\.sobel is no figure; did you mean sobol\?; .* has plot\.map, "):
        plot.sobel  # noqa: B018
    (tmp_path / "summary.json").write_text("{}")
    unfinished = lithobrake.open_study(tmp_path).plot
    assert dir(unfinished) == []
    with pytest.raises(ValueError, match=r"lacks study\.toml"):
        unfinished.map()


def test_a_figure_of_several_panels_is_that_of_the_page(study: StudyResults) -> None:
    rings, screening = study.plot.sobol().axes, study.results.expansion.screening
    parts = [(wedge.theta2 - wedge.theta1) / 360 for wedge in rings[0].patches]
    first = list(screening.sobol_first["speed_out"].values())
    # The rest is that of interactions.
    assert parts == pytest.approx([*first, 1 - sum(first)], abs=1e-6)


NAMES = (
    *("map", "ends", "times", "distances", "touchdowns", "contacts", "tilts", "sides", "sensitivity", "rebounds"),
)  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_a_figure_is_drawn_on_the_axes_that_are_given(name: str, study: StudyResults) -> None:
    axes = Figure().subplots()
    assert getattr(study.plot, name)(ax=axes) is axes
    assert axes.has_data()
    # The half of a body has a title in place of axes.
    assert axes.get_xlabel() or (name == "map" and axes.get_title())
    assert f"{name}()" in repr(study.plot)
    assert set(dir(study.plot)) == {*NAMES, "sobol"}


def widths(axes: Axes) -> dict[str, float]:
    """The lengths of the bars by their names."""
    return {label.get_text(): bar.get_width() for label, bar in zip(axes.get_yticklabels(), axes.patches, strict=True)}


def test_bars_of_ends_and_sides_are_their_shares(study: StudyResults) -> None:
    for axes, shares in (
        (
            study.plot.ends(Figure().subplots()),
            {end_words(study.results.site)[end]: one for end, one in study.results.ends.items()},
        ),
        (study.plot.sides(Figure().subplots()), study.results.rest.faces),
    ):
        assert widths(axes) == pytest.approx({name: 100 * one.share.value for name, one in shares.items()})


def test_every_lander_on_the_ground_is_on_the_map(study: StudyResults) -> None:
    axes, site = study.plot.map(Figure().subplots()), study.results.site
    at_rest = study.journeys.where(study.journeys["end"] == "at_rest")
    drawn = np.concatenate([dots.get_offsets() for dots in axes.collections])
    ground = GroundMap(site.latitude_deg, site.longitude_deg, float(np.linalg.norm(site.place_m)))
    for east, north in zip(*ground.places(at_rest["latitude_deg"], at_rest["longitude_deg"]), strict=True):
        assert np.min(np.hypot(drawn[:, 0] - east, drawn[:, 1] - north)) == pytest.approx(0.0, abs=1e-6)


def test_the_median_is_marked_where_half_of_the_landers_are_at_rest(study: StudyResults) -> None:
    axes, rest = study.plot.distances(Figure().subplots()), study.results.rest.distance_m
    marks = [line.get_xydata()[0].tolist() for line in axes.lines if line.get_marker() == "o"]
    assert marks == [pytest.approx([rest.median.value, 50.0]), pytest.approx([rest.q95.value, 95.0])]
