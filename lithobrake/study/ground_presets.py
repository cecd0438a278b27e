"""What is known of the ground of some bodies, as kinds of ground that a study file may name.

Sizes and laws are those of the sources in docs/howto/ground.md, read on the date there; the weights of the kinds are
choices of this project, and so are the ends of ranges that no source gives. Each is a starting point to be edited.
"""

from collections.abc import Mapping
from typing import Any

DATE = "2026-11-27"


def _between(lower: float, upper: float) -> dict[str, Any]:
    return {"distribution": "log_uniform", "lower": lower, "upper": upper}


def _kinds(
    gravel: tuple[float, float, float], stones: tuple[float, float, float], rock: float
) -> dict[str, Any]:  # fmt: skip
    """Gravel and stones, each with weight and ends of its sizes [m], and bare rock with its weight."""
    sized = {"gravel": gravel, "stones": stones}
    kinds = {name: {"weight": one[0], "grain_size": _between(*one[1:])} for name, one in sized.items() if one[0]}
    return {"kind": kinds | {"rock": {"weight": rock, "rock": True}}}


GROUND_PRESETS: Mapping[str, dict[str, Any]] = {
    "dimorphos": _kinds((0.55, 0.01, 0.3), (0.25, 0.3, 1.0), 0.2),
    "didymos": _kinds((0.7, 0.001, 0.1), (0.2, 0.1, 0.5), 0.1),
    "ryugu": _kinds((0.5, 0.01, 0.15), (0.3, 0.15, 1.0), 0.2),
    "bennu": _kinds((0.5, 0.01, 0.2), (0.3, 0.2, 1.0), 0.2),
    "itokawa": _kinds((0.3, 0.001, 0.05), (0.5, 0.05, 0.8), 0.2),
    "eros": _kinds((0.8, 0.0001, 0.05), (0.15, 0.05, 0.5), 0.05),
    "phobos": _kinds((0.95, 3e-5, 0.1), (0.0, 0.1, 0.5), 0.05),
    "apophis": _kinds((0.3, 0.001, 0.05), (0.5, 0.05, 0.8), 0.2),
}
