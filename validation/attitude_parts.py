"""What the attitude of the lander decides, beside the soil, in the studies whose runs are kept.

    python validation/attitude_parts.py

Reads the kept studies of showcase/ (validation/keep_results.py) and writes to attitude_parts.json the parts of the
variance of the rebound speed and of the return fraction, and the first touchdowns by the side that faces the ground.
"""

import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from lithobrake.analysis import variance_shares
from lithobrake.pipeline.answer.journey_ends import first_sides
from lithobrake.pipeline.answer.run_estimates import SOIL
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import independent_terms
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.results.study_files import json_values
from lithobrake.study import read_study

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import ROOT, command_line, origin, read_rows, write_document

RESULTS = Path(__file__).with_suffix(".json")
KEPT = ("drawn_700", "drawn_170", "mission")
PARTS = ("soil", "arrival", "attitude", "bed", "place")


def runs_of(folder: Path) -> DesignRuns:
    """The kept landings of a study, or the first ones of its journeys."""
    with tempfile.TemporaryDirectory() as place:
        (Path(place) / "designs").mkdir()
        shutil.copy(folder / "runs" / "drawn.csv", Path(place) / "designs" / "drawn.csv")
        return DesignRuns.load(StudyFolder(Path(place)), "drawn")


def returns_of(folder: Path) -> np.ndarray:
    """Share of the flights of each landing that return [run_count]."""
    count = len((folder / "runs" / "drawn.csv").read_text(encoding="utf-8").splitlines()) - 1
    rows = read_rows(folder / "run_flights.csv", {}, str)[:count]
    return np.array([float(row["returns"] or "nan") for row in rows])


def parts(folder: Path) -> dict[str, Any]:
    """Parts of the variance with their intervals, and results by side, of one study."""
    study = read_study(folder / "study.toml")
    design, runs, returns = DrawnDesign(study), runs_of(folder), returns_of(folder)
    inputs = design.soil_inputs
    x = runs.columns(list(inputs))
    soil = [name for name in inputs if name.startswith(SOIL)]
    attitude = independent_terms(design, runs.inputs)
    found: dict[str, Any] = {"landings": runs.run_count, "attitude_terms": attitude.shape[1]}
    for name, y in (("speed_out", runs.output("speed_out")), ("returns", returns)):
        one = variance_shares(inputs, x, y, runs.inputs["bed"], soil=soil, attitude=attitude)
        named = {} if one is None else {part: getattr(one, part) for part in PARTS if getattr(one, part) is not None}
        found[name] = {part: [share.value, share.lower, share.upper] for part, share in named.items()}
    found["sides"] = {side: json_values(one) for side, one in first_sides(study, runs, returns).items()}
    return found


def main() -> None:
    command_line(__doc__).parse_args()
    found = {name: parts(ROOT / "showcase" / name) for name in KEPT}
    write_document(RESULTS, {"studies": found, **origin("validation/attitude_parts.py")})


if __name__ == "__main__":
    main()
