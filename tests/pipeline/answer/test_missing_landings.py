"""Landings without an outcome: counts, the warning, and which landings a number describes."""

from pathlib import Path

import numpy as np
import pytest

from lithobrake.pipeline.answer.run_answers import described, left_in_flight, missing_landings, missing_warning
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.run_results import MissingLandings
from lithobrake.study import Study, check_tables

from ..synthetic_lander import synthetic_tables

OUTCOMES = ["clear", "clear", "captured", "left_sideways", "failed"]


@pytest.fixture(scope="module")
def study() -> Study:
    return check_tables(synthetic_tables(), Path())


def test_landings_without_an_outcome_are_counted_by_how_they_ended() -> None:
    found = missing_landings({"clear": 6, "captured": 1, "left_sideways": 2, "failed": 1})
    assert found == MissingLandings(3, 0.3, {"left_sideways": 2, "failed": 1})
    assert missing_landings({"clear": 3}) == MissingLandings(0, 0.0, {})


def test_more_than_2_per_cent_without_an_outcome_are_warned_of_with_the_cure(study: Study) -> None:
    assert missing_warning(study, {"clear": 98, "left_sideways": 2}) is None
    said = missing_warning(study, {"clear": 204, "left_sideways": 30, "time_limit": 6})
    assert said.startswith("36 of 240 landings (15 %) have no outcome (30 left the bed laterally, 6 in contact at ")
    assert "intervals hold whatever became of them" in said
    assert "describe only the other 204" in said
    for key in ("bed.width", "impact.incidence_deg", "landing.time_limit"):
        assert key in said
    assert "time_limit" not in (missing_warning(study, {"clear": 9, "left_sideways": 1}) or "")


def test_a_number_says_which_landings_it_describes() -> None:
    known = np.array([True, True, False, False, False])
    assert described(known, OUTCOMES) == "the 2 of 5 landings that left the surface"
    assert described(known | [False, False, True, False, False], OUTCOMES) == (
        "the 3 of 5 landings that left the surface or were captured"
    )


def test_those_that_left_in_flight_across_the_edge_are_like_those_that_are_missing() -> None:
    over = {"over_rim": np.array([1.0, 0.0, np.nan, np.nan, np.nan])}
    runs = DesignRuns([""] * 5, OUTCOMES, [""] * 5, {}, over)
    assert left_in_flight(runs).tolist() == [True, False, False, False, False]
