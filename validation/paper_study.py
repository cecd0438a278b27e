"""The paper's way on ten other beds, and what the numbers of drawn_700.toml depend on in the model of the soil.

    python validation/paper_study.py [--work FOLDER] [--kinds twin "other beds" ...] [--out validation]

"twin": scenarios/paper.toml a tenth of a millimetre beside, at order 3. "other beds": the same study with seeds from 2
on, on beds as deep and wide as those of studies/drawn_700.toml. "numerics": that study with one number of the
model halved and doubled after the other. "grain sizes": on smaller grains, poured under so much more gravity that they
overlap as much. paper_study.json gets an entry a study as it ends; one that stands in it is not run again.
"""

import sys
import tempfile
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import lithobrake
from lithobrake.files.reading import hashed_seed
from lithobrake.results.study_files import json_values

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import SCENARIOS, VALIDATION_STUDIES, command_line, origin, read_document, write_document

Tables = dict[str, Any]
PAPER = SCENARIOS / "paper.toml"
DRAWN = VALIDATION_STUDIES / "drawn_700.toml"
OTHER_SEEDS = range(2, 12)
RUNS, BEDS = 640, 8
# Longest edge of the lander over the diameter of a grain: grains of a bed, and its width [m].
SIZES = {2.0: (500, 1.65), 5.0: (1200, 1.1)}
SIZE_RUNS = 320
ROOT_2 = 2.0**0.5
BESIDE = 1e-4  # m
PAIRED = ("speed_out", "elevation_out", "spin_out")


def walled(path: Path) -> Tables:
    """The tables of a study of the repository, its beds between walls."""
    tables = tomllib.loads(path.read_text())
    return tables | {"bed": {"sides": "walls"} | tables["bed"]}


def changed(tables: Tables, section: str, **values: Any) -> Tables:
    return tables | {section: tables[section] | values}


def at_order_3() -> Tables:
    """The paper's way with its first step alone, for the second is made of the same runs."""
    return changed(walled(PAPER), "expansion", refined_level=3, refined_degree=3, kept_share=1.0, test_count=10)


def twin() -> Iterator[tuple[str, Tables]]:
    """The paper's study where its lander comes down beside."""
    tables = at_order_3()
    yield "beside", changed(tables, "impact", place={"x": BESIDE})


def other_beds() -> Iterator[tuple[str, Tables]]:
    """The paper's method, bed by bed."""
    size = {name: walled(DRAWN)["bed"][name] for name in ("grain_count", "width")}
    tables = changed(at_order_3(), "bed", **size)
    for seed in OTHER_SEEDS:
        yield f"seed {seed}", changed(tables, "bed", seed=hashed_seed(seed, "bed", 0)) | {"seed": seed}


def numerics() -> Iterator[tuple[str, Tables]]:
    """The drawn study with one number halved and doubled after the other; the dearest last."""
    base = changed(changed(walled(DRAWN), "design", run_count=RUNS), "bed", bed_count=BEDS)
    base = changed(base, "monte_carlo", sample_count=10_000)
    grains, (width, _), points = base["bed"]["grain_count"], base["bed"]["width"], base["bed"]["cloud_point_count"]
    yield "as it is", base
    yield "steps a contact halved", changed(base, "contact", steps_per_contact=12.5)
    yield "steps a contact doubled", changed(base, "contact", steps_per_contact=50.0)
    yield "depth halved", changed(base, "bed", grain_count=grains // 2)
    yield "area halved", changed(base, "bed", grain_count=grains // 2, width=[width / ROOT_2] * 2)
    yield "points a hull halved", changed(base, "bed", cloud_point_count=points // 2)
    yield "points a hull doubled", changed(base, "bed", cloud_point_count=2 * points)
    yield "depth doubled", changed(base, "bed", grain_count=2 * grains)
    yield "area doubled", changed(base, "bed", grain_count=2 * grains, width=[width * ROOT_2] * 2)
    yield "no grain held", changed(base, "contact", held_speed=0.0)


def grain_sizes() -> Iterator[tuple[str, Tables]]:
    base = changed(walled(DRAWN), "monte_carlo", sample_count=10_000)
    base = changed(base, "design", run_count=SIZE_RUNS)
    coarse, gravity = base["bed"]["diameter"]["value"], base["bed"]["pour_gravity"]
    for ratio, (grains, width) in SIZES.items():
        size = max(base["lander"]["edges"]) / ratio
        soil = {"grain_count": grains, "width": [width] * 2, "bed_count": BEDS}
        sizes = {"distribution": "constant", "value": size}
        yield (
            f"lander {ratio:g} grains",
            changed(base, "bed", **soil, diameter=sizes, pour_gravity=gravity * coarse / size),
        )


def spread_of(found: Tables) -> Tables:
    """Mean, standard deviation and quantiles by output: of samples of an expansion, of landings of a drawn study."""
    if found["expansion"] is not None:
        of_samples: Tables = found["samples"]["outputs"]
        return of_samples
    return {
        name: {"mean": one["mean"]["value"], "std": one["standard_deviation"]}
        | {f"quantile_{level}": entry["value"] for level, entry in one["quantiles"].items()}
        for name, one in found["outputs"].items()
        if "quantiles" in one
    }


def told(found: Tables) -> Tables:
    """What the tables and figures need of a study's results."""
    analysis = found["expansion"]
    entry = {name: found[name] for name in ("returns", "headline", "outputs", "variance_shares")} | {
        "shares": found["shares"] if analysis is None else found["samples"]["shares"],
        "samples": spread_of(found),
    }
    if analysis is None:
        return entry | {"outcomes": found["runs"]["outcomes"]}
    designs = {name: design["outcomes"] for name, design in analysis["designs"].items()}
    return entry | {name: analysis[name] for name in ("screening", "refined", "scores")} | {"outcomes": designs}


def run_and_time(tables: Tables, folder: Path, workers: int | None) -> tuple[lithobrake.StudyResults, float]:
    """The results of a study, and the time that it took [s]; says both."""
    start = time.perf_counter()
    results = lithobrake.run(tables, folder, workers=workers, report=False)
    wall = time.perf_counter() - start
    print(folder.name, f"{wall:.0f} s", results.results.headline[0], flush=True)
    return results, wall


KINDS = {"twin": twin, "other beds": other_beds, "numerics": numerics, "grain sizes": grain_sizes}


def main() -> None:
    work = Path(tempfile.gettempdir()) / "lithobrake_paper_study"
    parser = command_line(__doc__, work=work, out=Path(__file__).parent)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--workers", type=int, default=None)
    given = parser.parse_args()
    path = given.out / "paper_study.json"
    entries = read_document(path, {"studies": []})["studies"]
    done = {(one["kind"], one["name"]) for one in entries}
    for kind in given.kinds:
        for name, tables in KINDS[kind]():
            if (kind, name) in done:
                continue
            results, wall = run_and_time(tables, given.work / f"{kind} {name}".replace(" ", "_"), given.workers)
            entry = {"kind": kind, "name": name, "wall_s": wall} | told(json_values(results.results))
            if kind == "twin":
                first = results.runs.where(results.runs["design"] == "screening")
                entry["screening_runs"] = {output: first[output].tolist() for output in PAIRED}
            entries.append(entry)
            write_document(path, {**origin("validation/paper_study.py"), "studies": entries})


if __name__ == "__main__":
    main()
