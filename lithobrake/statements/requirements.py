"""A requirement in sentences and in rows of its tables: which deliveries meet it, and where that ends."""

import math
from collections.abc import Iterable, Sequence
from typing import Any

from lithobrake.results.requirement_results import Requirement, RequirementEdge, SimulatedCorner
from lithobrake.vocabulary.number_words import intervals, listing, number, out_of, percent, with_interval
from lithobrake.vocabulary.requirement import Verdict

Table = tuple[list[str], Iterable[Sequence[Any]]]


def requirement_statement(found: Requirement) -> str:
    """How many of the deliveries meet a requirement, and by which intervals."""
    total, met = len(found.deliveries), found.count(Verdict.MET)
    rest = {
        "do not": found.count(Verdict.NOT_MET),
        "are open": found.count(Verdict.OPEN),
        "have no result, as their impacts are outside the training range of the emulator": found.count(Verdict.OUTSIDE),
    }
    others = [f"{count} {words}" for words, count in rest.items() if count]
    whose = "of one ground" if found.one_ground else "over beds"
    said = (
        f"{out_of(met, total, 'deliveries')} meet {found.name} ({found.condition}) with a probability of at least "
        f"{percent(found.required)}, by {intervals(found.level)} {whose}"
    )
    return f"{said}; {listing(others)}." if others else f"{said}."


def edge_statement(found: Requirement, one: RequirementEdge) -> str:
    """Up to which of its values with a result a parameter meets a requirement, or from which on."""
    name, edge = found.names[one.along], one.edge
    pairs = [(key, value) for key, value in zip(found.names, one.values, strict=True) if value is not None]
    where = f", where {listing([f'{key} is {number(value)}' for key, value in pairs])}" if pairs else ""
    if edge.why is not None or edge.known is None:
        return f"{name} has no edge: {edge.why}{where}."
    (first, last), where = edge.known, f"{where}{_without_result(found.grid[one.along], edge.known)}"
    kept, side = f"from {number(first)} to {number(last)}", "up to" if edge.falls else "from"
    if math.isinf(edge.value):
        is_met = (edge.value > 0.0) == edge.falls
        sure = edge.sure if is_met else edge.possible
        if math.isinf(sure):
            return f"{name}: {'every' if is_met else 'no'} value {kept} is admissible{where}."
        if is_met:
            return f"{name} is admissible {kept}, with confidence {side} {number(sure)}{where}."
        return f"{name}: no value {kept} is admissible, and none beyond {number(sure)} can be{where}."
    ends = [_end(one, value) for value in (edge.sure, edge.possible)]
    return f"{name} is admissible {side} {number(edge.value)} (with confidence {ends[0]}, perhaps {ends[1]}){where}."


def _without_result(values: Sequence[float], known: tuple[float, float]) -> str:
    """Where values of a parameter have no result; nothing where all have one."""
    first, last = known
    sides = [f"below {number(first)}"] * (values[0] < first) + [f"above {number(last)}"] * (last < values[-1])
    return f"; no result {listing(sides)}" if sides else ""


def _end(one: RequirementEdge, value: float) -> str:
    """An end of the interval of an edge; where it lies beyond the values, what that says of them."""
    if math.isfinite(value):
        return f"{'up to' if one.edge.falls else 'from'} {number(value)}"
    return "everywhere" if (value > 0.0) == one.edge.falls else "nowhere"


def simulated_statement(found: Requirement, one: SimulatedCorner) -> str:
    """What simulated journeys give at a corner, beside the emulator, both as means over beds at one level."""
    where = listing([f"{key} = {number(value)}" for key, value in zip(found.names, one.values, strict=True)])
    said = (
        f"Corner {where}: {with_interval(one.landings)} of {one.journeys} simulated journeys, the emulator "
        f"{with_interval(one.emulator)}, by {intervals(one.landings.level)} of the mean over beds"
    )
    return f"{said}." if one.agrees is None else f"{said}; they {'agree' if one.agrees else 'disagree'}."


def delivery_rows(found: Requirement) -> Table:
    """The table of the deliveries: titles, and a row for each."""
    titles = [*_titles(found), "probability", "lower", "upper", "unknown", "beyond", "verdict"]
    rows = (
        [*one.values, _blank(one.probability.value), one.probability.lower, one.probability.upper, one.unknown,
         one.beyond, one.verdict.value]
        for one in found.deliveries
    )  # fmt: skip
    return titles, rows


def edge_rows(found: Requirement) -> Table:
    """The table of the edges: titles, and a row for each; an edge beyond the values with a result is -inf or inf."""
    titles = ["along", *_titles(found), "admissible", "edge", "edge_sure", "edge_possible", "why_none"]
    titles += ["result_from", "result_to"]
    rows = (
        [found.names[one.along], *("" if value is None else value for value in one.values),
         "" if one.edge.why else "up to" if one.edge.falls else "from",
         *(_blank(value) for value in (one.edge.value, one.edge.sure, one.edge.possible)), one.edge.why or "",
         *(one.edge.known or ("", ""))]
        for one in found.edges
    )  # fmt: skip
    return titles, rows


def simulated_rows(found: Requirement) -> Table:
    """The table of the corners: titles, and a row for each."""
    titles = [*_titles(found), "journeys", "landings", "landings_lower", "landings_upper"]
    titles += ["emulator", "emulator_lower", "emulator_upper", "agrees"]
    rows = (
        [*one.values, one.journeys, one.landings.value, one.landings.lower, one.landings.upper, one.emulator.value,
         one.emulator.lower, one.emulator.upper, "" if one.agrees is None else str(one.agrees).lower()]
        for one in found.simulated
    )  # fmt: skip
    return titles, rows


def _titles(found: Requirement) -> list[str]:
    """The parameters with their units."""
    return [f"{name} [{unit}]" if unit else name for name, unit in zip(found.names, found.units, strict=True)]


def _blank(value: float) -> float | str:
    return "" if math.isnan(value) else value
