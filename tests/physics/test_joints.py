"""Joined bodies against closed forms: a clamped beam, the effective mass of its tip, conservation laws."""

import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Material, Part, Sphere, World
from lithobrake.touchdown import BeamLink, beam_frequency, beam_link

SMOOTH = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=1.0, friction=0.0, density=1000.0)
ROUGH = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=1000.0)
# A boom of carbon fibre of 1.5 m, see docs/what_the_model_leaves_out.md.
LENGTH, MASS, BENDING_STIFFNESS = 1.5, 0.022, 10.8
FREQUENCY = beam_frequency(LENGTH, MASS, BENDING_STIFFNESS)
LINK = beam_link(LENGTH, MASS, FREQUENCY)
EDGE, THICKNESS = 0.3, 0.01
# Along x: of the hinge, and of the tip.
HINGE, TIP = 0.5 * EDGE + LENGTH - LINK.length, 0.5 * EDGE + LENGTH
HELD = 1e6  # kg


def boom(link: BeamLink = LINK, base: float = HELD, material: Material = SMOOTH, **joint: Any) -> World:
    """A cube with a link on a hinge that sticks out along +x; the link is body 1."""
    world = World(time_step=1e-3)
    world.add_body(Box((EDGE,) * 3), material, (0.0, 0.0, 0.0), mass=base)
    place = (HINGE + 0.5 * link.length, 0.0, 0.0)
    world.add_body(Box((link.length, THICKNESS, THICKNESS)), material, place, mass=link.mass)
    world.join(0, 1, (HINGE, 0.0, 0.0), link.stiffness, **joint)
    return world


def swing(world: World, spin: float, body: int = 1) -> None:
    """Let the link of `boom` swing about its hinge, about y [rad/s]."""
    arm, inertia = 0.5 * LINK.length, world.bodies[body].inertia[1, 1]
    world._state.motion["velocity"][body] = (0.0, 0.0, -spin * arm)
    world._state.motion["angular_momentum"][body] = (0.0, spin * inertia, 0.0)


def heights(world: World, duration: float, count: int, steps: float = 25.0) -> np.ndarray:
    """Heights [m] of the link's centre at so many equal times."""
    found = []
    for _ in range(count):
        world.run_locally(duration / count, steps)
        found.append(world.position[1, 2])
    return np.array(found)


def frequency_of(height: np.ndarray, interval: float) -> float:
    """Mean frequency [Hz] between crossings of 0 upward."""
    at = np.flatnonzero((height[:-1] < 0.0) & (height[1:] >= 0.0))
    crossing = interval * (at - height[at] / (height[at + 1] - height[at]))
    return float(1.0 / np.diff(crossing).mean())


def momenta(world: World) -> tuple[np.ndarray, np.ndarray]:
    """Linear momentum, and angular momentum about the origin."""
    linear = world.mass[:, None] * world.velocity
    return linear.sum(axis=0), (np.cross(world.position, linear) + world.angular_momentum).sum(axis=0)


def test_the_first_frequency_of_a_clamped_beam_is_that_of_its_modulus_and_section() -> None:
    """A tube of 100 GPa and 1600 kg/m3, 10 mm wide with walls of 0.3 mm: 6.7 Hz, and a stiffness of 9.6 N/m."""
    outer, inner = 0.005, 0.0047
    section, area = math.pi / 4.0 * (outer**4 - inner**4), math.pi * (outer**2 - inner**2)
    frequency = beam_frequency(LENGTH, 1600.0 * area * LENGTH, 1e11 * section)
    assert frequency == pytest.approx(6.7, abs=0.05)
    assert 3.0 * 1e11 * section / LENGTH**3 == pytest.approx(9.6, abs=0.05)
    # The link gives way at its tip as the beam does, within 3 %.
    link = beam_link(LENGTH, 1600.0 * area * LENGTH, frequency)
    assert link.stiffness / link.length**2 == pytest.approx(9.6, rel=0.035)


