"""Recreate rows of the validation tables from nothing, and hold them against those that are kept here.

    python validation/recreate.py                              lists the cases: rows and CPU time
    python validation/recreate.py NAME [NAME ...]              makes all rows of these cases anew
    python validation/recreate.py NAME --rows 0 5              makes only these rows anew, counted from 0
    python validation/recreate.py NAME --within 0.05           fails if a number differs by more than 5 %
    python validation/recreate.py NAME --given FOLDER          where it reads files of others, which are in FOLDER

A case is a document beside its table that says by which command it was made. The command runs in a copy of the folders
validation, benchmarks, scenarios and docs, where the rows that are asked for were taken out of the table; scripts make
what their table lacks. Nothing of the repository is changed. The copy and the beds that a script pours stay in --work,
and beds that are there are used. Of a case without a table nothing is compared: its document is made anew. The studies
of showcase are cases too, and run whole. The list says how many quantities of validation/quantities.csv rest on a case.

--note writes what a whole case cost, and how it compared, to recreated.json beside this script; times that a document
does not keep are taken from there. The same bits come out on the machine that made a row; elsewhere single bounces
differ, and their statistics agree.
"""

import math
import os
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import ROOT, command_line, origin, read_document, read_rows, write_document, write_rows
from quantities import kept_quantities

MARK = "made_by_recreate"  # a file in a copy
COPIED = ("validation", "benchmarks", "scenarios", "docs")
PLACE = "FOLDER"  # stands in a command for a folder of beds and studies
GIVEN = ("--meshes", "--kernels", "--samples")  # options of folders with files of others, which are not kept here
COSTS = ("cpu_s_of_rows", "cpu_s_of_landings", "cpu_s")
STUDY = "origin.json"  # says how a study of showcase was made
NOTES = "recreated.json"  # in the folder of this script
# Columns that no two runs have in common.
MEASURED = {"cpu_s", "wall_s", "load", "date"}

Line = dict[str, str]


@dataclass(frozen=True)
class Case:
    """A table of the validation, or the document of a script that has none.

    path: of the document, from the root. command: that made it. cpu_s: what all its rows cost [s], None if not kept.
    """

    path: Path
    command: str
    cpu_s: float | None
    table: Path | None = None

    @property
    def name(self) -> str:
        """By which it is asked for."""
        return self.path.parent.name if self.path.name == STUDY else self.path.stem

    @property
    def reads_given(self) -> bool:
        """Whether it reads files of others."""
        return any(f"{option} {PLACE}" in self.command for option in GIVEN)

    @property
    def why_not(self) -> str | None:
        """Why one command does not recreate it; None where one does."""
        rest = self.command
        for option in ("--work", "--out", *GIVEN):
            rest = rest.replace(f"{option} {PLACE}", "")
        if PLACE in rest or "..." in rest or not rest.startswith(("python validation/", "lithobrake run scenarios/")):
            return f"it takes a folder of its own: {self.command}"
        return None


def cases(root: Path = ROOT) -> dict[str, Case]:
    """All cases below a root, by name."""
    found, notes = {}, noted(root)
    for path in sorted((root / "showcase").glob(f"*/{STUDY}")):
        content = read_document(path)
        own = Case(
            path.relative_to(root), **{key: content.get("landings", content)[key] for key in ("command", "cpu_s")}
        )
        found[own.name] = own
    for path in sorted((root / "validation").rglob("*.json")):
        content = read_document(path)
        if isinstance(content, dict) and "command" in content:
            case = _case(path, content, root, notes)
            found[case.name] = case
    return found


def _seconds(cost: float | dict[str, float]) -> float:
    """CPU time [s] of a case, of which some tell that of each part."""
    return sum(cost.values()) if isinstance(cost, dict) else float(cost)


def _case(path: Path, content: dict[str, Any], root: Path, notes: dict[str, Any]) -> Case:
    table = path.with_name(str(content.get("table", f"{path.stem}.csv")))
    own = table.relative_to(root) if table.exists() else None
    cost = next((_seconds(content[key]) for key in COSTS if content.get(key)), None)
    if cost is None and path.stem in notes:
        cost = float(notes[path.stem]["cpu_s"])
    if cost is None:
        spent = cells(content)
        spent += [float(line["cpu_s"]) for line in lines(table) if line.get("cpu_s")] if own is not None else []
        cost = sum(spent) if spent else None
    return Case(path.relative_to(root), content["command"], cost, own)


