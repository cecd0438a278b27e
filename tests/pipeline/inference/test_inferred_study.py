"""Bounces, observed in a file or yet to come, and the emulator of a study."""

import json
import math
import shutil
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import lithobrake
from lithobrake.cli import app
from lithobrake.pipeline import plan_lines, plan_study
from lithobrake.pipeline.inference.bounce_table import read_bounces
from lithobrake.pipeline.inference.expected_inference import ExpectedInference
from lithobrake.pipeline.inference.inferred_study import InferredStudy, infer_study
from lithobrake.pipeline.study_run import run_study
from lithobrake.study import StudySource

from ...synthetic_landings import STRONG
from ..ball_studies import PAPERS, drawn, write_ball
from ..synthetic_lander import SOIL, SyntheticLander, synthetic_tables

SEEN = "speed_out [m/s],elevation_out [rad],error:speed_out [m/s],outcome\n0.12,0.5,0.002,\n,,,captured\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of 96 landings whose soil counts."""
    few = {"design": {"run_count": 96}, "monte_carlo": {"sample_count": 200}, "flight": {"flight_count": 50}}
    out = tmp_path_factory.mktemp("infer") / "out"
    lithobrake.run(synthetic_tables(**few), out, workers=1, model=SyntheticLander(STRONG), report=False)
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


def test_the_posterior_and_its_picture_are_written(folder: Path, tmp_path: Path) -> None:
    found = infer_study(folder, bounces(tmp_path, SEEN))
    content = json.loads((folder / "posterior.json").read_text(encoding="utf-8"))
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


def test_the_command_says_first_what_bounces_can_say(folder: Path, tmp_path: Path) -> None:
    said = CliRunner().invoke(app, ["infer", str(folder), "--bounce", str(bounces(tmp_path, SEEN))])
    assert said.exit_code == 0, said.output
    lines = " ".join(said.output.split())
    assert lines.index("Bounces with observed speed_out, elevation_out, spin_out") < lines.index("Posterior:")
    assert "grain.friction: one bounce leaves" in lines
    # Of two bounces on one bed one has no outputs, and says nothing of it.
    assert "The 2 bounces count as on beds of their own" in lines
    assert InferredStudy.open(folder).of_each_bounce == []


def test_a_folder_without_an_emulator_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"has no emulator\.json; run a drawn study there first"):
        InferredStudy.open(tmp_path)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of a program, with an emulator of its runs in the folder beside it."""
    changes = {
        PAPERS: drawn(24),
        'friction = { distribution = "uniform", lower = 0.05, upper = 0.4 }': "friction = 0.2",
    }
    path = write_ball(tmp_path_factory.mktemp("plan") / "study.toml", changes)
    run_study(StudySource.read(path), path.parent / "out", until="emulator", worker_count=1)
    return path


def test_with_an_emulator_it_says_how_many_bounces_halve_the_unknown(
    study: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
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
    assert 'needs design.method = "drawn"' in said.lines()[0]


def test_a_plan_that_is_not_asked_of_bounces_says_nothing_of_them(study: Path) -> None:
    plan = plan_study(study, study.parent / "out")
    assert plan.inference is None
    assert plan.to_json()["inference"] is None
