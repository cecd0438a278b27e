"""The two pair tests of the comparison of nine codes. Source: [Dosta-2024], drivers OSHertz- and OSMindlinSelfTest.

MercuryDPM's ends are those that its repository keeps, Drivers/Papers/OSBenchmark/SelfTestData; both last a step of
5e-7 s longer than they say.
"""

import math
import sys
from importlib import import_module
from pathlib import Path

import pytest

from lithobrake.dem import Material, Sphere, World
from lithobrake.dem.law.restitution import damping_ratio_of, pair_law

VALIDATION = Path(__file__).parents[2] / "validation" / "nine_codes"

STEP = 5e-7
# Of M1 on steel restitution is 0.4 and friction 0.2, the smaller of both.
M1 = Material(young_modulus=1e9, poisson_ratio=0.2, restitution=0.5, friction=0.3, density=2500.0)
STEEL = Material(young_modulus=210e9, poisson_ratio=0.2, restitution=0.4, friction=0.2, density=7200.0)
RADIUS = 0.001


def ball_on_plane(
    ball: Material, plane: Material, gravity, height: float, speed: float, step: float, steps: int
) -> World:
    world = World(gravity, step)
    world.add_body(Sphere(RADIUS), ball, (0, 0, height), velocity=(0, 0, -speed))
    world.add_plane((0, 0, 0), (0, 0, 1), plane)
    world.run(steps=steps)
    return world


def restitution_at(step: float) -> float:
    """Restitution of M1 from z = 1.01 mm at 1 m/s onto steel, followed for 60.5 us."""
    world = ball_on_plane(M1, STEEL, (0, 0, 0), 0.00101, 1.0, step, round(121 * STEP / step))
    assert not len(world.contacts())
    return float(world.velocity[0, 2])


def test_hertz_pair_leaves_with_the_restitution_entered() -> None:
    """Derived: e = 0.4, what the step leaves of it apart. At 5e-7 s MercuryDPM has 0.40107538, and 0.39994728 at 5e-8.

    Contact begins and ends within a step, which is a fortieth of it: the error is in proportion to the step.
    """
    coarse, fine, finest = (abs(restitution_at(step) - 0.4) for step in (STEP, STEP / 4.0, STEP / 16.0))
    assert finest < 0.4e-3 / 4.0
    assert coarse / fine == pytest.approx(4.0, rel=0.3)
    assert fine / finest == pytest.approx(4.0, rel=0.4)
    assert restitution_at(STEP / 10.0) == pytest.approx(0.4, rel=1e-3)


def test_mindlin_ball_slides_as_derived() -> None:
    """A ball of steel at rest on M1 under (5, 0, -5) m/s2, 10001 steps of 5e-7 s.

    Derived: it slides, a = g (1 - mu) and 5 mu g / (2 R) of spin; MercuryDPM: 0.0200031142 m/s, 12.4983210 rad/s and
    5.00201149e-5 m.
    """
    world = ball_on_plane(STEEL, M1, (5, 0, -5), RADIUS, 0.0, STEP, 10001)
    time = 10001 * STEP
    speed, spin, way = world.velocity[0, 0], world.spin[0, 1], world.position[0, 0]
    assert speed == pytest.approx(5.0 * (1.0 - 0.2) * time, rel=1e-3)
    assert spin == pytest.approx(2.5 * 0.2 * 5.0 / RADIUS * time, rel=1e-3)
    assert way == pytest.approx(0.5 * 4.0 * time**2, rel=1e-3)
    assert speed == pytest.approx(0.0200031142, rel=1e-3)
    assert spin == pytest.approx(12.4983210, rel=1e-3)
    assert way == pytest.approx(5.00201149e-5, rel=1e-3)
    # Momentum about the point of contact: what gravity turns.
    inertia = 0.4 * RADIUS**2
    assert RADIUS * speed + inertia * spin == pytest.approx(RADIUS * 5.0 * time, rel=1e-4)
    assert math.isclose(world.velocity[0, 1], 0.0, abs_tol=1e-15)


@pytest.fixture(scope="module")
def impact_bed():
    sys.path.insert(0, str(VALIDATION))
    try:
        return import_module("impact_bed")
    finally:
        del sys.path[0]


def test_pairs_of_the_impact_have_the_published_values(impact_bed) -> None:
    """Restitution, friction and effective moduli of the driver: its MercuryOS.h, and its restart files for moduli."""
    ball, of_grains, of_ball, m1 = (impact_bed.STEEL_OF_GRAINS, impact_bed.STEEL_OF_GRAINS, impact_bed.STEEL_OF_BALL,
        impact_bed.M1)  # fmt: skip
    for pair, restitution, friction, young, shear in (
        ((m1, m1), 0.5, 0.3, 520833333.333333, 115740740.740741),
        ((m1, ball), 0.4, 0.2, 1036729857.81991, 230384412.848868),
        ((m1, of_grains), 0.4, 0.2, 1036729857.81991, 230384412.848868),
        ((ball, of_ball), 0.6, 0.5, 109375000000.0, 24305555555.5556),
    ):
        law = pair_law(*pair, pair_rule="mean")
        assert law.damping_ratio == pytest.approx(damping_ratio_of(restitution), rel=1e-9)
        assert law.friction == pytest.approx(friction, rel=1e-12)
        assert law.young_modulus == pytest.approx(young, rel=1e-12)
        assert law.shear_modulus == pytest.approx(shear, rel=1e-12)


def test_ball_and_grains_meet_walls_of_their_own(impact_bed) -> None:
    """A grain on the floor touches the floor of grains alone; the ball falls as it does freely."""
    world = impact_bed.world_of(impact_bed.np.array([[0.03, 0.0, impact_bed.FLOOR + 0.000999]]), 1e-7)
    world.time = 0.02
    ball = impact_bed.add_ball(world, (0.0, 0.0))
    assert world.position[ball, 2] == pytest.approx(0.06 - 5.0 * 0.02 - 4.9 * 0.02**2, rel=1e-12)
    steel_of_grains, steel_of_ball = range(5), range(5, 10)
    assert {world.planes[k].meets for k in steel_of_grains} == {frozenset({0})}
    assert {world.planes[k].meets for k in steel_of_ball} == {frozenset({ball})}
    world.run(steps=1)
    assert len(world.contacts()) == 1
