"""What `lithobrake plan --infer` says of bounces that nobody has observed yet."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.pipeline import InferredStudy, plan_lines, plan_study
from lithobrake.pipeline.inference.expected_inference import ExpectedInference
from lithobrake.pipeline.study_run import run_study
from lithobrake.study import StudySource

from ..ball_studies import PAPERS, drawn, write_ball


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


def test_with_an_emulator_it_says_how_many_bounces_would_halve_what_is_unknown(
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
    paper = write_ball(tmp_path / "paper.toml", {})
    said = plan_study(paper, tmp_path / "out", infers=True).inference
    assert 'needs design.method = "drawn"' in said.lines()[0]


def test_a_plan_that_is_not_asked_of_bounces_says_nothing_of_them(study: Path) -> None:
    plan = plan_study(study, study.parent / "out")
    assert plan.inference is None
    assert plan.to_json()["inference"] is None
