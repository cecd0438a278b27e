"""Landers of the forecast: the study of a branch, and a row of landers.csv for each of its landers."""

import csv
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from assumptions import BETWEEN, Assumptions
from assumptions import FIRST as FIRST_ASSUMPTIONS
from branches import Branch
from grounds import RESTITUTION, DrawnRestitution
from harness import Row
from measurements import Measurement

from lithobrake.pipeline import run_study
from lithobrake.pipeline.job import StudyProgress
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.site import Site
from lithobrake.results import StudyResults, Table
from lithobrake.study import Study, StudySource
from lithobrake.study.ground_beds import grounds

TABLE, RUNS = "landers.csv", "runs.json"
KINDS = dict.fromkeys(("lander", "branch", "ground", "law", "kind", "end", "face"), str)
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


def follow(
    branch: Branch, ground: str, count: int, work: Path, workers: int | None, shown: StudyProgress,
    assumptions: Assumptions = FIRST_ASSUMPTIONS, measurements: Iterable[Measurement] = (),
) -> list[Row]:  # fmt: skip
    """A row for each lander of a branch on soil or hard ground, with its part of `count` landers of all branches.

    They are followed in a folder of work; one that has them by the same code is only read.
    """
    tables, model = assumptions.study(branch, ground, count, measurements), None
    if ground == "hard":
        tables["lander"]["restitution"], model = RESTITUTION, DrawnRestitution()
    source = StudySource.of_tables(tables, model and function_identity(model))
    folder = work / folder_name(branch, ground)
    run_study(source, folder, until="runs", worker_count=workers, model=model, shown=shown)
    study = StudyResults(folder)
    mass = Site(source.study).sampled(study.journeys.row_count)["mass"]
    rows = rows_of(study, {"lander": branch.lander, "branch": branch.name, "ground": ground}, mass)
    return with_grounds(rows, source.study) if assumptions.is_ground_unknown else rows


def folder_name(branch: Branch, ground: str) -> str:
    """The folder of a study in that of all."""
    return f"{branch.folder}_{ground}"


def with_grounds(rows: Iterable[Row], study: Study) -> list[Row]:
    """Rows with kind of ground, law of restitution and size of the grains [m] of their beds; hard ground has none."""
    of_beds, found = grounds(study), []
    for row in rows:
        kind, law, size = "", "", np.nan
        if of_beds:
            of = of_beds[int(row["bed"])]
            (kind, _, law), size = of.kind.partition(BETWEEN), of.size
        found.append({**row, "kind": kind, "law": law, "grain_size_m": size})
    return found


def rows_of(study: StudyResults, words: Row, mass: np.ndarray) -> list[Row]:
    """A row for each lander of a study, [count] masses of Dimorphos."""
    journeys, touchdowns = study.journeys, study.touchdowns
    first = {int(number): row for row, number in enumerate(touchdowns["journey"]) if touchdowns["touchdown"][row] == 0}
    rows = []
    for number in range(journeys.row_count):
        row = {
            **words, "journey": number, "mass_kg": float(mass[number]),
            **{name: journeys[name][number] for name in OWN},
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


def write_landers(path: Path, rows: Iterable[Row]) -> None:
    """Write rows as a CSV table, their numbers to six digits; the same bytes on all systems."""
    rows = [{key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items()} for row in rows]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
