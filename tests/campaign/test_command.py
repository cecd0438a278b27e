"""Programs as models: what they are given, what they give back, and every way in which they fail."""

import json
import os
import shlex
import sys
from pathlib import Path

import numpy as np
import pytest

from lithobrake.campaign import Command, Ledger, Limits, LocalExecutor, Runs, absolute_words, run

X = np.array([[1.0], [2.0]])

PROGRAM = """
import json, os, sys, time

def leave(text):
    open("outputs.json", "w").write(text)
    sys.exit(0)

question = json.load(open("inputs.json"))
a = question["inputs"]["a"]
print("rolling on", a)
if a == 2.0:
    DO
json.dump({"height": 2 * a}, open("outputs.json", "w"))
"""


def campaign(folder: Path, do: str, limits: Limits | None = None) -> Runs:
    """Two runs of a program that does something else at its second point."""
    program = folder / "program.py"
    program.write_text(PROGRAM.replace("DO", do))
    model = Command(shlex.join([sys.executable, str(program)]), folder / "solver", required=("height",))
    with Ledger(folder / "runs.sqlite") as ledger, LocalExecutor(2) as executor:
        return run(
            model,
            X,
            names=("a",),
            ledger=ledger,
            executor=executor,
            context={"solver": model.identity()},
            limits=limits,
        )


FAILURES = [
    ("sys.exit(3)", "RuntimeError: the program ended with exit code 3; its last words: rolling on 2.0"),
    ("os.kill(os.getpid(), 9)", "RuntimeError: the program ended with signal 9; its last words: "),
    ("raise OSError('no licence')", "ended with exit code 1; its last words: OSError: no licence"),
    ("sys.exit(0)", "ValueError: the program wrote no outputs.json"),
    ("leave('{\"height\": 1.0')", "outputs.json is not JSON"),
    ("json.dump([1.0], open('outputs.json', 'w')); sys.exit(0)", "is no JSON object of numbers by name"),
    ("json.dump({'height': float('nan')}, open('outputs.json', 'w')); sys.exit(0)", "has nan for height"),
    ("json.dump({'height': None}, open('outputs.json', 'w')); sys.exit(0)", "has None for height"),
    ("leave('[' * 100_000)", "outputs.json is not JSON (maximum recursion depth"),
    ("leave('{\"height\": 1' + '0' * 400 + '}')", "000 for height; allowed: a finite number"),
    ('leave(\'{"outputs": {"height": 1}, "outcome": [1]}\')', "has [1] for outcome; allowed: a word"),
    ('leave(\'{"outputs": {"height": 1}, "draws": [1]}\')', "has [1] for draws; allowed: a JSON object"),
    ('leave(\'{"outcome": "up", "height": 1}\')', "has height beside the outcome; allowed"),
    ('leave(\'{"outputs": {"height": 1}, "draws": {"a": NaN}}\')', "the draws are {'a': nan}; allowed: finite numbers"),
    ("os.remove('log.txt'); sys.exit(3)", "exit code 3; its last words: its log is no longer there"),
    ("json.dump({'depth': 1.0}, open('outputs.json', 'w')); sys.exit(0)", "outputs.json lacks height"),
]


@pytest.mark.parametrize(("do", "reason"), FAILURES, ids=[reason for _, reason in FAILURES])
def test_a_program_that_fails_is_a_failed_run_with_its_reason(do: str, reason: str, tmp_path: Path) -> None:
    runs = campaign(tmp_path, do)
    assert runs.outcomes == ["done", "failed"]
    assert reason in str(runs.records[1].reason)
    assert runs.records[0].outputs == {"height": 2.0}


def test_a_text_that_begins_with_a_mark_of_its_encoding_is_read(tmp_path: Path) -> None:
    runs = campaign(tmp_path, "leave('\\ufeff{\"height\": 7}')")
    assert runs.outputs(["height"])[:, 0].tolist() == [2.0, 7.0]


def test_a_program_over_its_wall_limit_is_ended_with_all_that_it_started(tmp_path: Path) -> None:
    runs = campaign(tmp_path, "open('number', 'w').write(str(os.getpid())); time.sleep(600)", Limits(wall_s=1.5))
    assert runs.records[1].reason == "it ran longer than its limit of 1.5 s"
    (number,) = (tmp_path / "solver").glob("*/number")
    status = Path("/proc") / number.read_text() / "stat"
    assert not status.exists() or status.read_text().rpartition(")")[2].split()[0] == "Z"


def test_each_run_has_a_folder_with_its_question_its_answer_and_its_log(tmp_path: Path) -> None:
    campaign(tmp_path, "pass")
    folders = sorted((tmp_path / "solver").iterdir())
    assert len(folders) == 2
    for folder in folders:
        question = json.loads((folder / "inputs.json").read_text())
        assert json.loads((folder / "outputs.json").read_text())["height"] == 2 * question["inputs"]["a"]
        assert (folder / "log.txt").read_text() == f"rolling on {question['inputs']['a']}\n"


def test_another_program_makes_other_runs_and_the_same_program_elsewhere_does_not(tmp_path: Path) -> None:
    first = campaign(tmp_path, "pass")
    assert campaign(tmp_path, "pass").reused_count == 2
    assert campaign(tmp_path, "sys.exit(3)").reused_count == 0
    (tmp_path / "other").mkdir()
    other = campaign(tmp_path / "other", "pass")
    assert [entry.key for entry in other.records] == [entry.key for entry in first.records]


def test_words_that_name_files_become_absolute_and_no_shell_reads_the_others(tmp_path: Path) -> None:
    (tmp_path / "my model.py").touch()
    words = absolute_words("python3 'my model.py' --speed $HOME *.py", tmp_path)
    assert words == ["python3", str((tmp_path / "my model.py").resolve()), "--speed", "$HOME", "*.py"]


def test_a_link_to_a_program_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "python").symlink_to(sys.executable)
    assert absolute_words("./python -V", tmp_path) == [str(tmp_path / "python"), "-V"]


@pytest.mark.skipif(os.name != "posix", reason="the command is a POSIX one")
def test_a_program_that_is_not_there_is_the_reason(tmp_path: Path) -> None:
    model = Command("no-such-program", tmp_path / "solver")
    with Ledger(tmp_path / "runs.sqlite") as ledger, LocalExecutor(1) as executor:
        runs = run(model, X, names=("a",), ledger=ledger, executor=executor)
    assert "FileNotFoundError" in str(runs.records[0].reason)
