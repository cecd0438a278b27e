"""Bodies that librate, roll or tumble: their rotation against closed forms and integrators, flights about them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from lithobrake.geometry.attitude import rotation_matrices
from lithobrake.smallbody import (
    AttitudeHistory,
    Body,
    Partner,
    Shape,
    dimorphos,
    fly,
    rotation_history,
    tumble,
)
from lithobrake.vocabulary.outcomes import FlightStatus

from .meshes import sphere_mesh

DAY = 86400.0
PERIOD = 11.3674 * 3600.0
EXTENTS = np.array([193.0, 148.0, 120.0])


def ellipsoid(extents: np.ndarray = EXTENTS, frequency: int = 6) -> Shape:
    directions, faces = sphere_mesh(frequency)
    return Shape(0.5 * extents * directions, faces)


def alone(spin_period: float = PERIOD) -> Body:
    return Body(ellipsoid(), 2.8e9, spin_period)


def paired(longitude_deg: float = 0.0) -> Body:
    """With a partner of the mass of Didymos, which always stands over one longitude."""
    other = Body(Shape(380.0 * sphere_mesh(6)[0], sphere_mesh(6)[1]), 5.4e11, 2.26 * 3600.0, "partner")
    return Body(ellipsoid(), 2.8e9, PERIOD, partner=Partner(other, PERIOD, longitude_deg))


def moments(body: Body) -> np.ndarray:
    return np.diag(body.shape.inertia_per_density)


def turns(history: AttitudeHistory) -> Rotation:
    return Rotation.from_quat(np.roll(history.attitude, -1, axis=1))


def times(history: AttitudeHistory) -> np.ndarray:
    return history.step * np.arange(len(history.attitude))


def among_stars(body: Body, time: np.ndarray) -> np.ndarray:
    """Rotation matrices of the body's axes at times, [count, 3, 3]."""
    frame = Rotation.from_rotvec(np.outer(body.spin_rate * time, [0.0, 0.0, 1.0])).as_matrix()
    return frame @ body.rotation.at(time).axes


def tidal_rate(body: Body) -> float:
    """G mass of the partner over the cube of the distance [1/s2]."""
    return body.partner.body.gravitational_parameter / body.orbit.distance**3


# The rotation itself.


def test_a_body_that_starts_at_rest_under_its_partner_stays_so():
    history = rotation_history(dimorphos(), 2.0 * DAY)
    assert np.abs(history.attitude - [1.0, 0.0, 0.0, 0.0]).max() < 1e-12
    assert np.abs(history.spin).max() < 1e-12 * dimorphos().spin_rate


@pytest.mark.parametrize("longitude_deg", [0.0, 180.0])
def test_a_small_yaw_swings_at_the_rate_of_three_times_b_less_a_over_c(longitude_deg):
    body = paired(longitude_deg)
    history = rotation_history(body, 4.0 * DAY, yaw_deg=0.05)
    a, b, c = moments(body)
    rate = math.sqrt(3.0 * tidal_rate(body) * (b - a) / c)
    yaw = turns(history).as_euler("ZYX", degrees=True)[:, 0]
    assert yaw == pytest.approx(0.05 * np.cos(rate * times(history)), abs=0.05 * 1e-4)
    assert np.degrees(history.largest_angles) == pytest.approx([0.05, 0.05, 0.0], abs=1e-4)


def test_small_pitch_and_roll_are_the_two_modes_of_the_linear_problem():
    """A phi'' - n D theta' + (C - B) n^2 phi = 0 and B theta'' + n D phi' + (C - A)(n^2 + 3 k) theta = 0, with
    D = A + B - C and k = G M / d^3: turns phi about x, theta about y, of a body that keeps pace."""
    body = paired()
    (a, b, c), n, k = moments(body), body.spin_rate, tidal_rate(body)
    stiff, soft = (c - a) * (n**2 + 3.0 * k), (c - b) * n**2
    middle = a * stiff + b * soft + (n * (a + b - c)) ** 2
    root = math.sqrt(middle**2 - 4.0 * a * b * stiff * soft)
    modes = [math.sqrt((middle + sign * root) / (2.0 * a * b)) for sign in (1.0, -1.0)]
    history = rotation_history(body, 6.0 * DAY, pitch_deg=0.01, roll_deg=0.02)
    _, pitch, roll = turns(history).as_euler("ZYX", degrees=True).T

    def left_over(rates: list[float]) -> float:
        waves = np.column_stack([f(rate * times(history)) for rate in rates for f in (np.cos, np.sin)])
        both = np.column_stack([pitch, roll])
        return float(np.abs(both - waves @ np.linalg.lstsq(waves, both, rcond=None)[0]).max())

    assert left_over(modes) < 1e-5
    assert left_over([1.01 * modes[0], modes[1]]) > 3e-4
    assert left_over([modes[0], 1.01 * modes[1]]) > 3e-4


