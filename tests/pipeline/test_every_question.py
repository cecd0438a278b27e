"""Every question of every study: one of landers that are followed to rest, and one of first touchdowns alone."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lithobrake
from lithobrake.analysis import predictive_p_value
from lithobrake.files.reading import read_rows
from lithobrake.pipeline import compare_studies, infer_study, map_sites, rare_failure
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.results import StudyResults
from lithobrake.study import StudySource

from ..quick_studies import quick_studies
from .coarse_bodies import coarse_bodies
from .journeys import bouncing_lander

LATITUDE, LONGITUDE = bouncing_lander.TABLES["delivery"]["latitude_deg"], -60.0
# The aim point lies on the edge of a region, so that landers meet both soils.
SOILS: dict[str, Any] = {
    "slab": {"longitude_deg": [LONGITUDE, LONGITUDE + 90.0], "grain": {
        "friction": {"distribution": "uniform", "lower": 0.3, "upper": 0.5}}},
}  # fmt: skip
QUESTIONS: dict[str, dict[str, Any]] = {
    "soil": SOILS,
    "delivery": {"north_error": {"distribution": "normal", "mean": 0.0, "std": 5.0},
                 "east_error": {"distribution": "normal", "mean": 0.0, "std": 5.0}},
    "limit_states": {"fast": "speed_out > 0.05", "gone": "escaped or speed_out > 0.2"},
    "expansion": {"screening_level": 2, "screening_degree": 2, "refined_level": 2, "refined_degree": 2,
                  "test_count": 10, "kept_outputs": ["speed_out"]},
    "monte_carlo": {"sample_count": 200},
    "journey": {"emulated_count": 40},
    "flight": {"flight_count": 10},
    "hard_ground": {"count": 10},
}  # fmt: skip


def land(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """The bouncing lander; a run of a design belongs to no journey."""
    return bouncing_lander.bounce({"journey": 1000.0, "touchdown": 0.0, **inputs}, seed)


OF_JOURNEYS = {"near": "distance < 30", "lit": "sun_hours > 6 and face != +z"}


def to_rest(**changes: dict[str, Any]) -> dict[str, Any]:
    options = {"aim": {"grid": {"delivery.speed": [0.05, 0.07]}, "lander_count": 2, "best": "near"}}
    states = {"limit_states": QUESTIONS["limit_states"] | OF_JOURNEYS}
    return bouncing_lander.journey_tables(**QUESTIONS | options | states | changes)


@pytest.fixture(scope="module", autouse=True)
def coarse() -> Iterator[None]:
    with coarse_bodies():
        yield


@pytest.fixture(scope="module")
def asked(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """A study of landers to rest that is asked everything."""
    with quick_studies():
        return lithobrake.run(to_rest(), tmp_path_factory.mktemp("asked") / "study", workers=1, model=land)


def test_landers_to_rest_answer_every_question_together(asked: StudyResults) -> None:
    found = asked.results
    assert found.ends["at_rest"].count + found.ends["escaped"].count > 40
    assert found.rest is not None
    assert found.rest.time_s.median.is_known
    assert 0.0 < found.returns.share.value <= 1.0
    assert set(found.limit_states) == {"fast", "gone", *OF_JOURNEYS}
    _check_journeys(asked)
    assert found.limit_states["gone"].probability.bounds is not None
    assert set(found.sky) == {"sun", "earth"}
    assert set(found.soils) == {"slab", "elsewhere"}
    assert min(one.touchdowns for one in found.soils.values()) > 5
    assert found.emulated is not None
    assert found.emulated.agrees
    assert found.aim is not None
    assert len(found.aim.aims) == 2
    assert found.samples is not None
    assert (found.samples.model, found.samples.sample_count) == ("expansion", 200)
    assert found.emulator is not None
    assert set(found.hard_ground) >= {"hard"}
    assert len(asked.touchdowns["outcome"]) == found.touchdowns > found.journeys
    assert (asked.folder / "report" / "index.html").is_file()


def _check_journeys(asked: StudyResults) -> None:
    """Limit states of journeys from journeys.csv and sky.csv, at the options, and in what a reader sees first."""
    found, table = asked.results, asked.journeys
    near, known = found.limit_states["near"], table["end"] != "failed"
    met = (table["end"] == "at_rest") & (table["distance"] < 30.0)
    assert near.probability.value == pytest.approx(met[known].mean())
    assert (near.radius_m, near.of_journey) == (30.0, True)
    assert near.emulator is not None
    sun = [row for row in read_rows(asked.folder / "sky.csv", ("journey", "body"), "") if row["body"] == "sun"]
    lit = [int(row["journey"]) for row in sun if 24.0 * float(row["day_fraction"]) > 6.0]
    seen = np.isin(np.arange(len(met)), lit) & (table["face"] != "+z") & (table["end"] == "at_rest")
    assert found.limit_states["lit"].failing_runs == seen.sum()
    assert found.limit_states["lit"].emulator is None
    assert "near" in found.end_variance_shares
    assert found.aim is not None
    assert all(set(one.soil.limit_states) == {"near"} for one in found.aim.aims)
    assert (
        "Most landers meet near with " in found.aim.statement or "most landers meet near with " in found.aim.statement
    )
    assert near.statement in found.answer
    page = (asked.folder / "report" / "index.html").read_text(encoding="utf-8")
    assert "come to rest within 30&nbsp;m of the aim point." in page
    assert found.rest is not None
    assert found.rest.miss is not None
    assert any(one.startswith("The landers at rest lie in the mean ") for one in found.answer)


def test_the_expansion_of_the_first_touchdown_knows_what_its_speed_depends_on(asked: StudyResults) -> None:
    """The rebound is 0.8 friction down and 0.6 along: it grows with the speed of the impact most of all."""
    found = asked.results.expansion
    assert found is not None
    total = found.refined.sobol_total["speed_out"]
    assert max(total, key=lambda name: total[name]) == "impact.speed"
    assert found.scores["test_all"]["speed_out"].q2 > 0.0


def test_a_bounce_that_was_seen_tells_the_friction_of_a_study_to_rest(
    asked: StudyResults, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Bounces that are made up, to see whether one like this is seen at all; tests/analysis tests them.
    monkeypatch.setitem(predictive_p_value.__globals__, "REPLICATES", 50)
    bounces = tmp_path / "bounces.csv"
    bounces.write_text("speed_out,error:speed_out,impact.speed,impact.incidence_deg\n0.035,0.001,0.06,5\n")
    content = infer_study(asked.folder, bounces)
    assert "grain.friction" in content["inputs"]


def test_a_rare_limit_state_is_found_by_first_touchdowns_of_a_study_to_rest(tmp_path: Path) -> None:
    tables = bouncing_lander.journey_tables(limit_states={"faster": "speed_out > 0.055"})
    source = StudySource.of_tables(tables, function_identity(land))
    found = rare_failure(source, tmp_path / "study", "faster", landing_count=100, worker_count=1, model=land)
    assert 0.0 < found["probability"] < 0.2


def test_sites_are_mapped_and_two_studies_compared_on_regions_of_soil(asked: StudyResults, tmp_path: Path) -> None:
    identity = function_identity(land)
    site_map = map_sites(
        StudySource.of_tables(to_rest(), identity), asked.folder, cell_count=12, lander_count=40, worker_count=1,
        model=land,
    )  # fmt: skip
    assert len(site_map.cells) >= 10
    assert 0.0 < site_map.at_rest.value <= 1.0
    steep = {"distribution": "uniform", "lower": 0.0, "upper": 20.0}
    # Asked for what is compared, and for nothing else.
    slower = bouncing_lander.journey_tables(
        soil=SOILS,
        delivery=QUESTIONS["delivery"] | {"incidence_deg": steep},
        limit_states={"near": OF_JOURNEYS["near"]},
    )
    other = bouncing_lander.run_without_emulator(slower, tmp_path / "other", land)
    answers = compare_studies(asked.folder, other.folder).answers
    assert {"at_rest", "time_s_median", "returns", "speed_out_median", "near"} <= set(answers)
    assert answers["near"].first.value == pytest.approx(asked.results.limit_states["near"].probability.value)
    assert "lit" not in answers
    # Every site has a circle of its own.
    assert all(set(cell.ends.limit_states) == {"near"} for cell in site_map.cells if cell.ends is not None)


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """A study of first touchdowns alone, with what was asked of landers to rest."""
    pointed = {**QUESTIONS["delivery"], "orientation": [1.0, 0.0, 0.0, 0.0], "pointing_error_deg": 30.0}
    tables = bouncing_lander.journey_tables(**QUESTIONS | {"delivery": pointed, "journey": {"touchdowns": 1}})
    del tables["expansion"], tables["journey"]["emulated_count"]
    tables["bed"]["boulders"] = {"diameter": {"distribution": "constant", "value": 0.15}, "coverage": 0.1}
    tables["bed"]["width"] = [1.0, 1.0]
    with quick_studies():
        return lithobrake.run(tables, tmp_path_factory.mktemp("first") / "study", workers=1, model=land)


def test_first_touchdowns_take_sky_soils_attitude_and_boulders(first: StudyResults) -> None:
    found = first.results
    assert found.touchdowns == found.journeys == 48
    assert found.ends["under_way"].count > 30
    assert set(found.soils) == {"slab", "elsewhere"}
    assert sum(one.touchdowns for one in found.soils.values()) == 48
    assert found.samples is not None
    assert (found.samples.model, found.samples.sample_count) == ("emulator", 200)
    friction = first.samples["grain.friction"]
    # Half of the landers come down in the region, whose friction begins where that of the other ground ends.
    assert 0.2 < float(np.mean(friction < 0.5)) < 0.8
    assert first.study["bed"]["boulders"]["coverage"] == 0.1
    assert (first.folder / "report" / "index.html").is_file()
