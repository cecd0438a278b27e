"""The command line: what it says on terminals and in files, and with which exit code."""

import io
import os
import re
import subprocess
import sys
import time
import tomllib
from pathlib import Path
from types import SimpleNamespace

import pytest
import typer
from rich.console import Console
from typer.testing import CliRunner

from lithobrake import __version__
from lithobrake.campaign import Ledger
from lithobrake.cli import app
from lithobrake.cli.arguments import EXPERT, EXPORT, LOOK, RUN, START
from lithobrake.progress import ProgressBars, ProgressLog
from lithobrake.study.short_study import all_keys, known_body, known_lander, short_study
from lithobrake.study.template import template

RUNNER = CliRunner()


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder, which is the current one."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def study(home: Path) -> Path:
    RUNNER.invoke(app, ["new", "study", "--full"])
    return home / "study.toml"


def test_help_names_the_commands() -> None:
    shown = RUNNER.invoke(app, ["--help"])
    assert shown.exit_code == 0
    names = "new examples plan run status runs bed screen refine test sample fly report export serve view"
    for name in names.split():
        assert f" {name} " in shown.stdout


def test_help_has_the_commands_in_groups() -> None:
    shown = RUNNER.invoke(app, ["--help"], env={"COLUMNS": "80"}).stdout
    places = [shown.index(f" {group} ") for group in (START, RUN, LOOK, EXPORT, EXPERT)]
    assert places == sorted(places)
    firsts = [shown.index(f"│ {name} ") for name in ("new", "plan", "report", "export", "rare")]
    assert all(place < first for place, first in zip(places, firsts, strict=True))
    assert all(first < place for first, place in zip(firsts, places[1:], strict=False))
    # No command stands outside of a group.
    assert "─ Commands ─" not in shown
    assert max(map(len, shown.splitlines())) <= 80


def test_examples_are_listed_and_copied(home: Path) -> None:
    listed = RUNNER.invoke(app, ["examples"]).stdout.splitlines()
    assert "  quick                     Quick look: CubeSat on Dimorphos" in listed
    assert max(map(len, listed)) <= 100
    copied = RUNNER.invoke(app, ["examples", "ball_on_plate"])
    run_it = "Run it with: lithobrake run ball_on_plate.toml"
    assert copied.stdout == f"Wrote ball_on_plate.toml, with ball_on_plate.py. {run_it}\n"
    (home / "ball_on_plate.toml").write_text("mine")
    refused = RUNNER.invoke(app, ["examples", "ball_on_plate"])
    assert (refused.exit_code, (home / "ball_on_plate.toml").read_text()) == (2, "mine")
    assert "ball_on_plate.toml exists, and is not replaced" in refused.output
    assert "did you mean quick?" in RUNNER.invoke(app, ["examples", "quik"]).output


@pytest.mark.parametrize("arguments", [["-h"], ["run", "-h"], ["runs", "-h"]])
def test_help_has_a_short_name_too(arguments: list[str]) -> None:
    assert RUNNER.invoke(app, arguments).output == RUNNER.invoke(app, [*arguments[:-1], "--help"]).output


@pytest.mark.parametrize("command", sorted(typer.main.get_command(app).commands))
def test_the_help_of_each_command_ends_in_an_example(command: str) -> None:
    assert f"Example: lithobrake {command} " in RUNNER.invoke(app, [command, "--help"]).output


def test_the_version_is_told() -> None:
    shown = RUNNER.invoke(app, ["--version"])
    assert (shown.exit_code, shown.output) == (0, f"lithobrake {__version__}\n")


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_of_a_shell_that_completes_is_given(shell: str) -> None:
    code = "from lithobrake.cli import app; app(prog_name='lithobrake')"

    def said(**variables: str) -> str:
        environment = os.environ | variables
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=False, env=environment
        )
        return done.stdout

    assert f"_LITHOBRAKE_COMPLETE=complete_{shell}" in said(_LITHOBRAKE_COMPLETE=f"source_{shell}")
    words = {"COMP_WORDS": "lithobrake sta", "COMP_CWORD": "1", "_TYPER_COMPLETE_ARGS": "lithobrake sta"}
    words["_TYPER_COMPLETE_FISH_ACTION"] = "get-args"
    assert "status" in said(_LITHOBRAKE_COMPLETE=f"complete_{shell}", **words)


