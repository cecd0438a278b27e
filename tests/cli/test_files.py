"""What commands do with files of the user, and with an output or a folder that is not there for them."""

import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from lithobrake.campaign import Ledger
from lithobrake.cli import app

RUNNER = CliRunner()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The folder of a campaign of one run."""
    with Ledger(tmp_path / "runs.sqlite") as ledger:
        ledger.queue([("first", {"a": 1.0}, 1, 0)], "7")
        ledger.finish("first", {"status": "done", "outcome": "clear", "outputs": {"speed_out": 0.1}})
    return tmp_path


def command(*words: str) -> list[str]:
    return [sys.executable, "-m", "lithobrake", *words]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no full device")
@pytest.mark.parametrize("words", [("status",), ("runs", "--csv")])
def test_an_output_that_takes_nothing_is_one_sentence(folder: Path, words: tuple[str, ...]) -> None:
    with open("/dev/full", "w") as full:
        ended = subprocess.run(
            command(*words, str(folder)), stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert ended.returncode == 2
    assert ended.stderr.splitlines() == [
        "standard output cannot be written (No space left on device); make room, or write elsewhere"
    ]


@pytest.mark.skipif(sys.platform != "linux", reason="other systems keep a current folder, or remove none")
def test_without_a_current_folder_the_sentence_says_so(folder: Path) -> None:
    (folder / "gone").mkdir()
    script = 'import os, sys; os.rmdir(os.getcwd()); from lithobrake.cli import app; app(["plan", sys.argv[1]])'
    study = folder / "study.toml"
    study.write_text((Path(__file__).parents[2] / "examples" / "ball_on_plate.toml").read_text())
    words = [sys.executable, "-c", script, str(study)]
    ended = subprocess.run(words, cwd=folder / "gone", capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout) == (2, "")
    assert "current folder" in ended.stderr
    assert ended.stderr.count("\n") == 1


@pytest.mark.parametrize("kind", [".h5", ".vtkhdf", ".png", ".mp4"])
def test_a_landing_replaces_a_file_only_when_told_to(tmp_path: Path, kind: str) -> None:
    study, path = Path(__file__).parents[2] / "scenarios" / "first_bounce.toml", tmp_path / f"landing{kind}"
    path.write_text("mine")
    found = RUNNER.invoke(app, ["land", str(study), "--out", str(path)])
    assert (found.exit_code, found.stdout) == (2, "")
    assert found.stderr.startswith(str(path))
    assert found.stderr.count("\n") == 1
    assert "--out" in found.stderr
    assert "--force" in found.stderr
    assert path.read_text() == "mine"


def test_runs_are_listed_with_how_fast_they_left(folder: Path) -> None:
    lines = RUNNER.invoke(app, ["runs", str(folder)]).stdout.splitlines()
    assert [line.split() for line in lines] == [
        ["rebound"],
        ["wall", "speed"],
        ["key", "status", "[s]", "outcome", "or", "reason"],
        ["first", "done", "0.1", "clear"],
    ]
