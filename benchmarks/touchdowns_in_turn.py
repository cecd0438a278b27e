"""CPU time of first touchdowns to rest by two checkouts of the project, side by side on the same beds.

    git worktree add OLD 2c481aac
    python benchmarks/touchdowns_in_turn.py OLD . --beds BED_FOLDER --out FILE

COUNT touchdowns of the study of one ground, every third journey, by a process of each checkout; both run at the same
time, so that other work on the machine slows both. BED_FOLDER holds bed_0.h5 and so on, poured by any engine. FILE.csv
gets a row a touchdown and checkout as it comes; FILE.json their sums, the ratio of these with an interval of 90 % by
resampling touchdowns, and how many were captured.
"""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from harness import Row, command_line, origin, read_rows, table, timed, write_document

COUNT, EVERY, RESAMPLES = 40, 3, 2000
# The study of one ground had the name of the quick study before the ground could be unknown.
STUDIES = ("one_ground.toml", "quick.toml")
COLUMNS = ["checkout", "touchdown", "outcome", "simulated_s", "cpu_s"]


def arrivals(beds: Path) -> Iterator[tuple[int, Any, Any, Any]]:
    """Number, bed, lander and landing of the touchdowns, by the package at hand."""
    from lithobrake.pipeline.design.drawn_design import DrawnDesign
    from lithobrake.pipeline.site import with_site_gravity
    from lithobrake.study import read_study
    from lithobrake.touchdown import Bed

    try:
        from lithobrake.touchdown.lander_model import lander
        from lithobrake.touchdown.touchdown_model import landing
    except ImportError:
        from lithobrake.study.touchdown_model import lander, landing  # type: ignore[import-not-found,no-redef]
    scenarios = Path(sys.modules["lithobrake"].__path__[0]).parent / "scenarios"
    path = next(scenarios / name for name in STUDIES if (scenarios / name).is_file())
    study = with_site_gravity(read_study(path).with_run_count(EVERY * COUNT))
    for number, row in list(enumerate(DrawnDesign(study).rows))[::EVERY]:
        yield number, Bed.load(beds / f"bed_{round(row['bed'])}.h5"), lander(study, row), landing(study, row)


def measure(name: str, beds: Path, out: Path) -> None:
    """Land with the package at hand, and add a row for each touchdown."""
    from lithobrake.touchdown import land

    with table(out, COLUMNS) as add:
        for place, (number, bed, body, event) in enumerate(arrivals(beds)):
            if place == 0:
                land(bed, body, event)  # it reads the kernels
            outcome, cpu = timed(lambda bed=bed, body=body, event=event: land(bed, body, event))
            found = {"outcome": str(outcome.status), "simulated_s": outcome.simulated_time, "cpu_s": cpu}
            add({"checkout": name, "touchdown": number} | found)


def summary(rows: list[Row]) -> Row:
    """What both checkouts took, and the ratio."""
    cost = {name: np.array([row["cpu_s"] for row in rows if row["checkout"] == name]) for name in ("old", "new")}
    generator = np.random.default_rng(0)
    which = generator.integers(0, COUNT, size=(2, RESAMPLES, COUNT))
    ratios = cost["new"][which[0]].sum(axis=1) / cost["old"][which[1]].sum(axis=1)
    lower, upper = np.quantile(ratios, [0.05, 0.95]).tolist()
    return {
        name: {
            "cpu_s": float(values.sum()), "cpu_s_median": float(np.median(values)),
            "simulated_s": sum(row["simulated_s"] for row in rows if row["checkout"] == name),
            "captured": sum(row["outcome"] == "captured" for row in rows if row["checkout"] == name),
        }
        for name, values in cost.items()
    } | {"ratio": float(cost["new"].sum() / cost["old"].sum()), "ratio_lower": lower, "ratio_upper": upper}  # fmt: skip


def main() -> None:
    given = command_line(__doc__, "old", "new", beds=Path, out=Path, measure="").parse_args()
    tables = {name: given.out.with_name(f"{given.out.name}_{name}.csv") for name in ("old", "new")}
    if given.measure:
        measure(given.measure, given.beds, tables[given.measure])
        return
    processes = []
    for name in tables:
        checkout = getattr(given, name).resolve()
        paths = os.pathsep.join([str(checkout), str(Path(__file__).resolve().parent)])
        command = [sys.executable, __file__, *sys.argv[1:], "--measure", name]
        processes.append(subprocess.Popen(command, env=os.environ | {"PYTHONPATH": paths}))
    if any(process.wait() for process in processes):
        raise SystemExit("a checkout has failed, see above")
    kinds = dict.fromkeys(("checkout", "outcome"), str)
    rows = [row for path in tables.values() for row in read_rows(path, kinds)]
    command = "benchmarks/touchdowns_in_turn.py OLD . --beds BED_FOLDER --out FILE"
    write_document(given.out.with_suffix(".json"), origin(command) | summary(rows))


if __name__ == "__main__":
    main()
