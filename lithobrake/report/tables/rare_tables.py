"""What `lithobrake rare` found, in words and tables: probabilities, the levels down to them, and what weakens them."""

from collections.abc import Mapping
from itertools import accumulate
from operator import mul
from typing import Any

from lithobrake.report.pages.html import PageTable, fixed, number
from lithobrake.vocabulary.percentages import percent

RareResults = Mapping[str, Mapping[str, Any]]


def rare_caption(rare: RareResults) -> str:
    """The sentence of the figure."""
    named = ", ".join(f"{name} ({found['condition']})" for name, found in rare.items())
    return (
        f"Subset simulation with landings of {named}: each point is a level, at whose threshold the next one begins "
        "with the landings that came nearer; at 0 the limit state is met. Bars are 90 % intervals."
    )


def rare_warnings(rare: RareResults) -> list[str]:
    """Where the same with another seed may give quite another probability."""
    return [f"{name}: {found['warning']}" for name, found in rare.items() if found["warning"]]


def rare_tables(rare: RareResults) -> list[PageTable]:
    """Probabilities and levels; none where there is no result."""
    return [_probabilities(rare), _levels(rare)] if rare else []


def _probabilities(rare: RareResults) -> PageTable:
    columns = ["limit state", "met where", "probability", "90 % interval", "landings", "beds", "origins"]
    rows = [
        [
            name,
            found["condition"],
            number(found["probability"]) if found["reached"] else f"below {number(found['rarest'])}",
            "none" if found["lower"] is None else f"{number(found['lower'])} to {number(found['upper'])}",
            *(number(found[key]) for key in ("landings", "beds")),
            fixed(found["origins"], 1),
        ]
        for name, found in rare.items()
    ]
    note = " ".join(found["statement"] for found in rare.values())
    note += " Origins: how many beds of one size the landings that meet it come from."
    return PageTable("Rare limit states", columns, rows, note, frozenset(columns[2:]))


def _levels(rare: RareResults) -> PageTable:
    columns = ["limit state", "level", "threshold", "share nearer", "probability so far"]
    rows = [
        [name if level == 0 else "", str(level + 1), fixed(threshold), percent(share, 1), number(left)]
        for name, found in rare.items()
        for level, (threshold, share, left) in enumerate(
            zip(found["thresholds"], found["shares"], accumulate(found["shares"], mul), strict=True)
        )
    ]
    note = "Thresholds: distance from the limit, in standard deviations of the outputs of the first level."
    return PageTable("Levels of the rare limit states", columns, rows, note, frozenset(columns[1:]))
