"""The bed, the ball and the walls of the impact of [Dosta-2024], in this engine.

Restitution and friction of pairs are entries of a table there: M1-M1 0.5 and 0.3, M1-steel 0.4 and 0.2, steel-steel 0.6
and 0.5. Under the mean of two materials the values below give each of these pairs exactly: the grains meet walls of
their own, and so does the ball.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem import Material, Sphere, World

Floats = NDArray[np.float64]

GRAVITY = 9.8  # m/s2
GRAIN_RADIUS, BALL_RADIUS = 0.001, 0.01  # m
# m: the inner faces of Penetration/walls.txt.
HALF_X, HALF_Y, FLOOR = 0.049, 0.03, -0.0902431
START, SPEED = 0.06, 5.0  # m and m/s, of the ball
GRAIN = {"young_modulus": 1e9, "poisson_ratio": 0.2, "density": 2500.0}
STEEL = {"young_modulus": 210e9, "poisson_ratio": 0.2, "density": 7200.0}
M1 = Material(restitution=0.5, friction=0.3, **GRAIN)
# With M1 the mean is 0.4 and 0.2.
STEEL_OF_GRAINS = Material(restitution=0.3, friction=0.1, **STEEL)
# With the ball the mean is 0.6 and 0.5.
STEEL_OF_BALL = Material(restitution=0.9, friction=0.9, **STEEL)


def published_positions(path: Path) -> Floats:
    """Return the centres [m] of the spheres in a file of the benchmark, shape [count, 3].

    A line holds radius and centre; the driver drops what does not: head and last line. Raises ValueError for another
    radius.
    """
    lines = [line.split() for line in path.read_text(encoding="ascii").splitlines()[1:]]
    rows = np.array([line for line in lines if len(line) == 4], dtype=float)
    if not (rows[:, 0] == GRAIN_RADIUS).all():
        raise ValueError(f"{path} has a radius other than {GRAIN_RADIUS} m: give the 25KParticles.txt of the benchmark")
    return rows[:, 1:]


def world_of(positions: Floats, step: float | None, dashpot: str = "mindlin") -> World:
    """Return the bed at rest in its box, under a time step [s]; dashpot: the tangential one of World."""
    world = World((0.0, 0.0, -GRAVITY), step, pair_rule="mean", tangential_dashpot=dashpot)
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (len(positions), 1))
    grains = world.add_bodies([Sphere(GRAIN_RADIUS)] * len(positions), M1, positions, upright)
    add_walls(world, STEEL_OF_GRAINS, grains)
    return world


def add_walls(world: World, material: Material, bodies: range) -> None:
    """Add floor and four walls, which these bodies meet."""
    world.add_plane((0, 0, FLOOR), (0, 0, 1), material, bodies=bodies)
    for axis, half in ((0, HALF_X), (1, HALF_Y)):
        for sign in (1.0, -1.0):
            normal = np.zeros(3)
            normal[axis] = sign
            world.add_plane(-half * normal, normal, material, bodies=bodies)


def in_free_fall(time: float) -> tuple[float, float]:
    """Return height [m] and velocity upwards [m/s] of the ball at a time [s] before it touches anything."""
    return START - SPEED * time - 0.5 * GRAVITY * time**2, -SPEED - GRAVITY * time


def add_ball(world: World, place: tuple[float, float]) -> int:
    """Add the steel ball above a place [m], where it is in its free fall at the world's time, and return its number."""
    height, velocity = in_free_fall(world.time)
    ball = world.add_body(Sphere(BALL_RADIUS), STEEL_OF_GRAINS, (*place, height), (0.0, 0.0, velocity))
    add_walls(world, STEEL_OF_BALL, range(ball, ball + 1))
    return ball
