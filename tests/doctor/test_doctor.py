"""The doctor finds what is there, says how to get what is not, and works where hardly anything is installed."""

import json
import math
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.doctor import diagnosis
from lithobrake.doctor.diagnosis import EXTRAS, NeededLibrary, parsed

RUNNER = CliRunner()
PROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]
# Extras that serve those who change the package.
FOR_DEVELOPERS = {"test", "bench", "oracle", "docs", "dev"}
REQUIREMENTS = ["numpy>=1.26", 'pandas>=2.0; extra == "data"', 'lithobrake[data]; extra == "test"', "rich"]


def test_every_extra_of_the_package_is_told_with_what_it_is_for() -> None:
    assert set(EXTRAS) == set(PROJECT["optional-dependencies"]) - FOR_DEVELOPERS


def test_requirements_are_read_as_the_metadata_write_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(diagnosis, "version", lambda name: {"numpy": "1.25.9", "pandas": "2.10rc1", "rich": "13"}[name])
    assert list(parsed(REQUIREMENTS)) == [
        NeededLibrary("numpy", "1.26", "1.25.9", ""),
        NeededLibrary("pandas", "2.0", "2.10rc1", "data"),
        NeededLibrary("rich", "0", "13", ""),
    ]
    assert [one.serves for one in parsed(REQUIREMENTS)] == [False, True, True]


@pytest.mark.parametrize(("text", "lowest"), [("mkdocs>=1.6,<2", "1.6"), ("a (>=2)", "2"), ("b<3,>=1.5", "1.5")])
def test_the_lowest_version_is_found_wherever_it_stands(text: str, lowest: str) -> None:
    assert next(iter(parsed([text]))).lowest == lowest


def test_versions_are_compared_by_their_numbers() -> None:
    assert NeededLibrary("scipy", "1.9", "1.15.2", "").serves
    assert not NeededLibrary("scipy", "1.15", "1.9", "").serves
    assert "1.9 is too old; needed: 1.15 or newer" in NeededLibrary("scipy", "1.15", "1.9", "").state


def test_a_look_without_speeds_names_libraries_machine_and_cache() -> None:
    shown = RUNNER.invoke(app, ["doctor", "--quick"])
    assert shown.exit_code == 0, shown.output
    assert "numpy" in shown.output
    assert "GB free" in shown.output
    assert "soft-surface engine: " in shown.output
    assert "Speed" not in shown.output


def test_landings_and_flights_are_timed_beside_the_reference_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    from lithobrake.doctor import speed
    from lithobrake.pipeline.planning import expected_time

    for name, count in (("FLIGHTS", 20), ("LANDINGS", 3), ("STEPS", 40)):
        monkeypatch.setattr(speed, name, count)
    monkeypatch.setattr(expected_time, "STEPS", speed.STEPS)
    found = json.loads(RUNNER.invoke(app, ["doctor", "--json"]).stdout)
    assert [one["what"].split()[0] for one in found["speeds"]] == ["steps", "landings", "flights"]
    assert all(math.isfinite(one["here"]) and one["here"] > 0.0 < one["reference"] for one in found["speeds"])
    assert set(found["machine"]["cache"]["is_compiled"]) == {"soft-surface engine", "flights"}


def test_the_reference_figures_are_those_that_were_measured() -> None:
    from lithobrake.doctor.speed import REFERENCE_FLIGHTS, REFERENCE_LANDINGS

    measured = json.loads((Path(__file__).parents[2] / "benchmarks/doctor_speed.json").read_text())["per_cpu_s"]
    for constant, (what, value) in zip((REFERENCE_LANDINGS, REFERENCE_FLIGHTS), measured.items(), strict=True):
        assert constant == float(f"{value:.2g}"), what


def test_where_nothing_is_installed_it_says_how_to_get_it() -> None:
    code = """
import sys
from importlib import metadata
gone = ("numpy", "scipy", "numba", "sklearn", "threadpoolctl", "h5py", "matplotlib", "tomli_w")
# None in the place of a module makes its import fail.
sys.modules.update(dict.fromkeys(gone))
def version(name):
    raise metadata.PackageNotFoundError(name)
metadata.version = version
metadata.requires = lambda name: ["numpy>=1.26", 'pyvista>=0.43; extra == "view"']
from lithobrake.cli import app
app(["doctor"])
"""
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert shown.returncode == 1, shown.stderr
    assert "numpy                missing" in shown.stdout
    assert 'To get what is missing: pip install --upgrade "lithobrake" && ' in shown.stdout
    assert 'pip install --upgrade "lithobrake[view]" (windows and films' in shown.stdout
