"""Slow landings, as journeys consist of: what they cost, and whether cheaper steps change how they end.

    python benchmarks/slow_landings.py BED_FOLDER --landings 200 --speeds 0.003 0.02 --ways 25:0:0 25:0.3:0.03
        --share 0/2 --out FILE

Beds are those of first_bounce.toml on ground that repeats, poured into BED_FOLDER where they are not there yet.
Soil, bed, place, heading and attitude are drawn, the speed [m/s] between two (in its logarithm), the incidence up to
STEEPEST, the spin up to what turns the surface as fast as the lander comes. Every draw lands in each way,
steps:resolved_speed:held_speed, one after the other. FILE.csv gets a row a landing as it comes, with the face that is
down at the end; --share 0/2 makes every second draw, for two processes. Without --ways nothing lands: FILE.json is
written from all tables FILE*.csv, each way beside the first: pairs, with p of McNemar's exact test of the captures and
p of the chi-square test of the faces at rest. Draws that did not land in each way are left out.
"""

import math
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
from harness import Row, command_line, origin, read_rows, table, timed, write_document
from landing_ensembles import beds_of, drawn_study, draws
from scipy.stats import binomtest, chi2_contingency

from lithobrake.touchdown import Bed, Lander, Landing, land
from lithobrake.touchdown.bed import rotation_matrix

STUDY = Path(__file__).parents[1] / "scenarios" / "first_bounce.toml"
BEDS, GRAVITY, TIME_LIMIT, STEEPEST = 8, 4.5e-5, 1000.0, math.radians(80.0)
COMPARED = ("speed_out", "elevation_out", "spin_out")
COLUMNS = ["landing", "bed", "way", "speed", "outcome", "face", "simulated_s", "cpu_s", *COMPARED]


def arrivals(landings: int, slowest: float, fastest: float, folder: Path) -> list[tuple[Bed, int, Lander, Landing]]:
    """Bed, its number, lander and landing of each draw."""
    study = drawn_study(STUDY, BEDS, 0.1)
    study = study.model_copy(update={"bed": study.bed.model_copy(update={"sides": "periodic"})})
    beds, generator, found = beds_of(study, folder), np.random.default_rng(5), []
    for bed, body, event in draws(study, landings):
        speed = math.exp(generator.uniform(math.log(slowest), math.log(fastest)))
        incidence = STEEPEST * generator.random()
        spin = generator.uniform(-1.0, 1.0, 3) * speed / body.shape.bounding_radius
        event = replace(
            event, speed=speed, incidence=incidence, spin=tuple(spin), gravity=(0.0, 0.0, -GRAVITY),
            time_limit=TIME_LIMIT,
        )  # fmt: skip
        found.append((beds[bed], bed, body, event))
    return found


def landed(bed: Bed, body: Lander, event: Landing, way: str) -> Row:
    steps, resolved, held = (float(part) for part in way.split(":"))
    contact = replace(event.contact, steps_per_contact=steps, resolved_speed=resolved, held_speed=held)
    outcome, cpu = timed(lambda: land(bed, body, replace(event, contact=contact)))
    # Of the outward normals of the lander's axes the one that points down most: "-z" says that the -z side lies below.
    down = -rotation_matrix(np.array(outcome.orientation))[2]
    axis = int(np.abs(down).argmax())
    face = ("+" if down[axis] > 0.0 else "-") + "xyz"[axis]
    return {
        "way": way, "outcome": str(outcome.status), "face": face, "simulated_s": outcome.simulated_time, "cpu_s": cpu,
    } | {name: outcome.outputs[name] for name in COMPARED}  # fmt: skip


def compared(plain: list[Row], other: list[Row], name: str) -> Row:
    """Mean difference of the pairs of an output, over what both give, with its error."""
    x, y = (np.array([row[name] for row in rows]) for rows in (plain, other))
    both = np.isfinite(x) & np.isfinite(y)
    difference = (y - x)[both]
    return {
        "pairs": int(both.sum()), "mean": float(x[both].mean()), "difference": float(difference.mean()),
        "error": float(difference.std(ddof=1) / math.sqrt(both.sum())),
        "correlation": float(np.corrcoef(x[both], y[both])[0, 1]),
    }  # fmt: skip


def summary(rows: list[Row]) -> Row:
    """Each way beside the first."""
    by_way = {way: sorted((r for r in rows if r["way"] == way), key=lambda r: r["landing"]) for way in ways_of(rows)}
    plain = next(iter(by_way.values()))
    found: Row = {}
    for way, other in by_way.items():
        pairs = list(zip(plain, other, strict=True))
        captured = [pair for pair in pairs if all(row["outcome"] == "captured" for row in pair)]
        alone = [sum(a["outcome"] == "captured" != b["outcome"] for a, b in some)
                 for some in (pairs, [pair[::-1] for pair in pairs])]  # fmt: skip
        faces = [Counter(row["face"] for row in some if row["outcome"] == "captured") for some in (plain, other)]
        found[way] = {
            "outcomes": dict(Counter(row["outcome"] for row in other)),
            "captured_first_alone": alone[0], "captured_second_alone": alone[1],
            "captured_p": float(binomtest(alone[0], sum(alone)).pvalue) if sum(alone) else 1.0,
            "captured_both": len(captured), "same_face": sum(a["face"] == b["face"] for a, b in captured),
            "faces": dict(sorted(faces[1].items())), "faces_p": same_faces_p(*faces),
            "cpu_s_mean": float(np.mean([row["cpu_s"] for row in other])),
            "cpu_s_median": float(np.median([row["cpu_s"] for row in other])),
        } | {name: compared(plain, other, name) for name in COMPARED}  # fmt: skip
    return found


def same_faces_p(*faces: Counter[str]) -> float | None:
    """p of the chi-square test that landers lie on the same faces as often; None where none was captured."""
    table = [[some[face] for face in sorted(set().union(*faces))] for some in faces]
    return float(chi2_contingency(table).pvalue) if all(map(sum, table)) else None


def ways_of(rows: list[Row]) -> list[str]:
    """The ways in the order of the table."""
    return list(dict.fromkeys(row["way"] for row in rows))


def main() -> None:
    options = {"landings": 200, "speeds": [0.003, 0.02], "ways": [""], "share": "0/1", "out": Path}
    given = command_line(__doc__, "beds_in", **options).parse_args()
    if given.ways == [""]:
        kinds = dict.fromkeys(("way", "outcome", "face"), str) | dict.fromkeys(("landing", "bed"), int)
        tables = sorted(given.out.parent.glob(f"{given.out.name}*.csv"))
        rows = [row for path in tables for row in read_rows(path, kinds)]
        landed_in = Counter(row["landing"] for row in rows)
        rows = [row for row in rows if landed_in[row["landing"]] == len(ways_of(rows))]
        command = f"benchmarks/slow_landings.py BED_FOLDER --out {given.out}"
        found = {"landings": len({row["landing"] for row in rows}), "ways": summary(rows)}
        write_document(given.out.with_suffix(".json"), origin(command) | found)
        return
    part, parts = (int(number) for number in given.share.split("/"))
    with table(given.out.with_suffix(".csv"), COLUMNS) as add:
        for number, (bed, index, body, event) in enumerate(arrivals(given.landings, *given.speeds, given.beds_in)):
            if number % parts == part:
                for way in given.ways:
                    add({"landing": number, "bed": index, "speed": event.speed, **landed(bed, body, event, way)})


if __name__ == "__main__":
    main()
