"""Small studies with the ball on the plate: what is reused, what is told, and what is said when something is wrong."""

import os
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from lithobrake.campaign import Record
from lithobrake.pipeline import run_study
from lithobrake.pipeline.study_run import run
from lithobrake.results import open_study
from lithobrake.study import StudySource

from ..command_line import lithobrake
from .ball_studies import FEW_RUNS, FEW_SAMPLES, PROGRAM, PYTHON, write_ball
from .killed_studies import start

FRICTION = 'friction = { distribution = "uniform", lower = 0.05, upper = 0.4 }'


def write_study(folder: Path, changes: dict[str, str], program: Path = PROGRAM) -> Path:
    return write_ball(folder / "study.toml", FEW_RUNS | {"test_count = 10": "test_count = 6"} | changes, program)


def said_by(*arguments: object, code: int = 0) -> str:
    """What a command says on standard error, its lines joined."""
    ended = lithobrake(*arguments)
    assert ended.returncode == code, ended.stderr
    assert "Traceback" not in ended.stderr
    return " ".join(ended.stderr.split())


def what_came(records: list[Record]) -> dict[str, tuple[object, ...]]:
    """Of each run by its key, what it follows from and what came of it; and when it was made."""
    return {entry.key: (entry.inputs, entry.seed, entry.outcome, entry.outputs, entry.ended) for entry in records}


@pytest.fixture(scope="module")
def fixed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study up to its test runs, in which the friction is a number."""
    folder = tmp_path_factory.mktemp("fixed")
    said = said_by("test", write_study(folder, {FRICTION: "friction = 0.225"}), "--out", folder / "out", "--workers", 1)
    assert "screening" in said
    assert "reused" not in said.partition("refine")[0]
    return folder / "out"


def test_an_input_that_becomes_uncertain_reuses_the_runs_at_its_median_and_says_so(fixed: Path) -> None:
    before = what_came(open_study(fixed).ledger)
    said = said_by("screen", write_study(fixed.parent, {}), "--out", fixed, "--workers", 1)
    # Three inputs have 7 nodes, four have 9: the two new ones are the ends of the friction.
    assert "screening: 7 of 9 runs were known and are reused" in said
    after = what_came(open_study(fixed).ledger)
    assert len(after) == len(before) + 2
    assert {key: after[key] for key in before} == before


def test_one_more_bed_reuses_the_runs_that_stay_on_theirs_and_says_so(fixed: Path) -> None:
    before = what_came(open_study(fixed).ledger)
    changes = {FRICTION: "friction = 0.225", "bed_count = 1": "bed_count = 2"}
    said = said_by("screen", write_study(fixed.parent, changes), "--out", fixed, "--workers", 1)
    after = what_came(open_study(fixed).ledger)
    moved = [entry for entry in open_study(fixed).ledger if entry.inputs["bed"] == 1.0]
    assert 0 < len(moved) < 7
    assert f"screening: {7 - len(moved)} of 7 runs were known and are reused" in said
    assert {key: after[key] for key in before} == before


def test_one_more_run_at_every_point_reuses_the_first_ones_and_says_so(fixed: Path) -> None:
    before = what_came(open_study(fixed).ledger)
    changes = {FRICTION: "friction = 0.225", "screening_level = 2": "screening_level = 1\nreplicate_count = 2"}
    said = said_by("screen", write_study(fixed.parent, changes), "--out", fixed, "--workers", 1)
    assert "screening: 7 of 14 runs were known and are reused" in said
    after = open_study(fixed).ledger
    assert len(after) == len(before) + 7
    assert {entry.replicate for entry in after if entry.key not in before} == {1}
    assert {key: what_came(after)[key] for key in before} == before


FAILS_ABOVE = """
import json, runpy, sys
if json.load(open("inputs.json"))["inputs"]["lander.restitution"] > 0.65:
    sys.exit("the ball broke")
