"""A limit state: a condition on how a first touchdown or a journey ends, in words of the study file, as a tree.

One that names something of a journey (JOURNEY_NUMBERS, how it ended, the side down) is of the whole journey, and so
are then the words that a first touchdown has as well. `lithobrake.analysis.subset_simulation` says which landings or
journeys meet one.
"""

import ast
import math
import operator
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from lithobrake.vocabulary.journey_names import FACE, JOURNEY_NUMBERS, JOURNEY_WORDS, PLACE, face_word
from lithobrake.vocabulary.outcomes import FATES
from lithobrake.vocabulary.plain_text import closest
from lithobrake.vocabulary.quantities import SIDES, TOUCHDOWN

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
    f"{', '.join(FATES)} (also == true, == false), and, or, not, brackets; or, of the whole journey, "
    f"{', '.join((*JOURNEY_NUMBERS, *JOURNEY_WORDS, FACE))}"
)
NUMBERS = (*TOUCHDOWN, *(name for name in JOURNEY_NUMBERS if name not in TOUCHDOWN))
WORDS = (*FATES, *(name for name in JOURNEY_WORDS if name not in FATES))
# What makes a condition one of the whole journey, and what no such condition may name.
OF_JOURNEY = frozenset({*JOURNEY_NUMBERS, *JOURNEY_WORDS, FACE} - {*TOUCHDOWN, *FATES})
OF_TOUCHDOWN = frozenset({*TOUCHDOWN, *FATES} - {*JOURNEY_NUMBERS, *JOURNEY_WORDS})


class Word(NamedTuple):
    """One of WORDS, or a side that is down as `face_word` names it, that is to be so, or not."""

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

    outputs, fates: the names of a first touchdown that it uses, in their order; journey: those of a whole journey.
    """

    text: str
    condition: Condition
    outputs: tuple[str, ...]
    fates: tuple[str, ...]
    journey: tuple[str, ...] = ()

    @classmethod
    def of(cls, text: str) -> "LimitState":
        """Read a condition. Raises NoLimitStateError for a text that is none."""
        tree = _parsed(text)
        condition = _condition(tree, text.strip())
        names = dict.fromkeys(node.id for node in ast.walk(tree) if isinstance(node, ast.Name))
        known = [name for name in names if name in NUMBERS or name in WORDS or name == FACE]
        own = [name for name in known if name in OF_JOURNEY]
        if not own:
            return cls(
                text, condition, tuple(n for n in known if n in TOUCHDOWN), tuple(n for n in known if n in FATES)
            )
        if first := [name for name in known if name in OF_TOUCHDOWN]:
            raise NoLimitStateError(
                f"{first[0]} is of the first touchdown, and {own[0]} of the whole journey; write two limit states"
            )
        return cls(text, condition, (), (), tuple(known))

    @property
    def has_area(self) -> bool:
        """Whether it depends on where a lander rests."""
        return bool(PLACE & {*self.journey})

    @property
    def radius(self) -> float | None:
        """The distance from the aim point [m] where it is that a lander rests within that; None for another."""
        match self.condition:
            case Comparison(("distance", float(radius)), ("<" | "<=",)):
                return radius
            case Comparison((float(radius), "distance"), (">" | ">=",)):
                return radius
        return None


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
            return _word_and_truth(node) or _side_down(node) or _comparison(node, text)
        case ast.Name(id=name):
            if name in NUMBERS:
                raise NoLimitStateError(f"{name} is a number: compare it, as in {name} > 0.1")
            if name == FACE:
                raise NoLimitStateError(f"{name} is the side down: compare it, as in {name} == +z")
            if name not in WORDS:
                raise NoLimitStateError(
                    f"{name} is no name here{closest(name, (*WORDS, *NUMBERS, FACE), ALIKE)}; it describes one "
                    "touchdown, or one journey"
                )
            return Word(name, True)
    words = ast.get_source_segment(text, node)
    raise NoLimitStateError(f"{words} is no condition: compare an output, or name what may happen")


def _word_and_truth(node: ast.Compare) -> Word | None:
    """The word of a comparison such as `returns == false`; None for another comparison."""
    match node:
        case ast.Compare(left=ast.Name(id=word), ops=[ast.Eq() | ast.NotEq() as op], comparators=[other]):
            said = other.id if isinstance(other, ast.Name) else str(getattr(other, "value", ""))
            if word in WORDS and said.lower() in TRUTH:
                return Word(word, TRUTH[said.lower()] == isinstance(op, ast.Eq))
    return None


def _side_down(node: ast.Compare) -> Word | None:
    """The word of `face == +z`, or with the side in quotation marks; None for a comparison of something else."""
    if FACE not in {side.id for side in (node.left, *node.comparators) if isinstance(side, ast.Name)}:
        return None
    match node:
        case ast.Compare(left=ast.Name(id="face"), ops=[ast.Eq() | ast.NotEq() as op], comparators=[other]):
            side = ast.unparse(other).replace("'", "")
            if side in SIDES:
                return Word(face_word(side), isinstance(op, ast.Eq))
    raise NoLimitStateError(f"{FACE} is the side down: compare it by == or != with one of {', '.join(SIDES)}")


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
        if node.id in WORDS:
            raise NoLimitStateError(f"{node.id} is true or false, and no number: write {node.id}, or not {node.id}")
        if node.id not in NUMBERS:
            near = closest(node.id, NUMBERS, ALIKE)
            raise NoLimitStateError(
                f"{node.id} is no output{near}; of a touchdown there are {', '.join(TOUCHDOWN)}, and of a journey "
                f"{', '.join(JOURNEY_NUMBERS)}"
            )
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