@pytest.mark.parametrize("pin_ratio", [5.0, 10.0, 30.0])
def test_a_link_swings_at_the_frequency_of_the_beam_less_what_the_pin_gives_way(pin_ratio: float) -> None:
    """By Dunkerley's formula the pin lowers the frequency by 3/8 of one over the square of its ratio, for a rod."""
    world = boom(pin_ratio=pin_ratio)
    swing(world, 0.1)
    found = frequency_of(heights(world, 1.5, 1500), 1e-3)
    assert found / FREQUENCY == pytest.approx(1.0 - 0.375 / pin_ratio**2, abs=1e-3)
    if pin_ratio >= 10.0:
        assert found == pytest.approx(FREQUENCY, rel=0.01)


def test_a_swing_decays_with_its_damping_ratio() -> None:
    ratio = 0.02
    world = boom(damping_ratio=ratio)
    swing(world, 0.1)
    height = np.abs(heights(world, 1.5, 1500))
    first, last = height[:200].max(), height[-200:].max()
    between = height[-200:].argmax() + 1300 - height[:200].argmax()
    decayed = math.exp(-ratio * 2.0 * math.pi * FREQUENCY * 1e-3 * between)
    assert last / first == pytest.approx(decayed, rel=0.02)


def tip_mass(material: Material, *, is_rigid: bool = False, **joint: Any) -> float:
    """Mass [kg] that a ball finds at the tip of a boom of a lander of 12 kg, by its rebound, and without friction."""
    lander, ball, speed, short_of_tip = 12.0, 0.05, 0.05, 0.002
    if is_rigid:
        world = World(time_step=1e-3)
        middle = np.array([HINGE + 0.5 * LINK.length, 0.0, 0.0])
        shape = ConvexHull(Box((LINK.length, THICKNESS, THICKNESS)).vertices + middle)
        density = LINK.mass / shape.volume
        part = Part(shape, Material(**{**SMOOTH_NUMBERS, "density": density, "young_modulus": material.young_modulus}))
        world.add_body(Box((EDGE,) * 3), material, (0.0, 0.0, 0.0), mass=lander, parts=(part,))
    else:
        world = boom(base=lander, material=material, **joint)
    place = (TIP - short_of_tip, 0.0, 0.5 * THICKNESS + 0.0205)
    number = world.add_body(Sphere(0.02), material, place, (0.0, 0.0, -speed), mass=ball)
    world.watch(number)
    world.run_locally(0.03, 50.0)
    assert world.first_touch is not None
    assert not world.is_touched
    change = world.velocity[number, 2] + speed
    return float(ball * change / (2.0 * speed - change))


SMOOTH_NUMBERS: dict[str, float] = {"poisson_ratio": 0.25, "restitution": 1.0, "friction": 0.0}


def smooth(young_modulus: float) -> Material:
    return Material(young_modulus=young_modulus, density=1000.0, **SMOOTH_NUMBERS)


def test_a_blow_at_the_tip_finds_a_quarter_of_the_mass_of_the_boom() -> None:
    """The modal mass of the first mode at the tip of a clamped beam, whose shape has there twice its mean square."""
    # Of the link, 2 mm short of the tip.
    expected = 0.25 * MASS * (LINK.length / (LINK.length - 0.002)) ** 2
    # A touch of 3 ms: longer than the period of a stiff pin, and far shorter than that of the boom, 0.15 s.
    assert tip_mass(smooth(1e7), pin_ratio=40.0) == pytest.approx(expected, rel=0.005)
    # A touch of 8 ms with the pin of a study, which gives way a little.
    assert tip_mass(smooth(1e6)) == pytest.approx(expected, rel=0.04)
    # Without hinges the tip has more than ten times the mass.
    assert tip_mass(smooth(1e6), is_rigid=True) > 10.0 * expected


def test_a_blow_shorter_than_the_pin_finds_a_link_that_flies_freely() -> None:
    """A free rod has a quarter of its mass at its tip."""
    assert tip_mass(smooth(1e9)) == pytest.approx(0.25 * LINK.mass, rel=0.06)


