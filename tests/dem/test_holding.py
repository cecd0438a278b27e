"""What is slow and out of reach stands still and loses nothing; the agenda and the cells of steps of their own."""

from dataclasses import replace

import numpy as np
import pytest

from lithobrake.compilation.compiled import large_kernel
from lithobrake.dem import Box, Material, Sphere, World
from lithobrake.dem.local_stepping import cells
from lithobrake.dem.local_stepping.agenda import Agenda, new_agenda, put_on, take_off

HARD = Material(young_modulus=1e7, poisson_ratio=0.25, density=2500.0, restitution=1.0, friction=0.0)
ROUGH = Material(young_modulus=1e7, poisson_ratio=0.25, density=2500.0, restitution=0.5, friction=0.5)


def row_of_balls(count: int = 6, apart: float = 0.0, friction: float = 0.0) -> World:
    """A ball that slides at a row of balls on the ground, which come to rest before; the first is watched."""
    world, ball = World(gravity=(0.0, 0.0, -1e-3)), replace(HARD, friction=friction)
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), replace(HARD, restitution=0.2))
    world.add_body(Sphere(0.05), ball, (-0.6, apart, 0.05), (0.2, 0.0, 0.0))
    for k in range(count):
        world.add_body(Sphere(0.05), ball, (0.1 * k * (1.0 - 1e-7), 0.0, 0.05))
    world.watch(0)
    return world


def sunk(radius: float, load: float, curvatures: int = 1) -> float:
    """Overlap [m] of a ball of the rough material with the ground (1), or with another like it (2), under a load [N].

    Source: Hertz (1882).
    """
    stiff = 4.0 / 3.0 * ROUGH.young_modulus / (2.0 * (1.0 - ROUGH.poisson_ratio**2))
    return (load / (stiff * (radius / curvatures) ** 0.5)) ** (2.0 / 3.0)


def heap() -> World:
    """Balls at rest on the ground, beside one another, and one far from them that comes down."""
    world = World(gravity=(0.0, 0.0, -1e-3))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROUGH)
    world.add_body(Sphere(0.05), ROUGH, (0.0, 0.0, 0.06), (0.0, 0.0, -0.05))
    rest = 0.05 - sunk(0.05, world.mass[0] * 1e-3)
    for k in range(4):
        world.add_body(Sphere(0.05), ROUGH, (1.0 + 0.11 * k, 0.0, rest))
    world.watch(0)
    return world


def held(world: World) -> np.ndarray:
    return world._state.local.flight.held


def test_a_blow_frees_what_it_reaches_and_keeps_its_momentum() -> None:
    free, world = row_of_balls(), row_of_balls()
    for each, speed in ((free, 0.0), (world, 0.01)):
        each.run_locally(1.5, 60.0)
        for number in range(60):
            each.run_locally(0.03, 60.0, held_speed=speed)
            # Before the blow all of the row is held.
            assert speed == 0.0 or number > 20 or held(each)[1:].all()
    # Like Newton's cradle: the last ball leaves with nearly all.
    assert free.velocity[-1, 0] > 0.15
    assert world.velocity[-1, 0] == pytest.approx(free.velocity[-1, 0], rel=0.05)
    # What a blow loses on a body before it goes is of a body as slow as what is held.
    assert world.velocity[:, 0].sum() == pytest.approx(0.2, rel=0.05)


def test_the_ledger_closes_as_bouncing_bodies_are_held_and_let_go() -> None:
    world = World(gravity=(0.0, 0.0, -1e-3))
    soft = replace(HARD, young_modulus=1e5)
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), soft)
    world.add_body(Sphere(0.05), soft, (0.0, 0.0, 50.0), (0.05, 0.0, 0.0))
    for k in range(4):
        world.add_body(Sphere(0.05), soft, (1.0 + 0.11 * k, 0.0, 0.05 - 1e-5 * (k + 1)))
    world.watch(0)
    before, motion, times_held = world.energy()["total"], 0.0, 0
    for k in range(200):
        world.run_locally(0.0193, 400.0, held_speed=0.025, reach=0.0 if k % 2 else 100.0)
        motion = max(motion, float(world.kinetic_energy[1:].sum()))
        times_held += int(held(world).sum())
    assert times_held > 200
    # Elastic energy is that of the last looks.
    assert world.energy()["total"] == pytest.approx(before, abs=0.01 * motion)


