"""The forecast of the landings of Juventas and Milani on Dimorphos, from nothing: studies of all branches, and answers.

    python validation/forecast_hera/forecast.py --work FOLDER [--landers NAME ...] [--grounds NAME ...] [--workers N]

Runs the study of every branch (branches.py) on soil, and on hard ground with a restitution drawn from 0 to 1, each in a
folder of its own in FOLDER; what is there is not run again. Writes landers.csv, a line for each lander, as each study
ends, and runs.json. Then answers.py gives forecast.json, and write_page.py docs/forecast_hera.md.
"""

import csv
import hashlib
import io
import sys
import time
from itertools import product
from pathlib import Path

import numpy as np
from branches import LANDERS, Branch, branches
from grounds import RESTITUTION, hard_touchdown

import lithobrake
from lithobrake.pipeline.site import Site
from lithobrake.results import StudyResults, Table
from lithobrake.study import StudySource

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import Row, command_line, origin, read_rows, write_document

HERE = Path(__file__).parent
TABLE = "landers.csv"
WORDS = ("lander", "branch", "ground", "end", "face")
KINDS = dict.fromkeys(WORDS, str)
COUNTS = {"soil": 240, "hard": 400}  # landers of all branches
# Columns of the first touchdown, by what the table calls them.
FIRST = {
    "speed": "impact.speed", "incidence_deg": "impact.incidence_deg",
    "grain_friction": "grain.friction", "grain_restitution": "grain.restitution",
    "grain_cohesion_n": "grain.cohesion_force", "young_modulus": "grain.young_modulus",
    "hull_restitution": "lander.restitution", "hull_friction": "lander.friction",
    "hull_cohesion_n": "lander.cohesion_force", "lander_mass": "lander.mass",
}  # fmt: skip


# Columns of the table of journeys.
OWN = (
    "bed", "end", "time_s", "latitude_deg", "longitude_deg", "position_x", "position_y", "position_z", "distance",
    "contacts", "touchdowns", "face", "tilt_deg",
)  # fmt: skip


def run_branch(branch: Branch, ground: str, work: Path, workers: int | None) -> StudyResults:
    """The study of a branch on soil or on hard ground."""
    tables, model = branch.tables(COUNTS[ground]), None
    if ground == "hard":
        tables["lander"]["restitution"], model = RESTITUTION, hard_touchdown
    return lithobrake.run(tables, work / f"{branch.folder}_{ground}", workers=workers, model=model, report=False)


def rows_of(branch: Branch, ground: str, study: StudyResults) -> list[Row]:
    """A row for each lander of a study."""
    journeys, touchdowns = study.journeys, study.touchdowns
    mass = Site(StudySource.of_tables(branch.tables(COUNTS[ground])).study).sampled(journeys.row_count)["mass"]
    first = {int(number): row for row, number in enumerate(touchdowns["journey"]) if touchdowns["touchdown"][row] == 0}
    rows = []
    for number in range(journeys.row_count):
        row: Row = {
            "lander": branch.lander, "branch": branch.name, "ground": ground, "journey": number,
            "mass_kg": float(mass[number]), **{name: journeys[name][number] for name in OWN},
        }  # fmt: skip
        place = first.get(number)
        for title, name in FIRST.items():
            row[title] = np.nan if place is None or name not in touchdowns else float(touchdowns[name][place])
        row["first_speed_ratio"] = speed_ratio(touchdowns, place)
        rows.append(row)
    return rows


def speed_ratio(touchdowns: Table, place: int | None) -> float:
    """Speed out over speed in at the first touchdown, 0 where the lander stays."""
    if place is None:
        return float("nan")
    if touchdowns["outcome"][place] == "captured":
        return 0.0
    return float(touchdowns["speed_out"][place] / touchdowns["impact.speed"][place])


def digest(*paths: Path) -> str:
    """SHA-256 of files one after the other."""
    found = hashlib.sha256()
    for path in paths:
        found.update(path.read_bytes())
    return found.hexdigest()


def package_files() -> list[Path]:
    """All that makes a study, in the order of their paths."""
    return sorted(Path(lithobrake.__file__).parent.rglob("*.py"))


def add_rows(path: Path, rows: list[Row]) -> None:
    """Add the rows of a study to a CSV table on disk, all or none."""
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    if not path.exists():
        writer.writeheader()
    for row in rows:
        writer.writerow({key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items()})
    with path.open("a", encoding="utf-8") as file:
        file.write(text.getvalue())


def main() -> None:
    """Run what is missing and note every lander."""
    options = command_line(__doc__, work=Path, out=HERE, landers=LANDERS, grounds=tuple(COUNTS), workers=0).parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    table, started = options.out / TABLE, time.perf_counter()
    done = {(row["lander"], row["branch"], row["ground"]) for row in read_rows(table, KINDS)}
    for lander, ground in product(options.landers, options.grounds):
        for branch in branches(lander):
            if (lander, branch.name, ground) in done:
                continue
            study = run_branch(branch, ground, options.work, options.workers or None)
            add_rows(table, rows_of(branch, ground, study))
            ends = ", ".join(f"{end} {one['count']}" for end, one in study.summary["results"]["ends"].items())
            print(f"{lander}, {branch.name}, {ground}: {ends}", flush=True)
    command = "validation/forecast_hera/forecast.py --work FOLDER"
    made = {"wall_s": round(time.perf_counter() - started), "code_sha256": digest(*package_files())}
    write_document(options.out / "runs.json", origin(command) | made)


if __name__ == "__main__":
    main()
