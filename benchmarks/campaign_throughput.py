"""What a campaign costs beside its runs: two workers against one on equal landings, empty runs through Dask, and the
coordinator of many processes.

    python benchmarks/campaign_throughput.py [--landings 40] [--empty-runs 20000] [--processes 16] [--study DIR]

The share of the workers' time that is spent in runs tells what coordination costs on a machine with other work, too;
the speed-up itself only on a quiet one: what all other processes took is printed. `LITHOBRAKE_CACHE` set, the kernels
are compiled once.
"""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from harness import SCENARIOS, command_line, origin, read_document, write_document

from lithobrake.campaign import DaskExecutor, Ledger, LocalExecutor, Runs, run
from lithobrake.pipeline import run_study
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.random_inputs import draw
from lithobrake.study import StudySource, read_study
from lithobrake.touchdown.touchdown_model import TouchdownModel, engine_hash

STUDY = SCENARIOS / "first_bounce.toml"
MANY = Path(__file__).parent / "results" / "campaign_processes.json"
LANDING_SECONDS, RUNS_A_PROCESS = 0.1, 100


class EqualLandings:
    """The landing at the medians of a study, again and again; its only input is a number that it does not look at."""

    def __init__(self, folder: Path) -> None:
        study = read_study(STUDY)
        self.model = TouchdownModel(study, (folder / "beds" / "bed_0.h5",), engine_hash())
        self.values = draw(study, study.touchdown_medians(), study.seed, DrawnDesign(study).region)

    def __call__(self, inputs: dict[str, float], seed: int) -> dict[str, Any]:
        """Land."""
        return self.model(self.values, seed)


def nothing(inputs: dict[str, float], seed: int) -> dict[str, float]:
    """An empty run."""
    return {}


def busy_time() -> float:
    """CPU time that all processes of this machine have taken since it started [s] (Linux)."""
    # user, nice, system, idle, iowait, irq, softirq, steal
    ticks = [int(word) for word in Path("/proc/stat").read_text().split("\n")[0].split()[1:9]]
    return (sum(ticks) - ticks[3] - ticks[4]) / os.sysconf("SC_CLK_TCK")


def landings(study: Path, folder: Path, count: int) -> None:
    """Time equal landings on one worker and on two; study: folder that has the bed, or gets it."""
    run_study(StudySource.read(STUDY), study, until="landing")
    model, x = EqualLandings(study), np.arange(count, dtype=float)[:, None]
    walls, cpus = dict[int, float](), dict[int, float]()
    for workers in (1, 2):
        with Ledger(folder / f"{workers}.sqlite") as ledger, LocalExecutor(workers) as executor:
            # Each process reads its bed and its kernels once; that is not what is measured here.
            run(model, -1 - x[: 2 * workers], names=("number",), ledger=ledger, executor=executor)
            busy, began = busy_time(), time.perf_counter()
            runs: Runs = run(model, x, names=("number",), ledger=ledger, executor=executor)
            walls[workers], busy = time.perf_counter() - began, busy_time() - busy
        inside, cpu = (sum(getattr(entry, name) for entry in runs.records) for name in ("wall_s", "cpu_s"))
        cpus[workers] = cpu
        print(
            f"{workers} worker(s): {count} landings in {walls[workers]:.2f} s, {1000 * cpu / count:.0f} ms of CPU time "
            f"each; {100 * inside / (workers * walls[workers]):.2f} % of the workers' time in runs; all else took "
            f"{(busy - cpu) / walls[workers]:.2f} cores of {os.cpu_count()}"
        )
    speed_up = walls[1] / walls[2]
    alike = speed_up * cpus[2] / cpus[1]
    print(f"speed-up {speed_up:.3f}; had a landing taken the same CPU time both times, {alike:.3f}")


@contextmanager
def cluster(folder: Path) -> Iterator[str]:
    """A Dask scheduler and a worker on this machine; gives the scheduler's address."""
    file = folder / "scheduler.json"
    commands = [
        ["dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file)],
        ["dask_worker", "--scheduler-file", str(file), "--nthreads", "1", "--no-nanny"],
    ]
    processes = []
    try:
        for name, *arguments in commands:
            command = [sys.executable, "-m", f"distributed.cli.{name}", *arguments, "--no-dashboard"]
            with (folder / f"{name}.txt").open("wb") as log:
                processes.append(subprocess.Popen(command, stdout=log, stderr=log, cwd=Path(__file__).parent))
            while not file.is_file():
                time.sleep(0.05)
        yield read_document(file)["address"]
    finally:
        for process in processes:
            process.kill()


def empty_runs(folder: Path, count: int) -> None:
    """Time empty runs through Dask, and what of it is the coordinator's own."""
    # The worker finds the model by the name of this file; as __main__ it would be sent whole with each run.
    from campaign_throughput import nothing as model

    x = np.arange(count, dtype=float)[:, None]
    with cluster(folder) as address, Ledger(folder / "empty.sqlite") as ledger, DaskExecutor(address) as executor:
        run(model, -1 - x[:10], names=("number",), ledger=ledger, executor=executor)
        wall, cpu = time.perf_counter(), time.process_time()
        runs = run(model, x, names=("number",), ledger=ledger, executor=executor)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    assert len(runs.records) == count
    print(
        f"{count} empty runs through Dask: {1000 * wall / count:.2f} ms a run, of which {1000 * cpu / count:.2f} ms "
        f"are CPU time of the coordinator; load now {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"
    )


def wait_a_landing(values: Mapping[str, float], seed: int) -> dict[str, float]:
    """A run as long as a short landing that takes no core: so many processes run at once on a machine of few cores."""
    time.sleep(LANDING_SECONDS)
    return {"number": values["number"]}


def many_processes(folder: Path, processes: int) -> None:
    """Time the coordinator of so many processes that make runs of LANDING_SECONDS; kept in results/."""
    from campaign_throughput import wait_a_landing as model

    count = RUNS_A_PROCESS * processes
    x = np.arange(count, dtype=float)[:, None]
    with Ledger(folder / "many.sqlite") as ledger, LocalExecutor(processes) as executor:
        run(model, -1 - x[: 2 * processes], names=("number",), ledger=ledger, executor=executor)
        wall, cpu = time.perf_counter(), time.process_time()
        runs = run(model, x, names=("number",), ledger=ledger, executor=executor)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    inside = sum(entry.wall_s or 0.0 for entry in runs.records)
    found = {
        "processes": processes, "runs": count, "run_s": inside / count, "wall_s": wall, "coordinator_cpu_s": cpu,
        "coordinator_part": cpu / inside, "in_runs": inside / (processes * wall),
    }  # fmt: skip
    write_document(MANY, found | origin(f"benchmarks/campaign_throughput.py --processes {processes}"))
    print(
        f"{processes} processes: {count} runs of {inside / count:.3f} s in {wall:.1f} s; the coordinator took "
        f"{100 * cpu / inside:.2f} % of their time, which was in runs for {100 * inside / (processes * wall):.1f} %"
    )


def main() -> None:
    parser = command_line(__doc__, landings=40, empty_runs=20_000, processes=0)
    parser.add_argument("--study", type=Path, metavar="DIR", help="keep the bed of the landings in this folder")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if options.landings:
            landings(options.study or folder / "study", folder, options.landings)
        if options.empty_runs:
            empty_runs(folder, options.empty_runs)
        if options.processes:
            many_processes(folder, options.processes)


if __name__ == "__main__":
    main()
