"""What the contact law must do beyond published cases: never make energy, bounce as entered wherever it is hit."""

import json
import math
import operator
import re

import h5py
import numpy as np
import pytest

from lithobrake.dem import Box, Material, Sphere, World, rotation_matrices
from lithobrake.dem.law.tangential_spring import spring_force
from lithobrake.dem.stepping.time_step_stability import contact_duration


def material(restitution=1.0, friction=0.0, poisson_ratio=0.25, young_modulus=1e7):
    return Material(young_modulus=young_modulus, poisson_ratio=poisson_ratio, restitution=restitution,
        friction=friction, density=2500.0)  # fmt: skip


def kinetic(world):
    return world.energy()["kinetic"]


def test_elastic_head_on_impact_keeps_kinetic_energy():
    """Derived: nothing is lost at e = 1; at a fiftieth of the contact duration."""
    stuff, mass = material(), 2500.0 * Sphere(0.05).volume
    modulus = 1e7 / (1 - 0.25**2) / 2
    world = World(time_step=contact_duration(0.5 * mass, 0.025, modulus, 0.2) / 50)
    for side in (-1.0, 1.0):
        world.add_body(Sphere(0.05), stuff, (side * 0.0501, 0, 0), velocity=(-side * 0.1, 0, 0))
    before = kinetic(world)
    world.run(steps=200)
    assert len(world.contacts()) == 0
    assert world.velocity[1, 0] > 0.0
    assert kinetic(world) == pytest.approx(before, rel=1e-4)


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.1, 0.24, 0.3, 0.49])
def test_oblique_impacts_never_make_energy(poisson_ratio):
    """Loading and unloading in every proportion of slip and spin: the rescaled spring only loses (e = 1)."""
    generator = np.random.default_rng(3)
    stuff = material(1.0, 0.8, poisson_ratio)
    for _ in range(20):
        world = World(time_step=2e-5)
        spin, slide = generator.normal(size=3) * 10.0, generator.normal(size=2) * 0.4
        world.add_body(Sphere(0.05), stuff, (0, 0, 0.0501), velocity=(*slide, -0.2), spin=spin)
        world.add_plane((0, 0, 0), (0, 0, 1), stuff)
        before = kinetic(world)
        world.run(duration=0.02)
        assert len(world.contacts()) == 0
        assert kinetic(world) <= before * (1.0 + 1e-4)
        assert world.energy()["friction"] >= -1e-6 * before


def corner_drop(damping_mass):
    """Restitution at the corner of a box that falls on it, far from below its centre, without friction.

    The box is stiff, so that it hardly turns while it touches (at 1e7 Pa it turns by 2 degrees, and 0.488 comes out).
    """
    stuff = material(0.5, young_modulus=1e9)
    box = Box((0.2, 0.1, 0.1))
    tilt = np.array([math.cos(0.25), 0.6 * math.sin(0.25), 0.8 * math.sin(0.25), 0.0])
    world = World(time_step=2e-6, damping_mass=damping_mass)
    world.add_body(box, stuff, (0, 0, 1.0), velocity=(0, 0, -0.2), orientation=tilt)
    world.add_plane((0, 0, 0.9), (0, 0, 1), stuff)
    # Until its lowest corner is ten micrometres above the plane nothing is looked at.
    lowest = 1.0 + (box.vertices @ rotation_matrices(tilt[None])[0].T)[:, 2].min()
    world.run(steps=int((lowest - 1e-5 - 0.9) / 0.2 / 2e-6))
    assert not len(world.contacts())
    while not len(world.contacts()):
        world.run(steps=1)
    point = world.contacts()["point"][0] - world.position[0]
    while len(world.contacts()):
        world.run(steps=1)
    return (world.velocity[0] + np.cross(world.spin[0], point))[2] / 0.2


def test_restitution_off_centre_is_that_of_the_contact_point():
    """The mass in the damping is the one that the force meets at the contact point, 1/(n . W . n)."""
    assert corner_drop("contact") == pytest.approx(0.5, abs=0.005)
    assert corner_drop("paper") < 0.45


