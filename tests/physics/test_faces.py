"""Hulls on planes and on each other: energy, rest, friction. Expected values are derived; see each docstring."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.dem import Box, ConvexHull, Material, Sphere, World


def material(restitution=0.5, friction=0.5, young_modulus=1e8):
    return Material(
        young_modulus=young_modulus, poisson_ratio=0.25, restitution=restitution, friction=friction, density=2000.0
    )


def on_plane(shape, stuff, position, gravity=(0, 0, -9.81), time_step=5e-5, **state):
    world = World(gravity, time_step)
    world.add_body(shape, stuff, position, **state)
    world.add_plane((0, 0, 0), (0, 0, 1), stuff)
    return world


def test_block_slides_to_a_stop():
    """v^2/(2 mu g) = 2.5484 m from 5 m/s at mu = 0.5."""
    world = on_plane(Box((0.4, 0.4, 0.05)), material(), (0, 0, 0.025), velocity=(5.0, 0, 0))
    world.run(duration=1.3)
    assert world.position[0, 0] == pytest.approx(2.5484, rel=0.005)
    assert abs(world.velocity[0, 0]) < 1e-6


@pytest.mark.parametrize("friction", [0.95, 1.05])
def test_block_on_a_slope_about_the_friction_angle(friction):
    """Below the friction angle it stays where it is; above, it accelerates at g (sin - mu cos)."""
    angle = 0.3
    mu = friction * math.tan(angle)
    gravity = (9.81 * math.sin(angle), 0, -9.81 * math.cos(angle))
    world = on_plane(Box((0.2, 0.2, 0.05)), material(friction=mu), (0, 0, 0.025), gravity)
    world.run(duration=0.5)
    start, speed = world.position[0, 0], world.velocity[0, 0]
    world.run(duration=1.0)
    if friction > 1.0:
        world.run(duration=9.0)
        assert abs(world.position[0, 0] - start) < 1e-6
    else:
        expected = 9.81 * (math.sin(angle) - mu * math.cos(angle))
        assert world.velocity[0, 0] - speed == pytest.approx(expected, rel=0.01)


def test_tall_block_rocks_without_gain_or_loss_of_energy():
    """e = 1, mu = 0: the patch has a potential; 1e-2 of the energy of rocking over 1000 periods."""
    tilt = 0.02
    turn = (math.cos(tilt / 2), math.sin(tilt / 2), 0, 0)
    height = 0.1 * math.cos(tilt) + 0.05 * math.sin(tilt)
    world = on_plane(Box((0.1, 0.1, 0.2)), material(1.0, 0.0, 1e7), (0, 0, height), time_step=2e-4, orientation=turn)
    world.run(steps=1)
    start = world.energy()["total"]
    rocking = world.mass[0] * 9.81 * 0.05 * tilt
    periods, before = 0, -1.0
    while periods < 1000:
        world.run(steps=50)
        spin = world.spin[0, 0]
        periods, before = periods + (before < 0.0 < spin), spin if spin != 0.0 else before
    assert abs(world.energy()["total"] - start) < 1e-2 * rocking


def test_tall_block_rings_down_to_rest():
    tilt = 0.02
    turn = (math.cos(tilt / 2), math.sin(tilt / 2), 0, 0)
    height = 0.1 * math.cos(tilt) + 0.05 * math.sin(tilt)
    world = on_plane(Box((0.1, 0.1, 0.2)), material(0.5, 0.5, 1e7), (0, 0, height), orientation=turn)
    world.run(duration=3.0)
    assert world.energy()["kinetic"] < 1e-20 * world.mass[0] * 9.81 * 0.2


def test_spun_face_stops_at_the_rate_of_its_friction():
    """Four corners at distance r: the couple is mu F r, so the spin falls at mu m g r / I."""
    box = Box((0.2, 0.2, 0.05))
    world = on_plane(box, material(friction=0.4), (0, 0, 0.025), time_step=2e-5)
    world.run(duration=0.5)
    still = World((0, 0, -9.81), 2e-5)
    still.add_body(box, material(friction=0.4), world.position[0], spin=(0, 0, 5.0))
    still.add_plane((0, 0, 0), (0, 0, 1), material(friction=0.4))
    still.run(duration=0.05)
    radius = math.sqrt(2.0) * (0.1 - box.rounding)
    expected = 0.4 * still.mass[0] * 9.81 * radius / still.inertia[0, 2]
    assert (5.0 - still.spin[0, 2]) / 0.05 == pytest.approx(expected, rel=0.03)
    still.run(duration=1.0)
    assert abs(still.spin[0, 2]) < 1e-9


@pytest.mark.parametrize("tilt", ["face", "edge", "corner"])
def test_dropped_cube_keeps_its_energy(tilt):
    """e = 1, mu = 0: kinetic and elastic energy before and after agree to 1e-3."""
    axis, angle = {
        "face": ((1, 0, 0), 0.0), "edge": ((1, 0, 0), math.pi / 4), "corner": ((1, -1, 0), math.atan(2**0.5)),
    }[tilt]  # fmt: skip
    unit = np.array(axis) / np.linalg.norm(axis)
    turn = (math.cos(angle / 2), *(math.sin(angle / 2) * unit))
    world = on_plane(
        Box((0.1, 0.1, 0.1)), material(1.0, 0.0), (0, 0, 0.1), (0, 0, 0), 1e-5, orientation=turn, velocity=(0, 0, -0.5)
    )
    before = world.energy()["total"]
    world.run(duration=0.3)
    assert world.energy()["total"] == pytest.approx(before, rel=1e-3)
    assert world.velocity[0, 2] > 0.0


def test_flat_drop_gives_the_entered_restitution():
    world = on_plane(Box((0.1, 0.1, 0.1)), material(0.5, 0.0), (0, 0, 0.0501), (0, 0, 0), 1e-5, velocity=(0, 0, -0.2))
    world.run(duration=0.05)
    assert world.velocity[0, 2] / 0.2 == pytest.approx(0.5, abs=0.01)


def test_stack_of_five_cubes_stands():
    world = World((0, 0, -9.81), 5e-5)
    for k in range(5):
        world.add_body(Box((0.1, 0.1, 0.1)), material(), (0, 0, 0.05 + 0.1 * k))
    world.add_plane((0, 0, 0), (0, 0, 1), material())
    world.run(duration=1.5)
    assert world.energy()["kinetic"] < 1e-9 * world.mass[0] * 9.81 * 0.1
    assert np.abs(world.position[:, 2] - (0.05 + 0.1 * np.arange(5))).max() < 2e-3


@pytest.mark.parametrize("ratio", [0.95, 1.05])
def test_block_topples_at_its_aspect_ratio(ratio):
    """It stands while tan(slope) < width / height, and falls above; the slope is raised slowly."""
    world = on_plane(Box((0.1, 0.1, 0.2)), material(friction=2.0), (0, 0, 0.1))
    for slope in np.linspace(0.0, math.atan(ratio * 0.5), 200):
        world.gravity = 9.81 * np.array([math.sin(slope), 0, -math.cos(slope)])
        world.run(duration=0.01)
    world.run(duration=1.0)
    fell = world.position[0, 2] < 0.09
    assert fell == (ratio > 1.0)


def elastic(first, second, place, turn):
    """Elastic energy and the force and torque on the second of two touching bodies."""
    world = World(time_step=1e-9)
    stuff = material(1.0, 0.0, 1e7)
    world.add_body(first, stuff, (0, 0, 0))
    world.add_body(second, stuff, place, orientation=turn)
    return world.energy()["elastic"], np.concatenate([world.contact_force[1], world.contact_torque[1]])


def turned_by(turn, rotation):
    """A quaternion after a small rotation (vector of the angle) in the world frame."""
    half = Rotation.from_rotvec(rotation) * Rotation.from_quat(turn, scalar_first=True)
    return half.as_quat(scalar_first=True)


def gradient_error(first, second, place, turn):
    """Largest difference of force and torque from the energy's slope (central differences), over the largest force."""
    found = elastic(first, second, place, turn)[1]
    step, slope = 1e-8, []
    for e in np.eye(3):
        there = (elastic(first, second, place + s * step * e, turn)[0] for s in (-1, 1))
        slope.append((next(there) - next(there)) / (2 * step))
    for e in np.eye(3):
        there = (elastic(first, second, place, turned_by(turn, s * 10 * step * e))[0] for s in (-1, 1))
        slope.append((next(there) - next(there)) / (20 * step))
    error = np.abs(found - slope)
    return max(error[:3].max(), error[3:].max() / np.cbrt(second.volume)) / np.linalg.norm(found[:3])


