"""The emulator of all touchdowns of journeys, delivery options by it, and inference from bounces with it."""

import json
import math
import shutil
from importlib import import_module
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from matplotlib.figure import Figure
from typer.testing import CliRunner

import lithobrake
from lithobrake.campaign import read_records
from lithobrake.cli import app
from lithobrake.files.reading import read_rows
from lithobrake.pipeline import plan_lines, plan_study, served_models
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import seen
from lithobrake.pipeline.inferred_study import ExpectedInference, InferredStudy, infer_study, read_bounces
from lithobrake.pipeline.journeys import emulated_journeys
from lithobrake.pipeline.journeys.delivery_options import option_arrivals
from lithobrake.pipeline.journeys.emulated_journeys import MOST_LANDINGS
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.study_run import run_study
from lithobrake.report import write_report
from lithobrake.results import StudyResults
from lithobrake.results.journey_results import EmulatedJourneys
from lithobrake.study import StudyError, StudySource
from lithobrake.study.lander_section import sides_down
from lithobrake.study.reader import check_tables
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import ORIENTATION

from ...synthetic_landings import STRONG
from ..ball_studies import drawn, write_ball
from ..few_terms import REFITS, fewest_terms
from ..journeys.bouncing_lander import TABLES, bounce, journey_tables
from ..synthetic_lander import SOIL, SyntheticLander, synthetic_tables

AIM: dict[str, Any] = {
    "grid": {"delivery.speed": [0.05, 0.07], "delivery.latitude_deg": [10.0, 20.0]},
    "within": ["at_rest > 0.2", "latitude_deg < 15"],
    "lander_count": 2,
}
COUNT = TABLES["journey"]["emulated_count"]


