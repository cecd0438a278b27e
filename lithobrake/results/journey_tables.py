"""The tables of a study's journeys: one row a journey, and one row a touchdown with its inputs, outputs and cost."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from lithobrake.vocabulary.quantities import JOURNEY, JOURNEYS_FILE, TOUCHDOWN_COST, TOUCHDOWNS_FILE

if TYPE_CHECKING:
    from lithobrake.campaign import Record

JOURNEYS, TOUCHDOWNS, TOUCHDOWN_RUNS = JOURNEYS_FILE, TOUCHDOWNS_FILE, "designs/touchdowns.csv"
# Columns that every table of journeys has; one of an earlier version lacks attitudes.
NEEDED = tuple(name for name in JOURNEY if not name.startswith("attitude_"))
# Columns of the runs that the table of touchdowns has already.
_TWICE = ("input:journey", "input:touchdown", "key", "outcome")


def joined_touchdowns(
    touchdowns: Sequence[Mapping[str, Any]], runs: Iterable[Mapping[str, Any]], ledger: "Iterable[Record]"
) -> list[dict[str, Any]]:
    """Rows of touchdowns.csv, each with the inputs and outputs of its run, by its key, and what that cost.

    A touchdown whose run is in neither has nothing there.
    """
    by_key = {row["key"]: {name: cell for name, cell in row.items() if _of_run(name)} for row in runs}
    costs = {record.key: {name: _cost(record, name) for name in TOUCHDOWN_COST} for record in ledger}
    return [{**row, **by_key.get(row["key"], {}), **costs.get(row["key"], {})} for row in touchdowns]


def _of_run(name: str) -> bool:
    """Whether a column of a design is only in there."""
    return name.split(" ")[0] not in _TWICE


def _cost(record: "Record", name: str) -> float:
    value = getattr(record, name)
    return math.nan if value is None else float(value)
