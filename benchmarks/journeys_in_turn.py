"""The same journeys by two checkouts of the project: what they cost, and whether they end alike.

    git worktree add OLD fb506b9
    python benchmarks/journeys_in_turn.py OLD . --work FOLDER --study scenarios/one_ground.toml --out FILE

Either checkout makes the study in a folder of its own below --work, where one that was stopped goes on and one that is
complete is only read; with --run they are first run, one after the other. FILE.csv gets a row a journey and checkout.
FILE.json: CPU time of all touchdowns from the ledgers, and the journeys in pairs: how many are the same to the last
bit, ends with p of McNemar's exact test, sides down with p of the chi-square test, and mean difference, standard error
and p of Wilcoxon's signed-rank test of what a journey comes to.
"""

import json
import math
import os
import sqlite3
import subprocess
import sys
from collections import Counter, defaultdict
from pathlib import Path

import numpy as np
from harness import Row, command_line, origin, read_rows, write_document, write_rows
from scipy.stats import binomtest, chi2_contingency, wilcoxon

COMPARED = ("time_s", "distance [m]", "path_length [m]", "contacts", "tilt_deg")
COLUMNS = ["journey", "checkout", "end", "face", "touchdowns", "cpu_s", *COMPARED]


def run(checkout: Path, study: Path, folder: Path) -> None:
    environment = os.environ | {"PYTHONPATH": str(checkout.resolve())}
    command = [sys.executable, "-m", "lithobrake", "run", str(study.resolve()), "--out", str(folder.resolve())]
    subprocess.run(command, env=environment, cwd=checkout, check=True)


def costs(folder: Path) -> dict[int, float]:
    """CPU time [s] of the touchdowns of each journey."""
    found: dict[int, float] = defaultdict(float)
    with sqlite3.connect(f"file:{folder / 'runs.sqlite'}?mode=ro", uri=True) as ledger:
        for inputs, cpu in ledger.execute("SELECT inputs, cpu_s FROM runs WHERE cpu_s IS NOT NULL"):
            if (journey := json.loads(inputs).get("journey")) is not None:
                found[int(journey)] += cpu
    return found


def journeys(name: str, folder: Path) -> list[Row]:
    """The journeys of a folder, in the order of their numbers."""
    texts = dict.fromkeys(("end", "face", "reason"), str) | dict.fromkeys(("journey", "bed", "touchdowns"), int)
    rows = read_rows(folder / "journeys.csv", texts, lambda value: float(value or math.nan))
    cpu = costs(folder)
    rows = [row | {"checkout": name, "cpu_s": cpu[row["journey"]]} for row in rows]
    return [{key: row[key] for key in COLUMNS} for row in sorted(rows, key=lambda row: row["journey"])]


def compared(old: list[Row], new: list[Row], name: str) -> Row:
    """Pairs in which both have a value, and how the second differs from the first."""
    x, y = (np.array([row[name] for row in rows]) for rows in (old, new))
    both = np.isfinite(x) & np.isfinite(y)
    x, y = x[both], y[both]
    difference = y - x
    return {
        "pairs": int(both.sum()), "mean": float(x.mean()), "median": float(np.median(x)),
        "median_new": float(np.median(y)), "difference": float(difference.mean()),
        "error": float(difference.std(ddof=1) / math.sqrt(len(x))),
        "p": float(wilcoxon(x, y).pvalue) if difference.any() else 1.0,
    }  # fmt: skip


def summary(old: list[Row], new: list[Row]) -> Row:
    """What both came to, side by side."""
    pairs = list(zip(old, new, strict=True))
    alone = [sum(a["end"] == "at_rest" != b["end"] for a, b in some) for some in (pairs, [p[::-1] for p in pairs])]
    faces = [Counter(row["face"] for row in rows if row["face"]) for rows in (old, new)]
    table = [[some[face] for face in sorted(set().union(*faces))] for some in faces]
    return {
        "journeys": len(pairs),
        "cpu_s": {row[0]["checkout"]: sum(one["cpu_s"] for one in row) for row in (old, new)},
        "touchdowns": {row[0]["checkout"]: sum(one["touchdowns"] for one in row) for row in (old, new)},
        "unchanged": sum(a["time_s"] == b["time_s"] for a, b in pairs),
        "ends": [dict(Counter(row["end"] for row in rows)) for rows in (old, new)],
        "at_rest_old_alone": alone[0], "at_rest_new_alone": alone[1],
        "at_rest_p": float(binomtest(alone[0], sum(alone)).pvalue) if sum(alone) else 1.0,
        "faces": [dict(sorted(some.items())) for some in faces],
        "same_face": sum(a["face"] == b["face"] != "" for a, b in pairs),
        "faces_p": float(chi2_contingency(table).pvalue),
    } | {name: compared(old, new, name) for name in COMPARED}  # fmt: skip


def main() -> None:
    given = command_line(__doc__, "old", "new", work=Path, study=Path, out=Path, run=False).parse_args()
    if given.run:
        for name in ("old", "new"):
            run(getattr(given, name), given.study, given.work / name)
    rows = [journeys(name, given.work / name) for name in ("old", "new")]
    write_rows(given.out.with_suffix(".csv"), COLUMNS, (row for one in zip(*rows, strict=True) for row in one))
    command = f"benchmarks/journeys_in_turn.py OLD . --work FOLDER --study scenarios/{given.study.name}"
    write_document(given.out.with_suffix(".json"), origin(command) | summary(*rows))


if __name__ == "__main__":
    main()