def test_a_body_without_a_partner_keeps_energy_and_angular_momentum():
    body = alone()
    body = replace(body, rotation=rotation_history(body, 5.0 * DAY, roll_deg=40.0, spin=(1e-4, 2e-4, -3e-4)))
    time = np.linspace(0.0, 5.0 * DAY, 1001)
    spin, _ = body.rotation.at(time).whole_spin(body.spin_rate)
    momentum = spin @ body.shape.inertia_per_density
    inertial = np.einsum("nij,nj->ni", among_stars(body, time), momentum)
    energy = np.sum(spin * momentum, axis=1)
    assert np.ptp(energy) < 1e-7 * energy[0]
    assert np.abs(inertial - inertial[0]).max() < 1e-7 * np.linalg.norm(inertial[0])
    # It does tumble: the axis of the angular momentum wanders far through the body.
    assert np.ptp(momentum[:, 1]) > 0.5 * np.linalg.norm(momentum[0])


def test_a_body_under_its_partner_keeps_the_jacobi_integral_of_rotation():
    """w I w / 2 - n L_z + 3 k (u I u) / 2, with u the partner's direction: of a partner that stands still."""
    body = paired()
    body = replace(body, rotation=rotation_history(body, 10.0 * DAY, yaw_deg=30.0, roll_deg=60.0))
    here = body.rotation.at(np.linspace(0.0, 10.0 * DAY, 1001))
    spin, _ = here.whole_spin(body.spin_rate)
    inertia, toward, pole = body.shape.inertia_per_density, here.axes[:, 0], here.axes[:, 2]
    momentum = spin @ inertia
    turning = 0.5 * np.sum(spin * momentum, axis=1) - body.spin_rate * np.sum(pole * momentum, axis=1)
    whole = turning + 1.5 * tidal_rate(body) * np.sum(toward * (toward @ inertia), axis=1)
    assert np.ptp(whole) < 1e-6 * np.ptp(turning)


def test_between_its_times_a_history_is_as_good_as_at_them():
    body = alone()
    coarse, fine = (rotation_history(body, days * DAY, spin=(2e-4, 1e-4, 0.0)) for days in (1.0, 1.37))
    time = np.linspace(0.0, DAY, 777)
    one, other = coarse.at(time), fine.at(time)
    assert np.abs(one.axes - other.axes).max() < 1e-8
    assert np.abs(one.spin - other.spin).max() < 1e-7 * 2e-4
    assert np.abs(one.change - other.change).max() < 1e-3 * np.abs(one.change).max()


# What flies about it.


def any_history(spin_rate: float, duration: float) -> AttitudeHistory:
    """Turns about three axes by chosen functions of time; the spin by differences."""
    step = 10.0
    time = np.arange(0.0, duration + step, step)

    def turn(at: np.ndarray) -> Rotation:
        angles = [0.7 * np.sin(2.0 * spin_rate * at), 1.3 * spin_rate * at, 0.4 + 0.3 * np.cos(3.0 * spin_rate * at)]
        return Rotation.from_euler("ZYX", np.column_stack(angles))

    spin = (turn(time - 0.01).inv() * turn(time + 0.01)).as_rotvec() / 0.02
    return AttitudeHistory(step, np.roll(turn(time).as_quat(), 1, axis=1), spin)


