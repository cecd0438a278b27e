"""Programs as models: what they are given, the formats they write, their logs, and every way in which they fail."""

import json
import os
import re
import shlex
import sys
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from lithobrake.campaign import Command, Ledger, Limits, LocalExecutor, Runs, absolute_words, run
from lithobrake.campaign.program import fill_template
from lithobrake.campaign.program_answer import read_answer
from lithobrake.campaign.single_run import KEPT, CappedLog, last_words, run_model

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
        return run(model, X, names=("a",), ledger=ledger, executor=executor, context={"solver": model.identity()},
            limits=limits)  # fmt: skip


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
    assert campaign(tmp_path, "leave('\\ufeff{\"height\": 7}')").outputs(["height"])[:, 0].tolist() == [2.0, 7.0]


@pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="what has left its session is found on Linux only")
@pytest.mark.parametrize("leaving", ["pass", "os.setsid(); os.fork() and time.sleep(600); os.setsid()"])
def test_a_program_over_its_wall_limit_is_ended_with_all_that_it_started(leaving: str, tmp_path: Path) -> None:
    do = f"{leaving}; open('number', 'w').write(str(os.getpid())); time.sleep(600)"
    runs = campaign(tmp_path, do, Limits(wall_s=1.0))
    assert runs.records[1].reason == "it ran longer than its limit of 1 s"
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


@pytest.mark.parametrize("piece", [1000, 65_536, 5_000_000])
def test_the_first_and_the_last_megabyte_are_kept_and_the_rest_is_counted(piece: int, tmp_path: Path) -> None:
    total = b"".join(b"line %8d\n" % number for number in range(700_000))
    with CappedLog(tmp_path / "log.txt") as log:
        for start in range(0, len(total), piece):
            log.write(total[start : start + piece])
    kept = (tmp_path / "log.txt").read_bytes()
    assert len(kept) <= 3 * KEPT
    notice = re.search(rb"\n\.\.\. (\d+) bytes are left out here \.\.\.\n", kept)
    first, last = kept[: notice.start()], kept[notice.end() :]
    assert len(first) == KEPT
    assert len(last) >= KEPT
    assert total.startswith(first)
    assert total.endswith(last)
    assert len(first) + int(notice[1]) + len(last) == len(total)


def test_a_short_log_is_kept_whole(tmp_path: Path) -> None:
    with CappedLog(tmp_path / "log.txt") as log:
        log.write(b"no licence\n\n")
        # A process that is ended here leaves all that it has written.
        assert (tmp_path / "log.txt").read_bytes() == b"no licence\n\n"
    assert last_words(tmp_path / "log.txt") == "no licence"


PRINTS_MUCH = "import sys; [print('overlap', 'x' * 10000) for _ in range(2000)]; print('it diverged'); sys.exit(3)"
LEAVES_SOMETHING = """
import json, subprocess, sys
subprocess.Popen([sys.executable, "-c", "import time; time.sleep(20)"])
print("all is well")
json.dump({"height": 1.0}, open("outputs.json", "w"))
"""


def test_a_program_that_prints_without_end_fills_no_disk_and_its_last_words_are_the_reason(tmp_path: Path) -> None:
    result = run_model(Command(shlex.join([sys.executable, "-c", PRINTS_MUCH]), tmp_path / "solver"), {"a": 1.0}, 1)
    assert "exit code 3" in result["reason"]
    assert result["reason"].endswith("it diverged")
    (log,) = (tmp_path / "solver").glob("*/log.txt")
    assert log.stat().st_size <= 3 * KEPT