def test_help_imports_nothing_heavy() -> None:
    heavy = "{'numpy', 'numba', 'scipy', 'pydantic', 'rich.progress', 'matplotlib'}"
    code = f"import sys; from lithobrake.cli import app; print(sorted({heavy} & set(sys.modules)))"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert shown.stdout.strip() == "[]"


def test_new_writes_a_study_and_does_not_overwrite_one(home: Path) -> None:
    assert RUNNER.invoke(app, ["new", "bennu"]).exit_code == 0
    text = short_study(known_body("dimorphos"), known_lander("2u"), (10.0, -60.0))
    assert (home / "bennu.toml").read_text() == text
    assert RUNNER.invoke(app, ["new", "all", "--full"]).exit_code == 0
    assert (home / "all.toml").read_text() == text + all_keys()
    assert RUNNER.invoke(app, ["new", "bounce", "--first-bounce"]).exit_code == 0
    assert (home / "bounce.toml").read_text() == template()
    again = RUNNER.invoke(app, ["new", "bennu"])
    assert again.exit_code == 2
    assert "bennu.toml exists" in again.stderr


def test_new_names_body_lander_and_place(home: Path) -> None:
    arguments = ["--body", "BENNU", "--lander", "mascot", "--at", "-20,300", "--shape", "bennu.obj"]
    assert RUNNER.invoke(app, ["new", "visit", *arguments]).exit_code == 0
    tables = tomllib.loads((home / "visit.toml").read_text())
    assert (tables["title"], tables["lander"]["mass"]) == ("MASCOT on Bennu", 10.0)
    assert (tables["delivery"]["latitude_deg"], tables["delivery"]["longitude_deg"]) == (-20.0, 300.0)
    assert (tables["site"]["body"], tables["site"]["mass"]) == ("bennu.obj", 7.329e10)
    assert "the package has no shape of Bennu; give a closed mesh" in refused(["new", "x", "--body", "bennu"])
    assert "known are Didymos, Dimorphos, Bennu" in refused(["new", "x", "--body", "pluto"])
    assert "known are 1U, 2U" in refused(["new", "x", "--lander", "4u"])
    assert "shape is empty" in refused(["new", "x", "--body", "bennu", "--shape", ""])
    assert "--first-bounce takes none of" in refused(["new", "x", "--first-bounce", "--lander", "6u"])
    odd = 'C:\\new\\"table".obj'
    assert RUNNER.invoke(app, ["new", "odd", "--body", "dimorphos", "--shape", odd]).exit_code == 0
    text = (home / "odd.toml").read_text()
    assert tomllib.loads(text)["site"]["body"] == odd
    # The other body is a ball of its volume, and the orbit that of the two.
    other = tomllib.loads(text)["site"]["partner_body"]
    assert other == {"name": "Didymos", "mass": 5.32e11, "diameter": pytest.approx(765.2)}
    for at in ("91,0", "10", "a,b", "nan,0"):
        assert "it takes a latitude of -90 to 90" in refused(["new", "x", "--at", at])
    assert not (home / "x.toml").exists()


MESH = ["--shape", "apophis.obj"]


@pytest.mark.parametrize(("arguments", "words"), [
    (MESH, "--shape is given; allowed: --shape with --body, whose mass and spin are known, or with both --mass"),
    ([*MESH, "--mass", "4e10"], "--shape and --mass are given; allowed"),
    ([*MESH, "--body", "bennu", "--mass", "4e10"], "--body and --shape and --mass are given; allowed: --shape with"),
    (["--mass", "4e10", "--spin", "1e5"], "--mass and --spin are given; allowed: --shape"),
    ([*MESH, "--mass", "-1", "--spin", "1e5"], "--mass is -1; allowed: a finite number above 0 [kg]"),
    ([*MESH, "--mass", "4e10", "--spin", "nan"], "--spin is nan; allowed: a finite number; write one"),
    (["--body", "bennu", "--shape", "m/ryugu_v3.obj"], "which names Ryugu, and --body is Bennu"),
])  # fmt: skip
def test_no_study_has_the_mass_of_another_body(arguments: list[str], words: str, home: Path) -> None:
    assert words in refused(["new", "x", *arguments])


