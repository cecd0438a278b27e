"""Limit states of a drawn study, from its file to its report, against what is known of the synthetic landings."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import lithobrake
from lithobrake.analysis.unseen_event import even_limit
from lithobrake.pipeline.answer.question_answers import limit_state_results
from lithobrake.pipeline.site import Site
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.results import StudyResults
from lithobrake.results.study_files import json_values
from lithobrake.study import check_tables

from ...synthetic_landings import OUTPUT_NAMES, WEAK, random_soils
from ..few_terms import fewest_terms
from ..synthetic_lander import SyntheticLander, synthetic_tables

# About a tenth and a two-hundredth of the landers that leave are faster [m/s].
FAST, FASTEST = 0.14, 0.21
CONDITIONS = {
    "fast": f"speed_out > {FAST}", "fastest": f"speed_out > {FASTEST}", "gone": "returns == false",
    "caught": "captured", "fast_and_back": f"speed_out > {FAST} and returns", "held": "settled", "lifted": "lofted",
}  # fmt: skip


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """A study of 150 landings, to its page."""
    changes = {"hard_ground": {"count": 0}, "flight": {"flight_count": 100}}
    tables = synthetic_tables(design={"run_count": 150}, limit_states=CONDITIONS, **changes)
    return lithobrake.run(tables, tmp_path_factory.mktemp("limits") / "out", workers=1, model=SyntheticLander())


@pytest.fixture(scope="module")
def found(results: StudyResults) -> dict[str, Any]:
    states: dict[str, Any] = results.summary["results"]["limit_states"]
    return states


def share_faster(speed: float) -> float:
    """Share of the landers of the truth that leave faster."""
    random = np.random.default_rng(5)
    left = WEAK.draw(random_soils(200_000, random), random.standard_normal(200_000), random).left
    return float((left[:, OUTPUT_NAMES.index("speed_out")] > speed).mean())


def test_a_common_limit_state_is_told_by_the_runs_and_a_rare_one_by_the_emulator(found: dict[str, Any]) -> None:
    assert list(found) == list(CONDITIONS)
    assert (found["fast"]["source"], found["fastest"]["source"]) == ("runs", "emulator")
    for name, speed in (("fast", FAST), ("fastest", FASTEST)):
        truth = share_faster(speed)
        assert found[name]["lower"] < truth < found[name]["upper"], (name, truth)
    rare = found["fastest"]
    # Of 150 landings on 12 beds, the same with 12 or with 13 on each.
    assert even_limit(156, 12) < rare["tail_limit"] < even_limit(144, 12)
    assert rare["upper"] >= rare["tail_limit"]
    # It is the landings and the beds that limit it.
    assert "; 150 landings on 12 beds cannot resolve probabilities below " in rare["statement"]


def test_words_agree_with_the_shares_of_the_study(results: StudyResults, found: dict[str, Any]) -> None:
    returns = results.summary["results"]["returns"]
    gone = found["gone"]["runs"]
    assert 1.0 - gone["share"] == pytest.approx(returns["share"], abs=1e-9)
    assert [1.0 - gone["upper"], 1.0 - gone["lower"]] == pytest.approx([returns["lower"], returns["upper"]], abs=1e-9)
    # Of a fate alone the flights of the runs say more than samples of the emulator.
    assert (found["gone"]["source"], found["gone"]["emulator"]) == ("runs", None)
    captured = results.summary["results"]["runs"]["outcomes"]["captured"]
    assert found["caught"]["failing_runs"] == captured
    assert found["fast_and_back"]["failing_runs"] < found["fast"]["failing_runs"]
    # At the equator of Didymos nothing lies on the ground.
    assert (found["held"]["failing_runs"], found["lifted"]["failing_runs"]) == (0.0, captured)


def test_inputs_stand_beside_what_luck_would_do(found: dict[str, Any]) -> None:
    for state in found.values():
        for one in state["inputs"].values():
            assert 0.0 <= one["lower"] <= one["distance"] <= one["upper"] <= 1.0
            assert one["found"] == (one["distance"] > one["luck"])
    assert len(found["fast"]["inputs"]) == 5


def test_every_key_is_described_and_the_page_has_the_sentences(results: StudyResults, found: dict[str, Any]) -> None:
    assert json_values(results.results) == results.summary["results"]
    page = (results.folder / "report" / "index.html").read_text(encoding="utf-8")
    for name, state in found.items():
        assert state["statement"].startswith(f"{name} ({state['condition']}): ")
        assert state["statement"] in results.headline
    assert "Limit states" in page
    assert "Inputs of the limit states" in page


def test_one_bed_has_no_interval_and_says_why(tmp_path: Path) -> None:
    few = {"design": {"run_count": 16}, "monte_carlo": {"sample_count": 200}, "flight": {"flight_count": 50}}
    changes = {"bed": {"bed_count": 1}, "hard_ground": {"count": 0}, "limit_states": {"fast": "speed_out > 0.1"}}
    tables = synthetic_tables(**few, **changes)
    with fewest_terms():
        results = lithobrake.run(tables, tmp_path / "out", workers=1, model=SyntheticLander(), report=False)
    state = results.summary["results"]["limit_states"]["fast"]
    assert (state["lower"], state["upper"], state["source"], state["inputs"]) == (None, None, "runs", {})
    assert "on one bed" in state["why"]


def test_an_output_that_no_run_has_is_refused(results: StudyResults) -> None:
    study = check_tables(synthetic_tables(limit_states={"hard": "peak_acceleration > 50"}), Path())
    job: Any = SimpleNamespace(study=study, folder=StudyFolder.only_read(results.folder), site=Site(study))
    with pytest.raises(ValueError, match=r"limit_states\.hard uses peak_acceleration, which no run has"):
        limit_state_results(job, {}, {})
