"""Imports run one way: dem <- touchdown <- pipeline <- cli; chaos <- emulator; campaign and smallbody stand alone."""

import ast
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from .syntax_trees import syntax_tree

PACKAGE = Path(__file__).parents[1] / "lithobrake"
# Anyone may import these: they know nothing of the rest.
LEAVES = {"files", "vocabulary", "geometry", "compilation"}
# What each part may import beside the leaves and itself.
ALLOWED: dict[str, set[str]] = {
    "dem": set(),
    # A touchdown of a study is made of what its file has.
    "touchdown": {"dem", "study"},
    "chaos": set(),
    "campaign": set(),
    "serve": set(),
    "smallbody": set(),
    "emulator": {"chaos"},
    "analysis": {"chaos", "emulator"},
    "results": {"campaign", "chaos", "emulator", "study", "touchdown"},
    "scoring": {"analysis"},
    "statements": {"results"},
    "report": {"results", "statements"},
    "view": {"results", "report"},
    "export": {"results", "smallbody", "study", "touchdown", "view"},
    # The reader makes words of a command absolute as the campaign starts them.
    "study": {"chaos", "campaign", "dem", "smallbody"},
    "pipeline": {
        *("dem", "touchdown", "chaos", "emulator", "campaign", "smallbody", "analysis", "report", "results"),
        *("statements", "study", "serve"),
    },
    "progress": {"campaign"},
    "doctor": {"campaign", "dem", "pipeline", "smallbody", "touchdown"},
    "__main__": {"cli"},
    "__init__": {"pipeline", "report", "results"},
    "cli": {"study", "pipeline", "campaign", "progress", "results", "scoring", "export", "serve", "view", "doctor"},
}
# Parts in which no file imports one that imports it, directly or through others.
WITHOUT_CIRCLES = tuple(part for part in ALLOWED if (PACKAGE / part).is_dir())
# Rooms of a part from the ground up: each imports those before it alone; what stands in none of them may import all.
ROOMS = {
    "dem": ("bodies", "narrow_phase", "law", "stepping", "local_stepping"),
    "pipeline": (
        *("site", "study_folder", "folder_state", "design", "job", "runs", "first_touchdown"),
        *("expansion", "journeys", "sky_at_rest", "answer", "site_arrivals", "site_grid", "delivery_grid", "stages"),
        *(
            "outdated_files",
            "sequential_sampling",
            "shared_numbers",
            "inferred_study",
            "nowcast",
            "planning",
            "study_run",
            "commands",
        ),
    ),
    "statements": (
        *("estimates", "labels", "ends", "captions", "touchdowns", "journeys", "grounds", "expansion", "limits"),
        *("comparison", "sites", "requirements", "nowcast", "notes", "answers"),
    ),
    "report": ("content", "tables", "figures", "live", "pages", "study_plots", "plotted_study", "reports"),
}
# Who uses which part by the names of its __init__ alone.
THROUGH_THE_FACE = (("touchdown", "dem"),)


def part_of(path: Path) -> str:
    """The part that a source file belongs to: its folder, or itself when it stands at the top."""
    inside = path.relative_to(PACKAGE)
    return inside.parts[0] if len(inside.parts) > 1 else inside.stem


@cache
def imported_names(path: Path, only_at_load: bool = False) -> set[str]:
    """The full names that a file imports: modules, and what comes out of them; wherever in the file it does so, or when
    it is itself imported. A face whose names are imported late counts as importing them.
    """
    nodes = syntax_tree(path).body
    stub = path.with_suffix(".pyi")
    if stub.exists():
        nodes = nodes + syntax_tree(stub).body
    if only_at_load and path.name != "__init__.py":
        nodes = [node for node in nodes if isinstance(node, ast.Import | ast.ImportFrom)]
    found = set()
    for node in ast.walk(ast.Module(nodes)):
        if isinstance(node, ast.ImportFrom):
            # A stub names what its face hands on, and does so by dots.
            assert node.level == stub.exists(), f"{path} imports by dots; write the full name"
            part = ".".join(("", *path.parent.relative_to(PACKAGE.parent).parts, "")) if node.level else ""
            found |= {f"{part[1:]}{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
    return {name for name in found if name.startswith("lithobrake.")}


def imported_parts(path: Path) -> set[str]:
    """The parts that a file imports."""
    parts = {name.split(".")[1] for name in imported_names(path)}
    return {part for part in parts if not part.startswith("__")}


@cache
def imported_file(name: str) -> Path:
    """The file that an imported name stands in: a module, or what holds the last part of the name."""
    for module in (name, name.rpartition(".")[0]):
        place = PACKAGE.parent.joinpath(*module.split("."))
        for path in (place.with_suffix(".py"), place / "__init__.py"):
            if path.exists():
                return path
    raise AssertionError(f"{name} is nowhere in the package")


SOURCES = sorted(PACKAGE.rglob("*.py"))


@pytest.mark.parametrize("path", SOURCES, ids=[str(path.relative_to(PACKAGE)) for path in SOURCES])
def test_a_file_imports_only_what_its_part_may(path: Path) -> None:
    part = part_of(path)
    allowed = LEAVES | {part} | ALLOWED.get(part, set())
    assert imported_parts(path) <= allowed


def test_every_part_has_its_rule() -> None:
    assert {part_of(path) for path in SOURCES} - LEAVES == set(ALLOWED)


def test_no_two_files_import_each_other() -> None:
    files = [path for path in SOURCES if part_of(path) in WITHOUT_CIRCLES]
    # Raises CycleError with the files of a circle.
    TopologicalSorter({path: {imported_file(name) for name in imported_names(path)} for path in files}).prepare()


def test_any_file_can_be_imported_first() -> None:
    graph = {}
    for path in SOURCES:
        files = {imported_file(name) for name in imported_names(path, only_at_load=True)}
        # A file brings the faces of the folders that it stands in; those of its importer are there already.
        faces = {folder / "__init__.py" for file in files for folder in file.parents if PACKAGE in folder.parents}
        graph[path] = {file for file in files | faces if file.parent not in path.parents or file.name != "__init__.py"}
    TopologicalSorter(graph).prepare()


def room_of(name: str) -> str:
    """The room of a part that a full name stands in: the folder, or the file, below the part."""
    return name.split(".")[2]


@pytest.mark.parametrize("part", ROOMS)
def test_rooms_of_a_part_import_one_way(part: str) -> None:
    upward = set()
    for path in (PACKAGE / part).rglob("*.py"):
        rooms = ROOMS[part]
        own = path.relative_to(PACKAGE / part).parts[0].removesuffix(".py")
        allowed = rooms[: rooms.index(own) + 1] if own in rooms else rooms
        used = {room_of(name) for name in imported_names(path) if name.startswith(f"lithobrake.{part}.")}
        upward |= {f"{path.relative_to(PACKAGE)} imports {room}" for room in used & set(rooms) - set(allowed)}
    assert not upward


def test_every_room_has_its_place() -> None:
    for part in ("pipeline", "statements", "report"):
        found = {
            path.relative_to(PACKAGE / part).parts[0].removesuffix(".py") for path in (PACKAGE / part).rglob("*.py")
        }
        assert found - {"__init__"} <= set(ROOMS[part]), part


@pytest.mark.parametrize(("user", "part"), THROUGH_THE_FACE)
def test_a_part_is_used_through_its_face(user: str, part: str) -> None:
    face = PACKAGE / part / "__init__.py"
    for path in (path for path in SOURCES if part_of(path) == user):
        for name in imported_names(path):
            assert not name.startswith(f"lithobrake.{part}.") or imported_file(name) == face, f"{path} imports {name}"