def test_a_body_by_its_mesh_has_the_mass_and_the_spin_that_are_given(home: Path) -> None:
    given = [*MESH, "--mass", "4e10", "--spin", "110160"]
    assert RUNNER.invoke(app, ["new", "apo", *given]).exit_code == 0
    tables = tomllib.loads((home / "apo.toml").read_text())
    assert tables["site"] == {"body": "apophis.obj", "name": "apophis", "mass": 4e10, "spin_period": 110160.0}
    assert tables["title"] == "2U on apophis"
    assert "partner_body" not in (home / "apo.toml").read_text()


@pytest.mark.parametrize(
    "name", ["", " ", ".", "..", "/", "folder/", ".toml", "folder/.toml", "a\nb", " a", "a\x1b[2J", "-x"]
)
def test_a_study_needs_a_name_that_can_be_pasted(name: str, home: Path) -> None:
    (home / "folder").mkdir()
    assert "allowed: a name, or a path that ends in one; write, say, bennu" in refused(["new", "--", name])
    assert [path.name for path in home.rglob("*")] == ["folder"]


def test_a_name_with_blanks_is_quoted_where_it_is_to_be_pasted(home: Path) -> None:
    assert RUNNER.invoke(app, ["new", "two words"]).output.endswith("then: lithobrake run 'two words.toml'\n")
    assert "--out 'two words'" in refused(["view", "two words"])


def test_a_name_that_no_file_can_have_is_one_sentence(home: Path) -> None:
    assert "cannot be written (File name too long)" in refused(["new", "x" * 300])
    assert "cannot be written (No such file or directory)" in refused(["new", "nowhere/x"])


def refused(arguments: list[str]) -> str:
    """What is said on standard error; there is no traceback, and the exit code is 2."""
    shown = RUNNER.invoke(app, arguments)
    assert shown.exit_code == 2
    assert "Traceback" not in shown.output
    return shown.stderr


SCHEMA = ("mass = 2.6", "mas = 2.6")
BETWEEN_KEYS = ("# bed_count =", "bed_count = 300")


@pytest.mark.parametrize(("old", "new"), [SCHEMA, BETWEEN_KEYS], ids=["schema", "between keys"])
def test_a_study_is_refused_before_anything_heavy_is_imported(old: str, new: str, tmp_path: Path) -> None:
    text = template()
    assert old in text
    (tmp_path / "wrong.toml").write_text(text.replace(old, new))
    heavy = "{'numpy', 'numba', 'scipy', 'sklearn', 'matplotlib', 'h5py', 'rich.progress', 'distributed'}"
    code = f"""
import atexit, sys
atexit.register(lambda: print(sorted({heavy} & set(sys.modules))))
from lithobrake.cli import app
from lithobrake.cli.arguments import EXPERT, EXPORT, LOOK, RUN, START
app(["run", sys.argv[1], "--out", sys.argv[2]])
"""
    command = [sys.executable, "-c", code, str(tmp_path / "wrong.toml"), str(tmp_path / "out")]
    shown = subprocess.run(command, capture_output=True, text=True, check=False)
    assert "wrong.toml: " in shown.stderr
    assert (shown.returncode, shown.stdout.strip()) == (2, "[]")


def test_a_missing_study_file_is_one_sentence(tmp_path: Path) -> None:
    said = refused(["run", str(tmp_path / "none.toml"), "--out", str(tmp_path / "out")])
    assert "none.toml: the study file cannot be read" in said
    assert not (tmp_path / "out").exists()


