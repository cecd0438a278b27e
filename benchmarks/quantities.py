"""Quantities that the validation holds against a measurement, a flight or another code: one table for all its pages.

A script that writes a page keeps the quantities of its cases in validation/quantities.csv, and counts them from the
same rows. validation/write_index.py writes the table of all cases.
"""

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple, Protocol

from harness import ROOT, write_rows
from page import yes

TABLE = ROOT / "validation" / "quantities.csv"
EXPERIMENT, FLIGHT, CODE = "experiment", "flight", "code"
NOT_SHOWN = "not shown"


class Verdict(Protocol):
    """A row of any page that agrees or not."""

    @property
    def agrees(self) -> bool: ...
    @property
    def cause(self) -> str: ...


class Quantity(NamedTuple):
    """What an experiment, a flight or another code (kind) found, what came out here, and whether a tolerance holds.

    error: the ratio of the two, or their difference, as the page states it. made_by: the case of validation/recreate.py
    that makes the number again. cause: of a quantity that disagrees, the simulations that show why, else NOT_SHOWN.
    """

    kind: str
    quantity: str
    other: str
    here: str
    error: str
    tolerance: str
    agrees: bool
    made_by: str
    cause: str = NOT_SHOWN

    @property
    def shown(self) -> str:
        """The cause, nothing where it agrees."""
        return "" if self.agrees else self.cause


COLUMNS = ("page", "case", *(name for name in Quantity._fields if name != "agrees"), "agrees")


def counts(quantities: Iterable[Verdict]) -> tuple[int, int, int, int]:
    """How many there are, how many agree, and how many disagree with a cause that is shown, and without one."""
    every = list(quantities)
    agree = sum(one.agrees for one in every)
    unknown = sum(not one.agrees and one.cause == NOT_SHOWN for one in every)
    return len(every), agree, len(every) - agree - unknown, unknown


def kept_quantities(table: Path = TABLE) -> dict[tuple[str, str], list[Quantity]]:
    """The quantities of each case, by its page and its name."""
    found: dict[tuple[str, str], list[Quantity]] = {}
    if not table.exists():
        return found
    with table.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            cells = {name: row[name] for name in Quantity._fields if name != "agrees"}
            cells["cause"] = row["cause"] or NOT_SHOWN
            own = Quantity(**cells, agrees=row["agrees"] == "yes")  # type: ignore[arg-type]
            found.setdefault((row["page"], row["case"]), []).append(own)
    return found


def keep_quantities(page: str, cases: dict[str, list[Quantity]], table: Path = TABLE) -> None:
    """Put the quantities of the cases of a page, by name, in place of those that the table has of that page."""
    others = {key: own for key, own in kept_quantities(table).items() if key[0] != page}
    every = others | {(page, case): own for case, own in cases.items()}
    write_rows(table, COLUMNS, (
        {"page": key[0], "case": key[1], **one._asdict(), "agrees": yes(one.agrees), "cause": one.shown}
        for key in sorted(every, key=lambda key: key[0]) for one in every[key]
    ))  # fmt: skip
