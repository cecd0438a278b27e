"""Odd values for a key of a study: of another type, sign, unit, size, script or length, at the ends of its range."""

import math
import random
from datetime import time
from typing import Any

from lithobrake.study.quantity import LARGEST, LEAST, MaybeUncertain, Number, Numbers, Whole

HUGE = 10**400
SIZES = (
    *(1e300, -1e300, 1e-300, 1e150, 5e-324, 0.0, HUGE, 2.0**53 + 2, 1e-45, 1e45),
    *(1e-20, 1e-12, 1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9, 1e12, 1e17, 1e20),
)
NEVER_SIZES = (math.nan, math.inf, -math.inf)
UNITS = (1e3, 1e-3, math.pi / 180.0, 180.0 / math.pi, 3600.0, 1e6)
SCRIPTS = ("Ünïcode 名前 🚀", "\u202e\u2066x", "a\nb\tc", "\x00", " ", "", "x" * 20_000, "{{ x }}", "../..", "<b>&amp;",
           "CON", "%s%n", "１２", "-1", "٣")  # fmt: skip


def kinds_of(old: Any, allowed: Number | None) -> list[str]:
    both = ["type", "duplicate", "name"]
    if allowed is not None:
        both += ["end"] * 4 + ["law"] * 2 * isinstance(allowed, MaybeUncertain)
    if isinstance(old, bool):
        return both
    if isinstance(old, int | float):
        return ["sign", "unit", "size", "size", "size", "nan", "type", "duplicate", "name"]
    if isinstance(old, list):
        return [*both, "size", "sign", "nan", "length"] if any(isinstance(one, float | int) for one in old) else [
            *both, "unicode", "length"]  # fmt: skip
    return [*both, "unicode", "unicode", "unicode"] if isinstance(old, str) else both


def odd_value(chance: random.Random, kind: str, old: Any, allowed: Number | None) -> tuple[Any, bool]:
    if allowed is not None and kind in ("end", "law"):
        return (_end(chance, allowed) if kind == "end" else _law(chance, allowed)), False
    return _changed(chance, kind, old)


def _changed(chance: random.Random, kind: str, old: Any) -> tuple[Any, bool]:
    if kind == "type":
        return _other_type(chance, old)
    if kind == "unicode":
        new = chance.choice(SCRIPTS)
        return ([new, *old[1:]] if isinstance(old, list) else new), False
    if kind == "length":
        return chance.choice(([], old * 2, old[:-1], [*old, old[-1]] if old else [1])), False
    if isinstance(old, list):
        place = chance.randrange(len(old))
        inner = old[place]
        if not isinstance(inner, int | float):
            return _other_type(chance, old)
        new, never = _changed(chance, kind, inner)
        return [*old[:place], new, *old[place + 1 :]], never
    if kind == "nan":
        return chance.choice(NEVER_SIZES), True
    factor = {"sign": (-1.0,), "unit": UNITS}.get(kind)
    if factor is None:
        return chance.choice(SIZES), False
    new = (old or 1) * chance.choice(factor)
    return (round(new) if isinstance(old, int) else new), False


def _end(chance: random.Random, allowed: Number) -> Any:
    """A number at an end of what is allowed, or just within; where there is no end, the largest or least of all."""
    low = max(allowed.at_least, allowed.above)
    high = min(allowed.at_most, allowed.below)
    low_in = low if allowed.at_least >= allowed.above else math.nextafter(low, math.inf) if low else LEAST
    high_in = high if allowed.at_most <= allowed.below else math.nextafter(high, -math.inf)
    ends = [low_in if math.isfinite(low) else -LARGEST, high_in if math.isfinite(high) else LARGEST]
    found = chance.choice([*ends, 0.5 * (ends[0] + ends[1]), ends[0] + 0.1 * min(ends[1] - ends[0], 1.0)])
    if isinstance(allowed, Whole):
        return int(min(max(found, ends[0]), ends[1]))
    return [found] * allowed.count if isinstance(allowed, Numbers) else found


def _law(chance: random.Random, allowed: Number) -> Any:
    """A distribution of odd parameters in place of a number."""
    low, high = sorted((_end(chance, _of_one(allowed)), _end(chance, _of_one(allowed))))
    return chance.choice(
        [
            {"distribution": "uniform", "lower": low, "upper": high},
            {"distribution": "log_uniform", "lower": abs(low) or 1e-99, "upper": abs(high) or 1e-98},
            {
                "distribution": "log_normal",
                "mean": chance.choice((-30.0, 0.0, 30.0)),
                "std": chance.choice((1e-9, 1.0, 30.0)),
            },
            {
                "distribution": "gamma",
                "shape": chance.choice((1e-3, 1.0, 1e6)),
                "scale": chance.choice((1e-9, 1.0, 1e9)),
            },
            {"distribution": "beta", "alpha": 1e-3, "beta": 1e-3, "lower": low, "upper": high},
            {
                "distribution": "truncated_normal",
                "mean": 0.0,
                "std": chance.choice((1e-9, 1.0, 1e9)),
                "lower": low,
                "upper": high,
            },
            {"distribution": "exponential", "rate": chance.choice((1e-9, 1.0, 1e9))},
        ]
    )


def _of_one(allowed: Number) -> Number:
    """The range of one number of a list."""
    return Number(allowed.unit, allowed.above, allowed.at_least, allowed.below, allowed.at_most)


def _other_type(chance: random.Random, old: Any) -> tuple[Any, bool]:
    text = str(old) if not isinstance(old, str) else "5 m"
    others: list[Any] = [
        {},
        {"a": 1},
        [[]],
        {"distribution": "uniform"},
        [1, "x"],
        time(7, 32),
    ]
    if isinstance(old, bool):
        others += [1, 0, "true", "yes"]
    elif isinstance(old, int | float):
        others += [text, f"{text} m", True, False, [old], "nan"]
    elif isinstance(old, str):
        others += [1, 1.5, True, [old]]
    elif isinstance(old, list):
        others += ["x", True, {f"k{place}": value for place, value in enumerate(old)}]
    else:
        others += ["x", 1]
    return chance.choice(others), not isinstance(old, dict)
