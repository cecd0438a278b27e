"""What a world takes, refuses and gives back; and one that repeats along x and y."""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import h5py
import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Material, Shape, Sphere, World
from lithobrake.dem.law.restitution import PAIR_RULES, pair_law
from lithobrake.dem.local_stepping import cells, local_engine
from lithobrake.dem.stepping.neighbours import neighbouring_pairs

ROCK = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=2500.0)


@pytest.mark.parametrize(("name", "value"), [
    ("young_modulus", 0.0),
    ("poisson_ratio", 0.5),
    ("poisson_ratio", -0.1),
    ("restitution", 0.0),
    ("restitution", 1.1),
    ("friction", -0.1),
    ("density", math.nan),
])  # fmt: skip
def test_materials_outside_their_ranges_are_refused(name, value):
    values = {"young_modulus": 1e7, "poisson_ratio": 0.25, "restitution": 0.5, "friction": 0.5, "density": 2500.0}
    with pytest.raises(ValueError, match=f"Material.{name}"):
        Material(**{**values, name: value})


def test_pair_takes_the_smaller_friction_and_restitution_unless_told_otherwise():
    other = Material(young_modulus=1e8, poisson_ratio=0.3, restitution=0.8, friction=0.2, density=1000.0)
    assert pair_law(ROCK, other).friction == 0.2
    assert pair_law(ROCK, other, pair_rule="mean").friction == pytest.approx(0.35)
    assert pair_law(ROCK, other, pair_rule="geometric").friction == pytest.approx(math.sqrt(0.1))
    assert pair_law(ROCK, other) == pair_law(other, ROCK)
    rough = replace(other, friction=0.9, rough=True)
    for rule in PAIR_RULES:
        assert pair_law(ROCK, rough, pair_rule=rule).friction == pair_law(rough, ROCK, pair_rule=rule).friction == 0.9
    assert pair_law(rough, replace(rough, friction=0.7)).friction == 0.9


@pytest.mark.parametrize(("nu", "factor"), [(0.1, 1.106), (0.2, 1.227), (0.3, 1.373), (0.4, 1.556)])
def test_printed_shear_modulus_is_too_stiff(nu, factor):
    rock = Material(young_modulus=1e7, poisson_ratio=nu, restitution=0.5, friction=0.5, density=2500.0)
    ratio = pair_law(rock, rock, "paper").shear_modulus / pair_law(rock, rock).shear_modulus
    assert ratio == pytest.approx(factor, abs=1e-3)


def test_state_reads_as_it_was_given():
    world = World((0, 0, -1.0), 1e-4)
    turn = np.array([0.5, 0.5, -0.5, 0.5])
    body = world.add_body(Box((0.1, 0.2, 0.3)), ROCK, (1, 2, 3), velocity=(4, 5, 6), orientation=turn, spin=(7, 8, 9))
    assert body == 0
    assert np.allclose(world.position[0], (1, 2, 3))
    assert np.allclose(world.velocity[0], (4, 5, 6))
    assert np.allclose(world.orientation[0], turn)
    assert np.allclose(world.spin[0], (7, 8, 9))
    assert world.mass[0] == pytest.approx(2500 * 0.006)
    assert np.allclose(world.inertia[0], 15.0 / 12.0 * np.array([0.05, 0.10, 0.13]))


def test_gravity_may_be_given_anew_and_is_refused_where_it_is_no_vector():
    world = World()
    world.gravity = (0.0, 0.0, -2.0)
    world.add_body(Sphere(0.05), ROCK, (0.0, 0.0, 1.0))
    world.time_step = 1e-3
    world.run(steps=100)
    assert world.velocity[0, 2] == pytest.approx(-0.2)
    with pytest.raises(ValueError, match=r"World\.gravity is 1\.0; allowed are three finite numbers"):
        world.gravity = 1.0


def test_body_added_later_meets_those_before():
    world = World((0, 0, -9.81), 1e-4)
    world.add_body(Sphere(0.05), ROCK, (0, 0, 0.05))
    world.add_plane((0, 0, 0), (0, 0, 1), ROCK)
    world.run(duration=0.2)
    assert world.contacts()["body_b"].tolist() == [-1]
    world.add_body(Sphere(0.05), ROCK, (0, 0, 0.16))
    world.run(duration=0.06)
    assert world.position[1, 2] < 0.16
    assert sorted(world.contacts()["body_b"].tolist()) == [-1, 1]