def test_about_a_ball_no_flight_depends_on_how_it_turns():
    directions, faces = sphere_mesh(12)
    ball = Body(Shape(100.0 * directions, faces), 1e10, 5.0 * 3600.0)
    turning = replace(ball, rotation=any_history(ball.spin_rate, 4.0 * 3600.0))
    begin, limit = 1234.0, 2.0 * 3600.0
    position = np.array([[100.5, 3.0, 2.0], [5.0, -120.0, 30.0], [0.0, 1.0, 140.0]])
    velocity = np.array([[0.03, 0.01, 0.02], [-0.06, 0.01, 0.01], [0.03, -0.05, -0.01]])
    flown = [fly(one, position, velocity, limit, frame="inertial", start_time=begin) for one in (ball, turning)]
    assert (flown[0].status == FlightStatus.IMPACT).all()
    # Facets of a ball lie up to 0.3 m below it, and a flight meets others as it turns.
    assert flown[1].time == pytest.approx(flown[0].time, abs=8.0)
    end = begin + flown[1].time
    frame = np.einsum("nij,nj->ni", turning.rotation.at(end).axes, flown[1].position)
    assert frame == pytest.approx(flown[0].position, abs=1.0)
    aloft = [fly(one, position, velocity, 300.0, frame="inertial", start_time=begin) for one in (ball, turning)]
    place, rate = turning.rotation.at(np.full(3, begin + 300.0)).states_into_frame(aloft[1].position, aloft[1].velocity)
    assert place == pytest.approx(aloft[0].position, abs=1e-2)
    assert rate == pytest.approx(aloft[0].velocity, abs=1e-4)


def test_a_body_that_stands_still_in_its_frame_has_the_flights_of_one_without_a_history():
    body = paired()
    still = replace(body, rotation=rotation_history(body, 2.0 * DAY))
    origin, axes = body.local_frame([0.0, 10.0, -40.0, 70.0], [0.0, 90.0, 200.0, 300.0])
    velocity = np.einsum("nij,nj->ni", axes, [[0.01, 0, 0.02], [0, 0.01, 0.03], [0.02, 0.01, 0.01], [0, 0.05, 0.1]])
    one, other = (fly(each, origin, velocity, DAY, start_time=3600.0) for each in (body, still))
    assert (one.status == other.status).all()
    assert (one.facet == other.facet).all()
    assert len(set(one.status.tolist())) > 1
    assert other.time == pytest.approx(one.time, rel=1e-9)
    assert other.position == pytest.approx(one.position, rel=1e-9, abs=1e-6)
    assert other.impact_speed == pytest.approx(one.impact_speed, rel=1e-9, nan_ok=True)


class Stars:
    """The body turning by Euler's equations and a lander about it, in axes that do not turn; its centre falls."""

    def __init__(self, body: Body, turn: Rotation, spin: np.ndarray) -> None:
        self.body, self.inertia = body, body.shape.inertia_per_density
        self.start, self.spin = turn.as_matrix(), spin + body.spin_rate * turn.as_matrix()[2]

    def toward(self, time: float) -> np.ndarray:
        motion = 2.0 * math.pi / self.body.partner.period
        place = math.radians(self.body.partner.longitude_deg) + motion * time
        return self.body.orbit.distance * np.array([math.cos(place), math.sin(place), 0.0])

    def slope(self, time: float, state: np.ndarray) -> np.ndarray:
        place, rate, turn, spin = state[:3], state[3:6], state[6:15].reshape(3, 3), state[15:]
        push = turn @ self.body.acceleration(turn.T @ place)
        torque = -np.cross(spin, self.inertia @ spin)
        if self.body.partner is not None:
            other, way = self.body.partner.body, self.toward(time)
            facing = Rotation.from_rotvec([0.0, 0.0, other.spin_rate * time + math.pi]).as_matrix()
            push = push + facing @ other.acceleration(facing.T @ (place - way))
            push = push - self.body.orbit.pull * way / self.body.orbit.distance
            unit = turn.T @ way / np.linalg.norm(way)
            torque = torque + 3.0 * tidal_rate(self.body) * np.cross(unit, self.inertia @ unit)
        cross = np.array([[0.0, -spin[2], spin[1]], [spin[2], 0.0, -spin[0]], [-spin[1], spin[0], 0.0]])
        return np.concatenate([rate, push, (turn @ cross).ravel(), np.linalg.solve(self.inertia, torque)])

    def fly(self, position: np.ndarray, velocity: np.ndarray, begin: float, duration: float):
        """Time of the impact and the state there, or at the end, body-fixed; the lander starts body-fixed."""
        exact = {"method": "DOP853", "rtol": 1e-9, "atol": 1e-10}
        state = np.concatenate([np.zeros(6), self.start.ravel(), self.spin])
        state[0] = 1e5
        if begin:
            state = solve_ivp(self.slope, (0.0, begin), state, **exact).y[:, -1]
        turn, spin = state[6:15].reshape(3, 3), state[15:]
        state[:6] = *(turn @ position), *(turn @ (velocity + np.cross(spin, position)))

        def ground(_time: float, y: np.ndarray) -> float:
            return float(self.body.shape.height(y[6:15].reshape(3, 3).T @ y[:3]))

        ground.terminal, ground.direction = True, -1
        found = solve_ivp(self.slope, (begin, begin + duration), state, events=ground, max_step=120.0, **exact)
        last = found.y[:, -1]
        turn, spin = last[6:15].reshape(3, 3), last[15:]
        place = turn.T @ last[:3]
        return found.t[-1] - begin, place, turn.T @ last[3:6] - np.cross(spin, place), found.status == 1


