"""How right `lithobrake plan` is: CPU times of a bed, and of landings or journeys, expected and as they come.

    python benchmarks/plan_estimate.py first_bounce drawn_700 paper --beds 4 --landings 14
    python benchmarks/plan_estimate.py quick mission aim --beds 4 --landings 24

pours beds of each study of scenarios/ or validation/studies/, makes so many of its landings on the first, with slow
grains held and without, and keeps the means of what came beside what was expected in benchmarks/plan_estimate.json. Of
a study of journeys it follows so many of these on as many beds instead. `bed_costs` is how many landings or journeys a
bed costs: what default_bed_count in lithobrake/study/ground_sections.py stands on. The
constants of expected_steps.py and expected_time.py in lithobrake/pipeline/planning were taken from there.
"""

import json
import math
import statistics
import tempfile
from dataclasses import replace
from pathlib import Path

from harness import SCENARIOS, VALIDATION_STUDIES, Row, command_line, origin, read_document, timed, write_document

from lithobrake.campaign import read_records
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.planning.expected_steps import ExpectedSoil
from lithobrake.pipeline.planning.expected_time import REFERENCE, landing_time, mean_journey_time, pour_time, probe
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.study_run import run_study
from lithobrake.study import StudySource, load_tables, read_study
from lithobrake.touchdown import Bed, land, pour_bed

RESULTS = Path(__file__).with_suffix(".json")
STUDIES = {path.stem: path for folder in (SCENARIOS, VALIDATION_STUDIES) for path in sorted(folder.glob("*.toml"))}
HELD = (0.0, 0.03, 0.1)
COMPILED_BY = 8  # grains


def landed(bed: Bed, soil: ExpectedSoil, held: float, count: int) -> dict[str, float]:
    """Mean CPU time of landings after the first, found and expected [s]."""
    found, expected = [], []
    for body, event in soil.landings[1 : count + 2]:
        one = replace(event, contact=replace(event.contact, held_speed=held))
        found.append(timed(lambda body=body, one=one: land(bed, body, one))[1])
        expected.append(landing_time(soil, body, one))
    return {"held_speed": held, "cpu_s": statistics.fmean(found[1:]), "expected_s": statistics.fmean(expected[1:])}


def followed(name: str, soil: ExpectedSoil, bed_count: int, count: int) -> dict[str, float]:
    """Mean CPU time of journeys, found and expected [s], and how many touchdowns each has."""
    tables = dict(load_tables(STUDIES[name]))
    tables |= {"journey": tables["journey"] | {"count": count}, "bed": tables["bed"] | {"bed_count": bed_count}}
    with tempfile.TemporaryDirectory() as folder:
        run_study(StudySource.of_tables(tables), Path(folder), until="runs", worker_count=1)
        records = read_records(Path(folder) / "runs.sqlite")
    return {
        "cpu_s": sum(one.cpu_s or 0.0 for one in records) / count, "expected_s": mean_journey_time(soil),
        "touchdowns": len(records) / count,
    }  # fmt: skip


def measure(name: str, bed_count: int, count: int) -> Row:
    """Pour beds of a study and make so many of its landings on the first."""
    study = with_site_gravity(read_study(STUDIES[name]))
    soil = ExpectedSoil.of(DrawnDesign(study), len(study.touchdown_values()))
    paces = [probe() / REFERENCE]
    small = max(math.sqrt(COMPILED_BY / soil.recipe.grain_count) * soil.recipe.width[0], 2.0 * soil.recipe.sizes.upper)
    # Between walls, since few grains are too close to their images.
    pour_bed(replace(soil.recipe, grain_count=COMPILED_BY, width=(small, small), sides="walls"))
    pours = [timed(lambda seed=seed: pour_bed(replace(soil.recipe, seed=seed))) for seed in range(bed_count)]
    bed, seconds = pours[0][0], [seconds for _, seconds in pours]
    journeys = None if study.journey.touchdowns == 1 else followed(name, soil, bed_count, count)
    landings = [landed(bed, soil, held, count) for held in HELD] if journeys is None else []
    paces.append(probe() / REFERENCE)
    pour = {"cpu_s": statistics.fmean(seconds), "each_cpu_s": seconds, "expected_s": pour_time(soil)}
    pour |= {"depth_m": bed.surface_height, "expected_depth_m": soil.depth}
    # As the study makes them; grains are held where it says so.
    held = study.contact.held_speed
    one = journeys or min(landings, key=lambda row: abs(row["held_speed"] - held))
    return {
        "grains": soil.recipe.grain_count, "paces": paces, "pour": pour, "bed_costs": pour["cpu_s"] / one["cpu_s"],
        "count": count, "landings": landings, "journeys": journeys,
    }  # fmt: skip


def main() -> None:
    parser = command_line(__doc__, beds=4, landings=14)
    parser.add_argument("studies", nargs="+", choices=STUDIES)
    given = parser.parse_args()
    known = read_document(RESULTS, {})
    for name in given.studies:
        command = f"benchmarks/plan_estimate.py {name} --beds {given.beds} --landings {given.landings}"
        known[name] = {"result": measure(name, given.beds, given.landings), **origin(command)}
        write_document(RESULTS, known)
        print(name, json.dumps(known[name]["result"]), flush=True)


if __name__ == "__main__":
    main()
