"""Beads poured on ground that repeats, or into a box, the beds of the experiments, and a ball that falls into one.

A bed is settled once and kept with the springs of its contacts (World.save) in a work folder, so that every drop
starts from the same rest.
"""

import hashlib
import math
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from result_rows import Row
from scipy.spatial import cKDTree

from lithobrake.dem import Material, Sphere, World, folded, period_of
from lithobrake.touchdown import settling

Floats = NDArray[np.float64]

POUR_STEPS = 18.0  # in the shortest contact while beads fall and settle
DAMPED, DAMPED_STEPS = 0.6, 30.0  # below such a restitution damping asks for more steps: up to 25 at 0.5
DROP_STEPS = 15.0  # in the shortest contact while the ball comes down
FOLLOWED = 1.05  # times the stopping time
LOOKS = 12  # a time of free fall through the whole column
PATIENCE = 40  # times of fall


@dataclass(frozen=True, kw_only=True)
class Beads:
    """What a bed of beads follows from."""

    diameters: tuple[float, ...]  # m, each as frequent as the others
    material: Material
    gravity: float  # m/s2, downwards
    width: float  # m, after which the ground repeats along x and y, or of the square box
    depth: float  # m, that the bed has if it fills 0.58 of it
    seed: int
    fall_speed: float = 3.0  # sqrt(g d), the most at which beads fall while the bed is poured: slow makes it loose
    walls: bool = False
    least_steps: float = 0.0  # in the shortest contact: damping in many contacts at once asks for more than POUR_STEPS
    tiles: int = 1  # along x and y: the bed is poured on a tile of width / tiles, and laid out so often

    @property
    def mean_diameter(self) -> float:
        """Mean diameter [m]."""
        return float(np.mean(self.diameters))

    @property
    def count(self) -> int:
        volume = math.pi / 6.0 * float(np.mean(np.array(self.diameters) ** 3))
        return round(0.58 * (self.width / self.tiles) ** 2 * self.depth / volume) * self.tiles**2


def empty_world(beads: Beads) -> World:
    """Return ground at height 0 without beads, of their material."""
    world = World((0.0, 0.0, -beads.gravity), None, period=None if beads.walls else (beads.width, beads.width))
    if beads.walls:
        add_box(world, beads.width, 0.0, beads.material)
    else:
        world.add_plane((0, 0, 0), (0, 0, 1), beads.material)
    return world


def add_box(world: World, width: float, floor: float, material: Material) -> None:
    """Add a floor at a height [m] and the four walls of a square box of a width [m] about the origin."""
    world.add_plane((0, 0, floor), (0, 0, 1), material)
    for axis in (0, 1):
        for sign in (1.0, -1.0):
            normal = np.zeros(3)
            normal[axis] = sign
            world.add_plane(-0.5 * width * normal, normal, material)


def add_beads(world: World, radii: Floats, material: Material, places: Floats) -> None:
    """Add beads of radii [m] at places [m], shape [count, 3]."""
    shapes = {radius: Sphere(float(radius)) for radius in np.unique(radii)}
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (len(radii), 1))
    world.add_bodies([shapes[radius] for radius in radii], material, places, upright)


def radii_of(world: World) -> Floats:
    """Radii of the bodies of a world [m]."""
    return np.array([body.shape.bounding_radius for body in world.bodies])


