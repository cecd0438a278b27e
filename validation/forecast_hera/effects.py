"""What single choices of the forecast on unknown ground are worth: booms, wings, the shape before DART. No part of it.

    python validation/forecast_hera/effects.py --work FOLDER [--shape FILE.obj] [--workers N]

Each is a pair of studies which differ in one choice: controlled descents to the end that faces Didymos, of a Dimorphos
that turns with its orbit, as a mesh must in a study; the ground is that of the edition but for its finest grains,
FINEST, on which long booms are affordable. Landers of a pair arrive alike, on ground of the same kind and size, so
differences are taken lander by lander, with intervals over beds. With --shape, that shape stands for the ellipsoid:
moved to its centre of mass, turned to its principal axes, scaled to the same volume. Writes effects.csv, a line for
each lander, and effects.json as each pair ends. What is in --work is not followed again.
"""

import sys
import tomllib
from itertools import product
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import numpy as np
from answers import CORRELATION, DRAWS, HERE, digest
from assumptions import OPEN_GROUND, PRESET
from branches import SCENARIOS, STUDY, branches, changed
from changes import broad_sides, change
from forecast import cpu_seconds
from harness import Row, command_line, origin, read_document, write_document
from landers import rows_of, write_landers
from variants import BRANCH, mesh_changes

from lithobrake.pipeline import run_study
from lithobrake.pipeline.job import Silent
from lithobrake.pipeline.site import Site
from lithobrake.results import StudyResults
from lithobrake.smallbody import Shape, dimorphos
from lithobrake.study import StudySource

COMMAND = "effects.py --work FOLDER --shape FILE.obj"
TABLE, EFFECTS = "effects.csv", "effects.json"
FINEST = 0.25  # m
LANDERS_OF_PAIR, BEDS, SEED = 16, 8, 2600
BOOMS, WINGS, SHAPE = "four booms of 1.5 m", "two wings", "shape before DART"
# Each lander's plain study.
BOX = "box"


def lander_parts(name: str) -> STUDY:
    """The key of a lander's parts as a study file has them."""
    text = (SCENARIOS / f"{name}.toml").read_text(encoding="utf-8")
    return {"lander.part": tomllib.loads(text)["lander"]["part"]}


def partner() -> STUDY:
    """Keys of Didymos as the partner of a mesh."""
    of = dimorphos().partner
    assert of is not None
    wide, _, high = np.ptp(of.body.shape.vertices, axis=0)
    body = {
        "name": "didymos", "mass": of.body.mass, "diameter": float(wide), "polar_diameter": float(high),
        "spin_period": of.body.spin_period, "period": of.period,
    }  # fmt: skip
    return {"site.partner_body": body}


def pairs(shape: STUDY | None) -> list[tuple[str, str, STUDY]]:
    """Each effect: its name, the lander, and the keys of the study with it."""
    shapes = [] if shape is None else [(SHAPE, lander, shape) for lander in ("juventas", "milani")]
    return [
        *shapes, (BOOMS, "juventas", lander_parts("juventas_with_booms")),
        (WINGS, "milani", lander_parts("milani_with_wings")),
    ]  # fmt: skip


def tables(lander: str, changes: STUDY) -> STUDY:
    """The tables of one study of a pair."""
    (branch,) = (one for one in branches(lander) if one.name == BRANCH)
    counts = {
        "site.rotation": None, "seed": SEED, "journey.count": LANDERS_OF_PAIR, "bed.bed_count": BEDS,
        "title": f"{branch.name}: {lander}",
    }  # fmt: skip
    with_ground = changed(branch.tables(1), {**OPEN_GROUND, **counts, **changes})
    return with_ground | {"ground": {**PRESET, "finest": FINEST}}


def followed(name: str, lander: str, changes: STUDY, folder: Path, costs: Row, workers: int | None) -> list[Row]:
    """The landers of a study in a folder of work; costs gets its CPU time [s] where they were not there."""
    source, cpu = StudySource.of_tables(tables(lander, changes)), cpu_seconds()
    own = folder / f"{lander}_{name}".replace(" ", "-")
    is_new = not own.exists()
    run_study(source, own, until="runs", worker_count=workers, shown=Silent())
    study = StudyResults(own)
    if is_new:
        costs[f"{lander}: {name}"] = round(cpu_seconds() - cpu, 1)
    mass = Site(source.study).sampled(study.journeys.row_count)["mass"]
    return rows_of(study, {"lander": lander, "branch": BRANCH, "ground": "soil"}, mass)


def compared(before: list[Row], after: list[Row], lander: str) -> dict[str, Any]:
    """Landers at rest, median times and differences, with intervals of 90 % over beds."""

    def told(rows: list[Row]) -> Row:
        rests = [row for row in rows if row["end"] == "at_rest"]
        sides = broad_sides(lander)
        return {
            "landers": len(rows), "at_rest": len(rests), "broad_side": sum(row["face"] in sides for row in rests),
            "time_s": float(np.median([row["time_s"] for row in rests])),
        }  # fmt: skip

    found = {**change(before, after, lander), "at_rest": rest_change(before, after)}
    return {"before": told(before), "after": told(after), "change": found}


def rest_change(before: list[Row], after: list[Row]) -> dict[str, float]:
    """Difference of the fractions at rest of the same landers, and its interval of 90 %.

    Pairs rest in both, in one or in none of the studies: a Dirichlet posterior with one pair spread evenly over the
    four, and counts divided by their design effect, so that few pairs that are all alike have an interval.
    """
    both = [(one["end"] == "at_rest", other["end"] == "at_rest") for one, other in zip(before, after, strict=True)]
    counts = np.array([both.count(case) for case in product((True, False), repeat=2)])
    effect = 1.0 + (len(both) / len({row["bed"] for row in before}) - 1.0) * CORRELATION
    draws = np.random.default_rng(SEED).dirichlet(counts / effect + 0.25, DRAWS)
    lower, upper = np.quantile(draws[:, 2] - draws[:, 1], (0.05, 0.95))
    return {"value": float((counts[2] - counts[1]) / len(both)), "lower": float(lower), "upper": float(upper)}


def main() -> None:
    parser = command_line(__doc__, work=Path, out=HERE, workers=0)
    parser.add_argument("--shape", type=Path)
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    mesh: STUDY | None = None
    facts: Row = {}
    if options.shape:
        shape = Shape.read(options.shape)
        alone = mesh_changes(shape, options.work)
        mesh = {key: value for key, value in alone.items() if key != "site.partner"} | partner()
        facts = {"shape": options.shape.name, "shape_sha256": digest(options.shape), "volume_m3": shape.volume,
                 "facets": len(shape.faces)}  # fmt: skip
    workers, costs = options.workers or None, read_document(options.out / EFFECTS, {}).get("cpu_s", {})
    made: list[Row] = []
    rows: list[Row] = []
    plain: dict[str, list[Row]] = {}
    for name, lander, changes in pairs(mesh):
        if lander not in plain:
            plain[lander] = followed(BOX, lander, {}, options.work, costs, workers)
            rows += [{"effect": BOX, **row} for row in plain[lander]]
        own = followed(name, lander, changes, options.work, costs, workers)
        rows += [{"effect": name, **row} for row in own]
        made.append({"effect": name, "lander": lander, "beds": BEDS, **compared(plain[lander], own, lander)})
        write_landers(options.out / TABLE, rows)
        found = {"effects": made, "finest_m": FINEST, "cpu_s": costs, **facts}
        write_document(options.out / EFFECTS, found | origin(f"validation/forecast_hera/{COMMAND}"))
        print(name, lander, made[-1], flush=True)


if __name__ == "__main__":
    main()