def touching(first, second, direction, turn):
    """The farthest place along a direction at which two bodies touch."""
    near, far = 0.0, 1.0
    for _ in range(50):
        middle = 0.5 * (near + far)
        near, far = (middle, far) if elastic(first, second, middle * direction, turn)[0] > 0.0 else (near, middle)
    return near * direction


@pytest.mark.parametrize("depth", [0.1, 0.6, 0.8, 1.0, 1.5, 4.0])
@pytest.mark.parametrize("seed", range(4))
def test_force_and_torque_of_hulls_are_the_gradient_of_their_energy(seed, depth):
    """At any depth (over the sum of the rounding radii), cores apart and crossing."""
    generator = np.random.default_rng(seed)
    first, second = (ConvexHull(generator.normal(size=(14, 3)) * 0.05) for _ in range(2))
    turn = generator.normal(size=4)
    turn /= np.linalg.norm(turn)
    direction = generator.normal(size=3)
    direction /= np.linalg.norm(direction)
    place = touching(first, second, direction, turn) - depth * (first.rounding + second.rounding) * direction
    assert gradient_error(first, second, place, turn) < 1e-5


@pytest.mark.parametrize("depth", [0.1, 0.6, 0.8, 1.0, 1.5, 4.0])
@pytest.mark.parametrize("tilt", [1e-2, 1e-5])
def test_force_and_torque_of_faces_are_the_gradient_of_their_energy(tilt, depth):
    """Two boxes face on face, yawed, overlapping in part, all but parallel."""
    first, second = Box((0.1, 0.1, 0.1)), Box((0.08, 0.12, 0.1))
    turn = (Rotation.from_rotvec((tilt, 0.7 * tilt, 0.0)) * Rotation.from_rotvec((0, 0, 0.4))).as_quat(
        scalar_first=True
    )
    place = touching(first, second, np.array([0.0, 0.0, 1.0]), turn)
    place += np.array([0.03, 0.02, -depth * (first.rounding + second.rounding)])
    assert gradient_error(first, second, place, turn) < 1e-5


