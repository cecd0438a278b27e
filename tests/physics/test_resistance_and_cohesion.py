"""Rolling and spinning resistance, and cohesion: the optional parts of the law, each against a closed form.

Rolling: Ai, Chen, Rotter and Ooi (2011), model C. Cohesion: constant, and Derjaguin, Muller and Toporov (1975).
"""

import math

import numpy as np
import pytest

from lithobrake.dem import Box, Material, Sphere, World

RADIUS, DENSITY, YOUNG, GRAVITY = 0.05, 2000.0, 1e8, 9.81
MASS = DENSITY * Sphere(RADIUS).volume


def material(**changes):
    values = {"young_modulus": YOUNG, "poisson_ratio": 0.25, "restitution": 0.5, "friction": 0.5, "density": DENSITY}
    return Material(**{**values, **changes})


def rest_overlap(force):
    """Overlap at which a sphere on a rigid plane carries a force (Hertz)."""
    return (0.75 * force * (1 - 0.25**2) / (YOUNG * math.sqrt(RADIUS))) ** (2 / 3)


def on_plane(stuff, gravity=(0.0, 0.0, -GRAVITY), load=MASS * GRAVITY, **motion):
    """A sphere at its rest overlap under a load, on a plane of the same surface that does not give."""
    world = World(gravity, 1e-5)
    world.add_body(Sphere(RADIUS), stuff, (0, 0, RADIUS - rest_overlap(load)), **motion)
    rigid = {**stuff.__dict__, "young_modulus": 1e9 * YOUNG, "poisson_ratio": 0.0}
    world.add_plane((0, 0, 0), (0, 0, 1), Material(**rigid))
    return world


def test_rolling_sphere_is_slowed_by_its_rolling_friction():
    """Derived: deceleration 5/7 of rolling friction times g, from the torque balance about the contact."""
    world = on_plane(material(rolling_friction=0.1), velocity=(0.5, 0, 0), spin=(0, 0.5 / RADIUS, 0))  # fmt: skip
    world.run(duration=0.1)
    before = world.velocity[0, 0]
    world.run(duration=0.3)
    assert (before - world.velocity[0, 0]) / 0.3 == pytest.approx(5 / 7 * 0.1 * GRAVITY, rel=0.005)
    world.run(duration=4.0)
    assert abs(world.velocity[0, 0]) < 1e-9
    assert world.energy()["rolling"] == pytest.approx(0.7 * MASS * 0.5**2, rel=0.01)


@pytest.mark.parametrize(("rolling_friction", "rests"), [(0.21, True), (0.19, False)])
def test_sphere_rests_on_a_slope_flatter_than_its_rolling_friction(rolling_friction, rests):
    """Derived: the couple of gravity about the contact is R m g sin(angle), the limit that of rolling friction."""
    slope = math.atan(0.2)
    gravity = (GRAVITY * math.sin(slope), 0, -GRAVITY * math.cos(slope))
    world = on_plane(material(rolling_friction=rolling_friction), gravity, MASS * GRAVITY * math.cos(slope))
    world.run(duration=0.5)
    if rests:
        before = world.position[0, 0]
        world.run(duration=2.0)
        assert abs(world.position[0, 0] - before) < 1e-6
    else:
        before = world.velocity[0, 0]
        world.run(duration=1.0)
        expected = 5 / 7 * GRAVITY * (math.sin(slope) - 0.19 * math.cos(slope))
        assert world.velocity[0, 0] - before == pytest.approx(expected, rel=0.01)


def test_spinning_sphere_is_slowed_by_its_spinning_friction():
    """Derived: spin about the normal falls by 5/2 of spinning friction times g over R."""
    world = on_plane(material(spinning_friction=0.02), spin=(0, 0, 10.0))
    world.run(duration=0.1)
    before = world.spin[0, 2]
    world.run(duration=0.5)
    assert (before - world.spin[0, 2]) / 0.5 == pytest.approx(2.5 * 0.02 * GRAVITY / RADIUS, rel=0.005)
    world.run(duration=6.0)
    assert abs(world.spin[0, 2]) < 1e-9
    free = on_plane(material(), spin=(0, 0, 10.0))
    free.run(duration=0.5)
    assert free.spin[0, 2] == pytest.approx(10.0, rel=1e-9)


PULLS = [
    pytest.param({"cohesion_force": 1.0}, 1.0, id="constant"),
    pytest.param({"surface_energy": 1.0 / (4 * math.pi * RADIUS)}, 1.0, id="DMT"),
]


