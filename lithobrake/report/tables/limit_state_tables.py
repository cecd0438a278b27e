"""Tables of limit states, and of rare ones."""

from collections.abc import Mapping
from itertools import accumulate
from operator import mul

from lithobrake.report.content import PageTable, table_cell
from lithobrake.results.page_data import PageData
from lithobrake.results.questions import LimitStateResult, RareLimitState
from lithobrake.statements import notes
from lithobrake.statements.labels import bracket, input_words
from lithobrake.vocabulary.number_words import at_level, fixed, number, percent, with_interval

SOURCES = {"runs": "runs", "emulator": "emulator, since too few runs meet it"}
RareResults = Mapping[str, RareLimitState]


def limit_state_tables(data: PageData) -> list[PageTable]:
    """Probabilities, and inputs where the runs show any; none where the study asks for no limit state."""
    states, rare = data.results.limit_states, data.rare
    return [*([_probabilities(states), *_inputs(states)] if states else []), *rare_tables(rare)]


def _probabilities(states: Mapping[str, LimitStateResult]) -> PageTable:
    interval = f"{at_level(next(iter(states.values())).probability.level)} [%]"
    columns = ["limit state", "condition", "probability [%]", interval, "source", "runs that meet it"]
    shown = {
        "by the emulator": {name: one.emulator for name, one in states.items() if one.emulator is not None},
        "on one ground": {name: one.over_grounds for name, one in states.items() if one.over_grounds is not None},
    }
    shown = {words: found for words, found in shown.items() if found}
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
            *(with_interval(found[name]) if name in found else "" for found in shown.values()),
        ]
        for name, state in states.items()
    ]
    note = notes.limit_states(states)
    return PageTable("Limit states", [*columns, *shown], rows, note, frozenset((*columns[2:4], columns[5], *shown)))


def _inputs(states: Mapping[str, LimitStateResult]) -> list[PageTable]:
    """Inputs among the runs that meet a limit state, furthest from their distribution first."""
    rows = []
    for name, state in states.items():
        found = sorted(state.inputs.items(), key=lambda entry: -entry[1].distance.value)
        rows += [
            [
                name if place == 0 else "",
                input_words(key),
                f"{fixed(one.distance.value)}{bracket(one.distance.lower, one.distance.upper, fixed)}",
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


def rare_tables(rare: RareResults) -> list[PageTable]:
    """Probabilities and levels; none where there is no result."""
    return [_rare_probabilities(rare), _levels(rare)] if rare else []


def _rare_probabilities(rare: RareResults) -> PageTable:
    interval = at_level(next(iter(rare.values())).probability.level)
    columns = ["limit state", "condition", "probability", interval, "landings", "beds", "origins"]
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
    origins = "Origins: the effective number of beds from which the landings that meet it come."
    note = f"{notes.limit_states(rare)} {origins}"
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
