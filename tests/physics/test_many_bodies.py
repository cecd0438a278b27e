"""Conservation, similarity, invariance, determinism: what holds for any number of bodies."""

import math

import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Material, Sphere, World


def material(**changes):
    values = {"young_modulus": 1e7, "poisson_ratio": 0.25, "restitution": 0.6, "friction": 0.5, "density": 2500.0}
    return Material(**{**values, **changes})


STRAIGHT = np.eye(3)


def heap(length=1.0, time=1.0, stress=1.0, order=None, turn=STRAIGHT, young_modulus=1e7):
    """Twelve hulls, boxes and spheres thrown together in a pit, in units scaled as asked."""
    generator = np.random.default_rng(5)
    density = stress * time**2 / length**2
    stuff = material(young_modulus=young_modulus * stress, density=2500.0 * density)
    world = World(tuple(turn @ np.array([0, 0, -9.81]) * length / time**2), 1e-4 * time)
    rows = []
    for k in range(12):
        cloud = generator.normal(size=(12, 3)) * 0.05
        shape = (ConvexHull(cloud * length), Box((0.1 * length, 0.12 * length, 0.08 * length)), Sphere(0.05 * length))[
            k % 3
        ]
        place = np.array([(k % 2) * 0.24, (k // 2 % 2) * 0.24, 0.15 + 0.25 * (k // 4)]) + 0.005 * generator.normal(
            size=3
        )
        rows.append((shape, turn @ place * length, turn @ generator.normal(size=3) * 0.3 * length / time))
    for k in order if order is not None else range(12):
        shape, place, velocity = rows[k]
        quaternion = (math.sqrt(0.5), 0, 0, math.sqrt(0.5)) if turn[0, 1] else (1, 0, 0, 0)
        world.add_body(shape, stuff, place, velocity=velocity, orientation=quaternion)
    world.add_plane((0, 0, 0), tuple(turn @ np.array([0, 0, 1.0])), stuff)
    for side in ((1, 0, 1), (-1, 0, 1), (0, 1, 1), (0, -1, 1)):
        world.add_plane(tuple(turn @ np.array([0.12, 0.12, -0.2]) * length), tuple(turn @ np.array(side)), stuff)
    return world


def again(world, order=range(12), turn=STRAIGHT):
    """A new world in the state of another, renumbered or turned by a quarter about z."""
    new = World(tuple(turn @ world.gravity), world.time_step)
    half = math.sqrt(0.5)
    for k in order:
        body, (w, x, y, z) = world.bodies[k], world.orientation[k]
        turned = (half * (w - z), half * (x - y), half * (y + x), half * (z + w))
        new.add_body(body.shape, body.material, turn @ world.position[k], turn @ world.velocity[k],
            turned if turn[0, 1] else (w, x, y, z), turn @ world.spin[k])  # fmt: skip
    for plane in world.planes:
        new.add_plane(turn @ plane.point, turn @ plane.normal, plane.material)
    return new


def test_same_input_same_bits():
    states, met = [], set()
    for _ in range(2):
        world = heap()
        for _ in range(30):
            world.run(steps=100)
            met |= {(int(c["body_a"]), int(c["body_b"])) for c in world.contacts()}
        states.append((world.position, world.velocity, world.orientation, world.angular_momentum))
    assert all(np.array_equal(a, b) for a, b in zip(*states, strict=True))
    assert sum(b >= 0 for _, b in met) >= 3


def on_threads(count):
    """A heap on so many threads, then on one and again on as many, with drag at first and lists renewed."""
    world = heap()
    world.drag = 1.0
    world.thread_count = count
    for k in range(4):
        world.run(steps=600)
        world.drag = 0.0
        world.thread_count = count if k == 1 else 1
    return world


@pytest.fixture(scope="module")
def alone():
    return on_threads(1)


@pytest.mark.parametrize("count", [2, 3])
def test_threads_change_no_bit(count, alone):
    """On one, two or three threads, changed on the way."""
    shared = on_threads(count)
    assert len(alone.contacts()) >= 3
    assert alone.energy()["damping"] > 0.0
    assert alone.energy() == shared.energy()
    for name in ("position", "velocity", "orientation", "angular_momentum", "contact_force", "contact_torque"):
        assert np.array_equal(getattr(alone, name), getattr(shared, name))
    assert np.array_equal(alone.contacts(), shared.contacts())


@pytest.fixture(scope="module")
def plain():
    """The heap in its own units; nobody goes on with it."""
    world = heap()
    world.run(steps=3000)
    return world


@pytest.mark.parametrize(
    ("length", "time", "stress"),
    [(1.0, 0.25, 16.0), (1.0, 4.0, 1 / 16), (4.0, 1.0, 16.0), (0.5, 1.0, 0.25), (1.0, 1.0, 8.0)],
)
def test_dynamic_similarity_to_the_last_bit(length, time, stress, plain):
    """Scaled by powers of two in length, time and stress (density follows), every number scales exactly."""
    scaled = heap(length, time, stress)
    scaled.run(steps=3000)
    assert plain.energy()["friction"] > 0.0
    assert np.array_equal(plain.position * length, scaled.position)
    assert np.array_equal(plain.velocity * length / time, scaled.velocity)
    assert np.array_equal(plain.orientation, scaled.orientation)


def test_energy_ledger_closes():
    world = heap()
    start = world.energy()
    for _ in range(10):
        world.run(steps=1000)
        now = world.energy()
        assert abs(now["total"] - start["total"]) < 1e-3 * (start["kinetic"] + start["potential"])
    assert now["damping"] > 0.0
    assert now["friction"] > 0.0


def test_closed_system_keeps_momentum_and_angular_momentum():
    generator = np.random.default_rng(2)
    world = World(time_step=1e-4)
    for k in range(8):
        place = 0.15 * np.array([k % 2, k // 2 % 2, k // 4]) - 0.075
        world.add_body(ConvexHull(generator.normal(size=(14, 3)) * 0.05), material(), place, velocity=-3.0 * place)

    def totals():
        momentum = world.mass[:, None] * world.velocity
        turning = world.angular_momentum + np.cross(world.position, momentum)
        reach = np.linalg.norm(world.position, axis=1) * np.linalg.norm(momentum, axis=1)
        return momentum.sum(axis=0), turning.sum(axis=0), np.abs(momentum).sum(), reach.sum()

    before = totals()
    world.run(steps=5000)
    after = totals()
    assert world.energy()["damping"] > 0.0
    assert np.abs(after[0] - before[0]).max() < 1e-12 * before[2]
    assert np.abs(after[1] - before[1]).max() < 1e-12 * after[3]


ORDER, QUARTER = np.random.default_rng(0).permutation(12), np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])


@pytest.mark.parametrize(("order", "turn"), [(ORDER, STRAIGHT), (range(12), QUARTER)], ids=["renumbered", "turned"])
def test_renumbering_and_turning_change_round_off_only(order, turn):
    fallen = heap()
    fallen.run(steps=3500)
    plain, other = again(fallen), again(fallen, order, turn)
    for world in (plain, other):
        assert len(world.contacts()) >= 3
        world.run(steps=200)
    assert np.abs(plain.position - fallen.position).max() > 1e-4
    assert np.abs(plain.position[order] @ turn.T - other.position).max() < 1e-10


def test_checkpoint_continues_bit_for_bit(tmp_path):
    world = heap()
    world.run(steps=1500)
    world.save(tmp_path / "world.h5")
    other = World.load(tmp_path / "world.h5")
    for one in (world, other):
        one.run(steps=700)
    assert np.array_equal(world.position, other.position)
    assert np.array_equal(world.angular_momentum, other.angular_momentum)
    assert world.energy() == other.energy()


def test_free_rotation_keeps_angular_momentum_and_energy():
    """Moments of inertia 1, 2, 3 kg m2; 1e5 steps; both to 1e-6."""
    world = World(time_step=1e-3)
    world.add_body(Sphere(1.0), material(), (0, 0, 0), spin=(1.0, 1.0, 0.1), mass=1.0, inertia=np.diag([1.0, 2.0, 3.0]))
    momentum, kinetic = world.angular_momentum[0], world.energy()["kinetic"]
    world.run(steps=100_000)
    assert np.abs(world.angular_momentum[0] - momentum).max() <= 1e-12
    assert world.energy()["kinetic"] == pytest.approx(kinetic, rel=1e-6)
    assert np.linalg.norm(world.orientation[0]) == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize(("ball", "floor", "stands"), [
    (0.5, 0.0893 * 1.05, True), (0.5, 0.0893 * 0.95, False), (0.2679 * 1.05, 0.5, True), (0.2679 * 0.95, 0.5, False),
])  # fmt: skip
def test_pyramid_of_three_spheres(ball, floor, stands):
    """Two on the floor, one on top: it stands if mu_floor >= 0.0893 and mu_sphere >= 0.2679."""
    world = World((0, 0, -9.81), 2e-5)
    stuff, ground = (material(friction=friction, young_modulus=1e9) for friction in (ball, floor))
    radius = 0.05
    for x, z in ((-radius, radius), (radius, radius), (0.0, radius * (1 + math.sqrt(3)))):
        world.add_body(Sphere(radius), stuff, (x, 0, z))
    world.add_plane((0, 0, 0), (0, 0, 1), ground)
    world.run(duration=0.6)
    assert (world.position[2, 2] > 2.6 * radius) == stands


def test_renewing_every_list_in_every_step_changes_no_bit():
    """Only names of features are kept from step to step: soft grains, so that overlaps reach past the rounding."""
    worlds = []
    for renewing in (False, True):
        world = heap(young_modulus=1e5)
        for _ in range(1500):
            world.run(steps=1)
            if renewing:
                world._state.engine.pairs.wake[:] = 0.0
        worlds.append(world)
    assert np.array_equal(worlds[0].position, worlds[1].position)
    assert np.array_equal(worlds[0].angular_momentum, worlds[1].angular_momentum)
    assert worlds[0].energy()["friction"] > 0.0


@pytest.fixture(scope="module")
def usual():
    """The heap with the skin that it has; nobody goes on with it."""
    world = heap()
    world.run(0.4)
    return world


@pytest.mark.parametrize("skin", [0.02, 1.0, 8.0])
def test_skin_of_the_neighbour_list_changes_no_bit(monkeypatch, skin, usual):
    """From lists that are renewed in every few steps to one that holds all pairs of hulls, boxes and spheres."""
    monkeypatch.setattr("lithobrake.dem.stepping.engine.SKIN", skin)
    other = heap()
    other.run(0.4)
    assert usual.energy()["friction"] > 0.0
    assert len(other._state.engine.pairs.first) != len(usual._state.engine.pairs.first)
    for name in ("position", "orientation", "velocity", "angular_momentum"):
        assert np.array_equal(getattr(usual, name), getattr(other, name))
    assert usual.energy() == pytest.approx(other.energy(), rel=1e-12)
