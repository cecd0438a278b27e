"""The emulator of all touchdowns of journeys, landers that it takes to rest, and delivery options by it."""

import dataclasses
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import lithobrake
from lithobrake.campaign import read_records
from lithobrake.files.reading import read_rows
from lithobrake.pipeline import served_models
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import seen
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.emulated.delivery_options import option_arrivals
from lithobrake.pipeline.emulated.emulated_journeys import COPIES, MOST_LANDINGS
from lithobrake.pipeline.site import Site
from lithobrake.report import write_report
from lithobrake.results import StudyResults
from lithobrake.results.emulated_results import EmulatedJourneys
from lithobrake.study import StudyError
from lithobrake.study.lander_sides import sides_down
from lithobrake.study.reader import check_tables
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import ORIENTATION

from ..journeys.bouncing_lander import TABLES, bounce, journey_tables

AIM: dict[str, Any] = {
    "grid": {"delivery.speed": [0.05, 0.07], "delivery.latitude_deg": [10.0, 20.0]},
    "within": ["at_rest > 0.2", "latitude_deg < 15"],
    "lander_count": 2,
}
COUNT = TABLES["journey"]["emulated_count"]


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    folder = tmp_path_factory.mktemp("emulated") / "study"
    return lithobrake.run(journey_tables(aim=AIM), folder, workers=1, model=bounce, report=False)


@pytest.fixture(scope="module")
def found(results: StudyResults) -> EmulatedJourneys:
    assert results.results.emulated is not None
    return results.results.emulated


def rows(results: StudyResults, landers: str) -> list[dict[str, str]]:
    return [row for row in read_rows(results.folder / "emulated.csv", ("landers",), "") if row["landers"] == landers]


def test_the_emulator_is_sampled_by_the_names_of_its_inputs(results: StudyResults) -> None:
    emulator = results.emulator
    laws = emulator.model.runs.inputs
    table = emulator.sample({name: law.median for name, law in laws.items()}, 400)
    assert table.row_count == 400
    assert table.columns["speed_out"].units == "m/s"
    assert set(table["outcome"]) <= set(emulator.model.outcome_names)
    assert "<td>emulator</td>" in results._repr_html_()


def test_landers_by_the_emulator_end_as_those_by_landings_do(found: EmulatedJourneys, results: StudyResults) -> None:
    assert results.results.ends is not None
    assert found.why is None
    assert found.count == COUNT
    assert found.agrees
    assert sum(one.share for one in found.ends.values()) == pytest.approx(1.0, abs=1e-12)
    assert sum(one.count for one in found.ends.values()) == pytest.approx((1.0 - found.unknown) * COUNT)
    for name, one in found.ends.items():
        assert one.upper is not None
        assert one.lower <= one.share <= one.upper, name
    assert "emulator and landings agree within" in results.results.answer[-2]


def test_landings_are_made_where_there_is_no_answer(found: EmulatedJourneys, results: StudyResults) -> None:
    records = read_records(results.folder / "emulated.sqlite")
    fresh = rows(results, "fresh")
    assert found.most_landings == int(MOST_LANDINGS * results.touchdowns.row_count)
    assert 0 < found.landings <= found.most_landings
    assert sum(int(row["landings"]) for row in fresh) == found.landings
    assert len(records) >= found.landings
    # A landing is made only beyond what any touchdown of the journeys had.
    widest = results.touchdowns["impact.incidence_deg"].max() + 5.0
    fastest = 1.1 * results.touchdowns["impact.speed"].max()
    gravity = results.touchdowns["surface.gravity"]
    for record in records:
        inputs = record.inputs
        strength = inputs["surface.gravity"]
        assert (
            inputs["impact.incidence_deg"] > widest
            or inputs["impact.speed"] > fastest
            or not gravity.min() - 0.11 * gravity.max() < strength < 1.1 * gravity.max()
            or inputs["surface.slope_deg"] > results.touchdowns["surface.slope_deg"].max() + 5.0
        )
    unknown = [row for row in fresh if row["end"] == "unknown"]
    assert found.unknown == len(unknown) / COUNT
    assert all(row["beyond"] == "1" for row in unknown)


def test_the_landers_of_the_journeys_meet_refits_that_have_not_seen_their_bed(results: StudyResults) -> None:
    own = rows(results, "own")
    assert len(own) == COPIES * 48
    refits = [{int(row["refit"]) for row in own if int(row["journey"]) == number} for number in range(48)]
    bed = results.journeys["bed"]
    for first in range(48):
        same = np.flatnonzero(bed == bed[first]).tolist()
        assert len({frozenset(refits[one]) for one in same}) == 1
    assert all(len(one) < REFIT_COUNT for one in refits)


def test_every_option_has_its_share_at_rest_on_the_soil_alone(results: StudyResults) -> None:
    aim = results.results.aim
    assert [one.values for one in aim.aims] == [(0.05, 10.0), (0.05, 20.0), (0.07, 10.0), (0.07, 20.0)]
    assert aim.names == ("delivery.speed", "delivery.latitude_deg")
    assert aim.units == ("m/s", "deg")
    written = read_rows(results.folder / "aim.csv", ("ground", "aim", "status"), "")
    for number, one in enumerate(aim.aims):
        ends = [row["status"] for row in written if int(row["aim"]) == number]
        assert len(ends) == 2 * REFIT_COUNT
        assert one.soil.settled.share == pytest.approx(ends.count(JourneyEnd.AT_REST) / len(ends))
        assert one.soil.allowed == (number in (0, 2))
        assert one.hard is None
    assert aim.best_on_hard is None
    assert aim.best_on_soil.aim in (0, 2)


