"""First touchdowns whose landers go on on hard ground, lie on one bed, or leave it laterally."""

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lithobrake
from lithobrake.pipeline.answer.run_estimates import PARTS
from lithobrake.pipeline.job import Silent
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.study_run import run_study
from lithobrake.results import StudyResults
from lithobrake.results.study_files import json_values
from lithobrake.smallbody import RestitutionTable
from lithobrake.study import StudySource

from ...synthetic_landings import WEAK
from ..few_terms import fewest_terms
from ..synthetic_lander import SyntheticLander, synthetic_tables

ARRIVAL = {
    "speed": {"distribution": "uniform", "lower": 0.005, "upper": 0.4},
    "incidence_deg": {"distribution": "uniform", "lower": 0.0, "upper": 88.0},
}
# All first touchdowns on level ground, where no lander gains speed.
FLAT = {"gravity": 5e-5}
FEW = {"design": {"run_count": 48}, "monte_carlo": {"sample_count": 200}, "flight": {"flight_count": 50}}
RIM_RUNS = 36
FEWER = {"run_count": RIM_RUNS}
NO_HARD_GROUND = {"count": 0}
# So much resistance that captured landers do not roll far, which takes most of the time elsewhere.
HARD_COUNT, ROLLING_FRICTION = 20, 2.0


def made(folder: Path, model: SyntheticLander, **changes: dict[str, Any]) -> StudyResults:
    tables = synthetic_tables(**FEW | {"hard_ground": NO_HARD_GROUND} | changes)
    with fewest_terms():
        return lithobrake.run(tables, folder, workers=1, model=model, report=False)


