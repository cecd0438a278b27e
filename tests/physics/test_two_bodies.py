"""Two-body contacts with published or derived outcomes. T1 to T7: Chung and Ooi (2011), Granular Matter 13, 643."""

import math

import numpy as np
import pytest

from lithobrake.dem import Material, Sphere, World
from lithobrake.dem.law.restitution import damping_ratio_of, restitution_of
from lithobrake.dem.stepping.time_step_stability import contact_duration


def material(young_modulus, poisson_ratio, density, restitution=1.0, friction=0.0):
    return Material(young_modulus=young_modulus, poisson_ratio=poisson_ratio, restitution=restitution,
        friction=friction, density=density)  # fmt: skip


def rigid(like):
    """A plane that does not give."""
    return material(1e9 * like.young_modulus, 0.0, 1.0, like.restitution, like.friction)


def fiftieth(stuff, radius, speed):
    """A fiftieth of the duration of an elastic contact of a ball with a plane that does not give [s]."""
    mass = stuff.density * Sphere(radius).volume
    return contact_duration(mass, radius, stuff.young_modulus / (1 - stuff.poisson_ratio**2), speed) / 50


def collide(world, step_limit=100_000):
    """Step through one contact; return peak normal force, peak overlap and duration."""
    force, overlaps = 0.0, [0.0]
    for _ in range(step_limit):
        world.run(steps=1)
        contacts = world.contacts()
        if len(contacts):
            force = max(force, contacts["normal_force"][0])
            overlaps.append(contacts["overlap"][0])
        elif len(overlaps) > 1:
            # The contact ended within the step, at the rate at which the overlap fell before.
            within = overlaps[-1] / (overlaps[-2] - overlaps[-1])
            return force, max(overlaps), (len(overlaps) - 1 + within) * world.time_step
    raise AssertionError("the contact did not end")


@pytest.mark.parametrize(
    ("young", "nu", "rho", "force", "overlap", "duration"),
    [(48e9, 0.20, 2800.0, 10.6969e3, 274.113e-6, 40.3395e-6), (20e9, 0.25, 2500.0, 7.1082e3, 368.304e-6, 54.2010e-6)],
    ids=["glass", "limestone"],
)
def test_t1_two_equal_spheres_elastic(young, nu, rho, force, overlap, duration):
    """Chung and Ooi (2011), test 1: two equal spheres, R = 10 mm, 10 m/s each, e = 1, mu = 0.35; step t_c/100."""
    stuff = material(young, nu, rho, 1.0, 0.35)
    world = World(time_step=duration / 100)
    for sign in (-1.0, 1.0):
        world.add_body(Sphere(0.01), stuff, (sign * 0.01, 0, 0), velocity=(-sign * 10.0, 0, 0))
    peak, deepest, lasted = collide(world)
    assert peak == pytest.approx(force, rel=1e-3)
    assert deepest == pytest.approx(overlap, rel=1e-3)
    assert lasted == pytest.approx(duration, rel=1e-3)
    assert np.abs(world.velocity[:, 0]).min() == pytest.approx(10.0, rel=1e-3)
    assert np.abs(world.velocity[:, 0]).max() == pytest.approx(10.0, rel=1e-3)


@pytest.mark.parametrize(
    ("young", "nu", "rho", "force", "overlap", "duration"),
    [(70e9, 0.30, 2699.0, 11.3699e3, 49.717e-6, 731.657e-6), (40e9, 0.35, 1800.0, 7.2327e3, 52.123e-6, 767.066e-6)],
    ids=["aluminium", "magnesium"],
)
def test_t2_sphere_on_rigid_plane_elastic(young, nu, rho, force, overlap, duration):
    """Chung and Ooi (2011), test 2: sphere of R = 0.1 m on a rigid plane, 0.2 m/s, e = 1, mu = 0; step t_c/100."""
    stuff = material(young, nu, rho)
    world = World(time_step=duration / 100)
    world.add_body(Sphere(0.1), stuff, (0, 0, 0.1), velocity=(0, 0, -0.2))
    world.add_plane((0, 0, 0), (0, 0, 1), rigid(stuff))
    peak, deepest, lasted = collide(world)
    assert peak == pytest.approx(force, rel=1e-3)
    assert deepest == pytest.approx(overlap, rel=1e-3)
    assert lasted == pytest.approx(duration, rel=1e-3)


