"""Templates that programs read, and the formats of what they write, as the libraries of these formats write them."""

import json
import shlex
import sys
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from lithobrake.campaign import Command
from lithobrake.campaign.command import fill_template, read_answer

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


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.csv", "b\nfast\n", "a.csv is no CSV of numbers"),
        ("a.csv", "b,c\n1\n", "a.csv is no CSV of numbers"),
        ("a.csv", "b\n", "a.csv is no CSV of numbers"),
        ("a.csv", "b\nnan\n", "a.csv has nan for b"),
        ("a.yaml", "b: [1\n", "a.yaml is not YAML"),
        ("a.yaml", "b: .inf\n", "a.yaml has inf for b"),
        ("a.yaml", "- 1\n", "a.yaml is no JSON object"),
        ("a.h5", "text", "a.h5 is not HDF5"),
    ],
)
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