def tumbling(material: Material, damping_ratio: float = 0.0, *, is_alone: bool = False) -> World:
    """A light box with links on either side, off its middle, that turns and flies toward two balls."""
    world = World(time_step=1e-3)
    turn = np.array([0.8, 0.3, -0.4, 0.2]) / np.linalg.norm([0.8, 0.3, -0.4, 0.2])
    spin, velocity = np.array([0.2, 1.0, 0.5]), np.array([0.05, 0.0, -0.1])
    w, v = turn[0], turn[1:]

    def turned(way: np.ndarray) -> np.ndarray:
        return way + 2.0 * np.cross(v, np.cross(v, way) + w * way)

    world.add_body(Box((0.3, 0.2, 0.1)), material, (0.0, 0.0, 0.0), tuple(velocity), tuple(turn), tuple(spin), mass=0.5)
    for side in (-1.0, 1.0):
        way, pin = (turned(np.array([side * length, 0.02, 0.03])) for length in (0.45, 0.2))
        moving = velocity + np.cross(spin, way)
        number = world.add_body(Box((0.5, 0.02, 0.03)), material, way, moving, tuple(turn), tuple(spin))
        world.join(0, number, pin, 0.4, damping_ratio=damping_ratio, limit=0.3)
    for x in () if is_alone else (-0.5, 0.5):
        world.add_body(Sphere(0.1), material, (x, 0.1, -0.4), (0.0, 0.0, 0.2))
    return world


def test_momentum_stays_to_rounding_and_angular_momentum_to_the_order_of_contacts() -> None:
    lost = []
    for steps in (25.0, 100.0):
        world = tumbling(ROUGH, damping_ratio=0.05)
        before, scale = momenta(world), float((world.mass * np.linalg.norm(world.velocity, axis=1)).sum())
        world.watch(0)
        world.run_locally(3.0, steps)
        assert world.first_touch is not None
        linear, angular = momenta(world)
        assert np.abs(linear - before[0]).max() < 1e-13 * scale
        lost.append(float(np.abs(angular - before[1]).max()) / scale)
    assert lost[0] < 1e-4
    assert lost[1] < lost[0] / 10.0


def lacking_energy(damping_ratio: float, steps: float, *, is_alone: bool) -> float:
    """What the ledger lacks after 3 s, over the energy of the motion at the start."""
    world = tumbling(ROUGH, damping_ratio, is_alone=is_alone)
    before, moving = world.energy()["total"], float(world.kinetic_energy.sum())
    world.run_locally(3.0, steps)
    assert world.energy()["damping"] > 0.0 or (is_alone and damping_ratio == 0.0)
    return abs(world.energy()["total"] - before) / moving


@pytest.mark.parametrize("damping_ratio", [0.0, 0.05])
def test_the_ledger_closes_and_better_with_more_steps(damping_ratio: float) -> None:
    alone = [lacking_energy(damping_ratio, steps, is_alone=True) for steps in (25.0, 100.0)]
    assert alone[0] < 1e-4
    assert alone[1] < 0.2 * alone[0]
    # With contacts, as without joints.
    assert lacking_energy(damping_ratio, 25.0, is_alone=False) < 0.004
    assert lacking_energy(damping_ratio, 200.0, is_alone=False) < 0.001


def test_a_limit_stops_a_link_and_gives_its_energy_back() -> None:
    limit, spin = 0.1, 6.0
    world = boom(limit=limit)
    swing(world, spin)
    start = float(world.kinetic_energy.sum())
    # Without a stop it would swing by spin over rate: 0.14.
    assert spin / (2.0 * math.pi * FREQUENCY) > 1.4 * limit
    angles, spins = [], []
    for _ in range(150):
        world.run_locally(1e-3, 100.0)
        w = abs(float(world.orientation[1] @ world.orientation[0]))
        angles.append(2.0 * math.acos(min(1.0, w)))
        spins.append(float(world.spin[1, 1]))
    # A stop as stiff as the pin, of ten times the rate of the hinge, is bent by a tenth of what the hinge would be.
    assert limit < max(angles) < 1.1 * limit
    assert min(spins) < -0.9 * spin
    assert world.energy()["total"] == pytest.approx(start, rel=1e-3)
    # Sooner back than a swing without a stop.
    assert np.argmin(spins) * 1e-3 < 0.45 / FREQUENCY


