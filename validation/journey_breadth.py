"""Do journeys end whatever the body, the slope, the lander, the angle and the speed? A few of each kind are followed.

    python validation/journey_breadth.py --shapes FOLDER [--work FOLDER] [--cases NAME ...]

FOLDER holds bennu_2692.obj and itokawa_5430.obj. Each case changes some keys of scenarios/one_ground.toml, on 4 beds
with 8 journeys, in a folder below --work, where a case that was stopped goes on. Writes journey_breadth.json, a row a
case.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np

import lithobrake
from lithobrake.results import StudyResults
from lithobrake.smallbody import Body, Shape

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, command_line, origin, read_document, study_tables, write_document

JOURNEYS, BEDS = 8, 4
HOUR = 3600.0
# Mass [kg] and spin period [s]: Lauretta et al. (2019), Fujiwara et al. (2006).
BENNU, ITOKAWA = (7.329e10, 4.296 * HOUR), (3.51e10, 12.13 * HOUR)


def body(path: Path, numbers: tuple[float, float], latitude: float, longitude: float) -> dict[str, Any]:
    """Keys of a study on another body, which has no partner."""
    return {
        "site": {"body": str(path), "mass": numbers[0], "spin_period": numbers[1]},
        "delivery": {"latitude_deg": latitude, "longitude_deg": longitude},
    }


def steep_place(path: Path, numbers: tuple[float, float], slope_deg: float) -> tuple[float, float]:
    """The place of a body at whose slope comes nearest to one [deg]."""
    shape = Shape.read(path)
    whole = Body(shape, mass=numbers[0], spin_period=numbers[1])
    centres = shape.corners.reshape(-1, 3, 3).mean(axis=1)
    latitude, longitude = shape.latitude_longitude(centres)
    slopes = np.degrees(whole.slope(latitude, longitude))
    nearest = int(np.argmin(np.abs(slopes - slope_deg)))
    return float(latitude[nearest]), float(longitude[nearest])


def cases(shapes: Path) -> dict[str, dict[str, Any]]:
    """Changes of the tables, by the name of the case."""
    bennu, itokawa = shapes / "bennu_2692.obj", shapes / "itokawa_5430.obj"
    return {
        "Bennu": body(bennu, BENNU, 20.0, 45.0),
        "Itokawa": body(itokawa, ITOKAWA, 20.0, 45.0),
        "slope of 45 deg (Itokawa)": body(itokawa, ITOKAWA, *steep_place(itokawa, ITOKAWA, 45.0)),
        "lander of 0.1 grains": {"lander": {"edges": [0.009, 0.009, 0.009], "mass": 1e-3}},
        "lander of 5 grains": {
            "lander": {"edges": [0.45, 0.45, 0.45], "mass": 60.0}, "bed": {"grain_count": 784, "width": [1.6, 1.6]},
        },
        "ball": {"lander": {"shape": "sphere", "edges": None, "diameter": 0.12}},
        "incidence 0 deg": {"delivery": {"incidence_deg": 0.0}},
        "incidence 89 deg": {"delivery": {"incidence_deg": 89.0}},
        "1 mm/s": {"delivery": {"speed": 0.001}},
        "1 m/s": {"delivery": {"speed": 1.0}},
    }  # fmt: skip


def ended(study: StudyResults) -> dict[str, Any]:
    """How the journeys of a case ended, and what they took."""
    results, journeys = study.results, study.journeys
    return {
        "ends": {name: one.count for name, one in results.ends.items() if one.count},
        "touchdowns": results.touchdowns,
        "most_contacts": int(journeys["contacts"].max()),
        "time_to_rest_median_s": results.rest.time_s.median.value,
        "distance_median_m": results.rest.distance_m.median.value,
        "cpu_s": float(np.nansum(study.touchdowns["cpu_s"])),
    }


def main() -> None:
    parser = command_line(__doc__, shapes=Path, work=Path("breadth"))
    parser.add_argument("--cases", nargs="*")
    given = parser.parse_args()
    path = Path(__file__).with_suffix(".json")
    few = {"journey": {"count": JOURNEYS}, "bed": {"bed_count": BEDS}}
    # Cases that are not asked for stay as they were found.
    found = read_document(path, {"cases": {}})["cases"] if given.cases else {}
    for name, changes in cases(given.shapes.absolute()).items():
        if given.cases and name not in given.cases:
            continue
        folder = given.work / "".join(letter if letter.isalnum() else "_" for letter in name)
        tables = study_tables(SCENARIOS / "one_ground.toml", few, changes)
        found[name] = ended(lithobrake.run(tables, folder, report=False))
        print(name, found[name], flush=True)
    document = {**origin("validation/journey_breadth.py --shapes FOLDER"), "journeys": JOURNEYS, "cases": found}
    write_document(path, document)


if __name__ == "__main__":
    main()
