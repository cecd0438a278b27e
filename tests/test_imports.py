"""Imports run one way: dem <- touchdown <- pipeline <- cli; chaos, campaign and smallbody stand alone."""

import ast
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


def part_of(path: Path) -> str:
    """The part that a source file belongs to: its folder, or itself when it stands at the top."""
    inside = path.relative_to(PACKAGE)
    return inside.parts[0] if len(inside.parts) > 1 else inside.stem


def imported_parts(path: Path) -> set[str]:
    """The parts that a file imports, wherever in the file it does so."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path} imports by dots; write the full name"
            names = [
                f"{node.module}.{alias.name}" if node.module == "lithobrake" else str(node.module)
                for alias in node.names
            ]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            continue
        found |= {name.split(".")[1] for name in names if name.startswith("lithobrake.")}
    return {name for name in found if not name.startswith("__")}


SOURCES = sorted(PACKAGE.rglob("*.py"))


@pytest.mark.parametrize("path", SOURCES, ids=[str(path.relative_to(PACKAGE)) for path in SOURCES])
def test_a_file_imports_only_what_its_part_may(path: Path) -> None:
    part = part_of(path)
    allowed = LEAVES | {part} | ALLOWED.get(part, set())
    assert imported_parts(path) <= allowed


def test_every_part_has_its_rule() -> None:
    assert {part_of(path) for path in SOURCES} - LEAVES == set(ALLOWED)


# Parts in which no file reaches itself by its imports.
WITHOUT_CIRCLES = (
    "campaign",
    "chaos",
)


def imported_files(path: Path) -> set[Path]:
    """The files of the package that a file imports, inside functions and for type checkers too."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {file_of(alias.name) for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            found |= {file_of(f"{node.module}.{alias.name}") or file_of(str(node.module)) for alias in node.names}
    return {file for file in found if file}


def file_of(module: str) -> Path | None:
    """The file of a module of the package; None for what is no module, or another package's."""
    place = PACKAGE.parent.joinpath(*module.split("."))
    return next((file for file in (place.with_suffix(".py"), place / "__init__.py") if file in SOURCES), None)


@pytest.mark.parametrize("part", WITHOUT_CIRCLES)
def test_no_two_files_import_each_other(part: str) -> None:
    left = {path: imported_files(path) - {path} for path in SOURCES if part_of(path) == part}
    # A file without imports among those that are left is in no circle; what never gets there is in one, or behind it.
    while free := {path for path, imported in left.items() if not imported & left.keys()}:
        left = {path: imported for path, imported in left.items() if path not in free}
    assert not left, f"these import each other: {', '.join(sorted(path.name for path in left))}"