runpy.run_path(PROGRAM, run_name="__main__")
"""


def test_runs_that_fail_in_a_corner_are_not_fitted_around(tmp_path: Path) -> None:
    (tmp_path / "breaks.py").write_text(FAILS_ABOVE.replace("PROGRAM", repr(str(PROGRAM))))
    for share, said in (
        ("0.02", "of 41 runs failed (8 x RuntimeError: the program ended with exit code 1; its last words: "
                 "the ball broke), 8 of them where lander.restitution > 0.6; allowed: at most 2 %"),
        ("0.5", "8 of them lie where lander.restitution > 0.6, so what is fitted without them knows nothing there"),
    ):  # fmt: skip
        changes = {
            "screening_level = 2": "screening_level = 2",
            "failed_share = 0.02": f"failed_share = {share}\nretry_count = 0",
        }
        study = write_study(tmp_path, changes, tmp_path / "breaks.py")
        assert said in said_by("screen", study, "--out", tmp_path / "out", "--workers", 1, code=2)
        assert not (tmp_path / "out" / "screening.json").exists()


def test_a_program_that_never_works_ends_the_study_soon_and_so_does_its_restart(tmp_path: Path) -> None:
    (tmp_path / "never.py").write_text("import sys; sys.exit('\\x1b[31mno [/licence]')")
    study = write_study(tmp_path, {"screening_level = 2": "screening_level = 2"}, tmp_path / "never.py")
    for _ in range(2):
        said = said_by("screen", study, "--out", tmp_path / "out", "--workers", 1, code=2)
        assert "x RuntimeError: the program ended with exit code 1; its last words: no [/licence]), so the" in said
        assert "give the same command again" in said
        # Ten runs, and what was under way beside them.
        assert 10 <= sum(entry.status == "failed" for entry in open_study(tmp_path / "out").ledger) <= 12
    assert "\x1b" not in lithobrake("runs", tmp_path / "out").stdout


def test_a_second_coordinator_is_refused_while_the_first_goes_on(tmp_path: Path) -> None:
    study = write_study(tmp_path, {})
    first = start(study, tmp_path / "out", word="screen")
    assert first.pid is not None
    while not (tmp_path / "out" / "study.toml").is_file():
        assert first.exitcode is None
        time.sleep(0.01)
    os.kill(first.pid, signal.SIGSTOP)
    said = said_by("screen", study, "--out", tmp_path / "out", "--workers", 1, code=2)
    told = lithobrake("status", tmp_path / "out").stdout
    os.kill(first.pid, signal.SIGCONT)
    first.join(timeout=120)
    assert f"another lithobrake is at work in {tmp_path / 'out'} (process {first.pid} on " in said
    assert f"(process {first.pid} on " in told
    assert first.exitcode == 0
    assert len(open_study(tmp_path / "out").ledger) == 9


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of 100 kB."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=100k", "tmpfs", str(disk)]
    try:
        done = subprocess.run(mount, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        pytest.skip("there is no mount command, so no small file system")
    if done.returncode:
        pytest.skip(f"only an administrator may make a small file system ({done.stderr.strip()})")
    yield disk
    subprocess.run(["umount", str(disk)], check=True)


def test_a_disk_that_fills_up_is_one_sentence_and_the_study_goes_on_when_there_is_room(
    fixed: Path, small_disk: Path, tmp_path: Path
) -> None:
    study = write_study(tmp_path, {FRICTION: "friction = 0.225"})
    assert "make room" in said_by("test", study, "--out", small_disk / "out", "--workers", 1, code=2)
    with sqlite3.connect(small_disk / "out" / "runs.sqlite") as database:
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    database.close()
    subprocess.run(["mount", "-o", "remount,size=20m", str(small_disk)], check=True)
    said_by("test", study, "--out", small_disk / "out", "--workers", 1)
    again, before = (what_came(open_study(out).ledger) for out in (small_disk / "out", fixed))
    assert {key: entry[:4] for key, entry in again.items()} == {key: before[key][:4] for key in again}


AS_NOBODY = """
import os, sys
from pathlib import Path
from lithobrake.campaign import Ledger
from lithobrake.pipeline import study_status
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.results import open_study

out = Path(sys.argv[1])
# What is imported late is imported here: the interpreter may lie where nobody may enter.
open_study(out).ledger
study_status(out).lines()
out.chmod(0o555)
if os.geteuid() == 0:
    os.seteuid(65534)