def test_all_errors_of_a_study_are_listed_before_anything_runs(home: Path) -> None:
    RUNNER.invoke(app, ["new", "wrong", "--full"])
    text = (home / "wrong.toml").read_text()
    (home / "wrong.toml").write_text(text.replace("mass = 4.0", "mas = -4.0").replace("count = 48", "count = 1"))
    said = refused(["run", "wrong.toml"])
    assert "wrong.toml: lander.mas is not a known key; did you mean mass?" in said
    assert "wrong.toml: lander.mass is missing" in said
    assert "wrong.toml: journey.count is 1; allowed: at least 2 and at most 1e+06" in said
    assert not (home / "runs").exists()


@pytest.mark.parametrize(("words", "said"), [
    (["run", "--out", "file/out"], "file/out cannot be written (file is a file)"),
    (["plan", "--out", "file"], "file cannot be written (file is a file)"),
    (["run", "--out", ""], "--out is empty (an unset variable?)"),
    (["run", "--out", " "], "--out is empty (an unset variable?)"),
    (["run", "--out", "."], "study.toml lies in ."),
    (["run", "--out", "mine"], "mine holds body.obj, and no study made it"),
    (["run", "--scheduler", ""], "the address of the Dask scheduler is ''; allowed: tcp://"),
    (["run", "--scheduler", "mpi"], "the address of the Dask scheduler is 'mpi'; allowed: tcp://"),
])  # fmt: skip
def test_what_a_study_cannot_be_run_with_is_one_sentence(words: list[str], said: str, study: Path) -> None:
    study.with_name("file").write_text("in the way")
    study.with_name("mine").mkdir()
    study.with_name("mine").joinpath("body.obj").write_text("v 0 0 0")
    before, there = study.read_bytes(), sorted(study.parent.rglob("*"))
    command, *options = words
    assert said in refused([command, "study.toml", *options])
    left = [path for path in study.parent.rglob("*") if path.relative_to(study.parent).parts[0] != "runs"]
    assert (study.read_bytes(), sorted(left)) == (before, there)


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="the administrator may write anywhere")
def test_a_read_only_folder_is_one_sentence(study: Path) -> None:
    study.with_name("locked").mkdir(mode=0o500)
    assert "cannot be written" in refused(["run", "study.toml", "--out", "locked/out"])


@pytest.mark.parametrize("command", ["report", "view"])
def test_a_folder_without_results_says_how_to_make_them(command: str, tmp_path: Path) -> None:
    assert "lithobrake run STUDY.toml" in refused([command, str(tmp_path)])


@pytest.mark.parametrize("command", ["status", "runs"])
def test_a_folder_that_is_no_study_is_one_sentence(command: str, tmp_path: Path) -> None:
    assert str(tmp_path) in refused([command, str(tmp_path)])


def test_more_workers_than_any_machine_has_are_refused() -> None:
    for command in ("plan", "run"):
        shown = RUNNER.invoke(app, [command, "study.toml", "--workers", "999999999999999999999999"])
        assert shown.exit_code == 2
        assert "10000" in shown.stderr


pty = pytest.importorskip("pty")
# Foreground or background, of the first sixteen, of 256, or any.
COLOUR = re.compile(rb"\x1b\[(?:\d+;)*(?:3[0-8]|4[0-8]|9[0-7]|10[0-7])(?:;\d+)*m")
PROGRESS = """
from lithobrake.progress import study_progress
with study_progress() as shown:
    shown.begin("landing", 1, 1)
    shown.progress(1, 2, "touchdowns", "all is well")
"""
HELP = "from lithobrake.cli import app; app(['run', '--help'])"
REFUSED = "from lithobrake.cli import app; app(['run'])"


