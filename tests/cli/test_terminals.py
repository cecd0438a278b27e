"""What is shown on terminals, in log files and while a study runs; names of files in commands."""

import io
import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest
from rich.console import Console
from typer.testing import CliRunner

from lithobrake.campaign import Ledger
from lithobrake.cli import app
from lithobrake.progress import ProgressBars, ProgressLog

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
        process = subprocess.Popen(
            [sys.executable, "-c", code], stdin=theirs, stdout=theirs, stderr=theirs,
            env={**kept, "TERM": "xterm-256color", "COLUMNS": "100", **variables},
        )  # fmt: skip
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
    "from lithobrake.cli.terminal import tell; tell(['  a study of ' + 'words ' * 30])",
    "from lithobrake.cli import app; app(['status', 'a study of ' + 'words ' * 30])",
])  # fmt: skip
def test_a_terminal_gets_whole_words(code: str) -> None:
    lines = on_a_terminal(code, COLUMNS="43").decode().splitlines()
    assert max(map(len, lines)) <= 43
    assert {word for line in lines for word in line.split()} >= {"a", "study", "of", "words"}
    assert " ".join(lines).split().count("words") == 30


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
