"""A ball on a bed of beads: what the experiments of validation/experiments ask for, in small."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lithobrake.dem import Material, Sphere, World

SIZE, WIDTH, COUNT = 0.01, 0.06, 200
GRAINS = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.6, friction=0.5, density=2500.0)


def box(beads, pace=1.0, stiffness=1.0):
    """Beads at places in a box, in units of time 1/pace as long: (g, E, v) times pace squared, squared and once."""
    stuff = replace(GRAINS, young_modulus=GRAINS.young_modulus * stiffness * pace**2)
    world = World((0.0, 0.0, -9.81 * pace**2), 5e-5 / pace)
    for place in beads:
        world.add_body(Sphere(0.5 * SIZE), stuff, place)
    world.add_plane((0, 0, 0), (0, 0, 1), stuff)
    for axis in (0, 1):
        for sign in (1.0, -1.0):
            normal = np.zeros(3)
            normal[axis] = sign
            world.add_plane(-0.5 * WIDTH * normal, normal, stuff)
    return world


@pytest.fixture(scope="module")
def bed():
    """Beads that fell from a lattice and lie still, at their places."""
    generator = np.random.default_rng(1)
    index = np.arange(COUNT)
    cells = np.stack([index % 5, index // 5 % 5, index // 25], axis=1) + 0.5
    pitch = WIDTH / 5
    world = box(cells * pitch - [0.5 * WIDTH, 0.5 * WIDTH, 0.0] + 0.08 * pitch * generator.uniform(-1, 1, (COUNT, 3)))
    world.drag = 20.0
    world.run(steps=12_000)
    # A last bead may still roll on top.
    assert np.quantile(np.linalg.norm(world.velocity, axis=1), 0.95) < 1e-3 * math.sqrt(9.81 * SIZE)
    return world.position


def with_ball(bed, density, speed, diameter, place=(0.0, 0.0), pace=1.0, stiffness=1.0):
    """A world with a ball just above all beads, on its way down; the ball is the last body."""
    world = box(bed, pace, stiffness)
    start = bed[:, 2].max() + 0.5 * SIZE + 0.5 * diameter
    world.add_body(Sphere(0.5 * diameter), replace(world.bodies[0].material, density=density), (*place, start),
        velocity=(0.0, 0.0, -speed * pace))  # fmt: skip
    return world


def test_one_drop_is_every_drop_of_its_similarity(bed):
    """Under 1/16384 of the gravity, with as much less stiffness and 1/128 of the speed: the same bits."""
    pair = [with_ball(bed, 2200.0, 1.0, 0.025, pace=pace) for pace in (1.0, 1.0 / 128.0)]
    for world in pair:
        world.run(steps=1500)
    assert (pair[1].gravity[2], pair[1].time) == (pytest.approx(-5.988e-4, rel=1e-4), 128.0 * pair[0].time)
    np.testing.assert_array_equal(pair[0].position, pair[1].position)
    np.testing.assert_array_equal(pair[0].velocity, 128.0 * pair[1].velocity)


def test_a_denser_ball_comes_deeper(bed):
    """Depth grows as the root of the density in experiments [Ambroso-2005]; so few beads show that it grows."""
    depths = []
    for density in (1000.0, 4000.0, 16000.0):
        world = with_ball(bed, density, 1.0, 0.02)
        lowest = math.inf
        for _ in range(40):
            world.run(steps=50)
            lowest = min(lowest, world.position[-1, 2])
        depths.append(bed[:, 2].max() - lowest)
    assert depths[0] < depths[1] < depths[2]
    assert depths[2] > 1.5 * depths[0]


def test_a_grain_leaves_a_bed_of_its_own_kind_slowly(bed):
    """At a Froude number of 20 it keeps about a fifth of its speed on average [Bogdan-2020]."""
    speed = 20.0 * math.sqrt(9.81 * SIZE)
    ratios = []
    for place in np.random.default_rng(2).uniform(-0.01, 0.01, (5, 2)):
        world = with_ball(bed, GRAINS.density, speed, SIZE, tuple(place), stiffness=100.0)
        world.time_step = 1.5e-6
        world.run(duration=0.004)
        ratios.append(np.linalg.norm(world.velocity[-1]) / speed)
    assert np.mean(ratios) < 0.4
