"""Beads poured into a box, and a ball dropped on them: what the experiments on this page share.

A bed is settled once and kept with the springs of its contacts (World.save) in a work folder, so that every drop
starts from the same rest.
"""

import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from lithobrake.dem import Material, Sphere, World
from lithobrake.touchdown import settling

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import harness
from harness import Row, origin, write_document

Floats = NDArray[np.float64]

POUR_STEPS = 18.0  # in the shortest contact while beads fall and settle
DROP_STEPS = 15.0  # in the shortest contact while the ball comes down
DAMPED, DAMPED_STEPS = 0.6, 30.0  # below such a restitution damping asks for more steps: up to 25 at .5
LOOKS = 12  # a time of free fall through the whole column
PATIENCE = 40  # times of fall
FOLLOWED = 1.05  # times the stopping time


@dataclass(frozen=True, kw_only=True)
class Beads:
    """What a bed of beads follows from."""

    diameters: tuple[float, ...]  # m, each as frequent as the others
    material: Material
    gravity: float  # m/s2, downwards
    width: float  # m, of the square box
    depth: float  # m, that the bed has if it fills .58 of it
    seed: int
    fall_speed: float = 3.0  # sqrt(g d), the most at which beads fall while the bed is poured: slow makes it loose

    @property
    def mean_diameter(self) -> float:
        """Mean diameter [m]."""
        return float(np.mean(self.diameters))

    @property
    def count(self) -> int:
        """Number of beads."""
        volume = math.pi / 6.0 * float(np.mean(np.array(self.diameters) ** 3))
        return round(0.58 * self.width**2 * self.depth / volume)


def walled_world(beads: Beads) -> World:
    """Return an empty box of the material of its beads: a floor at height 0 and four walls."""
    world = World((0.0, 0.0, -beads.gravity), None)
    add_box(world, beads.width, 0.0, beads.material)
    return world


def add_box(world: World, width: float, floor: float, material: Material) -> None:
    """Add a floor at a height [m] and the four walls of a square box of a width [m] about the origin."""
    world.add_plane((0, 0, floor), (0, 0, 1), material)
    for axis in (0, 1):
        for sign in (1.0, -1.0):
            normal = np.zeros(3)
            normal[axis] = sign
            world.add_plane(-0.5 * width * normal, normal, material)


