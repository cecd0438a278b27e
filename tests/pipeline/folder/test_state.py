"""What a study's folder says about its files: what is stale, foreign or damaged is named, and never mixed."""

import json
import os
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import pytest
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.files.atomic import locked
from lithobrake.pipeline.commands.status import StudyStatus
from lithobrake.pipeline.folder_state import FolderState, StageState
from lithobrake.pipeline.study_folder import FileState, Notes
from lithobrake.results import open_study

from ...command_line import lithobrake
from ...ledger_rows import edit_rows
from ..ball_studies import FEW_RUNS, FEW_SAMPLES, edit, write_ball

SMALL = (
    FEW_RUNS | FEW_SAMPLES | {'friction = { distribution = "uniform", lower = 0.05, upper = 0.4 }': "friction = 0.2"}
)
RUNNER = CliRunner()


def run(home: Path, command: str = "run", code: int = 0) -> str:
    """Run the study of a home in its folder; what is said on standard error, its lines joined."""
    ended = lithobrake(command, home / "ball.toml", "--out", home / "out", "--workers", 1)
    assert ended.returncode == code, ended.stderr
    assert "Traceback" not in ended.stderr
    return " ".join(ended.stderr.split())


def said_by(command: str, home: Path, code: int = 0) -> str:
    """What a command says of the folder of a home: on standard output, or in one sentence and with exit code 2."""
    shown = RUNNER.invoke(app, [command, str(home / "out")])
    assert shown.exit_code == code, shown.output
    assert not isinstance(shown.exception, ValueError)
    if code:
        assert len(shown.stderr.splitlines()) == 1
    return shown.stderr if code else shown.stdout


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study file and beside it the folder of the finished study."""
    home = tmp_path_factory.mktemp("finished")
    write_ball(home / "ball.toml", SMALL)
    run(home)
    return home


@pytest.fixture
def home(finished: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy that a test may spoil, on a machine without a browser."""
    monkeypatch.setattr("webbrowser.open", lambda page: False)
    return Path(shutil.copytree(finished, tmp_path / "home"))


def test_a_whole_folder_is_current_and_its_report_can_be_written_again(home: Path) -> None:
    before = {
        file: file.read_bytes() for file in (home / "out").rglob("*") if file.is_file() and file.suffix != ".lock"
    }
    lines = said_by("status", home).splitlines()
    assert lines[0] == f"{home / 'out'}: not running; the report is there"
    assert lines[1].startswith("12 of 12 stages are current: screening runs, screening, refined runs, refinement, ")
    assert not any("earlier" in line for line in lines)
    assert said_by("view", home).startswith("No browser found")
    assert len(said_by("report", home).splitlines()) == len(open_study(home / "out").summary["results"]["headline"]) + 1
    assert {path.name for path, content in before.items() if path.read_bytes() != content} <= {".lock", "keys.json"}
    assert said_by("status", home).splitlines() == lines


def test_a_changed_study_makes_old_files_stale_and_tells_runs_of_earlier_settings(home: Path) -> None:
    edit(home / "ball.toml", {"speed = 0.15": "speed = 0.2"})
    assert f"{home / 'ball.toml'} was edited since" in said_by("status", home)
    assert f"{home / 'ball.toml'} was edited after this report was made" in said_by("view", home)
    before = len(open_study(home / "out").ledger)
    run(home, "screen")
    lines = said_by("status", home).splitlines()
    assert lines[0].endswith("not running; the report is there, but its files have changed since")
    assert lines[1] == "2 of 12 stages are current: screening runs, screening"
    assert lines[2].startswith(
        "of an earlier setting or version: designs/refined.csv, refined.json, designs/test_kept.csv, "
    )
    made = len(open_study(home / "out").ledger) - before
    assert lines[3] == f"{made} runs: {made} done, 0 running, 0 failed"
    assert lines[4] == f"{before} more runs in the ledger are of earlier settings of the study"
    refused = said_by("report", home, code=2)
    assert "of an earlier setting or version: designs/refined.csv, refined.json, " in refused
    assert f"lithobrake run {home / 'ball.toml'} --out {home / 'out'}" in refused
    assert "does not match the files of the study" in said_by("view", home)


def test_edited_and_swapped_files_are_named_and_not_reported_on(home: Path) -> None:
    out = home / "out"
    edit(out / "summary.json", {'"format_version": ': '"format_version":  '})
    (out / "flights.csv").unlink()
    shutil.copy(out / "scores.json", out / "flights.json")
    said = said_by("report", home, code=2)
    assert "changed after it was made: flights.json, summary.json" in said
    assert "not there: flights.csv" in said
    assert "changed after it was made: flights.json, summary.json" in said_by("status", home)


def test_the_study_file_of_another_study_is_named(home: Path) -> None:
    edit(home / "out" / "study.toml", {"speed = 0.15": "speed = 0.2"})
    assert "changed after it was made: study.toml" in said_by("report", home, code=2)