def cells(content: Any) -> list[float]:
    """Every number named cpu_s in a document, however deep."""
    if isinstance(content, list):
        return [one for part in content for one in cells(part)]
    if not isinstance(content, dict):
        return []
    own = [float(content["cpu_s"])] if isinstance(content.get("cpu_s"), int | float) else []
    return own + [one for part in content.values() for one in cells(part)]


def noted(root: Path = ROOT) -> dict[str, Any]:
    """What recreated cases cost and how they compared, by name."""
    return read_document(root / "validation" / NOTES, {})


def lines(table: Path) -> list[Line]:
    """The rows of a CSV table as text."""
    return read_rows(table, {}, str)


def expected(case: Case, rows: list[int] | None) -> str:
    cost = case.cpu_s
    if rows is not None and case.table is not None:
        costs = [lines(ROOT / case.table)[row].get("cpu_s") for row in rows]
        cost = sum(float(one) for one in costs if one) if all(costs) else None
    if cost is None:
        return "CPU time not kept"
    return f"{cost:.3g} s of CPU time" + (" and that of beds that other rows share" if rows is not None else "")


def taken_out(table: Path, rows: list[int] | None) -> tuple[list[Line], list[Line]]:
    """Take rows, or all, out of a table on disk; returns these, and those that stay."""
    kept = lines(table)
    chosen = range(len(kept)) if rows is None else rows
    gone = [kept[row] for row in chosen]
    rest = [line for number, line in enumerate(kept) if number not in chosen]
    table.unlink()
    if rest:
        write_rows(table, rest[0], rest)
    return gone, rest