@pytest.mark.parametrize(("cohesion", "pull"), PULLS)
def test_cohesion_carries_a_sphere_as_heavy_as_its_pull(cohesion, pull):
    """Derived: hung from a ceiling a sphere stays while its weight is below the pull, 4 pi gamma R for DMT."""
    for weight, stays in ((0.98 * pull, True), (1.02 * pull, False)):
        world = on_plane(material(**cohesion), (0, 0, weight / MASS), load=pull - weight if stays else 0.0)
        world.run(duration=1.0)
        assert (len(world.contacts()) == 1) is stays
        assert bool(abs(world.velocity[0, 2]) < 1e-6) is stays


@pytest.mark.parametrize(("cohesion", "pull"), PULLS)
def test_cohesion_presses_a_sphere_down(cohesion, pull):
    """Derived: Hertz carries weight and pull; the contact force is the weight; friction counts the pull."""
    world = on_plane(material(**cohesion), load=MASS * GRAVITY + pull, velocity=(1.0, 0, 0))
    world.run(duration=0.01)
    contact = world.contacts()[0]
    assert contact["overlap"] == pytest.approx(rest_overlap(MASS * GRAVITY + pull), rel=1e-3)
    assert contact["normal_force"] == pytest.approx(MASS * GRAVITY, rel=1e-3)
    assert 1.0 - world.velocity[0, 0] == pytest.approx(0.01 * 0.5 * (GRAVITY + pull / MASS), rel=2e-3)


def test_cohesion_takes_no_energy():
    """An elastic impact gives back its speed: the pull is the gradient of an energy, which ends with the overlap."""
    world = World((0, 0, 0), 1e-6)
    stuff = material(restitution=1.0, friction=0.0, cohesion_force=5.0)
    world.add_body(Sphere(RADIUS), stuff, (0, 0, 0), velocity=(0.05, 0, 0))
    world.add_body(Sphere(RADIUS), stuff, (0.1001, 0, 0))
    world.run(duration=0.05)
    assert world.velocity[1, 0] == pytest.approx(0.05, rel=1e-3)


def test_a_box_is_held_to_a_ceiling_by_its_face():
    """A face pulls at least as strongly as one point, and at most 8 to the power 1/8 times so (patch.spread)."""
    pulls = []
    for factor in (0.99, 1.32):
        stuff = material(cohesion_force=1.0)
        box = Box((0.1, 0.1, 0.1))
        world = World((0, 0, factor / (DENSITY * box.volume)), 2e-5)
        world.add_body(box, stuff, (0, 0, 0.05 - 1e-7))
        world.add_plane((0, 0, 0), (0, 0, 1), stuff)
        world.run(duration=0.5)
        pulls.append(len(world.contacts()) == 1)
    assert pulls == [True, False]


def test_ledger_closes_and_similarity_holds_with_all_of_it():
    """Scaled by powers of two, every number scales exactly, rolling and cohesion included; energy is kept."""

    def pile(length=1.0, time=1.0, stress=1.0):
        stuff = Material(young_modulus=1e7 * stress, poisson_ratio=0.25, restitution=0.6, friction=0.5,
            rolling_friction=0.2, spinning_friction=0.1, density=2500.0 * stress * time**2 / length**2,
            cohesion_force=0.5 * stress * length**2, surface_energy=2.0 * stress * length)  # fmt: skip
        world = World((0.0, 0.0, -9.81 * length / time**2), 5e-5 * time)
        generator = np.random.default_rng(1)
        for k in range(9):
            place = np.array([k % 3 * 0.1, k // 3 % 3 * 0.1, 0.1 + 0.03 * k]) + 0.004 * generator.normal(size=3)
            shape = Sphere(0.05 * length) if k % 2 else Box((0.08 * length,) * 3)
            world.add_body(shape, stuff, place * length, velocity=generator.normal(size=3) * 0.3 * length / time)
        world.add_plane((0, 0, 0), (0, 0, 1), stuff)
        return world

    plain, scaled = pile(), pile(4.0, 0.5, 8.0)
    start = plain.energy()
    for world in (plain, scaled):
        world.run(steps=12000)
    assert np.array_equal(plain.position * 4.0, scaled.position)
    assert np.array_equal(plain.orientation, scaled.orientation)
    end = plain.energy()
    assert end["rolling"] > 0.0
    assert end["cohesive"] < 0.0
    assert abs(end["total"] - start["total"]) < 1e-3 * (start["kinetic"] + abs(start["potential"]))


@pytest.mark.parametrize("name", ["rolling_friction", "spinning_friction", "cohesion_force", "surface_energy"])
def test_negative_values_are_refused(name):
    with pytest.raises(ValueError, match=name):
        material(**{name: -1.0})
