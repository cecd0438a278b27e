"""Bodies of several convex parts against closed forms, conservation laws, and bodies of one part."""

import copy

import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Material, Part, Sphere, World
from lithobrake.smallbody import tumble

SMOOTH = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=1.0, friction=0.0, density=2000.0)
ROUGH = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.3, friction=0.6, density=2000.0)
LIGHT = Material(young_modulus=1e7, poisson_ratio=0.25, restitution=1.0, friction=0.0, density=20.0)
FLOOR = (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
# An attitude without any symmetry.
SLANTED = np.array([0.8, 0.3, -0.4, 0.2]) / np.linalg.norm([0.8, 0.3, -0.4, 0.2])
STEPPINGS = ("local", "global")


def moved(edges: tuple[float, float, float], way: tuple[float, float, float]) -> ConvexHull:
    return ConvexHull(Box(edges).vertices + np.array(way))


def advance(world: World, duration: float, stepping: str, steps: float = 200.0) -> None:
    if stepping == "local":
        world.run_locally(duration, steps)
    else:
        world.run(duration=duration)


def momenta(world: World) -> tuple[np.ndarray, np.ndarray]:
    """Linear momentum, and angular momentum about the origin."""
    linear = world.mass[:, None] * world.velocity
    return linear.sum(axis=0), (np.cross(world.position, linear) + world.angular_momentum).sum(axis=0)


def crooked(world: World, **motion: object) -> int:
    """Add a body whose centre of mass lies beside its centroid and whose axes are not principal ones."""
    parts = (Part(moved((1.2, 0.05, 0.05), (0.7, 0.2, 0.1)), LIGHT), Part(Sphere(0.1, (-0.3, 0.1, 0.2)), SMOOTH))
    return world.add_body(Box((0.4, 0.3, 0.2)), SMOOTH, parts=parts, **motion)


def test_two_cubes_are_the_box_that_they_make() -> None:
    world = World()
    halves = moved((0.2, 0.2, 0.2), (0.1, 0.0, 0.0)), moved((0.2, 0.2, 0.2), (-0.1, 0.0, 0.0))
    world.add_body(halves[0], SMOOTH, (0.0, 0.0, 0.0), parts=(Part(halves[1], SMOOTH),))
    world.add_body(Box((0.4, 0.2, 0.2)), SMOOTH, (5.0, 0.0, 0.0))
    joined, whole = world.bodies
    assert joined.mass == pytest.approx(whole.mass, rel=1e-14)
    assert joined.bounding_radius == pytest.approx(whole.bounding_radius, rel=1e-2)
    np.testing.assert_allclose(joined.centre_of_mass, 0.0, atol=1e-15)
    np.testing.assert_allclose(joined.inertia, whole.inertia, rtol=1e-13, atol=1e-15)


@pytest.mark.parametrize("stepping", STEPPINGS)
def test_two_cubes_rebound_from_a_floor_as_the_box_that_they_make(stepping: str) -> None:
    """A flat elastic impact turns the velocity round; nothing turns."""
    world = World()
    halves = moved((0.2, 0.2, 0.2), (0.1, 0.0, 0.0)), moved((0.2, 0.2, 0.2), (-0.1, 0.0, 0.0))
    world.add_body(halves[0], SMOOTH, (0.0, 0.0, 0.12), (0.0, 0.0, -0.5), parts=(Part(halves[1], SMOOTH),))
    world.add_body(Box((0.4, 0.2, 0.2)), SMOOTH, (5.0, 0.0, 0.12), (0.0, 0.0, -0.5))
    world.add_plane(*FLOOR, SMOOTH)
    advance(world, 0.1, stepping)
    np.testing.assert_allclose(world.velocity, [[0.0, 0.0, 0.5]] * 2, atol=2e-4)
    np.testing.assert_allclose(world.spin, 0.0, atol=1e-6)


@pytest.mark.parametrize("stepping", STEPPINGS)
def test_a_part_that_touches_nothing_changes_no_collision(stepping: str) -> None:
    """The same mass and inertia once as one part and once as two of which one lies within the other."""
    found = []
    for parts in ((), (Part(moved((0.1, 0.1, 0.1), (0.02, 0.0, 0.01)), ROUGH),)):
        world = World((0.0, 0.0, -1.0), 2e-5)
        world.add_body(Box((0.4, 0.3, 0.2)), ROUGH, (0.0, 0.0, 0.4), (0.3, 0.0, -0.5), SLANTED, (0.2, -0.1, 0.4),
            mass=10.0, inertia=np.diag([0.2, 0.3, 0.4]), centre_of_mass=(0.0, 0.0, 0.0), parts=parts)  # fmt: skip
        world.add_plane(*FLOOR, ROUGH)
        advance(world, 0.5, stepping, 50.0)
        found.append(np.concatenate([world.position[0], world.orientation[0], world.velocity[0], world.spin[0]]))
    np.testing.assert_allclose(found[0], found[1], rtol=1e-9, atol=1e-12)
    assert found[0][9] > -0.9  # it has met the floor


def test_a_centre_of_mass_given_at_the_centroid_changes_nothing() -> None:
    found = []
    for centre in (None, (0.0, 0.0, 0.0)):
        world = World((0.0, 0.0, -1.0))
        world.add_body(Box((0.4, 0.3, 0.2)), ROUGH, (0.0, 0.0, 0.4), (0.3, 0.0, -0.5), SLANTED, centre_of_mass=centre)
        world.add_plane(*FLOOR, ROUGH)
        world.run_locally(1.0, 25.0)
        found.append(np.concatenate([world.position[0], world.orientation[0], world.velocity[0]]))
    np.testing.assert_allclose(found[0], found[1], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("stepping", STEPPINGS)
@pytest.mark.parametrize("restitution", [1.0, 0.5])
def test_one_end_of_a_dumbbell_rebounds_as_an_impulse_at_its_arm(stepping: str, restitution: float) -> None:
    """An impulse j = (1 + e) m' v along the normal, with 1/m' = 1/m + (a x n) . W (a x n) at the arm a of the end."""
    stuff = Material(young_modulus=1e8, poisson_ratio=0.25, restitution=restitution, friction=0.0, density=2000.0)
    world, radius, half, tilt, speed = World(), 0.1, 0.5, 0.6, 0.3
    ends = Sphere(radius, (half, 0.0, 0.0)), Sphere(radius, (-half, 0.0, 0.0))
    turn = (np.cos(0.5 * tilt), 0.0, np.sin(0.5 * tilt), 0.0)
    height = radius + half * np.sin(tilt) + 1e-3
    world.add_body(ends[0], stuff, (0.0, 0.0, height), (0.0, 0.0, -speed), turn, parts=(Part(ends[1], stuff),))
    world.add_plane(*FLOOR, stuff)
    advance(world, 0.02, stepping, 400.0)
    mass, inertia = world.mass[0], world.mass[0] * (half**2 + 0.4 * radius**2)
    arm = half * np.cos(tilt)
    impulse = (1.0 + restitution) * speed / (1.0 / mass + arm**2 / inertia)
    np.testing.assert_allclose(world.velocity[0], [0.0, 0.0, -speed + impulse / mass], atol=2e-3 * speed)
    # A push up at +x turns +x up: about -y.
    np.testing.assert_allclose(world.spin[0], [0.0, -arm * impulse / inertia, 0.0], atol=4e-3 * speed)


@pytest.mark.parametrize("stepping", STEPPINGS)
@pytest.mark.parametrize("target", [Sphere(0.15), Box((0.3, 0.25, 0.2))])
def test_a_free_collision_keeps_momentum_and_energy(stepping: str, target: Sphere | Box) -> None:
    world = World()
    body = crooked(world, position=(0.0, 0.0, 0.0), orientation=SLANTED, spin=(0.3, 1.0, -0.5))
    aim = world.position[body] + np.array([0.3, 0.1, 0.8])
    world.add_body(target, SMOOTH, aim, (-0.3, -0.1, -0.9), SLANTED[::-1], (0.0, 0.4, 0.2))
    before, energy = momenta(world), world.energy()["total"]
    advance(world, 1.0, stepping)
    after = momenta(world)
    assert np.linalg.norm(world.velocity[body]) > 0.01  # they have met
    np.testing.assert_allclose(after[0], before[0], atol=1e-9)
    np.testing.assert_allclose(after[1], before[1], atol=1e-7)
    assert world.energy()["total"] == pytest.approx(energy, rel=2e-3)


@pytest.mark.parametrize("stepping", STEPPINGS)
def test_a_free_body_precesses_as_euler_says(stepping: str) -> None:
    """Attitude and spin against the closed form of a body whose inertia is far from diagonal in its own axes."""
    world, spin, time = World(time_step=2e-3), (0.5, 1.5, -1.0), 10.0
    crooked(world, position=(0.0, 0.0, 0.0), orientation=SLANTED, spin=spin)
    inertia = world.bodies[0].inertia
    assert np.abs(inertia[0, 1]) > 0.05 * inertia[0, 0]
    advance(world, time, stepping)
    attitude, turned = tumble(inertia, SLANTED[None], np.array([spin]), np.array([time]))
    assert abs(float(np.dot(attitude[0], world.orientation[0]))) == pytest.approx(1.0, abs=2e-4)
    np.testing.assert_allclose(world.spin[0], turned[0], atol=2e-2)


def test_a_foot_on_the_ground_carries_by_the_law_of_the_lever() -> None:
    """A box on its lower edge and a foot out on a strut: both forces from the balance about the other contact."""
    world = World((0.0, 0.0, -1.0))
    foot = Part(moved((0.1, 0.1, 0.04), (0.8, 0.0, -0.14)), ROUGH)
    body = world.add_body(Box((0.2, 0.2, 0.2)), ROUGH, (0.0, 0.0, 0.17), parts=(foot,))
    world.add_plane(*FLOOR, ROUGH)
    world.drag = 2.0
    world.run(duration=8.0)
    assert np.linalg.norm(world.velocity[body]) < 1e-6
    contacts = world.contacts()
    by_part = {int(one["part_a"]): one for one in contacts}
    assert set(by_part) == {0, 1}
    weight, middle = float(world.mass[body]), world.position[body, 0]
    arms = {part: float(one["point"][0] - middle) for part, one in by_part.items()}
    for part, other in ((0, 1), (1, 0)):
        share = arms[other] / (arms[other] - arms[part])
        assert by_part[part]["normal_force"] == pytest.approx(share * weight, rel=1e-3)


def test_parts_of_one_body_do_not_touch_each_other() -> None:
    world = World()
    world.add_body(Box((1.0, 1.0, 1.0)), ROUGH, (0.0, 0.0, 0.0), parts=(Part(Box((0.5, 2.0, 0.5)), ROUGH),))
    world.run_locally(1.0, 25.0)
    assert len(world.contacts()) == 0
    np.testing.assert_array_equal(world.velocity, 0.0)


def falling(stepping: str, shift: float = 0.0, threads: int = 1, duration: float = 1.2) -> World:
    """A crooked body that falls among blocks on ground that repeats after 4 m."""
    world = World((0.0, 0.0, -1.0), period=(4.0, 4.0))
    world.thread_count = threads
    for k, (x, y) in enumerate([(-1.0, 0.3), (0.2, 0.1), (1.1, -0.4), (1.8, 0.2)]):
        world.add_body(Box((0.5, 0.4, 0.3)), ROUGH, (x, y, 0.16), orientation=(1.0, 0.0, 0.0, 0.1 * k))
    crooked(world, position=(1.6 + shift, 0.1, 1.1), velocity=(0.3, 0.0, -0.5), orientation=SLANTED)
    world.add_plane(*FLOOR, ROUGH)
    advance(world, duration, stepping, 50.0)
    return world


@pytest.fixture(scope="module")
def fallen() -> dict[str, World]:
    """The world after the fall, by either way of stepping; nobody goes on with it."""
    return {stepping: falling(stepping) for stepping in STEPPINGS}


def test_what_happens_in_one_period_happens_in_the_next(fallen: dict[str, World]) -> None:
    here, there = fallen["local"], falling("local", shift=4.0)
    np.testing.assert_allclose(there.position[4] - here.position[4], [4.0, 0.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(there.velocity, here.velocity, atol=1e-5)


def test_both_ways_of_stepping_agree(fallen: dict[str, World]) -> None:
    """Over the first collisions, after which small differences grow."""
    one, other = fallen["local"], fallen["global"]
    np.testing.assert_allclose(one.position[4], other.position[4], atol=5e-3)


def test_threads_and_repetition_give_the_same_bits(fallen: dict[str, World]) -> None:
    """Threads over the first collision alone: they wait for one another in every step."""
    pairs = (
        (falling("global", duration=0.7), falling("global", duration=0.7, threads=2)),
        (fallen["local"], falling("local")),
    )
    assert pairs[0][0].kinetic_energy[:4].max() > 0.0
    for one, other in pairs:
        np.testing.assert_array_equal(one.position, other.position)
        np.testing.assert_array_equal(one.orientation, other.orientation)


def test_a_period_is_longer_than_a_boom_reaches() -> None:
    world = World(period=(2.0, 2.0))
    crooked(world, position=(0.0, 0.0, 0.0))
    world.add_body(Sphere(0.1), SMOOTH, (0.0, 0.0, 3.0))
    with pytest.raises(ValueError, match="two largest bodies"):
        world.contacts()


def test_a_world_with_parts_goes_on_from_its_file(fallen: dict[str, World], tmp_path) -> None:
    world = copy.deepcopy(fallen["global"])
    world.save(tmp_path / "world.h5")
    back = World.load(tmp_path / "world.h5")
    for one in (world, back):
        one.run(steps=200)
    np.testing.assert_array_equal(back.position, world.position)
    np.testing.assert_array_equal(back.angular_momentum, world.angular_momentum)
