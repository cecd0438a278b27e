"""Hulls pressed together past their rounding, as by hard impacts: they part again, and keep their energy."""

import math

import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Material, World
from lithobrake.touchdown.grains import make_grain

PAIRS = 200


def touching_distances(
    pairs: list[tuple[ConvexHull, ConvexHull]], turns: np.ndarray, along: np.ndarray, rock: Material
) -> np.ndarray:
    """Distances of two centroids [m] at which the hulls of each pair begin to touch, by bisection, [pairs].

    turns: [pairs, 2, 4]; along: unit vectors from one to the other, [pairs, 3]. All pairs lie in one world.
    """
    hulls, first = [hull for pair in pairs for hull in pair], np.arange(len(pairs))[:, None] * [1.0, 0.0, 0.0]
    near = np.zeros(len(pairs))
    far = np.array([2.0 * max(hull.bounding_radius for hull in pair) for pair in pairs])
    # Their size over 2**15, a few millionths of a metre: a hundredth of the roundings and less.
    for _ in range(15):
        middle = 0.5 * (near + far)
        world = World((0, 0, 0), 1e-9)
        places = np.stack([first, first + middle[:, None] * along], axis=1).reshape(-1, 3)
        world.add_bodies(hulls, rock, places, turns.reshape(-1, 4))
        touch = np.isin(np.arange(len(pairs)), world.contacts()["body_a"] // 2)
        near, far = np.where(touch, middle, near), np.where(touch, far, middle)
    return near


def pressed(hulls: tuple[ConvexHull, ConvexHull], turns: np.ndarray, apart: np.ndarray, rock: Material) -> World:
    """Return a world of two hulls at rest."""
    world = World((0, 0, 0), 1e-9)
    for hull, turn, place in zip(hulls, turns, (np.zeros(3), apart), strict=True):
        world.add_body(hull, rock, place, orientation=turn)
    return world


def test_hulls_pressed_into_each_other_part_with_their_energy():
    """Depths of 1.3 to 2 times both roundings, where the cores cross: no way of lying in each other is one of rest."""
    rock = Material(young_modulus=5e6, poisson_ratio=0.3, restitution=1.0, friction=0.0, density=2500.0)
    generator = np.random.default_rng(3)
    pairs, turns, along, shares = [], [], [], []
    for _ in range(PAIRS):
        pairs.append(tuple(make_grain(generator, 14, 0.08) for _ in range(2)))
        turns.append(generator.normal(size=(2, 4)))
        along.append(generator.normal(size=3))
        shares.append(generator.uniform(1.3, 2.0))
    turns /= np.linalg.norm(turns, axis=2)[..., None]
    along /= np.linalg.norm(along, axis=1)[:, None]
    apart = touching_distances(pairs, turns, along, rock)
    apart -= shares * np.array([sum(hull.rounding for hull in pair) for pair in pairs])
    ratios = []
    for pair, turn, place in zip(pairs, turns, apart[:, None] * along, strict=True):
        world = pressed(pair, turn, place, rock)
        stored = world.energy()["elastic"]
        world.time_step = 0.02 * world.largest_step
        for _ in range(400):
            world.run(steps=50)
            if len(world.contacts()) == 0:
                break
            world.time_step = min(world.time_step, 0.02 * world.largest_step)
        assert len(world.contacts()) == 0
        ratios.append(world.energy()["kinetic"] / stored)
    assert np.abs(np.array(ratios) - 1.0).max() < 0.02


HALF = math.pi / 8.0  # half of the angle that stands a cube on its edge


@pytest.mark.parametrize(("turns", "touching"), [
    (((math.cos(HALF), math.sin(HALF), 0, 0), (math.cos(HALF), 0, math.sin(HALF), 0)), "edges"),
    (((1, 0, 0, 0), (1, 0, 0, 0)), "faces"),
])  # fmt: skip
@pytest.mark.parametrize("depth", [2.0, 3.0, 4.0])
def test_deep_contacts_are_hertz(turns, touching, depth):
    """Cubes on crossed edges, or flush, at overlaps past the rounding: 2/5 K d^(5/2), though no corner lies inside."""
    rock = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=1.0, friction=0.0, density=2500.0)
    cube = Box((1.0, 1.0, 1.0))
    edge = math.sqrt(0.5) - (math.sqrt(2.0) - 1.0) * cube.rounding
    overlap = 2.0 * depth * cube.rounding
    world = World((0, 0, 0), 1e-9)
    for turn, height in zip(turns, (0.0, 2.0 * (edge if touching == "edges" else 0.5) - overlap), strict=True):
        world.add_body(cube, rock, (0, 0, height), orientation=turn)
    stiffness = 4.0 / 3.0 * 1e7 / (2.0 * (1.0 - 0.25**2)) * math.sqrt(0.5 * math.cbrt(0.75 / math.pi))
    assert world.energy()["elastic"] == pytest.approx(0.4 * stiffness * overlap**2.5, rel=0.03)