@pytest.mark.parametrize(("body", "begin"), [(alone(), 0.0), (paired(), 3000.0)], ids=["alone", "paired"])
def test_flights_about_a_tumbling_body_are_those_among_the_stars(body, begin):
    spin = np.array([2e-4, -1e-4, 1e-4])
    angles = {"yaw_deg": 30.0, "pitch_deg": -20.0, "roll_deg": 60.0}
    tumbling = replace(body, rotation=rotation_history(body, DAY, **angles, spin=spin))
    stars = Stars(body, Rotation.from_euler("ZYX", list(angles.values()), degrees=True), spin)
    origin, axes = body.local_frame([3.0, 40.0, -20.0], [5.0, 100.0, 190.0])
    origin = origin + 0.5 * axes[:, 2]
    velocity = np.einsum("nij,nj->ni", axes.transpose(0, 2, 1), [[0.01, 0, 0.012], [0, 0.012, 0.01], [-0.01, 0, 0.02]])
    flown = fly(tumbling, origin, velocity, 9000.0, start_time=begin, tolerance=1e-9)
    assert (flown.facet >= 0).sum() >= 2
    for row in range(3):
        time, place, rate, hit = stars.fly(origin[row], velocity[row], begin, 9000.0)
        assert hit == (flown.facet[row] >= 0)
        assert flown.time[row] == pytest.approx(time, abs=0.02)
        assert flown.position[row] == pytest.approx(place, abs=1e-3)
        assert flown.velocity[row] == pytest.approx(rate, abs=1e-6)
        if hit:
            assert flown.facet[row] == body.shape.nearest(place)[1]
            assert flown.impact_speed[row] == pytest.approx(np.linalg.norm(rate), rel=1e-4)
    uniform = fly(body, origin, velocity, 9000.0, start_time=begin)
    assert np.linalg.norm(uniform.position - flown.position, axis=1).min() > 0.5


def test_what_falls_on_the_partner_has_the_place_and_speed_there_whatever_the_body_does():
    body = paired()
    tumbling = replace(body, rotation=rotation_history(body, DAY, yaw_deg=50.0, roll_deg=70.0))
    start = [[120.0, 0.0, 0.0], [130.0, 20.0, 30.0]]
    velocity = [[0.4, 0.05, 0.0], [0.5, 0.0, 0.02]]
    one, other = (fly(each, start, velocity, DAY, frame="inertial", tolerance=1e-9) for each in (body, tumbling))
    assert (one.status == FlightStatus.PARTNER).all()
    assert (other.status == FlightStatus.PARTNER).all()
    # The body's own pull differs as it turns, by little so far away.
    assert other.latitude == pytest.approx(one.latitude, abs=0.5)
    assert other.longitude == pytest.approx(one.longitude, abs=0.5)
    assert other.impact_speed == pytest.approx(one.impact_speed, rel=3e-3)