@pytest.mark.parametrize("speed", [1e-6, 3.9])
@pytest.mark.parametrize("restitution", [0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0])
def test_t3_restitution_comes_out_as_entered(restitution, speed):
    """Chung and Ooi (2011), test 3: aluminium oxide sphere of R = 2.5 mm on a rigid plane; step t_c/50."""
    stuff = material(380e9, 0.23, 4000.0, restitution)
    world = World(time_step=fiftieth(stuff, 0.0025, speed))
    world.add_body(Sphere(0.0025), stuff, (0, 0, 0.0025), velocity=(0, 0, -speed))
    world.add_plane((0, 0, 0), (0, 0, 1), rigid(stuff))
    collide(world)
    assert world.velocity[0, 2] / speed == pytest.approx(restitution, abs=0.005)


@pytest.mark.parametrize(
    ("restitution", "ratio"),
    [(0.1, 1.2432), (0.2, 0.7313), (0.3, 0.4972), (0.5, 0.2553), (0.7, 0.1222), (0.9, 0.0343), (0.95, 0.0165)],
)
def test_damping_ratio_without_attraction(restitution, ratio):
    """Derived: an independent integration of the damped Hertz contact with the no-tension cut-off."""
    assert damping_ratio_of(restitution) == pytest.approx(ratio, abs=6e-5)


@pytest.mark.parametrize(
    ("angle_deg", "tangential", "spin"),
    [(35, 0.7398, 581.95), (50, 0.8471, 456.65), (70, 0.9337, 242.98), (85, 0.9841, 61.92)],
)
def test_t4_oblique_impact_gross_sliding(angle_deg, tangential, spin):
    """Chung and Ooi (2011), test 4: the sphere of test 3 at angles from the normal, mu = 0.092, e = 0.98; t_c/50."""
    stuff = material(380e9, 0.23, 4000.0, 0.98, 0.092)
    angle = math.radians(angle_deg)
    world = World(time_step=fiftieth(stuff, 0.0025, 3.9 * math.cos(angle)))
    velocity = (3.9 * math.sin(angle), 0, -3.9 * math.cos(angle))
    world.add_body(Sphere(0.0025), stuff, (0, 0, 0.0025), velocity=velocity)
    world.add_plane((0, 0, 0), (0, 0, 1), rigid(stuff))
    collide(world)
    assert world.velocity[0, 0] / velocity[0] == pytest.approx(tangential, abs=0.003)
    assert abs(world.spin[0, 1]) == pytest.approx(spin, rel=0.005)


@pytest.mark.parametrize("x", [8.0, 12.0])
def test_t5_gross_sliding_at_a_fixed_normal_speed(x):
    """Chung and Ooi (2011), test 5: steel sphere of R = 10 um, x = v_t/(mu v_n), mu = 0.3, e = 1; step t_c/50."""
    stuff = material(208e9, 0.30, 7850.0, 1.0, 0.3)
    radius, normal = 1e-5, 5.0
    world = World(time_step=fiftieth(stuff, radius, normal))
    world.add_body(Sphere(radius), stuff, (0, 0, radius), velocity=(x * 0.3 * normal, 0, -normal))
    world.add_plane((0, 0, 0), (0, 0, 1), rigid(stuff))
    collide(world)
    spin = world.spin[0, 1]
    slip = world.velocity[0, 0] - radius * spin
    assert slip / (0.3 * normal) == pytest.approx(x - 7.0, rel=0.01)
    assert radius * spin / (0.3 * normal) == pytest.approx(5.0, rel=0.01)


@pytest.mark.parametrize(("q", "kept"), [(0.184, 0.8163), (0.370, 0.6297), (0.563, 0.4373)])
def test_t6_spinning_sphere_gross_sliding(q, kept):
    """Chung and Ooi (2011), test 6: spinning sphere, R = 0.1 m, mu = 0.4, e = 0.5, q = 3.5 mu (1 + e) v_n/v_s."""
    stuff = material(70e9, 0.33, 2700.0, 0.5, 0.4)
    surface_speed = 3.5 * 0.4 * 1.5 * 0.2 / q
    world = World(time_step=fiftieth(stuff, 0.1, 0.2))
    world.add_body(Sphere(0.1), stuff, (0, 0, 0.1), velocity=(0, 0, -0.2), spin=(0, surface_speed / 0.1, 0))
    world.add_plane((0, 0, 0), (0, 0, 1), rigid(stuff))
    collide(world)
    slip = world.velocity[0, 0] - 0.1 * world.spin[0, 1]
    assert -slip / surface_speed == pytest.approx(kept, abs=0.005)


