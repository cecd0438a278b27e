"""Drawn studies whose landers go on from bounce to bounce, lie on one bed, or leave it laterally."""

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lithobrake
from lithobrake.pipeline.answer.run_estimates import PARTS
from lithobrake.pipeline.job import Silent
from lithobrake.results import StudyResults
from lithobrake.results.study_files import json_values
from lithobrake.smallbody import RestitutionTable
from lithobrake.vocabulary.outcomes import JourneyStatus

from ...synthetic_landings import WEAK
from ..synthetic_lander import SyntheticLander, synthetic_tables

ARRIVAL = {
    "speed": {"distribution": "uniform", "lower": 0.005, "upper": 0.4},
    "incidence_deg": {"distribution": "uniform", "lower": 0.0, "upper": 88.0},
}
FEW = {"design": {"run_count": 48}, "monte_carlo": {"sample_count": 400}, "flight": {"flight_count": 200}}


def made(folder: Path, model: SyntheticLander, **changes: dict[str, Any]) -> StudyResults:
    return lithobrake.run(synthetic_tables(**FEW, **changes), folder, workers=1, model=model, report=False)


@pytest.fixture(scope="module")
def journeys(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """Landers at 70 degrees north of Didymos, where the ground holds them, that arrive at any speed and angle."""
    model = SyntheticLander(dataclasses.replace(WEAK, capture=0.2), follows_speed=True)
    site, rest = {"latitude_deg": 70.0}, {"count": 100}
    return made(tmp_path_factory.mktemp("journeys") / "out", model, impact=ARRIVAL, site=site, rest=rest)


def test_landers_rest_on_the_soil_and_their_shares_have_intervals(journeys: StudyResults) -> None:
    found = journeys.summary["results"]["rest"]
    assert found["why_no_soil"] is None
    soil = found["soil"]
    settled = soil[JourneyStatus.SETTLED]
    assert 0.0 < settled["lower"] < settled["share"] < settled["upper"] < 1.0
    assert soil["level"] == 0.9
    # Most of the others have become slower than any run.
    assert soil[JourneyStatus.OUTSIDE]["count"] + soil[JourneyStatus.SETTLED]["count"] > 0.5 * soil["sample_count"]
    # Hard ground takes neither soil nor beds nor emulator: its shares have the sampling error of so many samples.
    hard = found["hard"]
    assert hard["settled"]["lower"] <= hard["settled"]["share"] <= hard["settled"]["upper"]
    assert (hard["level"], hard["why"]) == (0.9, None)
    assert "without soil, bed or emulator" in hard["of"]
    assert journeys.rest.where(journeys.rest["ground"] == "soil")["rebounds"].max() > 2


def test_the_speed_of_samples_follows_that_of_the_arrival_and_never_passes_it(journeys: StudyResults) -> None:
    samples = journeys.samples.where(journeys.samples["outcome"] == "clear")
    assert np.all(samples["speed_out"] < samples["impact.speed"])
    assert np.corrcoef(samples["speed_out"], samples["impact.speed"])[0, 1] > 0.5
    parts = journeys.summary["results"]["variance_shares"]["speed_out"]
    assert parts is None or parts["arrival"]["share"] > 0.2


def test_a_captured_lander_stays_where_the_ground_holds_it(journeys: StudyResults) -> None:
    table = journeys.run_flights.where(journeys.run_flights["outcome"] == "captured")
    assert len(table["returns"]) > 2
    assert set(table["returns"]) == {1.0}


def test_the_table_of_restitution_has_what_runs_and_samples_say(journeys: StudyResults) -> None:
    table = RestitutionTable.read(journeys.folder / "restitution.csv")
    samples = journeys.samples
    assert table.samples.sum() == np.isin(samples["outcome"], ["clear", "captured"]).sum()
    assert table.runs.sum() == np.isin(journeys.runs["outcome"], ["clear", "captured"]).sum() > 40
    assert (table.captured * table.samples).sum() == pytest.approx((samples["outcome"] == "captured").sum())
    left = samples.where(samples["outcome"] == "clear")
    normal = left["velocity_out_z"] / (left["impact.speed"] * np.cos(np.radians(left["impact.incidence_deg"])))
    lowest, highest = (table.quantiles["normal_restitution"][:, :, place] for place in (0, -1))
    assert (lowest.min(), highest.max()) == pytest.approx((normal.min(), normal.max()))


def test_journeys_on_equivalent_ground_stand_beside_soil_and_hard_ground(journeys: StudyResults) -> None:
    rest = journeys.summary["results"]["rest"]
    assert rest["equivalent"]["sample_count"] == rest["soil"]["sample_count"] == 100
    assert rest["equivalent"]["outside"]["count"] == 0
    # A fifth returns at the first impact.
    assert rest["equivalent"]["settled"]["share"] > 0.2
    assert json_values(journeys.results) == journeys.summary["results"]


@pytest.mark.parametrize(("changes", "words"), [
    ({"bed": {"bed_count": 1}}, "All runs landed on one bed."),
    ({"impact": {"region": None, "place": {"x": 0.0, "y": 0.0}}}, "All runs landed at one impact point."),
], ids=["one bed", "one place"])  # fmt: skip
def test_one_bed_or_one_place_gives_no_interval(changes: dict[str, dict[str, Any]], words: str, tmp_path: Path) -> None:
    results = made(tmp_path / "out", SyntheticLander(), **changes)
    found = results.summary["results"]
    returns = found["returns"]
    assert (returns["lower"], returns["upper"], returns["next_bed"]) == (None, None, None)
    assert words in returns["why"]
    assert "would change the result; this study cannot show by how much" in results.headline[1]
    assert "interval" not in results.headline[0]
    tables = found["shares"], found["shares"]["emulator"]
    assert {a["lower"] for table in tables for a in table.values() if isinstance(a, dict) and "lower" in a} == {None}
    assert found["outputs"]["speed_out"]["mean"]["lower"] is None


def test_a_journey_has_a_flight_for_each_rebound(journeys: StudyResults) -> None:
    """Whatever leaves an impact flies; who never slides has no other flight, and ends when the last of them does."""
    soil = journeys.rest.where(journeys.rest["ground"] == "soil")
    sample = journeys.arcs["sample"].astype(int)
    assert sample.max() < 100
    flown = np.bincount(sample, minlength=100)
    bounced = (soil["slid_length"][:100] == 0.0) & (soil["rebounds"][:100] > 0)
    assert bounced.sum() > 20
    assert flown[bounced].tolist() == soil["rebounds"][:100][bounced].tolist()
    last = np.searchsorted(sample, np.flatnonzero(bounced), side="right") - 1
    assert np.array_equal(journeys.arcs["end_s"][last], soil["time_s"][:100][bounced])


def test_landings_without_an_outcome_are_named_and_widen_the_interval(tmp_path: Path) -> None:
    limits = {"away": "escaped", "back": "returns", "caught": "captured"}
    results = made(tmp_path / "out", SyntheticLander(dataclasses.replace(WEAK, rim="fast_flat")), limit_states=limits)
    found = results.summary["results"]
    runs, returns, shares = found["runs"], found["returns"], found["shares"]
    lost = runs["outcomes"]["left_sideways"]
    assert runs["missing"] == {"count": lost, "share": lost / 48, "outcomes": {"left_sideways": lost}}
    assert lost / 48 > 0.02
    assert runs["warning"].startswith(f"{lost} of 48 landings ({100 * lost / 48:.0f} %) have no outcome")
    low, high = returns["if_missing"]
    assert returns["lower"] < low < returns["share"] < high < returns["upper"]
    assert returns["missing"] == shares["missing"]["share"] == lost / 48
    assert any(f"{lost} of 48 landings have no outcome" in sentence for sentence in results.headline)
    # Whatever describes fewer than all landings says which.
    left = f"the {48 - lost - runs['outcomes']['captured']} of 48 landings that left the surface"
    assert found["outputs"]["speed_out"]["of"] == found["variance_shares"]["speed_out"]["of"] == left
    assert found["emulator"]["of"] == left
    # One number for one thing: parts of one whole, and limit states of the same words.
    assert sum(shares[name]["share"] for name in PARTS) == pytest.approx(1.0)
    counted = [*PARTS, "missing"]
    assert sum(shares[name]["count"] for name in counted) == shares["sample_count"] == 64 * 48
    share = {key: returns[key] for key in ("share", "lower", "upper")}
    assert shares["returns"] == share | {"count": shares["impact"]["count"]}
    states = found["limit_states"]
    for name, word in (("away", "escaped"), ("back", "returns"), ("caught", "captured")):
        assert states[name]["source"] == "runs"
        assert [states[name][key] for key in ("probability", "lower", "upper")] == [
            shares[word][key] for key in ("share", "lower", "upper")
        ]


def test_runs_with_more_energy_than_they_brought_leave_the_speed_without_a_bound(tmp_path: Path) -> None:
    said: list[str] = []

    class Shown(Silent):
        def say(self, sentence: str) -> None:
            said.append(sentence)

    tables = synthetic_tables(**FEW, impact={"speed": 0.05})
    results = lithobrake.run(
        tables, tmp_path / "out", workers=1, model=SyntheticLander(), report=False, progress=Shown()
    )
    assert any("with more speed and spin than the impact energy allows" in sentence for sentence in said)
    assert results.samples.where(results.samples["outcome"] == "clear")["speed_out"].max() > 0.05