def on_a_terminal(code: str, **variables: str) -> bytes:
    """What a program writes on a terminal, error output included."""
    ours, theirs = pty.openpty()
    unset = ("NO_COLOR", "FORCE_COLOR", "COLORTERM")
    kept = {name: value for name, value in os.environ.items() if name not in unset}
    with os.fdopen(ours, "rb", buffering=0) as screen:
        process = subprocess.Popen([sys.executable, "-c", code], stdin=theirs, stdout=theirs, stderr=theirs,
            env={**kept, "TERM": "xterm-256color", "COLUMNS": "100", **variables})  # fmt: skip
        os.close(theirs)
        seen = b""
        while True:
            try:
                part = screen.read(4096)
            # Linux says so that nobody writes any more.
            except OSError:
                break
            if not part:
                break
            seen += part
        process.wait()
    return seen


@pytest.mark.parametrize("code", [PROGRESS, HELP, REFUSED], ids=["progress", "help", "refused"])
def test_no_color_takes_all_colours_away(code: str) -> None:
    assert COLOUR.search(on_a_terminal(code))
    without = on_a_terminal(code, NO_COLOR="1")
    assert len(without) > 100
    assert not COLOUR.search(without)


@pytest.mark.parametrize("code", [PROGRESS, HELP, REFUSED], ids=["progress", "help", "refused"])
def test_what_is_no_terminal_gets_no_escape_sequence(code: str) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "FORCE_COLOR"}
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False, env=environment)
    assert shown.stdout + shown.stderr
    assert b"\x1b" not in shown.stdout + shown.stderr


@pytest.mark.parametrize("code", [
    "from lithobrake.cli.arguments import tell; tell(['  a study of ' + 'words ' * 30])",
    "from lithobrake.cli import app; app(['status', 'a study of ' + 'words ' * 30])",
])  # fmt: skip
def test_a_terminal_gets_whole_words(code: str) -> None:
    lines = on_a_terminal(code, COLUMNS="43").decode().splitlines()
    assert max(map(len, lines)) <= 43
    assert {word for line in lines for word in line.split()} >= {"a", "study", "of", "words"}
    assert " ".join(lines).split().count("words") == 30


@pytest.fixture
def folder(tmp_path: Path) -> Path:
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
    script = 'import os; os.rmdir(os.getcwd()); from lithobrake.cli import app; app(["examples", "ball_on_plate"])'
    words = [sys.executable, "-c", script]
    ended = subprocess.run(words, cwd=folder / "gone", capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout) == (2, "")
    assert "current folder" in ended.stderr
    assert ended.stderr.count("\n") == 1


@pytest.mark.parametrize("seconds", ["0", "-1"])
def test_a_film_without_a_length_is_refused_before_the_landing(
    seconds: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Results that have a motion, and nothing else.
    monkeypatch.setattr(
        "lithobrake.results.open_study", lambda folder: SimpleNamespace(refuse_unknown_motion=lambda: None)
    )
    words = ["film", str(tmp_path), "--journey", "1", "--out", str(tmp_path / "x.webp"), "--seconds", seconds]
    found = RUNNER.invoke(app, words)
    assert (found.exit_code, "allowed: a finite time above 0 s" in found.stderr) == (2, True)


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
        ["rebound"], ["wall", "speed"], ["key", "status", "[s]", "outcome", "or", "reason"],
        ["first", "done", "0.1", "clear"],
    ]  # fmt: skip


DETAIL = "61 runs: 22 done, 2 running, 1 failed, 2.1 runs/s, 19 s left\nspeed_out  0.2 +- 0.01"
# Words of somebody's program: rich would take the first for a closing tag, a terminal would obey the others.
ODD = "its last words: [/red] [2024-01-01] \x1b[2J\x1b]0;title\x07\x1b[31mred\r\x9b5m"


def shown_on_a_terminal(
    sentence: str = "screening: 20 of 61 runs were known and are reused", detail: str = DETAIL
) -> str:
    text = io.StringIO()
    lines = ProgressBars(Console(file=text, force_terminal=True, width=100))
    with lines:
        lines.begin("screening", 3, 9)
        lines.say(sentence)
        lines.progress(23, 61, "screening runs", detail)
        lines._progress.refresh()
    return text.getvalue()


