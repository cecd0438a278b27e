"""The command line: what it says, and with which exit code."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from lithobrake.cli import app

RUNNER = CliRunner()


def test_help_names_the_commands() -> None:
    shown = RUNNER.invoke(app, ["--help"])
    assert shown.exit_code == 0
    for name in (
        "new",
        "plan",
        "run",
        "status",
        "runs",
        "bed",
        "screen",
        "refine",
        "test",
        "sample",
        "fly",
        "report",
        "view",
    ):
        assert f" {name} " in shown.stdout


def test_help_imports_nothing_heavy() -> None:
    heavy = "{'numpy', 'numba', 'scipy', 'pydantic', 'rich.progress', 'matplotlib'}"
    code = f"import sys; from lithobrake.cli import app; print(sorted({heavy} & set(sys.modules)))"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert shown.stdout.strip() == "[]"


def test_new_writes_a_study_and_does_not_overwrite_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert RUNNER.invoke(app, ["new", "bennu"]).exit_code == 0
    assert "[lander]" in (tmp_path / "bennu.toml").read_text()
    again = RUNNER.invoke(app, ["new", "bennu"])
    assert again.exit_code == 2
    assert "bennu.toml exists" in again.stderr


def refused(arguments: list[str]) -> str:
    """What is said on standard error; there is no traceback, and the exit code is 2."""
    shown = RUNNER.invoke(app, arguments)
    assert shown.exit_code == 2
    assert "Traceback" not in shown.output
    return shown.stderr


def test_a_missing_study_file_is_one_sentence(tmp_path: Path) -> None:
    said = refused(["run", str(tmp_path / "none.toml"), "--out", str(tmp_path / "out")])
    assert "none.toml: the study file cannot be read" in said
    assert not (tmp_path / "out").exists()


def test_all_errors_of_a_study_are_listed_before_anything_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    RUNNER.invoke(app, ["new", "wrong"])
    text = (tmp_path / "wrong.toml").read_text().replace("mass = 2.6", "mas = -2.6").replace("speed = 0.2", "speed = 0")
    (tmp_path / "wrong.toml").write_text(text)
    said = refused(["run", "wrong.toml"])
    assert "wrong.toml: lander.mas is not a known key; did you mean mass?" in said
    assert "wrong.toml: lander.mass is missing" in said
    assert "wrong.toml: impact.speed is 0; allowed: above 0 [m/s]" in said
    assert not (tmp_path / "runs").exists()


def test_a_folder_that_cannot_be_written_is_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    RUNNER.invoke(app, ["new", "study"])
    (tmp_path / "file").write_text("in the way")
    assert "cannot be written" in refused(["run", "study.toml", "--out", str(tmp_path / "file" / "out")])


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="the administrator may write anywhere")
def test_a_read_only_folder_is_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    RUNNER.invoke(app, ["new", "study"])
    (tmp_path / "locked").mkdir(mode=0o500)
    assert "cannot be written" in refused(["run", "study.toml", "--out", str(tmp_path / "locked" / "out")])


@pytest.mark.parametrize("command", ["report", "view"])
def test_a_folder_without_results_says_how_to_make_them(command: str, tmp_path: Path) -> None:
    assert "lithobrake run STUDY.toml" in refused([command, str(tmp_path)])


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--executor", "dask"], "--executor dask and --scheduler tcp://HOST:PORT go together"),
        (["--scheduler", "tcp://127.0.0.1:9"], "--executor dask and --scheduler tcp://HOST:PORT go together"),
        (["--executor", "mpi"], "--executor is mpi; allowed: local, dask"),
    ],
)
def test_an_executor_that_does_not_exist_is_refused(options: list[str], said: str) -> None:
    assert said in refused(["run", "study.toml", *options])


@pytest.mark.parametrize("command", ["status", "runs"])
def test_a_folder_that_is_no_study_is_one_sentence(command: str, tmp_path: Path) -> None:
    assert str(tmp_path) in refused([command, str(tmp_path)])
