"""A plate that meets loose grains in almost no gravity: OSIRIS-REx on Bennu (X3), and what resists it (K6).

    python validation/experiments/plate_into_loose_grains.py --work FOLDER --out FOLDER [--series NAME ...]

Series: flight, as [Walsh-2022]; corners, the eight combinations of packing, friction and cohesion [Ballouz-2021];
speeds, the force on the plate against its speed; slopes, of heaps of the grains of the corners. Rows that stand in the
tables are not run again.
"""

import math
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from repose import angle_of_repose
from result_rows import Row, note, options_of, read_rows
from scipy.spatial import cKDTree
from sphere_bed import Beads, Floats, add_beads

from lithobrake.dem import ConvexHull, Material, World, folded, period_of

NAME, SLOPES = "plate_into_loose_grains.csv", "plate_slopes.csv"
MASS, PLATE, SPEED, FOLLOWED = 1300.0, 0.32, 0.1, 6.0  # kg, m, m/s, s: [Walsh-2022]
THICK = 0.08  # m, of our plate; the head of OSIRIS-REx goes on behind its plate
LOOK = 0.005  # m of the plate's way at its first speed, between looks
STEPS = 20.0  # of its own that each contact takes
# How far grains that are being put may still overlap, in their mean diameter: then all are made so much smaller.
PUT = 2e-3
SMOOTH = {"friction": 0.2, "rolling_friction": 0.0}
SERIES = ("flight", "corners", "speeds", "slopes")


@dataclass(frozen=True, kw_only=True)
class Soil:
    """What a run follows from."""

    filled: float  # share of space that grains fill
    grain: float = 0.07  # m, mean diameter; between 0.8 and 1.2 of it
    width: float = 1.28  # m, after which the ground repeats: four plates
    depth: float = 1.0  # m
    friction: float = 0.6
    rolling_friction: float = 0.1
    cohesion: float = 0.0  # Pa: the pull of a contact over the square of the mean diameter
    density: float = 2000.0  # kg/m3, of a grain
    young_modulus: float = 1e6  # Pa
    speed: float = SPEED  # m/s, of the plate
    seed: int = 1

    @property
    def material(self) -> Material:
        return Material(
            young_modulus=self.young_modulus, poisson_ratio=0.25, restitution=0.5, friction=self.friction,
            density=self.density, rolling_friction=self.rolling_friction,
            cohesion_force=self.cohesion * self.grain**2,
        )  # fmt: skip


def cases() -> dict[str, dict[str, Soil]]:
    """Return what is run, by series and name."""
    dense, loose = Soil(filled=0.58), Soil(filled=0.5)
    flight = {f"filled {share:g}": replace(dense, filled=share) for share in (0.3, 0.58, 0.55, 0.6, 0.5)}
    flight |= {f"again {seed}": replace(dense, seed=seed) for seed in (2, 3)} | {
        "half density 0.58": replace(dense, density=595.0 / 0.58),
        "half density 0.6": replace(dense, filled=0.6, density=595.0 / 0.6),
    }  # fmt: skip
    corners = {
        f"corner {filled:g} {name} {pull:g} Pa": Soil(filled=filled, cohesion=pull, **kind)
        for filled in (0.5, 0.6) for name, kind in (("smooth", SMOOTH), ("rough", {})) for pull in (0.0, 50.0)
    }  # fmt: skip
    speeds = {
        f"speed {pull:g} Pa {speed:g}": replace(loose, cohesion=pull, speed=speed)
        for pull in (0.0, 10.0) for speed in (0.05, 0.1, 0.2, 0.4)
    }  # fmt: skip
    return {"flight": flight, "corners": corners, "speeds": speeds}


def put(soil: Soil) -> tuple[Floats, Floats]:
    """Return places and radii [m] of grains that about fill their share of space and nowhere overlap.

    They begin anywhere and are pushed apart, each of an overlapping pair by a little more than half its overlap.
    """
    generator = np.random.default_rng(soil.seed)
    volume = soil.filled * soil.width**2 * soil.depth
    radius = 0.5 * soil.grain * generator.uniform(0.8, 1.2, round(volume / (np.pi / 6.0 * soil.grain**3) / 1.04))
    radius *= np.cbrt(volume / (4.0 / 3.0 * np.pi * radius**3).sum())
    period, reach = period_of((soil.width, soil.width)), 2.0 * radius.max()
    # Between floor and surface nothing has an image: twice the height keeps them apart.
    box = (soil.width, soil.width, 2.0 * soil.depth)
    place = generator.uniform(0.0, 1.0, (len(radius), 3)) * [soil.width, soil.width, soil.depth]
    while True:
        place[:, 2] = np.clip(place[:, 2], radius, soil.depth - radius)
        place[:, :2] %= soil.width
        pair = cKDTree(place, boxsize=box).query_pairs(reach, output_type="ndarray")
        between = folded(place[pair[:, 1]] - place[pair[:, 0]], period)
        far = np.linalg.norm(between, axis=1)
        overlap = radius[pair].sum(axis=1) - far
        worst = float(overlap.max(initial=0.0))
        if worst <= PUT * soil.grain:
            return place - [0.0, 0.0, soil.depth], radius - 0.5 * worst
        pressed = overlap > 0.0
        push = (0.55 * overlap / np.maximum(far, 1e-12))[pressed, None] * between[pressed]
        np.subtract.at(place, pair[pressed, 0], push)
        np.add.at(place, pair[pressed, 1], push)


