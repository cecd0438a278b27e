"""How much energy does a shell lose in its first bounce on a hard plane, with grains inside and without?

    python validation/low_speed/filled_shell.py --work FOLDER --out FOLDER [--drops 3] [--settings NAME ...]

The shell is a rigid cube of six plates, the source's is flexible. Grains lie at its bottom before it strikes the plane.
Rows that stand in filled_shell.csv are not run again. Source: [Wen-2025]; all sizes and materials are ours.
"""

import itertools
import math
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.dem import Box, ConvexHull, Material, Part, Sphere, World
from lithobrake.geometry.attitude import quaternion

sys.path.extend([str(Path(__file__).parents[1] / "experiments"), str(Path(__file__).parents[2] / "benchmarks")])
from result_rows import Row, note, options_of, read_rows

HERE = Path(__file__).parent
NAME = "filled_shell.csv"
SIDE, WALL, GRAIN = 0.1, 0.005, 0.014  # m: outer side, thickness of a plate, diameter of a grain
INSIDE = SIDE - 2.0 * WALL
SHELL_MASS = 0.3  # kg
PACKED = 0.5  # of the space that so few settled grains take, they fill
SKIN = Material(young_modulus=1e6, poisson_ratio=0.3, restitution=0.7, friction=0.5, density=1000.0)
SETTLED = 1.0  # m/s2 under which grains come to lie; the bounce itself is too short for gravity to matter
STEPS = 25.0  # of its own that each contact takes
FOLLOWED = 3.0  # sides that the shell would go at its first speed, after it has touched


@dataclass(frozen=True)
class Setting:
    """What a drop follows from. filling: part of the inside that the grains take up as they lie."""

    filling: float = 0.5
    speed: float = 0.1  # m/s
    friction: float = 0.5  # of grains
    restitution: float = 0.7  # of grains
    floats: bool = False  # grains are anywhere inside, as after a long fall, instead of at the bottom
    young_modulus: float = 1e6  # Pa, of the shell


HALF = Setting()
SETTINGS = {
    "half full": HALF,
    "empty": replace(HALF, filling=0.0),
    "filling 0.15": replace(HALF, filling=0.15),
    "filling 0.8": replace(HALF, filling=0.8),
    "0.05 m/s": replace(HALF, speed=0.05),
    "0.2 m/s": replace(HALF, speed=0.2),
    "friction 0.2": replace(HALF, friction=0.2),
    "friction 0.9": replace(HALF, friction=0.9),
    "restitution 0.4": replace(HALF, restitution=0.4),
    "restitution 0.9": replace(HALF, restitution=0.9),
    "grains float": replace(HALF, floats=True),
    "soft shell": replace(HALF, young_modulus=1e5),
    "soft shell, empty": replace(HALF, young_modulus=1e5, filling=0.0),
}


def plates() -> list[ConvexHull]:
    """Return the six plates of the shell, in its frame."""
    found, away = [], 0.5 * (SIDE - WALL)
    for axis, sign in itertools.product(range(3), (-1.0, 1.0)):
        edges, centre = np.full(3, SIDE), np.zeros(3)
        edges[axis], centre[axis] = WALL, sign * away
        found.append(ConvexHull(Box(edges).vertices + centre))
    return found


def inertia_of_shell() -> np.ndarray:
    """Return the inertia [kg m2] of a hollow cube: that of the outer one less that of the inner one."""
    density = SHELL_MASS / (SIDE**3 - INSIDE**3)
    moment: np.ndarray = np.eye(3) * density * (SIDE**5 - INSIDE**5) / 6.0
    return moment


def skin_of(one: Setting) -> Material:
    return replace(SKIN, young_modulus=one.young_modulus)


def stuff_of(one: Setting) -> Material:
    return replace(SKIN, restitution=one.restitution, friction=one.friction, density=2500.0)


