"""The tables of limit states, and of those that are rare."""

from collections.abc import Mapping
from itertools import accumulate
from operator import mul

from lithobrake.report.content import PageTable
from lithobrake.report.page_data import DrawnPage
from lithobrake.report.words.captions import input_words
from lithobrake.report.words.numbers import fixed, number, table_cell
from lithobrake.results.questions import LimitStateResult, RareLimitState
from lithobrake.vocabulary.percentages import percent

SOURCES = {"runs": "runs", "emulator": "emulator, since too few runs meet it"}


def limit_state_tables(data: DrawnPage) -> list[PageTable]:
    """Probabilities, and inputs where runs tell of any; none where the study asks for no limit state."""
    states = data.results.limit_states
    return [_probabilities(states), *_inputs(states)] if states else []


def _probabilities(states: Mapping[str, LimitStateResult]) -> PageTable:
    level = percent(next(iter(states.values())).probability.level)
    columns = ["limit state", "condition", "probability [%]", f"{level} interval [%]", "source", "runs that meet it"]
    rows = [
        [
            name,
            state.condition,
            _percentage(state.probability.value),
            " to ".join(
                _percentage(end) for end in (state.probability.lower, state.probability.upper) if end is not None
            )
            or "none",
            SOURCES[state.source],
            number(state.failing_runs),
        ]
        for name, state in states.items()
    ]
    note = " ".join(state.statement for state in states.values())
    return PageTable("Limit states", columns, rows, note, frozenset((*columns[2:4], columns[5])))


def _inputs(states: Mapping[str, LimitStateResult]) -> list[PageTable]:
    """Inputs among the runs that meet a limit state, furthest from their distribution first."""
    rows = []
    for name, state in states.items():
        found = sorted(state.inputs.items(), key=lambda entry: -entry[1].distance.value)
        rows += [
            [
                name if place == 0 else "",
                input_words(key),
                f"{fixed(one.distance.value)} ({' to '.join(map(fixed, one.distance.bounds or ()))})",
                fixed(one.luck),
                table_cell(one.median),
                table_cell(one.median_of_all),
                "yes" if one.found else "no",
            ]
            for place, (key, one) in enumerate(found)
        ]
    columns = [
        *("limit state", "input", "distance from its distribution", "critical distance"),
        *("median if met", "median of its distribution", "significant"),
    ]
    note = (
        "Distance: the largest difference of the distribution functions of the input among the runs that meet the "
        "limit state and over all landings (Kolmogorov's), in brackets its interval. Significant: above the critical "
        "distance, which chance alone exceeds in one of ten studies, all inputs together. Medians in the unit of the "
        "study file."
    )
    return [PageTable("Inputs of the limit states", columns, rows, note, frozenset(columns[2:6]))] if rows else []


def _percentage(share: float) -> str:
    return number(100.0 * share)


RareResults = Mapping[str, RareLimitState]


def rare_tables(rare: RareResults) -> list[PageTable]:
    """Probabilities and levels; none where there is no result."""
    return [_rare_probabilities(rare), _levels(rare)] if rare else []


def _rare_probabilities(rare: RareResults) -> PageTable:
    level = percent(next(iter(rare.values())).probability.level)
    columns = ["limit state", "condition", "probability", f"{level} interval", "landings", "beds", "origins"]
    rows = [
        [
            name,
            found.condition,
            number(found.probability.value) if found.reached else f"below {number(found.rarest)}",
            " to ".join(number(end) for end in (found.probability.lower, found.probability.upper) if end is not None)
            or "none",
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