@pytest.fixture(scope="module")
def journeys(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """Landers at 70 degrees north of Didymos, where the ground holds them, that arrive at any speed and angle."""
    model = SyntheticLander(dataclasses.replace(WEAK, capture=0.2), follows_speed=True)
    site, hard = {"latitude_deg": 70.0}, {"count": HARD_COUNT, "rolling_friction": ROLLING_FRICTION}
    folder = tmp_path_factory.mktemp("journeys") / "out"
    changes = {"impact": ARRIVAL, "site": site, "surface": FLAT, "hard_ground": hard}
    return made(folder, model, monte_carlo={"sample_count": 400}, **changes)


def test_landers_rest_on_hard_ground_and_their_shares_have_the_error_of_their_number(journeys: StudyResults) -> None:
    """Hard ground takes neither soil nor beds nor emulator."""
    hard = journeys.results.hard_ground["hard"]
    at_rest = hard.ends["at_rest"].share
    assert (hard.count, hard.level, hard.why, hard.unknown) == (HARD_COUNT, 0.9, None, 0.0)
    assert at_rest.lower < at_rest.value <= at_rest.upper
    assert sum(one.count for one in hard.ends.values()) == HARD_COUNT
    assert "without soil or bed" in hard.of
    table = journeys.rest.where(journeys.rest["ground"] == "hard")
    assert table["journey"].tolist() == list(range(48, 48 + HARD_COUNT))
    assert table["touchdowns"].max() > 3
    rests = table.where(table["end"] == "at_rest")
    assert hard.slid.count == (table["slid_length"] > 0.0).sum() > HARD_COUNT // 2
    assert hard.time_s["quantile_0.5"] == pytest.approx(np.quantile(rests["time_s"], 0.5))
    assert (rests["slid_length"] <= rests["path_length"]).all()
    assert (rests["slid_time_s"] <= rests["time_s"]).all()
    lines = (journeys.folder / "rest.csv").read_text().splitlines()
    assert lines[0] == (
        "ground,journey,end,body,time_s,latitude_deg,longitude_deg,distance [m],touchdowns,path_length [m],"
        "slid_length [m],slid_time_s"
    )


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


def test_landers_on_equivalent_ground_stand_beside_hard_ground(journeys: StudyResults) -> None:
    equivalent = journeys.results.hard_ground["equivalent"]
    assert (equivalent.count, equivalent.level) == (HARD_COUNT, None)
    assert equivalent.unknown <= 0.03
    assert equivalent.why is not None
    # A fifth stays at the first impact.
    assert equivalent.ends["at_rest"].share.value > 0.2
    assert json_values(journeys.results) == journeys.summary["results"]


@pytest.fixture(scope="module")
def rim(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """Landers of one speed, of which the fast and flat leave over the rim."""
    model = SyntheticLander(dataclasses.replace(WEAK, rim="fast_flat"))
    limits = {"away": "escaped", "back": "returns", "caught": "captured"}
    return made(
        tmp_path_factory.mktemp("rim") / "out", model, limit_states=limits, design=FEWER, hard_ground={"count": 4}
    )


def test_a_study_of_one_speed_has_no_table(rim: StudyResults) -> None:
    assert not (rim.folder / "restitution.csv").exists()
    assert set(rim.results.hard_ground) == {"hard"}


@pytest.mark.parametrize(("changes", "words"), [
    ({"bed": {"bed_count": 1}}, "All runs landed on one bed."),
    ({"impact": {"region": None, "place": {"x": 0.0, "y": 0.0}}}, "All runs landed at one impact point."),
], ids=["one bed", "one place"])  # fmt: skip
def test_one_bed_or_one_place_gives_no_interval(changes: dict[str, dict[str, Any]], words: str, tmp_path: Path) -> None:
    results = made(tmp_path / "out", SyntheticLander(), design={"run_count": 16}, **changes)
    found = results.summary["results"]
    returns = found["returns"]
    assert (returns["lower"], returns["upper"], returns["next_bed"]) == (None, None, None)
    assert words in returns["why"]
    assert "would change the result; this study cannot show by how much" in results.headline[1]
    assert "interval" not in results.headline[0]
    tables = found["shares"], found["samples"]["shares"]
    assert {a["lower"] for table in tables for a in table.values() if isinstance(a, dict) and "lower" in a} == {None}
    assert found["outputs"]["speed_out"]["mean"]["lower"] is None


def test_landings_without_an_outcome_are_named_and_widen_the_interval(rim: StudyResults) -> None:
    found = rim.summary["results"]
    runs, returns, shares = found["runs"], found["returns"], found["shares"]
    lost = runs["outcomes"]["left_sideways"]
    assert runs["missing"] == {"count": lost, "share": lost / RIM_RUNS, "outcomes": {"left_sideways": lost}}
    assert lost / RIM_RUNS > 0.02
    assert runs["warning"].startswith(f"{lost} of {RIM_RUNS} landings ({100 * lost / RIM_RUNS:.0f} %) have no outcome")
    low, high = returns["if_missing"]
    assert returns["lower"] < low < returns["share"] < high < returns["upper"]
    assert returns["missing"] == shares["missing"]["share"] == lost / RIM_RUNS
    assert any(f"{lost} of {RIM_RUNS} landings have no outcome" in sentence for sentence in rim.headline)
    # Whatever describes fewer than all landings says which.
    left = f"the {RIM_RUNS - lost - runs['outcomes']['captured']} of {RIM_RUNS} landings that left the surface"
    assert found["outputs"]["speed_out"]["of"] == found["variance_shares"]["speed_out"]["of"] == left
    assert found["emulator"]["of"] == left
    # One number for one thing: parts of one whole, and limit states of the same words.
    assert sum(shares[name]["share"] for name in PARTS) == pytest.approx(1.0)
    counted = [*PARTS, "missing"]
    assert sum(shares[name]["count"] for name in counted) == shares["sample_count"] == 64 * RIM_RUNS
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

    model = SyntheticLander()
    source = StudySource.of_tables(
        synthetic_tables(**FEW | {"design": FEWER}, impact={"speed": 0.05}), function_identity(model)
    )
    with fewest_terms():
        run_study(source, tmp_path / "out", until="sample", worker_count=1, model=model, shown=Shown())
    results = lithobrake.open_study(tmp_path / "out")
    assert any("with more speed and spin than the impact energy allows" in sentence for sentence in said)
    assert results.samples.where(results.samples["outcome"] == "clear")["speed_out"].max() > 0.05