def lying(one: Setting, attitude: Rotation, generator: np.random.Generator) -> np.ndarray:
    """Return where grains lie in the frame of the shell [m], shape [count, 3], the shell turned by an attitude.

    Raises ValueError where the shell takes fewer grains.
    """
    count = round(one.filling * PACKED * INSIDE**3 / (math.pi / 6.0 * GRAIN**3))
    if count == 0:
        return np.zeros((0, 3))
    row, stuff = int(INSIDE / (1.02 * GRAIN)), stuff_of(one)
    if count > row**3:
        raise ValueError(f"filling {one.filling:g} asks for {count} grains; the shell takes {row**3}: choose less")
    pitch, world = INSIDE / row, World(tuple(SETTLED * attitude.inv().apply([0.0, 0.0, -1.0])))
    cells = generator.permutation(row**3)[:count]
    place = (np.stack([cells % row, cells // row % row, cells // row**2], axis=1) + 0.5) * pitch - 0.5 * INSIDE
    place += 0.5 * (pitch - GRAIN) * generator.uniform(-1.0, 1.0, place.shape)
    world.add_bodies([Sphere(0.5 * GRAIN)] * count, stuff, place, np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)))
    if one.floats:
        return place
    for axis, sign in itertools.product(range(3), (-1.0, 1.0)):
        normal = -sign * np.eye(3)[axis]
        world.add_plane(tuple(-0.5 * INSIDE * normal), tuple(normal), stuff)
    world.drag = math.sqrt(SETTLED / GRAIN) / 3.0
    while world.time < 15.0 * math.sqrt(INSIDE / SETTLED):
        world.run_locally(math.sqrt(INSIDE / SETTLED), STEPS)
        if np.abs(world.velocity).max() < 1e-2 * math.sqrt(SETTLED * GRAIN):
            break
    return world.position


def bounced(name: str, number: int) -> Row:
    """Let a shell strike the plane and return how fast the common centre of mass goes before and after [m/s]."""
    one, generator = SETTINGS[name], np.random.default_rng([11, number])
    start, attitude = time.process_time(), Rotation.from_quat(generator.normal(size=4))
    grains = lying(one, attitude, generator)
    hulls, skin = plates(), skin_of(one)
    lowest = float(min(attitude.apply(hull.vertices)[:, 2].min() for hull in hulls))
    world, centre, fall = World(), np.array([0.0, 0.0, -lowest + 1e-4]), (0.0, 0.0, -one.speed)
    world.add_plane((0, 0, 0), (0, 0, 1), skin)
    shell = world.add_body(
        hulls[0], skin, tuple(centre), fall, quaternion(attitude), mass=SHELL_MASS, inertia=inertia_of_shell(),
        centre_of_mass=np.zeros(3), parts=[Part(hull, skin) for hull in hulls[1:]],
    )  # fmt: skip
    for place in centre + attitude.apply(grains) if len(grains) else ():
        world.add_body(Sphere(0.5 * GRAIN), stuff_of(one), tuple(place), fall)
    world.run_locally(1e-4 / one.speed + FOLLOWED * SIDE / one.speed, STEPS)
    after = np.average(world.velocity, axis=0, weights=world.mass)
    inside = attitude_of(world, shell).inv().apply(world.position - world.position[shell])
    return {
        "setting": name, "drop": number, "grains": len(grains), "mass": float(world.mass.sum()), "speed": one.speed,
        "rebound_speed": float(np.linalg.norm(after)), "upward": float(after[2]),
        "energy_lost": 1.0 - float(after @ after) / one.speed**2,
        "touches_plane": int((world.contacts()["body_b"] < 0).any()), "farthest_out": float(np.abs(inside).max()),
        "cpu_s": time.process_time() - start,
    }  # fmt: skip


def attitude_of(world: World, body: int) -> Rotation:
    return Rotation.from_quat(world.orientation[body], scalar_first=True)


def main() -> None:
    given = options_of(__doc__, HERE, drops=3, settings=tuple(SETTINGS))
    ran = {(row["setting"], row["drop"]) for row in read_rows(given.out / NAME)}
    for number, name in itertools.product(range(given.drops), given.settings):
        if (name, number) not in ran:
            note(given.out / NAME, bounced(name, number))


if __name__ == "__main__":
    main()
