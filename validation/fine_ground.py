"""Does the answer settle as grains become fine? The question of the quick study on grounds of one size each.

    python validation/fine_ground.py [--sizes SIZE ...] [--work FOLDER]

The finest beds of an unknown ground stand for all finer ground. Here the lander of scenarios/quick.toml meets grains of
1.3, 2.6 and 3.8 to its longest edge, COUNT landers on BEDS beds each. Writes fine_ground.csv, a line for each size
as it ends; what stands there is not done again.
"""

import math
import sys
import tempfile
from pathlib import Path

import numpy as np

import lithobrake
from lithobrake.results import StudyResults

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, Row, add_row, command_line, read_rows, study_tables

SIZES = (0.18, 0.089, 0.06)  # m
COUNT, BEDS = 24, 12
TABLE = Path(__file__).with_suffix(".csv")


def tables(size: float) -> Row:
    """The study on grains of one size [m]."""
    ground = {"finest": min(size, 0.08), "kind": {"gravel": {"weight": 1.0, "grain_size": size}}}
    few = {"journey": {"count": COUNT, "emulated_count": 0}, "bed": {"bed_count": BEDS}}
    return study_tables(SCENARIOS / "quick.toml", few, ground=ground)


def found(study: StudyResults) -> Row:
    """Quantities of a study with the ends of their 90 % intervals, and what the first touchdowns did."""
    touchdowns, journeys = study.touchdowns, study.journeys
    first = np.array(touchdowns["touchdown"]) == 0
    rests = np.array(journeys["end"]) == "at_rest"
    faces = np.array(journeys["face"])[rests]
    row: Row = {"rests": int(rests.sum())}
    for name in ("time_s", "distance_m"):
        median = getattr(study.results.rest, name).median
        row |= {f"{name} {part}": float(getattr(median, part) or math.nan) for part in ("value", "lower", "upper")}
    return row | {
        "first_left": int((np.array(touchdowns["outcome"])[first] == "clear").sum()),
        "small_end": int(np.isin(faces, ("+z", "-z")).sum()),
        "touchdowns": study.results.touchdowns,
        "cpu_s_of_touchdown": float(np.nanmean(touchdowns["cpu_s"])),
    }


def main() -> None:
    given = command_line(__doc__, sizes=SIZES, work=Path(tempfile.gettempdir()) / "lithobrake_fine_ground").parse_args()
    done = {row["size_m"] for row in read_rows(TABLE, {})}
    for size in given.sizes:
        if size not in done:
            study = lithobrake.run(tables(size), given.work / f"{size:g}", workers=1, report=False)
            add_row(TABLE, {"size_m": size, "ratio": 0.227 / size, "landers": COUNT, **found(study)}, 4)


if __name__ == "__main__":
    main()
