"""A spacecraft's plate that meets loose grains in almost no gravity: OSIRIS-REx on Bennu (X3).

    python validation/experiments/plate_into_loose_grains.py --work FOLDER [--cases NAME ...]

1300 kg on a round plate of 32 cm come down at 10 cm/s on grains that fill a given share of their box. Six seconds later
OSIRIS-REx still went down at about 4 cm/s [Walsh-2022]. Bennu's gravity moves nothing by more than a millimetre in that
time, so none acts here, and a bed may be as loose as one likes. Rows that stand in plate_into_loose_grains.csv are not
run again.
"""

import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree
from sphere_bed import Floats, Row, add_box, note, read_rows, work_folder

from lithobrake.dem import ConvexHull, Material, Sphere, World

TABLE = Path(__file__).parent / "plate_into_loose_grains.csv"
MASS, PLATE, SPEED, FOLLOWED = 1300.0, 0.32, 0.1, 6.0  # kg, m, m/s, s: [Walsh-2022]
THICK = 0.08  # m, of our plate; the head of OSIRIS-REx goes on behind its plate
LOOK = 0.05  # s
STEPS = 20.0  # of its own that each contact takes
# How far grains that are being put may still overlap, in their mean diameter: then all are made so much smaller.
PUT = 2e-3


@dataclass(frozen=True, kw_only=True)
class Soil:
    """What a run follows from beside the plate."""

    filled: float  # share of the box that grains fill
    grain: float = 0.07  # m, mean diameter; between .8 and 1.2 of it
    width: float = 1.6  # m, of the box
    depth: float = 1.0  # m
    friction: float = 0.6
    rolling_friction: float = 0.1
    cohesion: float = 0.0  # Pa: the pull of a contact over the square of the mean diameter
    young_modulus: float = 1e6  # Pa
    seed: int = 1

    @property
    def material(self) -> Material:
        """The grains. Their density is ours."""
        return Material(
            young_modulus=self.young_modulus, poisson_ratio=0.25, restitution=0.5, friction=self.friction,
            density=2000.0, rolling_friction=self.rolling_friction, cohesion_force=self.cohesion * self.grain**2,
        )  # fmt: skip


def cases() -> dict[str, Soil]:
    """Return what is run, by name."""
    loose, dense = Soil(filled=0.45), Soil(filled=0.58)
    found = {f"filled_{share:g}": replace(loose, filled=share) for share in (0.3, 0.4, 0.45, 0.5, 0.55, 0.58)}
    for name, soil in (("loose", loose), ("dense", dense)):
        found |= {f"{name}_cohesion_{pull:g}Pa": replace(soil, cohesion=pull) for pull in (10.0, 100.0)} | {
            f"{name}_smooth": replace(soil, friction=0.2, rolling_friction=0.0),
            f"{name}_round": replace(soil, rolling_friction=0.0),
            f"{name}_stiffer": replace(soil, young_modulus=4e6),
            f"{name}_finer": replace(soil, grain=0.055),
            f"{name}_wider": replace(soil, width=2.0),
            f"{name}_deeper": replace(soil, depth=1.4),
            f"{name}_again": replace(soil, seed=2),
        }
    return found


def put(soil: Soil) -> tuple[Floats, Floats]:
    """Return places and radii [m] of grains that about fill their share of the box and nowhere overlap.

    They begin anywhere and are pushed apart, each of an overlapping pair by a little more than half its overlap.
    """
    generator = np.random.default_rng(soil.seed)
    volume = soil.filled * soil.width**2 * soil.depth
    radius = 0.5 * soil.grain * generator.uniform(0.8, 1.2, round(volume / (np.pi / 6.0 * soil.grain**3) / 1.04))
    radius *= np.cbrt(volume / (4.0 / 3.0 * np.pi * radius**3).sum())
    half = np.array([0.5 * soil.width, 0.5 * soil.width, 0.5 * soil.depth])
    place = generator.uniform(-1.0, 1.0, (len(radius), 3)) * (half - radius[:, None])
    while True:
        pair = cKDTree(place).query_pairs(2.0 * radius.max(), output_type="ndarray")
        between = place[pair[:, 1]] - place[pair[:, 0]]
        far = np.linalg.norm(between, axis=1)
        overlap = radius[pair].sum(axis=1) - far
        worst = float(overlap.max(initial=0.0))
        if worst <= PUT * soil.grain:
            break
        pressed = overlap > 0.0
        push = (0.55 * overlap / np.maximum(far, 1e-12))[pressed, None] * between[pressed]
        np.subtract.at(place, pair[pressed, 0], push)
        np.add.at(place, pair[pressed, 1], push)
        place = np.clip(place, radius[:, None] - half, half - radius[:, None])
    radius -= 0.5 * worst
    return place - [0.0, 0.0, half[2]], radius


