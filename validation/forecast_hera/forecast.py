"""The forecast of the landings of Juventas and Milani on Dimorphos, from nothing: studies of all branches, and answers.

    python validation/forecast_hera/forecast.py --work FOLDER [--landers NAME ...] [--branches NAME ...] [--count N]

Runs the study of every branch (branches.py) on soil, and on hard ground with a restitution drawn from 0 to 1, each in a
folder of its own in FOLDER; what is there is not run again. Writes landers.csv, a line for each lander, as each study
ends, and runs.json. Then answers.py gives forecast.json, and write_page.py docs/forecast_hera.md.
"""

import sys
import time
from pathlib import Path

import numpy as np
from branches import LANDERS, Branch, branches
from grounds import RESTITUTION, hard_touchdown

import lithobrake
from lithobrake.results import StudyResults

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import Row, add_row, command_line, origin, read_rows, write_document

HERE = Path(__file__).parent
TABLE = "landers.csv"
WORDS = ("lander", "branch", "ground", "end", "face")
KINDS = dict.fromkeys(WORDS, str)
HARD_COUNT = 400  # journeys a branch on hard ground, which take no soil
# Columns of the first touchdown, by what the table calls them.
FIRST = {
    "mass_kg": "site.mass", "speed": "impact.speed", "incidence_deg": "impact.incidence_deg",
    "grain_friction": "grain.friction", "grain_restitution": "grain.restitution",
    "grain_cohesion_n": "grain.cohesion_force", "young_modulus": "grain.young_modulus",
    "hull_restitution": "lander.restitution", "hull_friction": "lander.friction",
    "hull_cohesion_n": "lander.cohesion_force", "lander_mass": "lander.mass",
}  # fmt: skip


def run_soil(branch: Branch, work: Path, count: int | None, workers: int | None) -> StudyResults:
    """The study of a branch on soil."""
    return lithobrake.run(branch.tables(count), work / f"{branch.folder}_soil", workers=workers, report=False)


def run_hard(branch: Branch, work: Path, workers: int | None) -> StudyResults:
    """The same deliveries on hard ground."""
    tables = branch.tables(HARD_COUNT)
    tables["lander"]["restitution"] = RESTITUTION
    return lithobrake.run(
        tables, work / f"{branch.folder}_hard", workers=workers, model=hard_touchdown, report=False
    )


def rows_of(branch: Branch, ground: str, study: StudyResults) -> list[Row]:
    """A row for each lander of a study."""
    journeys, touchdowns = study.journeys, study.touchdowns
    first = {int(number): row for row, number in enumerate(touchdowns["journey"]) if touchdowns["touchdown"][row] == 0}
    rows = []
    for number in range(journeys.row_count):
        own = {name: journeys[name][number] for name in journeys}
        row: Row = {
            "lander": branch.lander, "branch": branch.name, "ground": ground, "journey": number,
            "bed": own["bed"], "end": own["end"], "time_s": own["time_s"], "latitude_deg": own["latitude_deg"],
            "longitude_deg": own["longitude_deg"], "distance_m": own["distance"], "contacts": own["contacts"],
            "touchdowns": own["touchdowns"], "face": own["face"], "tilt_deg": own["tilt_deg"],
        }  # fmt: skip
        place = first.get(number)
        for title, name in FIRST.items():
            row[title] = np.nan if place is None or name not in touchdowns else float(touchdowns[name][place])
        row["first_speed_ratio"] = speed_ratio(touchdowns, place)
        rows.append(row)
    return rows


def speed_ratio(touchdowns: lithobrake.results.Table, place: int | None) -> float:
    """Speed out over speed in at the first touchdown, 0 where the lander stays."""
    if place is None:
        return float("nan")
    if touchdowns["outcome"][place] == "captured":
        return 0.0
    return float(touchdowns["speed_out"][place] / touchdowns["impact.speed"][place])


def main() -> None:
    """Run what is missing and note every lander."""
    options = command_line(
        __doc__, work=Path, out=HERE, landers=LANDERS, branches=("",), count=0, workers=0, hard_only=False
    ).parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    table = options.out / TABLE
    done = {(row["lander"], row["branch"], row["ground"]) for row in read_rows(table, KINDS)}
    started = time.perf_counter()
    for lander in options.landers:
        for branch in branches(lander):
            if not any(part in branch.name for part in options.branches):
                continue
            for ground in ("hard", "soil")[: 1 if options.hard_only else 2]:
                if (lander, branch.name, ground) in done:
                    continue
                workers = options.workers or None
                if ground == "soil":
                    study = run_soil(branch, options.work, options.count or None, workers)
                else:
                    study = run_hard(branch, options.work, workers)
                for row in rows_of(branch, ground, study):
                    add_row(table, row, 6)
                print(f"{lander}, {branch.name}, {ground}: {study.summary['results']['ends']}", flush=True)
    write_document(
        options.out / "runs.json",
        origin(" ".join(["validation/forecast_hera/forecast.py", "--work", "FOLDER"])) | {
            "cpu_s": round(time.process_time()), "wall_s": round(time.perf_counter() - started)
        },
    )


if __name__ == "__main__":
    main()
