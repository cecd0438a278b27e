"""What scripts that measure share: options, origin of a figure, tables and documents on disk, CPU times, checkouts.

Knows nothing of lithobrake: a process that works with the package of another checkout reads this file, too.
"""

import argparse
import csv
import json
import os
import platform
import statistics
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "benchmarks" / "results"
SCENARIOS = ROOT / "scenarios"
VALIDATION_STUDIES = ROOT / "validation" / "studies"
PAGES = ROOT / "docs" / "validation"
Row = dict[str, Any]
Made = TypeVar("Made")


def origin(command: str) -> Row:
    """Return date, machine, mean load of the last minute, and a command that begins with the path of its script."""
    return {
        "date": time.strftime("%Y-%m-%d"), "machine": f"{platform.machine()}, {sys.platform}",
        "load": os.getloadavg()[0], "command": f"python {command}",
    }  # fmt: skip


def command_line(doc: str | None, *places: str, **options: Any) -> argparse.ArgumentParser:
    """Return a parser of paths in their places, one or more for a name that ends with "...", and of options.

    The value of an option is its default, and says what it reads: False is a switch, a tuple or list takes one value or
    more. A type instead of a value makes it required, and reads it.
    """
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in places:
        parser.add_argument(name.removesuffix("..."), type=Path, nargs="+" if name.endswith("...") else None)
    for name, value in options.items():
        option = f"--{name.replace('_', '-')}"
        if value is False:
            parser.add_argument(option, action="store_true")
        elif isinstance(value, type):
            parser.add_argument(option, type=value, required=True)
        elif isinstance(value, tuple | list):
            parser.add_argument(option, type=type(value[0]), nargs="+", default=value)
        else:
            # A path's own type is that of the system it is on.
            parser.add_argument(option, type=Path if isinstance(value, Path) else type(value), default=value)
    return parser


def study_tables(path: Path, *changes: Mapping[str, Row], **top: Any) -> Row:
    """The tables of a study file with other keys, in its sections and above them; a key that is None is left out."""
    tables = tomllib.loads(path.read_text(encoding="utf-8")) | top
    for part in changes:
        for name, keys in part.items():
            merged = tables.get(name, {}) | keys
            tables[name] = {key: value for key, value in merged.items() if value is not None}
    return tables


def between(lower: float, upper: float, distribution: str = "uniform") -> Row:
    """A quantity of a study file between two values."""
    return {"distribution": distribution, "lower": lower, "upper": upper}


def revision() -> str:
    """Return the commit of the checkout, with a + where files differ from it."""
    return _git("rev-parse", "--short", "HEAD") + "+" * bool(_git("status", "--porcelain", "--untracked-files=no"))


def _git(*words: str) -> str:
    return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def write_document(path: Path, content: Row) -> None:
    """Write a JSON document, whole or not at all."""
    draft = path.with_name(f"{path.name}.part")
    draft.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    draft.replace(path)


def read_document(path: Path, absent: Row | None = None) -> Row:
    """Return a JSON document; absent: what stands for one that is not there, else that raises FileNotFoundError."""
    if absent is not None and not path.exists():
        return absent
    found: Row = json.loads(path.read_text(encoding="utf-8"))
    return found


@contextmanager
def table(path: Path, columns: Iterable[str]) -> Iterator[Callable[[Row], None]]:
    """Begin a CSV table, and give what writes a row to it, at once."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(columns))
        writer.writeheader()

        def add(row: Row) -> None:
            writer.writerow(row)
            file.flush()

        yield add


def write_rows(path: Path, columns: Iterable[str], rows: Iterable[Row]) -> None:
    """Write a CSV table, a row as it comes."""
    with table(path, columns) as add:
        for row in rows:
            add(row)


def write_made(path: Path, command: str, **facts: Any) -> None:
    """Write beside a CSV table how it was made: facts, CPU time of this process, origin."""
    measured = {"cpu_s": round(time.process_time()), "table": path.name}
    write_document(path.with_suffix(".json"), facts | measured | origin(command))


def rounded(row: Row) -> Row:
    """Return a row with its numbers to four digits."""
    return {key: float(f"{value:.4g}") if isinstance(value, float) else value for key, value in row.items()}


def read_rows(path: Path, kinds: Mapping[str, Callable[[str], Any]], others: Callable[[str], Any] = float) -> list[Row]:
    """Return the rows of a CSV table, none where it is not there; kinds: what reads the values of a column."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return [{key: kinds.get(key, others)(value) for key, value in row.items()} for row in csv.DictReader(file)]


def add_row(path: Path, row: Row, digits: int | None = None) -> None:
    """Add a row to a CSV table on disk, with its head if it is the first; its numbers to so many digits."""
    with path.open("a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(row))
        if file.tell() == 0:
            writer.writeheader()
        if digits is not None:
            row = {key: f"{value:.{digits}g}" if isinstance(value, float) else value for key, value in row.items()}
        writer.writerow(row)


def timed(work: Callable[[], Made]) -> tuple[Made, float]:
    """What some work gives, and its CPU time [s]."""
    start = time.process_time()
    return work(), time.process_time() - start


def cpu_seconds(work: Callable[[], object], repeats: int) -> float:
    """Median CPU time of some calls [s]."""
    return statistics.median(timed(work)[1] for _ in range(repeats))


class Checkout:
    """A process of a script that works with the package of one checkout: it answers each line that comes in with one.

    folder: of the checkout. option: tells the script to work.
    """

    def __init__(self, folder: Path, script: str, option: str) -> None:
        environment = os.environ | {"PYTHONPATH": str(folder.resolve()), "OMP_NUM_THREADS": "1"}
        command = [sys.executable, str(Path(script).resolve()), option]
        self.process = subprocess.Popen(
            command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def answer(self, one: Row) -> Row:
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(json.dumps(one) + "\n")
        self.process.stdin.flush()
        row: Row = json.loads(self.process.stdout.readline())
        return row


def answer_lines(prepared: Callable[[Row], Callable[[], Row]]) -> None:
    """Do the work of a Checkout: prepare each piece, then do it, and answer with its row and its CPU time."""
    for line in sys.stdin:
        work = prepared(json.loads(line))
        start = time.process_time()
        try:
            row = work()
        except (ValueError, FloatingPointError) as error:
            row = {"outcome": f"failed: {error}"}
        print(json.dumps(row | {"cpu_s": time.process_time() - start}), flush=True)


def in_turn(
    checkouts: Mapping[str, Checkout], pieces: Iterable[dict[str, Row]], first: int, columns: list[str], out: Path,
    command: str, unit: str,
) -> None:  # fmt: skip
    """Have checkouts "old" and "new" do pieces in turn, each its own; write their rows and sums, and tell the ratio.

    first: number of the first piece, in the first column. unit: what pieces are, in the plural.
    """
    sums, count = dict.fromkeys(checkouts, 0.0), 0
    with table(out.with_suffix(".csv"), columns) as add:
        for count, piece in enumerate(pieces, 1):
            for name, checkout in checkouts.items():
                row = checkout.answer(piece[name])
                sums[name] += row["cpu_s"]
                add({columns[0]: first + count - 1, "checkout": name, **row})
            write_document(out.with_suffix(".json"), {**origin(command), unit: count, "cpu_s": sums})
    old, new = sums["old"], sums["new"]
    print(f"{count} {unit}: {old:.1f} s and {new:.1f} s of CPU: 1 / {old / new:.2f}")
