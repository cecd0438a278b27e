"""The page of landers that are followed to rest, of a study that asks for all there is."""

import re
from collections import Counter
from dataclasses import replace
from math import nan
from pathlib import Path

import numpy as np
import pytest

from lithobrake.report.content import Content, PageTable
from lithobrake.report.live.body_view import body_views
from lithobrake.report.pages.study_page import study_content
from lithobrake.report.tables.ground_strip import scale_end
from lithobrake.results import Table
from lithobrake.results.ground_results import FinerGround, GroundKindResults, OverGrounds
from lithobrake.results.page_data import PageData
from lithobrake.results.run_results import CountedShare
from lithobrake.statements import journeys as words
from lithobrake.statements.answers import study_answer, study_headline
from lithobrake.statements.ends import Scope
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import LEVEL, with_interval
from lithobrake.vocabulary.outcomes import END_COLOURS, JourneyEnd

SECTIONS = ["Where", "When", "Why", "How sure", "Method", "First touchdown", "Appendix", "Files"]


def tables_of(content: Content, title: str) -> dict[str, PageTable]:
    """The tables of a section that have a row."""
    (section,) = (one for one in content.sections if one.title == title)
    return {table.title: table for table in section.tables if table.rows}


def alone(data: PageData) -> PageData:
    """The same study without what it asks for beside the landers at rest."""
    results = replace(
        data.results, samples=None, expansion=None, emulator=None, hard_ground={}, limit_states={}, soils={}, sky={}
    )
    return replace(data, results=results, samples=None, expansion=None, hard_ground={})


def test_the_page_begins_with_the_share_at_rest_and_four_others(asked: PageData, asked_page: str) -> None:
    content, at_rest = study_content(asked), asked.results.ends[JourneyEnd.AT_REST].share
    assert content.answer.startswith(with_interval(at_rest, level=LEVEL))
    assert len(content.tiles) == 4
    assert not any(tile.words.startswith("at rest") for tile in content.tiles)
    rest = asked.journeys.rest
    assert float(content.tiles[0].value) == pytest.approx(rest.time_s.median.value / words.time_unit(rest)[0], rel=0.05)
    header = asked_page[: asked_page.index("</header>")]
    assert header.index('class="answer"') < header.index('class="tiles"') < header.index('id="figure-1"')
    assert re.findall(r"<h2>([^<]+)</h2>", asked_page) == SECTIONS


def on_grounds(data: PageData) -> PageData:
    """The same study as if it had two kinds of ground, and finer ground than any that is simulated."""

    def kind(weight: float, count: int, time_s: Estimate) -> GroundKindResults:
        share = CountedShare(count, Estimate(1.0, 0.8, 1.0))
        return GroundKindResults(weight, 12, count, (0.1, 0.2), share, time_s, Estimate(11.0, 7.0, 13.0), {})

    finest = FinerGround(0.1, 0.35, 20, CountedShare(20, Estimate(1.0, 0.7, 1.0)), Estimate(400.0, 300.0, 500.0),
                         Estimate(9.0, 6.0, 12.0))  # fmt: skip
    over = OverGrounds(Estimate(0.9, 0.62, 1.0), Estimate(900.0, 500.0, 1700.0), Estimate(12.0, 5.0, 31.0), {})
    kinds = {
        "gravel": kind(0.6, 28, Estimate(700.0, 600.0, 800.0)),
        "rock": kind(0.4, 20, Estimate(1500.0, None, None)),
    }
    return replace(data, results=replace(data.results, grounds=kinds, finer_ground=finest, over_grounds=over))


def test_on_unknown_ground_the_page_begins_with_the_answer_on_each_kind(asked: PageData) -> None:
    content = study_content(on_grounds(asked))
    assert content.answer.startswith("90 % (90 % interval 62-100 %)")
    strip = content.strip
    assert strip is not None
    assert [name for name, _ in strip.rows] == ["gravel", "rock", "finest", "one of these"]
    rests, times, distances = strip.columns
    assert rests.shown == ["100 (80-100)", "100 (80-100)", "100 (70-100)", ""]
    over = rests.found[3]
    assert over is not None
    assert (over.value, *(over.bounds or ())) == pytest.approx((90.0, 62.0, 100.0))
    size, unit = words.time_unit(asked.journeys.rest)
    assert unit in times.words
    assert [one.value for one in times.found if one] == pytest.approx(
        [700.0 / size, 1500.0 / size, 400.0 / size, 900.0 / size]
    )
    assert times.end >= 1700.0 / size
    assert (distances.shown[0], distances.end) == ("11 (7-13)", 40.0)
    # What the strip has stands in no box beside it, nor in the caption of the map.
    assert not any("median" in tile.words for tile in content.tiles)
    assert content.first is not None
    assert not re.search(r"\d", content.first.sentence)
    assert study_content(asked).strip is None


@pytest.mark.parametrize(("most", "end"), [(39.7, 40.0), (100.0, 100.0), (0.23, 0.3), (7.0, 7.0), (0.0, 1.0)])
def test_a_scale_ends_at_one_digit_and_zeros(most: float, end: float) -> None:
    assert scale_end(most) == pytest.approx(end)


def test_no_figure_or_part_of_the_page_hides_another(asked: PageData, asked_page: str, asked_folder: Path) -> None:
    content = study_content(asked)
    assert max(Counter(plot.name for plot in content.plots).values()) == 1
    assert max(Counter(re.findall(r' id="([^"]+)"', asked_page)).values()) == 1
    assert len(list((asked_folder / "report").glob("*.png"))) == asked_page.count('<figure id="figure-')


