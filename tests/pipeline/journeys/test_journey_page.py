"""The page of a study of journeys: the end first, and what is of the first touchdown alone says so."""

import dataclasses
import math
import re
from pathlib import Path

import numpy as np
import pytest

from lithobrake.report import write_report
from lithobrake.report.content import Content, PageTable
from lithobrake.report.figures.ground_map import round_length
from lithobrake.report.live.body_view import end_views
from lithobrake.report.pages.journey_page import journey_content
from lithobrake.results import StudyResults
from lithobrake.results.page_data import JourneyPage, page_results
from lithobrake.results.run_results import CountedShare
from lithobrake.statements import journeys as words
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.outcomes import END_COLOURS, JourneyEnd
from lithobrake.vocabulary.percentages import LEVEL, with_interval

from ...report.browser import browser_page, needs_browser


@pytest.fixture
def data(journeys: StudyResults) -> JourneyPage:
    found = page_results(journeys)
    assert isinstance(found, JourneyPage)
    return found


def tables_of(content: Content) -> dict[str, PageTable]:
    return {table.title: table for section in content.sections for table in section.tables}


def test_the_page_begins_with_the_share_at_rest_and_four_others(data: JourneyPage, journeys_folder: Path) -> None:
    page = write_report(journeys_folder).read_text(encoding="utf-8")
    content, at_rest = journey_content(data), data.ends[JourneyEnd.AT_REST].share
    assert content.answer.startswith(with_interval(at_rest, level=LEVEL))
    assert len(content.tiles) == 4
    assert not any(tile.words.startswith("at rest") for tile in content.tiles)
    assert float(content.tiles[0].value) == pytest.approx(
        data.at_rest.time_s.median.value / words.time_unit(data)[0], rel=0.05
    )
    header = page[: page.index("</header>")]
    assert header.index('class="answer"') < header.index('class="tiles"') < header.index('id="figure-1"')
    contents = ["Where", "When", "Why", "How sure", "Method", "Appendix", "Files"]
    assert re.findall(r"<h2>([^<]+)</h2>", page) == contents


def test_the_shares_of_all_ends_add_up(data: JourneyPage) -> None:
    table = tables_of(journey_content(data))["How the journeys ended"]
    assert sum(float(row[2].split(" ")[0]) for row in table.rows) == pytest.approx(100.0, abs=1.0)


def test_figures_and_tables_of_the_first_touchdown_say_so(data: JourneyPage) -> None:
    content = journey_content(data)
    names = [plot.name for plot in content.plots]
    assert names[:6] == ["ends", "outcomes", "attitude", "times", "counts", "end_variance"]
    others = [plot for plot in content.plots[6:] if plot.name != "bed"]
    assert others
    assert [plot.name for plot in others if "first touchdown" not in f"{plot.title} {plot.sentence}".lower()] == []
    appendix = next(section for section in content.sections if section.title == "Appendix")
    titles = {table.title for table in appendix.tables}
    assert {title for title in titles if not title.startswith("First touchdown: ")} <= {
        "Beds", "Sampled inputs",
    }  # fmt: skip


def test_figures_without_landers_at_rest_are_left_out(data: JourneyPage) -> None:
    none = np.full(data.journeys.row_count, JourneyEnd.ESCAPED.value)
    columns = dict(data.journeys.columns)
    columns["end"] = dataclasses.replace(columns["end"], values=none)
    nothing = dataclasses.replace(data.at_rest.time_s.median, value=math.nan, lower=None, upper=None)
    empty = dataclasses.replace(data.at_rest.time_s, median=nothing, q95=nothing)
    rest = dataclasses.replace(
        data.at_rest, time_s=empty, contacts=empty, distance_m=empty, tilt_deg=empty, faces={}, regions=()
    )
    ends = {end.value: CountedShare(0, Estimate(0.0, 0.0, 0.2)) for end in JourneyEnd}
    ends[JourneyEnd.ESCAPED] = CountedShare(48, Estimate(1.0, 0.8, 1.0))
    table = type(data.journeys)(data.journeys.row, columns)
    content = journey_content(dataclasses.replace(data, journeys=table, ends=ends, at_rest=rest))
    assert [plot.name for plot in content.plots][:2] == ["counts", "end_variance"]
    assert [tile.value for tile in content.tiles].count("0") == 3


@pytest.mark.parametrize(("most", "length"), [(7.3, 5.0), (5.0, 5.0), (1.99, 1.0), (0.3, 0.2), (250.0, 200.0)])
def test_a_bar_of_lengths_is_a_round_one(most: float, length: float) -> None:
    assert round_length(most) == pytest.approx(length, rel=1e-12)


def test_the_view_in_three_dimensions_has_the_flights_of_journeys(data: JourneyPage) -> None:
    ways, ends = data.paths
    arcs = [end for end in ends if end == JourneyEnd.AT_REST]
    assert len(ways) == len(ends) > len(arcs) > 0
    (view,) = end_views(data)
    on_ground = int(np.isfinite(data.journeys["latitude_deg"]).sum())
    assert f"where {on_ground} landers ended on the ground" in view.html
    assert f"--key: {END_COLOURS[JourneyEnd.AT_REST]}" in view.html
    # A lander with several flights is one way, of so many flights.
    flights = [int(count) for count in re.findall(r'"flights": (\d+)', view.html)]
    assert sum(flights) == len(ways)
    assert len(flights) == len(np.unique(data.path_times[1]))


@needs_browser
def test_the_page_takes_three_sheets_of_paper_at_most(journeys_folder: Path, tmp_path: Path) -> None:
    path = write_report(journeys_folder)
    with browser_page(tmp_path) as page:
        page.open(path, 1280)
        assert 2 <= page.sheets() <= 3
        assert page.complaints == []
