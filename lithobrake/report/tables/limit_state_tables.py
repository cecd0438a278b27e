"""The tables of the limit states that a study file asks for: how probable, and which inputs make them."""

from collections.abc import Mapping

from lithobrake.report.content import PageTable
from lithobrake.report.page_data import DrawnPage
from lithobrake.report.words.captions import input_words
from lithobrake.report.words.numbers import fixed, number, table_cell
from lithobrake.results.limit_state_results import LimitStateResult
from lithobrake.vocabulary.percentages import percent

SOURCES = {"runs": "runs", "emulator": "emulator, since too few runs meet it"}


def limit_state_tables(data: DrawnPage) -> list[PageTable]:
    """Probabilities, and inputs where runs tell of any; none where the study asks for no limit state."""
    states = data.results.limit_states
    return [_probabilities(states), *_inputs(states)] if states else []


def _probabilities(states: Mapping[str, LimitStateResult]) -> PageTable:
    level = percent(next(iter(states.values())).level)
    columns = ["limit state", "condition", "probability [%]", f"{level} interval [%]", "source", "runs that meet it"]
    rows = [
        [
            name,
            state.condition,
            _percentage(state.probability),
            " to ".join(_percentage(end) for end in (state.lower, state.upper) if end is not None) or "none",
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
        found = sorted(state.inputs.items(), key=lambda entry: -entry[1].distance)
        rows += [
            [
                name if place == 0 else "",
                input_words(key),
                f"{fixed(one.distance)} ({fixed(one.lower)} to {fixed(one.upper)})",
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
