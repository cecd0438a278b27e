"""The partner of a binary: attraction and impact against an integration in the axes of the stars."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from lithobrake.smallbody import Body, Partner, didymos, dimorphos, fly


def turned(angle: float) -> np.ndarray:
    """Rotation about z."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


class Stars:
    """Both bodies about their common centre of mass in axes that do not turn, from the definition of the orbit."""

    def __init__(self, body: Body) -> None:
        self.body, self.other = body, body.partner.body
        total = body.gravitational_parameter + self.other.gravitational_parameter
        self.motion = 2.0 * math.pi / body.partner.period
        flat = body.flattening + self.other.flattening
        self.apart = brentq(
            lambda d: total / d**2 * (1.0 + 1.5 * flat / d**2) - self.motion**2 * d, 500.0, 5000.0, xtol=1e-10
        )
        self.share = self.other.gravitational_parameter / total
        self.start = math.radians(body.partner.longitude_deg)
        self.facing = self.start + math.pi - math.radians(body.partner.facing_deg)

    def centres(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        place = self.start + self.motion * time
        line = self.apart * np.array([math.cos(place), math.sin(place), 0.0])
        return -self.share * line, (1.0 - self.share) * line

    def local(self, time: float, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A place in the frames of the two bodies."""
        one, two = self.centres(time)
        turn = self.facing + self.other.spin_rate * time
        return turned(-self.body.spin_rate * time) @ (place - one), turned(-turn) @ (place - two)

    def slope(self, time: float, state: np.ndarray) -> np.ndarray:
        one, two = self.local(time, state[:3])
        push = turned(self.body.spin_rate * time) @ self.body.acceleration(one)
        push = push + turned(self.facing + self.other.spin_rate * time) @ self.other.acceleration(two)
        return np.concatenate([state[3:], push])

    def fly(self, position: np.ndarray, velocity: np.ndarray, begin: float, duration: float) -> tuple[str, np.ndarray]:
        """Status and body-fixed position at the end; starts are body-fixed."""
        place = self.start + self.motion * begin
        drift = self.share * self.apart * self.motion * np.array([-math.sin(place), math.cos(place), 0.0])
        turn = turned(self.body.spin_rate * begin)
        rate = turn @ (velocity + np.cross([0.0, 0.0, self.body.spin_rate], position)) - drift
        state = np.concatenate([turn @ position + self.centres(begin)[0], rate])

        def ground(which: int):
            def height(time: float, state: np.ndarray) -> float:
                shape = (self.body, self.other)[which].shape
                return float(shape.height(self.local(time, state[:3])[which])) if time > begin + 5.0 else 1.0

            height.terminal, height.direction = True, -1
            return height

        limits = {"rtol": 1e-10, "atol": 1e-8, "max_step": 120.0}
        events = [ground(0), ground(1)]
        end = solve_ivp(self.slope, (begin, begin + duration), state, method="DOP853", events=events, **limits)
        status = "flying" if end.status == 0 else ("impact" if len(end.t_events[0]) else "partner")
        return status, self.local(end.t[-1], end.y[:3, -1])[0]


def throws(body: Body, speed: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Starts on the surface, within 70 deg of the vertical."""
    random = np.random.default_rng(2)
    origin, axes = body.local_frame(5.0, 30.0)
    tilt, turn = np.radians(70.0) * np.sqrt(random.uniform(size=count)), random.uniform(0.0, 2.0 * np.pi, count)
    local = np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=1)
    return np.tile(origin, (count, 1)), speed * random.uniform(0.3, 1.0, count)[:, None] * local @ axes


@pytest.mark.parametrize(("body", "speed"), [(didymos(), 0.3), (dimorphos(), 0.15)], ids=["didymos", "dimorphos"])
def test_flights_in_a_binary_against_the_axes_of_the_stars(body, speed):
    """From either body, at any time, to any end; none of the formulas of the turning frame is used on the other side"""
    position, velocity = throws(body, speed, 8)
    begin = np.linspace(-3e4, 3e4, 8)
    flights = fly(body, position, velocity, 15_000.0, start_time=begin)
    known = flights.status != "escaped"
    assert known.sum() >= 6
    for i in np.flatnonzero(known):
        status, place = Stars(body).fly(position[i], velocity[i], float(begin[i]), 15_000.0)
        assert status == flights.status[i]
        assert np.linalg.norm(flights.position[i] - place) < 0.02


def test_the_partner_is_hit():
    """Thrown at Didymos from above Dimorphos, some of them at its rim; the ends lie on its surface."""
    body = dimorphos()
    random = np.random.default_rng(4)
    position = random.normal(size=(24, 3))
    position *= 2.0 * body.shape.radius / np.linalg.norm(position, axis=1)[:, None]
    aim = np.array([body.orbit.distance, 0.0, 0.0]) + random.uniform(-420.0, 420.0, size=(24, 3)) - position
    velocity = 0.7 * aim / np.linalg.norm(aim, axis=1)[:, None]
    flights = fly(body, position, velocity, 6_000.0)
    hit = flights.status == "partner"
    assert 10 <= hit.sum() < 24
    other = body.partner.body
    latitude, longitude = flights.latitude[hit], flights.longitude[hit]
    end, speed = body.orbit.seen_from_partner(flights.position, flights.velocity, flights.time)
    assert np.abs(other.shape.height(end[hit])).max() < 1e-6
    assert np.array_equal(other.shape.latitude_longitude(end[hit]), (latitude, longitude))
    assert flights.impact_speed[hit] == pytest.approx(np.linalg.norm(speed[hit], axis=1))
    assert (flights.incidence[hit] < 0.5 * np.pi).all()
    for i in np.flatnonzero(~hit)[:3]:
        if flights.status[i] != "escaped":
            assert Stars(body).fly(position[i], velocity[i], 0.0, 6_000.0)[0] == flights.status[i]


def test_the_velocity_against_the_partner_is_the_derivative_of_its_frame():
    body = dimorphos()
    place, rate, step = np.array([300.0, -200.0, 50.0]), np.array([0.1, 0.2, -0.3]), 1e-2
    ends = [body.orbit.seen_from_partner(place + share * rate, rate, 5e3 + share)[0] for share in (-step, step)]
    _, speed = body.orbit.seen_from_partner(place, rate, 5e3)
    assert speed == pytest.approx((ends[1] - ends[0]) / (2.0 * step), abs=1e-8)


def test_the_orbit_of_the_built_in_binary():
    """Kepler's third law with both masses and flattenings; published are 1144 +- 70 m after the impact of DART."""
    body = didymos()
    assert body.orbit.distance == pytest.approx(Stars(body).apart)
    total = body.gravitational_parameter + body.partner.body.gravitational_parameter
    spheres = (total * (body.partner.period / (2.0 * math.pi)) ** 2) ** (1 / 3)
    assert 1.006 < body.orbit.distance / spheres < 1.007
    assert 1144 - 70 < body.orbit.distance < 1144 + 70
    assert dimorphos().orbit.distance == pytest.approx(body.orbit.distance)
    # Always the same face: the centre of Didymos stands over longitude 0 of Dimorphos at any time.
    for time in (0.0, 1e4):
        centre, _ = body.orbit.seen_from_partner([0.0, 0.0, 0.0], [0.0, 0.0, 0.0], time)
        assert centre == pytest.approx([body.orbit.distance, 0.0, 0.0], abs=1e-9)
    assert dimorphos().orbit.rate == 0.0


def test_the_centre_of_a_moon_follows_its_orbit():
    """What stands at the centre of Dimorphos feels nothing of Didymos: its facets pull as hard as the orbit turns."""
    moon = dimorphos()
    angle = np.radians(np.arange(0.0, 360.0, 3.0))
    around = moon.orbit.distance * np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
    pull = -(moon.partner.body.acceleration(around) * around).sum(axis=1).mean() / moon.orbit.distance
    # The rest is that the moon is flat too, a part of 1e-3, less what the fourth degree of Didymos adds.
    assert moon.orbit.pull == pytest.approx(pull, rel=3e-4)


def test_a_flat_body_attracts_as_its_moments_say():
    """MacCullagh's formula against the facets of Didymos, where the orbit of its moon is."""
    body = didymos(partner=False)
    # Longitudes 0 and 90 in the mean, between which the equator's own shape cancels.
    directions = np.eye(3)[:2]
    for far, fourth_degree in ((1156.0, 2e-3), (11560.0, 1e-6)):
        pull = -(body.acceleration(far * directions) * directions).sum(axis=1).mean()
        share = pull * far**2 / body.gravitational_parameter
        assert share == pytest.approx(1.0 + 1.5 * body.flattening / far**2, rel=fourth_degree)


def test_the_partner_is_switched_off():
    """Alone, flights are the same bits as those of a body that never had one; with it they differ."""
    alone, bare = didymos(partner=False), replace(didymos(), partner=None)
    assert alone.partner is None
    position, velocity = throws(alone, 0.3, 6)
    ends = [fly(body, position, velocity, 2e4).position for body in (alone, bare, didymos())]
    assert np.array_equal(ends[0], ends[1])
    assert np.abs(ends[0] - ends[2]).max() > 0.1


def test_starts_on_and_in_the_partner():
    body = didymos()
    other = body.partner.body
    ground = np.array([body.orbit.distance + 88.5, 0.0, 0.0])  # the far side, which the orbit carries away
    resting = fly(body, ground, np.cross([0.0, 0.0, body.orbit.rate], ground) - [0.01, 0.0, 0.0], 600.0)
    assert (resting.status[0], resting.time[0]) == ("partner", pytest.approx(0.0, abs=0.5))
    assert resting.longitude[0] == pytest.approx(180.0)
    with pytest.raises(ValueError, match="below the surface of dimorphos"):
        fly(body, [body.orbit.distance, 0.0, 0.0], [0.0, 0.0, 0.0], 60.0)
    assert other.partner is None


def test_wrong_partners_are_refused():
    body = didymos(partner=False)
    with pytest.raises(ValueError, match="period is -1"):
        Partner(body, period=-1.0)
    with pytest.raises(ValueError, match="must be finite"):
        Partner(body, period=1e4, longitude_deg=math.nan)
    with pytest.raises(ValueError, match="no partner of its own"):
        Partner(didymos(), period=4e4)
    with pytest.raises(ValueError, match="longer period"):
        replace(body, partner=Partner(dimorphos(partner=False), period=7000.0))