@pytest.mark.parametrize("ratio", [10.0, 100.0])
@pytest.mark.parametrize("refinement", [1.0, 4.0])
def test_a_heavy_plate_rolls_on_small_balls(ratio, refinement):
    """Derived: balls between a moving plate and the ground roll at half its speed and take nothing from it."""
    radius, speed = 0.05 / ratio * 2.0, 0.02
    stuff = material(0.5, 0.5, young_modulus=1e8)
    plate = Box((1.0, 1.0, 0.1))
    world = World((0, 0, -1e-3), 0.4e-3 / ratio / refinement)
    for x, y in ((-0.3, -0.3), (0.3, -0.3), (0.0, 0.3)):
        world.add_body(Sphere(radius), stuff, (x, y, radius), velocity=(0.5 * speed, 0, 0),
            spin=(0, 0.5 * speed / radius, 0))  # fmt: skip
    world.add_body(plate, stuff, (0, 0, 2.0 * radius + 0.05), velocity=(speed, 0, 0), mass=250.0)
    world.add_plane((0, 0, 0), (0, 0, 1), stuff)
    world.run(duration=0.5)
    # The balls yield to their load first, and roll on radii that much shorter.
    assert world.velocity[3, 0] == pytest.approx(speed, rel=2e-3)
    assert np.abs(world.velocity[:3, 0] - 0.5 * speed).max() < 0.02 * 0.5 * speed


def dot(one, other):
    return sum(map(operator.mul, one, other))


FRICTION, GRAVITY = 0.5, 1e-3


def plate_on_cubes(ratio, time_step):
    """A heavy plate at rest on three cubes that are `ratio` times thinner, near where its load lets it sink to."""
    edge, sunk = 0.1 / ratio, 4.5e-6 * ratio ** (1.0 / 3.0)
    stuff = material(0.5, FRICTION, young_modulus=1e8)
    plate = Box((1.0, 1.0, 0.1))
    world = World((0, 0, -GRAVITY), time_step)
    for x, y in ((-0.3, -0.3), (0.3, -0.3), (0.0, 0.3)):
        world.add_body(Box((edge, edge, edge)), stuff, (x, y, 0.5 * edge - 0.4 * sunk))
    world.add_body(plate, stuff, (0, 0, edge + 0.05 - sunk), mass=250.0)
    world.add_plane((0, 0, 0), (0, 0, 1), stuff)
    world.drag = 20.0
    world.run(duration=0.8)
    return world


def tilt(world, start, end, count):
    """Turn gravity to a slope whose tangent is the friction times `end`, from one of `start`, in steps of 10 ms."""
    for slope in np.linspace(math.atan(start * FRICTION), math.atan(end * FRICTION), count):
        world.gravity = (GRAVITY * math.sin(slope), 0, -GRAVITY * math.cos(slope))
        world.run(duration=0.01)


def slid(world):
    """Distance that the plate slides in a second, and in the second after."""
    places = [world.position[3, 0]]
    for _ in range(2):
        world.run(duration=1.0)
        places.append(world.position[3, 0])
    return np.diff(places)


@pytest.mark.parametrize(("ratio", "time_steps"), [(10.0, (5e-5, 4e-5)), (100.0, (2.75e-6,))])
def test_a_heavy_plate_sticks_to_small_cubes(ratio, time_steps):
    """Below the friction angle it gives a little and stays, above it slides as a rigid block does."""
    angle = math.atan(1.1 * FRICTION)
    acceleration = GRAVITY * (math.sin(angle) - FRICTION * math.cos(angle))
    for time_step in time_steps:
        world = plate_on_cubes(ratio, time_step)
        world.drag = 0.0
        tilt(world, 0.0, 0.9, 100)
        given, after = slid(world)
        tilt(world, 0.9, 1.1, 10)
        first, later = slid(world)
        assert later - first == pytest.approx(acceleration, rel=0.01)
        assert 0.0 < given < 0.1 * acceleration
        assert abs(after) < 0.01 * acceleration


def test_a_step_too_large_is_refused_with_one_that_serves():
    """The message names the largest safe step; with it the same impact runs."""

    def impact(step):
        world = World(time_step=step)
        stuff = material(0.5, 0.5)
        world.add_body(Sphere(0.05), stuff, (0, 0, 0.0501), velocity=(0, 0, -1.0))
        world.add_plane((0, 0, 0), (0, 0, 1), stuff)
        world.run(duration=0.05)
        return world

    with pytest.raises(ValueError, match="at most") as refused:
        impact(2e-3)
    largest = float(re.search(r"at most ([0-9.e+-]+) s", str(refused.value))[1])
    assert 0.0 < largest < 2e-3
    assert impact(0.5 * largest).velocity[0, 2] > 0.0


