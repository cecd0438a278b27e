"""Neighbours found in the cells of a grid are those that looking at every body finds."""

import numpy as np
import pytest

from lithobrake.dem import Box, Material, Sphere, World
from lithobrake.dem.local_stepping import cells

ROCK = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=2500.0)


def flock(spread: float) -> World:
    """Spheres of three sizes and a wide slab that fly through each other in all directions over a floor."""
    generator = np.random.default_rng(5)
    world = World(gravity=(0.0, 0.0, -0.5))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROCK)
    places = np.stack(np.meshgrid(*3 * [np.arange(6)], indexing="ij"), axis=-1).reshape(-1, 3)
    for place in places:
        radius = float(generator.choice([0.02, 0.03, 0.04]))
        velocity = generator.normal(scale=spread, size=3)
        world.add_body(Sphere(radius), ROCK, 0.1 * place + (0.0, 0.0, 0.05), velocity)
    world.add_body(Box((0.6, 0.6, 0.05)), ROCK, (0.25, 0.25, 0.8), (0.0, 0.0, -0.5))
    return world


def test_the_same_motion_as_with_one_cell_for_all(monkeypatch: pytest.MonkeyPatch) -> None:
    def motion() -> tuple[np.ndarray, int]:
        world = flock(0.3)
        world.run_locally(0.3, 15.0)
        local = world._state.local
        return world.position.copy(), len(local.cells.first)

    many = motion()
    monkeypatch.setattr(cells, "MOST_CELLS", 1.0 / 217.0)
    one = motion()
    assert many[1] > 100
    assert one[1] == 1
    # Pairs listed in another order are looked at in another order where they are due at once.
    assert many[0] == pytest.approx(one[0], abs=1e-9)


def test_what_flies_far_beyond_the_grid_still_meets() -> None:
    world = World()
    world.add_body(Sphere(0.05), ROCK, (0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
    world.add_body(Sphere(0.05), ROCK, (0.3, 0.0, 0.0), (0.5, 0.0, 0.0))
    world.add_body(Sphere(0.05), ROCK, (0.0, 0.3, 0.0))
    # They meet at x = 0.5, beyond the grid, which ends where the bodies stood.
    world.run_locally(1.0, 15.0)
    assert world.velocity[1, 0] > world.velocity[0, 0]
    assert world.velocity[:2, 0].sum() == pytest.approx(1.5, rel=1e-12)