def test_what_is_held_shows_the_forces_of_its_contacts() -> None:
    world = heap()
    world.time_step = world.shortest_contact(0.1) / 50.0
    world.run(steps=1)
    pressed = world.contact_force[1:, 2]
    world.run_locally(0.0, 25.0, held_speed=0.025)
    assert held(world)[1:].all()
    assert world.contact_force[1:, 2] == pytest.approx(pressed, rel=2e-3)  # dashpots see speeds half a kick apart
    assert (pressed > 0.0).all()


def test_bodies_that_took_common_steps_before_are_found_by_what_comes() -> None:
    # The smallest body gives the reach of the lists of common steps, the median one that of steps of their own.
    def ends(common_steps: bool) -> World:
        world = row_of_balls(2)
        for x in (0.204, 0.304 - 1e-8):
            world.add_body(Sphere(0.05), HARD, (x, 0.0, 0.05))
        world.add_body(Sphere(0.005), HARD, (0.0, -5.0, 0.005))
        if common_steps:
            world.time_step = 1e-9
            world.run(steps=1)
        for _ in range(200):
            world.run_locally(0.02, 50.0, held_speed=0.1)
        return world

    fresh, world = ends(False), ends(True)
    assert fresh.velocity[4, 0] > 0.1
    assert world.velocity[:, 0] == pytest.approx(fresh.velocity[:, 0], abs=0.01)


def test_what_rests_on_a_held_body_does_not_sink() -> None:
    # Touching by no more than a rounding, with no speed: gravity alone presses them together.
    radius, gravity = 0.0625, 1e-2
    world = World(gravity=(0.0, 0.0, -gravity))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROUGH)
    world.add_body(Sphere(radius), ROUGH, (-100.0, 0.0, 50.0), (0.0, 1.0, 0.0))
    for centre in (radius, 3.0 * radius):
        world.add_body(Sphere(radius), ROUGH, (1.0, 0.0, centre - 2.0**-20))
    world.watch(0)
    for _ in range(100):
        world.run_locally(0.02, 25.0, held_speed=0.5)
    assert held(world)[1]
    weight = world.mass[1] * gravity
    most = sunk(radius, 2.0 * weight) + sunk(radius, weight, 2)
    assert 0.0 <= 3.0 * radius - world.position[2, 2] <= 1.2 * most


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_the_ledger_closes_as_oblique_blows_free_bodies(friction: float) -> None:
    for apart in (0.02, -0.04, 0.06):
        world = row_of_balls(3, apart, friction)
        world.run_locally(1.5, 100.0)
        before, freed = world.energy()["total"], False
        for _ in range(60):
            world.run_locally(0.03, 100.0, held_speed=0.06)
            freed |= not held(world)[1]
        assert freed
        assert world.energy()["total"] == pytest.approx(before, rel=1e-3)


def test_what_is_far_and_at_rest_stands_still_until_the_watched_body_is_near() -> None:
    world = heap()
    world.run_locally(0.1, 15.0, held_speed=0.005, reach=0.2)
    assert held(world)[1:].all()
    assert not held(world)[0]
    place = world.position[1:]
    world.run_locally(0.3, 15.0, held_speed=0.005, reach=0.2)
    assert (world.position[1:] == place).all()
    world.run_locally(0.3, 15.0, held_speed=0.005, reach=2.0)
    assert not held(world).any()


