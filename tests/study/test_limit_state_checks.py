"""Limit states of journeys that a study cannot answer, or none can meet, are refused in one sentence."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from lithobrake.study import StudyError, check_tables
from lithobrake.study.limit_state_checks import option_states
from lithobrake.study.template import template
from lithobrake.vocabulary.limit_state import LimitState

from ..pipeline.journeys.bouncing_lander import journey_tables


def refusal(condition: str, name: str = "near", **changes: dict[str, Any]) -> str:
    with pytest.raises(StudyError) as error:
        check_tables(journey_tables(limit_states={name: condition}, **changes), Path())
    (said,) = error.value.problems
    assert "\n" not in said
    return str(said)


@pytest.mark.parametrize(("condition", "words"), [
    ("distance < 0", "which no journey can meet: distance is above 0 m"),
    ("distance <= -5", "which no journey can meet: distance is above 0 m"),
    ("20 <= distance <= 20", "which no journey can meet"),
    ("distance < 20 and distance > 30", "which no journey can meet"),
    ("latitude_deg > 91", "which no journey can meet: latitude_deg is from -90 to 90 deg"),
    ("longitude_deg > 190", "which no journey can meet: longitude_deg is from -180 to 180 deg"),
    ("20 < latitude_deg < 10", "which no journey can meet"),
    ("latitude_deg > 10 and distance < 30 and latitude_deg < 5", "which no journey can meet"),
    ("face == +z and face == -z", "which no journey can meet; correct"),
    ("under_way and distance < 20", "which no journey can meet"),
    ("contacts < 1 and at_rest", "which no journey can meet: contacts is at least 1"),
    ("1 < contacts < 2 and at_rest", "which no journey can meet"),
    ("distance < 20 or not distance < 20", "which every journey meets"),
    ("at_rest or escaped or partner or under_way", "which every journey meets"),
    ("sun_hours > 25", "which no journey can meet: sun_hours is from 0 to 24 h"),
    ("orbiter_hours > 2", "uses orbiter_hours, and [sky] does not ask for it (it asks for: sun, earth)"),
])  # fmt: skip
def test_what_no_journey_can_meet_or_every_one_does_is_refused(condition: str, words: str) -> None:
    said = refusal(condition)
    assert said.startswith("study.toml: limit_states.near ")
    assert words in said


@pytest.mark.parametrize("condition", [
    "distance < 20", "distance < 1e9", "not distance < 20", "face == +z or face == -z", "contacts <= 1 and at_rest",
    "longitude_deg > 170 or longitude_deg < -170", "distance < 30 and latitude_deg < 70", "escaped or distance > 3",
    "path_length < distance", "not at_rest", "1 < contacts < 3 and at_rest", "sun_hours > 8 and earth_hours > 2",
])  # fmt: skip
def test_what_some_journeys_can_meet_is_kept(condition: str) -> None:
    study = check_tables(journey_tables(limit_states={"near": condition}), Path())
    assert LimitState.of(study.limit_states.conditions()["near"]).journey


def test_what_the_study_does_not_follow_is_refused() -> None:
    first = refusal("distance < 20", journey={"touchdowns": 1, "emulated_count": None})
    assert "uses distance, and journey.touchdowns = 1 follows landers for their first touchdown alone" in first
    ball = {"shape": "sphere", "diameter": 0.1, "edges": None}
    assert "uses face, and the lander is a ball" in refusal("face == +z", lander=ball)
    assert "at_rest has a name that is one of the results" in refusal("distance < 20", name="at_rest")
    asked = {"half_width": 0.05, "half_width_of": "near"}
    assert 'design.half_width_of is "near", which uses sun_hours' in refusal("sun_hours > 8", design=asked)


def test_a_distance_needs_an_aim_point() -> None:
    tables = tomllib.loads(template()) | {"limit_states": {"near": "distance < 20"}, "journey": {}}
    tables["site"] = {key: value for key, value in tables["site"].items() if not key.startswith(("latit", "longit"))}
    with pytest.raises(StudyError) as error:
        check_tables(tables, Path())
    assert any("limit_states.near uses distance, and the study has no aim point" in one for one in error.value.problems)


def test_options_are_compared_by_what_their_landers_tell() -> None:
    grid = {"grid": {"delivery.speed": [0.05, 0.07]}}
    states = {"near": "distance < 20", "down": "face == +z", "fast": "speed_out > 0.1"}
    asked = grid | {"best": "near", "within": ["near > 0.2"]}
    study = check_tables(journey_tables(limit_states=states, aim=asked), Path())
    assert list(option_states(study)) == ["near"]
    for best in ("down", "fast", "nowhere"):
        with pytest.raises(StudyError, match=rf'aim.best is "{best}"; allowed: a limit state of journeys'):
            check_tables(journey_tables(limit_states=states, aim=grid | {"best": best}), Path())
    with pytest.raises(StudyError, match=r"aim\.best is given without aim\.grid"):
        check_tables(journey_tables(limit_states=states, aim={"best": "near"}), Path())
