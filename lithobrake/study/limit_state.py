"""A limit state: a condition on how a landing ends, in words of the study file, and whether landings meet it."""

import ast
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from pydantic_core import core_schema

from lithobrake.study.quantity import refuse
from lithobrake.study.refusals import closest
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, TouchdownOutcome
from lithobrake.vocabulary.quantities import TOUCHDOWN

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Mask = NDArray[np.bool_]

RETURNS = "returns"
# Of a captured lander: whether gravity and rotation together hold it where it lies, or lift it off.
SETTLED, LOFTED = JourneyStatus.SETTLED.value, JourneyStatus.LOFTED.value
# What becomes of a lander in the first flight, as a word that is true or false.
FATES = (RETURNS, TouchdownOutcome.CAPTURED.value, SETTLED, LOFTED, *(status.value for status in FlightStatus))
# Outputs that a lander has also if it is captured; all others are of its way out, which it does not have.
ALSO_OF_CAPTURED = ("contact_duration", "penetration", "peak_acceleration", "energy_lost")
# A condition that a person wrote; a longer one would overflow the parser.
LONGEST = 500
COMPARISONS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Gt: lambda a, b: a > b,
    ast.GtE: lambda a, b: a >= b,
    ast.Lt: lambda a, b: a < b,
    ast.LtE: lambda a, b: a <= b,
}
# Distances where there is none: of what is true or false alone, or is not known, and of what lies on the boundary.
FAR, NEAR = 1e30, 1e-30
TRUTH = {"true": True, "false": False}
ALLOWED = (
    "outputs (SI) compared by <, <=, >, >= with numbers or each other, the words "
    f"{', '.join(FATES)} (also == true, == false), and, or, not, brackets"
)


class Met(NamedTuple):
    """Which landings surely meet a condition, and which may, both [count]; what is not known of one may be either."""

    surely: "Mask"
    maybe: "Mask"


class NoLimitStateError(ValueError):
    """A text that is no condition; the message says what of it is wrong."""


@dataclass(frozen=True)
class LimitState:
    """A condition such as `speed_out > 0.1 and not returns`; `of` reads one.

    outputs, fates: the names that it uses, in their order.
    """

    text: str
    outputs: tuple[str, ...]
    fates: tuple[str, ...]

    @classmethod
    def of(cls, text: str) -> "LimitState":
        """Read a condition. Raises NoLimitStateError for a text that is none."""
        tree = _parsed(text)
        _check(tree, text.strip())
        names = dict.fromkeys(node.id for node in ast.walk(tree) if isinstance(node, ast.Name))
        return cls(text, tuple(n for n in names if n in TOUCHDOWN), tuple(n for n in names if n in FATES))

    def met(self, values: Mapping[str, "NDArray[np.float64]"]) -> "NDArray[np.float64]":
        """Whether landings meet it: 1, 0, or NaN where what is known does not decide, shape [count].

        values: of each name that it uses and of `captured`, [count]: outputs [SI], fates 1 or 0; NaN is not known. A
        comparison with an output of the way out of a lander that was captured, which has none, is not met.
        """
        import numpy as np

        found = _met(_parsed(self.text), values)
        return np.where(found.surely == found.maybe, found.surely.astype(float), np.nan)

    def margin(self, values: Mapping[str, "NDArray[np.float64]"], scale: Mapping[str, float]) -> "NDArray[np.float64]":
        """How far landings are from meeting it, shape [count]: at most 0 where they do, FAR where nobody knows.

        values: as for `met`; scale: of each output that it uses, in its unit, in which distances are counted.
        """
        import numpy as np

        met = self.met(values)
        # The sign is that of `met`, whatever a distance of several comparisons, or one of exactly 0, would have.
        size = np.maximum(np.abs(np.nan_to_num(_distance(_parsed(self.text), values, scale), nan=FAR)), NEAR)
        return np.where(met == 1.0, -size, np.where(met == 0.0, size, FAR))


class LimitStateText:
    """Annotation of a key of the study file that takes a condition."""

    def __get_pydantic_core_schema__(self, _source: object, _handler: object) -> core_schema.CoreSchema:
        """Let the annotation itself check the value."""
        return core_schema.no_info_plain_validator_function(self.read)

    def read(self, value: object) -> str:
        """Give back the text; refuse what is no condition."""
        if not isinstance(value, str):
            raise refuse(value, ALLOWED, 'write it in quotation marks, as in "speed_out > 0.1 and not returns"')
        try:
            LimitState.of(value)
        except NoLimitStateError as error:
            raise refuse(value, ALLOWED, str(error)) from error
        return value


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
        raise NoLimitStateError('it cannot be read: write it as in "speed_out > 0.1 and not returns"') from error


