"""Worlds of two grains above a plane: stepped once, they have the kernels compiled that any other world calls."""

from lithobrake.dem.bodies.shape import Box
from lithobrake.dem.world import World
from lithobrake.dem.world_state import NOTHING_WATCHED
from lithobrake.vocabulary.material_properties import Material


def two_grains(heights: tuple[float, float]) -> World:
    rock = Material(density=2000.0, young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5)
    world = World(gravity=(0.0, 0.0, -1.0))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), rock)
    for height in heights:
        world.add_body(Box((1.0, 1.0, 1.0)), rock, (0.0, 0.0, height))
    return world


def step_locally(joined: bool = False) -> None:
    """Take steps of each contact's own: so grains fall, and landers land; joined: with parts on hinges."""
    # So far apart that nobody asks whether they are near: another process may compile that for common steps.
    world = two_grains((1.0, 9.0))
    if joined:
        world.join(0, 1, (0.0, 0.0, 5.0), 1.0)
    world.run_locally(1e-3, 25.0)
    world.contacts()


def step_together() -> None:
    """Take a step that all contacts share: so a bed settles, and tells by its forces whether it rests."""
    world = two_grains((1.0, 2.5))
    # The large kernel first, and then those that list neighbours: another process may have them by then.
    engine = world._state.new_engine(world._state.motion, world._state.pairs, world._state.lost)
    engine.advance(1, world._step(0.0), NOTHING_WATCHED)
    world.run(steps=1)
    # Settling asks for the largest step, the watch on a lander for spins.
    world.time_step = min(world.time_step, world.largest_step)
    world.energy()
    world.contacts()