def places_of(world: World, about: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """Positions [m] of the bodies of a world from a point of its ground, of their nearest images where it repeats."""
    return folded(world.position - [*about, 0.0], period_of(world.period))


def poured(beads: Beads) -> World:
    """Return beads that fell from a loose lattice under their gravity and came to rest.

    At rest: the mean resultant force on a bead is below a hundredth of the mean contact force, and the kinetic energy
    below 1e-5 of that which lifts all beads by a diameter, with the drag of their fall and then without it. These are
    the criteria of touchdown/settling.py.
    """
    if beads.tiles > 1:
        return laid_out(beads)
    generator = np.random.default_rng(beads.seed)
    world = empty_world(beads)
    sizes = generator.choice(beads.diameters, beads.count)
    row = int(beads.width / (1.03 * max(beads.diameters)))
    pitch = beads.width / row
    play = 0.5 * (pitch - max(beads.diameters))
    k = np.arange(beads.count)
    cells = np.stack([k % row, k // row % row, k // row**2], axis=1) + 0.5
    corner = np.array([0.5 * beads.width, 0.5 * beads.width, 0.0])
    add_beads(
        world, 0.5 * sizes, beads.material, cells * pitch - corner + play * generator.uniform(-1.0, 1.0, cells.shape)
    )
    world.drag = fall_drag(beads)
    come_to_rest(world, beads, LOOKS)
    return world


def laid_out(beads: Beads) -> World:
    """Return copies of a poured tile side by side, at rest together."""
    tile = poured(replace(beads, width=beads.width / beads.tiles, tiles=1))
    places, width = places_of(tile), beads.width / beads.tiles
    steps = (np.arange(beads.tiles) - 0.5 * (beads.tiles - 1)) * width
    every = np.concatenate([places + np.array([x, y, 0.0]) for x in steps for y in steps])
    world = empty_world(beads)
    add_beads(world, np.tile(radii_of(tile), beads.tiles**2), beads.material, every)
    world.drag = fall_drag(beads)
    come_to_rest(world, beads)
    return world


def fall_drag(beads: Beads) -> float:
    """Return the drag [1/s] that holds falling beads below their fall speed."""
    return math.sqrt(beads.gravity / beads.mean_diameter) / beads.fall_speed


def steps_for(material: Material, steps: float) -> float:
    """Return steps in the shortest contact of a material, more where its damping asks for them."""
    return steps if material.restitution >= DAMPED else max(steps, DAMPED_STEPS)


def come_to_rest(world: World, beads: Beads, hanging: int = 0) -> None:
    """Run a world under its drag until it is at rest, and on without drag until it is at rest.

    hanging: looks for which beads that hang in the air at first, and are slow, must have had time to fall.
    Raises ValueError where it is not at rest after its patience.
    """
    fall = math.sqrt(2.0 * float(world.position[:, 2].max()) / beads.gravity)
    speed = 2.0 * beads.gravity / world.drag
    world.time_step = world.shortest_contact(speed) / steps_for(beads.material, max(POUR_STEPS, beads.least_steps))
    for look in range(PATIENCE * LOOKS):
        world.run(duration=fall / LOOKS)
        ratio = settling.kinetic_ratio(world, beads.mean_diameter, beads.gravity)
        if look < hanging or ratio > settling.KINETIC_RATIO:
            continue
        if settling.unbalanced_force(world) < settling.UNBALANCED_FORCE:
            if world.drag == 0.0:
                return
            world.drag = 0.0
    raise ValueError(f"{beads.count} beads were not at rest after {world.time:.3g} s: raise PATIENCE")


def kept(beads: Beads, work: Path) -> World:
    """Return the settled bed from the work folder, poured if it is not there."""
    told = repr(sorted(asdict(beads).items()))
    path = work / f"bed_{hashlib.sha256(told.encode()).hexdigest()[:16]}.h5"
    if not path.exists():
        poured(beads).save(path)
    return World.load(path)


def column_tops(world: World, reach: float, spacing: float, about: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """Heights [m] of the highest point of a bead above each point of a grid, out to a reach [m] from a place [m]."""
    steps = math.floor(reach / spacing)
    axis = np.arange(-steps, steps + 1) * spacing
    tops = np.zeros((len(axis), len(axis)))
    for place, r in zip(places_of(world, about), radii_of(world), strict=True):
        near_x, near_y = np.abs(axis - place[0]) < r, np.abs(axis - place[1]) < r
        if near_x.any() and near_y.any():
            off = (axis[near_x, None] - place[0]) ** 2 + (axis[None, near_y] - place[1]) ** 2
            top = np.where(off < r * r, place[2] + np.sqrt(np.maximum(r * r - off, 0.0)), 0.0)
            tops[np.ix_(near_x, near_y)] = np.maximum(tops[np.ix_(near_x, near_y)], top)
    return tops


def bulk_density(world: World, beads: Beads, above: float = 2.0, below: float = 4.0) -> float:
    """Mass of the beads in the middle over the volume of that part [kg/m3].

    The part is a box half as wide as the bed, from some beads above the floor to some below the surface, filled by
    points at random.
    """
    generator = np.random.default_rng(0)
    size = beads.mean_diameter
    level = float(column_tops(world, 0.25 * beads.width, 0.3 * size).mean())
    low = np.array([-0.25 * beads.width, -0.25 * beads.width, above * size])
    high = np.array([0.25 * beads.width, 0.25 * beads.width, level - below * size])
    points = generator.uniform(low, high, (40_000, 3))
    inside = np.zeros(len(points), dtype=bool)
    tree = cKDTree(points)
    for near in tree.query_ball_point(places_of(world), radii_of(world)):
        inside[near] = True
    return float(inside.mean()) * beads.material.density


class Ball(NamedTuple):
    """A ball and how it meets the bed: diameter [m], density [kg/m3], place [m] over the bed."""

    diameter: float
    density: float
    place: tuple[float, float] = (0.0, 0.0)

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return self.density * math.pi / 6.0 * self.diameter**3


def touch_height(world: World, ball: Ball) -> float:
    """Return the height [m] of a ball's lowest point where it first touches a bead on its way down."""
    reach = 0.5 * ball.diameter + radii_of(world)
    places = places_of(world, ball.place)
    span = reach**2 - (places[:, :2] ** 2).sum(axis=1)
    centre = float((places[:, 2] + np.sqrt(np.maximum(span, 0.0)))[span > 0.0].max()) * (1.0 + 1e-9)
    return centre - 0.5 * ball.diameter


def dropped(
    world: World, ball: Ball, material: Material, fall: float, pace: float, *, touch_speed: float | None = None,
    steps: float = DROP_STEPS,
) -> tuple[Row, Floats]:  # fmt: skip
    """Let a ball fall from a height [m] of its lowest point above the mean surface, and follow it until it stops.

    touch_speed [m/s]: with which it first touches a bead, instead of what the fall gives. pace [s] is the time between
    two looks. steps: in the shortest contact.
    Returns the row of results and the path: time since the first touch [s], depth of the lowest point below the mean
    surface [m], speed downwards [m/s], deceleration [m/s2], shape [looks, 4].
    """
    gravity, radius = -float(world.gravity[2]), 0.5 * ball.diameter
    level = float(column_tops(world, 1.2 * radius, 0.1 * radius, ball.place).mean())
    start = touch_height(world, ball)
    speed = math.sqrt(max(2.0 * gravity * (fall - (start - level)), 0.0)) if touch_speed is None else touch_speed
    body = world.add_body(
        Sphere(radius), material, (*ball.place, start + radius), velocity=(0.0, 0.0, -speed), mass=ball.mass,
        inertia=0.4 * ball.mass * radius**2 * np.eye(3),
    )  # fmt: skip
    # Ball and beads are of about the same modulus: the lightest pair of beads has the shortest contact.
    fastest = max(speed, math.sqrt(gravity * radius))
    world.time_step = world.shortest_contact(fastest) / steps_for(material, steps)
    looks = followed(world, body, level + radius, max(round(pace / world.time_step), 1) * world.time_step)
    stopped = float(looks[np.argmax(looks[:, 2] <= 0.0), 0])
    return {
        "impact_speed": math.sqrt(2.0 * gravity * fall), "level": level, "touch_height": start - level,
        "deepest": float(looks[:, 1].max()), "depth": float(looks[-1, 1]), "stopping_time": stopped,
        "peak_deceleration": float(looks[:, 3].max()),
    }, looks  # fmt: skip


def followed(world: World, body: int, zero: float, pace: float) -> Floats:
    """Return the path of a body, a look every pace [s], until it has stood still; depth counts from zero [m]."""
    begun, stopped = world.time, math.inf
    path: list[tuple[float, float, float, float]] = []
    while world.time - begun < FOLLOWED * stopped:
        before = float(world.velocity[body, 2])
        world.run(duration=pace)
        now = float(world.velocity[body, 2])
        path.append((world.time - begun, zero - float(world.position[body, 2]), -now, (now - before) / pace))
        if stopped == math.inf and now >= 0.0:
            stopped = world.time - begun
    return np.array(path)
