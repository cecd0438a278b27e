"""The forecast of the landings of Juventas and Milani on Dimorphos, from nothing: one command.

    python validation/forecast_hera/forecast.py --work FOLDER [--out FOLDER] [--workers N]

Runs the study of every branch (branches.py) on soil, and on hard ground with a restitution drawn from 0 to 1, each in a
folder of its own in --work. One that is there already, by the same code of the engine, is kept; one that was cut short
goes on. Then writes to --out: landers.csv, a line for each lander; runs.json, what each study cost; forecast.json, the
answers; and the page with its figures, which go to docs/ (and showcase/) where --out is this folder. Last it compares
the forecast with the one that stood here before.
"""

import os
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from answers import FORECAST, HERE, digest, package_files, write_answers
from branches import LANDERS, Branch, branches
from compare import comparison
from harness import Row, command_line, origin, read_document, write_document
from landers import COUNTS, RUNS, TABLE, folder_name, follow, write_landers
from write_page import DOCS, write

import showcase
from lithobrake.campaign import duration
from lithobrake.pipeline.job import Silent

# CPU time of a lander, to tell the time left [s].
LANDER_CPU = {"soil": 4.5, "hard": 0.1}
SHOWN_EVERY = 60.0  # s


class Watch(Silent):
    """Notes whether a study has work to do, and shows now and then how far it is."""

    def __init__(self) -> None:
        self.worked, self.shown = False, time.monotonic()

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        self.worked = True
        if time.monotonic() - self.shown > SHOWN_EVERY:
            self.shown = time.monotonic()
            print(f"    {what}: {done:.0f} of {total:.0f}", flush=True)


def cpu_seconds() -> float:
    """CPU time of this process and of those that it started and that have ended [s]."""
    return sum(os.times()[:4])


def expected_cpu(branch: Branch, ground: str) -> float:
    """CPU time that the landers of a branch take, roughly [s]."""
    return LANDER_CPU[ground] * branch.weight * COUNTS[ground]


def run_part(branch: Branch, ground: str, count: int, work: Path, workers: int | None) -> tuple[list[Row], Row | None]:
    """The landers of a branch on a ground, and what they cost; None where they were there already."""
    started, cpu, watch = time.perf_counter(), cpu_seconds(), Watch()
    is_new = not (work / folder_name(branch, ground)).exists()
    rows = follow(branch, ground, count, work, workers, watch)
    if not watch.worked:
        return rows, None
    cost = {"cpu_s": round(cpu_seconds() - cpu, 1), "wall_s": round(time.perf_counter() - started, 1)}
    return rows, {**cost, "from_nothing": is_new, "date": time.strftime("%Y-%m-%d"), "load": os.getloadavg()[0]}


def run_all(work: Path, workers: int | None) -> tuple[list[Row], list[Row]]:
    """The landers of all branches on both grounds, and what each study cost; the costs stay beside the studies."""
    parts = [(branch, ground) for lander in LANDERS for ground in COUNTS for branch in branches(lander)]
    path = work / RUNS
    costs: dict[str, Row] = read_document(path, {})
    landers, spent, fresh, left = [], 0.0, 0.0, sum(expected_cpu(*one) for one in parts)
    for number, (branch, ground) in enumerate(parts, 1):
        name, started = f"{branch.lander}, {branch.name}, {ground}", time.perf_counter()
        print(f"{number} of {len(parts)}: {name}", flush=True)
        rows, cost = run_part(branch, ground, COUNTS[ground], work, workers)
        landers += rows
        left -= expected_cpu(branch, ground)
        if cost is not None:
            costs[name] = {"landers": len(rows), **cost}
            write_document(path, costs)
            spent, fresh = spent + time.perf_counter() - started, fresh + expected_cpu(branch, ground)
        print(
            f"    {in_words(rows, cost)}{f'; about {duration(left * spent / fresh)} left' if fresh else ''}", flush=True
        )
    return landers, [{"study": name, **cost} for name, cost in costs.items()]


def in_words(rows: list[Row], cost: Row | None) -> str:
    rests = sum(row["end"] == "at_rest" for row in rows)
    words = f"{rests} of {len(rows)} landers at rest"
    if cost is None:
        return f"{words}; kept, made by the same code of the engine"
    return f"{words}; {duration(cost['wall_s'])}, {duration(cost['cpu_s'])} of CPU"


def main() -> None:
    options = command_line(__doc__, work=Path, out=HERE, workers=0).parse_args()
    before = read_document(HERE / FORECAST)
    for folder in (options.work, options.out):
        folder.mkdir(parents=True, exist_ok=True)
    landers, costs = run_all(options.work, options.workers or None)
    write_landers(options.out / TABLE, landers)
    totals = {key: round(sum(one[key] for one in costs)) for key in ("cpu_s", "wall_s")}
    made = {**totals, "code_sha256": digest(*package_files()), "studies": costs}
    write_document(options.out / RUNS, origin("validation/forecast_hera/forecast.py --work FOLDER") | made)
    after = write_answers(options.out)
    is_kept = options.out.resolve() == HERE
    write(options.out, DOCS if is_kept else options.out)
    if is_kept:
        showcase.keep(HERE, DOCS, showcase.FOLDER)
    print("\n".join(comparison(before, after)))


if __name__ == "__main__":
    main()
