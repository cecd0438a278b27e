"""The restitution that a soft surface implies, and journeys on hard ground that has it."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

import lithobrake
from lithobrake.pipeline.rest.hard_equivalents import implied
from lithobrake.results import StudyResults
from lithobrake.results.json_values import to_json
from lithobrake.smallbody import HardSurface, Impacts, RestitutionTable

from ...synthetic_landings import WEAK
from ..synthetic_lander import SyntheticLander, synthetic_tables

ARRIVAL = {
    "speed": {"distribution": "uniform", "lower": 0.005, "upper": 0.4},
    "incidence_deg": {"distribution": "uniform", "lower": 0.0, "upper": 88.0},
}


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    few = {"design": {"run_count": 48}, "monte_carlo": {"sample_count": 1000}, "flight": {"flight_count": 100}}
    tables = synthetic_tables(**few, impact=ARRIVAL, site={"latitude_deg": 50.0}, rest={"count": 200})
    model = SyntheticLander(dataclasses.replace(WEAK, capture=0.2), follows_speed=True)
    return lithobrake.run(tables, tmp_path_factory.mktemp("like") / "out", workers=1, model=model, report=False)


def test_hard_ground_implies_itself() -> None:
    """The rebounds of a hard surface give back the numbers that it was made of."""
    random = np.random.default_rng(1)
    speed, incidence = random.uniform(0.01, 0.4, 200), random.uniform(0.1, 1.2, 200)
    nothing, lander = np.zeros((200, 3)), np.arange(200)
    for friction in (np.inf, 0.1):
        impacts = Impacts(speed, incidence, nothing, np.full(200, -1e-4), lander)
        left = HardSurface(0.6, 0.8, friction)(impacts, random).velocity
        found = implied(speed, incidence, left)
        assert found["normal_restitution"] == pytest.approx(0.6)
        slides = found["tangential_restitution"] > 0.8 + 1e-9
        assert found["tangential_restitution"][~slides] == pytest.approx(0.8)
        assert found["friction"][slides] == pytest.approx(friction)
        assert slides.any() == np.isfinite(friction)


def test_the_table_has_what_runs_and_samples_say(results: StudyResults) -> None:
    table = RestitutionTable.read(results.folder / "restitution.csv")
    samples = results.samples
    ended = np.isin(samples["outcome"], ["clear", "captured"])
    assert table.samples.sum() == ended.sum()
    assert table.runs.sum() == np.isin(results.runs["outcome"], ["clear", "captured"]).sum() > 40
    stay = (table.captured * table.samples).sum()
    assert stay == pytest.approx((samples["outcome"] == "captured").sum())
    left = samples.where(samples["outcome"] == "clear")
    normal = left["velocity_out_z"] / (left["impact.speed"] * np.cos(np.radians(left["impact.incidence_deg"])))
    lowest, highest = (table.quantiles["normal_restitution"][:, :, place] for place in (0, -1))
    assert (lowest.min(), highest.max()) == pytest.approx((normal.min(), normal.max()))


def test_journeys_on_it_stand_beside_soil_and_hard_ground(results: StudyResults) -> None:
    rest = results.summary["results"]["rest"]
    assert rest["equivalent"]["sample_count"] == rest["soil"]["sample_count"] == 200
    assert rest["equivalent"]["outside"]["count"] == 0
    # A fifth returns at the first impact.
    assert rest["equivalent"]["settled"]["share"] > 0.2
    assert to_json(results.results) == results.summary["results"]


def test_a_study_of_one_speed_has_no_table(tmp_path: Path) -> None:
    tables = synthetic_tables(design={"run_count": 30}, monte_carlo={"sample_count": 100}, rest={"count": 20})
    out = lithobrake.run(tables, tmp_path / "out", workers=1, model=SyntheticLander(), report=False)
    assert not (out.folder / "restitution.csv").exists()
    assert out.summary["results"]["rest"]["equivalent"] is None
