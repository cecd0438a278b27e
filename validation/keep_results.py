"""Keep what a finished study found, in files small enough for the repository.

    python validation/keep_results.py STUDY_FOLDER --command "lithobrake run scenarios/paper.toml" --log FILE --load 2

Copies study, summary, expansions, emulator or journeys, and figures to showcase/NAME, NAME being that of the folder;
writes the ledger as CSV and a contact sheet of the landing that the study shows; and notes with which command, on what
machine and in which time it was made (from the log of the run, as bash's `time` ends it).
"""

import re
import shutil
import sys
from pathlib import Path

import numpy as np
from scipy.stats import spearmanr

import lithobrake
from lithobrake.export import ExportOptions, export_study

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import ROOT, command_line, origin, read_document, write_document

OUTPUTS = ("speed_out", "elevation_out", "spin_out")
KEPT = (
    "study.toml", "summary.json", "scores.json", "screening.json", "refined.json", "emulator.json", "estimates.json",
    "run_flights.csv", "journeys.csv",
)  # fmt: skip


def times(log: str) -> dict[str, float]:
    """Seconds on the clock and of CPU that a command took, from what bash's `time` wrote last."""
    found = re.findall(r"^(real|user|sys)\s+(\d+)m([\d.]+)s$", log, re.MULTILINE)[-3:]
    seconds = {name: 60.0 * int(minutes) + float(rest) for name, minutes, rest in found}
    return {"wall_s": seconds["real"], "cpu_s": seconds["user"] + seconds["sys"]}


def stages(log: str) -> list[str]:
    """What the log says of the time that each stage took."""
    return [line.strip() for line in log.splitlines() if re.search(r"\btook [\d.]+ (s|min|h)\b", line)]


def rank_correlations(results: lithobrake.StudyResults) -> dict[str, dict[str, float]]:
    """Spearman's rank correlation of outputs with the inputs that vary, over the samples that leave."""
    samples = results.samples
    left = np.isfinite(samples[OUTPUTS[0]])
    inputs = list(samples)[: list(samples).index("outcome")]
    return {
        output: {name: float(spearmanr(samples[name][left], samples[output][left]).statistic) for name in inputs}
        for output in OUTPUTS
    }


def keep(study: Path, out: Path) -> None:
    out.mkdir(parents=True, exist_ok=True)
    results = lithobrake.StudyResults(study)
    # One touchdown of each lander stands in drawn.csv, with all that is known of it.
    twice = ("journeys.csv", "touchdowns.csv") if results.study["journey"]["touchdowns"] == 1 else ()
    for name in KEPT:
        if (study / name).exists() and name not in twice:
            shutil.copy(study / name, out / name)
    # Where the study was made is of no use elsewhere.
    summary = (out / "summary.json").read_text(encoding="utf-8")
    (out / "summary.json").write_text(summary.replace(f'"{study.resolve()}"', f'"runs/{study.name}"'), encoding="utf-8")
    (out / "runs").mkdir(exist_ok=True)
    for table in (study / "designs").glob("*.csv"):
        if table.name not in twice:
            shutil.copy(table, out / "runs" / table.name)
    (out / "figures").mkdir(exist_ok=True)
    # The sheet shows the landing in more frames than its figure.
    for figure in sorted(set((study / "report").glob("*.png")) - set((study / "report").glob("*_landing.png"))):
        shutil.copy(figure, out / "figures" / figure.name)
    if (study / "samples.h5").exists():
        write_document(out / "rank_correlations.json", rank_correlations(results))
    export_study(results, out / "landing", ["sheet"], ExportOptions(replaces=True))


def main() -> None:
    parser = command_line(__doc__, "study", command=str, log=Path, out=ROOT / "showcase")
    parser.add_argument("--load", type=float, required=True, help="processes that shared the machine while it ran")
    parser.add_argument(
        "--kept-landings", action="store_true", help="the landings are those of the origin that is there (kept_runs.py)"
    )
    given = parser.parse_args()
    out = given.out / given.study.name
    earlier = read_document(out / "origin.json") if given.kept_landings else {}
    keep(given.study, out)
    log = given.log.read_text()
    made = {**origin(""), "load": given.load, "command": given.command, **times(log), "stages": stages(log)}
    if earlier:
        keys = ("date", "machine", "command", "load", "wall_s", "cpu_s")
        made["landings"] = earlier.get("landings") or {key: earlier[key] for key in keys}
    write_document(out / "origin.json", made)


if __name__ == "__main__":
    main()
