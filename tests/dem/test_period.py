"""A world that repeats along x and y: nothing notices where one period ends and the next begins."""

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Material, Shape, Sphere, World
from lithobrake.dem.local_stepping import cells
from lithobrake.dem.stepping.neighbours import neighbouring_pairs

ROCK = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=0.6, friction=0.5, density=2500.0)
DULL = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=0.1, friction=0.3, density=2500.0)
SMOOTH = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=0.6, friction=0.0, density=2500.0)
PERIOD = (0.6, 0.7)
GRAINS = 48
STEPPINGS = ("common", "own")
# For hulls at steps of their own: whether a contact keeps its step is decided at a threshold, to which rounding leads.
ROUNDING, THRESHOLD = 1e-11, 1e-4


def hull(generator: np.random.Generator, radius: float) -> ConvexHull:
    """The envelope of points evenly on a sphere."""
    points = generator.normal(size=(12, 3))
    return ConvexHull(radius * points / np.linalg.norm(points, axis=1)[:, None])


def advance(world: World, duration: float, stepping: str) -> None:
    if stepping == "common":
        world.run(duration)
    else:
        world.run_locally(duration, 25.0)


def pair(spheres: bool, middle: np.ndarray, period: tuple[float, float] | None) -> World:
    """Two spinning bodies that meet askew at a place, each of them in the tile about the origin."""
    generator = np.random.default_rng(4)
    world = World(time_step=2e-5, period=period)
    for side in (-1.0, 1.0):
        shape: Shape = Sphere(0.05) if spheres else hull(generator, 0.07)
        place = middle + side * np.array([0.06, 0.04, 0.01])
        if period is not None:
            place[:2] -= np.round(place[:2] / period) * period
        world.add_body(shape, ROCK, place, velocity=-side * np.array([0.5, 0.3, 0.0]), spin=side * np.array([1, 2, 3]))
    return world


def gas(count: int = 30, friction: float = 0.5) -> World:
    """Hulls and spheres that fly through each other between a smooth floor and a smooth lid, with no one speed."""
    generator = np.random.default_rng(7)
    stuff = Material(**{**vars(ROCK), "friction": friction})
    world = World(period=PERIOD, time_step=5e-5)
    for k in range(count):
        place = [0.16 * (k % 4) + 0.02, 0.17 * (k // 4 % 4), 0.1 + 0.17 * (k // 16)]
        shape: Shape = Sphere(0.05) if k % 3 == 0 else hull(generator, 0.06)
        world.add_body(shape, stuff, place, velocity=generator.normal(size=3), spin=generator.normal(size=3))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), SMOOTH)
    world.add_plane((0.0, 0.0, 0.5), (0.0, 0.0, -1.0), SMOOTH)
    return world