def test_the_push_on_the_ground_is_gravity_less_the_acceleration_of_the_ground():
    body = paired()
    body = replace(body, rotation=rotation_history(body, DAY, yaw_deg=40.0, roll_deg=60.0, spin=(2e-4, 0.0, -1e-4)))
    points, _ = body.shape.locate([0.0, 10.0, -80.0], [0.0, 90.0, 200.0])
    time, apart = np.array([20000.0, 31000.0, 40000.0]), 20.0

    def places(at: np.ndarray) -> np.ndarray:
        return np.einsum("nij,nj->ni", among_stars(body, at), points)

    moved = (places(time + apart) - 2.0 * places(time) + places(time - apart)) / apart**2
    moved = np.einsum("nji,nj->ni", among_stars(body, time), moved)
    found = body.effective_acceleration(points, time=time) - body.acceleration(points)
    assert found == pytest.approx(-moved, abs=1e-5 * np.abs(moved).max())
    uniform = body.effective_acceleration(points) - body.acceleration(points)
    assert np.abs(found - uniform).max() > 0.5 * np.abs(uniform).max()


# What is refused.


def test_flights_longer_than_the_history_are_refused():
    body = alone()
    body = replace(body, rotation=rotation_history(body, 3600.0))
    with pytest.raises(ValueError, match="known from 0 to 3600 s, and flights or slides may last from 0 to 4000 s"):
        fly(body, [100.0, 0.0, 0.0], [0.0, 0.0, 0.0], 3000.0, start_time=1000.0)
    with pytest.raises(ValueError, match=r"spin_period is not 40922\.6 s"):
        fly(body, [100.0, 0.0, 0.0], [0.0, 0.0, 0.0], 300.0, spin_period=3e4)
    for time in (math.nan, 1e300, -2000.0):
        with pytest.raises(ValueError, match=r"time is .* s; allowed: 0 to 3600 s, for which attitudes are known"):
            body.rotation.at(time)
    with pytest.raises(
        ValueError, match=r"duration is 1e\+300, but must be a finite number above 0 and of at most 1e\+09"
    ):
        rotation_history(body, 1e300)


@pytest.mark.parametrize(("attitude", "spin", "words"), [
    (np.ones((1, 4)), np.zeros((1, 3)), "at least two"),
    (np.zeros((2, 4)), np.zeros((2, 3)), "no quaternion 0"),
    (np.ones((2, 4)), np.full((2, 3), 1.0), "more attitudes"),
])  # fmt: skip
def test_attitudes_that_are_no_history_are_refused(attitude, spin, words):
    with pytest.raises(ValueError, match=words):
        AttitudeHistory(10.0, attitude, spin)


EPS = np.finfo(float).eps
KINDS = {"any": (0.3, 0.7, 0.9), "oblate": (0.6, 0.6, 1.0), "prolate": (0.2, 1.0, 1.0), "ball": (0.4, 0.4, 0.4)}


def skewed(moments: tuple[float, float, float], random: np.random.Generator) -> np.ndarray:
    """An inertia with these principal moments about axes of any direction."""
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
    return axes @ np.diag(moments) @ axes.T