def test_nobody_waits_for_what_a_program_leaves_running(tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(LEAVES_SOMETHING)
    model = Command(shlex.join([sys.executable, str(tmp_path / "program.py")]), tmp_path / "solver")
    result = run_model(model, {"a": 1.0}, 1)
    assert result["outputs"] == {"height": 1.0}
    assert result["wall_s"] < 20
    (log,) = (tmp_path / "solver").glob("*/log.txt")
    assert log.read_text() == "all is well\n"


def prints_much(inputs: dict[str, float], seed: int) -> dict[str, float]:
    """A model that does not stop talking."""
    for _ in range(500):
        print("overlap", "x" * 10_000)
    return {"height": 1.0}


def test_the_log_of_a_model_is_capped_too(tmp_path: Path) -> None:
    assert run_model(prints_much, {"a": 1.0}, 1, tmp_path / "logs" / "run.log")["outputs"] == {"height": 1.0}
    text = (tmp_path / "logs" / "run.log").read_text()
    assert len(text) <= 3 * KEPT
    assert text.startswith('{"inputs": {"a": 1.0}, "seed": 1}\noverlap xxx')
    assert '"status": "done"' in text.splitlines()[-1]


ANSWER = {"outcome": "clear", "outputs": {"velocity_out_x": 0.05, "spin_out": 1.25e-3}}


def write(path: Path, answer: dict[str, Any]) -> None:
    """Write an answer in the format of the ending, with the library of the format."""
    if path.suffix == ".json":
        path.write_text(json.dumps(answer))
    elif path.suffix == ".csv":
        pandas = pytest.importorskip("pandas")
        rows = [{"outcome": "captured", **dict.fromkeys(answer["outputs"], 9.0)}]
        rows.append({"outcome": answer["outcome"], **answer["outputs"]})
        pandas.DataFrame(rows).to_csv(path, index=False)
    elif path.suffix in (".yaml", ".yml"):
        path.write_text(pytest.importorskip("yaml").safe_dump(answer))
    else:
        with h5py.File(path, "w") as file:
            file.attrs["outcome"] = answer["outcome"]
            for name, value in answer["outputs"].items():
                file[f"outputs/{name}"] = value
            file["outputs/history"] = np.zeros(7)


@pytest.mark.parametrize("name", ["a.json", "a.csv", "a.yaml", "a.yml", "a.h5", "a.hdf5"])
def test_every_format_gives_the_same_answer(tmp_path: Path, name: str) -> None:
    write(tmp_path / name, ANSWER)
    assert read_answer(tmp_path / name) == ANSWER


def test_plain_numbers_need_no_outcome(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("# not a comment,b\n1.5, 2\n")
    assert read_answer(tmp_path / "a.csv") == {"outputs": {"# not a comment": 1.5, "b": 2.0}}
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["b"] = np.array([2.0])
    assert read_answer(tmp_path / "a.h5") == {"outputs": {"b": 2.0}}
    (tmp_path / "a.csv").write_text("b,penetration\n2,\n")
    assert read_answer(tmp_path / "a.csv") == {"outputs": {"b": 2.0}}


@pytest.mark.parametrize(("name", "text", "words"), [
    ("a.csv", "b\nfast\n", "a.csv is no CSV of numbers"),
    ("a.csv", "b,c\n1\n", "a.csv is no CSV of numbers"),
    ("a.csv", "b\n", "a.csv is no CSV of numbers"),
    ("a.csv", "b\nnan\n", "a.csv has nan for b"),
    ("a.csv", "b, b\n1, 2\n", "a.csv .*it has 'b' twice"),
    ("a.json", '{"outcome": "clear", "outcome": "captured", "outputs": {"b": 1}}', "a.json .*it has 'outcome' twice"),
    ("a.yaml", "outputs: {b: 1, b: 2}\n", "a.yaml .*it has 'b' twice"),
    ("a.yaml", "b: [1\n", "a.yaml is not YAML"),
    ("a.yaml", "b: .inf\n", "a.yaml has inf for b"),
    ("a.yaml", "- 1\n", "a.yaml is no JSON object"),
    ("a.h5", "text", "a.h5 is not HDF5"),
])  # fmt: skip
def test_what_is_no_answer_says_so(tmp_path: Path, name: str, text: str, words: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(ValueError, match=words):
        read_answer(tmp_path / name)


def test_places_of_a_template_become_numbers_of_the_run(tmp_path: Path) -> None:
    template, folder = tmp_path / "in.landing", tmp_path / "run"
    folder.mkdir()
    template.write_text("fric {{grain.friction}} ${kept} {{ seed }} {{ setting.bed.kind }}\n")
    question = {"inputs": {"grain.friction": 0.1}, "seed": 7, "setting": {"bed": {"kind": "box", "width": [1, 2]}}}
    fill_template(template, folder, question)
    assert (folder / "in.landing").read_text() == "fric 0.1 ${kept} 7 box\n"
    template.write_text("{{ grain.fricton }}")
    with pytest.raises(ValueError, match=r"did you mean grain\.friction\?"):
        fill_template(template, folder, question)


def test_a_program_that_knows_no_json_makes_a_run(tmp_path: Path) -> None:
    """It reads numbers from its own input file and writes a table."""
    template, program = tmp_path / "in.txt", tmp_path / "program.py"
    template.write_text("speed {{ impact.speed }}\n")
    program.write_text("s = float(open('in.txt').read().split()[1])\nopen('out.csv', 'w').write(f'h\\n{2 * s!r}\\n')\n")
    words = shlex.join([sys.executable, str(program)])
    command = Command(words, tmp_path / "runs", required=("h",), templates=(template,), answer="out.csv")
    assert command({"impact.speed": 0.1}, 1) == {"outputs": {"h": 0.2}}
    before = command.identity()
    template.write_text("# changed\nspeed {{ impact.speed }}\n")
    assert command.identity() != before
    assert Command(words, tmp_path).identity() == command.identity()[:2]


def test_files_of_a_study_count_from_it_and_are_checked(tmp_path: Path) -> None:
    from lithobrake.study import StudyError, StudySource

    ball = Path(__file__).parents[2] / "examples" / "ball_on_plate.toml"
    path = tmp_path / "study.toml"

    def study(keys: str) -> Any:
        path.write_text(ball.read_text().replace('command = "python3 ball', f'{keys}\ncommand = "python3 ball'))
        return StudySource.read(path).study

    (tmp_path / "in.txt").write_text("")
    read = study('templates = ["in.txt"]\nanswer = "out.csv"')
    assert (read.solver.templates, read.solver.answer) == ([str(tmp_path / "in.txt")], "out.csv")
    for keys, words in (
        ('templates = ["in.lost"]', "no such file"),
        ('answer = "out.xls"', r"ending in \.json, \.csv"),
        ('answer = "../out.csv"', "without folders"),
        ('templates = ["in.txt"]\nanswer = "in.txt"', "would stand twice"),
    ):
        with pytest.raises(StudyError, match=words):
            study(keys)