@cache
def fallen(spheres: bool) -> World:
    """Hulls or spheres that have fallen on a floor."""
    generator, world = np.random.default_rng(9), World((0.0, 0.0, -9.81), period=PERIOD)
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROCK)
    for k in range(GRAINS):
        place = np.array([0.15 * (k % 4), 0.175 * (k // 4 % 4), 0.1 + 0.15 * (k // 16)])
        shape: Shape = Sphere(0.07) if spheres else hull(generator, 0.09)
        world.add_body(shape, ROCK, place + 0.01 * generator.normal(size=3))
    world.drag = 5.0
    world.run_locally(0.8, 10.0)
    return world


def pile(shift: tuple[float, float] = (0.0, 0.0), scatter: int | None = None, spheres: bool = False) -> World:
    """What has fallen, at rest, moved sideways, and each by so many whole periods as a seed says."""
    made, world = fallen(spheres), World((0.0, 0.0, -9.81), 1e-4, period=PERIOD)
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROCK)
    count = (GRAINS, 2)
    tiles = np.zeros(count) if scatter is None else np.random.default_rng(scatter).integers(-3, 4, size=count)
    way = np.column_stack([np.array(shift) + tiles * PERIOD, np.zeros(GRAINS)])
    world.add_bodies([body.shape for body in made.bodies], ROCK, made.position + way, made.orientation)
    return world


@pytest.mark.parametrize("stepping", STEPPINGS)
@pytest.mark.parametrize("spheres", [True, False])
@pytest.mark.parametrize("middle", [(0.3, 0.0, 0.0), (0.0, -0.35, 0.0), (0.3, 0.35, 0.0), (4.5, -1.05, 0.0)])
def test_a_collision_through_the_boundary_is_that_in_the_middle(
    middle: tuple[float, float, float], spheres: bool, stepping: str
) -> None:
    alone, through = pair(spheres, np.zeros(3), None), pair(spheres, np.array(middle), PERIOD)
    for world in (alone, through):
        advance(world, 0.1, stepping)
    assert alone.energy()["damping"] > 0.0
    way = through.position - alone.position
    way[:, :2] -= np.array(middle)[:2]
    way[:, :2] -= np.round(way[:, :2] / PERIOD) * PERIOD
    tolerance = THRESHOLD if stepping == "own" and not spheres else ROUNDING
    assert np.abs(way).max() < tolerance * 0.1
    assert through.velocity == pytest.approx(alone.velocity, abs=tolerance)
    assert through.spin == pytest.approx(alone.spin, abs=20.0 * tolerance)


def test_a_pile_moved_anywhere_has_the_same_forces() -> None:
    here = pile()
    largest = np.abs(here.contact_force).max()
    for seed, shift in enumerate([(0.3, 0.0), (0.123, -0.456), (71.0, 0.35)]):
        there = pile(shift, seed)
        assert np.abs(there.contact_force - here.contact_force).max() < 1e-8 * largest
        assert np.abs(there.contact_torque - here.contact_torque).max() < 1e-9 * largest
        contacts = [{(c["body_a"], c["body_b"]) for c in world.contacts()} for world in (here, there)]
        assert contacts[0] == contacts[1]
        assert len(contacts[0]) > 80


@pytest.mark.parametrize("stepping", STEPPINGS)
def test_a_pile_moved_anywhere_moves_the_same(stepping: str) -> None:
    """Under a gravity that it did not settle under; spheres, see THRESHOLD."""
    here, there = pile(spheres=True), pile((0.123, -0.456), 2, spheres=True)
    start = here.position, there.position
    for world in (here, there):
        world.gravity = (2.0, 1.0, -5.0)
        advance(world, 0.01, stepping)
    ways = [world.position - before for world, before in zip((here, there), start, strict=True)]
    assert np.abs(ways[0]).max() > 1e-5
    assert ways[1] == pytest.approx(ways[0], abs=1e-9 * np.abs(ways[0]).max())
    assert np.abs(there.contact_force - here.contact_force).max() < 1e-6 * np.abs(here.contact_force).max()


def test_the_pile_leans_on_its_images() -> None:
    world = pile()
    contacts = world.contacts()
    between = contacts[contacts["body_b"] >= 0]
    way = world.position[between["body_b"]] - world.position[between["body_a"]]
    assert ((np.abs(way[:, :2]) > 0.5 * np.array(PERIOD)).sum(axis=0) >= 5).all()


@pytest.mark.parametrize("stepping", STEPPINGS)
def test_a_gas_keeps_its_momentum_along_the_periods(stepping: str) -> None:
    world = gas()
    start, size = world.mass @ world.velocity, float(world.mass @ np.abs(world.velocity).sum(axis=1))
    advance(world, 0.5, stepping)
    # What crossed a boundary has met others there.
    assert (np.abs(world.position[:, :2]) > 0.5 * np.array(PERIOD)).any()
    assert world.energy()["friction"] > 0.0
    assert (world.mass @ world.velocity)[:2] == pytest.approx(start[:2], abs=1e-12 * size)


@pytest.mark.parametrize(("stepping", "error"), [("common", 1e-3), ("own", 5e-3)])
def test_the_ledger_of_energy_closes(stepping: str, error: float) -> None:
    """With own steps as well as in test_local_steps.py."""
    world = gas()
    world.gravity = (0.3, -0.2, -1.0)
    start = world.energy()
    if stepping == "common":
        world.run(0.5)
    else:
        world.run_locally(0.5, 60.0)
    assert world.energy()["damping"] > 0.0
    assert world.energy()["total"] == pytest.approx(start["total"], abs=error * start["kinetic"])


@pytest.mark.parametrize("stepping", STEPPINGS)
def test_threads_change_no_bit(stepping: str) -> None:
    alone, shared = gas(), gas()
    shared.thread_count = 2
    for world in (alone, shared):
        advance(world, 0.1, stepping)
    assert alone.energy()["damping"] > 0.0
    for name in ("position", "velocity", "orientation", "angular_momentum", "contact_force", "contact_torque"):
        assert np.array_equal(getattr(alone, name), getattr(shared, name))
    assert np.array_equal(alone.contacts(), shared.contacts())


@pytest.mark.parametrize("stepping", STEPPINGS)
def test_a_checkpoint_goes_on_bit_for_bit(stepping: str, tmp_path: Path) -> None:
    world = gas()
    advance(world, 0.1, stepping)
    world.save(tmp_path / "gas.h5")
    again = World.load(tmp_path / "gas.h5")
    assert again.period == PERIOD
    for one in (world, again):
        advance(one, 0.1, stepping)
    assert np.array_equal(world.position, again.position)
    assert np.array_equal(world.angular_momentum, again.angular_momentum)
    assert World().period is None


@pytest.mark.parametrize("stepping", STEPPINGS)
def test_what_slides_over_the_boundary_notices_nothing(stepping: str) -> None:
    """A box over hulls, or a ball over balls, farther than a period: in two worlds with boundaries at other places.

    At steps of their own only balls: see THRESHOLD, of which each contact of a hull would make more.
    """
    spheres, motions = stepping == "own", []
    for shift, scatter in (((0.0, 0.0), None), ((0.25, 0.3), 3)):
        world = pile(shift, scatter, spheres)
        world.gravity = (0.0, 0.0, -20.0)
        place = (shift[0], shift[1], float(world.position[:, 2].max()) + (0.125 if spheres else 0.15))
        shape: Shape = Sphere(0.05) if spheres else Box((0.15, 0.12, 0.1))
        lander = world.add_body(shape, DULL, place, velocity=(8.0, 1.0, -1.0))
        world.watch(lander)
        advance(world, 0.2, stepping)
        motion = world.motion_of(lander)
        motions.append((motion.position - place, motion.velocity, motion.spin))
        assert world.watched["last_contact"] - world.watched["first_contact"] > 0.05
    assert motions[0][0][0] > PERIOD[0]
    for one, other in zip(*motions, strict=True):
        # Of many contacts one after the other, each multiplies what rounding began with.
        assert one == pytest.approx(other, abs=1e-6)


def test_neighbours_are_those_among_all_images() -> None:
    """Spheres strewn over several tiles: each pair whose nearest images are less than the skin apart, once."""
    generator, skin = np.random.default_rng(2), 0.03
    world = World(time_step=1e-5, period=PERIOD)
    for place in generator.uniform(-1.0, 1.0, size=(40, 3)) * (2.0, 2.0, 0.2):
        world.add_body(Sphere(0.05), ROCK, place)
    engine = world._state.stepping_together(world._step(0.0))
    found = neighbouring_pairs(engine.bodies, engine.cores, engine.planes, engine.scratch, skin)
    images = [np.array([i * PERIOD[0], j * PERIOD[1], 0.0]) for i in range(-8, 9) for j in range(-8, 9)]
    way = world.position[:, None] - world.position
    distance = np.min([np.linalg.norm(way + image, axis=2) for image in images], axis=0)
    first, second = np.nonzero(np.triu(distance < 0.1 + skin, 1))
    assert list(zip(found.first, found.second, strict=True)) == list(zip(first, second, strict=True))
    across = np.abs(way[first, second, :2]) > 0.5 * np.array(PERIOD)
    assert across.any(axis=0).all()


def test_own_steps_find_neighbours_in_cells_as_among_all(monkeypatch: pytest.MonkeyPatch) -> None:
    """Spheres that fly through each other and over boundaries, in the cells of a period or all in one."""

    def motion() -> tuple[np.ndarray, np.ndarray, int]:
        generator, world = np.random.default_rng(3), World(period=(0.5, 0.6))
        for place in np.stack(np.meshgrid(*3 * [np.arange(5)], indexing="ij"), axis=-1).reshape(-1, 3):
            world.add_body(Sphere(0.03), ROCK, (0.1, 0.12, 0.1) * place, generator.normal(scale=0.3, size=3))
        world.run_locally(0.3, 15.0)
        return world.position, world.velocity, len(world._state.local.cells.first)

    many = motion()
    monkeypatch.setattr(cells, "MOST_CELLS", 1.0 / 125.0)
    one = motion()
    assert many[2] > 100
    assert one[2] == 1
    assert (many[0][:, :2] < -0.05).any(axis=0).all()
    # Pairs listed in another order are looked at in another order where they are due at once.
    assert many[0] == pytest.approx(one[0], abs=1e-9)
    assert many[1] == pytest.approx(one[1], abs=1e-8)


@pytest.mark.parametrize("period", [(1.0,), (1.0, 0.0), (1.0, math.inf), (math.nan, 1.0), (-1.0, 1.0)])
def test_a_period_is_two_positive_lengths(period: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match=r"World period is .* allowed are two finite lengths above 0"):
        World(period=period)


@pytest.mark.parametrize("stepping", STEPPINGS)
def test_a_period_in_which_two_could_meet_twice_is_refused(stepping: str) -> None:
    # 2 (0.1 + 0.05 + 2 skins of a quarter of the smallest radius, 0.02)
    least = 2.0 * (0.15 + 2.0 * 0.005)
    for period, fine in (((0.999 * least, 1.0), False), ((1.0, 0.999 * least), False), ((1.001 * least, 1.0), True)):
        world = World(time_step=1e-4, period=period)
        for k, radius in enumerate((0.05, 0.1, 0.02)):
            world.add_body(Sphere(radius), ROCK, (0.0, 0.0, 0.4 * k))
        if fine:
            advance(world, 1e-3, stepping)
        else:
            with pytest.raises(ValueError, match=r"World period is .* at least 0\.32 m"):
                advance(world, 1e-3, stepping)


def test_a_plane_that_does_not_repeat_is_refused() -> None:
    with pytest.raises(ValueError, match=r"add_plane normal is .* allowed is one along z"):
        World(period=PERIOD).add_plane((0.0, 0.0, 0.0), (0.1, 0.0, 1.0), ROCK)
