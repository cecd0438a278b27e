"""Rows of results on disk: what scripts of the experiments share.

A script takes --work, a folder for beds and paths, and --out, the folder of its table: one line a run, added as it
ends, and beside it a JSON file that says by which command, when and where.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import harness
from harness import PAGES, Row, origin, write_document

HERE = Path(__file__).parent
FIGURES = PAGES / "experiments"


def options_of(doc: str | None, here: Path = HERE, **options: Any) -> argparse.Namespace:
    """Return the options of a script in a folder, with the folders --work, made if it is not there, and --out."""
    parser = harness.command_line(doc, **options)
    parser.add_argument("--work", type=Path, required=True, help="folder for beds and paths, made if it is not there")
    parser.add_argument("--out", type=Path, default=here, help="folder of the table")
    given = parser.parse_args()
    for folder in (given.work, given.out):
        folder.mkdir(parents=True, exist_ok=True)
    return given


def read_rows(path: Path) -> list[Row]:
    """Return the rows of a table, numbers as numbers; none where it is not there."""
    return harness.read_rows(path, {}, number)


def number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def note(table: Path, row: Row) -> None:
    """Add a row to a table, and write beside it how it is made and what all its rows cost."""
    harness.add_row(table, row, digits=7)
    print(row, flush=True)
    rows = read_rows(table)
    cost = round(sum(float(row.get("cpu_s", 0.0)) for row in rows), 1)
    script = Path(sys.argv[0]).resolve()
    command = f"validation/{script.parent.name}/{script.name} --work FOLDER --out FOLDER"
    document = {"table": table.name, **origin(command), "rows": len(rows), "cpu_s_of_rows": cost}
    write_document(table.with_suffix(".json"), document)
