"""Inputs that go together, as numbers that do not: what they explain together is then that of one input."""

from collections.abc import Mapping

import numpy as np
from scipy import special, stats

from lithobrake.analysis import FailureInput
from lithobrake.results.questions import LimitStateInput
from lithobrake.study import Study
from lithobrake.study.delivery_checks import correlated_keys, drawn_apart
from lithobrake.study.delivery_sections import arrival_key
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.quantities import ARRIVAL


def taken_apart(study: Study, columns: Mapping[str, Array]) -> dict[str, Array]:
    """Columns by dotted key [run_count], with what [delivery] correlates as the independent draws that it came from.

    Terms in these are not correlated over the law of the inputs, as estimates take them to be, and functions of the
    correlated inputs together are the same as of these. Speed and incidence that follow from flights to the ground go
    together by the spread of their release: of these what the speed leaves open of the incidence takes its place.
    """
    dotted = {_dotted(key): key for key in correlated_keys(study)}
    given = {key: columns[name] for name, key in dotted.items() if name in columns}
    found = drawn_apart(study, given)
    apart = dict(columns) | {name: found[key] for name, key in dotted.items() if key in found}
    is_flown = study.delivery is not None and study.delivery.is_flown
    if is_flown and all(name in columns for name in ARRIVAL):
        first, second = (columns[name] for name in ARRIVAL)
        apart[ARRIVAL[1]] = less_first(first, second)
    return apart


def _dotted(key: str) -> str:
    return arrival_key(f"delivery.{key}")


def groups_of_inputs(study: Study) -> list[set[str]]:
    """Inputs that go together, by dotted key: those that [delivery] links by its correlations, and what follows from
    one release.
    """
    delivery = study.delivery
    if delivery is None:
        return []
    groups: list[set[str]] = [{*ARRIVAL}] if delivery.is_flown else []
    for one, other, _ in delivery.correlations or ():
        pair = {_dotted(one), _dotted(other)}
        linked = [group for group in groups if group & pair]
        groups = [group for group in groups if not group & pair] + [pair.union(*linked)]
    return groups


def significant_together(study: Study, found: Mapping[str, FailureInput]) -> dict[str, LimitStateInput]:
    """Inputs of a limit state, of which those that go together are significant where one of them is."""
    significant = {name for name, one in found.items() if one.found}
    linked = {name for group in groups_of_inputs(study) if group & significant for name in group}
    return {name: LimitStateInput(**vars(one), found=name in significant | linked) for name, one in found.items()}


def independent_columns(study: Study, columns: Mapping[str, Array]) -> Array:
    """The same as points, in the order of the columns, [run_count, input_count]."""
    return np.column_stack([*taken_apart(study, columns).values()])


def less_first(first: Array, second: Array) -> Array:
    """The values of the second in another order [count], by their normal scores less what those of the first tell."""
    scores = [special.ndtri((stats.rankdata(one) - 0.5) / len(one)) for one in (first, second)]
    if min(np.ptp(one) for one in scores) == 0.0:
        return second
    part = float(scores[0] @ scores[1]) / float(scores[0] @ scores[0])
    order = np.argsort(np.argsort(scores[1] - part * scores[0], kind="stable"), kind="stable")
    found: Array = np.sort(second)[order]
    return found