for open_folder in (lambda: StudyFolder(out), lambda: Ledger(out / "runs.sqlite")):
    try:
        open_folder()
    except ValueError as error:
        print(error)
print(len(open_study(out).ledger))
print(*study_status(out).lines(), sep="\\n")
"""


@pytest.mark.skipif(os.name != "posix", reason="folders have an owner and modes on POSIX only")
def test_a_folder_that_may_only_be_read_is_refused_in_one_sentence_and_its_runs_are_read(tmp_path: Path) -> None:
    # Nobody may enter the folders of these tests, so this one lies beside them.
    with tempfile.TemporaryDirectory() as name:
        out = Path(name) / "out"
        os.chmod(name, 0o755)
        said_by("screen", write_study(tmp_path, {FRICTION: "friction = 0.225"}), "--out", out, "--workers", 1)
        before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
        command = [sys.executable, "-c", AS_NOBODY, str(out)]
        said = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
        assert said[0].startswith(f"{out} cannot be written (")
        assert said[0].endswith("choose another folder with --out")
        assert said[1].startswith(f"{out / 'runs.sqlite'} cannot be used as a ledger (")
        assert said[2:4] == ["7", f"{out}: not running; there is no report yet"]
        assert said[4] == "2 of 12 stages are current: screening runs, screening"
        assert said[5].startswith("not there: designs/refined.csv, refined.json, ")
        assert said[6:7] == ["7 runs: 7 done, 0 running, 0 failed"]
        assert {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} == before
        out.chmod(0o755)


def test_a_progress_that_shows_nothing_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="which has no begin, say, progress; allowed: None, or what"):
        run("examples/ball_on_plate.toml", tmp_path / "study", progress=print)  # type: ignore[arg-type]
    assert not (tmp_path / "study").exists()


FEW = FEW_RUNS | FEW_SAMPLES
FEW |= {"screening_degree = 2": "screening_degree = 1\nfit = 'omp'", "refined_level = 3": "refined_level = 2",
    "test_count = 10": "test_count = 6", "sample_count = 10_000": "sample_count = 200\nscatter = true",
    "duration = 7200.0": "duration = 600.0"}  # fmt: skip
# What was done of how much, by stage and piece of work.
Told = dict[str, dict[str, list[tuple[float, float]]]]
# Which pieces of work each stage tells of, in their order.
WORKS = {
    "screening runs": ["screening runs"], "screening": ["screening fit, outputs"], "refined runs": ["refined runs"],
    "refinement": ["refined fit, outputs"], "test runs": ["test kept runs", "test all runs"],
    "scores": ["scores with their intervals"],
    "flights": ["gravity table", "checks of flights", "flights", "flights without scatter"],
    "paths of flights": ["paths of flights", "ways of flights"],
    "landers on hard ground": ["landers, hard ground"],
}  # fmt: skip


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> tuple[Told, list[str]]:
    """What a study has told of its work, and what it has said before the first stage."""
    folder = tmp_path_factory.mktemp("told")
    path = write_ball(folder / "study.toml", FEW)
    stages: Told = {}
    said_first: list[str] = []

    class Shown:
        def say(self, sentence: str) -> None:
            if not stages:
                said_first.append(sentence)

        def begin(self, title: str, number: int, count: int) -> None:
            stages[title] = {}

        def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
            stages[list(stages)[-1]].setdefault(what, []).append((done, total))

    run_study(StudySource.read(path), folder / "out", worker_count=1, until="hard_ground", shown=Shown())
    return stages, said_first


@pytest.fixture
def told(study: tuple[Told, list[str]]) -> Told:
    return study[0]


def test_the_program_of_a_study_is_named_before_anything_starts_it(study: tuple[Told, list[str]]) -> None:
    (said,) = study[1]
    assert said.endswith(f"every remaining run starts: {PYTHON} {PROGRAM}")


@pytest.mark.parametrize("stage", list(WORKS))
def test_every_long_piece_of_work_is_told_of(stage: str, told: Told) -> None:
    assert list(told[stage]) == WORKS[stage]


def test_a_fit_is_counted_from_none_to_all(told: Told) -> None:
    assert [done for done, _ in told["screening"]["screening fit, outputs"]] == [0, *range(7)]
