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
    "results": {"chaos", "study"},
    "report": {"chaos"},
    # The reader makes words of a command absolute as the campaign starts them.
    "study": {"chaos", "campaign", "smallbody", "touchdown"},
    "pipeline": {
        *("dem", "touchdown", "chaos", "campaign", "smallbody", "analysis", "report", "results"),
        "study",
    },
    "progress": {"progress_log"},
    "progress_log": {"campaign"},
    "__main__": {"cli"},
    "cli": {"study", "pipeline", "campaign", "progress", "report"},
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