def copied(folder: Path) -> Path:
    """Copy what scripts read and write into a folder; returns the root of the copy."""
    tree = folder / "tree"
    if tree.exists() and not (tree / MARK).exists():
        raise ValueError(f"{tree} is none of this script's; choose another folder with --work.")
    shutil.rmtree(tree, ignore_errors=True)
    tree.mkdir(parents=True)
    (tree / MARK).touch()
    for name in COPIED:
        shutil.copytree(ROOT / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
    return tree


def run(case: Case, tree: Path, work: Path, given: Path | None) -> tuple[float, float]:
    """Run the command of a case in a copy; returns its time on the clock and its CPU time [s]."""
    words = shlex.split(case.command)
    for number, word in enumerate(words):
        if word == PLACE:
            # Rows that stay are beside the document, and so are those that are made.
            folders = {"--out": tree / case.path.parent, "--work": work}
            words[number] = str(folders.get(words[number - 1], given))
    if words[0] == "lithobrake":
        words = ["python", "-m", *words, "--out", str(work / case.name)]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    start, spent = time.monotonic(), children_cpu()
    done = subprocess.run([sys.executable, *words[1:]], cwd=tree, env=environment, check=False)
    if done.returncode:
        raise ValueError(f"{case.name}: its script ended with exit code {done.returncode}; see what it said above.")
    return time.monotonic() - start, children_cpu() - spent


def children_cpu() -> float:
    """CPU time of the processes that this one started and that have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def gap(old: str, new: str) -> float:
    """Relative difference of two cells; infinite where texts differ."""
    if old == new:
        return 0.0
    try:
        one, other = float(old), float(new)
    except ValueError:
        return math.inf
    if one == other or (math.isnan(one) and math.isnan(other)):
        return 0.0
    if not (math.isfinite(one) and math.isfinite(other)):
        return math.inf
    return abs(one - other) / max(abs(one), abs(other))


def differences(old: list[Line], new: list[Line]) -> list[dict[str, float]]:
    """Relative differences by column of each old row from that of the new ones with which it has most cells in common.

    Columns that are measured anew in each run are left out, and so are those that are equal.
    """
    found = []
    for line in old:
        pairs = [{key: gap(line[key], other.get(key, "")) for key in line if key not in MEASURED} for other in new]
        nearest = min(pairs, key=lambda pair: sum(value > 0.0 for value in pair.values()))
        found.append({key: value for key, value in nearest.items() if value > 0.0})
    return found


def told(name: str, apart: list[dict[str, float]], spent: tuple[float, float]) -> float:
    """Print how recreated rows compare; returns the largest relative difference. spent: clock and CPU [s]."""
    same = sum(not one for one in apart)
    print(f"{name}: {len(apart)} rows in {spent[0]:.0f} s on the clock, {spent[1]:.0f} s of CPU time; ", end="")
    print(f"{same} have the same digits")
    worst: dict[str, float] = {}
    for one in apart:
        for key, value in one.items():
            worst[key] = max(worst.get(key, 0.0), value)
    for key, value in sorted(worst.items(), key=lambda item: -item[1]):
        print(f"  {key}: differs by up to {100.0 * value:.3g} %" if value < math.inf else f"  {key}: another word")
    return max(worst.values(), default=0.0)


def recreate(
    case: Case, rows: list[int] | None, work: Path, note: bool = False, within: float = math.inf,
    given: Path | None = None,
) -> float:  # fmt: skip
    """Make rows of a case anew, and print how they compare; returns the largest relative difference.

    note: keep what it cost and how it compared, if all rows were made anew. given: folder with the files of others.

    Raises ValueError where one command does not recreate the case, or where it has no such row.
    """
    if case.why_not:
        raise ValueError(f"{case.name}: {case.why_not}")
    if case.reads_given and given is None:
        raise ValueError(f"{case.name} reads files of others; name their folder with --given. It ran: {case.command}")
    if case.table is None and rows is not None:
        raise ValueError(f"{case.name} has no table of rows; leave --rows out to make all of it anew.")
    if case.table is None and math.isfinite(within):
        raise ValueError(f"{case.name} has no table to compare; leave --within out.")
    count = 0 if case.table is None else len(lines(ROOT / case.table))
    if rows is not None and not all(0 <= row < count for row in rows):
        raise ValueError(f"{case.name} has rows 0 to {count - 1}; --rows has {rows}.")
    print(f"{case.name}: expects {expected(case, rows)}", flush=True)
    tree = copied(work)
    if case.table is None:
        (tree / case.path).unlink(missing_ok=True)
        spent = run(case, tree, work / "runs", given)
        made = work / "runs" / case.name if case.path.name == STUDY else tree / case.path
        print(f"{case.name}: {spent[0]:.0f} s on the clock, {spent[1]:.0f} s of CPU time: {made}")
        if note:
            keep(case.name, spent[1], None)
        return 0.0
    old, rest = taken_out(tree / case.table, rows)
    spent = run(case, tree, work / "runs", given)
    new = lines(tree / case.table)
    if new[: len(rest)] == rest:  # otherwise the script wrote the whole table anew
        new = new[len(rest) :]
    if len(new) < len(old):
        raise ValueError(f"{case.name}: the script made {len(new)} of {len(old)} rows.")
    apart = differences(old, new)
    if note and not rest:
        keep(case.name, spent[1], apart)
    return told(case.name, apart, spent)


def keep(name: str, cpu: float, apart: list[dict[str, float]] | None) -> None:
    """Note what a case cost [s], and how many of its rows came out with the same digits."""
    same = {} if apart is None else {"rows": len(apart), "same_digits": sum(not one for one in apart)}
    entry = {"cpu_s": float(f"{cpu:.3g}"), **same, **origin(f"validation/recreate.py {name} --note")}
    write_document(ROOT / "validation" / NOTES, dict(sorted({**noted(), name: entry}.items())))


def listed(known: dict[str, Case]) -> None:
    rest_on = Counter(one.made_by for own in kept_quantities().values() for one in own)
    print(f"{'case':32} {'rows':>6} {'quantities':>10} {'CPU time [s]':>14}  made by")
    for case in known.values():
        count = "-" if case.table is None else str(len(lines(ROOT / case.table)))
        cost = "-" if case.cpu_s is None else f"{case.cpu_s:.4g}"
        print(f"{case.name:32} {count:>6} {rest_on[case.name] or '-':>10} {cost:>14}  {case.command}")


def main() -> int:
    parser = command_line(__doc__, within=math.inf)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--rows", type=int, nargs="+", help="of one case, counted from 0")
    parser.add_argument("--note", action="store_true", help="keep what whole cases cost, and how they compared")
    parser.add_argument("--given", type=Path, help="folder with the files of others that a case reads")
    parser.add_argument("--work", type=Path, help="folder of the copy and of beds; default: a new one")
    given, known = parser.parse_args(), cases()
    if not given.names:
        listed(known)
        return 0
    for name in given.names:
        if name not in known:
            parser.error(f"no case is named {name}; there are {', '.join(known)}.")
    if given.rows is not None and len(given.names) != 1:
        parser.error("--rows counts the rows of one case; name one.")
    work: Path = given.work or Path(tempfile.mkdtemp(prefix="lithobrake_recreate_"))
    try:
        largest = max(
            recreate(
                known[name], given.rows, work.resolve(), given.note, given.within, given.given and given.given.resolve()
            )
            for name in given.names
        )
    except ValueError as error:
        parser.error(str(error))
    if largest > given.within:
        print(f"A number differs by more than {100.0 * given.within:g} %.")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
