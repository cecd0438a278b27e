"""Which code makes a file outdated: that which decides what stands in it, and no other."""

import ast
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import pytest

from lithobrake.files import reading
from lithobrake.pipeline import stage_keys
from lithobrake.pipeline.job import Stage
from lithobrake.pipeline.stages import STAGES
from lithobrake.study import Study, check_tables
from lithobrake.study.template import template

from ..paper_tables import paper_tables

PACKAGE = Path(reading.__file__).parents[1]
# What decides no content of a file, or is known to the study by another hash.
ELSEWHERE = (
    *(
        "pipeline/study_folder.py",
        "pipeline/folder_state.py",
        "pipeline/job.py",
        "files",
        "progress",
    ),  # how files are written
    *("campaign", "compilation"),  # who makes runs, and how kernels are compiled
    *("dem", "touchdown"),  # the hash of the engine
    *("study", "vocabulary"),  # by their values, which each stage reads; words
    *("pipeline/runs/beds.py", "pipeline/runs/solver.py"),  # the keys of beds and runs
    # inputs of the first touchdowns of journeys, which the keys of runs hold
    *("pipeline/design/arrivals.py", "pipeline/design/descents.py", "pipeline/design/drawn_design.py"),
    *("pipeline/design/bed_order.py", "pipeline/design/descent_checks.py", "pipeline/design/released_states.py"),
    "pipeline/design/side_designs.py",
    "pipeline/design/random_inputs.py",  # inputs of runs, likewise
    "__init__.py",
)
# The site that a design holds: its runs take of it the same inputs of first touchdowns alone. What else reads the site
# imports it by itself.
BY_KEYS_OF_RUNS = {PACKAGE / "pipeline/design/drawn_design.py": {PACKAGE / "pipeline/site.py"}}


@cache
def imported(path: Path) -> list[Path]:
    """The files of the package that a file imports, also within functions, but not for its types alone."""
    found = []
    tree = ast.parse(path.read_text(encoding="utf-8"))
    typed = {
        id(node) for part in ast.walk(tree) if isinstance(part, ast.If) and "TYPE_CHECKING" in ast.unparse(part.test)
        for node in ast.walk(part)
    }  # fmt: skip
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and id(node) not in typed and (node.module or "").startswith("lithobrake"):
            for name in (f"{node.module}.{alias.name}" for alias in node.names):
                found += file_of(name)
    return found


def file_of(name: str) -> list[Path]:
    """The file of a name: a module, or what holds the last part of the name."""
    for module in (name, name.rpartition(".")[0]):
        place = PACKAGE.parent.joinpath(*module.split("."))
        found = [path for path in (place.with_suffix(".py"), place / "__init__.py") if path.exists()]
        if found:
            return found
    return []


def is_in(path: Path, parts: tuple[str, ...]) -> bool:
    return any(path.is_relative_to(PACKAGE / part) for part in parts)


def closure(start: Path) -> set[Path]:
    """All files that decide what a file does, up to those that a study knows otherwise."""
    found, left = set[Path](), [start]
    while left:
        path = left.pop()
        if path not in found and not is_in(path, ELSEWHERE):
            found.add(path)
            left += set(imported(path)) - BY_KEYS_OF_RUNS.get(path, set())
    return found


def before(stage: Stage) -> tuple[str, ...]:
    """Parts of a stage and of all that it follows."""
    by_name = {one.name: one for one in STAGES}
    return stage.parts + tuple(part for name in stage.after for part in before(by_name[name]))


@pytest.mark.parametrize("stage", [one for one in STAGES[:-1] if one.parts], ids=lambda stage: stage.name)
def test_each_stage_is_outdated_by_all_code_that_decides_its_files(stage: Stage) -> None:
    start = file_of(stage.make.__module__)[0]
    lacking = {path for path in closure(start) if not is_in(path, before(stage))}
    assert not {str(path.relative_to(PACKAGE)) for path in lacking if path.name != "__init__.py"}


def drawn_study() -> Study:
    return check_tables(tomllib.loads(template()), Path())


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package's sources."""
    copy = tmp_path_factory.mktemp("sources") / "lithobrake"
    for path in PACKAGE.rglob("*.py"):
        place = copy / path.relative_to(PACKAGE)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(path.read_bytes())
    return copy


@contextmanager
def edited(files: list[Path]) -> Iterator[None]:
    """A comma more in the first docstring of these files, for as long as this lasts."""
    texts = {path: path.read_text(encoding="utf-8") for path in files}
    for path, text in texts.items():
        path.write_text(text.replace('."""', '.,"""', 1), encoding="utf-8")
    # As in another process.
    reading.source_hash.cache_clear()
    yield
    for path, text in texts.items():
        path.write_text(text, encoding="utf-8")
    reading.source_hash.cache_clear()


@pytest.mark.parametrize("study", [drawn_study(), check_tables(paper_tables(), Path())], ids=["drawn", "paper"])
@pytest.mark.parametrize(("room", "outdated"), [
    ("pipeline/planning", set()),
    ("pipeline/commands", set()),
    ("pipeline/inferred_study.py", set()),
    ("cli", set()),
    ("campaign", set()),
    ("export", set()),
    ("report/pages", {"report"}),
    ("statements", {"estimate", "summary", "report"}),
    ("results/study_results.py", {"estimate", "summary", "report"}),
    ("pipeline/first_touchdown/bounce_laws.py", {"hard_ground", "aim", "summary", "report"}),
    ("pipeline/answer", {"estimate", "summary", "report"}),
])  # fmt: skip
def test_a_comma_outdates_what_its_room_makes_and_nothing_else(
    sources: Path, monkeypatch: pytest.MonkeyPatch, study: Study, room: str, outdated: set[str]
) -> None:
    monkeypatch.setattr(reading, "__file__", str(sources / "files" / "reading.py"))
    keys, place = stage_keys(study), sources / room
    with edited([place] if place.is_file() else list(place.glob("*.py"))):
        changed = stage_keys(study)
    assert stage_keys(study) == keys
    made = {stage.name for stage in STAGES if stage.files(study)}
    assert {name for name in keys if keys[name] != changed[name]} == outdated & made