def test_joined_bodies_do_not_touch_and_what_touches_either_is_seen() -> None:
    world = World(time_step=1e-3)
    world.add_body(Box((0.2, 0.2, 0.2)), ROUGH, (0.0, 0.0, 0.0))
    world.add_body(Box((0.4, 0.1, 0.1)), ROUGH, (0.15, 0.0, 0.0))
    world.join(0, 1, (0.0, 0.0, 0.0), 1.0)
    number = world.add_body(Sphere(0.05), ROUGH, (0.3, 0.0, 0.11), (0.0, 0.0, -0.1))
    world.watch(0)
    world.run_locally(0.05, 25.0)
    assert world.contacts().size == 0
    assert world.first_touch is None
    while not world.is_touched:
        world.run_locally(1e-3, 25.0)
    assert {(int(one["body_a"]), int(one["body_b"])) for one in world.contacts()} == {(1, number)}
    assert world.watched["peak_force"] > 0.0
    # The forces of the joint are no contact forces.
    np.testing.assert_allclose(world.contact_force[0], 0.0, atol=1e-12)
    np.testing.assert_allclose(world.contact_force[1], -world.contact_force[number], atol=1e-12)


def test_a_saved_world_with_joints_goes_on_with_the_same_bits(tmp_path: Any) -> None:
    world = tumbling(ROUGH, 0.05)
    world.run_locally(1.2, 25.0)
    world.save(tmp_path / "world.h5")
    again = World.load(tmp_path / "world.h5")
    for one in (world, again):
        one.run_locally(1.0, 25.0)
    np.testing.assert_array_equal(world.position, again.position)
    np.testing.assert_array_equal(world.angular_momentum, again.angular_momentum)
    assert world.energy() == again.energy()


def joined(*members: Any, point: Any = (0.1, 0.0, 0.0), stiffness: Any = 1.0, **joint: Any) -> World:
    world = tumbling(ROUGH)
    world.join(*members, point, stiffness, **joint)
    return world


@pytest.mark.parametrize(("make", "said"), [
    (lambda: joined(3, 9), "World.join second is 9; allowed is the number of a body, 0 to 4: add it first"),
    (lambda: joined(3, True), "World.join second is True; allowed is the number of a body"),
    (lambda: joined(3, 3), "World.join second is 3, the first one; allowed is another body without a joint"),
    (lambda: joined(3, 1), "World.join second is 1, a body that has a joint already"),
    (lambda: joined(3, 0), "World.join second is 0, a body that has a joint already"),
    (lambda: joined(0, 3, point=(0.0, 0.0)), "World.join point is (0.0, 0.0)"),
    (lambda: joined(0, 3, stiffness=0.0), "World.join stiffness is 0.0 N m/rad; allowed is a finite value above 0"),
    (lambda: joined(0, 3, stiffness="stiff"), "World.join stiffness is 'stiff' N m/rad"),
    (lambda: joined(0, 3, damping_ratio=-0.1), "World.join damping_ratio is -0.1; allowed is a value from 0 to 1"),
    (lambda: joined(0, 3, damping_ratio=math.nan), "World.join damping_ratio is nan"),
    (lambda: joined(0, 3, limit=2.0), "World.join limit is 2.0 rad; allowed is a value from 0 to 1.5708"),
    (lambda: joined(0, 3, limit=0.0), "World.join limit is 0.0 rad; allowed is above 0"),
    (lambda: joined(0, 3, pin_ratio=1.0), "World.join pin_ratio is 1.0; allowed is a value from 2 to 1000"),
    (lambda: joined(0, 3).run(steps=1), "World.run takes one step for all, and the world has 3 joints"),
    (lambda: joined(0, 3).watch(3), "World.watch body is 3, which is joined to body 0"),
])  # fmt: skip
def test_what_is_no_joint_is_refused_in_one_sentence(make: Callable[[], Any], said: str) -> None:
    with pytest.raises(ValueError, match=re.escape(said)) as refused:
        make()
    assert "\n" not in str(refused.value)
