"""Motion in a frame that turns: against the inertial frame, closed forms, and the energy that it keeps."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from lithobrake.dem import Box, Material, Sphere, World
from lithobrake.vocabulary.field_errors import FieldError

ROCK = Material(density=2500.0, young_modulus=2e6, poisson_ratio=0.25, restitution=0.7, friction=0.0)
# About that of Dimorphos, askew, and its gravity.
ROTATION, GRAVITY = np.array([0.4e-4, -0.7e-4, 1.2e-4]), np.array([1e-5, 0.5e-5, -5e-5])
DAY = 86_400.0


def turning_world(rotation: np.ndarray = ROTATION, gravity: np.ndarray = GRAVITY) -> World:
    world = World(gravity)
    world.rotation = rotation
    return world


def stars_from_frame(time: float, rotation: np.ndarray = ROTATION) -> np.ndarray:
    """The rotation matrix, [3, 3], from the frame to the axes that do not turn."""
    return Rotation.from_rotvec(rotation * time).as_matrix()


def test_a_free_body_moves_as_in_the_inertial_frame() -> None:
    world = turning_world()
    start, velocity = np.array([3.0, -1.0, 2.0]), np.array([0.02, -0.03, 0.05])
    # Large, so that the neighbour list serves long: a day in millions of pieces would add up their roundings.
    ball = world.add_body(Sphere(100.0), ROCK, tuple(start), tuple(velocity), spin=(1e-5, -2e-5, 3e-5))
    momentum = world.motion_of(ball).angular_momentum + world.bodies[ball].inertia @ ROTATION
    world.run_locally(DAY, 25.0)

    # There, what keeps gravity uniform in the frame is a pull toward its axis beside gravity, which turns.
    def pulls(time: float, state: np.ndarray) -> np.ndarray:
        pull = np.cross(ROTATION, np.cross(ROTATION, state[:3]))
        return np.concatenate([state[3:], stars_from_frame(time) @ GRAVITY + pull])

    begin = np.concatenate([start, velocity + np.cross(ROTATION, start)])
    exact = solve_ivp(pulls, (0.0, DAY), begin, method="DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    back = stars_from_frame(DAY).T
    position = back @ exact[:3]
    found = world.motion_of(ball)
    assert np.linalg.norm(found.position - position) < 1e-12 * np.linalg.norm(position)
    velocity = found.velocity + np.cross(ROTATION, found.position)
    assert np.linalg.norm(velocity - back @ exact[3:]) < 1e-12 * np.linalg.norm(exact[3:])
    # Nothing turns it against the stars.
    kept = stars_from_frame(DAY) @ (found.angular_momentum + world.bodies[ball].inertia @ ROTATION)
    assert np.linalg.norm(kept - momentum) < 1e-12 * np.linalg.norm(momentum)
    turned = Rotation.from_rotvec((np.array([1e-5, -2e-5, 3e-5]) + ROTATION) * DAY)
    against = Rotation.from_rotvec(-ROTATION * DAY) * turned
    assert (against.inv() * Rotation.from_quat(found.orientation, scalar_first=True)).magnitude() < 1e-6


@pytest.mark.parametrize("common", [False, True])
def test_a_tumbling_body_keeps_its_jacobi_energy_and_its_momentum_among_the_stars(common: bool) -> None:
    rotation = 1000.0 * ROTATION
    world = turning_world(rotation)
    box = world.add_body(Box((0.1, 0.2, 0.3)), ROCK, (0.0, 0.0, 0.0), (0.02, 0.05, 0.1), spin=(0.2, -0.1, 0.3))
    inertia = world.bodies[box].inertia

    def kept() -> tuple[float, np.ndarray]:
        motion = world.motion_of(box)
        turn = Rotation.from_quat(motion.orientation, scalar_first=True).as_matrix()
        by_frame = turn @ inertia @ turn.T @ rotation
        energy = motion.kinetic_energy - motion.mass * GRAVITY @ motion.position - 0.5 * rotation @ by_frame
        momentum = stars_from_frame(world.time, rotation) @ (motion.angular_momentum + by_frame)
        return energy, momentum

    energy, momentum = kept()
    turned = 0.5 * np.dot(world.spin[box], world.angular_momentum[box])
    for _ in range(20):
        if common:
            world.time_step = 0.01
            world.run(steps=300)
        else:
            world.run_locally(3.0, 25.0)
        now, momentum_now = kept()
        assert now == pytest.approx(energy, abs=2e-3 * turned)
        assert np.linalg.norm(momentum_now - momentum) < 1e-9 * np.linalg.norm(momentum)


def test_a_hop_is_bent_as_theory_says() -> None:
    # Thrown up at v in a field g, a body drifts by 4/3 w v^3 / g^2 against the turn, where w is small and level.
    rate, gravity, speed = 1e-7, 5e-5, 0.015
    world = turning_world(np.array([0.0, rate, 0.0]), np.array([0.0, 0.0, -gravity]))
    ball = world.add_body(Sphere(0.05), ROCK, (0.0, 0.0, 0.0), (0.0, 0.0, speed))
    world.run_locally(2.0 * speed / gravity, 25.0)
    assert world.position[ball, 0] == pytest.approx(-4.0 / 3.0 * rate * speed**3 / gravity**2, rel=1e-3)


def test_a_bouncing_ball_drifts_as_theory_says() -> None:
    """On a smooth plane a ball keeps its horizontal velocity: between bounces the closed form of each hop holds."""
    rotation, gravity = np.array([2e-4, 9e-4, 4e-4]), 1e-3
    world = turning_world(rotation, np.array([0.0, 0.0, -gravity]))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROCK)
    ball = world.add_body(Sphere(0.05), ROCK, (0.0, 0.0, 0.05), (0.004, 0.0, 0.02))
    twice = 2.0 * rotation

    def moving(time: float, state: np.ndarray) -> np.ndarray:
        return np.concatenate([state[3:], np.array([0.0, 0.0, -gravity]) - np.cross(twice, state[3:])])

    def lands(time: float, state: np.ndarray) -> float:
        return float(state[2])

    lands.terminal, lands.direction = True, -1  # type: ignore[attr-defined]
    time, state = 0.0, np.array([0.0, 0.0, 0.0, 0.004, 0.0, 0.02])
    for _ in range(3):
        hop = solve_ivp(moving, (0.0, 1e3), state, events=lands, rtol=1e-11, atol=1e-13)
        time, state = time + hop.t[-1], hop.y[:, -1]
        state[2], state[5] = 0.0, -0.7 * state[5]
    world.run_locally(time, 100.0)
    way = world.position[ball, :2]
    straight = 0.004 * time
    assert np.linalg.norm(state[:2] - [straight, 0.0]) > 0.015
    # A collision lasts half a second of a hop of twenty to fifty.
    assert np.linalg.norm(way - state[:2]) < 0.02 * np.linalg.norm(state[:2] - [straight, 0.0])


@pytest.mark.parametrize("shape", [Sphere(0.1), Box((0.1, 0.1, 0.227))], ids=["ball", "box"])
def test_the_ledger_of_a_bouncing_body_closes_as_in_a_frame_that_does_not_turn(shape: Sphere | Box) -> None:
    def lacking(rotation: np.ndarray) -> float:
        world, rough = turning_world(rotation, np.array([0.0, 0.0, -5e-5])), replace(ROCK, friction=0.5)
        world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), rough)
        world.add_body(shape, rough, (0.0, 0.0, 0.25), (0.03, 0.01, -0.04), spin=(0.1, 0.2, 0.05))
        before, found = world.energy()["total"], []
        for _ in range(20):
            world.run_locally(10.0, 25.0)
            found.append(world.energy()["total"])
        return float(np.abs(np.array(found) / before - 1.0).max())

    # 2 w v is some ten times the weight at 0.04 m/s, and does no work.
    assert lacking(40.0 * ROTATION) < 1.1 * lacking(np.zeros(3)) + 1e-4 < 0.006


def test_what_rests_stays_at_rest() -> None:
    # No Coriolis force acts on it, and gravity at the place is that of the frame: it presses on the plane alone.
    gravity = np.array([0.0, 0.0, -5e-5])
    world = turning_world(ROTATION, gravity)
    rough = Material(density=2500.0, young_modulus=2e5, poisson_ratio=0.25, restitution=0.5, friction=0.6)
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), rough)
    box = world.add_body(Box((0.1, 0.1, 0.2)), rough, (0.0, 0.0, 0.1), (0.0, 0.0, -1e-4))
    world.run_locally(600.0, 25.0)
    place = world.position[box].copy()
    world.run_locally(3600.0, 25.0)
    assert np.linalg.norm(world.position[box] - place) < 1e-6
    assert np.linalg.norm(world.velocity[box]) < 1e-8


def test_a_frame_that_does_not_turn_changes_no_bit() -> None:
    ends = []
    for rotation in (None, np.zeros(3)):
        world = World((0.0, 0.0, -1e-3))
        if rotation is not None:
            world.rotation = rotation
        world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROCK)
        world.add_body(Box((0.1, 0.1, 0.2)), ROCK, (0.0, 0.0, 0.2), (0.01, 0.0, -0.02), spin=(0.1, 0.2, 0.3))
        world.run_locally(30.0, 25.0)
        ends.append(world.position.tobytes() + world.orientation.tobytes())
    assert ends[0] == ends[1]


def test_a_turning_frame_is_kept_on_disk(tmp_path: pytest.TempPathFactory) -> None:
    world = turning_world()
    world.add_body(Sphere(0.1), ROCK, (0.0, 0.0, 0.0))
    world.save(tmp_path / "world.h5")  # type: ignore[operator]
    assert World.load(tmp_path / "world.h5").rotation.tolist() == ROTATION.tolist()  # type: ignore[operator]


@pytest.mark.parametrize("value", [(math.nan, 0.0, 0.0), (1.0, 2.0), "fast"])
def test_a_rotation_is_three_finite_numbers(value: object) -> None:
    with pytest.raises(FieldError, match=r"World\.rotation"):
        World().rotation = value  # type: ignore[assignment]


@pytest.mark.parametrize("common", [False, True])
def test_drag_and_a_turning_frame_exclude_each_other(common: bool) -> None:
    world = turning_world()
    world.add_body(Sphere(0.1), ROCK, (0.0, 0.0, 0.0))
    world.drag = 0.1
    with pytest.raises(FieldError, match=r"World\.drag is 0\.1 1/s"):
        world.run(steps=1) if common else world.run_locally(1.0, 25.0)