def test_plane_meets_only_the_bodies_named():
    world = World((0, 0, -9.81), 1e-4)
    for x in (0.0, 1.0):
        world.add_body(Sphere(0.05), ROCK, (x, 0, 0.06))
    world.add_plane((0, 0, 0), (0, 0, 1), ROCK, bodies=[0])
    world.run(duration=0.3)
    assert world.position[0, 2] > 0.04
    assert world.position[1, 2] < -0.3


def test_time_step_is_a_fiftieth_of_the_shortest_contact():
    world = World((0, 0, -9.81))
    world.add_body(Sphere(0.05), ROCK, (0, 0, 0.55))
    world.add_plane((0, 0, 0), (0, 0, 1), ROCK)
    assert world.time_step == pytest.approx(world.shortest_contact(math.sqrt(2 * 9.81 * 0.6)) / 50, rel=1e-12)
    world.run(duration=0.1)
    assert world.time == pytest.approx(0.1, rel=1e-12)


@pytest.mark.parametrize(("call", "word"), [
    (lambda w: w.add_body(Sphere(1.0), ROCK, (0, 0)), "position"),
    (lambda w: w.add_body(Sphere(1.0), ROCK, (0, 0, 0), orientation=(0, 0, 0, 0)), "orientation"),
    (lambda w: w.add_body(Sphere(1.0), ROCK, (0, 0, 0), mass=-1.0), "mass"),
    (lambda w: w.add_body(Sphere(1.0), ROCK, (0, 0, 0), inertia=-np.eye(3)), "inertia"),
    (lambda w: w.add_body(Sphere(1.0), ROCK, (0, 0, 0), inertia=np.eye(3) + np.eye(3, k=1)), "inertia"),
    (lambda w: w.add_body(Sphere(1.0), ROCK, (0, 0, 0), inertia=np.diag([0.001, 0.001, 0.01])), "sum of the other two"),
    (lambda w: w.add_plane((0, 0, 0), (0, 0, 0), ROCK), "normal"),
    (lambda w: w.run(duration=1.0), "no body"),
    (lambda w: w.run(), "either"),
    (lambda w: World(pair_rule="larger"), "pair_rule"),
    (lambda w: World(time_step=0.0), "time_step"),
])  # fmt: skip
def test_wrong_calls_are_refused_in_a_sentence(call, word):
    with pytest.raises(ValueError, match=word):
        call(World())