def poured(beads: Beads) -> World:
    """Return beads that fell from a loose lattice under their gravity and came to rest.

    At rest: the mean resultant force on a bead is below a hundredth of the mean contact force, and the kinetic energy
    below 1e-5 of that which lifts all beads by a diameter, with the drag of their fall and then without it. These are
    the criteria of touchdown/settling.py.
    """
    generator = np.random.default_rng(beads.seed)
    world = walled_world(beads)
    sizes = generator.choice(beads.diameters, beads.count)
    shapes = {size: Sphere(0.5 * size) for size in beads.diameters}
    row = int(beads.width / (1.03 * max(beads.diameters)))
    pitch = beads.width / row
    play = 0.5 * (pitch - max(beads.diameters))
    for k, size in enumerate(sizes):
        cell = np.array([k % row, k // row % row, k // row**2]) + 0.5
        place = cell * pitch - [0.5 * beads.width, 0.5 * beads.width, 0.0]
        world.add_body(shapes[size], beads.material, place + play * generator.uniform(-1.0, 1.0, 3))
    world.drag = math.sqrt(beads.gravity / beads.mean_diameter) / beads.fall_speed
    come_to_rest(world, beads)
    return world


def steps_for(material: Material, steps: float) -> float:
    """Return steps in the shortest contact of a material, more where its damping asks for them."""
    return steps if material.restitution >= DAMPED else max(steps, DAMPED_STEPS)


def come_to_rest(world: World, beads: Beads) -> None:
    """Run a world under its drag until it is at rest, and on without drag until it is at rest.

    Raises ValueError where it is not at rest after its patience.
    """
    fall = math.sqrt(2.0 * float(world.position[:, 2].max()) / beads.gravity)
    speed = 2.0 * beads.gravity / world.drag
    world.time_step = world.shortest_contact(speed) / steps_for(beads.material, POUR_STEPS)
    for look in range(PATIENCE * LOOKS):
        world.run(duration=fall / LOOKS)
        ratio = settling.kinetic_ratio(world, beads.mean_diameter, beads.gravity)
        # The lattice hangs in the air at first, and is slow: it must have had time to fall.
        if look < LOOKS or ratio > settling.KINETIC_RATIO:
            continue
        if settling.unbalanced_force(world) < settling.UNBALANCED_FORCE:
            if world.drag == 0.0:
                return
            world.drag = 0.0
    raise ValueError(f"{beads.count} beads were not at rest after {world.time:.3g} s: raise PATIENCE")


def kept(beads: Beads, work: Path) -> World:
    """Return the settled bed from the work folder, poured if it is not there."""
    sizes = f"{min(beads.diameters):g}-{max(beads.diameters):g}"
    stuff = beads.material
    name = (
        f"bed_{sizes}_{beads.width:g}_{beads.depth:g}_E{stuff.young_modulus:g}_e{stuff.restitution:g}"
        f"_mu{stuff.friction:g}_rho{stuff.density:g}_g{beads.gravity:g}_{beads.seed}"
    )
    if beads.fall_speed != Beads.fall_speed:
        name += f"_fall{beads.fall_speed:g}"
    path = work / f"{name}.h5"
    if not path.exists():
        work.mkdir(parents=True, exist_ok=True)
        poured(beads).save(path)
    return World.load(path)


def column_tops(world: World, reach: float, spacing: float) -> Floats:
    """Heights [m] of the highest point of a bead above each point of a grid, out to a reach [m] from the middle."""
    steps = math.floor(reach / spacing)
    axis = np.arange(-steps, steps + 1) * spacing
    tops = np.zeros((len(axis), len(axis)))
    radius = np.array([body.shape.bounding_radius for body in world.bodies])
    for place, r in zip(world.position, radius, strict=True):
        near_x, near_y = np.abs(axis - place[0]) < r, np.abs(axis - place[1]) < r
        if near_x.any() and near_y.any():
            off = (axis[near_x, None] - place[0]) ** 2 + (axis[None, near_y] - place[1]) ** 2
            top = np.where(off < r * r, place[2] + np.sqrt(np.maximum(r * r - off, 0.0)), 0.0)
            tops[np.ix_(near_x, near_y)] = np.maximum(tops[np.ix_(near_x, near_y)], top)
    return tops


def bulk_density(world: World, beads: Beads) -> float:
    """Mass of the beads in the middle over the volume of that part [kg/m3].

    The part is a box half as wide as the bed, from two beads above the floor to four below the surface, filled by
    points at random.
    """
    generator = np.random.default_rng(0)
    size = beads.mean_diameter
    level = float(column_tops(world, 0.25 * beads.width, 0.3 * size).mean())
    low = np.array([-0.25 * beads.width, -0.25 * beads.width, 2.0 * size])
    high = np.array([0.25 * beads.width, 0.25 * beads.width, level - 4.0 * size])
    points = generator.uniform(low, high, (40_000, 3))
    radius = np.array([body.shape.bounding_radius for body in world.bodies])
    inside = np.zeros(len(points), dtype=bool)
    tree = cKDTree(points)
    for near in tree.query_ball_point(world.position, radius):
        inside[near] = True
    return float(inside.mean()) * beads.material.density


def dropped(
    world: World,
    ball: Sphere,
    material: Material,
    mass: float,
    place: tuple[float, float],
    fall: float,
    pace: float,
    local: float = 0.0,
    touch_speed: float | None = None,
    steps: float = DROP_STEPS,
) -> tuple[Row, Floats]:
    """Let a ball fall from a height [m] of its lowest point above the mean surface, and follow it until it stops.

    touch_speed [m/s]: with which it first touches a bead, instead of what the fall gives. pace [s] is the time between
    two looks. steps: in the shortest contact. local: steps in a contact at its own; 0: all at the world's step.
    Returns the row of results and the path: time since the surface was reached [s], depth of the lowest point below the
    mean surface [m], speed downwards [m/s], deceleration [m/s2], shape [looks, 4].
    """
    gravity, radius = -float(world.gravity[2]), ball.radius
    tops = column_tops(world, 1.2 * radius, 0.1 * radius)
    level = float(tops.mean())
    offset = world.position[:, :2] - place
    sizes = np.array([body.shape.bounding_radius for body in world.bodies])
    span = (radius + sizes) ** 2 - (offset**2).sum(axis=1)
    start = float((world.position[:, 2] + np.sqrt(np.maximum(span, 0.0)))[span > 0.0].max()) * (1.0 + 1e-9) - radius
    speed = math.sqrt(max(2.0 * gravity * (fall - (start - level)), 0.0)) if touch_speed is None else touch_speed
    inertia = 0.4 * mass * radius**2 * np.eye(3)
    body = world.add_body(
        ball, material, (*place, start + radius), velocity=(0.0, 0.0, -speed), mass=mass, inertia=inertia
    )  # fmt: skip
    # Ball and beads are of about the same modulus: the lightest pair of beads has the shortest contact.
    fastest = max(speed, math.sqrt(gravity * radius))
    world.time_step = world.shortest_contact(fastest) / steps_for(material, steps)
    pace = max(round(pace / world.time_step), 1) * world.time_step
    begun, path = world.time, []
    stopped = 0.0
    while stopped == 0.0 or world.time - begun < FOLLOWED * stopped:
        before = float(world.velocity[body, 2])
        if local > 0.0:
            world.run_locally(pace, local)
        else:
            world.run(duration=pace)
        now = float(world.velocity[body, 2])
        height = float(world.position[body, 2]) - radius
        path.append((world.time - begun, level - height, -now, (now - before) / pace))
        if stopped == 0.0 and now >= 0.0:
            stopped = world.time - begun
    looks = np.array(path)
    return {
        "impact_speed": math.sqrt(2.0 * gravity * fall), "level": level, "touch_height": start - level,
        "deepest": float(looks[:, 1].max()),
        "depth": float(looks[-1, 1]), "stopping_time": stopped, "peak_deceleration": float(looks[:, 3].max()),
    }, looks  # fmt: skip


def read_rows(path: Path) -> list[Row]:
    """Return the rows of a table, numbers as numbers; none where it is not there."""
    return harness.read_rows(path, {}, number)


def number(text: str) -> float | str:
    """Return a number where the text is one."""
    try:
        return float(text)
    except ValueError:
        return text


def work_folder(doc: str | None, **options: Any) -> argparse.ArgumentParser:
    """Return a parser of options, and of that which names the folder of beds and paths."""
    parser = harness.command_line(doc, **options)
    parser.add_argument("--work", type=Path, required=True, help="folder for beds and paths, made if it is not there")
    return parser


def note(table: Path, row: Row, command: str) -> None:
    """Add a row to a table on disk, tell it, and write beside the table when, where and by which command it was last
    added to, and what all its rows cost.
    """
    harness.add_row(table, row, digits=7)
    print(row, flush=True)
    rows = read_rows(table)
    cost = round(sum(float(row.get("cpu_s", 0.0)) for row in rows), 1)
    script = f"validation/experiments/{command}"
    document = {"table": table.name, **origin(script), "rows": len(rows), "cpu_s_of_rows": cost}
    write_document(table.with_suffix(".json"), document)
