"""What one bed hides: the same question asked of one bed and place, and of many, with one seed after the other.

    python validation/one_bed.py [--seeds 20] [--work FOLDER] [--out validation]

Runs scenarios/one_place.toml (the paper's way) and scenarios/first_bounce.toml (every landing a draw) with seeds from
FIRST_SEED on, which differ in their pours too. Then that with finer grains in a bed of the same size, with side
runs, which split soil, place and chaos. one_bed.json gets an entry a study as it ends; a study that stands in it is not
run again: delete it to start anew. validation/one_bed_figures.py draws them.
"""

import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

from paper_study import run_and_time

import lithobrake
from lithobrake.files.reading import hashed_seed
from lithobrake.results.study_files import json_values

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, command_line, origin, read_document, write_document

FIRST_SEED = 101
# Enough to see how far apart they are.
ONE_PLACE_SEEDS = 10
QUESTIONS = {"one place": "one_place", "draws": "first_bounce"}
DIAMETERS = (0.12, 0.09, 0.065)  # m; the lander measures 0.1 x 0.1 x 0.227 m
SPEED, ELEVATION = "speed_out", "elevation_out"


def scenario(name: str, seed: int) -> dict[str, Any]:
    """The tables of a study of the repository, with another seed, and between walls on the beds of one_place.toml."""
    tables, place = (tomllib.loads((SCENARIOS / f"{one}.toml").read_text()) for one in (name, "one_place"))
    one_bed = {"bed_count": 1, "seed": hashed_seed(seed, "bed", 0)}
    ground = {key: value for key, value in place["bed"].items() if key not in one_bed}
    return tables | {"seed": seed, "bed": ground | (one_bed if "expansion" in tables else {})}


def with_grains(tables: dict[str, Any], diameter: float) -> dict[str, Any]:
    """The same study over grains of a diameter [m] that fill the same volume, with side runs."""
    count = round(tables["bed"]["grain_count"] * (tables["bed"]["diameter"]["value"] / diameter) ** 3)
    grains = {"grain_count": count, "diameter": {"distribution": "constant", "value": diameter}}
    design = tables["design"] | {"run_count": 100, "side_runs": True}
    return tables | {"bed": tables["bed"] | grains, "design": design}


def studies(seeds: int) -> list[tuple[str, float, dict[str, Any]]]:
    """Kind, grain diameter [m] and tables of every study."""
    own = scenario("first_bounce", FIRST_SEED)["bed"]["diameter"]["value"]
    pairs = [
        (kind, own, scenario(name, FIRST_SEED + k))
        for k in range(seeds)
        for kind, name in QUESTIONS.items()
        if kind == "draws" or k < ONE_PLACE_SEEDS
    ]
    return pairs + [("grain sizes", d, with_grains(scenario("first_bounce", FIRST_SEED), d)) for d in DIAMETERS]


def told(results: lithobrake.StudyResults) -> dict[str, Any]:
    """What the table and the figures need of a study."""
    found = json_values(results.results)
    samples, analysis = found["samples"]["outputs"], found["expansion"]
    entry = {
        "returns": found["returns"], "variance_shares": found["variance_shares"], "headline": found["headline"],
        "mean": {name: samples[name]["mean"] for name in (SPEED, ELEVATION)},
        "std": {name: samples[name]["std"] for name in (SPEED, ELEVATION)},
    }  # fmt: skip
    if analysis is None:
        entry["runs"] = found["runs"]
    else:
        entry["sobol_first"] = analysis["refined"]["sobol_first"][SPEED]
        entry["q2"] = analysis["scores"]["test_all"][SPEED]["q2"]
        entry["outcomes"] = {name: design["outcomes"] for name, design in analysis["designs"].items()}
    return entry


def main() -> None:
    work = Path(tempfile.gettempdir()) / "lithobrake_one_bed"
    parser = command_line(__doc__, seeds=20, work=work, out=Path(__file__).parent)
    parser.add_argument("--workers", type=int, default=None)
    given = parser.parse_args()
    path = given.out / "one_bed.json"
    entries = read_document(path, {"studies": []})["studies"]
    done = {(e["kind"], e["diameter_m"], e["seed"]) for e in entries}
    for kind, diameter, tables in studies(given.seeds):
        key = (kind, diameter, tables["seed"])
        if key in done:
            continue
        folder = given.work / f"{kind} {diameter:g} {tables['seed']}".replace(" ", "_")
        results, wall = run_and_time(tables, folder, given.workers)
        entries.append(dict(zip(("kind", "diameter_m", "seed"), key, strict=True)) | {"wall_s": wall} | told(results))
        command = f"validation/one_bed.py --seeds {given.seeds}"
        write_document(path, {**origin(command), "studies": entries})


if __name__ == "__main__":
    main()
