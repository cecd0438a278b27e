"""The rule for the smallest bed."""

import math

import pytest

from lithobrake.dem import Material, Sphere, World
from lithobrake.touchdown import Lander, smallest_bed, wave_speed


def rock(young_modulus=1e7):
    return Material(young_modulus=young_modulus, poisson_ratio=0.25, restitution=1.0, friction=0.0, density=2500.0)


def test_wave_runs_through_a_chain_at_its_speed():
    """Nesterenko (1983): the wave in a chain of touching spheres, struck by one of them."""
    diameter, speed, count = 0.1, 0.1, 60
    world = World((0.0, 0.0, 0.0))
    for k in range(count):
        world.add_body(Sphere(0.05), rock(), (diameter * k, 0, 0), velocity=(speed if k == 0 else 0.0, 0, 0))
    times = []
    for probe in (20, 50):
        while world.velocity[probe, 0] < 0.25 * speed:
            world.run(steps=1)
        times.append(world.time)
    measured = 30 * diameter / (times[1] - times[0])
    # What runs on is a solitary wave about five grains long whose peak is 0.68 of the striker's speed.
    assert wave_speed(rock(), diameter, 0.68 * speed) == pytest.approx(measured, rel=0.05)


def test_rule_does_not_depend_on_speed_or_stiffness():
    """Wave speed goes with v^(1/5) E^(2/5), contact time with their inverse."""
    lander = Lander(shape=Sphere(0.1), mass=2.0, inertia=None, material=rock())
    width, depth = smallest_bed(lander, rock(), 0.05, 0.1)
    assert smallest_bed(lander, rock(1e6), 0.05, 0.4) == pytest.approx((width, depth), rel=1e-9)
    assert width == pytest.approx(0.2 + 2.0 * depth, rel=1e-12)
    assert 0.05 < depth < 0.2


def test_rule_grows_with_the_mass_of_the_lander():
    depths = [
        smallest_bed(Lander(shape=Sphere(0.1), mass=mass, inertia=None, material=rock()), rock(), 0.05, 0.1)[1]
        for mass in (0.1, 1.0, 10.0)
    ]
    assert depths == sorted(depths)
    assert math.isfinite(depths[-1])