def test_a_folder_of_the_first_format_is_told_and_not_reported_on(home: Path) -> None:
    keys = json.loads((home / "out" / "keys.json").read_text())
    first = {"format_version": 1, "files": keys["files"], "wall_s": keys["wall_s"]}
    (home / "out" / "keys.json").write_text(json.dumps(first))
    assert "keys.json is of an earlier format" in said_by("report", home, code=2)
    assert "keys.json is of an earlier format" in said_by("view", home)
    assert "keys.json is of an earlier format" in said_by("status", home)
    assert "runs: " in said_by("status", home)
    assert "reused" not in run(home)
    assert "earlier format" not in said_by("status", home)


def test_while_a_study_is_at_work_what_is_not_current_is_still_to_come(home: Path) -> None:
    (home / "out" / "samples.h5").unlink()
    (home / "out" / "flights.csv").write_text("half")
    with locked(home / "out" / ".lock", "busy") as note:
        note(stage="samples", number=7, count=11)
        lines = said_by("status", home).splitlines()
        assert "another lithobrake is at work" in said_by("report", home, code=2)
        (home / "out" / ".lock").write_text("{")
        assert f"{home / 'out' / '.lock'} cannot be read (" in said_by("status", home, code=2)
    assert ": stage 7 of 11, samples (process " in lines[0]
    assert lines[2] == "to come: samples, flights"


def damage_hdf5(path: Path) -> None:
    with h5py.File(path, "r+") as file:
        del file["inputs"]


def damage_cell(path: Path, cell: str) -> None:
    """Damage a run that the screening needs."""
    edit_rows(path, "outputs = ? WHERE key = ?", (cell, Notes.read(path.parent).designs["screening"][0]))


FILES: dict[str, tuple[str, Callable[[Path], object]]] = {
    "empty summary": ("summary.json", lambda path: path.write_text("")),
    "a list as summary": ("summary.json", lambda path: path.write_text("[1, 2]")),
    "3000 brackets": ("summary.json", lambda path: path.write_text("[" * 3000)),
    "400 digits": ("flights.json",
                   lambda path: edit(path, {'"jacobi_flight_count": ': '"a": ' + 400 * "9" + ', "b": '})),
    "empty flights": ("flights.csv", lambda path: path.write_text("")),
    "another table": ("flights.csv", lambda path: path.write_text("a,b\n1,2\n")),
    "empty rest": ("rest.csv", lambda path: path.write_text("")),
    "a number as scores": ("scores.json", lambda path: path.write_text("3")),
    "half an expansion": ("refined.json", lambda path: path.write_text(path.read_text()[:500])),
    "another expansion": ("screening.json", lambda path: path.write_text('{"format": "lithobrake expansion"}')),
    "truncated samples": ("samples.h5", lambda path: path.write_bytes(path.read_bytes()[:3000])),
    "samples without inputs": ("samples.h5", damage_hdf5),
}  # fmt: skip
KEYS = {"empty": "", "a list": "[1]", "a number": "3", "no format": "{}",
    "files are a list": '{"format_version": 2, "files": []}',
    "a file is a number": '{"format_version": 2, "files": {"summary.json": 3}}',
    "stages without names": '{"format_version": 2, "stages": {"a": {"title": "a", "key": "b", "files": []}}}',
    "400 digits": '{"format_version": 2, "wall_s": {"bed": ' + 400 * "9" + "}}",
    "3000 brackets": "[" * 3000 + "]" * 3000}  # fmt: skip
