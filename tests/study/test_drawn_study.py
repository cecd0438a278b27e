"""Keys of a drawn study: its defaults, and what is refused."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from lithobrake.study import Study, StudyError, check_tables
from lithobrake.study.bed_section import JOURNEYS_A_BED, LANDINGS_A_BED, default_bed_count
from lithobrake.study.template import template

TABLES: dict[str, Any] = tomllib.loads(template()) | {"design": {"method": "drawn"}}


def study(changes: dict[str, dict[str, Any]]) -> Study:
    """The template by the drawn method, with other keys in its tables."""
    tables = TABLES | {name: {**TABLES.get(name, {}), **keys} for name, keys in changes.items()}
    return check_tables(tables, Path())


def test_the_drawn_method_draws_what_is_left_open() -> None:
    found = study({})
    assert (found.impact.azimuth_deg, found.impact.orientation) == ("random", "random")
    assert (found.design.run_count, found.bed_count, found.design.side_runs) == (240, 12, False)


def test_sequence_is_an_alias_of_the_drawn_method() -> None:
    alias = study({"design": {"method": "sequence"}})
    assert alias == study({})
    assert alias.model_dump()["design"]["method"] == "drawn"


def test_what_is_given_is_kept() -> None:
    given = {"azimuth_deg": 30.0, "orientation": [1, 0, 0, 0], "pointing_error_deg": 3}
    found = study({"impact": given, "bed": {"bed_count": 7}})
    assert (found.impact.azimuth_deg, found.impact.orientation) == (30.0, (1.0, 0.0, 0.0, 0.0))
    assert (found.impact.pointing_error_deg, found.bed_count) == (3.0, 7)


def test_an_error_of_pointing_is_about_the_attitude_as_given_even_if_that_is_left_out() -> None:
    assert study({"impact": {"pointing_error_deg": 3.0}}).impact.orientation == (1.0, 0.0, 0.0, 0.0)


def test_the_papers_method_has_its_defaults_still() -> None:
    found = check_tables(TABLES | {"design": {"method": "paper"}}, Path())
    assert (found.impact.azimuth_deg, found.impact.orientation) == (0.0, (1.0, 0.0, 0.0, 0.0))
    assert found.bed_count == 1


def test_beds_follow_from_the_runs_within_limits() -> None:
    landings = {8: 8, 12: 12, 240: 12, 241: 13, 600: 30, 100_000: 1000}
    journeys = {8: 8, 48: 12, 49: 13, 240: 60, 5000: 1000}
    assert {runs: default_bed_count(runs, LANDINGS_A_BED) for runs in landings} == landings
    assert {runs: default_bed_count(runs, JOURNEYS_A_BED) for runs in journeys} == journeys


REFUSED: list[tuple[dict[str, dict[str, Any]], list[str]]] = [
    ({"design": {"refined_level": 3, "fit": "ols"}},
     ['design.fit, design.refined_level go with design.method = "paper", and it is "drawn"']),
    ({"monte_carlo": {"scatter": True}}, ['monte_carlo.scatter is true and goes with design.method = "paper"']),
    ({"design": {"run_count": 20}, "bed": {"bed_count": 21}}, ["bed.bed_count is 21, and design.run_count 20"]),
    ({"design": {"half_width": 0.1, "half_width_of": "fast"}}, ['design.half_width_of is "fast"; allowed: a name of']),
    ({"design": {"half_width_of": "fast"}, "limit_states": {"fast": "returns"}},
     ['design.half_width_of is "fast", and there is no design.half_width']),
    ({"design": {"half_width": 0.5}}, ["design.half_width is 0.5", "above 0 and below 0.5"]),
    ({"design": {"largest_run_count": 500}}, ["design.largest_run_count is 500, and nothing asks for more"]),
    ({"design": {"half_width": 0.02, "largest_run_count": 100}},
     ["design.largest_run_count is 100; allowed: at least design.run_count, 240"]),
    ({"design": {"half_width": 0.02}, "bed": {"bed_count": 1}}, ["design.half_width is 0.02, and runs on one bed"]),
    ({"design": {"method": "paper", "half_width": 0.02}},
     ['design.half_width goes with design.method = "drawn", and it is "paper"']),
    ({"design": {"run_count": "many"}}, ["design.run_count is", "whole number"]),
    ({"design": {"side_runs": "yes"}}, ["design.side_runs is", "true or false"]),
    ({"design": {"side_runs": True, "twin_shift": 0.0}}, ["design.twin_shift is 0", "above 0 [m]"]),
    ({"impact": {"orientation": "random", "pointing_error_deg": 5.0}},
     ["impact.pointing_error_deg is 5", "points anywhere already"]),
    ({"impact": {"place": {"x": 0.0}, "region": {"x": [-0.1, 0.1], "y": [0.0, 0.1]}}}, ["are both given"]),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "words"), REFUSED, ids=[words[0] for _, words in REFUSED])
def test_what_does_not_go_with_the_drawn_method_is_refused_in_one_sentence(
    changes: dict[str, dict[str, Any]], words: list[str]
) -> None:
    with pytest.raises(StudyError) as refusal:
        study(changes)
    (said,) = refusal.value.problems
    for word in words:
        assert word in said


def test_tables_that_are_none_are_refused_as_ever() -> None:
    for name in ("bed", "impact", "design"):
        with pytest.raises(StudyError, match=f"{name} is 3"):
            check_tables(TABLES | {name: 3}, Path())
