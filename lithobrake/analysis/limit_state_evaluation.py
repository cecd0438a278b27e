"""Which landings meet a limit state, and how far others are from meeting it; what is not known of one may be either."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lithobrake.vocabulary.limit_state import COMPARED, Comparison, Condition, Junction, LimitState, Negation, Word
from lithobrake.vocabulary.outcomes import TouchdownOutcome

Values = Mapping[str, NDArray[np.float64]]

# Outputs that a lander has also if it is captured; all others are of its rebound, which it does not have.
ALSO_OF_CAPTURED = ("contact_duration", "penetration", "peak_acceleration", "energy_lost")
# Distances where there is none: of what is true or false alone, or is not known, and of what lies on the boundary.
FAR, NEAR = 1e30, 1e-30


class Met(NamedTuple):
    """Which landings surely meet a condition, and which may, both [count]."""

    surely: NDArray[np.bool_]
    maybe: NDArray[np.bool_]


def limit_state_met(state: LimitState, values: Values) -> NDArray[np.float64]:
    """Whether landings meet a limit state: 1, 0, or NaN where what is known does not decide, shape [count].

    values: of each name that it uses and of `captured`, [count]: outputs [SI], fates 1 or 0; NaN is not known. A
    comparison with an output of the rebound of a lander that was captured, which has none, is not met.
    """
    found = _met(state.condition, values)
    return np.where(found.surely == found.maybe, found.surely.astype(float), np.nan)


def limit_state_margin(state: LimitState, values: Values, scale: Mapping[str, float]) -> NDArray[np.float64]:
    """How far landings are from meeting a limit state, shape [count]: at most 0 where they do, FAR where not known.

    values: as for `limit_state_met`; scale: of each output that it uses, in its unit, in which distances are counted.
    """
    met = limit_state_met(state, values)
    # The sign is that of `met`, whatever a distance of several comparisons, or one of exactly 0, would have.
    size = np.maximum(np.abs(np.nan_to_num(_distance(state.condition, values, scale), nan=FAR)), NEAR)
    return np.where(met == 1.0, -size, np.where(met == 0.0, size, FAR))


def _met(condition: Condition, values: Values) -> Met:
    """Which landings meet a condition; what is not known may be so or not (logic of three values)."""
    match condition:
        case Junction(parts, needs_all):
            join = np.logical_and if needs_all else np.logical_or
            surely, maybe = zip(*(_met(part, values) for part in parts), strict=True)
            return Met(join.reduce(surely), join.reduce(maybe))
        case Negation(other):
            found = _met(other, values)
            return Met(~found.maybe, ~found.surely)
        case Word(name, is_so):
            return Met(values[name] == float(is_so), values[name] != float(not is_so))
        case Comparison():
            return _compared(condition, values)


def _compared(comparison: Comparison, values: Values) -> Met:
    """Which landings meet a comparison of two sides or more."""
    captured = values[TouchdownOutcome.CAPTURED] == 1.0
    met, known = np.ones(len(captured), dtype=bool), np.ones(len(captured), dtype=bool)
    numbers = _numbers(comparison, values)
    for side, number in zip(comparison.sides, numbers, strict=True):
        if isinstance(side, str):
            # NaN is neither above nor below anything: a captured lander meets nothing that is said of its rebound.
            absent = captured & (side not in ALSO_OF_CAPTURED)
            known &= np.isfinite(number) | absent
    for sign, left, right in zip(comparison.signs, numbers, numbers[1:], strict=False):
        met &= COMPARED[sign](left, right)
    return Met(known & met, ~known | met)


def _distance(condition: Condition, values: Values, scale: Mapping[str, float]) -> NDArray[np.float64]:
    """Distance of landings from meeting a condition, [count], below 0 where they do; NaN where an output is missing."""
    match condition:
        case Junction(parts, needs_all):
            # One that is not known leaves the others of an `or` as near as they are.
            nearest = np.maximum if needs_all else np.fmin
            return nearest.reduce([_distance(part, values, scale) for part in parts])
        case Negation(other):
            return -_distance(other, values, scale)
        case Word():
            # What is true or false has no distance.
            return np.where(_met(condition, values).surely, -FAR, FAR)
        case Comparison(sides, signs):
            numbers, size = _numbers(condition, values), max(scale[side] for side in sides if isinstance(side, str))
            pairs = zip(signs, numbers, numbers[1:], strict=False)
            gaps = [(a - b if sign in ("<", "<=") else b - a) / size for sign, a, b in pairs]
            # Two numbers beside each other have one gap for all landings.
            return np.maximum.reduce(np.broadcast_arrays(*gaps))


def _numbers(comparison: Comparison, values: Values) -> list[Any]:
    """The numbers of each side: [count] of an output, or the one that was written."""
    return [values[side] if isinstance(side, str) else side for side in comparison.sides]
