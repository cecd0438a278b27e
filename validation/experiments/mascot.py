"""A lander like MASCOT on a ball like Ryugu: contacts and time until it rests, as distributions (X8).

    python validation/experiments/mascot.py --work FOLDER

Landings with drawn speed, incidence, soil, bed, place, attitude and heading make an emulator; 20 000 landers then go
from impact to impact. Those whose first impact is like MASCOT's are taken out of them. Writes mascot.csv, a line for
each of these, and mascot.json.

Facts: [Scholten-2019] (times, number of contacts, way), [Watanabe-2019] (Ryugu).
"""

import csv
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull as Hull

import lithobrake

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import command_line, origin, write_document

HERE = Path(__file__).parent
# m, kg, s: a ball of Ryugu's volume, mass and spin.
RADIUS, MASS, PERIOD = 448.0, 4.50e11, 7.63262 * 3600.0
# First impact: what falls 41 m in 350 s under Ryugu's gravity comes down at .143 m/s, nearly straight.
FIRST_SPEED, FIRST_INCIDENCE = (0.125, 0.160), 25.0  # m/s, deg
MEASURED = {"contacts": 4, "time_s": 663.0, "way_m": 17.0}


def ball(path: Path) -> None:
    """Write an OBJ of a ball of the radius: 1280 facets."""
    count = 642
    turn = np.arange(count) * np.pi * (3.0 - 5.0**0.5)
    height = 1.0 - 2.0 * (np.arange(count) + 0.5) / count
    across = np.sqrt(1.0 - height**2)
    points = RADIUS * np.stack([across * np.cos(turn), across * np.sin(turn), height], axis=1)
    faces = Hull(points).simplices
    corners = points[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = (normal * corners[:, 0]).sum(axis=1) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in points] + [f"f {a} {b} {c}" for a, b, c in faces + 1]
    path.write_text("\n".join(lines) + "\n")


def study(body: Path) -> dict[str, Any]:
    """Return the study: everything about soil and grains is ours."""
    return {
        "title": "MASCOT on a ball like Ryugu", "seed": 1,
        "bed": {
            "grain_count": 160, "width": [1.3, 1.3], "diameter": {"distribution": "constant", "value": 0.16},
            "cloud_point_count": 14, "pour_gravity": 0.5,
        },
        "grain": {
            "density": 2000.0, "young_modulus": {"distribution": "log_uniform", "lower": 5e5, "upper": 5e6},
            "poisson_ratio": 0.25, "restitution": {"distribution": "uniform", "lower": 0.3, "upper": 0.8},
            "friction": {"distribution": "uniform", "lower": 0.5, "upper": 0.9},
        },
        "lander": {
            "shape": "box", "edges": [0.275, 0.29, 0.195], "mass": 10.0,
            "restitution": {"distribution": "uniform", "lower": 0.3, "upper": 0.8},
        },
        "impact": {
            "speed": {"distribution": "uniform", "lower": 0.005, "upper": 0.17},
            "incidence_deg": {"distribution": "uniform", "lower": 0.0, "upper": 88.0},
        },
        "surface": {"gravity": 1.5e-4},
        "design": {"run_count": 216},
        "monte_carlo": {"sample_count": 20_000},
        "site": {
            "body": str(body), "unit": "m", "mass": MASS, "spin_period": PERIOD, "latitude_deg": -22.0,
        },
        "flight": {"flight_count": 2000},
        "rest": {"count": 20_000, "duration": 86_400.0},
    }  # fmt: skip


def main() -> None:
    """Run the study, take out the landers, say how they compare."""
    parser = command_line(__doc__)
    parser.add_argument("--work", type=Path, required=True, help="folder of the study, made if it is not there")
    work = parser.parse_args().work
    work.mkdir(parents=True, exist_ok=True)
    ball(work / "ryugu_ball.obj")
    results = lithobrake.run(study((work / "ryugu_ball.obj").resolve()), work / "study")
    rest, samples = results.rest, results.samples
    soil = rest.where(rest["ground"] == "soil")
    first = soil["sample"].astype(int)
    speed, incidence = samples["impact.speed"][first], samples["impact.incidence_deg"][first]
    like = (speed > FIRST_SPEED[0]) & (speed < FIRST_SPEED[1]) & (incidence < FIRST_INCIDENCE)
    names = ("status", "time_s", "rebounds", "path_length", "impact_speed")
    with (HERE / "mascot.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["first_speed", "first_incidence_deg", *names])
        for row in np.flatnonzero(like):
            writer.writerow([f"{speed[row]:.4g}", f"{incidence[row]:.4g}", *(soil[name][row] for name in names)])
    document = {
        **origin("validation/experiments/mascot.py --work FOLDER"), "landers": int(like.sum()),
        "measured": MEASURED, "runs": results.summary["results"].get("runs"), "headline": results.headline,
    }  # fmt: skip
    write_document(HERE / "mascot.json", document)
    print(json.dumps(document, indent=1))


if __name__ == "__main__":
    main()