def test_what_is_asked_beside_the_landers_at_rest_has_its_place(asked: PageData) -> None:
    content = study_content(asked)
    names = [plot.name for plot in content.plots]
    assert names[:7] == ["ends", "end_shares", "attitude", "hard_ground", "times", "counts", "end_variance"]
    assert {"sobol", "errors", "designs", "outputs", "body", "outcomes", "runs"} <= set(names[7:])
    assert {"Smallest regions", "On other ground", "What they see from there"} <= tables_of(content, "Where").keys()
    assert {"Limit states", "How the journeys ended"} <= tables_of(content, "How sure").keys()
    first = tables_of(content, "First touchdown")
    assert {"Return fraction", "Sobol indices", "Errors of the expansions", "Uncertain inputs"} <= first.keys()
    live = [re.findall(r'<section id="([^"]+)"', one.html) for section in content.sections for one in section.live]
    assert {"body-3d", "explorer", "touchdown-explorer"} <= {name for found in live for name in found}


def test_the_answer_names_the_fraction_at_rest_first_and_then_all_that_is_asked(asked: PageData) -> None:
    results, scope = asked.results, Scope(
        has_soil=True, bed_count=12, one_place=False, random_attitude=True, has_scatter=False, flight_time=3600.0,
        journey_time=172_800.0, to_rest=True,
    )  # fmt: skip
    said = study_answer(scope, results)
    assert "of the landers come to rest within 48 h" in said[0]
    limited = study_answer(replace(scope, touchdowns=3), results)[0]
    assert "of the landers come to rest within 3 touchdowns and 48 h" in limited
    order = ["come to rest within", "on hard ground", "fast (speed_out", "The emulator of all touchdowns"]
    places = [next(place for place, one in enumerate(said) if part in one) for part in order]
    assert places == sorted(places)
    behind = study_headline(scope, replace(results, answer=tuple(said)))[len(said) :]
    assert behind
    assert all(one.startswith("First touchdown: ") for one in behind)
    assert any("largest total Sobol index" in one for one in behind)


def test_where_all_landers_end_alike_the_answer_says_for_which_correlation_its_interval_holds(asked: PageData) -> None:
    results, rests = asked.results, JourneyEnd.AT_REST
    scope = Scope(
        has_soil=True, bed_count=12, one_place=False, random_attitude=True, has_scatter=False, flight_time=3600.0,
        journey_time=172_800.0, to_rest=True,
    )  # fmt: skip
    words = "The interval holds for a correlation of landers on one bed of up to 0.5."
    for share, lower, is_said in ((1.0, 0.9, True), (0.98, 0.9, False), (1.0, None, False)):
        ends = {**results.ends, rests: CountedShare(48, Estimate(share, lower, None if lower is None else 1.0))}
        assert (words in study_answer(scope, replace(results, ends=ends))[0]) is is_said


def test_a_study_that_asks_for_no_more_shows_no_more(asked: PageData) -> None:
    content = study_content(alone(asked))
    names = {plot.name for plot in content.plots}
    assert not names & {"sobol", "errors", "designs", "outputs", "body", "outcomes", "hard_ground", "calibration"}
    assert {"ends", "end_shares", "attitude", "times", "counts", "end_variance", "variance", "runs", "bed"} <= names
    assert not tables_of(content, "How sure").keys() & {"Limit states"}


def test_the_shares_of_all_ends_add_up(asked: PageData) -> None:
    table = tables_of(study_content(asked), "How sure")["How the journeys ended"]
    assert sum(float(row[2].split(" ")[0]) for row in table.rows) == pytest.approx(100.0, abs=1.0)


def test_figures_without_landers_at_rest_are_left_out(asked: PageData) -> None:
    data, journeys = alone(asked), asked.journeys
    none = np.full(journeys.table.row_count, JourneyEnd.ESCAPED.value)
    columns = dict(journeys.table.columns)
    columns["end"] = replace(columns["end"], values=none)
    nothing = replace(journeys.rest.time_s.median, value=nan, lower=None, upper=None)
    empty = replace(journeys.rest.time_s, median=nothing, q95=nothing)
    rest = replace(journeys.rest, time_s=empty, contacts=empty, distance_m=empty, tilt_deg=empty, faces={}, regions=())
    ends = {end.value: CountedShare(0, Estimate(0.0, 0.0, 0.2)) for end in JourneyEnd}
    ends[JourneyEnd.ESCAPED] = CountedShare(48, Estimate(1.0, 0.8, 1.0))
    lost = replace(journeys, table=Table(journeys.table.row, columns), rest=rest)
    content = study_content(replace(data, journeys=lost, results=replace(data.results, ends=ends)))
    assert [plot.name for plot in content.plots][:2] == ["counts", "end_variance"]
    assert [tile.value for tile in content.tiles].count("0") == 3


def test_the_view_in_three_dimensions_has_the_flights_of_journeys(asked: PageData) -> None:
    ways, ends = asked.paths
    assert len(ways) == len(ends) > len([end for end in ends if end == JourneyEnd.AT_REST]) > 0
    (view,) = body_views(asked)
    on_ground = int(np.isfinite(asked.journeys.table["latitude_deg"]).sum())
    assert f"where {on_ground} landers ended on the ground" in view.html
    assert f"--key: {END_COLOURS[JourneyEnd.AT_REST]}" in view.html
    # A lander with several flights is one way, of so many flights.
    flights = [int(count) for count in re.findall(r'"flights": (\d+)', view.html)]
    assert (sum(flights), len(flights)) == (len(ways), len(np.unique(asked.path_times[1])))
