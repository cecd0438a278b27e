"""Both grounds of a binary: states that go over from one to the other, flights between them, and landers on both."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.smallbody import Body, HardSurface, Launch, Partner, Shape, fly, hop, rotation_history
from lithobrake.smallbody.flight_results import Flights, StartStates
from lithobrake.smallbody.grounds import Moments, grounds_of
from lithobrake.smallbody.landers import Landers, follow
from lithobrake.smallbody.touchdown import Answers, ImpactStates
from lithobrake.vocabulary.constants import GRAVITATIONAL_CONSTANT
from lithobrake.vocabulary.outcomes import JourneyEnd, TouchdownOutcome

from .meshes import sphere_mesh

HOUR = 3600.0
PERIOD = 11.4 * HOUR  # of the orbit
SLOW = 9.0 * HOUR  # in which the partner turns: its ground holds what lies on it everywhere
COUNT = 6


def binary(*, size: float = 1.0, longitude_deg: float = 20.0, facing_deg: float = -75.0) -> Body:
    """An ellipsoid like Dimorphos, or so many times as large, and a ball like Didymos that turns more slowly."""
    directions, faces = sphere_mesh(6)
    other = Body(Shape(390.0 * directions, faces), 5.3e11, SLOW, "other")
    shape = Shape(size * np.array([89.0, 84.0, 60.0]) * directions, faces)
    return Body(shape, 3.5e9 * size**3, PERIOD, "own", Partner(other, PERIOD, longitude_deg, facing_deg))


def tumbling(size: float = 1.0) -> Body:
    body = binary(size=size, longitude_deg=0.0)
    return replace(body, rotation=rotation_history(body, 3e5, yaw_deg=20.0, roll_deg=30.0, spin=(5e-5, 0.0, 2e-5)))


def moments(body: Body, *, own_numbers: bool) -> Moments:
    random = np.random.default_rng(4)
    change = random.uniform(0.9, 1.1, (2, COUNT)) if own_numbers else np.ones((2, COUNT))
    return Moments(random.uniform(0.0, 2e5, COUNT), body.mass * change[0], body.spin_period * change[1])


def about_z(angle: np.ndarray) -> np.ndarray:
    return Rotation.from_rotvec(np.asarray(angle)[:, None] * [0.0, 0.0, 1.0]).as_matrix()


def inertial_frames(body: Body, when: Moments) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Axes of both bodies in columns, [count, 3, 3], and place [m] and velocity [m/s] of the other one's centre, along
    axes that do not turn; from the definition of the orbit, not from the code that is tested."""
    there = body.partner
    assert there is not None
    motion, rate = 2.0 * math.pi / there.period, 2.0 * np.pi / when.spin_period
    start = math.radians(there.longitude_deg)
    first = about_z(rate * when.time)
    if body.rotation is not None:
        first = first @ body.rotation.at(when.time).axes
    second = about_z(start + math.pi - math.radians(there.facing_deg) + 2.0 * math.pi / SLOW * when.time)
    distance = body.orbit_with(GRAVITATIONAL_CONSTANT * when.mass, rate).distance
    angle = start + motion * when.time
    direction, across = (
        np.stack([np.cos(one), np.sin(one), np.zeros(COUNT)], axis=1) for one in (angle, angle + 0.5 * math.pi)
    )
    return first, second, distance[:, None] * direction, (motion * distance)[:, None] * across