def test_box_of_boxes_comes_to_rest():
    """Eight cubes side by side and on each other in a pit of frictional walls stand still."""
    stuff = material(0.5, 0.5)
    world = World((0, 0, -9.81), 5e-5)
    for k in range(8):
        world.add_body(Box((0.1, 0.1, 0.1)), stuff,
            (0.1002 * (k % 2), 0.1002 * (k // 2 % 2), 0.05 + 0.1 * (k // 4)))  # fmt: skip
    world.add_plane((0, 0, 0), (0, 0, 1), stuff)
    for axis in (0, 1):
        for sign, place in ((1.0, -0.0502), (-1.0, 0.1504)):
            normal, point = np.zeros(3), np.zeros(3)
            normal[axis], point[axis] = sign, place
            world.add_plane(point, normal, stuff)
    world.run(duration=1.0)
    assert kinetic(world) < 1e-9 * world.mass.sum() * 9.81 * 0.1
    assert np.abs(world.position[:, 2] - (0.05 + 0.1 * (np.arange(8) // 4))).max() < 2e-3


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.1, 0.25, 0.4, 0.49])
def test_tangential_spring_gives_back_no_more_than_it_got_on_random_paths(poisson_ratio):
    """VALIDATION: no energy from load and slip that wander at random, the overlap up to 100 times as deep at times.

    Work and stored energy are summed here, not taken from the ledger. Without rescaling on unloading they fail.
    """
    generator = np.random.default_rng(7)
    shear_over_normal = 8.0 / (4.0 * (2.0 - poisson_ratio) * (1.0 + poisson_ratio))
    normal_over = 4.0 / 3.0 / (2.0 * (1.0 - poisson_ratio**2))
    for friction in (0.1, 0.5, 5.0):
        overlap, spring, stiffness, given, most = 1.0, (0.0, 0.0, 0.0), 0.0, 0.0, 0.0
        for deeper, along, across in generator.normal(size=(4000, 3)).tolist():
            overlap = min(max(overlap * math.exp(0.3 * deeper), 0.1), 10.0)
            way = (0.2 * overlap * along, 0.2 * overlap * across, 0.0)
            before, softer = spring, stiffness
            stiffness = shear_over_normal * overlap**0.5
            limit = friction * normal_over * overlap**1.5
            spring = spring_force(before, softer, stiffness, way, (0.0, 0.0, 0.0), 0.0, limit).total
            given -= 0.5 * dot(before, way) + 0.5 * dot(spring, way)
            most = max(most, given)
            assert given - 0.5 * dot(spring, spring) / stiffness > -1e-12 * most
            assert math.hypot(*spring) <= limit * (1.0 + 1e-12)


def swinging(dashpot: str) -> World:
    """A ball at rest on a plane, held by friction, that is pushed to the side: its spring swings some twenty times."""
    stuff, radius, gravity = material(0.5, 50.0), 0.05, 10.0
    mass, modulus = 2500.0 * Sphere(radius).volume, 1e7 / (1.0 - 0.25**2) / 2.0
    sunk = (mass * gravity / (4.0 / 3.0 * modulus * math.sqrt(radius))) ** (2.0 / 3.0)
    world = World((0, 0, -gravity), 1e-6, tangential_dashpot=dashpot)
    world.add_body(Sphere(radius), stuff, (0, 0, radius - sunk), velocity=(1e-4, 0, 0))
    world.add_plane((0, 0, 0), (0, 0, 1), stuff)
    world.run(duration=0.05)
    return world


def test_without_a_tangential_dashpot_a_spring_across_the_normal_swings_on() -> None:
    """Energy of the push, kinetic and elastic: all of it is left without the dashpot, a part with it."""
    pushed = 0.5 * 2500.0 * Sphere(0.05).volume * 1e-8
    kept, lost = swinging("none"), swinging("mindlin")
    assert kept.energy()["damping"] == pytest.approx(0.0, abs=1e-4 * pushed)
    # The ball goes on rolling, which holds 5/7 of it; the rest swings.
    assert lost.energy()["damping"] == pytest.approx(2.0 / 7.0 * pushed, rel=0.05)
    assert lost.spin[0, 1] == pytest.approx(5.0 / 7.0 * 1e-4 / 0.05, rel=0.02)


def test_a_world_keeps_its_tangential_dashpot_in_a_file(tmp_path) -> None:
    world = swinging("none")
    world.save(tmp_path / "world.h5")
    again = World.load(tmp_path / "world.h5")
    for one in (world, again):
        one.run(duration=0.01)
    np.testing.assert_array_equal(again.velocity, world.velocity)
    assert again.energy()["damping"] == pytest.approx(0.0, abs=1e-12)
    # Files of before have no such option, and the dashpot.
    with h5py.File(tmp_path / "world.h5", "r+") as file:
        options = json.loads(file.attrs["options"])
        assert options.pop("tangential_dashpot") == "none"
        file.attrs["options"] = json.dumps(options)
    older = World.load(tmp_path / "world.h5")
    older.run(duration=0.01)
    assert older.energy()["damping"] > 0.0
    with pytest.raises(ValueError, match=r"World\.tangential_dashpot is 'half'; allowed are mindlin, none: choose one"):
        World(tangential_dashpot="half")
