"""What a world takes, refuses and gives back."""

import math
from dataclasses import replace

import h5py
import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Material, Sphere, World
from lithobrake.dem.law.material_pair import PAIR_RULES, pair_law

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
    with pytest.raises(ValueError, match=r"World gravity is 1\.0; allowed are three finite numbers"):
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


def test_too_large_a_step_names_the_largest_safe_one():
    world = World((0, 0, 0), 5e-3)
    world.add_body(Sphere(0.05), ROCK, (0, 0, 0.049))
    world.add_plane((0, 0, 0), (0, 0, 1), ROCK)
    with pytest.raises(ValueError, match="at most") as refusal:
        world.run(steps=10)
    safe = World((0, 0, 0), 0.5 * float(str(refusal.value).split("at most ")[1].split(" s")[0]))
    safe.add_body(Sphere(0.05), ROCK, (0, 0, 0.049))
    safe.add_plane((0, 0, 0), (0, 0, 1), ROCK)
    safe.run(steps=10)


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
    with pytest.raises(ValueError, match=r"add_bodies orientation is \[0.0, 0\.0, 0\.0, 0\.0\]; allowed is any finite"):
        World().add_bodies([Sphere(1.0)], ROCK, np.zeros((1, 3)), np.zeros((1, 4)))


def test_a_given_inertia_decides_what_a_contact_meets():
    # A cube's corner along a face's normal: 1/m + 2 (a/2)^2/I, with I = m a^2/6 a quarter of m.
    cube, world = Box((1.0, 1.0, 1.0)), World()
    world.add_body(cube, ROCK, (0.0, 0.0, 0.0), mass=8.0)
    world.add_body(cube, ROCK, (3.0, 0.0, 0.0), mass=8.0, inertia=np.eye(3) * 8.0 / 3.0)
    assert world.bodies[0].smallest_masses_at_contact == pytest.approx((2.0,))
    assert world.bodies[1].smallest_masses_at_contact == pytest.approx((8.0 / 2.5,))