def kept(soil: Soil, work: Path) -> tuple[Floats, Floats]:
    """Return places and radii [m] of grains from the work folder, put if they are not there."""
    path = work / f"grains_{soil.filled:g}_{soil.grain:g}_{soil.width:g}_{soil.depth:g}_{soil.seed}.npz"
    if not path.exists():
        place, radius = put(soil)
        np.savez(path, place=place, radius=radius)
    with np.load(path) as grains:
        return grains["place"], grains["radius"]


def bulk_density(radius: Floats, soil: Soil) -> float:
    """Return the mass of all grains over the volume of their space [kg/m3]."""
    volume = float((4.0 / 3.0 * np.pi * radius**3).sum())
    return soil.density * volume / (soil.width**2 * soil.depth)


def plate() -> ConvexHull:
    """Return a round plate: two rings of 24 corners."""
    turn = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    ring = 0.5 * PLATE * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return ConvexHull(
        np.concatenate([np.column_stack([ring, np.full(24, height)]) for height in (-0.5 * THICK, 0.5 * THICK)])
    )


def pressed_in(soil: Soil, work: Path) -> tuple[Row, Floats]:
    """Let the plate come down; return the row and the path: time [s], depth of its underside [m], speed [m/s].

    It is followed until it has stopped, and for the time in which it would go 0.6 m.
    """
    place, radius = kept(soil, work)
    start = time.process_time()
    world, stuff = World(period=(soil.width, soil.width)), soil.material
    add_beads(world, radius, stuff, place)
    world.add_plane((0, 0, -soil.depth), (0, 0, 1), stuff)
    # The whole spacecraft is behind it: it hardly turns.
    body = world.add_body(
        plate(), replace(stuff, cohesion_force=0.0), (0.0, 0.0, 0.5 * THICK + 1e-6), (0.0, 0.0, -soil.speed),
        mass=MASS, inertia=MASS * np.eye(3),
    )  # fmt: skip
    path, until = [(0.0, 0.0, soil.speed)], FOLLOWED * SPEED / soil.speed
    look = LOOK / soil.speed
    while world.time < until - 0.5 * look and path[-1][2] > 0.0:
        world.run_locally(look, STEPS)
        path.append((world.time, 0.5 * THICK - world.position[body, 2], -world.velocity[body, 2]))
    way = np.array(path)
    row: Row = {"grains": len(radius), "bulk_density": bulk_density(radius, soil)}
    for instant in (1.0, FOLLOWED):
        row[f"depth_{instant:g}"] = float(np.interp(instant, way[:, 0], way[:, 1]))
        row[f"speed_{instant:g}"] = float(np.interp(instant, way[:, 0], way[:, 2]))
    row["stopped_after"] = float(way[-1, 0]) if way[-1, 2] <= 0.0 else math.nan
    row["deepest"], row["mean_force"] = float(way[:, 1].max()), mean_force(way)
    return {**row, "cpu_s": time.process_time() - start}, way


def mean_force(way: Floats) -> float:
    """Return the mean force of the soil [N] until the plate is half its diameter deep, or stops: energy over way."""
    deep = min(0.5 * PLATE, float(way[:, 1].max()))
    speed = float(np.interp(deep, np.maximum.accumulate(way[:, 1]), way[:, 2]))
    return 0.5 * MASS * (way[0, 2] ** 2 - max(speed, 0.0) ** 2) / deep


def slopes(out: Path) -> None:
    """Measure the slopes of heaps of such grains, under Earth's gravity: stiffer, and less damped."""
    ran = {(row["kind"], row["seed"]) for row in read_rows(out / SLOPES)}
    for kind, values in (("smooth", SMOOTH), ("rough", {})):
        stuff = replace(Soil(filled=0.6, **values).material, young_modulus=2e7, restitution=0.8)
        for seed in (1, 2):
            if (kind, seed) not in ran:
                sizes = (0.8 * Soil.grain, Soil.grain, 1.2 * Soil.grain)
                bed = Beads(diameters=sizes, material=stuff, gravity=9.81, width=1.0, depth=1.0, seed=seed)
                note(out / SLOPES, {"kind": kind, **angle_of_repose(bed, seed)})


def main() -> None:
    given = options_of(__doc__, series=SERIES)
    ran = {row["name"] for row in read_rows(given.out / NAME)}
    for series in given.series:
        if series == "slopes":
            slopes(given.out)
            continue
        for name, soil in cases()[series].items():
            if name not in ran:
                row, path = pressed_in(soil, given.work)
                np.save(given.work / f"plate_{name.replace(' ', '_')}.npy", path)
                shown = {key: getattr(soil, key) for key in Soil.__dataclass_fields__}
                note(given.out / NAME, {"series": series, "name": name, **shown, **row})


if __name__ == "__main__":
    main()