def test_a_terminal_shows_the_bars_and_more_below_them() -> None:
    shown = shown_on_a_terminal()
    assert "23/61" in shown
    assert "61 runs: 22 done, 2 running, 1 failed" in shown
    assert "speed_out  0.2 +- 0.01" in shown
    assert "20 of 61 runs were known and are reused" in shown


def test_a_bar_swings_until_the_work_has_a_measure() -> None:
    lines = ProgressBars(Console(file=io.StringIO(), force_terminal=True, width=100))
    with lines:
        lines.begin("fit", 3, 9)
        for what in ("fit", "chances of the outcomes"):
            lines.progress(0, 1, what)
            stage, work = lines._progress.tasks
            assert (stage.completed, stage.total) == (2, 9)
            assert (work.description, work.total, work.fields["count"]) == (f"  {what}", None, "")
        lines.progress(0.25, 1, "chances of the outcomes")
        work = lines._progress.tasks[-1]
        assert (work.completed, work.total, work.fields["count"]) == (0.25, 1, "25 %")
        assert work.fields["tells_time_left"]
        lines.progress(0, 61, "runs")
        assert (lines._progress.tasks[-1].total, lines._progress.tasks[-1].fields["count"]) == (61, "0/61")


def test_words_of_a_program_are_shown_as_they_are_and_command_nothing() -> None:
    shown = shown_on_a_terminal(ODD, ODD)
    assert shown.count("its last words: [/red] [2024-01-01] red") == 2
    for command in ("\x1b[2J", "\x1b]0;", "\x1b[31m", "\x9b"):
        assert command not in shown
    file = io.StringIO()
    with ProgressLog(file) as lines:
        lines.say(ODD)
    assert "its last words: [/red] [2024-01-01] red" in file.getvalue()
    assert not set("\x1b\r\x9b\x07") & set(file.getvalue())


def logged(*works: tuple[float, float, str, str], until: str) -> str:
    """The log of a stage with these pieces of work, written until some words stand in it."""
    file = io.StringIO()
    with ProgressLog(file, first=0.02, every=0.02) as lines:
        lines.begin("screening", 3, 9)
        for work in works:
            lines.progress(*work)
            time.sleep(0.001)
        limit = time.monotonic() + 20.0
        while until not in file.getvalue() and time.monotonic() < limit:
            time.sleep(0.005)
        assert until in file.getvalue()
        lines.begin("refinement", 4, 9)
    return file.getvalue()


def test_a_log_file_has_stages_and_their_work_and_how_both_ended() -> None:
    shown = logged((23, 61, "screening runs", DETAIL), until="19 s left").splitlines()
    # One line, not all that a terminal has room for.
    line = "  screening runs: 61 runs: 22 done, 2 running, 1 failed, 2.1 runs/s, 19 s left"
    assert shown[:2] == ["stage 3 of 9: screening", line]
    assert shown[-3:] == [line, "  screening took 0 s", "stage 4 of 9: refinement"]


def test_a_log_file_tells_done_rate_and_time_left_of_work_that_gives_numbers_alone() -> None:
    shown = logged((100, 400, "flights", ""), (200, 400, "flights", ""), until="left")
    rate = r"[\d.e+]+/(s|min)"
    assert re.search(rf"^  flights: 200/400, \d+ s so far, {rate}, \d+ s left$", shown, re.MULTILINE)
    assert re.search(rf"^  flights: 200/400, {rate}, took \d+ s$", shown, re.MULTILINE)
    shown = logged((0.2, 1, "pouring", ""), (0.4, 1, "pouring", ""), until="left")
    assert re.search(r"^  pouring: 40 %, \d+ s so far, \d+ s left$", shown, re.MULTILINE)
    assert re.search(r"^  pouring: took \d+ s$", shown, re.MULTILINE)
    shown = logged((0.0, 1, "landing", ""), (0.001, 1, "landing", ""), until="so far")
    assert " left" not in shown


def test_a_log_file_shows_life_where_the_work_tells_nothing() -> None:
    shown = logged(until="so far").splitlines()
    assert shown[1] == "  screening: 0 s so far"
    assert "  screening took 0 s" in shown
