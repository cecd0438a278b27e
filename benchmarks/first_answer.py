"""What it takes from an empty cache to an engine that steps, and to one landing, by two checkouts in turn.

    git worktree add OLD a6d9565
    python benchmarks/first_answer.py OLD . --pieces steps land --rounds 2 --out FILE

"steps" compiles what beds and landings call, as a study does before all else; "land" is `lithobrake land` of
first_bounce.toml, which pours its bed, too. Each is a process of its own with a cache of its own, empty at first; it
is made twice, so that the second finds the kernels, and for "land" the bed, on disk. FILE.csv gets a row a process: CPU
time of it and of those that it starts, CPU time of it alone (what it takes on the clock where cores are idle), time on
the clock, load. FILE.json gets the medians, and the ratios to the first checkout. With --one-core all is made on one
core, where nothing is compiled in a second process.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from harness import SCENARIOS, Row, command_line, origin, table, write_document

# Older checkouts keep this function elsewhere, and give it a job in place of what the job shows progress with.
STEPS = """
from importlib.util import find_spec
is_old = find_spec("lithobrake.pipeline.kernels") is not None
if is_old:
    from lithobrake.pipeline.kernels import compile_kernels
else:
    from lithobrake.pipeline.runs.beds import compile_kernels
class Silent:
    def progress(self, *what):
        pass
compile_kernels(Silent() if is_old else Silent().progress)
"""
PIECES = {"steps": ["-c", STEPS], "land": ["-m", "lithobrake", "land", str(SCENARIOS / "first_bounce.toml")]}
TIMES = ("cpu_s", "own_cpu_s", "clock_s")
COLUMNS = ["round", "piece", "checkout", "cache", *TIMES, "load"]
# Of /proc/PID/stat behind the name of a process: its own CPU times in the program and in the kernel, in ticks.
OWN_TICKS = slice(11, 13)


def measured(folder: Path, arguments: list[str], cache: str) -> Row:
    """Times [s] of a process, and the load before it. Raises RuntimeError for one that fails."""
    environment = os.environ | {"PYTHONPATH": str(folder.resolve()), "LITHOBRAKE_CACHE": cache}
    load, start = os.getloadavg()[0], time.perf_counter()
    process = subprocess.Popen([sys.executable, *arguments], env=environment, stdout=subprocess.DEVNULL, cwd=folder)
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
    clock = time.perf_counter() - start
    ticks = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()[OWN_TICKS]
    _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        raise RuntimeError(f"{arguments} of {folder} ended with status {status}; its words stand above")
    own = sum(map(int, ticks)) / os.sysconf("SC_CLK_TCK")
    return {"cpu_s": used.ru_utime + used.ru_stime, "own_cpu_s": own, "clock_s": clock, "load": load}


def summary(rows: list[Row]) -> Row:
    """Medians of each piece by checkout and cache, and how they compare with those of the first checkout."""
    found: Row = {}
    for row in rows:
        case = [other for other in rows if all(other[key] == row[key] for key in ("piece", "checkout", "cache"))]
        found.setdefault(row["piece"], {}).setdefault(row["cache"], {})[row["checkout"]] = {
            key: statistics.median(other[key] for other in case) for key in TIMES
        }
    for piece in found.values():
        for of_cache in piece.values():
            if "new" in of_cache:
                of_cache["ratio"] = {key: of_cache["new"][key] / of_cache["old"][key] for key in TIMES}
    return found


def main() -> None:
    options = {"pieces": list(PIECES), "rounds": 2, "one_core": False, "out": Path}
    given = command_line(__doc__, "old", "new", **options).parse_args()
    if given.one_core:
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    command = f"benchmarks/first_answer.py OLD . --pieces {' '.join(given.pieces)} --rounds {given.rounds}"
    command += " --one-core" * given.one_core
    rows: list[Row] = []
    with table(given.out.with_suffix(".csv"), COLUMNS) as add:
        for number in range(given.rounds):
            for piece in given.pieces:
                for checkout, folder in (("old", given.old), ("new", given.new)):
                    with tempfile.TemporaryDirectory() as cache:
                        for state in ("empty", "filled"):
                            row = measured(folder, PIECES[piece], cache)
                            rows.append({"round": number, "piece": piece, "checkout": checkout, "cache": state} | row)
                            add(rows[-1])
                    content = {**origin(command), "rounds": number + 1, "pieces": summary(rows)}
                    write_document(given.out.with_suffix(".json"), content)


if __name__ == "__main__":
    main()
