"""Kernels take their arguments in one order, say what they write, and are named by no file."""

import ast
import inspect
import re
from functools import cache
from pathlib import Path

import pytest

DEM = Path(__file__).parents[2] / "lithobrake" / "dem"
# The order of arrays, after the pair and before all else.
ORDER = ("System", "Bodies", "Cores", "Planes", "Pairs", "Laws", "Step", "Simplex", "TurnedFeatures", "Patch",
    "Scratch", "Reactions", "Partition")  # fmt: skip
# What these functions write is their first argument.
WRITERS = ("put", "add")


def functions(path: Path) -> list[ast.FunctionDef]:
    return [node for node in ast.parse(path.read_text(encoding="utf-8")).body if isinstance(node, ast.FunctionDef)]


def is_kernel(function: ast.FunctionDef) -> bool:
    return any(isinstance(mark, ast.Name) and mark.id.endswith("kernel") for mark in function.decorator_list)


KERNELS = {function.name: function for path in sorted(DEM.rglob("*.py")) for function in functions(path)
           if is_kernel(function)}  # fmt: skip


def annotations(function: ast.FunctionDef) -> dict[str, str]:
    return {argument.arg: ast.unparse(argument.annotation) for argument in function.args.args}


def root(node: ast.expr) -> str | None:
    """The variable that an expression is a part of."""
    while isinstance(node, ast.Attribute | ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else None


def assignments(function: ast.FunctionDef) -> list[tuple[ast.expr, ast.expr | None]]:
    """What is assigned, and what to it (None: a number added to it), tuple by tuple."""
    found: list[tuple[ast.expr, ast.expr | None]] = []
    for node in ast.walk(function):
        if isinstance(node, ast.AugAssign):
            found.append((node.target, None))
        elif isinstance(node, ast.Assign):
            for target in node.targets:
                ends = target.elts if isinstance(target, ast.Tuple) else [target]
                # What is unpacked from one thing is a part of that.
                several = isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple)
                found += zip(ends, node.value.elts if several else [node.value] * len(ends), strict=True)
    return found


@cache
def written(kernel: str) -> set[str]:
    """The arguments whose arrays a kernel writes, itself or through the kernels that it calls."""
    function = KERNELS[kernel]
    arguments, assigned = list(annotations(function)), assignments(function)
    part_of = {name: name for name in arguments}
    for target, value in assigned:
        if isinstance(target, ast.Name) and value is not None and root(value) in part_of:
            part_of[target.id] = part_of[root(value)]
    places = {root(target) for target, _ in assigned if not isinstance(target, ast.Name)}
    for node in ast.walk(function):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            called = KERNELS.get(node.func.id)
            if node.func.id in WRITERS:
                places.add(root(node.args[0]))
            elif called is not None:
                filled = dict(zip(annotations(called), node.args, strict=True))
                places |= {root(filled[name]) for name in written(called.name)}
    return {part_of[place] for place in places if place in part_of}


@pytest.mark.parametrize("name", sorted(KERNELS))
def test_arrays_come_in_one_order_after_the_pair(name: str) -> None:
    types = list(annotations(KERNELS[name]).items())
    place = [
        0 if name == "pair" else 1 + ORDER.index(kind) if kind in ORDER else 1 + len(ORDER) for name, kind in types
    ]
    assert place == sorted(place), f"{name} takes {types}"


@pytest.mark.parametrize("name", sorted(set(KERNELS) - set(WRITERS)))
def test_a_kernel_says_what_it_writes(name: str) -> None:
    text = re.sub(r"\s+", " ", inspect.cleandoc(ast.get_docstring(KERNELS[name]) or ""))
    said = re.findall(r"\bWrites to ([a-z_, ]+)\.", text)
    assert len(said) <= 1
    assert set(re.split(r", | and ", said[0]) if said else []) == written(name)


@pytest.mark.parametrize("path", sorted(DEM.rglob("*.py")), ids=lambda path: path.stem)
def test_no_file_has_the_name_of_a_function_in_it(path: Path) -> None:
    assert path.stem not in [function.name for function in functions(path)]
