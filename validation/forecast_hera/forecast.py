"""The forecast of the landings of Juventas and Milani on Dimorphos, from nothing: one command.

    python validation/forecast_hera/forecast.py --work FOLDER [--out FOLDER] [--workers N] [--measurements FILE]
        [--assumptions NAME]

Runs the study of every branch (branches.py) on soil, and on hard ground with a restitution drawn from 0 to 1, each in a
folder of its own in --work. One that is there already, by the same code of the engine, is kept; one that was cut short
goes on. Then writes to --out, WORK/forecast where it is not given: landers.csv, a line for each lander; runs.json, what
each study cost; forecast.json, the answers; and the page with its figures. Last it compares the forecast with the first
edition. With measurements their values stand in the studies in place of assumptions. Answers and page of these, and of
other assumptions than the first (assumptions.py), are left to the edition that is made of the landers (edition.py
--landers).
"""

import os
import shutil
import sys
import time
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from answers import FIRST_EDITION, FORECAST, HERE, digest, package_files, write_answers
from assumptions import ASSUMPTIONS, FIRST, Assumptions
from branches import LANDERS, SCENARIOS, Branch
from compare import comparison
from harness import Row, command_line, origin, read_document, write_document
from landers import RUNS, TABLE, folder_name, follow, write_landers
from measured_branches import simulated_branches
from measurements import DRAWN, Measurement, read_measurements
from write_page import write

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


def expected_cpu(branch: Branch, ground: str, assumptions: Assumptions) -> float:
    """CPU time that the landers of a branch take, roughly [s]."""
    return LANDER_CPU[ground] * branch.weight * assumptions.counts[ground]


def run_part(
    branch: Branch,
    ground: str,
    count: int,
    work: Path,
    workers: int | None,
    assumptions: Assumptions = FIRST,
    measurements: Sequence[Measurement] = (),
) -> tuple[list[Row], Row | None]:
    """The landers of a branch on a ground, and what they cost; None where they were there already."""
    started, cpu, watch = time.perf_counter(), cpu_seconds(), Watch()
    is_new = not (work / folder_name(branch, ground)).exists()
    rows = follow(branch, ground, count, work, workers, watch, assumptions, measurements)
    if not watch.worked:
        return rows, None
    cost = {"cpu_s": round(cpu_seconds() - cpu, 1), "wall_s": round(time.perf_counter() - started, 1)}
    return rows, {**cost, "from_nothing": is_new, "date": time.strftime("%Y-%m-%d"), "load": os.getloadavg()[0]}


def run_all(
    work: Path, workers: int | None, measurements: Sequence[Measurement] = (), assumptions: Assumptions = FIRST
) -> tuple[list[Row], list[Row]]:
    """The landers of all branches on both grounds, and what each study cost; the costs stay beside the studies."""
    chosen = {lander: simulated_branches(lander, measurements) for lander in LANDERS}
    parts = [(branch, ground) for lander in LANDERS for ground in assumptions.counts for branch in chosen[lander]]
    path = work / RUNS
    costs: dict[str, Row] = read_document(path, {})
    landers, spent, fresh, left = [], 0.0, 0.0, sum(expected_cpu(*one, assumptions) for one in parts)
    for number, (branch, ground) in enumerate(parts, 1):
        name, started = f"{branch.lander}, {branch.name}, {ground}", time.perf_counter()
        print(f"{number} of {len(parts)}: {name}", flush=True)
        rows, cost = run_part(branch, ground, assumptions.counts[ground], work, workers, assumptions, measurements)
        landers += rows
        left -= expected_cpu(branch, ground, assumptions)
        if cost is not None:
            costs[name] = {"landers": len(rows), **cost}
            write_document(path, costs)
            spent, fresh = spent + time.perf_counter() - started, fresh + expected_cpu(branch, ground, assumptions)
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
    parser = command_line(__doc__, work=Path, workers=0)
    for name in ("out", "measurements"):
        parser.add_argument(f"--{name}", type=Path)
    parser.add_argument("--assumptions", choices=ASSUMPTIONS, default=FIRST.name)
    options = parser.parse_args()
    out = options.out or options.work / "forecast"
    if out.resolve() == HERE or FIRST_EDITION.parent in out.resolve().parents:
        raise SystemExit(f"--out is {out}; allowed: a folder elsewhere, as editions are never edited; name another")
    for folder in (options.work, out):
        folder.mkdir(parents=True, exist_ok=True)
    assumptions = ASSUMPTIONS[options.assumptions]
    try:
        measurements = read_measurements(options.measurements) if options.measurements else ()
        assumptions.refuse_unused(measurements)
    except ValueError as error:
        raise SystemExit(str(error)) from error
    landers, costs = run_all(options.work, options.workers or None, measurements, assumptions)
    write_landers(out / TABLE, landers)
    totals = {key: round(sum(one[key] for one in costs)) for key in ("cpu_s", "wall_s")}
    studies = {name: digest(SCENARIOS / f"{name}.toml") for name in LANDERS}
    made = {**totals, "code_sha256": digest(*package_files()), "studies_sha256": studies, "studies": costs}
    words = f'forecast.py --work FOLDER --assumptions "{assumptions.name}"'
    write_document(
        out / RUNS, origin(f"validation/forecast_hera/{words}") | {"assumptions": assumptions.name} | made
    )  # fmt: skip
    if measurements:
        shutil.copy(options.measurements, out / DRAWN)
    if measurements or assumptions is not FIRST:
        file = options.measurements or HERE / "measurements.toml"
        print(f"edition: python validation/forecast_hera/edition.py {file} --landers {out}")
        return
    after = write_answers(out)
    write(out, out)
    print("\n".join(comparison(read_document(FIRST_EDITION / FORECAST), after)))


if __name__ == "__main__":
    main()
