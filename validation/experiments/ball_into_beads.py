"""A ball dropped into loose dry beads (X1): depth against density, fall height and diameter of the ball.

    python validation/experiments/ball_into_beads.py --work FOLDER [--beads 5] [SERIES ...]

SERIES is any of drops, repose, similarity, places, diameters, box, grains, step (none: all). --beads: mean diameter of
the beads in mm; the experiment's are 3 mm, larger ones are fewer. Rows that stand in ball_into_beads.csv are not run
again.

Source: [Uehara-2003]; [Ambroso-2005]; [Ambroso-2005b]; for the set-up DEM-Engine's DEMdemo_BallDrop.cpp.
"""

import math
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from repose import angle_of_repose
from similarity import similar_drops
from sphere_bed import Beads, Row, bulk_density, dropped, kept, note, read_rows, work_folder

from lithobrake.dem import Material, Sphere

HERE = Path(__file__).parent
TABLE = HERE / "ball_into_beads.csv"
GRAVITY = 9.81
BALL = 0.0254
SPREAD = tuple((25 + k) / 30 for k in range(11))  # eleven sizes from 5/6 to 7/6 of the mean
# As in DEM-Engine's demonstration, but for the modulus: there 7e7 Pa.
GLASS = Material(young_modulus=1e7, poisson_ratio=0.24, restitution=0.9, friction=0.3, density=2500.0)
PACE = 5e-4  # s between looks at the ball


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
        "name": name, "density": density, "fall": fall, "diameter": diameter,
        "bead_size": beads.mean_diameter,
        "beads": beads.count, "width": beads.width, "bed_depth": beads.depth, "bulk_density": bulk,
        "young_modulus": beads.material.young_modulus,
        "restitution": beads.material.restitution, "friction": beads.material.friction, **result,
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def bed_of(size: float, width: float = 3.0 * BALL, depth: float = 0.085, **material: float) -> Beads:
    """Return the bed of a mean bead size [m]: three ball diameters wide, and 3.3 deep."""
    sizes = tuple(round(share * size, 7) for share in SPREAD)
    return Beads(
        diameters=sizes, material=replace(GLASS, **material), gravity=GRAVITY, width=width, depth=depth, seed=1
    )  # fmt: skip


def other_beds(size: float) -> dict[str, dict[str, Beads]]:
    """Return the beds that differ from that of the drops in one respect, by series and name."""
    return {
        "box": {
            "wider": bed_of(size, width=6.0 * BALL), "high": bed_of(size, depth=0.12), "low": bed_of(size, depth=0.05),
            "wide": bed_of(size, width=4.0 * BALL), "narrow": bed_of(size, width=2.25 * BALL),
        },
        "grains": {
            "poured_slowly": replace(bed_of(size), fall_speed=0.6),
            **{f"friction_{mu:g}": bed_of(size, friction=mu) for mu in (0.1, 0.6)},
            "restitution_0.5": bed_of(size, restitution=0.5),
            **{f"modulus_{modulus:g}": bed_of(size, young_modulus=modulus) for modulus in (2.5e6, 7e7)},
        },
    }  # fmt: skip


def series(size: float) -> dict[str, list[tuple[str, Row]]]:
    """Return the drops of each series by name: the keywords of drop_row."""
    bed = bed_of(size)
    light = {"density": 2200.0, "fall": 0.1}
    heavy = {"density": 15000.0, "fall": 0.1}
    found: dict[str, list[tuple[str, Row]]] = {
        "drops": [
            (f"drop_{density:g}_{fall:g}", {"beads": bed, "density": density, "fall": fall})
            for fall in (0.1, 0.05, 0.2) for density in (2200.0, 15000.0, 7800.0, 3800.0)
        ],
        "places": [
            (f"place_{k}", {"beads": bed, **light, "place": place})
            for k, place in enumerate(((0.006, 0.0), (-0.006, 0.0), (0.0, 0.006), (0.0, -0.006)))
        ],
        "diameters": [(f"diameter_{d:g}", {"beads": bed, **light, "diameter": d}) for d in (0.0127, 0.018, 0.036)],
        "step": [("local_steps", {"beads": bed, **light, "local": 15.0})],
    }  # fmt: skip
    for kind, beds in other_beds(size).items():
        # A light and a heavy ball: what a bed changes of the exponent of density.
        found[kind] = [
            (name + end, {"beads": other, **ball})
            for name, other in beds.items() for end, ball in (("", light), ("_heavy", heavy))
        ]  # fmt: skip
    return {kind: [(f"{1e3 * size:g}mm_{name}", row) for name, row in rows] for kind, rows in found.items()}


def missing(chosen: list[str], work: Path, size: float) -> Iterator[tuple[Path, Row]]:
    """Run what is asked for and has no row yet; yield each row and its table."""
    every = series(size)
    for kind in chosen:
        for name, keywords in every.get(kind, []):
            if name not in {row["name"] for row in read_rows(TABLE)}:
                yield TABLE, drop_row(work, name, **keywords)
    heaps = HERE / "repose.csv"
    if "repose" in chosen:
        for seed in range(1 + len(read_rows(heaps)), 3):
            yield heaps, angle_of_repose(bed_of(size), seed)
    pairs = HERE / "similarity.csv"
    if "similarity" in chosen and not read_rows(pairs):
        small = bed_of(0.003, width=0.03, depth=0.02)
        for row in similar_drops(kept(small, work), small, Sphere(0.005), 2200.0, 0.05):
            yield pairs, row


def main() -> None:
    """Run the series asked for."""
    parser = work_folder(__doc__)
    parser.add_argument("series", nargs="*")
    parser.add_argument("--beads", type=float, default=5.0, help="mean diameter of the beads [mm]")
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    chosen = given.series or [*series(0.005), "similarity", "repose"]
    for table, row in missing(chosen, given.work, 1e-3 * given.beads):
        note(table, row, f"ball_into_beads.py --work FOLDER --beads {given.beads:g}")


if __name__ == "__main__":
    main()
