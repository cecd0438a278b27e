"""A study that a Python script starts without a guard; tests/campaign/test_main_module.py has campaigns."""

import subprocess
import sys
from pathlib import Path

import pytest

from .ball_studies import FEW_RUNS, write_ball

SCRIPT = """
print("started")
from pathlib import Path
import lithobrake

results = lithobrake.run("ball.toml", out="out", workers=2, report=False)
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


def said_by_python(folder: Path, script: str, piped: bool) -> subprocess.CompletedProcess[str]:
    (folder / "script.py").write_text(script)
    words = [sys.executable, "-" if piped else "script.py"]
    given = script if piped else None
    return subprocess.run(words, cwd=folder, input=given, capture_output=True, text=True, check=False)


def test_a_study_starts_from_a_piped_script_without_a_guard(tmp_path: Path) -> None:
    few = FEW_RUNS | {"sample_count = 10_000": "sample_count = 100", "flight_count = 50": "flight_count = 1"}
    write_ball(tmp_path / "ball.toml", few | {"count = 200 ": "count = 0 "})
    said = said_by_python(tmp_path, SCRIPT, piped=True)
    assert (said.returncode, said.stdout) == (0, "started\n13 ['clear']\n"), said.stderr


@pytest.mark.parametrize(
    ("piped", "words"),
    [
        (False, 'what starts it belongs under: if __name__ == "__main__":'),
        (True, "write it to a file, say model.py, and import it from there"),
    ],
)
def test_a_model_that_workers_cannot_import_is_one_sentence(piped: bool, words: str, tmp_path: Path) -> None:
    write_ball(tmp_path / "ball.toml", FEW_RUNS)
    said = said_by_python(tmp_path, OWN_MODEL, piped)
    assert said.returncode == 1
    last = said.stderr.strip().splitlines()[-1]
    assert last.startswith("lithobrake.campaign.worker.MainModuleError: ")
    assert words in last
