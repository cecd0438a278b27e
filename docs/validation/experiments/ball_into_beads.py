"""A ball dropped into loose dry beads (X1): depth against density, fall height and diameter of the ball.

    python docs/validation/experiments/ball_into_beads.py --work FOLDER [SERIES ...]

SERIES is any of drops, places, diameters, box, softness, friction, restitution, step, similarity, repose (none: all).
Rows that stand in ball_into_beads.csv are not run again.

Source: Uehara et al. (2003), Phys. Rev. Lett. 90, 194301; Ambroso et al. (2005), Phys. Rev. E 71, 051305 and 72, 041305;
DEM-Engine, DEMdemo_BallDrop.cpp, for the set-up.
"""

import argparse
import math
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from repose import angle_of_repose
from similarity import similar_drops
from sphere_bed import Beads, Row, add_row, bulk_density, dropped, kept, read_rows

from lithobrake.dem import Material, Sphere

HERE = Path(__file__).parent
TABLE = HERE / "ball_into_beads.csv"
GRAVITY = 9.81
BALL = 0.0254
SIZES = tuple(round(2.5e-3 + 1e-4 * k, 6) for k in range(11))
# As in DEM-Engine's demonstration, but for the modulus: there 7e7 Pa.
GLASS = Material(young_modulus=1e7, poisson_ratio=0.24, restitution=0.9, friction=0.3, density=2500.0)
BED = Beads(diameters=SIZES, material=GLASS, gravity=GRAVITY, width=0.085, depth=0.085, seed=1)
SMALL = replace(BED, width=0.065, depth=0.06)
PACE = 2.5e-4  # s between looks at the ball


def drop_row(
    work: Path, name: str, beads: Beads, density: float, fall: float, diameter: float = BALL,
    place: tuple[float, float] = (0.0, 0.0), local: float = 0.0,
) -> Row:  # fmt: skip
    """Drop one ball into a bed; its path goes into the work folder."""
    world = kept(beads, work)
    start = time.process_time()
    bulk = bulk_density(world, beads)
    mass = density * math.pi / 6.0 * diameter**3
    result, path = dropped(world, Sphere(0.5 * diameter), beads.material, mass, place, fall, PACE, local)
    np.save(work / f"path_{name}.npy", path)
    return {
        "name": name, "density": density, "fall": fall, "diameter": diameter, "beads": beads.count,
        "width": beads.width, "bulk_density": bulk, "young_modulus": beads.material.young_modulus,
        "restitution": beads.material.restitution, "friction": beads.material.friction, **result,
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def changed(**values: float) -> Beads:
    """Return the small bed of another material."""
    return replace(SMALL, material=replace(GLASS, **values))


def series(work: Path) -> dict[str, list[tuple[str, dict]]]:
    """Return the drops of each series by name: the keywords of drop_row."""
    steel = {"density": 7800.0, "fall": 0.1}
    light = {"density": 2200.0, "fall": 0.1}
    return {
        "drops": [
            (f"drop_{density:g}_{fall:g}", {"beads": BED, "density": density, "fall": fall})
            for fall in (0.1, 0.05, 0.2) for density in (2200.0, 15000.0, 7800.0, 3800.0)
        ],
        "diameters": [
            (f"diameter_{d:g}_{density:g}", {"beads": BED, "density": density, "fall": 0.1, "diameter": d})
            for density in (2200.0,) for d in (0.0127, 0.019)
        ],
        "box": [
            *((f"box_small_{kind['density']:g}", {"beads": SMALL, **kind}) for kind in (light, steel)),
            ("box_low_2200", {"beads": replace(BED, depth=0.06), **light}),
        ],
        "places": [
            (f"place_{k}", {"beads": SMALL, **light, "place": place})
            for k, place in enumerate(((0.006, 0.0), (-0.006, 0.0), (0.0, 0.006), (0.0, -0.006)))
        ],
        "softness": [
            ("soft", {"beads": changed(young_modulus=2.5e6), **light}),
            ("stiff", {"beads": changed(young_modulus=7e7), **light}),
        ],
        "friction": [(f"friction_{mu:g}", {"beads": changed(friction=mu), **light}) for mu in (0.1, 0.5)],
        "restitution": [("restitution_0.5", {"beads": changed(restitution=0.5), **light})],
        "step": [("local", {"beads": SMALL, **light, "local": 20.0})],
    }  # fmt: skip


def missing(chosen: list[str], work: Path) -> Iterator[tuple[Path, Row]]:
    """Run what is asked for and has no row yet; yield each row and its table."""
    every = series(work)
    for kind in chosen:
        for name, keywords in every.get(kind, []):
            if name not in {row["name"] for row in read_rows(TABLE)}:
                yield TABLE, drop_row(work, name, **keywords)
    heaps = HERE / "repose.csv"
    if "repose" in chosen:
        for seed in range(1 + len(read_rows(heaps)), 4):
            yield heaps, angle_of_repose(SIZES, GLASS, GRAVITY, seed)
    pairs = HERE / "similarity.csv"
    if "similarity" in chosen and not read_rows(pairs):
        small = replace(BED, width=0.03, depth=0.02)
        for row in similar_drops(kept(small, work), small, Sphere(0.005), 2200.0, 0.05):
            yield pairs, row


def main() -> None:
    """Run the series asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("series", nargs="*")
    parser.add_argument("--work", type=Path, required=True, help="folder for beds and paths, made if it is not there")
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    chosen = given.series or [*series(given.work), "similarity", "repose"]
    for table, row in missing(chosen, given.work):
        add_row(table, row)
        print(row, flush=True)


if __name__ == "__main__":
    main()
