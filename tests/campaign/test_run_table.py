"""Runs in a table: what differs between them, with units, in the width of a terminal."""

import csv
import io
from pathlib import Path

import pytest

from lithobrake.campaign import Ledger, Record, read_records, run_lines, write_csv

UNITS = {"grain.young_modulus": "Pa", "grain.friction": "-", "height": "m"}
REASON = "RuntimeError: the program ended with exit code 3; its last words: the overlap grew without bound"


@pytest.fixture
def records(tmp_path: Path) -> list[Record]:
    """Two runs that differ in two of three inputs, the second failed."""
    with Ledger(tmp_path / "runs.sqlite") as ledger:
        for key, young, friction in (("first", 1e6, 0.5), ("second", 3.16228e7, 0.25)):
            inputs = {"grain.young_modulus": young, "grain.density": 2500.0, "grain.friction": friction}
            ledger.queue([(key, inputs, 1, 0)], "7")
            failed = {"status": "failed", "reason": REASON, "wall_s": 12.0}
            done = {"status": "done", "outcome": "clear", "outputs": {"height": 0.1}, "wall_s": 0.04321}
            ledger.finish(key, done if key == "first" else failed)
    return read_records(tmp_path / "runs.sqlite")


def test_runs_are_told_with_the_inputs_that_differ_and_their_units(records: list[Record]) -> None:
    assert run_lines(records, UNITS, None) == [
        "                                 grain     grain",
        "                   wall  young_modulus  friction",
        "key     status      [s]           [Pa]       [-]  outcome or reason",
        "first   done    0.04321          1e+06       0.5  clear",
        f"second  failed       12      3.162e+07      0.25  {REASON}",
    ]


def test_a_table_fits_its_terminal_and_names_what_it_leaves_out(records: list[Record]) -> None:
    wide = run_lines(records, UNITS, 90)
    assert max(map(len, wide)) == 90
    assert wide[-1].endswith("...")
    narrow = run_lines(records, UNITS, 66)
    assert "friction" not in "".join(narrow[:-1])
    assert "grain.friction" in narrow[-1]
    assert "--csv" in narrow[-1]
    heads = {"height": ("rebound", "height"), "grain.friction": ("", "friction"), "grain.density": ("", "the same")}
    shown = run_lines(records, UNITS, 72, heads)
    assert [line.split() for line in shown[:4]] == [
        ["rebound"], ["wall", "height", "friction"], ["key", "status", "[s]", "[m]", "[-]", "outcome", "or", "reason"],
        ["first", "done", "0.04321", "0.1", "0.5", "clear"],
    ]  # fmt: skip
    assert shown[-1].startswith("Differ too: grain.young_modulus")
    assert max(map(len, shown)) <= 72
    assert max(map(len, narrow)) <= 66
    none = run_lines(records, UNITS, 40)
    assert none[0].split() == ["wall"]
    assert " ".join(none[-2:]).startswith("Differ too: grain.young_modulus, grain.friction")
    assert max(map(len, none[-2:])) <= 40


def test_a_ledger_without_runs_is_a_head_alone() -> None:
    assert run_lines([], {}, 80) == ["             wall", "key  status   [s]  outcome or reason"]


def test_names_without_a_unit_stand_alone_in_csv(records: list[Record]) -> None:
    text = io.StringIO()
    write_csv(records, text, UNITS)
    titles = next(csv.reader(io.StringIO(text.getvalue())))
    assert titles[-4:] == [
        "input:grain.young_modulus [Pa]", "input:grain.density", "input:grain.friction [-]", "output:height [m]",
    ]  # fmt: skip


def test_names_and_draws_of_a_program_enter_the_csv_as_plain_text(tmp_path: Path) -> None:
    with Ledger(tmp_path / "runs.sqlite") as ledger:
        ledger.queue([("first", {"a": 1.0}, 1, 0)], "7")
        outputs, draws = {"\x1b[31mheight\ud800": 1.0}, {"licence": "\x1b]0;title\x07B"}
        ledger.finish("first", {"status": "done", "outcome": "clear", "outputs": outputs, "draws": draws})
    text = io.StringIO()
    write_csv(read_records(tmp_path / "runs.sqlite"), text)
    (row,) = csv.DictReader(io.StringIO(text.getvalue()))
    assert (row["output:height "], row["draw:licence"]) == ("1.0", "B")
    assert text.getvalue().isascii()