def starts(count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    attitude = random.normal(size=(count, 4))
    return attitude / np.linalg.norm(attitude, axis=1)[:, None], random.normal(size=(count, 3))


def error(found: np.ndarray, exact: np.ndarray) -> float:
    """Largest difference of two lists of attitudes; a quaternion and its negative are one attitude."""
    return float(np.minimum(np.abs(found - exact).max(axis=1), np.abs(found + exact).max(axis=1)).max())


def integrated(inertia: np.ndarray, attitude: np.ndarray, spin: np.ndarray, duration: float) -> tuple[np.ndarray, ...]:
    """Attitude and spin of one body by DOP853: the quaternion alone, under an angular momentum that stays."""
    start = rotation_matrices(attitude[None])[0]
    momentum, inverse = start @ inertia @ start.T @ spin, np.linalg.inv(inertia)

    def rate(_: float, q: np.ndarray) -> np.ndarray:
        x, y, z = inverse @ rotation_matrices(q[None])[0].T @ momentum
        return 0.5 * np.array([[0, -x, -y, -z], [x, 0, z, -y], [y, -z, 0, x], [z, y, -x, 0]]) @ q

    q = solve_ivp(rate, (0.0, duration), attitude, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    turn = rotation_matrices(q[None])[0]
    return q / np.linalg.norm(q), turn @ inverse @ turn.T @ momentum


@pytest.mark.parametrize("kind", KINDS)
def test_it_turns_as_an_integrator_has_it(kind: str) -> None:
    random = np.random.default_rng(0)
    inertia = 1e-3 * skewed(KINDS[kind], random)
    attitude, spin = starts(4, random)
    duration = np.array([-18.0, -7.0, 9.0, 20.0])
    found = tumble(inertia, attitude, spin, duration)
    for one in range(4):
        exact = integrated(inertia, attitude[one], spin[one], duration[one])
        # DOP853 at these tolerances loses some 1e-11 on the way.
        assert error(found[0][one : one + 1], exact[0][None]) < 1e-10
        assert found[1][one] == pytest.approx(exact[1], abs=1e-10)


def test_both_ways_of_circling_are_met() -> None:
    """About the axis of the largest moment and about that of the smallest, in either sense."""
    moments = np.array(KINDS["any"])
    level, upright = np.array([[1.0, 0.1, 0.2]]), np.array([[0.2, 0.1, 1.0]])
    for spin in (level, upright, -level, -upright):
        found = tumble(np.diag(moments), [[1.0, 0.0, 0.0, 0.0]], spin, [7.0])
        exact = integrated(np.diag(moments), np.array([1.0, 0.0, 0.0, 0.0]), spin[0], 7.0)
        assert error(found[0], exact[0][None]) < 1e-11
        assert found[1][0] == pytest.approx(exact[1], abs=1e-11)


@pytest.mark.parametrize("kind", KINDS)
def test_twelve_hours_keep_momentum_and_energy_and_come_back(kind: str) -> None:
    random = np.random.default_rng(1)
    inertia = skewed(KINDS[kind], random)
    attitude, spin = starts(200, random)
    spin *= 5.0 / np.linalg.norm(spin, axis=1)[:, None]
    first, second = random.uniform(0.0, 21_600.0, (2, 200))

    def kept(attitude: np.ndarray, spin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        turn = rotation_matrices(attitude)
        momentum = np.einsum("nij,jk,nlk,nl->ni", turn, inertia, turn, spin)
        return momentum, np.einsum("ni,ni->n", momentum, spin)

    halfway = tumble(inertia, attitude, spin, first)
    parts, whole = tumble(inertia, *halfway, second), tumble(inertia, attitude, spin, first + second)
    # A rounding of each of the 2e5 radians, times what a spin near the separatrix makes of it.
    assert error(parts[0], whole[0]) < 2e5 * EPS * 200.0
    assert error(tumble(inertia, *whole, -first - second)[0], attitude) < 2e5 * EPS * 200.0
    (before, energy), (after, energy_after) = kept(attitude, spin), kept(*whole)
    assert np.abs(after - before).max() < 50.0 * EPS * np.linalg.norm(before, axis=1).max()
    assert energy_after == pytest.approx(energy, rel=50.0 * EPS)
    assert np.linalg.norm(whole[0], axis=1) == pytest.approx(1.0, abs=4.0 * EPS)


@pytest.mark.parametrize("kind", KINDS)
def test_no_time_and_no_spin_change_nothing(kind: str) -> None:
    random = np.random.default_rng(2)
    inertia = skewed(KINDS[kind], random)
    attitude, spin = starts(50, random)
    same = tumble(inertia, attitude, spin, np.zeros(50))
    assert error(same[0], attitude) < 20.0 * EPS
    assert same[1] == pytest.approx(spin, abs=50.0 * EPS)
    resting = tumble(inertia, attitude, np.zeros((50, 3)), np.full(50, 1e4))
    assert error(resting[0], attitude) < 20.0 * EPS
    assert not resting[1].any()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("rate", [5.0, -5.0])
def test_a_spin_about_a_principal_axis_stays(kind: str, axis: int, rate: float) -> None:
    """Even about the middle one, where nothing disturbs it."""
    spin, half = np.zeros((1, 3)), 0.5 * rate * 43_200.0
    spin[0, axis] = rate
    turned, after = tumble(np.diag(KINDS[kind]), [[1.0, 0.0, 0.0, 0.0]], spin, [43_200.0])
    exact = np.zeros((1, 4))
    exact[0, 0], exact[0, 1 + axis] = np.cos(half), np.sin(half)
    assert error(turned, exact) < 2.0 * abs(half) * EPS
    assert after == pytest.approx(spin, abs=20.0 * EPS)


def test_a_spin_about_the_middle_axis_turns_over() -> None:
    """The middle component of a body without symmetry goes from one sense to the other and back in one period."""
    from scipy.special import ellipkm1

    tilt = 1e-6
    # 1, 2, 3 kg m2: the excess over the separatrix is 2 tilt^2, and the rate 1 / sqrt(3).
    spin = np.array([[0.0, 1.0, tilt]])
    complement = tilt**2 * 3.0 * 2.0 / (tilt**2 * 6.0 + 2.0)
    half_period = 2.0 * ellipkm1(complement) / np.sqrt((2.0 + 6.0 * tilt**2) / 6.0)
    turned, after = tumble(np.diag([1.0, 2.0, 3.0]), [[1.0, 0.0, 0.0, 0.0]], spin, [half_period])
    in_body = rotation_matrices(turned)[0].T @ after[0]
    assert in_body == pytest.approx([0.0, -1.0, tilt], abs=1e-9)


def test_on_the_separatrix_a_spin_ends_about_the_middle_axis() -> None:
    """1.5, 3 and 4 kg m2, angular momenta of 1 and 2 along the outer axes: on it to the last bit."""
    moments, attitude = np.array([1.5, 3.0, 4.0]), np.array([[1.0, 0.0, 0.0, 0.0]])
    spin = np.array([[1.0, 0.0, 2.0]]) / moments
    turned, after = tumble(np.diag(moments), attitude, spin, [3.0])
    exact = integrated(np.diag(moments), attitude[0], spin[0], 3.0)
    assert error(turned, exact[0][None]) < 1e-11
    assert after[0] == pytest.approx(exact[1], abs=1e-11)
    turned, after = tumble(np.diag(moments), attitude, spin, [1e4])
    assert np.abs(rotation_matrices(turned)[0].T @ after[0]) == pytest.approx([0.0, np.sqrt(5.0) / 3.0, 0.0], abs=1e-14)


@pytest.mark.parametrize("scale", [1e-200, 1e-6, 1e100])
def test_no_scale_of_spin_or_inertia_matters(scale: float) -> None:
    attitude, spin = starts(5, np.random.default_rng(4))
    inertia = np.diag(KINDS["any"])
    plain = tumble(inertia, attitude, spin, np.full(5, 3.0))
    scaled = tumble(1e-9 * inertia, attitude, scale * spin, np.full(5, 3.0 / scale))
    assert error(scaled[0], plain[0]) < 100.0 * EPS
    assert scaled[1] / scale == pytest.approx(plain[1], abs=100.0 * EPS)


@pytest.mark.parametrize("kind", KINDS)
def test_a_body_turns_the_same_whoever_turns_beside_it(kind: str) -> None:
    random = np.random.default_rng(5)
    inertia, state = skewed(KINDS[kind], random), (*starts(300, random), random.uniform(0.0, 4e4, 300))
    together = tumble(inertia, *state)
    for _ in range(60):
        few = random.choice(300, random.integers(1, 9))
        for one, all_of_them in zip(tumble(inertia, *(part[few] for part in state)), together, strict=True):
            assert (one == all_of_them[few]).all()


def test_what_no_body_has_is_refused() -> None:
    state = ([[1.0, 0.0, 0.0, 0.0]], [[0.0, 0.0, 1.0]], [1.0])
    for inertia, words in (
        (np.eye(2), "shape"), (np.zeros((3, 3)), "is 0"), (np.diag([1.0, 1.0, -1.0]), "moment"),
        (np.eye(3) + np.eye(3, k=1), "symmetric"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=words):
            tumble(inertia, *state)
    for wrong in (([1.0, 0.0, 0.0, 0.0], *state[1:]), ([[0.0] * 4], *state[1:]), (*state[:2], [np.inf])):
        with pytest.raises(ValueError, match="attitude"):
            tumble(np.eye(3), *wrong)
    empty = tumble(np.eye(3), np.zeros((0, 4)), np.zeros((0, 3)), np.zeros(0))
    assert [one.shape for one in empty] == [(0, 4), (0, 3)]