def test_crowded_pair_grows_its_list():
    """A face with many corners on a face: more features than a pair first has room for."""
    angle = np.linspace(0, 2 * np.pi, 30, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
    disc = ConvexHull(np.vstack([ring, ring + np.array([0, 0, 0.5])]))
    world = World(time_step=1e-9)
    world.add_body(disc, ROCK, (0, 0, 0))
    world.add_body(disc, ROCK, (0, 0, 0.5 - 1e-5), orientation=(math.cos(0.03), 0, 0, math.sin(0.03)))
    contacts = world.contacts()
    assert len(contacts) == 1
    assert abs(contacts["point"][0, :2]).max() < 1e-6
    assert contacts["normal"][0] == pytest.approx((0, 0, 1))


def test_loaded_world_takes_new_bodies_on_its_planes(tmp_path):
    world = World((0, 0, -9.81), 1e-4)
    world.add_body(Sphere(0.05), ROCK, (0, 0, 0.05))
    world.add_plane((0, 0, 0), (0, 0, 1), ROCK)
    world.save(tmp_path / "world.h5")
    loaded = World.load(tmp_path / "world.h5")
    loaded.add_body(Sphere(0.05), ROCK, (1, 0, 0.06))
    loaded.run(duration=0.3)
    assert loaded.position[1, 2] > 0.04


@pytest.mark.parametrize("held_speed", [0.0, 2e-3])
@pytest.mark.parametrize("widens", [False, True])
def test_a_heap_that_is_stopped_while_it_falls_goes_on_with_the_same_bits(tmp_path, held_speed, widens, monkeypatch):
    """At steps of their own: stopped in the middle of collisions, with some held, or without a free slot."""
    if widens:
        monkeypatch.setattr(local_engine, "SLOTS", 1)

    def heap():
        random, world = np.random.default_rng(3), World((0.0, 1e-3, -0.01), period=(1.2, 1.2))
        world.rotation = (0.0, 1e-3, 2e-3)
        world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROCK)
        for number in range(12):
            place = (0.3 * (number % 3), 0.3 * (number // 3 % 2), 0.1 + 0.25 * (number // 6))
            shape = Sphere(0.06) if number % 4 == 0 else Box((0.1, 0.12, 0.15))
            world.add_body(shape, ROCK, place, (0.0, 0.0, -0.05), tuple(random.normal(size=4)))
        world.watch(11)
        return world

    def go_on(world, duration):
        world.run_locally(duration, 25.0, held_speed=held_speed, reach=0.3 if held_speed else 0.0)
        return world

    whole, stopped = heap(), heap()
    for duration in (2.0, 1.0, 5.0):
        go_on(whole, duration)
        go_on(stopped, duration).save(tmp_path / "world.h5")
        stopped = World.load(tmp_path / "world.h5")
        go_on(stopped, 0.25)
        go_on(whole, 0.25)
    assert len(whole.contacts())
    for name in ("position", "velocity", "orientation", "angular_momentum"):
        assert getattr(whole, name).tobytes() == getattr(stopped, name).tobytes(), name
    assert whole.energy() == stopped.energy()
    assert whole.watched == stopped.watched
    assert whole.time == stopped.time


def test_saving_changes_nothing(tmp_path):
    ends = []
    for saves in (False, True):
        world = World((0.0, 0.0, -0.01))
        world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROCK)
        world.add_body(Box((0.1, 0.12, 0.15)), ROCK, (0.0, 0.0, 0.2), (0.01, 0.0, -0.05), spin=(0.1, 0.2, 0.0))
        for _ in range(10):
            world.run_locally(1.0, 25.0)
            if saves:
                world.save(tmp_path / "world.h5")
        ends.append(world.position.tobytes() + world.orientation.tobytes())
    assert ends[0] == ends[1]


def test_a_world_of_another_format_version_is_refused_in_a_sentence(tmp_path):
    world = World((0, 0, -9.81), 1e-4)
    world.add_body(Sphere(0.05), ROCK, (0, 0, 0.05))
    world.save(tmp_path / "world.h5")
    with h5py.File(tmp_path / "world.h5", "a") as file:
        file.attrs["format_version"] = 1
    with pytest.raises(ValueError, match=r"world\.h5 holds lithobrake world, version 1, .* make it again"):
        World.load(tmp_path / "world.h5")


def test_time_step_that_was_set_stays():
    world = World((0, 0, -9.81))
    world.add_body(Sphere(0.05), ROCK, (0, 0, 0.05))
    world.time_step = 1e-5
    world.add_plane((0, 0, 0), (0, 0, 1), ROCK)
    assert world.time_step == 1e-5


@pytest.mark.parametrize("steps", [-5, 2.5])
def test_steps_are_whole_and_not_negative(steps):
    world = World((0, 0, 0), 1e-5)
    world.add_body(Sphere(0.05), ROCK, (0, 0, 0.05))
    with pytest.raises(ValueError, match="steps"):
        world.run(steps=steps)


@pytest.mark.parametrize("shape", [Sphere(0.1), Box((0.1, 0.2, 0.1))])
@pytest.mark.parametrize("name", ["velocity", "angular_momentum"])
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_motion_that_is_lost_is_told(shape, name, value):
    world = World((0, 0, -1), 1e-3)
    world.add_body(shape, ROCK, (0, 0, 1))
    world.add_body(shape, ROCK, (0, 0, 2))
    world.run(steps=5)
    getattr(world._state.engine.bodies, name)[0] = value
    with pytest.raises(FloatingPointError, match="diverged"):
        world.run(steps=5)


@pytest.mark.parametrize("shape", [Sphere(0.1), Box((0.1, 0.2, 0.1))])
@pytest.mark.parametrize("run", [lambda world: world.run(1.0), lambda world: world.run_locally(1.0, 25)])
def test_no_contact_is_deeper_than_its_body(shape, run):
    soft = Material(density=2500.0, young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5)
    world = World((0, 0, -1))
    world.add_plane((0, 0, 0), (0, 0, 1), soft)
    world.add_body(shape, soft, (0, 0, 0.2), mass=1e6)
    with pytest.raises(FloatingPointError, match=r"body 0 lies 0\.\d+ m behind plane 0 .* take a stiffer material"):
        run(world)


def test_a_body_behind_a_plane_that_does_not_meet_it_is_free():
    world = World((0, 0, -1))
    world.add_plane((0, 0, 0), (0, 0, 1), ROCK, bodies=[])
    world.add_body(Sphere(0.1), ROCK, (0, 0, -1))
    world.run_locally(0.1, 25)
    assert world.position[0, 2] == pytest.approx(-1.005)


def test_many_bodies_at_once_are_those_added_one_by_one():
    generator = np.random.default_rng(4)
    shapes = [ConvexHull(0.1 * generator.normal(size=(14, 3))) for _ in range(5)] + [Sphere(0.1)]
    position, orientation = generator.normal(size=(6, 3)), generator.normal(size=(6, 4))
    one_by_one, at_once = World(), World()
    for shape, place, turn in zip(shapes, position, orientation, strict=True):
        one_by_one.add_body(shape, ROCK, place, orientation=turn)
    at_once.add_body(Sphere(1.0), ROCK, (9.0, 0.0, 0.0))
    assert at_once.add_bodies(shapes, ROCK, position, orientation) == range(1, 7)
    for name in ("position", "orientation", "mass", "inertia"):
        assert np.array_equal(getattr(at_once, name)[1:], getattr(one_by_one, name))
    lightest = [body.smallest_masses_at_contact for body in at_once.bodies[1:]]
    assert lightest == [body.smallest_masses_at_contact for body in one_by_one.bodies]


def test_many_bodies_ask_for_a_row_each():
    with pytest.raises(
        ValueError, match=r"add_bodies position has shape \(1, 3\); allowed are finite numbers in \(2, 3\)"
    ):
        World().add_bodies([Sphere(1.0)] * 2, ROCK, np.zeros((1, 3)), np.ones((2, 4)))
    with pytest.raises(
        ValueError, match=r"add_bodies orientation is \[0\.0, 0\.0, 0\.0, 0\.0\]; allowed is any finite"
    ):
        World().add_bodies([Sphere(1.0)], ROCK, np.zeros((1, 3)), np.zeros((1, 4)))


def test_a_given_inertia_decides_what_a_contact_meets():
    # A cube's corner along a face's normal: 1/m + 2 (a/2)^2/I, with I = m a^2/6 a quarter of m.
    cube, world = Box((1.0, 1.0, 1.0)), World()
    world.add_body(cube, ROCK, (0.0, 0.0, 0.0), mass=8.0)
    world.add_body(cube, ROCK, (3.0, 0.0, 0.0), mass=8.0, inertia=np.eye(3) * 8.0 / 3.0)
    assert world.bodies[0].smallest_masses_at_contact == pytest.approx((2.0,))
    assert world.bodies[1].smallest_masses_at_contact == pytest.approx((8.0 / 2.5,))


STUFF = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=0.6, friction=0.5, density=2500.0)
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
        world.add_body(shape, STUFF, place, velocity=-side * np.array([0.5, 0.3, 0.0]), spin=side * np.array([1, 2, 3]))
    return world