LEDGERS: dict[str, Callable[[Path], object]] = {
    "empty": lambda path: path.write_bytes(b""),
    "no database": lambda path: path.write_text("this is not a database, and long enough to be seen as such" * 20),
    "truncated": lambda path: path.write_bytes(path.read_bytes()[: path.stat().st_size // 2]),
    "another database": lambda path: (path.unlink(), sqlite3.connect(path).execute("CREATE TABLE runs (a TEXT)")),
    "a broken cell": lambda path: damage_cell(path, '{"speed_out": '),
    "a list in a cell": lambda path: damage_cell(path, "[1]"),
    "a word for a number": lambda path: damage_cell(path, '{"speed_out": "fast"}'),
    "400 digits": lambda path: damage_cell(path, '{"speed_out": ' + 400 * "9" + "}"),
    "3000 brackets": lambda path: damage_cell(path, "[" * 3000),
}


@pytest.mark.parametrize(("name", "damage"), FILES.values(), ids=FILES)
def test_a_damaged_file_is_named_with_the_remedy(name: str, damage: Callable[[Path], object], home: Path) -> None:
    damage(home / "out" / name)
    said = said_by("report", home, code=2)
    assert f"changed after it was made: {name}" in said
    assert "make them with: lithobrake run " in said
    assert f"changed after it was made: {name}" in said_by("status", home)
    assert f"changed after it was made: {name}" in said_by("view", home)
    assert said_by("runs", home)


@pytest.mark.parametrize("text", KEYS.values(), ids=KEYS)
def test_damaged_keys_are_one_sentence(text: str, home: Path) -> None:
    (home / "out" / "keys.json").write_text(text)
    for command in ("report", "status", "view"):
        said = said_by(command, home, code=2)
        assert said.startswith(f"{home / 'out' / 'keys.json'} cannot be read (")
        assert "lithobrake run STUDY.toml" in said


@pytest.mark.parametrize("damage", LEDGERS.values(), ids=LEDGERS)
def test_a_damaged_ledger_is_one_sentence(damage: Callable[[Path], object], home: Path) -> None:
    damage(home / "out" / "runs.sqlite")
    for command in ("status", "runs"):
        said = said_by(command, home, code=2)
        assert said.startswith(f"{home / 'out' / 'runs.sqlite'} cannot be read (")
        assert "put a copy of it back, or move it away" in said


def test_edited_rows_of_the_ledger_are_left_out_and_made_again(home: Path, caplog: pytest.LogCaptureFixture) -> None:
    ledger, designs = home / "out" / "runs.sqlite", home / "out" / "designs"
    before, tables = open_study(home / "out").ledger, {path: path.read_bytes() for path in designs.iterdir()}
    with sqlite3.connect(ledger) as database:
        speed = "json_set(outputs, '$.speed_out', 0.5 * json_extract(outputs, '$.speed_out'))"
        database.execute(f"UPDATE runs SET outputs = {speed} WHERE outcome = 'clear'")
    database.close()
    shutil.rmtree(designs)
    said_by("status", home)
    assert "left out here and made again" in caplog.messages[0]
    run(home)
    assert {path: path.read_bytes() for path in designs.iterdir()} == tables
    after = {record.key: record for record in open_study(home / "out").ledger}
    assert {key: record.outputs for key, record in after.items()} == {one.key: one.outputs for one in before}


@pytest.mark.parametrize("name", [name for name in LEDGERS if name != "empty"])
def test_a_damaged_ledger_is_not_written_over(name: str, home: Path) -> None:
    ledger = home / "out" / "runs.sqlite"
    LEDGERS[name](ledger)
    (home / "out" / "designs" / "screening.csv").unlink()
    before = ledger.read_bytes()
    shown = RUNNER.invoke(app, ["screen", str(home / "ball.toml"), "--out", str(home / "out"), "--workers", "1"])
    assert shown.exit_code == 2
    assert f"{ledger} cannot be " in shown.stderr
    assert "put a copy of it back, or move it away" in shown.stderr
    assert ledger.read_bytes() == before


def test_a_run_makes_damaged_files_again_with_the_same_bytes(home: Path) -> None:
    out = home / "out"
    results = open_study(out).summary["results"]
    runs, before = open_study(out).ledger, {}
    for name, damage in dict(FILES.values()).items():
        before[name] = (out / name).read_bytes()
        damage(out / name)
    run(home)
    del before["summary.json"]
    assert {name: (out / name).read_bytes() for name in before} == before
    # The summary has the times of this execution too.
    assert open_study(out).summary["results"] == results
    assert open_study(out).ledger == runs


def test_a_run_with_damaged_keys_says_so_and_makes_the_files_again(home: Path) -> None:
    (home / "out" / "keys.json").write_text("")
    said = run(home)
    assert f"{home / 'out' / 'keys.json'} cannot be read (" in said
    assert "so its files are made again" in said
    assert said_by("status", home).splitlines()[1].startswith("12 of 12 stages are current")


@pytest.mark.parametrize("words", [["status"], ["runs", "--csv"]], ids=" ".join)
def test_a_reader_that_has_enough_is_no_mistake(words: list[str], home: Path) -> None:
    command = [sys.executable, "-m", "lithobrake", *words, str(home / "out")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as writer:
        # As `| head -0` does: nobody reads a line.
        writer.stdout.close()
        said = writer.stderr.read()
    assert said == ""
    assert writer.returncode == 0


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="the administrator may write anywhere")
def test_no_report_is_written_where_nothing_may_be(home: Path) -> None:
    (home / "out").chmod(0o555)
    try:
        assert "no report can be written there" in said_by("report", home, code=2)
    finally:
        (home / "out").chmod(0o755)


def test_files_of_the_stage_at_work_are_its_own_before_they_are_noted() -> None:
    new, missing = FileState.FOREIGN, FileState.MISSING
    stage = StageState(2, "bed", "beds", {"beds/bed_0.h5": new, "beds/bed_1.h5": missing})
    state = FolderState(Notes(), [stage], "", "", None)

    def told(number: int | None) -> Any:
        holder = None if number is None else {"number": number, "stage": "beds", "count": 9, "process": 1, "host": "h"}
        return StudyStatus(Path("out"), holder, None, state, None).to_json()["stages"][0]["files"]

    assert told(2) == {"beds/bed_0.h5": "made by the stage at work", "beds/bed_1.h5": "not there"}
    assert told(1) == told(None) == {"beds/bed_0.h5": FileState.FOREIGN, "beds/bed_1.h5": "not there"}


def test_looking_at_a_study_loads_nothing_heavy() -> None:
    heavy = "{'numpy', 'pydantic', 'numba', 'scipy', 'h5py', 'matplotlib'}"
    code = f"import sys; from lithobrake.pipeline import study_status; print(sorted({heavy} & set(sys.modules)))"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert shown.stdout.strip() == "[]"
