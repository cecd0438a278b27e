"""What two choices of the forecast are worth: grains that are held, and the shape of Dimorphos. No part of it.

    python validation/forecast_hera/variants.py --work FOLDER [--shape FILE.obj] [--workers N]

Follows the landers of one branch, small libration, at the surface, near end, again: with grains held that move at less
than 0.03 of the lander's speed, in place of 0.1; and, with --shape, on the ellipsoid and on that shape, both without
Didymos, as a mesh has no partner in a study. The shape is moved to its centre of mass, turned to its principal axes and
scaled to the volume of the ellipsoid; masses stay. Writes variants.csv, a line for each lander, and variants.json, how
they compare and how they were made. What is in --work is not followed again.
"""

import sys
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import numpy as np
from answers import FIRST_EDITION, HERE, SEED, digest
from assumptions import FIRST
from branches import LANDERS, branches
from forecast import run_part
from harness import Row, command_line, origin, read_rows, write_document
from landers import KINDS, TABLE, write_landers

from lithobrake.pipeline.site import Site
from lithobrake.smallbody import Shape, dimorphos
from lithobrake.study import StudySource

VARIANTS, COMPARED = "variants.csv", "variants.json"
BRANCH = "small libration, at the surface, near end"
FORECAST_ROWS, HELD, ALONE, MESH = "the forecast", "held_speed 0.03", "ellipsoid alone", "shape model alone"
# What each is compared with.
BESIDE = {HELD: FORECAST_ROWS, MESH: ALONE}
CHANGES: dict[str, dict[str, Any]] = {
    HELD: {"contact.held_speed": 0.03},
    ALONE: {"site.partner": False, "site.rotation": None},
}
DRAWS = 1000


def mesh_changes(shape: Shape, work: Path) -> dict[str, Any]:
    """Keys of a study on a shape model without a partner, about its principal axes and of the ellipsoid's volume."""
    ellipsoid = Site(StudySource.of_tables(branches(LANDERS[0])[0].tables(FIRST.counts["soil"])).study).body.shape
    _, axes = np.linalg.eigh(shape.inertia_per_density)
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    vertices = (shape.vertices - shape.centroid) @ axes * (ellipsoid.volume / shape.volume) ** (1.0 / 3.0)
    path = work / "shape.obj"
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in vertices] + [f"f {a} {b} {c}" for a, b, c in shape.faces + 1]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    own = {"site.body": str(path.resolve()), "site.spin_period": dimorphos().spin_period}
    return own | dict.fromkeys(("site.extents", "site.partner", "site.rotation"))


def beside(rows: list[Row], before: list[Row]) -> Row:
    """How landers compare with the same landers before: at rest, and the ratio of median times to rest.

    The interval of the ratio, 90 %, resamples beds, each with its landers of both.
    """
    both = [(one, two) for one, two in zip(rows, before, strict=True) if one["end"] == two["end"] == "at_rest"]
    times = np.array([[one["time_s"], two["time_s"]] for one, two in both])
    bed = np.array([two["bed"] for _, two in both])
    members, random = [np.flatnonzero(bed == one) for one in np.unique(bed)], np.random.default_rng(SEED)
    drawn = [
        np.concatenate([members[k] for k in random.integers(len(members), size=len(members))]) for _ in range(DRAWS)
    ]
    lower, upper = np.quantile([np.divide(*np.median(times[one], axis=0)) for one in drawn], (0.05, 0.95))
    return {
        "landers": len(rows), "at_rest": sum(one["end"] == "at_rest" for one in rows),
        "at_rest_before": sum(one["end"] == "at_rest" for one in before),
        "median_time_s": float(np.median(times[:, 0])), "median_time_before_s": float(np.median(times[:, 1])),
        "time_ratio": float(np.divide(*np.median(times, axis=0))), "lower": float(lower), "upper": float(upper),
    }  # fmt: skip


def compared(rows: list[Row]) -> list[Row]:
    """Each variant and lander beside what it is compared with, as far as both are there."""
    found = []
    for (variant, other), lander in product(BESIDE.items(), LANDERS):
        after, before = (
            [row for row in rows if (row["variant"], row["lander"]) == (one, lander)] for one in (variant, other)
        )
        if after and before:
            found.append({"variant": variant, "beside": other, "lander": lander, **beside(after, before)})
    return found


def main() -> None:
    parser = command_line(__doc__, work=Path, out=HERE, workers=0)
    parser.add_argument("--shape", type=Path)
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    changes, shapes = dict(CHANGES), {}
    if options.shape:
        shape = Shape.read(options.shape)
        changes[MESH] = mesh_changes(shape, options.work)
        shapes = {"shape": options.shape.name, "shape_sha256": digest(options.shape), "volume_m3": shape.volume}
    forecast = [
        row for row in read_rows(FIRST_EDITION / TABLE, KINDS) if (row["branch"], row["ground"]) == (BRANCH, "soil")
    ]
    rows, costs = [{"variant": FORECAST_ROWS, **row} for row in forecast], {}
    for (variant, change), lander in product(changes.items(), LANDERS):
        (branch,) = (one for one in branches(lander) if one.name == BRANCH)
        changed, folder = (
            replace(branch, changes={**branch.changes, **change}),
            options.work / variant.replace(" ", "-"),
        )
        found, cost = run_part(changed, "soil", FIRST.counts["soil"], folder, options.workers or None)
        rows += [{"variant": variant, **row} for row in found]
        costs[f"{variant}: {lander}"] = cost
        print(f"{variant}: {lander}: {cost}", flush=True)
    write_landers(options.out / VARIANTS, rows[len(forecast) :])
    made = {"compared": compared(rows), "cost": costs, **shapes}
    write_document(options.out / COMPARED, made | origin("validation/forecast_hera/variants.py --work FOLDER"))


if __name__ == "__main__":
    main()
