"""Which contact ends the correlation of two landers that share bed, impact point, attitude, soil and arrival?

    python validation/pairing.py [--work FOLDER] [--options NAME ...]
    python validation/pairing.py --judge    the correlations alone, from the tables that stand

The same landers of scenarios/one_ground.toml are followed to rest as they are, and with one thing changed. Studies go
on in the work folder. pairing_touchdowns.csv gets a row for each touchdown and pairing_journeys.csv one for each
journey as a study ends; what stands there is not made again. pairing.json has the correlations, with those of first
touchdowns that share some numbers only (grain_size.csv).
"""

import math
import sys
import tempfile
from pathlib import Path

from pairing_correlations import JOURNEYS, TOUCHDOWNS, judged

from lithobrake.files.reading import read_rows as read_table
from lithobrake.pipeline import run_study
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.study import StudySource
from lithobrake.vocabulary.quantities import ORIENTATION, PLACE, SPIN, VELOCITY_OUT

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, Row, add_row, between, command_line, origin, read_rows, study_tables, write_document

HERE = Path(__file__).parent
COUNT, BEDS, SEED = 24, 8, 301
BED = {"bed_count": BEDS, "grain_count": 110, "width": [0.6, 0.6]}
# Faster and flatter than in the scenario, where all come to rest at the first touchdowns; a softer soil takes longer
# steps (journey_seed_pairs.py has the same).
SLOWEST, FASTEST, FLATTEST = 0.08, 0.2, 70.0  # m/s, m/s, deg
SOIL = {"grain": {"young_modulus": between(3e4, 3e5, "log_uniform")}}


def speed(factor: float) -> dict[str, Row]:
    return {"delivery": {"speed": between(factor * SLOWEST, factor * FASTEST), "incidence_deg": between(0.0, FLATTEST)}}


# The second study of each pair; "none" is the first one of all.
OPTIONS: dict[str, dict[str, Row]] = {
    "none": {},
    "speed +0.0001 %": speed(1.000001),
    "mass +10 %": {"lander": {"mass": 2.2}},
    "speed +30 %": speed(1.3),
    "restitution 0.8": {"grain": {"restitution": between(0.75, 0.85)}},
}
INPUTS = ("impact.speed", "impact.incidence_deg", *PLACE, *ORIENTATION, *SPIN)
OUTPUTS = (*VELOCITY_OUT, "speed_out", "spin_out", "contact_duration", "penetration")
OF_JOURNEY = ("time_s", "distance", "contacts", "touchdowns", "path_length", "position_x", "position_y", "position_z")


def followed(name: str, work: Path) -> StudyFolder:
    """The folder of a study whose landers have been followed."""
    changes = {"journey": {"count": COUNT}, "bed": BED}
    tables = study_tables(SCENARIOS / "one_ground.toml", changes, SOIL, speed(1.0), OPTIONS[name], seed=SEED)
    folder = work / name.replace(" ", "_").replace("%", "percent")
    run_study(StudySource.of_tables(tables), folder, until="runs", worker_count=1)
    return StudyFolder(folder)


def add_touchdowns(name: str, folder: StudyFolder) -> None:
    runs = DesignRuns.load(folder, "touchdowns")
    names = ("journey", "touchdown", "bed")
    for row in range(runs.run_count):
        numbers = {key: int(runs.inputs[key][row]) for key in names}
        found = {key: float(runs.inputs[key][row]) for key in INPUTS} | {
            key: float(runs.output(key)[row]) for key in OUTPUTS
        }
        add_row(TOUCHDOWNS, {"option": name, **numbers, "outcome": runs.outcomes[row], **found}, 7)


def rows_of(folder: StudyFolder, name: str) -> list[dict[str, str]]:
    """Rows of a table of the folder, by column without its unit."""
    rows = read_table(folder / name, ("journey",), "")
    return [{title.split(" ")[0]: value for title, value in row.items()} for row in rows]


def add_journeys(name: str, folder: StudyFolder) -> None:
    first = {row["journey"]: row for row in rows_of(folder, "touchdowns.csv") if row["touchdown"] == "0"}
    for row in rows_of(folder, "journeys.csv"):
        numbers = {key: float(row[key]) if row[key] else math.nan for key in OF_JOURNEY}
        begin = first[row["journey"]]
        way = {f"way_{axis}": numbers[f"position_{axis}"] - float(begin[f"position_{axis}"]) for axis in "xyz"}
        plain = {"journey": int(row["journey"]), "bed": int(row["bed"]), "end": row["end"], "face": row["face"]}
        add_row(JOURNEYS, {"option": name, **plain, **numbers, **way}, 8)


def make(work: Path, names: list[str]) -> None:
    for name in names:
        done = {row["option"] for row in read_rows(JOURNEYS, {}, str)}
        if name not in done:
            folder = followed(name, work)
            add_touchdowns(name, folder)
            add_journeys(name, folder)
            print(name, flush=True)


def main() -> None:
    work = Path(tempfile.gettempdir()) / "lithobrake_pairing"
    given = command_line(__doc__, work=work, options=tuple(OPTIONS), judge=False).parse_args()
    if not given.judge:
        given.work.mkdir(parents=True, exist_ok=True)
        make(given.work, list(given.options))
    document = {**origin("validation/pairing.py"), "journeys": COUNT, "beds": BEDS, "seed": SEED, **judged()}
    write_document(HERE / "pairing.json", document)


if __name__ == "__main__":
    main()
