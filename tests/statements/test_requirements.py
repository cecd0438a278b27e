"""Sentences and rows of a requirement: of the values with a result alone, and of corners at one level."""

from collections.abc import Sequence

import pytest

from lithobrake.pipeline.delivery_grid import Asked, requirement_edges
from lithobrake.results.requirement_results import RequiredDelivery, Requirement, SimulatedCorner
from lithobrake.statements.requirements import edge_rows, edge_statement, simulated_statement
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.requirement import Verdict

SPEED = "delivery.speed"
VALUES = (0.05, 0.1, 0.15, 0.2, 0.25)


def required(found: Sequence[float | None]) -> Requirement:
    """A probability of at least 0.9 over five speeds; None: outside the training range of the emulator."""
    asked = Asked(LimitState.of("distance < 30"), 0.9, 0.9, {SPEED: VALUES})
    deliveries = tuple(
        RequiredDelivery((value,), Estimate(one or 0.5, (one or 0.5) - 0.005, (one or 0.5) + 0.005), 0.0, "",
                         Verdict.OUTSIDE if one is None else Verdict.OPEN)
        for value, one in zip(VALUES, found, strict=True)
    )  # fmt: skip
    edges = requirement_edges(asked, deliveries)
    return Requirement("near", "distance < 30", 0.9, 0.9, (SPEED,), ("m/s",), (VALUES,), deliveries, edges, (), (),
                       1000, 50, 12, one_ground=False)  # fmt: skip


@pytest.mark.parametrize(("found", "said"), [
    ([0.99, 0.98, 0.97, 0.96, 0.95], "delivery.speed: every value from 0.05 to 0.25 is admissible."),
    ([0.99, 0.98, 0.97, None, None], "delivery.speed: every value from 0.05 to 0.15 is admissible; no result above "
     "0.15."),
    ([None, None, None, 0.5, 0.4], "delivery.speed: no value from 0.2 to 0.25 is admissible; no result below 0.2."),
    ([None, 0.98, 0.94, 0.86, None], "delivery.speed is admissible up to 0.175 (with confidence up to 0.172, perhaps "
     "up to 0.178); no result below 0.1 and above 0.2."),
    ([0.99, None, None, None, 0.95], "delivery.speed has no edge: between values with a result there are some "
     "without."),
    ([0.99, None, None, None, 0.5], "delivery.speed has no edge: between values with a result there are some without."),
])  # fmt: skip
def test_an_edge_speaks_of_the_values_with_a_result_alone(found: list[float | None], said: str) -> None:
    requirement = required(found)
    assert edge_statement(requirement, requirement.edges[0]) == said


def test_the_table_of_the_edges_has_the_values_with_a_result() -> None:
    titles, rows = edge_rows(required([0.99, 0.98, 0.97, None, None]))
    (row,) = (dict(zip(titles, one, strict=True)) for one in rows)
    assert (row["edge"], row["result_from"], row["result_to"]) == (float("inf"), 0.05, 0.15)
    titles, rows = edge_rows(required([None, None, None, None, 0.9]))
    (row,) = (dict(zip(titles, one, strict=True)) for one in rows)
    assert (row["edge"], row["result_from"], row["result_to"]) == ("", "", "")


def test_a_corner_names_the_level_of_both() -> None:
    landings, emulator = Estimate(0.92, 0.8, 0.97), Estimate(0.94, 0.9, 0.96)
    said = simulated_statement(required([0.99] * 5), SimulatedCorner((0.25,), 48, landings, emulator, agrees=True))
    assert said == (
        "Corner delivery.speed = 0.25: 92 % (80-97 %) of 48 simulated journeys, the emulator 94 % (90-96 %), by "
        "90 % intervals of the mean over beds; they agree."
    )
