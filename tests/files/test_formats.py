"""Each kind of file names itself, and no two kinds by the same words, so that none is taken for a damaged other."""

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "lithobrake"


def written_formats() -> Iterator[str]:
    """What the package's code assigns to a constant FORMAT, or to the entry "format" of a file."""
    for path in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Assign):
                for target in node.targets:
                    yield from _formats(target, node.value)


def _formats(target: ast.expr, value: ast.expr) -> Iterator[str]:
    match target, value:
        case ast.Tuple(elts=targets), ast.Tuple(elts=values) if len(targets) == len(values):
            for one, other in zip(targets, values, strict=True):
                yield from _formats(one, other)
        case (
            (ast.Name(id="FORMAT") | ast.Subscript(slice=ast.Constant(value="format"))),
            ast.Constant(value=str(words)),
        ):
            yield words


def test_no_two_kinds_of_files_have_one_format() -> None:
    counts = Counter(written_formats())
    # Expansion, emulator, bed, landing and world at least.
    assert len(counts) >= 5
    assert set(counts.values()) == {1}
