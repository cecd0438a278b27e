"""Figures of studies without journeys one by one; tests/pipeline/journeys has those of journeys."""

from pathlib import Path

import matplotlib
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure

import lithobrake
from lithobrake.report.figures.style import STYLE


def test_what_becomes_of_the_landings_is_that_of_the_summary(sequence_folder: Path) -> None:
    results = lithobrake.open_study(sequence_folder)
    axes = results.plot.ends(Figure().subplots())
    widths = {
        label.get_text(): bar.get_width() for label, bar in zip(axes.get_yticklabels(), axes.patches, strict=True)
    }
    assert widths["captured"] == pytest.approx(100 * results.results.shares.outcomes["captured"].share.value)
    landings = results.plot.rebounds(Figure().subplots()).collections[0].get_offsets()
    assert len(landings) == results.results.runs.outcomes["clear"]


def test_a_figure_of_its_own_has_the_look_of_the_report(sequence_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(matplotlib.rcParams, "axes.edgecolor", "red")
    plot = lithobrake.open_study(sequence_folder).plot
    axes = plot.map()
    assert axes.spines["left"].get_edgecolor() == matplotlib.colors.to_rgba(STYLE["axes.edgecolor"])
    assert plot.variance(Figure().subplots()).spines["bottom"].get_edgecolor() == matplotlib.colors.to_rgba("red")
    pyplot.close(axes.figure)


def test_a_figure_that_a_study_lacks_is_refused_in_a_sentence(study_folder: Path, tmp_path: Path) -> None:
    plot = lithobrake.open_study(study_folder).plot
    assert plot.map(Figure().subplots()).has_data()
    with pytest.raises(ValueError, match=r"^plot\.times shows journeys to rest, which .*; it has plot\.map"):
        plot.times()
    with pytest.raises(ValueError, match="paper study, without parts of the variance"):
        plot.variance()
    (tmp_path / "summary.json").write_text("{}")
    with pytest.raises(ValueError, match=r"lacks study\.toml"):
        lithobrake.open_study(tmp_path).plot.map()
