"""Contacts at steps of their own, and slow ones: the same laws, and momentum kept to the last bits."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Material, Sphere, World
from lithobrake.dem.local_stepping import local_engine
from lithobrake.dem.stepping.time_step_stability import Clock

ROCK = {"young_modulus": 1e7, "poisson_ratio": 0.25, "density": 2500.0}


def rock(restitution: float, friction: float) -> Material:
    return Material(**ROCK, restitution=restitution, friction=friction)


def cluster(material: Material, count: int = 12, gravity: float = 0.0) -> World:
    """Rounded rocks that fly toward the middle of an empty space, and turn."""
    generator = np.random.default_rng(7)
    world = World(gravity=(0.0, 0.0, -gravity))
    places = 0.16 * np.array([(i, j, k) for i in range(3) for j in range(2) for k in range(2)])[:count]
    for place in places - places.mean(axis=0):
        hull = ConvexHull(0.05 * generator.normal(size=(14, 3)))
        turn = generator.normal(size=4)
        world.add_body(hull, material, place, -0.5 * place, tuple(turn), tuple(generator.normal(size=3)))
    return world


def momenta(world: World) -> tuple[np.ndarray, np.ndarray]:
    """Sum of the momenta, and of the angular momenta about the origin."""
    linear = world.mass[:, None] * world.velocity
    return linear.sum(axis=0), (np.cross(world.position, linear) + world.angular_momentum).sum(axis=0)


@pytest.mark.parametrize("restitution", [0.3, 0.5, 0.8, 1.0])
@pytest.mark.parametrize(("steps", "error"), [(15.0, 0.01), (40.0, 0.004)])
def test_spheres_bounce_with_their_restitution(restitution: float, steps: float, error: float) -> None:
    world = World()
    world.add_body(Sphere(0.05), rock(restitution, 0.5), (0.0, 0.0, 0.0))
    world.add_body(Sphere(0.05), rock(restitution, 0.5), (0.11, 0.0, 0.0), (-0.2, 0.0, 0.0))
    world.run_locally(0.3, steps)
    speed = world.velocity[1, 0] - world.velocity[0, 0]
    assert speed / 0.2 == pytest.approx(restitution, abs=error)


def test_momentum_stays_and_angular_momentum_to_the_third_order_of_steps() -> None:
    lost = []
    for steps in (15.0, 60.0):
        world = cluster(rock(0.6, 0.5))
        before, scale = momenta(world), float((world.mass * np.linalg.norm(world.velocity, axis=1)).sum())
        world.run_locally(3.0, steps)
        assert world.energy()["friction"] > 0.0
        linear, angular = momenta(world)
        assert np.abs(linear - before[0]).max() < 1e-13 * scale
        lost.append(float(np.abs(angular - before[1]).max()) / scale)
    # A steady force keeps its arms while other contacts turn the bodies.
    assert lost[0] < 1e-8
    assert lost[1] < lost[0] / 16.0


def laid(shape: Box | Sphere, height: float, gravity: float) -> World:
    """A body laid down on a plane, without overlap."""
    world = World(gravity=(0.0, 0.0, -gravity))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), rock(0.5, 0.5))
    world.add_body(shape, rock(0.5, 0.5), (0.0, 0.0, height))
    return world


@pytest.mark.parametrize(("gravity", "time"), [(1.0, 2.0), (5e-5, 60.0)])
@pytest.mark.parametrize(("shape", "height"), [(Box((0.1, 0.12, 0.08)), 0.04), (Sphere(0.05), 0.05)])
def test_what_is_laid_down_comes_to_rest(shape: Box | Sphere, height: float, gravity: float, time: float) -> None:
    world = laid(shape, height, gravity)
    world.run_locally(time, 25.0)
    sunk = height - world.position[0, 2]
    # Of the speed with which it would fall through its overlap.
    assert np.linalg.norm(world.velocity[0]) < 1e-9 * (2.0 * gravity * sunk) ** 0.5
    assert world.contacts()["normal_force"].sum() == pytest.approx(world.mass[0] * gravity, rel=1e-9)


def test_a_peg_on_a_box_comes_to_rest() -> None:
    world = laid(Box((0.05, 0.05, 0.05)), 0.025, 9.81)
    world.add_body(Box((0.096, 0.02, 0.02)), rock(0.5, 0.5), (0.0, 0.0, 0.0601))
    world.run_locally(2.0, 25.0)
    assert np.linalg.norm(world.velocity, axis=1).max() < 1e-12


@pytest.mark.parametrize("radius", [0.02, 0.005])
def test_a_heavy_plate_on_a_light_grain_makes_no_energy(radius: float) -> None:
    hard = Material(young_modulus=1e10, poisson_ratio=0.25, density=2500.0, restitution=0.5, friction=0.5)
    world = World(gravity=(0.0, 0.0, -1.0))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), hard)
    world.add_body(Sphere(radius), hard, (0.0, 0.0, radius))
    world.add_body(Box((1.0, 1.0, 0.1)), hard, (0.0, 0.0, 2.0 * radius + 0.0501), (0.0, 0.0, -0.1))
    before, impact = world.energy()["total"], 0.5 * world.mass[1] * 0.01
    for _ in range(20):
        world.run_locally(0.01, 25.0)
        assert world.energy()["total"] - before == pytest.approx(0.0, abs=3e-3 * impact)


def test_the_ledger_of_a_box_on_a_layer_of_grains_closes_to_the_second_order_of_the_steps() -> None:
    soil = Material(young_modulus=2e6, poisson_ratio=0.25, density=2500.0, restitution=0.5, friction=0.5)
    lacking = []
    for steps in (25.0, 100.0):
        world = World(gravity=(0.0, 0.0, -5e-5))
        world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), soil)
        for x, y in np.ndindex(5, 5):
            world.add_body(Sphere(0.05), soil, (0.101 * (x - 2), 0.101 * (y - 2), 0.05))
        # 12 kg, on nine grains askew.
        box = replace(soil, density=12.0 / 0.3**3)
        number = world.add_body(Box((0.3, 0.3, 0.3)), box, (0.003, 0.002, 0.2501), (0.01, 0.0, -0.05))
        before, impact = world.energy()["total"], float(world.kinetic_energy[number])
        world.run_locally(0.3, steps)
        assert world.velocity[number, 2] > 0.02
        lacking.append(abs(world.energy()["total"] - before) / impact)
    assert lacking[0] < 0.01
    assert lacking[1] < 0.001


@pytest.mark.parametrize(("restitution", "friction"), [(1.0, 0.0), (0.6, 0.0), (0.6, 0.5)])
@pytest.mark.parametrize(("steps", "error"), [(15.0, 0.02), (60.0, 0.005)])
def test_the_ledger_of_energy_closes(restitution: float, friction: float, steps: float, error: float) -> None:
    world = cluster(rock(restitution, friction))
    before = world.energy()["total"]
    for _ in range(4):
        world.run_locally(1.0, steps)
        assert world.energy()["total"] == pytest.approx(before, rel=error)


def test_free_fall_is_exact_however_long_it_is() -> None:
    world = World(gravity=(0.0, 0.0, -1e-3))
    world.add_body(Box((0.1, 0.1, 0.2)), rock(0.5, 0.5), (0.0, 0.0, 10.0), (0.1, 0.0, 0.02), spin=(0.1, 0.02, 0.3))
    world.add_body(Sphere(0.1), rock(0.5, 0.5), (50.0, 0.0, 0.0))
    kinetic = float(world.kinetic_energy[0]) - 0.5 * world.mass[0] * float(world.velocity[0] @ world.velocity[0])
    world.run_locally(100.0, 15.0)
    assert world.position[0] == pytest.approx((10.0, 0.0, 10.0 + 2.0 - 5.0), abs=1e-12)
    assert world.velocity[0] == pytest.approx((0.1, 0.0, 0.02 - 0.1), abs=1e-14)
    moving = 0.5 * world.mass[0] * float(world.velocity[0] @ world.velocity[0])
    assert float(world.kinetic_energy[0]) - moving == pytest.approx(kinetic, rel=1e-3)


def test_a_sliding_ball_comes_to_roll_at_five_sevenths_of_its_speed() -> None:
    world = World(gravity=(0.0, 0.0, -1.0))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), rock(0.3, 0.4))
    world.add_body(Sphere(0.05), rock(0.3, 0.4), (0.0, 0.0, 0.05), (0.5, 0.0, 0.0))
    world.run_locally(2.0, 15.0)
    assert world.velocity[0, 0] == pytest.approx(5.0 / 7.0 * 0.5, rel=2e-3)
    assert world.spin[0, 1] * 0.05 == pytest.approx(world.velocity[0, 0], rel=2e-3)


def test_drag_slows_as_it_should_and_is_booked() -> None:
    world = World(gravity=(0.0, 0.0, -0.1))
    world.add_body(Sphere(0.1), rock(0.5, 0.5), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
    world.add_body(Sphere(0.1), rock(0.5, 0.5), (50.0, 0.0, 0.0))
    world.drag = 0.5
    world.run_locally(2.0, 15.0)
    kept = math.exp(-1.0)
    assert world.velocity[0] == pytest.approx((kept, 0.0, -0.2 * (1.0 - kept)), abs=1e-14)
    assert world.position[0, 0] == pytest.approx((1.0 - kept) / 0.5, abs=1e-14)


def test_contacts_go_on_at_common_steps_and_back(tmp_path: Path) -> None:
    world = cluster(rock(0.5, 0.5), gravity=0.5)
    world.add_plane((0.0, 0.0, -0.4), (0.0, 0.0, 1.0), rock(0.5, 0.5))
    world.run_locally(2.0, 15.0)
    touching = {(int(one["body_a"]), int(one["body_b"])) for one in world.contacts()}
    assert touching
    springs = np.abs(world.contacts()["tangential_force"]).max()
    world.save(tmp_path / "world.h5")
    assert {(int(one["body_a"]), int(one["body_b"])) for one in world.contacts()} == touching
    assert np.abs(world.contacts()["tangential_force"]).max() == pytest.approx(springs)
    total = world.energy()["total"]
    world.time_step = world.shortest_contact(0.5) / 50.0
    world.run(0.05)
    world.run_locally(0.05, 30.0)
    assert world.energy()["total"] == pytest.approx(total, rel=5e-3)
    again = World.load(tmp_path / "world.h5")
    again.run_locally(0.5, 15.0)
    assert np.isfinite(again.position).all()


def test_the_same_bits_each_time_and_with_slots_that_do_not_suffice(monkeypatch: pytest.MonkeyPatch) -> None:
    def ends() -> tuple[bytes, int]:
        world = cluster(rock(0.6, 0.5))
        world.run_locally(2.0, 15.0)
        return world.position.tobytes(), len(world._state.local.pairs.first)

    first, again = ends(), ends()
    assert first == again
    monkeypatch.setattr(local_engine, "SLOTS", 0)
    tight = ends()
    assert tight[1] < first[1]
    # Items keep their order when they get other slots, but for those that were listed meanwhile.
    assert np.frombuffer(tight[0]) == pytest.approx(np.frombuffer(first[0]), abs=0.05)


def test_all_that_touch_are_listed_and_few_besides() -> None:
    material, generator, shapes = rock(0.5, 0.5), np.random.default_rng(3), list[ConvexHull]()
    world, listed, meeting = World(gravity=(0.0, 0.0, -0.5)), 0, 0
    world.add_plane((0.0, 0.0, -0.3), (0.0, 0.0, 1.0), material)
    for place in 0.16 * np.array([(i, j, k) for i in range(3) for j in range(3) for k in range(3)]):
        shapes.append(ConvexHull(generator.uniform(0.3, 1.0, size=3) * 0.06 * generator.normal(size=(14, 3))))
        turn, spin = generator.normal(size=4), 8.0 * generator.normal(size=3)
        world.add_body(shapes[-1], material, place - 0.16, -2.0 * (place - 0.16), tuple(turn), tuple(spin))
    for _ in range(25):
        world.run_locally(0.05, 15.0)
        local = world._state.local
        pairs = {(int(a), int(b)) for a, b in zip(local.pairs.first, local.pairs.second, strict=True) if a >= 0}
        fresh = World()
        for shape, place, turn in zip(shapes, world.position, world.orientation, strict=True):
            fresh.add_body(shape, material, tuple(place), orientation=tuple(turn))
        assert {(int(one["body_a"]), int(one["body_b"])) for one in fresh.contacts()} <= pairs
        reach, between = [shape.bounding_radius for shape in shapes], world.position[:, None] - world.position
        meeting += int((np.linalg.norm(between, axis=2) < np.add.outer(reach, reach)).sum() - len(shapes)) // 2
        listed += sum(second >= 0 for _, second in pairs)
    # Of those whose bounding spheres meet, most are farther apart than the skin.
    assert listed < 0.4 * meeting


def test_a_watched_body_tells_how_long_it_was_touched() -> None:
    world = World()
    world.add_body(Sphere(0.05), rock(1.0, 0.0), (0.0, 0.0, 0.0))
    world.add_body(Sphere(0.05), rock(1.0, 0.0), (0.11, 0.0, 0.0), (-0.2, 0.0, 0.0))
    world.watch(0)
    world.run_locally(0.01, 40.0)
    assert world.touch_duration is None
    world.run_locally(0.3, 40.0)
    # Of 40 steps one may be missed at either end.
    assert world.touch_duration == pytest.approx(world.shortest_contact(0.2), rel=0.06)
    # Hertz: the deepest overlap has all of the energy of the reduced mass.
    reduced, stiffness = 0.5 * world.mass[0], 4.0 / 3.0 * (1e7 / (2.0 * (1.0 - 0.25**2))) * math.sqrt(0.025)
    deepest = (1.25 * reduced * 0.2**2 / stiffness) ** 0.4
    assert world.watched["peak_force"] == pytest.approx(stiffness * deepest**1.5, rel=0.01)


@pytest.mark.parametrize("stepping", ["global", "local"])
def test_both_steppings_give_the_instants_of_touch_in_seconds(stepping: str) -> None:
    world = World()
    world.add_body(Sphere(0.05), rock(1.0, 0.0), (0.0, 0.0, 0.0))
    world.add_body(Sphere(0.05), rock(1.0, 0.0), (0.11, 0.0, 0.0), (-0.2, 0.0, 0.0))
    world.watch(0)
    duration = world.shortest_contact(0.2)
    world.time_step = duration / 40.0

    def run(time: float) -> None:
        world.run(time) if stepping == "global" else world.run_locally(time, 40.0)

    run(0.01)
    assert math.isnan(world.watched["first_contact"])
    assert math.isnan(world.watched["last_contact"])
    assert world.first_touch is None
    run(0.2)
    # The gap of 0.01 m closes in 0.05 s; the first touch is noted up to a step after it, the last up to one before.
    assert 0.05 <= world.watched["first_contact"] <= 0.05 + 0.06 * duration
    assert world.watched["last_contact"] == pytest.approx(0.05 + duration, abs=0.06 * duration)
    assert world.first_touch == world.watched["first_contact"]
    assert world.touch_duration == pytest.approx(duration, rel=0.06)
    assert not world.is_touched


def test_what_cannot_be_run_is_refused() -> None:
    world = World()
    with pytest.raises(ValueError, match="no body to move"):
        world.run_locally(1.0, 15.0)
    world.add_body(Sphere(0.05), rock(1.0, 0.0), (0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match=r"duration is -1\.0 s"):
        world.run_locally(-1.0, 15.0)
    with pytest.raises(ValueError, match="steps_per_contact is 2; allowed is a finite value of at least 5"):
        world.run_locally(1.0, 2)
    with pytest.raises(ValueError, match="held_speed is nan m/s; allowed is a finite value of at least 0"):
        world.run_locally(1.0, 15.0, held_speed=math.nan)
    with pytest.raises(ValueError, match=r"held_speed is 0\.1 m/s; allowed is 0 while no body is watched: call watch"):
        world.run_locally(1.0, 15.0, held_speed=0.1)
    with pytest.raises(ValueError, match=r"calm_speed is -1\.0 m/s; allowed is a finite value of at least 0"):
        world.run_locally(1.0, 15.0, held_speed=0.1, calm_speed=-1.0)


@pytest.mark.parametrize("begun", [0.0, 0.6], ids=["before it moves", "on its way"])
def test_reading_a_world_changes_nothing_of_what_comes(begun: float) -> None:
    ends = []
    for reads in (False, True):
        world = cluster(rock(0.6, 0.5), gravity=0.1)
        world.add_plane((0.0, 0.0, -0.3), (0.0, 0.0, 1.0), rock(0.6, 0.5))
        if begun:
            world.run_locally(begun, 15.0)
        if reads:
            world.contact_force, world.contacts(), world.energy(), world.largest_step, world.motion_of(3)
        world.run_locally(1.0, 15.0)
        ends.append(world.position.tobytes() + world.orientation.tobytes())
    assert ends[0] == ends[1]


def test_one_body_is_read_as_among_all() -> None:
    world = cluster(rock(0.6, 0.5), gravity=0.1)
    world.watch(5)
    world.run_locally(0.7, 15.0)
    one = world.motion_of(5)
    for name in ("position", "velocity", "orientation", "angular_momentum", "spin"):
        assert np.array_equal(getattr(one, name), getattr(world, name)[5])
    assert one.kinetic_energy == pytest.approx(world.kinetic_energy[5], rel=1e-15)


def test_a_watched_body_tells_whether_anything_touches_it() -> None:
    world = World(gravity=(0.0, 0.0, -1.0))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), rock(0.3, 0.5))
    world.add_body(Sphere(0.05), rock(0.3, 0.5), (0.0, 0.0, 0.051))
    world.watch(0)
    touched = []
    for _ in range(60):
        world.run_locally(0.005, 15.0)
        touched.append(world.is_touched)
        assert world.is_touched == bool(world.contact_force[0].any())
    # It falls for 0.045 s, bounces, and comes to rest.
    assert not any(touched[:8])
    assert all(touched[-5:])


STONE = Material(young_modulus=1e7, poisson_ratio=0.25, density=2500.0, restitution=0.5, friction=0.5)
RADIUS, GRAVITY, STEPS = 0.05, 5e-5, 15.0
# Hertz: a ball on a plane sinks in until 4/3 E* sqrt(R) overlap^(3/2) bears its weight.
MODULUS = STONE.young_modulus / (2.0 * (1.0 - STONE.poisson_ratio**2))
WEIGHT = STONE.density * 4.0 / 3.0 * math.pi * RADIUS**3 * GRAVITY
SUNK = (0.75 * WEIGHT / (MODULUS * math.sqrt(RADIUS))) ** (2.0 / 3.0)
# One less than the radius by its last bit.
BY_ROUNDING = math.nextafter(RADIUS, 0.0)


def balls_over_ground(*heights: float, upward: float = 0.0) -> World:
    """Balls one above the other, with their centres at heights [m] over a plane; the last goes up at a speed [m/s]."""
    world = World(gravity=(0.0, 0.0, -GRAVITY))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), STONE)
    for height in heights:
        speed = upward if height == heights[-1] else 0.0
        world.add_body(Sphere(RADIUS), STONE, (0.0, 0.0, height), (0.0, 0.0, speed))
    return world


@pytest.mark.parametrize("overlap", [0.0, RADIUS - BY_ROUNDING, 1e-15, 1e-12])
def test_a_ball_that_begins_to_touch_at_rest_sinks_in_as_far_as_hertz_says(overlap: float) -> None:
    world = balls_over_ground(RADIUS - overlap)
    deepest = 0.0
    for _ in range(60):
        world.run_locally(0.05, STEPS)
        deepest = max(deepest, RADIUS - world.position[0, 2])
    # Without damping it would go to 2.5^(2/3) of where it rests.
    assert SUNK < deepest < 2.5 ** (2.0 / 3.0) * SUNK
    assert RADIUS - world.position[0, 2] == pytest.approx(SUNK, rel=0.02)


@pytest.mark.parametrize("gap", [1e-3, 1e-6, -1e-17, -1e-12])
def test_a_ball_that_falls_on_one_at_rest_meets_it(gap: float) -> None:
    low = balls_over_ground(RADIUS)
    low.run_locally(5.0, STEPS)
    rests = low.position[0, 2]
    world = balls_over_ground(rests, rests + 2.0 * RADIUS + gap)
    world.run_locally(40.0, STEPS)
    below, above = world.position[:, 2]
    # The one bears both; curvatures add where balls meet, so their stiffness is less by the root of two.
    assert RADIUS - below == pytest.approx(2.0 ** (2.0 / 3.0) * SUNK, rel=0.05)
    assert 2.0 * RADIUS - (above - below) == pytest.approx(2.0 ** (1.0 / 3.0) * SUNK, rel=0.05)


def test_a_ball_thrown_up_from_one_at_rest_comes_back_no_faster() -> None:
    speed = 5e-4
    low = balls_over_ground(RADIUS)
    low.run_locally(5.0, STEPS)
    rests = low.position[0, 2]
    world = balls_over_ground(rests, rests + 2.0 * RADIUS + 1e-6, upward=speed)
    fastest = 0.0
    for _ in range(60):
        world.run_locally(1.0, STEPS)
        fastest = max(fastest, float(np.abs(world.velocity[:, 2]).max()))
    assert fastest < 1.01 * speed
    assert world.position[1, 2] - world.position[0, 2] == pytest.approx(2.0 * RADIUS, abs=1e-6)


@pytest.mark.parametrize("drift", [0.0, 1.0])
def test_two_that_touch_by_rounding_feel_a_blow_however_fast_they_fly_together(drift: float) -> None:
    hard = Material(young_modulus=1e7, poisson_ratio=0.25, density=2500.0, restitution=1.0, friction=0.0)
    world = World()
    for place, speed in ((0.0, 0.0), (2.0 * BY_ROUNDING, 0.0), (0.25, -0.1)):
        world.add_body(Sphere(RADIUS), hard, (place, 0.0, 0.0), (speed, drift, 0.0))
    world.run_locally(1.0, 40.0)
    # Newton's cradle, but for what balls that touch share of a blow.
    assert world.velocity[0, 0] == pytest.approx(-0.0994, rel=0.01)
    assert world.velocity[:, 0].sum() == pytest.approx(-0.1, rel=1e-12)


def test_a_chosen_step_is_made_to_fit_the_duration_and_holds() -> None:
    clock = Clock(0.0, None, None)
    assert clock.steps_in(1.0, lambda: 0.3) == 4
    assert clock.time_step == 0.25
    assert clock.steps_in(0.5, lambda: math.nan) == 2


def test_only_a_step_that_was_given_outlasts_a_change() -> None:
    chosen, given = Clock(0.0, None, 0.25), Clock(0.0, None, 0.25)
    given.give(0.1)
    for clock in (chosen, given):
        clock.choose_anew()
    assert (chosen.time_step, given.time_step) == (None, 0.1)


def test_no_duration_takes_no_step_and_chooses_none() -> None:
    clock = Clock(0.0, None, None)
    assert clock.steps_in(0.0, lambda: 0.3) == 0
    assert clock.time_step is None


@pytest.mark.parametrize("duration", [-1.0, math.inf, math.nan])
def test_a_duration_that_is_none_is_refused(duration: float) -> None:
    with pytest.raises(ValueError, match="duration"):
        Clock(0.0, 0.1, 0.1).steps_in(duration, lambda: 0.1)
