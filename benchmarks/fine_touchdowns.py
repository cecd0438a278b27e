"""What finer ground costs: touchdowns to rest on grains of 4.5 cm, and beds and landings on a tenth of the lander.

    python benchmarks/fine_touchdowns.py --count 6 --work FOLDER --out FILE

The lander of scenarios/one_ground.toml meets 560 grains of 4.5 cm in place of 96 of 9 cm, in its first COUNT drawn
touchdowns, each followed to its end. Bed 0 of "hulls 10" of validation/grain_size.py, with the first COUNT landings of
its first block, is the other half. FOLDER keeps the beds with what they cost; FILE.json gets the rows as they come.
"""

import json
import statistics
import sys
from collections.abc import Callable
from itertools import islice
from pathlib import Path

from harness import ROOT, SCENARIOS, Row, command_line, origin, read_rows, study_tables, timed, write_document

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.runs.beds import bed_recipe, compile_kernels
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.study import check_tables
from lithobrake.touchdown import Bed, land, pour_bed
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.touchdown_model import landing

sys.path.insert(0, str(ROOT / "validation"))
import grain_size

DIAMETER, GRAINS = 0.045, 560  # m
TENTH = "hulls 10"


def kept_bed(path: Path, pour: Callable[[], Bed]) -> tuple[Bed, float]:
    """Return a bed and the CPU time [s] of its pour; both are read where they stand on disk."""
    note = path.with_suffix(".json")
    if not note.exists():
        poured, cpu = timed(pour)
        poured.save(path)
        write_document(note, {"cpu_s": cpu})
    return Bed.load(path), json.loads(note.read_text())["cpu_s"]


def to_rest(work: Path, count: int, add: Callable[[Row], None]) -> None:
    """First touchdowns of the study on the finer bed, each to its end."""
    size = {"diameter": {"distribution": "constant", "value": DIAMETER}, "grain_count": GRAINS, "bed_count": 1}
    tables = study_tables(SCENARIOS / "one_ground.toml", {"bed": size})
    study = with_site_gravity(check_tables(tables, SCENARIOS))
    bed, cpu = kept_bed(work / "to_rest.h5", lambda: pour_bed(bed_recipe(study, 0)))
    add({"ground": "4.5 cm", "what": "bed", "cpu_s": cpu})
    for row in DrawnDesign(study.with_run_count(count)).rows:
        body, event = lander(study, row), landing(study, row)
        outcome, cpu = timed(lambda body=body, event=event: land(bed, body, event))
        found = {"outcome": str(outcome.status), "simulated_s": outcome.simulated_time}
        add({"ground": "4.5 cm", "what": "touchdown", "cpu_s": cpu} | found)


def a_tenth(work: Path, count: int, add: Callable[[Row], None]) -> None:
    """Bed and landings of the ladder of grain sizes, grains of a tenth of the lander's longest edge."""
    ground, table = grain_size.GROUNDS[TENTH], work / "tenth.csv"
    poured = grain_size.bed(TENTH, ground, 0, work, table)
    add({"ground": TENTH, "what": "bed", "cpu_s": read_rows(table, {"ground": str})[0]["cpu_s"]})
    for way, number, key in islice(grain_size.landings_of(ground), count):
        row = grain_size.landed(ground, way, 0, poured, number, key)
        found = {"outcome": row["status"], "simulated_s": row["time"]}
        add({"ground": TENTH, "what": "touchdown", "cpu_s": row["cpu_s"]} | found)


def medians(rows: list[Row]) -> Row:
    """Median CPU time [s] of each ground and part."""
    keys = sorted({(row["ground"], row["what"]) for row in rows})
    return {
        f"{ground}, {what}": statistics.median(
            row["cpu_s"] for row in rows if (row["ground"], row["what"]) == (ground, what)
        )
        for ground, what in keys
    }


def main() -> None:
    given = command_line(__doc__, count=6, work=Path, out=Path).parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    # The first bed would count the compilation, too.
    compile_kernels(lambda *_: None)
    rows: list[Row] = []

    def add(row: Row) -> None:
        rows.append(row)
        print(json.dumps(row), flush=True)
        content = origin(f"benchmarks/fine_touchdowns.py --count {given.count}")
        write_document(given.out.with_suffix(".json"), content | {"median_cpu_s": medians(rows), "rows": rows})

    to_rest(given.work, given.count, add)
    a_tenth(given.work, given.count, add)


if __name__ == "__main__":
    main()
