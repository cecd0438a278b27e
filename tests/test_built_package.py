"""The wheel and the archive of sources that a release consists of, built, installed by themselves, and used."""

import os
import subprocess
import sys
import tarfile
import zipfile
from email.parser import Parser
from importlib.util import find_spec
from pathlib import Path

import pytest

import lithobrake

ROOT = Path(__file__).parents[1]
ARCHIVE = f"lithobrake-{lithobrake.__version__}"
# What tests and documents read, beside the sources.
NEEDED = ("README.md", "CHANGELOG.md", "LICENSE", "mkdocs.yml", "pyproject.toml", "tests/conftest.py", ".ci/run")
FOLDERS = ("benchmarks", "docs", "examples", "lithobrake", "scenarios", "tests", "validation")
SAY = """
import lithobrake
from lithobrake.study import read_study
from lithobrake.study.reader import shipped
from pathlib import Path

assert lithobrake.__version__ == "VERSION"
assert "site-packages-of-its-own" in lithobrake.__file__, lithobrake.__file__
for name, one in shipped().items():
    assert "site-packages-of-its-own" in str(one.path)
    if one.is_study:
        read_study(Path(name))
print(len(shipped()))
"""

# Where the builder is found, which may be elsewhere than among the packages of this Python.
BUILDER = [path for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if path and Path(path) != ROOT]

pytestmark = pytest.mark.skipif(find_spec("hatchling") is None, reason="hatchling, which builds, is not installed")


def done(words: list[str | Path], folder: Path, *paths: str) -> str:
    """What a command prints in a folder; paths: where Python looks first for what it imports."""
    setting = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    ended = subprocess.run(words, cwd=folder, env=setting, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


@pytest.fixture(scope="module")
def release(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of wheel and archive, the wheel built from the unpacked archive, as an installer does."""
    folder = tmp_path_factory.mktemp("release")
    build = [sys.executable, "-m", "hatchling", "build", "-d", folder, "-t"]
    done([*build, "sdist"], ROOT, *BUILDER)
    with tarfile.open(folder / f"{ARCHIVE}.tar.gz") as archive:
        archive.extractall(folder, filter="data")
    done([*build, "wheel"], folder / ARCHIVE, *BUILDER)
    return folder


def test_the_archive_has_what_tests_and_documents_need(release: Path) -> None:
    tracked = {path.relative_to(release / ARCHIVE).as_posix() for path in (release / ARCHIVE).rglob("*")}
    assert set(NEEDED) <= tracked
    for folder in FOLDERS:
        lost = {
            path.relative_to(ROOT).as_posix()
            for path in (ROOT / folder).rglob("*")
            if path.is_file() and path.suffix in (".py", ".toml", ".csv", ".json", ".md", ".js", ".css")
        } - tracked
        assert not {name for name in lost if "__pycache__" not in name and "/runs/" not in name}
    assert "showcase/mission/summary.json" in tracked


def test_the_wheel_says_what_it_is(release: Path) -> None:
    (wheel,) = release.glob("*.whl")
    with zipfile.ZipFile(wheel) as file:
        names = file.namelist()
        (path,) = (name for name in names if name.endswith("METADATA"))
        said = Parser().parsestr(file.read(path).decode())
    assert (said["Name"], said["Version"]) == ("lithobrake", lithobrake.__version__)
    assert said["License-Expression"] == "BSD-3-Clause"
    assert said["Requires-Python"] == ">=3.11"
    classifiers = said.get_all("Classifier")
    assert {f"Programming Language :: Python :: 3.{minor}" for minor in (11, 12, 13)} <= set(classifiers)
    assert "Intended Audience :: Science/Research" in classifiers
    assert {name.split("/")[0] for name in names} == {"lithobrake", f"{ARCHIVE}.dist-info"}
    sources = {path.relative_to(ROOT).as_posix() for path in (ROOT / "lithobrake").rglob("*") if path.is_file()}
    assert {name for name in sources if "__pycache__" not in name} <= set(names)


def test_an_installed_wheel_runs_its_studies_by_name_and_gives_its_examples(release: Path, tmp_path: Path) -> None:
    place = tmp_path / "site-packages-of-its-own"
    (wheel,) = release.glob("*.whl")
    install = ["-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--no-compile", "--target", place, wheel]
    done([sys.executable, *install], tmp_path)
    assert int(done([sys.executable, "-c", SAY.replace("VERSION", lithobrake.__version__)], tmp_path, str(place))) > 10
    listed = done([sys.executable, "-m", "lithobrake", "examples"], tmp_path, str(place))
    assert "\n  quick " in listed
    done([sys.executable, "-m", "lithobrake", "examples", "ball_on_plate"], tmp_path, str(place))
    assert (tmp_path / "ball_on_plate.toml").read_bytes() == (ROOT / "examples/ball_on_plate.toml").read_bytes()
    assert (place / "bin" / "lithobrake").is_file()
