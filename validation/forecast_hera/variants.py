"""What two choices of the forecast are worth: grains that are held, and the shape of Dimorphos. No part of it.

    python validation/forecast_hera/variants.py --work FOLDER [--shape FILE.obj] [--workers N]

Follows the landers of one branch, small libration, at the surface, near end, again: with grains held that move at less
than 0.03 of the lander's speed, in place of 0.1; and, with --shape, on the ellipsoid and on that shape, both without
Didymos, as a mesh has no partner in a study. The shape is moved to its centre of mass, turned to its principal axes and
scaled to the volume of the ellipsoid; masses stay. Writes variants.csv, a line for each lander, and variants.json, how
they compare and how they were made. What is in --work is not followed again.
"""

import json
import sys
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

import numpy as np
from answers import HERE, digest, quantiles
from branches import LANDERS, branches
from forecast import run_part
from harness import Row, command_line, origin, read_rows, write_document
from landers import COUNTS, KINDS, TABLE, write_landers

from lithobrake.pipeline.site import Site
from lithobrake.smallbody import Shape, dimorphos
from lithobrake.study import StudySource

VARIANTS, MADE = "variants.csv", "variants.json"
HELD, BASE, MESH = "held_speed 0.03", "ellipsoid, no Didymos", "shape model, no Didymos"
BRANCH = "small libration, at the surface, near end"
ALONE = {"site.partner": False, "site.rotation": None}
CHANGES: dict[str, dict[str, Any]] = {HELD: {"contact.held_speed": 0.03}, BASE: ALONE}


def mesh_changes(shape: Path, work: Path) -> dict[str, Any]:
    """Keys of a study on a shape model of the ellipsoid's volume, about its principal axes."""
    given = Shape.read(shape)
    ellipsoid = Site(StudySource.of_tables(branches(LANDERS[0])[0].tables(COUNTS["soil"])).study).body.shape
    _, axes = np.linalg.eigh(given.inertia_per_density)
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    vertices = (given.vertices - given.centroid) @ axes * (ellipsoid.volume / given.volume) ** (1.0 / 3.0)
    path = work / "shape.obj"
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in vertices] + [f"f {a} {b} {c}" for a, b, c in given.faces + 1]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    own = {"site.body": str(path.resolve()), "site.extents": None, "site.partner": None, "site.rotation": None}
    return own | {"site.spin_period": dimorphos().spin_period}


def main() -> None:
    """Follow the landers, and write them."""
    parser = command_line(__doc__, work=Path, out=HERE, workers=0, only="")
    parser.add_argument("--shape", type=Path)
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    changes = CHANGES | ({MESH: mesh_changes(options.shape, options.work)} if options.shape else {})
    rows, costs = [], {}
    for (variant, change), lander in product(changes.items(), LANDERS):
        (branch,) = (one for one in branches(lander) if one.name == BRANCH)
        changed, folder = replace(branch, changes={**branch.changes, **change}), options.work / variant.replace(" ", "-")
        found, cost = run_part(changed, "soil", COUNTS["soil"], folder, options.workers or None)
        rows += [{"variant": variant, **row} for row in found]
        costs[f"{variant}: {lander}"] = cost
        print(f"{variant}: {lander}: {cost}", flush=True)
    write_landers(options.out / VARIANTS, rows)


if __name__ == "__main__":
    main()
