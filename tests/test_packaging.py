"""The documents and the package metadata agree with each other and with what a new user pastes."""

import ast
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import lithobrake

ROOT = Path(__file__).parents[1]
PARTS = ("dem", "touchdown", "chaos", "emulator", "campaign", "smallbody", "analysis", "report")


def readme_commands() -> list[str]:
    """The shell commands of the README, one entry a block."""
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
    metadata = tomllib.loads((ROOT / "pyproject.toml").read_text())
    assert metadata["project"]["version"] == lithobrake.__version__
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
    names_on_index = {
        "PIL": "matplotlib", "contourpy": "matplotlib", "imageio_ffmpeg": "imageio-ffmpeg", "sklearn": "scikit-learn",
        "mpl_toolkits": "matplotlib", "pydantic_core": "pydantic", "llvmlite": "numba", "tomli_w": "tomli-w",
        "yaml": "pyyaml",
    }  # fmt: skip
    used: set[str] = set()
    for source in (ROOT / "lithobrake").rglob("*.py"):
        for node in ast.walk(ast.parse(source.read_text())):
            if isinstance(node, ast.Import):
                used |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
                used.add(node.module.split(".")[0])
    foreign = {names_on_index.get(name, name) for name in used if name not in sys.stdlib_module_names} - {"lithobrake"}
    assert foreign <= declared


def _project() -> dict[str, list[str]]:
    project: dict[str, list[str]] = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    return project
