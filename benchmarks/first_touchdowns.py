"""First touchdowns of a study to rest: what they cost, and how they end, by the engine of one checkout and of another.

    python benchmarks/first_touchdowns.py scenarios/one_ground.toml BED_FOLDER --way NAME --numbers 0 96 --out FILE

BED_FOLDER holds the beds of the study, bed_0.h5 and so on; poured by one engine they serve for both. --numbers: the
first touchdown, and the one before which it ends, which may be beyond those of the study. FILE_NAME_0.csv, with the
first number, gets a row a touchdown as it comes, with the face that is down at the end. Without --way nothing lands:
FILE.json is written from all tables FILE*.csv, each way beside the first, over the touchdowns that all have; see
slow_landings.py.
"""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from harness import command_line, origin, read_rows, table, write_document
from slow_landings import COLUMNS, landed, summary, ways_of

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.study import read_study
from lithobrake.touchdown import Bed, Lander, Landing
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.touchdown_model import landing

KINDS = dict.fromkeys(("way", "outcome", "face"), str) | dict.fromkeys(("landing", "bed"), int)


def arrivals(path: Path, beds: Path, first: int, end: int) -> Iterator[tuple[int, int, Bed, Lander, Landing]]:
    """Number, number of its bed, bed, lander and landing of some first touchdowns of a study."""
    study = with_site_gravity(read_study(path).with_run_count(end))
    for number, row in list(enumerate(DrawnDesign(study).rows))[first:]:
        bed = int(row["bed"])
        yield number, bed, Bed.load(beds / f"bed_{bed}.h5"), lander(study, row), landing(study, row)


def main() -> None:
    options = {"way": "", "numbers": [0, 96], "out": Path}
    given = command_line(__doc__, "study", "beds_in", **options).parse_args()
    if not given.way:
        tables = sorted(given.out.parent.glob(f"{given.out.name}*.csv"))
        rows = [row for path in tables for row in read_rows(path, KINDS)]
        made = Counter(row["landing"] for row in rows)
        rows = [row for row in rows if made[row["landing"]] == len(ways_of(rows))]
        command = f"benchmarks/first_touchdowns.py {given.study} BED_FOLDER --out {given.out}"
        found = {"touchdowns": len({row["landing"] for row in rows}), "ways": summary(rows)}
        write_document(given.out.with_suffix(".json"), origin(command) | found)
        return
    first, end = given.numbers
    with table(given.out.with_name(f"{given.out.name}_{given.way}_{first}.csv"), COLUMNS) as add:
        for number, index, bed, body, event in arrivals(given.study, given.beds_in, first, end):
            contact = event.contact
            way = f"{contact.steps_per_contact}:{contact.resolved_speed}:{contact.held_speed}"
            row = {"landing": number, "bed": index, "speed": event.speed} | landed(bed, body, event, way)
            add(row | {"way": given.way})


if __name__ == "__main__":
    main()