def test_the_emulator_of_touchdowns_is_served(results: StudyResults, monkeypatch: pytest.MonkeyPatch) -> None:
    # A function has no beds, and study.toml does not name it.
    monkeypatch.setattr("lithobrake.pipeline.emulated.touchdown_emulator.height_of_beds", lambda study, folder: 0.0)
    models = {one.name: one for one in served_models(results.folder / "study.toml", results.folder)}
    served = models["emulator"]
    ground = ("surface.gravity", "surface.slope_deg")
    assert served.inputs[-4:] == ("impact.speed", "impact.incidence_deg", *ground)
    point = [float(np.median(results.touchdowns[name])) for name in served.inputs]
    drawn = [served.evaluate(point, {"seed": seed}) for seed in range(40)]
    assert drawn[0] == served.evaluate(point, {"seed": 0})
    assert {one[0] for one in drawn} <= {0.0, 1.0, 3.0}
    for one in drawn:
        assert one[1] == pytest.approx(np.linalg.norm(one[4:]), rel=1e-12)
    pointed = [served.evaluate(point, {"seed": 1, "orientation": one}) for one in ([1, 0, 0, 0], [0.7, 0.7, 0, 0])]
    assert pointed[0] != pointed[1]
    with pytest.raises(ValueError, match=r"config.orientation is \[1, 0\]; allowed: a quaternion"):
        served.evaluate(point, {"orientation": [1, 0]})
    fast = [*point[:-4], 10.0 * point[-4], *point[-3:]]
    with pytest.raises(ValueError, match=r"no answer to this impact; allowed: impact.speed"):
        served.evaluate(fast, {})


def always_captured(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    outcome = bounce(inputs, seed)
    return {"outcome": "captured", "outputs": {"displacement_x": 0.0, "displacement_y": 0.0, "duration": 1.0}} | (
        outcome if int(inputs["journey"]) < 3 else {}
    )


def test_too_few_that_left_give_no_emulator_and_a_reason(tmp_path: Path) -> None:
    changes = {"journey": {"count": 24}, "aim": AIM}
    found = lithobrake.run(journey_tables(**changes), tmp_path / "out", workers=1, model=always_captured, report=False)
    emulated, aim = found.results.emulated, found.results.aim
    assert "left the ground, and it needs 8" in emulated.why
    assert emulated.why in found.results.answer
    assert [one.soil.missing for one in aim.aims] == [1.0] * 4
    assert found.touchdown_explorer is None
    with h5py.File(found.folder / "touchdown_explorer.h5") as file:
        assert file.attrs["why"] == emulated.why
    page = write_report(found.folder).read_text(encoding="utf-8")
    assert 'id="body-3d"' in page
    assert 'id="explorer"' not in page


def test_a_side_is_an_option_like_any_other(results: StudyResults) -> None:
    study = check_tables(journey_tables(aim={"grid": {"delivery.speed": [0.05]}, "sides": ["z", "x or y"]}), Path())
    assert study.aim.aims() == [{"delivery.speed": 0.05, "aim.sides": 0.0}, {"delivery.speed": 0.05, "aim.sides": 1.0}]
    begin = option_arrivals(DrawnDesign(study), Site(study))
    inputs = {name: begin.column(name) for name in (*ORIENTATION, "impact.azimuth_deg")}
    sides = sides_down(study.lander, seen(inputs)[0])
    half = len(sides) // 2
    assert set(sides[:half]) == {"z"}
    assert set(sides[half:]) == {"x or y"}
    # What is not chosen is the same for both.
    assert begin.column("impact.incidence_deg")[:half] == pytest.approx(begin.column("impact.incidence_deg")[half:])


@pytest.mark.parametrize(
    ("sides", "said"),
    [(["z", "up"], r'aim.sides is .*; allowed: some of "x or y", "z", each once'), (["z", "z"], "each once")],
)
def test_sides_that_the_lander_does_not_have_are_refused(sides: list[str], said: str) -> None:
    with pytest.raises(StudyError, match=said):
        check_tables(journey_tables(aim={"sides": sides}), Path())


@pytest.mark.parametrize(("grid", "said"), [
    ({"impact.speed": [0.05]}, r'"impact.speed" is no aim; allowed: delivery.speed'),
    ({"delivery.speed": [0.05, 0.2]}, r"ascending values from 0.04 to 0.08"),
    ({"delivery.spin_x": [0.1]}, r'"delivery.spin_x" is no aim'),
])  # fmt: skip
def test_options_that_journeys_do_not_reach_are_refused(grid: dict[str, list[float]], said: str) -> None:
    with pytest.raises(StudyError, match=said):
        check_tables(journey_tables(aim={"grid": grid}), Path())


def test_a_limit_of_another_method_is_refused() -> None:
    with pytest.raises(StudyError, match="at_rest, missing, distance_p95"):
        check_tables(journey_tables(aim={**AIM, "within": ["settled > 0.5"]}), Path())


def test_the_same_study_gives_the_same_landers(results: StudyResults, tmp_path: Path) -> None:
    again = lithobrake.run(journey_tables(aim=AIM), tmp_path / "again", workers=1, model=bounce, report=False)
    for name in ("emulated.csv", "aim.csv"):
        assert (again.folder / name).read_bytes() == (results.folder / name).read_bytes()
    assert dataclasses.asdict(again.results)["emulated"] == dataclasses.asdict(results.results)["emulated"]