def test_what_is_slower_than_calm_is_held_and_let_go_by_a_blow_of_the_held_speed() -> None:
    def slide(calm_speed: float | None) -> World:
        world = heap()
        # Without friction it goes on at 1e-3 m/s, towards the next ball 0.01 m away.
        world.add_body(Sphere(0.05), replace(ROUGH, friction=0.0), (2.0, 0.0, 0.05), (1e-3, 0.0, 0.0))
        world.run_locally(1.0, 15.0)
        world.run_locally(0.1, 15.0, held_speed=1e-3, calm_speed=calm_speed)
        return world

    assert not held(slide(None))[-1]
    assert not held(slide(0.9e-3))[-1]
    world = slide(5e-3)
    assert held(world)[1:].all()
    # It has booked its motion as lost, and goes on from rest once a ball hits it.
    assert (world.velocity[-1] == 0.0).all()
    world.add_body(Sphere(0.05), HARD, (1.85, 0.0, 0.05), (0.01, 0.0, 0.0))
    for _ in range(30):
        world.run_locally(0.5, 15.0, held_speed=1e-3, calm_speed=2e-3)
    assert not held(world)[-2]
    assert world.velocity[-2, 0] > 2e-3


def test_with_all_in_reach_no_bit_changes() -> None:
    plain, other = heap(), heap()
    for _ in range(5):
        plain.run_locally(0.2, 15.0)
        other.run_locally(0.2, 15.0, held_speed=0.005, reach=10.0)
    assert plain.position.tobytes() == other.position.tobytes()


def test_common_steps_let_all_go() -> None:
    world = heap()
    world.run_locally(0.1, 15.0, held_speed=0.005)
    assert held(world)[1:].all()
    before = world.energy()["total"]
    world.time_step = world.shortest_contact(0.1) / 500.0
    world.run(steps=1)
    # They go on from rest, under forces that carry half of their weight at least.
    assert np.abs(world.velocity[1:, 2]).max() < 1e-3 * world.time_step
    assert world.energy()["total"] == pytest.approx(before, rel=1e-6)


@large_kernel
def do(agenda: Agenda, item: int, time: float) -> None:
    if time >= 0.0:
        put_on(agenda, item, time)
    else:
        take_off(agenda, item)


def test_items_come_in_the_order_of_their_times_whatever_came_before() -> None:
    generator = np.random.default_rng(4)
    agenda, expected = new_agenda(40), {}
    for item, at in zip(generator.integers(40, size=3000).tolist(), generator.integers(-4, 12, size=3000), strict=True):
        do(agenda, item, float(at))
        if at >= 0:
            expected[item] = float(at)
        else:
            expected.pop(item, None)
        assert agenda.size[0] == len(expected)
        if expected:
            assert agenda.heap[0] == min(expected, key=lambda one: (expected[one], one))
    while expected:
        first = int(agenda.heap[0])
        assert first == min(expected, key=lambda one: (expected[one], one))
        do(agenda, first, -1.0)
        del expected[first]
    assert agenda.size[0] == 0


ROCK = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=2500.0)


def flock(spread: float) -> World:
    """Spheres of three sizes and a wide slab that fly through each other in all directions over a floor."""
    generator = np.random.default_rng(5)
    world = World(gravity=(0.0, 0.0, -0.5))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROCK)
    places = np.stack(np.meshgrid(*3 * [np.arange(6)], indexing="ij"), axis=-1).reshape(-1, 3)
    for place in places:
        radius = float(generator.choice([0.02, 0.03, 0.04]))
        world.add_body(Sphere(radius), ROCK, 0.1 * place + (0.0, 0.0, 0.05), generator.normal(scale=spread, size=3))
    world.add_body(Box((0.6, 0.6, 0.05)), ROCK, (0.25, 0.25, 0.8), (0.0, 0.0, -0.5))
    return world


def test_the_same_motion_as_with_one_cell_for_all(monkeypatch: pytest.MonkeyPatch) -> None:
    def motion() -> tuple[np.ndarray, int]:
        world = flock(0.3)
        world.run_locally(0.3, 15.0)
        return world.position.copy(), len(world._state.local.cells.first)

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
