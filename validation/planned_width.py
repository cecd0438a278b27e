"""Does the half width come true that `lithobrake plan` promises? Fresh small studies, and those that are kept here.

    python validation/planned_width.py [--work FOLDER]    makes studies that are missing, then compares
    python validation/planned_width.py --page              the table of docs/estimates.md

Fresh studies differ in lander, soil, arrival and body, on as many beds as a study has that does not say how many. Their
outcomes and beds stand in planned_width_runs.json; a study that stands in it is not made again. planned_width.csv has a
row a study: what was promised before a run, and after the first third of the runs, and what came out. Earlier studies:
the twenty of journey_seed_pairs.csv, the journeys of where_it_ends_up.json, and the folders of showcase/.
"""

import json
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, Row, command_line, write_document

from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.fly.run_flights import RunFlights
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_run import run_study
from lithobrake.study import StudySource

RUNS = Path(__file__).with_name("planned_width_runs.json")


def uniform(lower: float, upper: float) -> Row:
    """A quantity between two values."""
    return {"distribution": "uniform", "lower": lower, "upper": upper}


def soil(lower: float, upper: float, **more: Any) -> Row:
    """Grains of these Young's moduli [Pa]."""
    return {"young_modulus": {"distribution": "log_uniform", "lower": lower, "upper": upper}, **more}


BALL = {"shape": "sphere", "edges": None, "diameter": 0.15, "mass": 3.0}
# Keys that differ from scenarios/quick.toml or scenarios/first_bounce.toml; one that is None is left out.
JOURNEYS: dict[str, dict[str, Row]] = {
    "ball, 8 to 25 cm/s": {
        "delivery": {"speed": uniform(0.08, 0.25), "incidence_deg": uniform(0.0, 60.0)},
        "lander": BALL, "grain": soil(3e4, 3e5),
    },
    "flat heavy box, shallow": {
        "delivery": {"speed": uniform(0.06, 0.15), "incidence_deg": uniform(40.0, 80.0)},
        "lander": {"edges": [0.2, 0.15, 0.08], "mass": 6.0}, "grain": soil(5e4, 5e5),
    },
    "cube on Didymos": {
        "delivery": {"speed": uniform(0.05, 0.2), "latitude_deg": 60.0, "longitude_deg": 10.0},
        "lander": {"edges": [0.15, 0.15, 0.15], "mass": 2.5}, "grain": soil(5e4, 5e5), "site": {"body": "didymos"},
    },
    "elastic, slippery grains": {
        "delivery": {"speed": uniform(0.06, 0.18)},
        "grain": soil(3e4, 3e5, restitution=uniform(0.8, 0.95), friction=uniform(0.2, 0.4)),
    },
    "slow, at the equator": {"delivery": {"speed": uniform(0.03, 0.09), "latitude_deg": 0.0, "longitude_deg": 90.0}},
    "spinning, 10 to 30 cm/s": {
        "delivery": {"speed": uniform(0.1, 0.3), "spin_x": uniform(-0.3, 0.3)}, "grain": soil(3e4, 3e5),
    },
}  # fmt: skip
LANDINGS: dict[str, dict[str, Row]] = {
    "first bounce of a ball": {"lander": BALL},
    "first bounce of a heavy box, 60 deg": {"lander": {"mass": 10.0}, "impact": {"incidence_deg": 60.0}},
    "first bounce at 0.25 m/s, 30 deg north": {"impact": {"speed": 0.25}, "site": {"latitude_deg": 30.0}},
}
JOURNEY_COUNT, LANDING_COUNT, FIRST_SEED = 60, 240, 501


def tables(name: str, seed: int) -> Row:
    """The tables of a fresh study."""
    follows = name in JOURNEYS
    file = SCENARIOS / ("quick.toml" if follows else "first_bounce.toml")
    study: Row = tomllib.loads(file.read_text(encoding="utf-8")) | {"seed": seed}
    count = {"journey": {"count": JOURNEY_COUNT}} if follows else {"design": {"run_count": LANDING_COUNT}}
    # A little wider than the bed of the quick study, so that no grain of so many beds is too long for it.
    bed = {"bed": {"bed_count": None, "grain_count": 120, "width": [0.62, 0.62]}}
    for part in (count, bed, (JOURNEYS | LANDINGS)[name]):
        for section, keys in part.items():
            merged = study.get(section, {}) | keys
            study[section] = {key: value for key, value in merged.items() if value is not None}
    return study


def outcomes(folder: StudyFolder, follows: bool) -> Row:
    """Outcome and bed of each run of a finished study."""
    if follows:
        table = JourneyTable.load(folder)
        return {"values": table.rests.astype(float).tolist(), "bed": table.bed.tolist()}
    values, bed = RunFlights.load(folder, "drawn").returns, DesignRuns.load(folder, "drawn").inputs["bed"]
    known = [None if np.isnan(one) else round(float(one), 4) for one in values]
    return {"values": known, "bed": bed.astype(int).tolist()}


def make(work: Path) -> None:
    """Make the fresh studies that are missing."""
    for number, name in enumerate(JOURNEYS | LANDINGS):
        known = json.loads(RUNS.read_text()) if RUNS.exists() else {}
        if name in known:
            continue
        out, follows = work / str(FIRST_SEED + number), name in JOURNEYS
        source = StudySource.of_tables(tables(name, FIRST_SEED + number))
        run_study(source, out, until="runs" if follows else "fly_runs", worker_count=1)
        write_document(RUNS, known | {name: outcomes(StudyFolder(out), follows)})
        print(name, flush=True)


def main() -> None:
    """Make what is missing, then compare."""
    work = Path(tempfile.gettempdir()) / "lithobrake_planned_width"
    options = command_line(__doc__, work=work, page=False).parse_args()
    make(options.work)


if __name__ == "__main__":
    main()