def test_sphere_presses_on_a_face_as_on_a_plane():
    """The face of a box is flat and its contact radius that of its volume: Hertz with 1/R = 1/R1 + 1/R2."""
    world = World(time_step=1e-9)
    stuff = material(1.0, 0.0, 1e7)
    world.add_body(Box((1.0, 1.0, 1.0)), stuff, (0, 0, 0))
    world.add_body(Sphere(0.1), stuff, (0.1, 0.05, 0.6 - 1e-4))
    contact = world.contacts()[0]
    radius = 1.0 / (1.0 / 0.1 + (4 * math.pi / 3) ** (1 / 3))
    modulus = 1e7 / (2 * (1 - 0.25**2))
    assert contact["overlap"] == pytest.approx(1e-4, rel=1e-9)
    assert contact["normal_force"] == pytest.approx(4 / 3 * modulus * math.sqrt(radius) * 1e-4**1.5, rel=1e-9)


# A cube of 20 mm whose upper face is cut in triangles, about (0, 0, -0.01).
CUBE = np.array([(x, y, z) for x in (-0.01, 0.01) for y in (-0.01, 0.01) for z in (-0.01, 0.01)])


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.003, 0.003), (0.004, -0.002), (0.009, 0.0)])
def test_a_ball_leaves_a_wall_of_facets_as_it_leaves_a_plane(place):
    """A ball of 1 mm at 0.610557 m/s with e = 0.50: in a face, on the edge of its triangles, and near its rounded rim.

    The case is issue 73 of DEM-Engine, where the two walls differ: both must give 0.305279 m/s.
    """
    stuff, speed = material(0.50, 0.0, 1e7), 0.610557
    left = {}
    for wall in ("plane", "box", "hull"):
        world = World(time_step=2e-7)
        world.add_body(Sphere(0.5e-3), stuff, (*place, 0.5001e-3), velocity=(0.0, 0.0, -speed))
        heavy = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=0.50, friction=0.0, density=1e12)
        if wall == "plane":
            world.add_plane((0, 0, 0), (0, 0, 1), heavy)
        else:
            world.add_body(Box((0.02, 0.02, 0.02)) if wall == "box" else ConvexHull(CUBE), heavy, (0, 0, -0.01))
        world.run(duration=2e-3)
        assert len(world.contacts()) == 0
        left[wall] = world.velocity[0]
    for velocity in left.values():
        assert velocity[2] == pytest.approx(0.5 * speed, rel=0.005)
        assert velocity == pytest.approx(left["plane"], abs=1e-3 * speed)


