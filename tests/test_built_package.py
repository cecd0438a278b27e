"""The release, its documents and its metadata: they agree, and what an installer gets works."""

import ast
import os
import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from email.parser import Parser
from importlib.util import find_spec
from pathlib import Path

import pytest

import lithobrake

from .syntax_trees import syntax_tree

ROOT = Path(__file__).parents[1]
ARCHIVE = f"lithobrake-{lithobrake.__version__}"
# What tests and documents read, beside the sources.
NEEDED = ("README.md", "CHANGELOG.md", "LICENSE", "mkdocs.yml", "pyproject.toml", "tests/conftest.py", ".ci/run",
    "Containerfile", ".dockerignore", "recipe/recipe.yaml")  # fmt: skip
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


def done(words: list[str | Path], folder: Path, *paths: str) -> str:
    """What a command prints in a folder; paths: where Python looks first for what it imports."""
    setting = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    ended = subprocess.run(words, cwd=folder, env=setting, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


@pytest.fixture(scope="module")
def release(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of wheel and archive, the wheel built from the unpacked archive, as an installer does."""
    if find_spec("hatchling") is None:
        pytest.skip("hatchling, which builds, is not installed")
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
    assert (said["License-Expression"], said["Requires-Python"]) == ("BSD-3-Clause", ">=3.11")
    classifiers = said.get_all("Classifier")
    assert {f"Programming Language :: Python :: 3.{minor}" for minor in (11, 12, 13, 14)} <= set(classifiers)
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
    assert "\n  quick " in done([sys.executable, "-m", "lithobrake", "examples"], tmp_path, str(place))
    done([sys.executable, "-m", "lithobrake", "examples", "ball_on_plate"], tmp_path, str(place))
    assert (tmp_path / "ball_on_plate.toml").read_bytes() == (ROOT / "examples/ball_on_plate.toml").read_bytes()
    assert (place / "bin" / "lithobrake").is_file()


PARTS = ("dem", "touchdown", "chaos", "emulator", "campaign", "smallbody", "analysis", "report")


def readme_commands() -> list[str]:
    return re.findall(r"```sh\n(.*?)```", (ROOT / "README.md").read_text(), flags=re.DOTALL)


def test_readme_gives_two_commands_of_one_line_each() -> None:
    commands = readme_commands()
    assert len(commands) == 2
    assert all(command.strip().count("\n") == 0 for command in commands)
    assert "lithobrake run scenarios/quick.toml" in commands[0]
    assert "pytest" in commands[1]


def test_each_command_makes_its_own_environment() -> None:
    assert all(command.startswith("python3 -m venv .venv && .venv/bin/pip install") for command in readme_commands())


def test_ci_runs_the_command_of_the_readme() -> None:
    script = (ROOT / ".ci" / "run").read_text()
    extraction = re.search(r"awk '.*' README\.md", script)
    found = subprocess.run(["bash", "-c", extraction.group()], cwd=ROOT, capture_output=True, text=True, check=True)
    assert found.stdout == readme_commands()[1]
    assert "ruff check" in script
    assert "ruff format --check" in script
    assert "mypy" in script


def test_ci_is_executable() -> None:
    assert (ROOT / ".ci" / "run").stat().st_mode & 0o111


def test_version_is_the_same_everywhere() -> None:
    assert tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"] == lithobrake.__version__
    assert f"version: {lithobrake.__version__}\n" in (ROOT / "CITATION.cff").read_text()
    assert f"## {lithobrake.__version__} " in (ROOT / "CHANGELOG.md").read_text()


def test_every_part_named_on_its_page_is_a_package() -> None:
    page = (ROOT / "docs" / "commands_and_files.md").read_text()
    named = re.findall(r"^\| `lithobrake\.(\w+)` \|", page, flags=re.MULTILINE)
    assert named
    assert all((ROOT / "lithobrake" / part / "__init__.py").is_file() for part in named)


def test_imports_of_third_parties_are_declared() -> None:
    """Each package that `lithobrake` imports is among the core dependencies, or an extra."""
    project = _project()
    # Dask is imported only by who asks for a cluster, others by who asks for their tables or files.
    extras = project["optional-dependencies"]
    entries = [*project["dependencies"], *extras["dask"], *extras["data"], *extras["yaml"], *extras["view"]]
    declared = {re.split(r"[>=<\[]", entry)[0] for entry in entries}
    # Some come with the package that they belong to, which asks for the one it needs.
    names_on_index = {"PIL": "matplotlib", "contourpy": "matplotlib", "imageio_ffmpeg": "imageio-ffmpeg",
        "sklearn": "scikit-learn", "mpl_toolkits": "matplotlib", "pydantic_core": "pydantic", "llvmlite": "numba",
        "tomli_w": "tomli-w", "lazy_loader": "lazy-loader", "yaml": "pyyaml"}  # fmt: skip
    used: set[str] = set()
    for source in (ROOT / "lithobrake").rglob("*.py"):
        for node in ast.walk(syntax_tree(source)):
            if isinstance(node, ast.Import):
                used |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
                used.add(node.module.split(".")[0])
    foreign = {names_on_index.get(name, name) for name in used if name not in sys.stdlib_module_names} - {"lithobrake"}
    assert foreign <= declared


def test_the_conda_recipe_asks_for_what_the_project_asks_for() -> None:
    yaml = pytest.importorskip("yaml")
    recipe, project = yaml.safe_load((ROOT / "recipe" / "recipe.yaml").read_text()), _project()
    assert recipe["context"]["version"] == lithobrake.__version__
    assert recipe["about"]["summary"] == project["description"]
    assert recipe["build"]["python"]["entry_points"] == [f"lithobrake = {project['scripts']['lithobrake']}"]
    # conda-forge's matplotlib brings Qt besides, which nothing here draws with.
    names = {"matplotlib": "matplotlib-base"}
    asked = [("python", project["requires-python"]), *(_parted(entry) for entry in project["dependencies"])]
    assert recipe["requirements"]["run"] == [f"{names.get(name, name)} {bounds}" for name, bounds in asked]
    builder = tomllib.loads((ROOT / "pyproject.toml").read_text())["build-system"]["requires"]
    assert {" ".join(_parted(entry)) for entry in builder} <= set(recipe["requirements"]["host"])


def test_the_container_runs_as_a_user_of_its_own_and_takes_the_source_of_the_clone() -> None:
    lines = (ROOT / "Containerfile").read_text().splitlines()
    last = {line.split()[0]: line for line in lines if line and line.split()[0].isupper()}
    assert last["USER"] == "USER lander"
    assert last["ENTRYPOINT"] == 'ENTRYPOINT ["lithobrake"]'
    assert "COPY . /source" in lines
    left_out = (ROOT / ".dockerignore").read_text().split()
    # What the wheel is built from.
    assert not {"README.md", "LICENSE", "pyproject.toml", "lithobrake", "scenarios", "examples"} & set(left_out)
    assert all(name in "".join(lines) for name in ("useradd --uid 1000 --create-home lander", "chown lander /work"))


def _parted(entry: str) -> tuple[str, str]:
    """Name and bounds of a requirement such as numpy>=1.26."""
    name, bounds = re.match(r"([\w.-]+)(.*)", entry).groups()
    return name, bounds


def _project() -> dict[str, list[str]]:
    return tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
