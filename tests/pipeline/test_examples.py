"""Solvers of one's own, as a user starts them from examples and scripts, and what a study does with their answers."""

import csv
import io
import json
import math
import runpy
import shutil
import subprocess
import sys
from datetime import datetime, timedelta
from pathlib import Path
from types import ModuleType

import pytest

from lithobrake.campaign import LocalExecutor
from lithobrake.campaign.worker import MainModuleError
from lithobrake.pipeline import study_run
from lithobrake.pipeline.design.dependencies import solver_dependencies
from lithobrake.results import open_study
from lithobrake.study import StudyError, read_study

from ..command_line import lithobrake
from .ball_studies import FEW_RUNS, FEW_SAMPLES, edit, write_ball

EXAMPLES = Path(__file__).parents[2] / "examples"
# Fewer runs, of a program that does not look for packages, of which it needs none: sooner there, for each run.
FEWER = FEW_SAMPLES | {
    "python3 ball_on_plate.py": "python3 -S ball_on_plate.py",
    "refined_level = 3": "refined_level = 2", "refined_degree = 3": "refined_degree = 2",
}  # fmt: skip


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The study of the example."""
    folder = tmp_path_factory.mktemp("plate")
    shutil.copy(EXAMPLES / "ball_on_plate.py", folder)
    shutil.copy(EXAMPLES / "ball_on_plate.toml", folder)
    study = edit(folder / "ball_on_plate.toml", FEWER)
    ended = lithobrake("run", study, "--out", folder / "out", "--workers", 1)
    assert ended.returncode == 0, ended.stderr
    return folder / "out"


def test_a_study_with_a_program_goes_to_its_report(plate: Path) -> None:
    results = open_study(plate).results
    analysis, hard_ground = results.expansion, results.hard_ground
    assert (results.beds, analysis.designs["test_all"].outcomes) == ((), {"clear": 10})
    assert analysis.scores["test_all"]["speed_out"].q2 > 0.9
    assert "solver.inputs.plate_tilt_deg" in analysis.screening.inputs
    # One speed of all impacts: the expansion knows no later ones.
    assert {ground: one.count for ground, one in hard_ground.items()} == {"hard": 5}
    page = (plate / "report" / "index.html").read_text()
    assert "The touchdowns were made by a program of the study&#x27;s author: python3 -S ball_on_plate.py" in page


def test_the_summary_says_when_it_was_made(plate: Path) -> None:
    date = datetime.fromisoformat(open_study(plate).summary["provenance"]["date"])
    assert date.utcoffset() == timedelta(0)
    assert abs(date.timestamp() - (plate / "summary.json").stat().st_mtime) < 60.0
    assert f"Study of {date:%Y-%m-%d, %H:%M} UTC" in (plate / "report" / "index.html").read_text(encoding="utf-8")


def test_the_runs_are_told_from_another_terminal(plate: Path) -> None:
    records = open_study(plate).ledger
    said = lithobrake("status", plate).stdout
    assert f"{len(records)} runs: {len(records)} done, 0 running, 0 failed" in said
    assert f"outcomes: {len(records)} clear" in said
    assert "speed_out" in said
    rows = list(csv.DictReader(io.StringIO(lithobrake("runs", plate, "--csv").stdout)))
    assert [row["key"] for row in rows] == [entry.key for entry in records]
    assert float(rows[0]["input:impact.speed [m/s]"]) == 0.15
    assert {"input:lander.friction [-]", "input:solver.inputs.plate_tilt_deg", "output:spin_out [rad/s]"} <= set(
        rows[0]
    )
    sections, names, units, *lines = lithobrake("runs", plate).stdout.splitlines()
    assert sections.split() == ["rebound", "lander", "lander", "impact"]
    assert names.split() == ["wall", "speed", "restitution", "friction", "incidence_deg"]
    assert units.split() == ["key", "status", "[s]", "[m/s]", "[-]", "[-]", "[deg]", "outcome", "or", "reason"]
    assert [line.split()[0] for line in lines[:-1]] == [entry.key[:12] for entry in records]
    assert "--csv" in lines[-1]


def test_a_higher_order_and_more_test_runs_reuse_what_is_still_valid_and_say_so(plate: Path, tmp_path: Path) -> None:
    shutil.copy(EXAMPLES / "ball_on_plate.py", tmp_path)
    shutil.copy(plate.parent / "ball_on_plate.toml", tmp_path / "more.toml")
    edit(tmp_path / "more.toml", {"refined_level = 2": "refined_level = 3", "test_count = 10": "test_count = 12"})
    # The folder goes over to the study under its new name.
    shutil.copy(tmp_path / "more.toml", plate / "study.toml")
    before = len(open_study(plate).ledger)
    ended = lithobrake("test", tmp_path / "more.toml", "--out", plate, "--workers", 1)
    assert ended.returncode == 0, ended.stderr
    said = " ".join(ended.stderr.split())
    # Nodes of the finer grid that are those of the coarser one.
    assert "refined: 25 of 69 runs were known and are reused" in said
    assert "test all: 10 of 12 runs were known and are reused" in said
    assert len(open_study(plate).ledger) == before + 44 + 2 + 2


def test_the_function_gives_what_the_program_gives(
    plate: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    script = EXAMPLES / "ball_on_plate_campaign.py"
    monkeypatch.setattr(sys, "argv", [str(script), str(tmp_path)])
    # Where Python looks for what a script imports.
    monkeypatch.syspath_prepend(EXAMPLES)
    # As `python ball_on_plate_campaign.py FOLDER` does, whose processes import the script.
    told = []
    for _ in range(2):
        runpy.run_path(str(script), run_name="__main__")
        told.append(capfd.readouterr().out)
    first, second = told
    assert first.startswith("69 runs, 0 of them known before\n")
    assert second.startswith("69 runs, 69 of them known before\n")
    assert first.split("\n")[1:] == second.split("\n")[1:]
    told = lithobrake("status", tmp_path).stdout.splitlines()
    assert told[:2] == [f"{tmp_path}: not running", "69 runs: 69 done, 0 running, 0 failed"]
    assert any(line.startswith("velocity_out_z ") for line in told)
    centre = {"incidence_deg": 35.0, "restitution": 0.6, "friction": 0.225}
    (here,) = (
        entry.outputs
        for entry in open_study(tmp_path).ledger
        if all(math.isclose(entry.inputs[name], value) for name, value in centre.items())
    )
    (there,) = (
        entry.outputs
        for entry in open_study(plate).ledger
        if math.isclose(entry.inputs["impact.incidence_deg"], 35.0)
        and math.isclose(entry.inputs["lander.restitution"], 0.6)
        and math.isclose(entry.inputs["lander.friction"], 0.225)
        and entry.inputs["solver.inputs.plate_tilt_deg"] == 0.0
    )
    assert {name: there[name] for name in here} == here


def test_a_frictionless_elastic_ball_is_thrown_back_as_light_from_a_mirror() -> None:
    code = f"import sys; sys.path.insert(0, {str(EXAMPLES)!r}); from ball_on_plate import bounce; import json; "
    code += "print(json.dumps(bounce(2.0, 0.5, 1.0, 0.0, 0.05, 0.0, 0.1)))"
    out = json.loads(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout)
    # The mirror is tilted by 0.1: the ray, 0.5 from the vertical, comes back 0.5 - 2 x 0.1 from it.
    assert out["velocity_out_x"] == pytest.approx(2 * math.sin(0.3), rel=1e-14)
    assert out["velocity_out_z"] == pytest.approx(2 * math.cos(0.3), rel=1e-14)
    assert out["spin_out"] == 0.0


def test_the_place_of_a_study_does_not_name_its_runs(tmp_path: Path) -> None:
    for name in ("ball_on_plate.toml", "ball_on_plate.py"):
        (tmp_path / name).write_text((EXAMPLES / name).read_text())
    here, there = (read_study(folder / "ball_on_plate.toml") for folder in (EXAMPLES, tmp_path))
    assert solver_dependencies(here) == solver_dependencies(there)
    (tmp_path / "ball_on_plate.py").write_text("print()")
    assert solver_dependencies(here) != solver_dependencies(there)


@pytest.mark.parametrize(("command", "said"), [
    ("no-such-program x", 'solver.command begins with "no-such-program", which is no program here; give its path'),
    ("python3 'x", "close every quotation mark"),
    (r"python3 \u0000x", r"allowed: what can be shown on one line; write plain words"),
    ("/" + "x" * 300, "which is no program here; give its path"),
])  # fmt: skip
def test_a_command_that_cannot_be_started_is_refused(command: str, said: str, tmp_path: Path) -> None:
    text = (EXAMPLES / "ball_on_plate.toml").read_text().replace("python3 ball_on_plate.py", command)
    (tmp_path / "study.toml").write_text(text)
    with pytest.raises(StudyError, match=said):
        read_study(tmp_path / "study.toml")


def test_inputs_without_a_command_are_refused(tmp_path: Path) -> None:
    text = (EXAMPLES / "ball_on_plate.toml").read_text().replace("command = ", "# command = ")
    (tmp_path / "study.toml").write_text(text)
    with pytest.raises(StudyError, match=r"solver\.command is missing"):
        read_study(tmp_path / "study.toml")


# What a worker that starts a script again prints comes twice.
SCRIPT = """
print("started")
from pathlib import Path
import lithobrake