@pytest.mark.parametrize("depth", [0.3, 0.6, 0.7, 0.8, 0.95])
def test_elastic_faces_give_back_all_they_take(depth):
    """e = 1, mu = 0, two cubes pressed face to face to a part of their rounding: nothing is damped at any depth."""
    cube = Box((0.1, 0.1, 0.1))
    world = World(time_step=1e-5)
    stuff = material(1.0, 0.0, 1e7)
    world.add_body(cube, stuff, (0, 0, 0))
    world.add_body(cube, stuff, (0.003, 0.002, 0.1 - depth * 2.0 * cube.rounding))
    before = world.energy()["total"]
    world.run(duration=0.02)
    after = world.energy()
    assert after["elastic"] == 0.0
    assert abs(after["damping"]) < 1e-12 * before
    assert after["kinetic"] == pytest.approx(before, rel=1e-3)


# Two boxes, and how deep one lies in the other.
PAIR = Box((0.1, 0.1, 0.1)), Box((0.08, 0.12, 0.1))
DEPTH = 0.3 * (PAIR[0].rounding + PAIR[1].rounding)
# Pairs a metre apart in one world, which share the cost of making it.
PAIRS = 100


def forces_along(path, steps):
    """Force and torque over a length on the second of two boxes [N] in the poses along a path, [steps + 1, 6]."""
    found, stuff, shares = [], material(1.0, 0.0, 1e7), np.linspace(0.0, 1.0, steps + 1)
    for start in range(0, len(shares), PAIRS):
        world = World(time_step=1e-9)
        for number, share in enumerate(shares[start : start + PAIRS]):
            (x, y, z), turn = path(share)
            world.add_body(PAIR[0], stuff, (0, number, 0))
            world.add_body(PAIR[1], stuff, (x, number + y, z), orientation=turn)
        found.append(np.hstack([world.contact_force[1::2], world.contact_torque[1::2] / 0.05]))
    forces = np.concatenate(found)
    assert np.abs(forces).max() > 0.0
    return forces


def largest_jump(forces):
    """Largest change from one pose to the next."""
    return np.abs(np.diff(forces, axis=0)).max()


def slide(share):
    """A face slides over a face, yawed, past edges and corners of both."""
    return (-0.06 + 0.1 * share, 0.013 * share, 0.1 - DEPTH), (math.cos(0.1), 0.0, 0.0, math.sin(0.1))


def tilt(share):
    """A box tilts over a face, from one of its own faces past the edge to the next, its lowest point as deep."""
    angle = -0.05 + (0.5 * math.pi + 0.1) * share
    corners = np.array([(y, z) for y in (-0.06, 0.06) for z in (-0.05, 0.05)])
    lowest = (corners @ (math.sin(angle), math.cos(angle))).min()
    return (0.007, 0.004, 0.05 - lowest - DEPTH), (math.cos(0.5 * angle), math.sin(0.5 * angle), 0.0, 0.0)


@pytest.mark.parametrize("path", [slide, tilt])
def test_force_and_torque_have_no_jumps(path):
    """Halving the steps of a path halves the largest change, within a fifth: first order, no jumps."""
    forces = forces_along(path, 2000)
    assert largest_jump(forces) < 0.6 * largest_jump(forces[::2])
