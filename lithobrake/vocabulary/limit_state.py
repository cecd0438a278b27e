"""A limit state: a condition on how a landing ends, in words of the study file, read into a tree of four kinds.

`lithobrake.analysis.subset_simulation` says which landings meet one.
"""

import ast
import math
import operator
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from lithobrake.vocabulary.outcomes import FATES
from lithobrake.vocabulary.plain_text import closest
from lithobrake.vocabulary.quantities import TOUCHDOWN

# How like a name has to be to be meant: a place, say, is no displacement.
ALIKE = 0.6
# A condition that a person wrote; a longer one would overflow the parser.
LONGEST = 500
SIGNS: dict[type, str] = {ast.Gt: ">", ast.GtE: ">=", ast.Lt: "<", ast.LtE: "<="}
COMPARED: dict[str, Callable[[Any, Any], Any]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
TRUTH = {"true": True, "false": False}
EXAMPLE = '"speed_out > 0.1 and not returns"'
ALLOWED = (
    "outputs (SI) compared by <, <=, >, >= with numbers or each other, the words "
    f"{', '.join(FATES)} (also == true, == false), and, or, not, brackets"
)


class Word(NamedTuple):
    """One of FATES that is to be so, or not."""

    name: str
    is_so: bool


class Comparison(NamedTuple):
    """Outputs, by name, and numbers: each side stands in its sign (<, <=, >, >=) to the next."""

    sides: tuple[str | float, ...]
    signs: tuple[str, ...]


class Negation(NamedTuple):
    """Not this condition."""

    of: "Condition"


class Junction(NamedTuple):
    """All of these conditions, or any of them."""

    parts: tuple["Condition", ...]
    needs_all: bool


Condition = Word | Comparison | Negation | Junction


class NoLimitStateError(ValueError):
    """A text that is no condition; the message says what of it is wrong."""


@dataclass(frozen=True)
class LimitState:
    """A condition such as `speed_out > 0.1 and not returns`; `of` reads one.

    outputs, fates: the names that it uses, in their order.
    """

    text: str
    condition: Condition
    outputs: tuple[str, ...]
    fates: tuple[str, ...]

    @classmethod
    def of(cls, text: str) -> "LimitState":
        """Read a condition. Raises NoLimitStateError for a text that is none."""
        tree = _parsed(text)
        condition = _condition(tree, text.strip())
        names = dict.fromkeys(node.id for node in ast.walk(tree) if isinstance(node, ast.Name))
        return cls(text, condition, tuple(n for n in names if n in TOUCHDOWN), tuple(n for n in names if n in FATES))


def _parsed(text: str) -> ast.expr:
    """The tree of a text in the grammar of Python, of which a condition is a small part."""
    if len(text) > LONGEST:
        raise NoLimitStateError(f"it has {len(text)} characters: write a condition of {LONGEST} at most")
    # The parser of Python passes over what stands behind the one, and over the other within brackets.
    if "#" in text or len(text.strip().splitlines()) > 1:
        raise NoLimitStateError("it has a comment (#) or a line break: write a condition on one line, without #")
    try:
        return ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise NoLimitStateError(f"it cannot be read: write it as in {EXAMPLE}") from error


def _condition(node: ast.expr, text: str) -> Condition:
    """The condition of a tree; text: the whole one. Raises NoLimitStateError for whatever is none."""
    match node:
        case ast.BoolOp(op=op, values=values):
            return Junction(tuple(_condition(value, text) for value in values), isinstance(op, ast.And))
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            return Negation(_condition(operand, text))
        case ast.Compare():
            return _word_and_truth(node) or _comparison(node, text)
        case ast.Name(id=name):
            if name in TOUCHDOWN:
                raise NoLimitStateError(f"{name} is a number: compare it, as in {name} > 0.1")
            if name not in FATES:
                raise NoLimitStateError(
                    f"{name} is no name here{closest(name, (*FATES, *TOUCHDOWN), ALIKE)}; it describes one touchdown"
                )
            return Word(name, True)
    words = ast.get_source_segment(text, node)
    raise NoLimitStateError(f"{words} is no condition: compare an output, or name what may happen")


def _word_and_truth(node: ast.Compare) -> Word | None:
    """The word of a comparison such as `returns == false`; None for another comparison."""
    match node:
        case ast.Compare(left=ast.Name(id=word), ops=[ast.Eq() | ast.NotEq() as op], comparators=[other]):
            said = other.id if isinstance(other, ast.Name) else str(getattr(other, "value", ""))
            if word in FATES and said.lower() in TRUTH:
                return Word(word, TRUTH[said.lower()] == isinstance(op, ast.Eq))
    return None


def _comparison(node: ast.Compare, text: str) -> Comparison:
    if not all(type(op) in SIGNS for op in node.ops):
        raise NoLimitStateError(
            "outputs are compared by <, <=, >, >=, and == only says of one word whether it is true or false"
        )
    sides = tuple(_side(side, text) for side in (node.left, *node.comparators))
    if not any(isinstance(side, str) for side in sides):
        raise NoLimitStateError(f"{ast.get_source_segment(text, node)} compares numbers alone: name an output")
    return Comparison(sides, tuple(SIGNS[type(op)] for op in node.ops))


def _side(node: ast.expr, text: str) -> str | float:
    """A side of a comparison: an output or a finite number. Raises NoLimitStateError for anything else."""
    if isinstance(node, ast.Name):
        if node.id in FATES:
            raise NoLimitStateError(f"{node.id} is true or false, and no number: write {node.id}, or not {node.id}")
        if node.id not in TOUCHDOWN:
            near = closest(node.id, TOUCHDOWN, ALIKE)
            raise NoLimitStateError(f"{node.id} is no output{near}; of a touchdown there are {', '.join(TOUCHDOWN)}")
        return node.id
    number = _number(node)
    if number is None:
        raise NoLimitStateError(f"{ast.get_source_segment(text, node)} is neither an output nor a finite number")
    return number


def _number(node: ast.expr) -> float | None:
    """The finite number that a side of a comparison is, with its sign; None for another."""
    match node:
        case ast.UnaryOp(op=ast.USub() | ast.UAdd() as sign, operand=ast.Constant() as operand):
            value = _number(operand)
            return None if value is None else -value if isinstance(sign, ast.USub) else value
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            # Whole numbers too long for a float are not finite to it.
            return float(value) if abs(value) < 1e308 and math.isfinite(value) else None
    return None