def spun(axes: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    return np.einsum("nij,nj->ni", axes, vectors)


@pytest.mark.parametrize("turns", ["synchronous", "own", "tumbling"])
def test_a_change_of_the_ground_leaves_place_velocity_and_directions_among_the_stars(turns: str) -> None:
    body = tumbling() if turns == "tumbling" else binary()
    when, random = moments(body, own_numbers=turns == "own"), np.random.default_rng(5)
    own, other = grounds_of(body)
    place, velocity = random.normal(0.0, 400.0, (COUNT, 3)), random.normal(0.0, 0.3, (COUNT, 3))
    first, second, centre, drift = inertial_frames(body, when)
    spin_of_other = np.tile([0.0, 0.0, 2.0 * math.pi / SLOW], (COUNT, 1))
    assert other.spin(when) == pytest.approx(spin_of_other, rel=1e-15)
    # As it stands on the other body, and as flights have it.
    from_other = centre + spun(second, place), drift + spun(second, velocity + np.cross(spin_of_other, place))
    here, rate = other.states_of_flights(place, velocity, when)
    from_own = spun(first, here), spun(first, rate + np.cross(own.spin(when), here))
    for one, same, size in zip(from_own, from_other, (1e3, 0.3), strict=True):
        assert np.abs(one - same).max() < 1e-12 * size
    matrices = other.turns(when)
    assert matrices is not None
    from_stars = np.einsum("nij,nkj->nik", matrices, first)
    assert np.abs(from_stars - second.transpose(0, 2, 1)).max() < 1e-13
    # The way back is that of the ends of flights.
    zero = np.zeros(COUNT)
    flights = Flights(
        body, StartStates(when.time, here, rate, when.mass, when.spin_period), np.full(COUNT, "partner"), zero, here,
        rate, np.zeros(COUNT, dtype=np.int64), np.zeros(COUNT, dtype=np.int64),
    )  # fmt: skip
    assert np.abs(flights.on_ground[0] - place).max() < 1e-9
    assert np.abs(flights.on_ground[1] - velocity).max() < 1e-12


def test_flights_from_the_partner_are_those_about_it() -> None:
    """The same flights with the roles of the two bodies changed: both integrate other equations to one motion."""
    body = binary()
    about, (_, other) = body.seen_from_partner, grounds_of(body)
    random = np.random.default_rng(6)
    up = random.normal(size=(COUNT, 3))
    start = about.shape.surface_point(*about.shape.latitude_longitude(up))
    normals = about.shape.normals[about.shape.nearest(start)[1]]
    velocity = normals * random.uniform(0.1, 0.45, COUNT)[:, None] + random.normal(0.0, 0.05, (COUNT, 3))
    time = random.uniform(0.0, 1e5, COUNT)
    when = Moments(time, np.full(COUNT, body.mass), np.full(COUNT, body.spin_period))
    there = fly(about, start, velocity, 2e4, start_time=time, tolerance=1e-11)
    here = fly(body, *other.states_of_flights(start, velocity, when), 2e4, start_time=time, tolerance=1e-11)
    assert (there.status == "impact").any()
    named = {"impact": "partner", "partner": "impact"}
    assert here.status.tolist() == [named.get(word, word) for word in there.status.tolist()]
    assert np.abs(here.time - there.time).max() < 1e-3
    ended = here.status == "partner"
    assert np.abs(here.on_ground[0][ended] - there.position[ended]).max() < 1e-4
    aloft = here.status == "flying"
    then = Moments(time + here.time, when.mass, when.spin_period)
    assert (
        np.abs(other.states_of_flights(there.position, there.velocity, then)[0][aloft] - here.position[aloft]).max(
            initial=0.0
        )
        < 1e-2
    )


def test_energy_and_momentum_are_kept_over_the_change_of_the_ground() -> None:
    """Near the other body alone nothing but its own attraction acts: its Jacobi constant is that of either frame."""
    body = binary()
    _, other = grounds_of(body)
    about = body.seen_from_partner
    start = about.shape.surface_point(5.0, 100.0)[None]
    velocity = 0.12 * about.shape.normals[about.shape.nearest(start)[1]]
    when = Moments(np.array([2e4]), np.array([body.mass]), np.array([body.spin_period]))
    flight = fly(body, *other.states_of_flights(start, velocity, when), 1e5, start_time=2e4, tolerance=1e-11)
    assert flight.status[0] == "partner"
    place, rate = flight.on_ground
    alone, spin = about.partner and replace(about, partner=None), 2.0 * math.pi / SLOW

    def jacobi(where: np.ndarray, how: np.ndarray) -> float:
        turning = spin**2 * float(where[0, 0] ** 2 + where[0, 1] ** 2)
        return 0.5 * (float((how**2).sum()) - turning) - float(alone.potential(where[0]))

    # The small body changes it by its tide: G m r^2 / d^3 = 2e-5 m2/s2, of 0.07.
    assert jacobi(place, rate) == pytest.approx(jacobi(start, velocity), abs=5e-5)
    assert flight.time[0] > 100.0


def test_what_is_felt_on_the_partner_is_how_a_slow_flight_begins() -> None:
    body = binary()
    _, other = grounds_of(body)
    about = body.seen_from_partner
    point = about.shape.surface_point([20.0, -50.0], [-40.0, 130.0])
    up = about.shape.normals[about.shape.nearest(point)[1]]
    when = Moments(np.array([1e3, 7e4]), np.full(2, body.mass), np.full(2, body.spin_period))
    felt = other.felt(point, when)
    # The swapped body has the same numbers, and its own code for what is felt.
    numbers = np.full(2, about.mass), np.full(2, about.spin_period)
    assert np.abs(felt - about.felt(point, when.time, *numbers)).max() < 1e-12 * np.abs(felt).max()
    speed = 1e-3
    flight = fly(body, *other.states_of_flights(point, speed * up, when), 5.0, start_time=when.time, tolerance=1e-12)
    later = Moments(when.time + flight.time, when.mass, when.spin_period)
    about_it = fly(about, point, speed * up, 5.0, start_time=when.time, tolerance=1e-12)
    change = (about_it.velocity - speed * up) / about_it.time[:, None]
    assert np.abs(change - felt).max() < 3.0 * speed * other.spin(later)[0, 2]


def thrown_between(speed: float, duration: float = 4e5) -> tuple[Body, Landers]:
    """Landers thrown off the near side of the first body toward the other one, on bouncy ground."""
    body = binary(longitude_deg=0.0, facing_deg=0.0)
    origin, axes = body.local_frame(np.linspace(-20.0, 20.0, 5), np.linspace(-30.0, 30.0, 5))
    launch = Launch(origin, speed * axes[:, 2], spin=(1e-3, 2e-3, -1e-3))
    return body, hop(body, launch, HardSurface(0.5, 0.7, 0.5), duration, friction=0.6, gravity="exact", threads=1)


def test_landers_that_reach_the_partner_come_to_rest_there() -> None:
    body, landers = thrown_between(0.08)
    over = landers.ground == 1
    assert over.sum() >= 2
    assert body.partner is not None
    height = np.abs(body.partner.body.shape.height(landers.position[over]))
    assert set(landers.end[over].tolist()) == {JourneyEnd.PARTNER}
    assert landers.is_down[over].all()
    assert height.max() < 1e-6
    assert (landers.touchdowns[over] > 2).all()
    # It keeps what it had on the way, and what is on the first body is at rest there.
    assert set(landers.end[~over].tolist()) <= {JourneyEnd.AT_REST, JourneyEnd.ESCAPED, JourneyEnd.UNDER_WAY}


class Pushes:
    """Touchdowns that throw landers off the partner along their normal, once, and capture all others."""

    def __init__(self, speed: float) -> None:
        self.speed, self.seen = speed, list[ImpactStates]()

    def answers(self, impacts: ImpactStates) -> Answers:
        found = Answers.unknown(len(impacts))
        self.seen.append(impacts)
        first = impacts.number == 0
        found.outcome[:] = np.where(first, TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED)
        found.velocity[:, 2] = np.where(first, self.speed, 0.0)
        found.spin[:] = [2e-3, 1e-3, -3e-3]
        found.attitude[:] = [Rotation.from_rotvec([0.1, 0.2, 0.3])] * len(impacts)
        return found


def landers_on_partner(body: Body, latitude: np.ndarray, longitude: np.ndarray, **changes: float) -> Landers:
    there = body.partner
    assert there is not None
    position, axes = there.body.local_frame(latitude, longitude)
    count = len(position)
    numbers = {name: np.zeros(count) for name in ("start", "speed", "incidence_deg", "mean_incidence_deg")}
    landers = Landers(
        body=body, duration=changes.get("duration", 2e5), gravity="exact", most=50, threads=1,
        mass=np.full(count, body.mass), spin_period=np.full(count, body.spin_period), position=position, axes=axes,
        spin=np.zeros((count, 3)), **numbers,
    )  # fmt: skip
    landers.ground[:] = 1
    return landers


def thrown_back(body: Body) -> tuple[Landers, Pushes]:
    """Landers thrown off a row around the equator of the partner, fast enough to pass the point between the two."""
    landers, touchdowns = landers_on_partner(body, np.zeros(24), np.linspace(-175.0, 170.0, 24)), Pushes(0.37)
    return follow(landers, touchdowns), touchdowns


def test_a_lander_flies_back_from_the_partner_and_rests_at_home() -> None:
    body = binary(size=2.0, longitude_deg=0.0, facing_deg=0.0)
    landers, _ = thrown_back(body)
    home = landers.end == JourneyEnd.AT_REST
    assert home.any()
    assert (landers.ground[home] == 0).all()
    assert np.abs(body.shape.height(landers.position[home])).max() < 1e-6
    assert (landers.end[landers.ground == 1] == JourneyEnd.PARTNER).all()


@pytest.mark.parametrize("tumbles", [False, True])
def test_spin_and_attitude_among_the_stars_stay_from_one_ground_to_the_other(tumbles: bool) -> None:
    """A ball keeps its spin, and its attitude turns by that, seen from either body."""
    body = tumbling(size=2.0) if tumbles else binary(size=2.0, longitude_deg=0.0)
    start = landers_on_partner(body, np.zeros(24), np.linspace(-175.0, 170.0, 24)).axes
    later = thrown_back(body)[1].seen[1]
    assert set(later.ground.tolist()) == {0, 1}
    for place, lander in enumerate(later.lander.tolist()):
        whole, axes = among_stars(body, 1, 0.0, start[lander].T @ [2e-3, 1e-3, -3e-3])
        own, there = among_stars(body, int(later.ground[place]), float(later.clock[place]), later.spin[place])
        assert np.abs(own - whole).max() < 1e-12
        begun = axes * Rotation.from_matrix(start[lander].T) * Rotation.from_rotvec([0.1, 0.2, 0.3])
        found = later.attitude[place]
        assert found is not None
        turned = Rotation.from_rotvec(whole * later.clock[place]) * begun
        assert (turned.inv() * there * found).magnitude() < 1e-8


def among_stars(body: Body, ground: int, time: float, spin: np.ndarray) -> tuple[np.ndarray, Rotation]:
    """A spin against the ground [rad/s] as one against the stars, along axes that do not turn, and the body's axes."""
    when = Moments(np.array([time] * COUNT), np.full(COUNT, body.mass), np.full(COUNT, body.spin_period))
    axes = inertial_frames(body, when)[ground][0]
    return axes @ (spin + grounds_of(body)[ground].spin(when)[0]), Rotation.from_matrix(axes)


def test_landers_on_both_grounds_go_as_each_alone() -> None:
    """To the last bit, also those of them that change over."""
    body, every = thrown_between(0.08)
    assert every.ground[0] != every.ground[2]
    for one in (0, 2):
        origin, axes = body.local_frame(np.linspace(-20.0, 20.0, 5), np.linspace(-30.0, 30.0, 5))
        launch = Launch(origin[one], 0.08 * axes[one, 2], spin=(1e-3, 2e-3, -1e-3))
        alone = hop(body, launch, HardSurface(0.5, 0.7, 0.5), 4e5, friction=0.6, gravity="exact", threads=1)
        for name in ("end", "ground", "time", "position", "spin", "touchdowns", "path_length"):
            assert np.array_equal(getattr(every, name)[one], getattr(alone, name)[0]), name


def test_a_planet_is_no_ground_for_landers() -> None:
    directions, faces = sphere_mesh(3)
    mars = Body(Shape(3.39e6 * directions, faces), 6.417e23, 27_553.8, "Mars")
    shape = Shape(11e3 * directions, faces)
    phobos = Body(shape, 1.06e16, 27_553.8, "Phobos", Partner(mars, 27_553.8))
    assert len(grounds_of(phobos)) == 1
    assert len(grounds_of(binary())) == 2
    assert len(grounds_of(replace(binary(), partner=None))) == 1
    found = hop(phobos, Launch(phobos.shape.surface_point(0.0, 0.0), [800.0, 1800.0, 0.0]), HardSurface(0.5), 2e4)
    assert (found.end[0], bool(found.is_down[0])) == (JourneyEnd.PARTNER, False)
