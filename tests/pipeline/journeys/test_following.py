"""Landers that are followed on hard ground of known shape: bounces, flights, ways along the ground, and their ends."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy import stats

from lithobrake.smallbody import Body, HardSurface, Impacts, Rebounds, Shape, didymos, fly, rotation_history
from lithobrake.smallbody.ground_touchdowns import Bounces
from lithobrake.smallbody.hopping import Thrown
from lithobrake.smallbody.landers import follow
from lithobrake.smallbody.touchdown import Answers
from lithobrake.vocabulary.quantities import UNKNOWN_END

from ...smallbody.meshes import CUBE_FACES, cube_vertices, sphere_mesh
from .plain_landers import Recorded, hop, thrown_landers

UP = np.array([0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def plain() -> Body:
    """A cube of 200 m that does not turn: near the middle of its top, gravity is nearly plumb and constant."""
    return Body(Shape(cube_vertices(200.0), CUBE_FACES), mass=2e10, spin_period=math.inf)


@pytest.fixture(scope="module")
def spinning() -> Body:
    """Didymos alone, at whose equator nothing lies; its moments and the cells of its facets are made once."""
    return didymos(partner=False)


def test_bounces_of_a_ball_follow_the_geometric_series(plain: Body) -> None:
    """Thrown up at v from a plane it bounces at e v, e e v ...: flights of 2 v / g, 2 e v / g ..."""
    origin = np.array([3.0, 2.0, 100.0])
    push = -float(plain.acceleration(origin)[2])
    speed, restitution = 0.004, 0.5
    end, _ = hop(plain, origin, speed * UP, HardSurface(restitution, rest_height=1e-3))
    assert end.end[0] == "at_rest"
    # A rebound of e**n v rises (e**n v)**2 / 2 g; the first one below the height of rest is the end.
    rebounds = math.floor(math.log(math.sqrt(2.0 * push * 1e-3) / speed) / math.log(restitution))
    assert end.touchdowns[0] == rebounds + 2
    # Gravity weakens by some thousandths over the 0.09 m that the first flight rises.
    expected = 2.0 * speed / push * (1.0 - restitution ** (rebounds + 1)) / (1.0 - restitution)
    assert end.time[0] == pytest.approx(expected, rel=5e-3)
    latitude, _ = plain.shape.latitude_longitude(end.position)
    assert latitude[0] == pytest.approx(math.degrees(math.atan2(100.0, math.hypot(3.0, 2.0))), abs=0.1)


def test_landers_end_in_each_way(plain: Body) -> None:
    start = np.array([3.0, 2.0, 100.0])

    def unknown(hit: Impacts, random: np.random.Generator) -> Rebounds:
        nothing = np.zeros(len(hit.speed), dtype=bool)
        return Rebounds(np.full((len(hit.speed), 3), np.nan), hit.spin, nothing, ~nothing)

    def end(velocity: float, bounce: Any, **settings: Any) -> tuple[str, bool]:
        found, _ = hop(plain, start, velocity * UP, bounce, **settings)
        return str(found.end[0]), bool(found.is_down[0])

    assert end(0.01, unknown) == (UNKNOWN_END, True)
    assert end(0.01, HardSurface(1.0), duration=1e3) == ("under_way", False)
    assert end(1.0, HardSurface(1.0)) == ("escaped", False)
    # The last of the most touchdowns has no flight after it.
    assert end(0.002, HardSurface(1.0), most=4) == ("under_way", True)
    limited, _ = hop(plain, start, 0.002 * UP, HardSurface(1.0), most=4)
    assert limited.touchdowns[0] == 4
    assert hop(plain, start, 0.002 * UP, HardSurface(0.0), most=2)[0].end[0] == "at_rest"


def test_the_frame_of_an_impact_and_the_spin_are_carried(plain: Body) -> None:
    """A bounce that turns by a right angle to the left of the way it came, and gives a spin about the normal."""

    def aside(hit: Impacts, random: np.random.Generator) -> Rebounds:
        along = hit.speed * np.sin(hit.incidence)
        up = hit.speed * np.cos(hit.incidence)
        spin = np.tile([0.0, 0.0, 0.5], (len(along), 1))
        none = np.zeros(len(along), dtype=bool)
        return Rebounds(np.stack([0.0 * along, along, up], axis=1), spin, none, none)

    start, velocity = np.array([-1.0, 0.3, 100.0]), [0.01, 0.0, 0.01]
    first, end, again = (hop(plain, start, velocity, aside, most=most)[0] for most in (2, 3, 3))
    assert first.position[0, 0] > start[0] + 0.5
    assert abs(first.position[0, 1] - start[1]) < 0.1
    assert end.position[0, 1] > first.position[0, 1] + 0.5
    assert end.spin[0] == pytest.approx([0.0, 0.0, 0.5])
    assert np.array_equal(again.position, end.position)


def test_a_bounce_is_told_which_lander_it_is(plain: Body) -> None:
    """The second of three lands and stays; the others bounce once more, and each keeps the last impact it had."""
    seen = []

    def only_the_second_stays(hit: Impacts, random: np.random.Generator) -> Rebounds:
        seen.append(hit.lander.tolist())
        up = np.stack([0.0 * hit.speed, 0.0 * hit.speed, 0.5 * hit.speed], axis=1)
        return Rebounds(up, hit.spin, hit.lander == 1, np.zeros(len(hit.speed), dtype=bool))

    start = np.array([[3.0, 2.0, 100.0], [-3.0, 1.0, 100.0], [0.0, 4.0, 100.0]])
    end, thrown = hop(plain, start, 4e-3 * UP, only_the_second_stays, most=3)
    assert seen == [[0, 1, 2], [0, 2]]
    assert end.end.tolist() == ["under_way", "at_rest", "under_way"]
    assert thrown.seen[0].speed == pytest.approx([4e-3] * 3, rel=5e-3)
    assert thrown.seen[1].speed == pytest.approx([2e-3] * 2, rel=5e-3)
    assert (thrown.seen[1].incidence_deg < 6.0).all()


@pytest.mark.parametrize("rise", [0.09, -0.02])
def test_between_touchdown_and_flight_no_energy_is_lost(plain: Body, rise: float) -> None:
    """A lander that has risen by h comes down with v^2 + 2 g h; one that has sunk has paid for the way up."""
    origin, speed = np.array([3.0, 2.0, 100.0]), 5e-3
    push = -float(plain.acceleration(origin)[2])
    landers, which = thrown_landers(plain, origin, gravity="exact"), np.array([0])
    risen = Answers.unknown(1)
    risen.outcome[:], risen.velocity[:], risen.rise[:] = "clear", [[0.0, 0.0, speed]], rise
    flights = landers.go_on(which, risen)
    assert flights is not None
    assert plain.shape.height(flights.start.position[0]) == pytest.approx(max(rise, 0.0), abs=1e-9)
    # Gravity weakens by thousandths over the way up.
    assert landers.speed[0] ** 2 == pytest.approx(speed**2 + 2.0 * push * rise, rel=5e-3)


def test_a_bounce_into_the_ground_is_refused(plain: Body) -> None:
    def down(hit: Impacts, random: np.random.Generator) -> Rebounds:
        none = np.zeros(len(hit.speed), dtype=bool)
        return Rebounds(np.tile([0.0, 0.0, -0.1], (len(hit.speed), 1)), hit.spin, none, none)

    with pytest.raises(ValueError, match="a bounce sent a lander into the ground"):
        hop(plain, [3.0, 2.0, 100.0], 0.01 * UP, down)


def test_a_lander_that_only_its_own_motion_holds_down_slides_until_it_leaves_the_ground(spinning: Body) -> None:
    """Westward along the equator of Didymos it stays down, though the ground there throws off what lies on it."""
    origin, axes = spinning.local_frame(0.0, 0.0, 270.0)
    assert axes[2] @ spinning.effective_acceleration(origin) > 0.0
    stuck, _ = hop(spinning, origin, 0.15 * axes[0], HardSurface(0.6))
    # Nothing says how a lander leaves that the ground pushes off at rest.
    assert (stuck.end[0], stuck.contact_length[0]) == (UNKNOWN_END, 0.0)
    assert 5 < stuck.touchdowns[0] < 100
    # Friction takes the motion that holds it down, and the spin throws it off.
    short, _ = hop(spinning, origin, 0.15 * axes[0], HardSurface(0.6), friction=0.1, duration=4000.0)
    assert (short.end[0], short.is_down[0]) == ("under_way", True)
    assert short.contact_time[0] > 3000.0
    end, _ = hop(spinning, origin, 0.15 * axes[0], HardSurface(0.6), friction=0.6, duration=2e4)
    assert (end.end[0], end.is_down[0]) == ("under_way", False)
    assert end.contact_time[0] > 1000.0
    assert end.path_length[0] > 100.0


def test_a_ball_that_grazes_hard_ground_slides_and_the_way_is_told(plain: Body) -> None:
    """Captured with its horizontal velocity: the journey is longer by the slide, in time and along the ground."""
    origin = np.array([3.0, 2.0, 100.0])
    push, speed = -float(plain.acceleration(origin)[2]), 0.01
    ground = HardSurface(0.0, 1.0, friction=0.0)
    stuck, end = (hop(plain, origin, [speed, 0.0, 1e-3], ground, friction=mu)[0] for mu in (math.inf, 0.4))
    assert (stuck.end[0], end.end[0]) == ("at_rest", "at_rest")
    assert (stuck.contact_length[0], stuck.contact_time[0]) == (0.0, 0.0)
    # Away from the middle gravity leans back by a hundredth a metre: it brakes and presses less.
    assert end.contact_length[0] == pytest.approx(speed**2 / (2.0 * 0.4 * push), rel=0.1)
    assert end.time[0] - stuck.time[0] == pytest.approx(end.contact_time[0])
    assert end.path_length[0] - stuck.path_length[0] == pytest.approx(end.contact_length[0])
    assert end.position[0] - stuck.position[0] == pytest.approx([end.contact_length[0], 0.0, 0.0], abs=5e-3)
    with pytest.raises(ValueError, match="a captured lander is above the ground"):
        hop(plain, 2.0 * origin, [0.0] * 3, ground, captured=True)


def test_a_captured_lander_rests_slides_or_is_pushed_off(spinning: Body) -> None:
    """On a slope of Didymos the rough one rests where it is, the smooth one goes downhill; at the equator it lifts."""
    (steep, _), (equator, _) = spinning.local_frame(40.0, 0.0), spinning.local_frame(0.0, 0.0)
    assert 0.05 < math.tan(float(spinning.slope(40.0, 0.0))) < 0.9

    def captured(place: np.ndarray, friction: float) -> Any:
        return hop(spinning, place, [0.0] * 3, HardSurface(0.0), captured=True, friction=friction, duration=6000.0)[0]

    rough, smooth, lifted = captured(steep, 0.9), captured(steep, 0.05), captured(equator, 0.9)
    assert (rough.end[0], rough.time[0], rough.contact_length[0], rough.touchdowns[0]) == ("at_rest", 0.0, 0.0, 1)
    assert smooth.contact_length[0] > 1.0
    assert smooth.contact_time[0] > math.sqrt(2.0 * smooth.contact_length[0] / 1e-3)
    # Downhill on a body that spins at its limit is toward the equator.
    assert abs(spinning.shape.latitude_longitude(smooth.position)[0][0]) < 40.0
    assert (lifted.end[0], lifted.contact_length[0]) == (UNKNOWN_END, 0.0)


def test_landers_together_go_as_each_alone(spinning: Body) -> None:
    """To the last bit, each from its own place, at its own time, about a body of its own mass."""
    origin, axes = spinning.local_frame([40.0, 50.0], [0.0, 90.0])
    velocity, time, mass = 0.1 * axes[:, 2] + 0.05 * axes[:, 0], np.array([5.0, 7.0]), [5e11, 5.4e11]
    settings: dict[str, Any] = {"friction": 0.6, "duration": 1e4}
    every, _ = hop(spinning, origin, velocity, HardSurface(0.7), time=time, mass=mass, **settings)
    assert every.touchdowns.max() > 4
    for one in range(2):
        alone, _ = hop(
            spinning, origin[one], velocity[one], HardSurface(0.7), time=time[one], mass=mass[one], **settings
        )
        for name in ("end", "time", "position", "spin", "touchdowns", "path_length", "contact_length"):
            assert np.array_equal(getattr(every, name)[one], getattr(alone, name)[0]), name


def test_the_flights_of_a_lander_lead_from_touchdown_to_touchdown(plain: Body, spinning: Body) -> None:
    """Made again one by one, they end to the last bit where the next begins."""
    origin, axes = spinning.local_frame(40.0, 0.0)
    landers = thrown_landers(spinning, origin, time=5.0, duration=2e4)
    thrown = Thrown(
        Bounces(HardSurface(0.7), 0, ""), (0.1 * axes[2] + 0.05 * axes[0])[None], np.zeros((1, 3)), np.zeros(1, bool)
    )
    which, ends = np.array([0]), []
    for _ in range(4):
        before = landers.time[0]
        flights = landers.go_on(which, thrown.answers(landers.impacts(which)))
        assert flights is not None
        assert flights.start.time[0] == 5.0 + before
        start = flights.start
        again = fly(
            spinning, start.position, start.velocity, 2e4 - before, gravity="exact", start_time=start.time, threads=1
        )
        assert np.array_equal(again.position, landers.position)
        assert landers.time[0] == before + again.time[0]
        if ends:
            assert np.array_equal(start.position, ends[-1])
        ends.append(landers.position.copy())
    assert landers.touchdowns[0] == 4


def test_a_lander_keeps_its_spin_among_the_stars_until_it_rests() -> None:
    directions, faces = sphere_mesh(6)
    body = Body(Shape(0.5 * np.array([193.0, 148.0, 120.0]) * directions, faces), 2.8e9, 11.3674 * 3600.0)
    body = replace(body, rotation=rotation_history(body, 86400.0, roll_deg=50.0, spin=(2e-4, 0.0, 1e-4)))
    origin, axes = body.local_frame(5.0, 40.0)
    against, begin = np.array([1e-3, -2e-3, 5e-4]), 1000.0
    end, thrown = hop(body, origin, 0.01 * axes[2], HardSurface(0.5), spin=against, time=begin, most=2, duration=2e4)

    def among_stars(at: float) -> np.ndarray:
        turn = body.spin_rate * at
        c, s = math.cos(turn), math.sin(turn)
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ body.rotation.at(at).axes[0]

    def ground(at: float) -> np.ndarray:
        return body.rotation.at(np.array([at])).whole_spin(np.array([body.spin_rate]))[0][0]

    landed = begin + end.time[0]
    before, after = among_stars(begin) @ (against + ground(begin)), thrown.seen[0].spin[0] + ground(landed)
    assert end.time[0] > 50.0
    assert among_stars(landed) @ after == pytest.approx(before, abs=1e-10)
    rest, _ = hop(body, origin, 0.01 * axes[2], HardSurface(0.0), spin=against, time=begin, friction=0.6, duration=2e4)
    assert rest.end[0] == "at_rest"


COUNT = 1500
ELASTIC = HardSurface(1.0, 1.0, 0.0, 0.0)


def rough(body: Body, roughness_deg: float, velocity: np.ndarray) -> np.ndarray:
    """Velocities after a bounce off rough elastic ground of as many landers, [COUNT, 3], body-fixed."""
    landers = thrown_landers(
        body, np.tile([0.0, 0.0, 100.0], (COUNT, 1)), roughness_deg=roughness_deg, duration=1e5, most=3
    )
    zero = np.zeros((COUNT, 3))
    thrown = Thrown(Bounces(ELASTIC, 0, ""), np.tile(velocity, (COUNT, 1)), zero, np.zeros(COUNT, bool))
    which = np.arange(COUNT)
    landers.go_on(which, thrown.answers(landers.impacts(which)))
    flights = landers.go_on(which, thrown.answers(landers.impacts(which)))
    assert flights is not None
    return flights.start.velocity


def test_an_elastic_bounce_is_mirrored_by_the_ground_that_is_met(plain: Body) -> None:
    """Straight down on a slope a lander leaves at twice the slope from the vertical, and uphill of nowhere."""
    roughness, speed = math.radians(5.0), 2e-3
    left = rough(plain, 5.0, speed * UP)
    size = np.linalg.norm(left, axis=1)
    assert size == pytest.approx(np.full(COUNT, speed), rel=1e-3)
    zenith, square = np.arccos(left[:, 2] / size), math.tan(roughness) ** 2
    law = stats.kstest(zenith, lambda angle: 1.0 - np.exp(-(np.tan(0.5 * angle) ** 2) / square))
    assert law.statistic < 1.63 / math.sqrt(COUNT)


def test_rough_ground_turns_landers_back(plain: Body) -> None:
    """Of landers that come in flat, ground that rises before them sends some back along their way."""
    velocity = 2e-3 * np.array([math.sin(math.radians(70.0)), 0.0, math.cos(math.radians(70.0))])
    smooth, steep = (rough(plain, angle, velocity) for angle in (0.01, 40.0))
    assert smooth[:, 0] == pytest.approx(np.full(COUNT, velocity[0]), rel=0.01)
    assert 0.1 < np.mean(steep[:, 0] < 0.0) < 0.9


def test_what_leaves_rough_ground_downward_meets_ground_again_at_once(plain: Body) -> None:
    """The flight ends where it begins, and the next gradient is another."""
    velocity = 2e-3 * np.array([math.sin(math.radians(70.0)), 0.0, math.cos(math.radians(70.0))])
    landers = thrown_landers(plain, np.tile([0.0, 0.0, 100.0], (200, 1)), roughness_deg=40.0)
    thrown = Thrown(
        Bounces(HardSurface(0.6, 0.8, 0.6, 1e-4), 0, ""),
        np.tile(velocity, (200, 1)),
        np.zeros((200, 3)),
        np.zeros(200, bool),
    )
    recorded = Recorded(thrown)
    follow(landers, recorded)
    normals, places, downward = {}, {}, 0
    for seen in recorded.seen:
        for lander, place, axes in zip(seen.lander.tolist(), seen.position, seen.axes, strict=True):
            # Flights begin within a tenth of a millimetre of the ground, as starts on it may.
            if lander in places and np.linalg.norm(place - places[lander]) < 1e-3:
                downward += 1
                assert not np.allclose(normals[lander], axes[2])
            normals[lander], places[lander] = axes[2], place
    assert downward > 50
    assert (landers.end == "at_rest").mean() > 0.9
