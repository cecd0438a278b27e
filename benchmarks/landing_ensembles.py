"""The same landings with contacts stepped in several ways: what they cost, and whether their statistics are the same.

    python benchmarks/landing_ensembles.py STUDY.toml BED_FOLDER --region 0.1 --beds 8 --landings 200
        --stepping global:30 local:15 local:25 --out FILE

Soils, beds, places (within the region [m] about the middle), headings and attitudes are drawn; every draw lands once
in each way, one after the other, so that ratios of CPU times are of the same minutes. Beds are poured into BED_FOLDER
where they are not there yet. FILE.csv gets a row a landing as it comes, FILE.json the comparison with the first way:
means with their errors, mean difference of pairs, correlation, p of the Kolmogorov-Smirnov test, ratio of CPU times.
"""

import math
import tomllib
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from harness import Row, command_line, origin, table, timed, write_document
from scipy.stats import ks_2samp

from lithobrake.chaos import sobol_sequence
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.random_inputs import draw
from lithobrake.pipeline.runs.beds import bed_recipe
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.study import Study, check_tables
from lithobrake.touchdown import Bed, Lander, Landing, land, pour_bed
from lithobrake.touchdown.lander_model import lander
from lithobrake.touchdown.touchdown_model import landing

COMPARED = ("speed_out", "elevation_out", "spin_out", "contact_duration", "penetration", "peak_acceleration")


def drawn_study(path: Path, bed_count: int, region: float) -> Study:
    """The study with places, headings and attitudes drawn."""
    tables = tomllib.loads(path.read_text())
    tables["bed"]["bed_count"] = bed_count
    tables["impact"].pop("place", None)
    ends = [-region, region]
    tables["impact"] |= {"region": {"x": ends, "y": ends}, "orientation": "random", "azimuth_deg": "random"}
    return with_site_gravity(check_tables(tables, path.parent))


def beds_of(study: Study, folder: Path) -> list[Bed]:
    """The beds of a study, poured where they are not there yet."""
    folder.mkdir(parents=True, exist_ok=True)
    for index in range(study.bed_count):
        path = folder / f"bed_{index}.h5"
        if not path.exists():
            pour_bed(bed_recipe(study, index)).save(path)
    return [Bed.load(folder / f"bed_{index}.h5") for index in range(study.bed_count)]


def draws(study: Study, count: int) -> Iterator[tuple[int, Lander, Landing]]:
    design = DrawnDesign(study)
    for number, row in enumerate(sobol_sequence(design.inputs, count, seed=3).tolist()):
        inputs = study.touchdown_medians() | dict(zip(design.inputs, row, strict=True))
        values = draw(study, inputs, 1000 + number, design.region)
        yield round(values["bed"]), lander(study, values), landing(study, values)


def landed(bed: Bed, body: Lander, arrival: Landing, way: str) -> Row:
    """Land once in a way: "local:15", "local:15:0.1" with resolved_speed, "local:15:0.1:0.03" with held_speed, too."""
    stepping, steps, resolved, held = (*way.split(":"), "0", "0")[:4]
    contact = replace(
        arrival.contact, stepping=stepping, steps_per_contact=float(steps), resolved_speed=float(resolved),
        held_speed=float(held),
    )  # fmt: skip
    outcome, cpu = timed(lambda: land(bed, body, replace(arrival, contact=contact)))
    return {"way": way, "outcome": str(outcome.status), "simulated_s": outcome.simulated_time, "cpu_s": cpu} | {
        name: outcome.outputs[name] for name in COMPARED
    }


def compared(plain: list[Row], other: list[Row]) -> Row:
    found: Row = {
        "outcomes": dict(Counter(row["outcome"] for row in other)),
        "same_outcome": float(np.mean([a["outcome"] == b["outcome"] for a, b in zip(plain, other, strict=True)])),
        # The first landing compiles the kernels.
        "cpu_ratio": sum(row["cpu_s"] for row in plain[1:]) / sum(row["cpu_s"] for row in other[1:]),
        "cpu_s_a_landing": float(np.mean([row["cpu_s"] for row in other[1:]])),
    }
    for name in COMPARED:
        x, y = (np.array([row[name] for row in rows], dtype=float) for rows in (plain, other))
        both = np.isfinite(x) & np.isfinite(y)
        difference, known = (y - x)[both], y[np.isfinite(y)]
        found[name] = {
            "mean": float(known.mean()), "error": float(known.std() / math.sqrt(len(known))),
            "difference": float(difference.mean()),
            "difference_error": float(difference.std() / math.sqrt(both.sum())),
            "correlation": float(np.corrcoef(x[both], y[both])[0, 1]),
            "ks_p": float(ks_2samp(x[np.isfinite(x)], known).pvalue),
        }  # fmt: skip
    return found


def main() -> None:
    ways = ["global:30", "local:15", "local:25"]
    options = {"region": 0.1, "beds": 8, "landings": 200, "stepping": ways, "out": Path}
    given = command_line(__doc__, "study", "beds_in", **options).parse_args()
    study = drawn_study(given.study, given.beds, given.region)
    beds, rows = beds_of(study, given.beds_in), {way: list[Row]() for way in given.stepping}
    command = (
        f"benchmarks/landing_ensembles.py {given.study} BED_FOLDER --region {given.region} --beds {given.beds} "
        f"--landings {given.landings} --stepping {' '.join(given.stepping)}"
    )
    columns = ["landing", "bed", "way", "outcome", "simulated_s", "cpu_s", *COMPARED]
    with table(given.out.with_suffix(".csv"), columns) as add:
        for number, (bed, body, arrival) in enumerate(draws(study, given.landings)):
            for way in given.stepping:
                row = landed(beds[bed], body, arrival, way)
                rows[way].append(row)
                add({"landing": number, "bed": bed, **row})
            plain = rows[given.stepping[0]]
            if number > 1:
                found = {way: compared(plain, rows[way]) for way in given.stepping}
                content = {**origin(command), "landings": number + 1, "ways": found}
                write_document(given.out.with_suffix(".json"), content)


if __name__ == "__main__":
    main()
