"""The page of a study of journeys: the end first, and what is of the first touchdown alone says so."""

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest

from lithobrake.report import write_report
from lithobrake.report.figures.close_view import round_length
from lithobrake.report.page_data import JourneyPage, page_results
from lithobrake.report.pages.journey_page import DECIDES, FIRST, WHERE, journey_content
from lithobrake.results import StudyResults
from lithobrake.results.journey_results import EndShare
from lithobrake.vocabulary.outcomes import JourneyEnd

from ...report.page_text import visible_text


@pytest.fixture
def data(journeys: StudyResults) -> JourneyPage:
    found = page_results(journeys)
    assert isinstance(found, JourneyPage)
    return found


def test_the_page_begins_with_the_ends_of_the_journeys(journeys_folder: Path) -> None:
    page = write_report(journeys_folder).read_text(encoding="utf-8")
    lines = visible_text(page).splitlines()
    first = [line for line in lines if re.match(r"[\d.]+ % \|", line)]
    assert [line.split(" | ")[1].split(",")[0] for line in first] == [end.label for end in JourneyEnd]
    assert sum(float(line.split(" ")[0]) for line in first) == pytest.approx(100.0, abs=1.0)
    places = [lines.index(words) for words in (WHERE, DECIDES, FIRST)]
    assert places == sorted(places)
    assert lines.index(first[-1]) < places[0]
    captions = {line.split(". ")[1]: line for line in lines if line.startswith("Figure ") and ". " in line}
    assert next(iter(captions)) == "Where the landers rest"
    assert "Where it rests" not in captions
    assert 'class="absent"' not in page


def test_figures_and_tables_of_the_first_touchdown_say_so(data: JourneyPage) -> None:
    content = journey_content(data)
    names = [plot.name for plot in content.plots]
    assert names[:5] == ["ends", "times", "counts", "attitude", "end_variance"]
    assert all("first touchdown" in plot.sentence for plot in content.plots[5:])
    titles = [table.title for table in content.tables]
    assert titles[0] == "How the journeys ended"
    others = [title for title in titles[1:] if not title.startswith("First touchdown: ")]
    assert set(others) <= {"Beds", "Site and body", "Inputs that the runs draw"}


def test_figures_without_landers_at_rest_are_left_out(data: JourneyPage) -> None:
    none = np.full(data.journeys.row_count, JourneyEnd.ESCAPED.value)
    columns = dict(data.journeys.columns)
    columns["end"] = dataclasses.replace(columns["end"], values=none)
    nothing = dataclasses.replace(data.at_rest.time_s.median, value=None, lower=None, upper=None)
    empty = dataclasses.replace(data.at_rest.time_s, median=nothing, q95=nothing)
    rest = dataclasses.replace(
        data.at_rest, time_s=empty, contacts=empty, distance_m=empty, tilt_deg=empty, faces={}, regions=()
    )
    ends = {end.value: EndShare(0, 0.0, 0.0, 0.2) for end in JourneyEnd}
    ends[JourneyEnd.ESCAPED] = EndShare(48, 1.0, 0.8, 1.0)
    table = type(data.journeys)(data.journeys.row, columns)
    content = journey_content(dataclasses.replace(data, journeys=table, ends=ends, at_rest=rest))
    assert [plot.name for plot in content.plots][:2] == ["counts", "end_variance"]
    assert content.plots[0].heading == WHERE


@pytest.mark.parametrize(("most", "length"), [(7.3, 5.0), (5.0, 5.0), (1.99, 1.0), (0.3, 0.2), (250.0, 200.0)])
def test_a_bar_of_lengths_is_a_round_one(most: float, length: float) -> None:
    assert round_length(most) == pytest.approx(length, rel=1e-12)


def test_the_view_in_three_dimensions_has_the_flights_of_journeys(data: JourneyPage) -> None:
    ways, ends = data.paths
    arcs = [end for end in ends if end == JourneyEnd.AT_REST]
    assert len(ways) == len(ends) > len(arcs) > 0
    section = next(one for one in journey_content(data).live if "Where the landers rest, to turn" in one.html)
    on_ground = int(np.isfinite(data.journeys["latitude_deg"]).sum())
    assert f"where {on_ground} landers ended on the ground" in section.html
