"""Imports run one way: dem <- touchdown <- pipeline <- cli; chaos, campaign and smallbody stand alone."""

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "lithobrake"
# Anyone may import these: they know nothing of the rest.
LEAVES = {"compiled", "disk_cache", "atomic", "mesh", "mesh_files", "outputs", "plain", "reading", "__init__"}
# What each part may import beside the leaves and itself.
ALLOWED: dict[str, set[str]] = {
    "dem": set(),
    "touchdown": {"dem"},
    "chaos": set(),
    "campaign": set(),
    "smallbody": set(),
    "analysis": {"chaos"},
    "results": set(),
    "report": {"chaos"},
    "wording": set(),
    "quantity": {"wording", "chaos"},
    "study_campaign": {"quantity"},
    "study_design": {"study_campaign", "quantity"},
    "study_flight": {"study_campaign", "quantity"},
    "study": {"study_campaign", "study_design", "study_flight", "quantity"},
    "site": {"study", "quantity", "smallbody"},
    "study_body": {"study", "quantity", "wording", "site"},
    "study_contact": {"study", "quantity"},
    "study_checks": {"study", "study_body", "study_contact", "quantity", "wording", "chaos", "touchdown"},
    "study_file": {"study", "study_body", "study_checks", "site", "wording", "campaign"},
    "study_template": {"study", "study_units", "quantity"},
    "study_units": {"study", "quantity"},
    "pipeline": {
        *("dem", "touchdown", "chaos", "campaign", "smallbody", "analysis", "report"),
        *("study", "study_file", "study_units", "quantity", "site"),
    },
    "progress": {"progress_log"},
    "progress_log": {"campaign"},
    "__main__": {"cli"},
    "cli": {"study_file", "study_units", "pipeline", "campaign", "progress", "study_template", "report"},
}
# Parts within which imports run one way from file to file, too.
ONE_WAY = ("smallbody",)


def part_of(path: Path) -> str:
    """The part that a source file belongs to: its folder, or itself when it stands at the top."""
    inside = path.relative_to(PACKAGE)
    return inside.parts[0] if len(inside.parts) > 1 else inside.stem


def imported_names(path: Path) -> set[str]:
    """The modules and names that a file imports from the package, with dots, wherever in the file it does so."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path} imports by dots; write the full name"
            found |= {f"{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
    return {name for name in found if name.startswith("lithobrake.")}


def imported_parts(path: Path) -> set[str]:
    """The parts that a file imports."""
    return {part for name in imported_names(path) if not (part := name.split(".")[1]).startswith("__")}


def imported_files(path: Path) -> set[Path]:
    """The files of its own part that a file imports; for a name that is no file, the __init__ that it comes from."""
    found = set()
    for part, *inside in (name.split(".")[1:] for name in imported_names(path)):
        if part == path.parent.name:
            file = path.with_name(f"{[*inside, '__init__'][0]}.py")
            found.add(file if file.exists() else path.with_name("__init__.py"))
    return found


SOURCES = sorted(PACKAGE.rglob("*.py"))


@pytest.mark.parametrize("path", SOURCES, ids=[str(path.relative_to(PACKAGE)) for path in SOURCES])
def test_a_file_imports_only_what_its_part_may(path: Path) -> None:
    part = part_of(path)
    allowed = LEAVES | {part} | ALLOWED.get(part, set())
    assert imported_parts(path) <= allowed


def test_every_part_has_its_rule() -> None:
    assert {part_of(path) for path in SOURCES} - LEAVES == set(ALLOWED)


@pytest.mark.parametrize("part", ONE_WAY)
def test_no_two_files_import_each_other(part: str) -> None:
    """Neither directly nor by way of others: that raises CycleError, with their names."""
    imports = {path: imported_files(path) for path in (PACKAGE / part).glob("*.py")}
    assert set(TopologicalSorter(imports).static_order()) == set(imports)
