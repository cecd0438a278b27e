"""A sentence with a number is made in one place, and what words an estimate stands in one room.

Sentences are f-strings, reduced to their words: two with the same words in two places are one sentence made twice.
"""

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from ..syntax_trees import syntax_tree

PACKAGE = Path(__file__).parents[2] / "lithobrake"
# Below this part, which puts single numbers, shares and intervals in words, nothing knows of results.
WORDING = ("statements", "vocabulary")
# Stands for a number in a sentence.
NUMBER = "\0"
FEWEST_WORDS = 5
# What gives an interval its level, and what words the share of landers that end in some way; a warning says what may.
ESTIMATES = {
    "an interval": rf"{NUMBER} % interval|{NUMBER} intervals?\b|\b9[05] %",
    "an end share": rf"{NUMBER} (of the (landers|landings)\b(?! may)|come to rest|at rest|impact the surface)\b",
}


@cache
def sentences() -> tuple[tuple[str, str, ast.JoinedStr], ...]:
    """File, skeleton and node of every f-string of the package but for messages of errors."""
    found: list[tuple[str, str, ast.JoinedStr]] = []
    left: list[ast.AST]
    for path in sorted(PACKAGE.rglob("*.py")):
        name, left = path.relative_to(PACKAGE).as_posix(), [syntax_tree(path)]
        while left:
            node = left.pop()
            if isinstance(node, ast.JoinedStr):
                found.append((name, skeleton(node), node))
            if not isinstance(node, ast.Raise):
                left.extend(ast.iter_child_nodes(node))
    return tuple(found)


def skeleton(node: ast.JoinedStr) -> str:
    """The words of an f-string, with a sign in the place of each number."""
    return "".join(str(part.value) if isinstance(part, ast.Constant) else NUMBER for part in node.values)


def words(text: str) -> list[str]:
    """The words of a sentence; of a text for another program there are none."""
    return [] if re.search(r"<\w|SELECT|lithobrake run", text) else re.findall(r"[A-Za-z][A-Za-z'-]*", text)


def made_twice(found: Iterator[tuple[str, str]]) -> dict[str, list[str]]:
    """Sentences of several words by the places, of which each has more than one."""
    places = defaultdict(list)
    for name, text in found:
        if len(words(text)) >= FEWEST_WORDS:
            places[" ".join(words(text))].append(name)
    return {text: names for text, names in places.items() if len(names) > 1}


def test_no_sentence_with_a_number_is_made_twice() -> None:
    assert made_twice((name, text) for name, text, _ in sentences()) == {}


@pytest.mark.parametrize("what", ESTIMATES)
def test_estimates_are_put_in_words_in_one_room(what: str) -> None:
    outside = [(name, text) for name, text, _ in sentences() if not name.startswith(WORDING)]
    assert [(name, text) for name, text in outside if re.search(ESTIMATES[what], text)] == []


def test_shares_are_made_per_cent_in_one_place() -> None:
    by_hand = []
    for name, text, node in sentences():
        for part, after in zip(node.values, [*node.values[1:], None], strict=True):
            is_share = isinstance(after, ast.Constant) and str(after.value).startswith(" %")
            if is_share and isinstance(part, ast.FormattedValue) and "100" in ast.unparse(part.value):
                by_hand.append((name, text))
    assert {name for name, _ in by_hand} <= {"vocabulary/number_words.py"}


def test_durations_are_put_in_words_in_one_place() -> None:
    units = rf"{NUMBER} (min|h|days)\b"
    timed = {name for name, text, _ in sentences() if re.search(units, text)}
    assert {name for name in timed if not name.startswith(WORDING)} == set()


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ('f"{percent(level)} interval"', "an interval"),
        ('f"({100 * level:.0f} % interval {low} to {high})"', "an interval"),
        ('f"95 % within {far} m"', "an interval"),
        ('f"{share} of the landers stay"', "an end share"),
        ('f"{share} come to rest within {limit}"', "an end share"),
    ],
)
def test_what_words_an_estimate_is_found(source: str, said: str) -> None:
    (node,) = [one for one in ast.walk(ast.parse(source)) if isinstance(one, ast.JoinedStr)][:1]
    assert re.search(ESTIMATES[said], skeleton(node))


def test_a_sentence_that_is_made_twice_is_found() -> None:
    one, other = f"{NUMBER} of {NUMBER} landings have no outcome at all", f"{NUMBER} landings of have no outcome at all"
    assert made_twice(iter([("a.py", one), ("b.py", one.replace(" of ", " of  "))])) != {}
    assert made_twice(iter([("a.py", one), ("b.py", other), ("b.py", f"{NUMBER} of {NUMBER}")])) == {}