def kept(soil: Soil, work: Path) -> tuple[Floats, Floats]:
    """Return places and radii [m] of grains from the work folder, put if they are not there."""
    path = work / f"grains_{soil.filled:g}_{soil.grain:g}_{soil.width:g}_{soil.depth:g}_{soil.seed}.npz"
    if not path.exists():
        place, radius = put(soil)
        np.savez(path, place=place, radius=radius)
    with np.load(path) as grains:
        return grains["place"], grains["radius"]


def bulk_density(radius: Floats, soil: Soil) -> float:
    """Return the mass of all grains over the volume of their box [kg/m3]."""
    volume = float((4.0 / 3.0 * np.pi * radius**3).sum())
    return soil.material.density * volume / (soil.width**2 * soil.depth)


def plate() -> ConvexHull:
    """Return a round plate: two rings of 24 corners."""
    turn = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    ring = 0.5 * PLATE * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return ConvexHull(
        np.concatenate([np.column_stack([ring, np.full(24, height)]) for height in (-0.5 * THICK, 0.5 * THICK)])
    )


def pressed_in(soil: Soil, work: Path) -> tuple[Row, Floats]:
    """Let the plate come down; return the row and the path: time [s], depth of its underside [m], speed [m/s]."""
    place, radius = kept(soil, work)
    start = time.process_time()
    world, stuff = World(), soil.material
    for point, size in zip(place, radius, strict=True):
        world.add_body(Sphere(float(size)), stuff, point)
    add_box(world, soil.width, -soil.depth, stuff)
    # The whole spacecraft is behind it: it hardly turns.
    body = world.add_body(
        plate(), replace(stuff, cohesion_force=0.0), (0.0, 0.0, 0.5 * THICK + 1e-6), (0.0, 0.0, -SPEED), mass=MASS,
        inertia=MASS * np.eye(3),
    )  # fmt: skip
    path = [(0.0, 0.0, SPEED)]
    while world.time < FOLLOWED - 0.5 * LOOK and path[-1][2] > 0.0:
        world.run_locally(LOOK, STEPS)
        path.append((world.time, 0.5 * THICK - world.position[body, 2], -world.velocity[body, 2]))
    way = np.array(path)
    row: Row = {"grains": len(radius), "bulk_density": bulk_density(radius, soil)}
    for instant in (1.0, 6.0):
        row[f"depth_{instant:g}"] = float(np.interp(instant, way[:, 0], way[:, 1]))
        row[f"speed_{instant:g}"] = float(np.interp(instant, way[:, 0], way[:, 2]))
    row["stopped_after"] = float(way[-1, 0]) if way[-1, 2] <= 0.0 else np.nan
    return {**row, "cpu_s": time.process_time() - start}, way


def main() -> None:
    """Run what has no row yet."""
    parser = work_folder(__doc__)
    parser.add_argument("--cases", nargs="*", default=list(cases()))
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    ran = {row["name"] for row in read_rows(TABLE)}
    for name in given.cases:
        if name in ran:
            continue
        soil = cases()[name]
        row, path = pressed_in(soil, given.work)
        np.save(given.work / f"plate_{name}.npy", path)
        shown = {key: getattr(soil, key) for key in Soil.__dataclass_fields__}
        note(TABLE, {"name": name, **shown, **row}, "plate_into_loose_grains.py --work FOLDER")


if __name__ == "__main__":
    main()