def test_t7_equal_and_opposite_spins_feel_no_friction():
    """Chung and Ooi (2011), test 7: two equal spheres that roll off each other keep their spins."""
    stuff = material(70e9, 0.33, 2700.0, 0.5, 0.4)
    world = World(time_step=1e-6)
    for sign in (-1.0, 1.0):
        world.add_body(Sphere(0.1), stuff, (sign * 0.1, 0, 0), velocity=(-sign * 0.2, 0, 0), spin=(0, 0, sign * 7.0))
    collide(world)
    assert np.abs(world.spin[:, 2] - [-7.0, 7.0]).max() <= 1e-12 * 7.0
    assert np.abs(world.velocity[:, 1]).max() <= 1e-12 * 0.2


def test_sphere_at_rest_overlap_and_period():
    """Derived: Hertz and its linearisation, R = 0.05 m, rho = 2000, E = 1e7, nu = 0.25, g = 9.81."""
    stuff = material(1e7, 0.25, 2000.0)
    world = World((0, 0, -9.81), 1e-5)
    overlap, nudge = 2.185228e-4, 2e-6
    world.add_body(Sphere(0.05), stuff, (0, 0, 0.05 - overlap + nudge))
    world.add_plane((0, 0, 0), (0, 0, 1), rigid(stuff))
    heights = []
    for _ in range(10_000):
        world.run(steps=1)
        heights.append(world.position[0, 2])
    offset = np.array(heights) - (0.05 - overlap)
    up = np.flatnonzero((offset[:-1] < 0) & (offset[1:] >= 0))
    assert np.diff(up).mean() * 1e-5 == pytest.approx(0.02421, rel=0.01)
    assert np.mean(heights[up[0] : up[-1]]) == pytest.approx(0.05 - overlap, abs=1e-3 * overlap)


def test_sphere_rolls_down_a_slope():
    """Derived: 5/7 g sin(angle) t, less the lag of the settling; 15 degrees, mu = 0.5, g = 9.8, 1 s."""
    stuff = material(1e8, 0.25, 2000.0, 0.5, 0.5)
    angle = math.radians(15.0)
    world = World((9.8 * math.sin(angle), 0, -9.8 * math.cos(angle)), 2e-5)
    world.add_body(Sphere(0.05), stuff, (0, 0, 0.05))
    world.add_plane((0, 0, 0), (0, 0, 1), rigid(stuff))
    world.run(duration=1.0)
    assert world.velocity[0, 0] == pytest.approx(1.8117, rel=1e-3)


def test_sliding_sphere_begins_to_roll():
    """Derived: rolling from t = 2 v/(7 mu g) on, at 5/7 of the speed, after x = 12 v^2/(49 mu g)."""
    stuff = material(1e8, 0.25, 2000.0, 0.5, 0.3)
    world = World((0, 0, -9.81), 1e-5)
    overlap = (0.75 * 2000 * Sphere(0.05).volume * 9.81 / (1e8 / (1 - 0.0625) * math.sqrt(0.05))) ** (2 / 3)
    world.add_body(Sphere(0.05), stuff, (0, 0, 0.05 - overlap), velocity=(1.0, 0, 0))
    world.add_plane((0, 0, 0), (0, 0, 1), rigid(stuff))
    while world.velocity[0, 0] - 0.05 * world.spin[0, 1] > 1e-3:
        world.run(steps=1)
    assert world.time == pytest.approx(0.09708, rel=0.005)
    assert world.position[0, 0] == pytest.approx(0.083214, rel=0.005)
    world.run(duration=0.1)
    assert world.velocity[0, 0] == pytest.approx(0.71429, rel=0.005)


@pytest.mark.parametrize("restitution", [1e-12, 1e-8, 1e-4, 0.05, 0.1353, 0.1354, 0.99])
def test_every_restitution_has_a_damping_ratio(restitution):
    assert restitution_of(damping_ratio_of(restitution)) == pytest.approx(restitution, rel=1e-6)