@pytest.fixture(scope="module")
def results(journeys_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> StudyResults:
    """The study of the journeys, which is then asked for delivery options as well."""
    folder = tmp_path_factory.mktemp("emulated") / "study"
    shutil.copytree(journeys_folder, folder)
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
    assert (table.row_count, table.columns["speed_out"].units) == (400, "m/s")
    assert set(table["outcome"]) <= set(emulator.model.outcome_names)
    assert "<td>emulator</td>" in results._repr_html_()


def test_landers_by_the_emulator_end_as_those_by_landings_do(found: EmulatedJourneys, results: StudyResults) -> None:
    assert results.results.ends is not None
    assert found.why is None
    assert found.count == COUNT
    assert found.agrees
    assert sum(one.share.value for one in found.ends.values()) == pytest.approx(1.0, abs=1e-12)
    assert sum(one.count for one in found.ends.values()) == pytest.approx((1.0 - found.unknown) * COUNT)
    for name, one in found.ends.items():
        assert one.share.upper is not None
        assert one.share.lower <= one.share.value <= one.share.upper, name
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
    assert len(own) == emulated_journeys.COPIES * 48
    refits = [{int(row["refit"]) for row in own if int(row["journey"]) == number} for number in range(48)]
    bed = results.journeys["bed"]
    for first in range(48):
        same = np.flatnonzero(bed == bed[first]).tolist()
        assert len({frozenset(refits[one]) for one in same}) == 1
    assert all(len(one) < REFITS for one in refits)


def test_every_option_has_its_share_at_rest_on_the_soil_alone(results: StudyResults) -> None:
    aim = results.results.aim
    assert [one.values for one in aim.aims] == [(0.05, 10.0), (0.05, 20.0), (0.07, 10.0), (0.07, 20.0)]
    assert aim.names == ("delivery.speed", "delivery.latitude_deg")
    assert aim.units == ("m/s", "deg")
    written = read_rows(results.folder / "aim.csv", ("ground", "aim", "status"), "")
    for number, one in enumerate(aim.aims):
        ends = [row["status"] for row in written if int(row["aim"]) == number]
        assert len(ends) == 2 * REFITS
        assert one.soil.settled.value == pytest.approx(ends.count(JourneyEnd.AT_REST) / len(ends))
        assert one.soil.allowed == (number in (0, 2))
        assert one.hard is None
    assert aim.best_on_hard is None
    assert aim.best_on_soil.aim in (0, 2)


def test_the_emulator_of_touchdowns_is_served(results: StudyResults, monkeypatch: pytest.MonkeyPatch) -> None:
    # A function has no beds, and study.toml does not name it.
    monkeypatch.setattr("lithobrake.pipeline.journeys.touchdown_emulator.height_of_beds", lambda study, folder: 0.0)
    served = {one.name: one for one in served_models(results.folder / "study.toml", results.folder)}["emulator"]
    assert served.inputs[-4:] == ("impact.speed", "impact.incidence_deg", "surface.gravity", "surface.slope_deg")
    point = [float(np.median(results.touchdowns[name])) for name in served.inputs]
    drawn = [served.evaluate(point, {"seed": seed}) for seed in range(40)]
    assert drawn[0] == served.evaluate(point, {"seed": 0})
    assert {one[0] for one in drawn} <= {0.0, 1.0, 3.0}
    for one in drawn:
        assert one[1] == pytest.approx(np.linalg.norm(one[4:]), rel=1e-12)
    # Of draws near a row of the table some are of the same row at both attitudes.
    flat, tipped = (
        [served.evaluate(point, {"seed": seed, "orientation": one}) for seed in range(40)]
        for one in ([1, 0, 0, 0], [0.7, 0.7, 0, 0])
    )
    assert flat != tipped
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
    changes = {"journey": {"count": 12}, "aim": AIM}
    with fewest_terms():
        found = lithobrake.run(
            journey_tables(**changes), tmp_path / "out", workers=1, model=always_captured, report=False
        )
    emulated, aim = found.results.emulated, found.results.aim
    assert "left the ground, and it needs 8" in emulated.why
    assert emulated.why in found.results.answer
    assert [one.soil.missing for one in aim.aims] == [1.0] * 4
    # Three of the 12 landers alone have an attitude.
    assert (found.results.rest.faces, found.results.rest.tilt_deg) == ({}, None)
    assert found.touchdown_explorer is None
    with h5py.File(found.folder / "touchdown_explorer.h5") as file:
        assert file.attrs["why"] == emulated.why
    page = write_report(found.folder).read_text(encoding="utf-8")
    assert 'id="body-3d"' in page
    assert 'id="explorer"' not in page


def test_a_side_is_an_option_like_any_other(results: StudyResults) -> None:
    study = check_tables(journey_tables(aim={"grid": {"delivery.speed": [0.05]}, "sides": ["z", "x or y"]}), Path())
    assert study.aim.aims() == [{"delivery.speed": 0.05, "aim.sides": 0.0}, {"delivery.speed": 0.05, "aim.sides": 1.0}]
    begin = option_arrivals(DrawnDesign(study), study.aim.aims(), 100)
    inputs = {name: begin.column(name) for name in (*ORIENTATION, "impact.azimuth_deg")}
    sides = sides_down(study.lander, seen(inputs)[0])
    half = len(sides) // 2
    assert (set(sides[:half]), set(sides[half:])) == ({"z"}, {"x or y"})
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
    shutil.copytree(results.folder, tmp_path / "again")
    for name in ("touchdown_emulator.json", "emulated.csv", "aim.csv"):
        (tmp_path / "again" / name).unlink()
    source = StudySource.of_tables(journey_tables(aim=AIM), function_identity(bounce))
    run_study(source, tmp_path / "again", until="aim", worker_count=1, model=bounce)
    for name in ("touchdown_emulator.json", "emulated.csv", "aim.csv"):
        assert (tmp_path / "again" / name).read_bytes() == (results.folder / name).read_bytes(), name


@pytest.fixture(autouse=True)
def few_bounces(monkeypatch: pytest.MonkeyPatch) -> None:
    """What bounces say is worked out for fewer of them, at fewer points, by fewer refits; tests/analysis looks at the
    numbers.
    """
    infer = import_module("lithobrake.analysis.bayesian_inference").infer
    monkeypatch.setitem(infer.__kwdefaults__, "refit_count", 8)
    module = import_module("lithobrake.analysis.identifiability")
    for name, few in (("MOST_BOUNCES", 8), ("PRIOR_POINTS", 512), ("REPLICATES", 50)):
        monkeypatch.setattr(module, name, few)


SEEN = "speed_out [m/s],elevation_out [rad],error:speed_out [m/s],outcome\n0.12,0.5,0.002,\n,,,captured\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of 96 landings whose soil counts, and whose flights, at which nobody looks, are short."""
    out, model = tmp_path_factory.mktemp("infer") / "out", SyntheticLander(STRONG)
    changes = {"design": {"run_count": 96}, "flight": {"duration": 600.0}}
    source = StudySource.of_tables(synthetic_tables(**changes), function_identity(model))
    run_study(source, out, until="emulator", worker_count=1, model=model)
    return out


def bounces(folder: Path, text: str) -> Path:
    path = folder / "bounces.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_of_bounces_is_read_row_by_row(tmp_path: Path) -> None:
    first, second = read_bounces(bounces(tmp_path, SEEN))
    assert first.outputs == {"speed_out": 0.12, "elevation_out": 0.5}
    assert (first.errors, first.outcome) == ({"speed_out": 0.002}, None)
    assert (second.outputs, second.outcome, second.bed) == ({}, "captured", None)
    on_bed = read_bounces(bounces(tmp_path, "bed,speed_out\n tray 1 ,0.1\n,0.2\n"))
    assert [one.bed for one in on_bed] == ["tray 1", None]
    known = read_bounces(bounces(tmp_path, "impact.speed [m/s],speed_out\n0.3,0.1\n"))[0]
    assert (known.known, known.outputs) == ({"impact.speed": 0.3}, {"speed_out": 0.1})


@pytest.mark.parametrize(("title", "si"), [
    ("speed_out [cm/s]", 0.011),
    ("speed_out[mm/s]", 0.0011),
    ("speed_out [ m s-1 ]", 1.1),
    ("speed_out [ft/s]", 0.33528),
    ("spin_out [deg/s]", math.radians(1.1)),
    ("spin_out [rpm]", 1.1 * 2.0 * math.pi / 60.0),
    ("elevation_out [°]", math.radians(1.1)),
    ("peak_acceleration [cm/s^2]", 0.011),
    ("contact_duration [min]", 66.0),
    ("error:spin_out [deg/s]", math.radians(1.1)),
    ("impact.incidence_deg [rad]", math.degrees(1.1)),
    ("impact.incidence_deg", 1.1),
])  # fmt: skip
def test_a_unit_behind_the_name_of_a_column_is_converted(title: str, si: float, tmp_path: Path) -> None:
    one = read_bounces(bounces(tmp_path, f"{title}\n1.1\n"))[0]
    (value,) = (one.outputs | one.errors | one.known).values()
    assert value == pytest.approx(si, rel=1e-15)


@pytest.mark.parametrize(("text", "words"), [
    ("speed_out\nfast\n", 'has "fast" for speed_out in row 1; write a number'),
    ("outcome\nlost\n", 'has the outcome "lost" in row 1; allowed: clear, captured'),
    ("speed_out\n", "has no bounce"),
    ("speed_out [furlong/s]\n0.1\n", r"speed_out in the unit \[furlong/s\]; allowed: m/s, km/s, cm/s, mm/s"),
    ("spin_out [Hz]\n1\n", r"spin_out in the unit \[Hz\]; allowed: rad/s, mrad/s, deg/s"),
    ("error:speed_out [m]\n1\n", r"error:speed_out in the unit \[m\]; allowed: m/s"),
    ("outcome [s],speed_out\n,1\n", r"outcome in the unit \[s\]; allowed: -, 1, %"),
    ("bed [m],speed_out\n,1\n", r"bed in the unit \[m\]; allowed: -, 1, %"),
    ("speed_out [M/S]\n0.1\n", r"unit \[M/S\]; allowed: m/s"),
    ("speed_out,speed_out\n0.1,0.2\n", "it has 2 columns speed_out"),
    ("speed_out [cm/s],speed_out [m/s]\n11,0.1\n", "it has 2 columns speed_out"),
])  # fmt: skip
def test_a_file_that_tells_no_bounce_is_refused(text: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=words):
        read_bounces(bounces(tmp_path, text))


def test_the_posterior_and_its_picture_are_written(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # tests/report looks at what is drawn.
    drawn = list[Any]()
    monkeypatch.setattr(
        "lithobrake.report.figures.model_figures.corner_figure", lambda inputs: drawn.append(inputs) or Figure((1, 1))
    )
    found = infer_study(folder, bounces(tmp_path, SEEN))
    content = json.loads((folder / "posterior.json").read_text(encoding="utf-8"))
    assert drawn == [content["inputs"]]
    assert content == json.loads(json.dumps(found))
    assert set(content["inputs"]) == set(SOIL)
    friction = content["inputs"]["grain.friction"]
    lower, middle, upper = friction["after"]
    assert 0.3 <= lower < middle < upper <= 0.9
    assert np.quantile(friction["points"], [0.05, 0.95]) == pytest.approx([lower, upper], abs=0.04)
    assert friction["sd_ratio"] < 1.0
    assert content["is_reliable"]
    assert 0.0 <= content["predictive_p_value"][0] <= 1.0
    assert content["predictive_p_value"][1] is None
    assert content["bounces"][0]["bed"] is None
    assert content["beds"].startswith("The 2 bounces count as on beds of their own")
    assert (folder / "posterior.png").read_bytes().startswith(b"\x89PNG")


def test_bounces_that_share_a_bed_say_so(folder: Path, tmp_path: Path) -> None:
    shared = "speed_out,elevation_out,bed\n0.12,0.5,a\n0.11,0.6,a\n"
    content = InferredStudy.open(folder).infer(bounces(tmp_path, shared))
    assert [one["bed"] for one in content["bounces"]] == ["a", "a"]
    assert content["beds"].startswith(
        "Of the 2 bounces 2 share bed a; of the scatter at one soil the bed has: speed_out "
    )


def test_an_emulator_of_before_the_spin_had_a_bound_is_refused_by_its_version(folder: Path, tmp_path: Path) -> None:
    old = tmp_path / "old"
    shutil.copytree(folder, old)
    content = json.loads((old / "emulator.json").read_text(encoding="utf-8"))
    speed, spin = (content["output_names"].index(name) for name in ("speed_out", "spin_out"))
    for row in content["upper"]:
        row[speed], row[spin] = 1.0, None
    (old / "emulator.json").write_text(json.dumps(content), encoding="utf-8")
    command = ["infer", str(old), "--bounce", str(bounces(tmp_path, SEEN))]
    edited = CliRunner().invoke(app, command)
    assert edited.exit_code == 2
    assert edited.stderr.startswith(
        f"{old / 'emulator.json'} changed after it was made, as its hash in keys.json tells"
    )
    # As in an archive, whose files nobody has noted.
    (old / "keys.json").unlink()
    said = CliRunner().invoke(app, command)
    assert (said.exit_code, said.stdout) == (2, "")
    assert said.stderr.startswith(
        f"{old / 'emulator.json'} has an emulator of an earlier version (format 1, lithobrake "
    )
    assert "again with: lithobrake run STUDY.toml" in said.stderr
    assert len(said.stderr.splitlines()) == 1


def test_the_command_says_first_what_bounces_can_say(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The test above draws the picture.
    monkeypatch.setattr("lithobrake.report.write_corner", lambda posterior, picture: None)
    said = CliRunner().invoke(app, ["infer", str(folder), "--bounce", str(bounces(tmp_path, SEEN))])
    assert said.exit_code == 0, said.output
    lines = " ".join(said.output.split())
    assert lines.index("Bounces with observed speed_out, elevation_out, spin_out") < lines.index("Posterior:")
    assert "grain.friction: one bounce leaves" in lines
    # Of two bounces on one bed one has no outputs, and says nothing of it.
    assert "The 2 bounces count as on beds of their own" in lines
    assert InferredStudy.open(folder).of_each_bounce == []


def test_a_folder_without_an_emulator_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"has no emulator\.json; run a study there first that draws landers"):
        InferredStudy.open(tmp_path)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of a program, with an emulator of its runs in the folder beside it."""
    changes = {
        **drawn(16),
        'friction = { distribution = "uniform", lower = 0.05, upper = 0.4 }': "friction = 0.2",
    }
    path = write_ball(tmp_path_factory.mktemp("plan") / "study.toml", changes)
    run_study(StudySource.read(path), path.parent / "out", until="emulator", worker_count=1)
    return path


def test_with_an_emulator_it_says_how_many_bounces_halve_it(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made, planned = list[ExpectedInference](), InferredStudy.plan
    monkeypatch.setattr(InferredStudy, "plan", lambda inferred: made.append(planned(inferred)) or made[-1])
    plan = plan_study(study, study.parent / "out", infers=True)
    (expected,) = made
    assert plan.inference == expected
    assert expected.outputs == ("speed_out", "elevation_out", "spin_out")
    content = json.loads(json.dumps(plan.to_json(), allow_nan=False))["inference"]
    assert content["why"] is None
    assert len(content["inputs"]) > 1
    for name, one in expected.inputs.items():
        assert content["inputs"][name] == {"left_of_sd": one.left_of_sd, "halved_by": one.halved_by}
        assert f"  {name}: {one.words()}" in plan_lines(plan)


def test_without_an_emulator_it_says_what_to_run_first(study: Path, tmp_path: Path) -> None:
    found = CliRunner().invoke(app, ["plan", str(study), "--out", str(tmp_path / "out"), "--infer"])
    assert found.exit_code == 0, found.output
    command = f"make it with: lithobrake run {study} --out {tmp_path / 'out'}."
    assert any(line.startswith("Bounces: ") and line.endswith(command) for line in found.output.splitlines())
    assert not (tmp_path / "out").exists()
    said = plan_study(write_ball(tmp_path / "paper.toml", {}), tmp_path / "out", infers=True).inference
    assert "an emulator of drawn landers, and design.run_count is 0" in said.lines()[0]


def test_a_plan_that_is_not_asked_of_bounces_says_nothing_of_them(study: Path) -> None:
    plan = plan_study(study, study.parent / "out")
    assert plan.inference is None
    assert plan.to_json()["inference"] is None
