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
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import numpy as np
from answers import HERE, digest
from assumptions import OPEN_GROUND, PRESET
from branches import SCENARIOS, STUDY, branches, changed
from changes import broad_sides, change
from forecast import cpu_seconds
from harness import Row, command_line, origin, write_document
from landers import rows_of, write_landers
from variants import BRANCH, mesh_changes

from lithobrake.pipeline import run_study
from lithobrake.pipeline.job import Silent
from lithobrake.pipeline.site import Site
from lithobrake.results import StudyResults
from lithobrake.smallbody import Shape, dimorphos
from lithobrake.study import StudySource

TABLE, EFFECTS = "effects.csv", "effects.json"
FINEST = 0.25  # m
LANDERS_OF_PAIR, BEDS, SEED = 16, 8, 2600
BOOMS, WINGS, SHAPE = "four booms of 1.5 m", "two wings", "shape before DART"
# Each lander's plain study, and those that differ from it.
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


def pairs(shape: STUDY | None) -> list[tuple[str, str, STUDY, STUDY]]:
    """Each effect: its name, the lander, and the keys of the study without and with it."""
    found = [
        (BOOMS, "juventas", {}, lander_parts("juventas_with_booms")),
        (WINGS, "milani", {}, lander_parts("milani_with_wings")),
    ]  # fmt: skip
    if shape is not None:
        found = [(SHAPE, lander, {}, shape) for lander in ("juventas", "milani")] + found
    return found


def tables(lander: str, changes: STUDY) -> STUDY:
    """The tables of one study of a pair."""
    (branch,) = (one for one in branches(lander) if one.name == BRANCH)
    counts = {
        "site.rotation": None, "seed": SEED, "journey.count": LANDERS_OF_PAIR, "bed.bed_count": BEDS,
        "title": f"{branch.name}: {lander}",
    }  # fmt: skip
    with_ground = changed(branch.tables(1), {**OPEN_GROUND, **counts, **changes})
    return with_ground | {"ground": {**PRESET, "finest": FINEST}}


def followed(name: str, lander: str, changes: STUDY, work: Path, workers: int | None) -> tuple[list[Row], float]:
    """The landers of a study and the CPU time that it took [s], 0 where they were there."""
    source, cpu = StudySource.of_tables(tables(lander, changes)), cpu_seconds()
    folder = work / f"{lander}_{name}".replace(" ", "-")
    is_new = not folder.exists()
    run_study(source, folder, until="runs", worker_count=workers, shown=Silent())
    study = StudyResults(folder)
    words = {"lander": lander, "branch": BRANCH, "ground": "soil"}
    mass = Site(source.study).sampled(study.journeys.row_count)["mass"]
    return rows_of(study, words, mass), cpu_seconds() - cpu if is_new else 0.0


def compared(before: list[Row], after: list[Row], lander: str) -> dict[str, Any]:
    """Landers at rest, median times and differences, with intervals of 90 % over beds."""

    def told(rows: list[Row]) -> Row:
        rests = [row for row in rows if row["end"] == "at_rest"]
        sides = broad_sides(lander)
        return {
            "landers": len(rows), "at_rest": len(rests), "broad_side": sum(row["face"] in sides for row in rests),
            "time_s": float(np.median([row["time_s"] for row in rests])),
        }  # fmt: skip

    return {"before": told(before), "after": told(after), "change": change(before, after, lander)}


def main() -> None:
    parser = command_line(__doc__, work=Path, out=HERE, workers=0)
    parser.add_argument("--shape", type=Path)
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    mesh, facts = None, {}
    if options.shape:
        shape = Shape.read(options.shape)
        alone = mesh_changes(shape, options.work)
        mesh = {key: value for key, value in alone.items() if key != "site.partner"} | partner()
        facts = {"shape": options.shape.name, "shape_sha256": digest(options.shape), "volume_m3": shape.volume,
                 "facets": len(shape.faces)}  # fmt: skip
    made: list[Row] = []
    plain: dict[str, list[Row]] = {}
    rows: list[Row] = []
    costs: dict[str, float] = {}
    for name, lander, without, with_it in pairs(mesh):
        if lander not in plain:
            plain[lander], costs[f"{lander}: {BOX}"] = followed(
                BOX, lander, without, options.work, options.workers or None
            )
            rows += [{"effect": BOX, **row} for row in plain[lander]]
        own, costs[f"{lander}: {name}"] = followed(name, lander, with_it, options.work, options.workers or None)
        rows += [{"effect": name, **row} for row in own]
        made.append({"effect": name, "lander": lander, "beds": BEDS, **compared(plain[lander], own, lander)})
        write_landers(options.out / TABLE, rows)
        write_document(
            options.out / EFFECTS,
            {"effects": made, "finest_m": FINEST, "cpu_s": costs, **facts}
            | origin("validation/forecast_hera/effects.py --work FOLDER --shape FILE.obj"),
        )
        print(name, lander, made[-1], flush=True)


if __name__ == "__main__":
    main()
