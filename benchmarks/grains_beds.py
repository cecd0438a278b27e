"""The beds of hulls and spheres that other engines were timed on, and larger ones laid out of copies of them.

And a CubeSat that comes down on them.
"""

from pathlib import Path

import numpy as np

from lithobrake.dem import Box, ConvexHull, Material, Shape, Sphere, World

ROCK = Material(young_modulus=5e6, poisson_ratio=0.3, restitution=0.5, friction=0.5, density=2500.0)
WIDTH = {"hull1000": 1.0, "hull2000": 2.0, "hull4000": 2.0, "sph4000": 1.0}
LIBRARY_PERIOD = {"hull1000": 1000, "hull2000": 500, "hull4000": 1000}
TIME_STEP, GRAVITY = 2e-4, 9.81e-3


def library(path: Path) -> list[ConvexHull]:
    """Read the hulls: number of points, then their coordinates, a line each."""
    rows = [line.split() for line in path.read_text().splitlines() if line and not line.startswith("#")]
    return [ConvexHull(np.array(row[1:], dtype=float).reshape(int(row[0]), 3)) for row in rows]


def shapes_of(folder: Path, case: str, radii: np.ndarray) -> list[Shape]:
    if case.startswith("sph"):
        made = {radius: Sphere(radius) for radius in set(radii)}
        return [made[radius] for radius in radii]
    hulls = library(folder / "hull_library.txt")
    return [hulls[k % LIBRARY_PERIOD[case] % 64] for k in range(len(radii))]


def bed(folder: Path, case: str, tiles: tuple[int, int] = (1, 1)) -> World:
    """Return a bed in its open box, or so many copies of it side by side in one."""
    rows, width = np.loadtxt(folder / f"{case}.txt"), WIDTH[case]
    shapes = shapes_of(folder, case, rows[:, 0])
    world = World((0.0, 0.0, -GRAVITY), TIME_STEP)
    for i in range(tiles[0]):
        for j in range(tiles[1]):
            for shape, row in zip(shapes, rows, strict=True):
                place = row[1:4] + np.array([i * width, j * width, 0.0])
                world.add_body(shape, ROCK, place, velocity=row[8:11], orientation=row[4:8], spin=row[11:14])
    low = -0.5 * width
    high = (low + tiles[0] * width, low + tiles[1] * width)
    world.add_plane((0, 0, 0), (0, 0, 1), ROCK)
    for axis in (0, 1):
        inward = np.eye(3)[axis]
        world.add_plane((low, low, 0), inward, ROCK)
        world.add_plane((*high, 0), -inward, ROCK)
    return world


def boxes(world: World, width: float, count: int, share: float = 1.0) -> World:
    """Return copies of a bed on one floor, each in a box of its own, of the grains in a share of its width along x."""
    copies = World(tuple(world.gravity), TIME_STEP)
    copies.add_plane((0, 0, 0), (0, 0, 1), ROCK)
    radius = np.array([body.shape.bounding_radius for body in world.bodies])
    kept = np.flatnonzero(world.position[:, 0] < (share - 0.5) * width)
    low = -0.5 * width
    # A wall stands where the farthest grain that is kept reaches.
    high = -low if share == 1.0 else float((world.position[kept, 0] + radius[kept]).max())
    for k in range(count):
        shift = np.array([2.0 * width * k, 0.0, 0.0])
        numbers = [
            copies.add_body(world.bodies[n].shape, ROCK, world.position[n] + shift, orientation=world.orientation[n])
            for n in kept
        ]
        for point, inward in (
            ((low, 0, 0), (1, 0, 0)), ((high, 0, 0), (-1, 0, 0)), ((0, low, 0), (0, 1, 0)), ((0, -low, 0), (0, -1, 0))
        ):  # fmt: skip
            copies.add_plane(np.array(point) + shift, inward, ROCK, bodies=numbers)
    return copies


def relaxed(world: World, steps: int) -> World:
    """Let a bed find its rest with drag; copies of one overlap where they meet, and start at half the step."""
    world.drag = 2.0
    world.time_step = 0.5 * TIME_STEP
    world.run(steps=steps // 10)
    world.time_step = TIME_STEP
    world.run(steps=steps)
    world.drag = 0.0
    return world


def touch_down(world: World, speed: float) -> None:
    """Let a CubeSat of 6 kg (0.2 x 0.1 x 0.1 m) come down amid a bed, until its first steps in it."""
    top = float(world.position[np.linalg.norm(world.position[:, :2], axis=1) < 0.2, 2].max())
    world.add_body(Box((0.2, 0.1, 0.1)), ROCK, (0.0, 0.0, top + 0.1), velocity=(0.5 * speed, 0, -speed), mass=6.0)
    world.time_step = TIME_STEP
    world.run(steps=100)


def coordination(world: World) -> float:
    """Mean number of bodies that touch a body."""
    return 2.0 * int((world.contacts()["body_b"] >= 0).sum()) / len(world.bodies)
