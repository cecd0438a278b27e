"""One name means one thing, and functions stay short enough to be read at once."""

import ast
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from .syntax_trees import syntax_tree

PACKAGE = Path(__file__).parents[1] / "lithobrake"
# Both are public: what a grain is, and what a body is; a study as it was checked, and one that is written in Python.
SAME_NAME_ON_PURPOSE = {"Shape", "Study"}
# Lines beside the docstring; a kernel, which a call would slow down, may have twice as many.
LONGEST = 40
LONGEST_KERNEL = 80
# Compiled where Numba is there, and by NumPy alone where it is not.
ALSO_KERNELS = ("expansion_loop",)
# Where a newcomer who looks for these words among the names of files finds them.
LOOKED_FOR = {
    "gjk": "dem/narrow_phase", "penetration": "dem/narrow_phase", "hertz": "dem/law", "coulomb": "dem/law",
    "restitution": "dem/law", "tangential_spring": "dem/law", "rolling_resistance": "dem/law",
    "time_step": "dem/stepping", "stability": "dem/stepping", "agenda": "dem/local_stepping",
    "settling": "touchdown", "outcome_judge": "touchdown", "bootstrap": "chaos", "sobol_indices": "chaos",
    "polyhedron_gravity": "smallbody", "impact_search": "smallbody", "ledger": "campaign", "refusals": "study",
    "captions": "statements",
}  # fmt: skip


@cache
def trees() -> dict[Path, ast.Module]:
    """The syntax trees of all files of the package."""
    return {path: syntax_tree(path) for path in sorted(PACKAGE.rglob("*.py"))}


def test_each_class_is_defined_once() -> None:
    names = Counter(node.name for tree in trees().values() for node in tree.body if isinstance(node, ast.ClassDef))
    assert {name for name, count in names.items() if count > 1} <= SAME_NAME_ON_PURPOSE


@pytest.mark.parametrize(("word", "part"), LOOKED_FOR.items())
def test_what_is_looked_for_is_the_name_of_a_file(word: str, part: str) -> None:
    assert [path for path in (PACKAGE / part).glob("*.py") if word in path.stem]


def lines_of(function: ast.FunctionDef) -> int:
    """Lines of a function beside its docstring."""
    first = function.body[0]
    said = first.end_lineno - first.lineno + 1 if ast.get_docstring(function) else 0
    return function.end_lineno - function.lineno + 1 - said


def test_functions_are_short() -> None:
    for path, tree in trees().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef):
                marks = " ".join(ast.unparse(mark) for mark in node.decorator_list)
                is_kernel = "kernel" in marks or "compiled" in marks or node.name in ALSO_KERNELS
                assert lines_of(node) <= (LONGEST_KERNEL if is_kernel else LONGEST), f"{path.name}: {node.name}"
