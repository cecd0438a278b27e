"""The notebooks and the slide of examples/ as scripts, as a reader runs them, and what they give."""

import io
import os
import re
import runpy
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import chdir, contextmanager, redirect_stdout
from pathlib import Path
from types import MappingProxyType
from typing import Any
from unittest.mock import patch

import matplotlib.pyplot as plt
import pytest

from lithobrake.results import open_study
from lithobrake.study import read_study

from ..command_line import lithobrake
from ..pipeline.few_terms import few_terms
from ..quick_studies import blank_pictures, one_process

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "examples").glob("notebook_*.py"))


def printed(name: str, folder: Path, smaller: Mapping[str, str] = MappingProxyType({})) -> str:
    """What a notebook prints, run as a script in a folder.

    smaller: texts of the notebook, and those by which its study takes less time.
    """
    path = ROOT / f"examples/notebook_{name}.py"
    script = path.read_text(encoding="utf-8")
    for text, other in smaller.items():
        assert script.count(text) == 1, text
        script = script.replace(text, other)
    # A script may import what lies beside it.
    with (
        chdir(folder), patch.dict(os.environ, {"PYTHONPATH": str(ROOT)}), patch.object(sys, "path", list(sys.path)),
        redirect_stdout(io.StringIO()) as said,
    ):  # fmt: skip
        exec(compile(script, path, "exec"), {"__name__": "__main__", "__file__": str(path)})
    return said.getvalue()


@contextmanager
def commands_here() -> Iterator[None]:
    """Have this process do what a script asks `python -m lithobrake` for, with one worker, which is it too; pictures of
    reports are blank.
    """
    elsewhere = subprocess.run

    def run(words: list[str], **options: Any) -> subprocess.CompletedProcess[str]:
        if words[:3] != [sys.executable, "-m", "lithobrake"]:
            return elsewhere(words, **options)
        ended = lithobrake(*words[3:])
        assert ended.returncode == 0, ended.stderr
        return ended

    with one_process(), blank_pictures(), patch.object(subprocess, "run", run):
        yield


def number(pattern: str, text: str) -> float:
    found = re.search(pattern, text)
    assert found, f"{pattern} is not in: {text}"
    return float(found[1])


@pytest.mark.parametrize("path", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_a_notebook_is_made_of_cells_that_begin_with_a_title(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.startswith("# %% [markdown]\n# # ")
    assert text.count("\n# %%\n") >= 3


def test_a_first_study_is_run_and_then_read(tmp_path: Path) -> None:
    fewer = {"flight_count = 50": "flight_count = 6", "sample_count = 1000": "sample_count = 200"}
    with commands_here(), few_terms():
        said = printed("first_study", tmp_path, smaller=fewer | {'gravity = "exact"': 'gravity = "table"'})
    assert "24 of 24 landings left the surface." in said
    assert "24 touchdowns" in said
    assert (tmp_path / "runs/first_study/report/index.html").is_file()
    read = printed("reading_a_study", tmp_path)
    assert read.startswith("Table of 24 rows (run): ")
    assert 40.0 < number(r"(\d+) % of the speed of arrival", read) < 90.0
    # More friction takes more of the speed along the plate.
    slippery, rough = (number(rf"friction {one}: speed out ([\d.]+) to", read) for one in ("0.10", "0.35"))
    assert slippery > rough


def test_a_landing_by_hand_comes_out_with_its_picture(tmp_path: Path) -> None:
    said = printed("one_landing", tmp_path, smaller={"speeds = [0.1, 0.2, 0.3, 0.4]": "speeds = [0.3]"})
    assert 0.4 < number(r"([\d.]+) of the bed is solid", said) < 0.75
    assert 0.0 < number(r"at 0.3 m/s it keeps (\d+) %", said) < 60.0
    assert (tmp_path / "landing.png").read_bytes().startswith(b"\x89PNG")


def test_a_solver_of_ones_own_is_run_once_and_replaced(tmp_path: Path) -> None:
    first, second = (printed("own_solver", tmp_path) for _ in range(2))
    assert "69 runs, 0 of them known before" in first
    assert "69 runs, 69 of them known before" in second
    # Restitution times the cosine of the incidence, which a polynomial of the third degree follows closely.
    assert number(r"velocity_out_z: wrong by ([\d.]+) %", first) < 0.5


def test_a_study_without_a_file_is_run_shown_and_kept(tmp_path: Path) -> None:
    with commands_here():
        said = printed(
            "study_in_python", tmp_path, smaller={'"count": 8': '"count": 2', '"grain_count": 30': '"grain_count": 20'}
        )
    assert "study.toml: lander.mas is not a known key; did you mean mass?" in said
    assert re.search(r"^\d+ % \(90 % interval .*\(2 journeys, \d+ simulated landings, 2 beds\)", said, re.MULTILINE)
    assert "['contacts', 'distances', 'ends', 'map', " in said
    assert "plot.grounds shows unknown ground ([ground]), which" in said
    assert (tmp_path / "box.png").read_bytes().startswith(b"\x89PNG")
    kept = open_study(tmp_path / "runs/box")
    assert kept.journeys.row_count == 2
    assert read_study(tmp_path / "runs/box/study.toml").journey.count == 2


def test_a_shape_of_ones_own_holds_and_loses_landers(tmp_path: Path) -> None:
    said = printed("own_shape", tmp_path)
    assert said.startswith("224 facets, ")
    assert 1500.0 < number(r"m3, (\d+) kg/m3", said) < 2500.0
    assert 0.0 < number(r"'impact': ([\d.]+)", said) < 1.0


def test_a_slide_is_drawn_beside_the_folder_of_a_study(tmp_path: Path) -> None:
    folder = tmp_path / "mission"
    shutil.copytree(ROOT / "showcase" / "mission", folder)
    path = runpy.run_path(str(ROOT / "examples" / "slide.py"))["main"](folder)
    assert path == tmp_path / "mission_slide.png"
    picture = plt.imread(path)
    assert picture.shape[:2] == (1080, 1920)
    # Words stand on the left, the map on the right: neither half is empty.
    assert all((half[..., :3] < 0.5).any() for half in (picture[:, :800], picture[:, 800:]))