def _check(node: ast.expr, text: str) -> None:
    """Raise NoLimitStateError for whatever is no condition; text: the whole one."""
    match node:
        case ast.BoolOp(values=values):
            for value in values:
                _check(value, text)
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            _check(operand, text)
        case ast.Compare() if _word_and_truth(node) is not None:
            return
        case ast.Compare(left=left, ops=ops, comparators=others):
            if not all(type(op) in COMPARISONS for op in ops):
                raise NoLimitStateError(
                    "outputs are compared by <, <=, >, >=, and == only says of one word whether it is true or false"
                )
            sides = [left, *others]
            for side in sides:
                _check_side(side, text)
            if not any(isinstance(side, ast.Name) for side in sides):
                raise NoLimitStateError(f"{ast.get_source_segment(text, node)} compares numbers alone: name an output")
        case ast.Name(id=name):
            if name in TOUCHDOWN:
                raise NoLimitStateError(f"{name} is a number: compare it, as in {name} > 0.1")
            if name not in FATES:
                raise NoLimitStateError(f"{name} is no name here{closest(name, (*FATES, *TOUCHDOWN))}")
        case _:
            words = ast.get_source_segment(text, node)
            raise NoLimitStateError(f"{words} is no condition: compare an output, or name what may happen")


def _check_side(node: ast.expr, text: str) -> None:
    """Raise NoLimitStateError for a side of a comparison that is neither an output nor a finite number."""
    if isinstance(node, ast.Name) and node.id not in TOUCHDOWN:
        if node.id in FATES:
            raise NoLimitStateError(f"{node.id} is true or false, and no number: write {node.id}, or not {node.id}")
        raise NoLimitStateError(f"{node.id} is no output{closest(node.id, TOUCHDOWN)}: {', '.join(TOUCHDOWN)}")
    if not isinstance(node, ast.Name) and _number(node) is None:
        raise NoLimitStateError(f"{ast.get_source_segment(text, node)} is neither an output nor a finite number")


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


def _word_and_truth(node: ast.Compare) -> tuple[str, bool] | None:
    """The word of a comparison such as `returns == false`, and whether it is to be so; None for another comparison."""
    match node:
        case ast.Compare(left=ast.Name(id=word), ops=[ast.Eq() | ast.NotEq() as op], comparators=[other]):
            said = other.id if isinstance(other, ast.Name) else str(getattr(other, "value", ""))
            if word in FATES and said.lower() in TRUTH:
                return word, TRUTH[said.lower()] == isinstance(op, ast.Eq)
    return None


def _met(node: ast.expr, values: Mapping[str, Any]) -> Met:
    """Which landings meet a condition that was checked; what is not known may be so or not (logic of three values)."""
    match node:
        case ast.BoolOp(op=op, values=parts):
            found = _met(parts[0], values)
            for part in parts[1:]:
                other = _met(part, values)
                found = (
                    Met(found.surely & other.surely, found.maybe & other.maybe)
                    if isinstance(op, ast.And)
                    else Met(found.surely | other.surely, found.maybe | other.maybe)
                )
            return found
        case ast.UnaryOp(operand=operand):
            found = _met(operand, values)
            return Met(~found.maybe, ~found.surely)
        case ast.Compare() if (word := _word_and_truth(node)) is not None:
            found = _met(ast.Name(id=word[0]), values)
            return found if word[1] else Met(~found.maybe, ~found.surely)
        case ast.Name(id=name):
            return Met(values[name] == 1.0, values[name] != 0.0)
        case ast.Compare(left=left, ops=ops, comparators=others):
            return _compared([left, *others], ops, values)
    raise AssertionError(f"{ast.dump(node)} was not checked")


def _compared(sides: list[ast.expr], operators: list[ast.cmpop], values: Mapping[str, Any]) -> Met:
    """Which landings meet a comparison of two sides or more."""
    import numpy as np

    captured = values[TouchdownOutcome.CAPTURED] == 1.0
    met, known = np.ones(len(captured), dtype=bool), np.ones(len(captured), dtype=bool)
    numbers: list[Any] = [values[side.id] if isinstance(side, ast.Name) else _number(side) for side in sides]
    for side, number in zip(sides, numbers, strict=True):
        if isinstance(side, ast.Name):
            # NaN is neither above nor below anything: a captured lander meets nothing that is said of its way out.
            absent = captured & (side.id not in ALSO_OF_CAPTURED)
            known &= np.isfinite(number) | absent
    for place, operator in enumerate(operators):
        met &= COMPARISONS[type(operator)](numbers[place], numbers[place + 1])
    return Met(known & met, ~known | met)


def _distance(node: ast.expr, values: Mapping[str, Any], scale: Mapping[str, float]) -> Any:
    """Distance of landings from meeting a condition, [count], below 0 where they do; NaN where an output is missing."""
    import numpy as np

    match node:
        case ast.BoolOp(op=op, values=parts):
            # One that is not known leaves the others of an `or` as near as they are.
            nearest = np.maximum if isinstance(op, ast.And) else np.fmin
            return nearest.reduce([_distance(part, values, scale) for part in parts])
        case ast.UnaryOp(operand=operand):
            return -_distance(operand, values, scale)
        case ast.Compare(left=left, ops=ops, comparators=others) if _word_and_truth(node) is None:
            sides = [left, *others]
            numbers: list[Any] = [values[side.id] if isinstance(side, ast.Name) else _number(side) for side in sides]
            size = max(scale[side.id] for side in sides if isinstance(side, ast.Name))
            rising = [isinstance(operator, ast.Lt | ast.LtE) for operator in ops]
            gaps = zip(rising, numbers, numbers[1:], strict=False)
            return np.maximum.reduce([(a - b if up else b - a) / size for up, a, b in gaps])
    # What is true or false has no distance.
    found = _met(node, values)
    return np.where(found.surely, -FAR, FAR)