results = lithobrake.run("ball.toml", out="out", workers=1, report=False)
print(results.runs.row_count, sorted(set(results.runs["outcome"].tolist())))
"""
OWN_MODEL = """
import tomllib
from pathlib import Path
import lithobrake

def model(inputs, seed):
    return {"outcome": "captured", "outputs": {}}

tables = tomllib.loads(Path("ball.toml").read_text())
del tables["solver"]
lithobrake.run(tables, out="out", model=model, workers=1, report=False)
"""


def test_a_study_starts_from_a_piped_script_without_a_guard(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    few = FEW_RUNS | {"sample_count = 10_000": "sample_count = 0", "flight_count = 50": "flight_count = 1"}
    write_ball(tmp_path / "ball.toml", few | {"count = 200 ": "count = 0 "})
    # No file and no module has what is piped.
    main = ModuleType("__main__")
    monkeypatch.setitem(sys.modules, "__main__", main)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(study_run, "LocalExecutor", LocalExecutor)
    exec(SCRIPT, vars(main))
    assert capfd.readouterr().out == "started\n13 ['clear']\n"


def test_a_model_that_workers_cannot_import_is_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """That of a piped script is refused in tests/campaign."""
    write_ball(tmp_path / "ball.toml", FEW_RUNS)
    (tmp_path / "script.py").write_text(OWN_MODEL)
    monkeypatch.chdir(tmp_path)
    # A worker is a process of its own, which imports the script.
    monkeypatch.setattr(study_run, "LocalExecutor", LocalExecutor)
    words = 'what starts it belongs under: if __name__ == "__main__":'
    with pytest.raises(MainModuleError, match=f"^[^\n]*{words}[^\n]*$"):
        runpy.run_path("script.py", run_name="__main__")
