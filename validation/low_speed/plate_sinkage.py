"""Pressure against sinkage of a round plate pressed into grains, prepared with cohesion and without.

    python validation/low_speed/plate_sinkage.py --work FOLDER --out FOLDER [--names NAME ...]

Plate, speed, depth and materials are those of [Negrut-2026], whose grains are clumps of three spheres of 22 mm in
a round bin; ours are spheres of 60 mm with rolling resistance, softer, on ground that repeats. Rows that stand in
plate_sinkage.csv are not run again.
"""

import math
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from lithobrake.dem import Material, World
from lithobrake.touchdown import settling

sys.path.extend([str(Path(__file__).parents[1] / "experiments"), str(Path(__file__).parents[2] / "benchmarks")])
from repose import angle_of_repose
from result_rows import Row, note, options_of, read_rows
from sphere_bed import Beads, Floats, add_beads, bulk_density, column_tops, empty_world, kept, places_of

HERE = Path(__file__).parent
NAME = "plate_sinkage.csv"
PLATE, SPEED, DEEP, DATUM = 0.35, 0.05, 0.06, 1000.0  # m, m/s, m, Pa: the source
WIDTH, BED, GRAVITY = 1.05, 0.28, 9.81  # m, m, m/s2: the source
GRAIN = 0.06  # m
MIDDLE = (1.0, 1.5)  # grains above the floor and below the surface, between which the packing is measured
ACCELERATION = 200.0  # m/s2, the source's cohesion: a pull of so much times the reduced mass of two grains
DRY = Material(
    young_modulus=1e7, poisson_ratio=0.3, restitution=0.4, friction=0.5, density=2600.0, rolling_friction=0.1
)
TICK = 1e-3  # s, between two moves of the plate
AREA = 0.25 * math.pi * PLATE**2
SHOWN = (0.005, 0.02, 0.04, 0.06)  # m
# Name: whether grains pull on each other while they are poured, and while the plate is pressed; seed.
NAMES = {
    "dry": (False, False, 1), "cohesive": (False, True, 1), "poured cohesive": (True, True, 1),
}  # fmt: skip


def stuff(pulls: bool) -> Material:
    mass = DRY.density * math.pi / 6.0 * GRAIN**3
    return replace(DRY, cohesion_force=ACCELERATION * 0.5 * mass if pulls else 0.0)


def beads(pulls: bool, seed: int) -> Beads:
    """Return what a bed follows from: three sizes, so that no crystal grows."""
    sizes = (0.9 * GRAIN, GRAIN, 1.1 * GRAIN)
    return Beads(
        diameters=sizes, material=stuff(pulls), gravity=GRAVITY, width=WIDTH, depth=BED, seed=seed, least_steps=60.0
    )


def prepared(work: Path, poured: bool, pressed: bool, seed: int) -> World:
    """Return a bed poured with one material and brought to rest with another."""
    bed = kept(beads(poured, seed), work)
    if poured == pressed:
        return bed
    world = empty_world(beads(pressed, seed))
    add_beads(world, np.array([body.shape.bounding_radius for body in bed.bodies]), stuff(pressed), places_of(bed))
    world.drag = math.sqrt(GRAVITY / GRAIN)
    settling.run_quietly(world, 0.3)
    world.drag = 0.0
    return world


def pressed_in(world: World) -> Floats:
    """Press the plate; return its sinkage [m] from where it bears 1 kPa, and the mean pressure [Pa], shape [looks, 2].

    The plate is a plane that meets the grains under its disc.
    """
    height = float(column_tops(world, 0.5 * PLATE, 0.1 * GRAIN).max()) + 1e-4
    plate = world.add_plane((0, 0, height), (0, 0, -1), DRY, bodies=[])
    looks: list[tuple[float, float]] = []
    datum = math.nan
    while math.isnan(datum) or datum - height < DEEP:
        height -= SPEED * TICK
        place = places_of(world)
        under = np.flatnonzero((np.hypot(place[:, 0], place[:, 1]) < 0.5 * PLATE) & (place[:, 2] < height))
        world.move_plane(plate, (0, 0, height), bodies=[int(k) for k in under])
        settling.run_quietly(world, TICK)
        contacts = world.contacts()
        pressure = float(contacts["normal_force"][contacts["body_b"] == -1 - plate].sum()) / AREA
        if math.isnan(datum) and pressure >= DATUM:
            datum = height
        if not math.isnan(datum):
            looks.append((datum - height, pressure))
    return np.array(looks)


def smoothed(curve: Floats, sinkage: float, half: float = 1e-3) -> float:
    """Return the mean pressure [Pa] within a millimetre of a sinkage [m]."""
    near = np.abs(curve[:, 0] - sinkage) <= half
    return float(curve[near, 1].mean())


def exponent(curve: Floats) -> float:
    """Return the power of sinkage by which pressure grows from 5 to 60 mm, each millimetre alike."""
    at = np.arange(SHOWN[0], SHOWN[-1], 1e-3)
    return float(np.polyfit(np.log(at), np.log([smoothed(curve, one) for one in at]), 1)[0])


def bearing_capacity(slope: float, unit_weight: float, depth: float, diameter: float) -> float:
    """Return the pressure [Pa] that grains without cohesion bear under a round plate at a depth [m].

    slope: angle of internal friction [rad]; unit_weight [N/m3]; diameter [m]. Sources: [Terzaghi-1943] for the sum and
    the 0.3 of a circle, [Vesic-1973] for the factors.
    """
    of_depth = math.exp(math.pi * math.tan(slope)) * math.tan(0.25 * math.pi + 0.5 * slope) ** 2
    of_width = 2.0 * (of_depth + 1.0) * math.tan(slope)
    return unit_weight * (depth * of_depth + 0.3 * diameter * of_width)


def loosened(slope: float) -> float:
    """Return the angle of friction [rad] for which loose ground that yields locally bears as much; [Terzaghi-1943]."""
    return math.atan(2.0 / 3.0 * math.tan(slope))


def run(name: str, work: Path) -> Row:
    poured, pressed, seed = NAMES[name]
    start = time.process_time()
    world = prepared(work, poured, pressed, seed)
    density = bulk_density(world, beads(poured, seed), *MIDDLE)
    curve = pressed_in(world)
    np.savetxt(work / f"plate_{name.replace(' ', '_').replace(',', '')}.txt", curve)
    return {
        "name": name, "grains": len(world.bodies), "solid_fraction": density / DRY.density,
        **{f"pressure_{1e3 * one:g}mm": smoothed(curve, one) for one in SHOWN}, "exponent": exponent(curve),
        "slope_deg": math.nan, "cpu_s": time.process_time() - start,
    }  # fmt: skip


def heap(seed: int) -> Row:
    """Return the slope of a heap of the grains without cohesion."""
    found = angle_of_repose(beads(False, seed), seed)
    empty = dict.fromkeys(("solid_fraction", *(f"pressure_{1000.0 * one:g}mm" for one in SHOWN), "exponent"), math.nan)
    return {
        "name": f"heap {seed}", "grains": found["beads"], **empty, "slope_deg": found["angle_deg"],
        "cpu_s": found["cpu_s"],
    }  # fmt: skip


def main() -> None:
    given = options_of(__doc__, HERE, names=(*NAMES, "heap 1", "heap 2"))
    ran = {row["name"] for row in read_rows(given.out / NAME)}
    for name in given.names:
        if name not in ran:
            note(given.out / NAME, heap(int(name[5:])) if name.startswith("heap") else run(name, given.work))


if __name__ == "__main__":
    main()
