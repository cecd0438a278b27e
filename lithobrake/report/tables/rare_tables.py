"""What `lithobrake rare` found, in words and tables: probabilities, the levels down to them, and what weakens them."""

from collections.abc import Mapping
from itertools import accumulate
from operator import mul

from lithobrake.report.content import PageTable
from lithobrake.report.words.numbers import fixed, number
from lithobrake.results.limit_state_results import RareLimitState
from lithobrake.vocabulary.percentages import percent

RareResults = Mapping[str, RareLimitState]


def rare_tables(rare: RareResults) -> list[PageTable]:
    """Probabilities and levels; none where there is no result."""
    return [_probabilities(rare), _levels(rare)] if rare else []


def _probabilities(rare: RareResults) -> PageTable:
    level = percent(next(iter(rare.values())).level)
    columns = ["limit state", "condition", "probability", f"{level} interval", "landings", "beds", "origins"]
    rows = [
        [
            name,
            found.condition,
            number(found.probability) if found.reached else f"below {number(found.rarest)}",
            " to ".join(number(end) for end in (found.lower, found.upper) if end is not None) or "none",
            number(found.landings),
            number(found.beds),
            fixed(found.origins, 1),
        ]
        for name, found in rare.items()
    ]
    note = " ".join(found.statement for found in rare.values())
    note += " Origins: the effective number of beds from which the landings that meet it come."
    return PageTable("Rare limit states", columns, rows, note, frozenset(columns[2:]))


def _levels(rare: RareResults) -> PageTable:
    columns = ["limit state", "level", "threshold", "fraction nearer the limit", "probability so far"]
    rows = [
        [name if level == 0 else "", str(level + 1), fixed(threshold), percent(share, 1), number(left)]
        for name, found in rare.items()
        for level, (threshold, share, left) in enumerate(
            zip(found.thresholds, found.shares, accumulate(found.shares, mul), strict=True)
        )
    ]
    note = "Thresholds: distance from the limit, in standard deviations of the outputs of the first level."
    return PageTable("Levels of the rare limit states", columns, rows, note, frozenset(columns[1:]))