def test_a_large_ball_over_the_edge_meets_a_small_one_with_another_between() -> None:
    """Two small balls beside a large one that the fold takes to the other side; it touches the first alone.

    The second begins farther along x than the first ends, and before the image of the large one in a list by x.
    """
    world = World(time_step=1e-5, period=(0.06, 0.06))
    for radius, place in ((0.003, (0.0204, 0.0, 0.0)), (0.003, (0.0298, 0.02, 0.0)), (0.01, (0.0301, 0.0, 0.0))):
        world.add_body(Sphere(radius), ROCK, place)
    contacts = world.contacts()
    assert [tuple(sorted((int(a), int(b)))) for a, b in zip(contacts["body_a"], contacts["body_b"], strict=True)] == [
        (0, 2)
    ]


def gas(count: int = 30, friction: float = 0.5) -> World:
    """Hulls and spheres that fly through each other between a smooth floor and a smooth lid, with no one speed."""
    generator = np.random.default_rng(7)
    stuff = Material(**{**vars(STUFF), "friction": friction})
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
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), STUFF)
    for k in range(GRAINS):
        place = np.array([0.15 * (k % 4), 0.175 * (k // 4 % 4), 0.1 + 0.15 * (k // 16)])
        shape: Shape = Sphere(0.07) if spheres else hull(generator, 0.09)
        world.add_body(shape, STUFF, place + 0.01 * generator.normal(size=3))
    world.drag = 5.0
    world.run_locally(0.8, 10.0)
    return world


def pile(shift: tuple[float, float] = (0.0, 0.0), scatter: int | None = None, spheres: bool = False) -> World:
    """What has fallen, at rest, moved sideways, and each by so many whole periods as a seed says."""
    made, world = fallen(spheres), World((0.0, 0.0, -9.81), 1e-4, period=PERIOD)
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), STUFF)
    count = (GRAINS, 2)
    tiles = np.zeros(count) if scatter is None else np.random.default_rng(scatter).integers(-3, 4, size=count)
    way = np.column_stack([np.array(shift) + tiles * PERIOD, np.zeros(GRAINS)])
    world.add_bodies([body.shape for body in made.bodies], STUFF, made.position + way, made.orientation)
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
        advance(world, 0.05, stepping)
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
        advance(world, 0.2 if spheres else 0.1, stepping)
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
        world.add_body(Sphere(0.05), STUFF, place)
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
            world.add_body(Sphere(0.03), STUFF, (0.1, 0.12, 0.1) * place, generator.normal(scale=0.3, size=3))
        world.run_locally(0.3, 15.0)
        return world.position, world.velocity, len(world._state.local.cells.first)

    many = motion()
    monkeypatch.setattr(cells, "MOST_CELLS", 1.0 / 125.0)
    one = motion()
    assert many[2] > 100
    assert one[2] == 1
    assert (many[0][:, :2] < -0.05).any(axis=0).all()
    # Pairs listed in another order are looked at in another order where they are due at once.
    assert (many[0], many[1]) == (pytest.approx(one[0], abs=1e-9), pytest.approx(one[1], abs=1e-8))


@pytest.mark.parametrize("period", [(1.0,), (1.0, 0.0), (1.0, math.inf), (math.nan, 1.0), (-1.0, 1.0)])
def test_a_period_is_two_positive_lengths(period: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match=r"World\.period is .* allowed are two finite lengths above 0"):
        World(period=period)


@pytest.mark.parametrize("stepping", STEPPINGS)
def test_a_period_in_which_two_could_meet_twice_is_refused(stepping: str) -> None:
    # 2 (0.1 + 0.05 + 2 skins of a quarter of the smallest radius, 0.02)
    least = 2.0 * (0.15 + 2.0 * 0.005)
    for period, fine in (((0.999 * least, 1.0), False), ((1.0, 0.999 * least), False), ((1.001 * least, 1.0), True)):
        world = World(time_step=1e-4, period=period)
        for k, radius in enumerate((0.05, 0.1, 0.02)):
            world.add_body(Sphere(radius), STUFF, (0.0, 0.0, 0.4 * k))
        if fine:
            advance(world, 1e-3, stepping)
        else:
            with pytest.raises(ValueError, match=r"World\.period is .* at least 0\.32 m"):
                advance(world, 1e-3, stepping)


def test_a_plane_that_does_not_repeat_is_refused() -> None:
    with pytest.raises(ValueError, match=r"add_plane normal is .* allowed is one along z"):
        World(period=PERIOD).add_plane((0.0, 0.0, 0.0), (0.1, 0.0, 1.0), STUFF)
