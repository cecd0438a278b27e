"""Bounces on hard, rough and tabulated ground, ways along the ground, and journeys made of flights and bounces."""

import dataclasses
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from scipy import integrate, stats

from lithobrake.smallbody import (
    Body,
    HardSurface,
    Impacts,
    Launch,
    Rebounds,
    RestitutionTable,
    RoughGround,
    Shape,
    didymos,
    fly,
    hop,
    incidence_on,
    met_normals,
)
from lithobrake.smallbody.bounce import LEVELS, cells
from lithobrake.smallbody.sliding import NEAR, ROLLING_INERTIA, OnGround, Slides, slide

from .meshes import CUBE_FACES, cube_vertices, sphere_mesh


@pytest.fixture(scope="module")
def plain() -> Body:
    """A cube of 200 m that does not turn: near the middle of its top, gravity is nearly plumb and constant."""
    return Body(Shape(cube_vertices(200.0), CUBE_FACES), mass=2e10, spin_period=math.inf)


def impacts(speed: float, incidence: float, outward: float = -1e-4) -> Impacts:
    return Impacts(np.array([speed]), np.array([incidence]), np.zeros((1, 3)), np.array([outward]), np.arange(1))


def test_hard_surface_limits_the_tangential_impulse_by_friction():
    random = np.random.default_rng(0)
    steep = HardSurface(0.6, 0.5, friction=0.3)(impacts(0.2, 0.2), random)
    down, along = 0.2 * math.cos(0.2), 0.2 * math.sin(0.2)
    # Steep: friction could stop more than is lost; half of the horizontal speed is kept.
    assert steep.velocity[0] == pytest.approx([0.5 * along, 0.0, 0.6 * down])
    flat = HardSurface(0.6, 0.5, friction=0.3)(impacts(0.2, 1.4), random)
    down, along = 0.2 * math.cos(1.4), 0.2 * math.sin(1.4)
    # Flat: it slides, and loses friction times the normal impulse.
    assert flat.velocity[0] == pytest.approx([along - 0.3 * 1.6 * down, 0.0, 0.6 * down])
    assert not steep.captured[0]
    assert HardSurface(0.6)(impacts(1e-4, 0.0), random).captured[0]
    assert not HardSurface(0.6)(impacts(1e-4, 0.0, outward=1e-5), random).captured[0]
    with pytest.raises(ValueError, match="normal_restitution is"):
        HardSurface(1.2)


def test_bounces_of_a_ball_follow_the_geometric_series(plain):
    """Thrown up at v from a plane it bounces at e v, e e v ...: flights of 2 v / g, 2 e v / g ..."""
    origin = np.array([3.0, 2.0, 100.0])
    push = -float(plain.acceleration(origin)[2])
    speed, restitution = 0.004, 0.5
    surface = HardSurface(restitution, rest_height=1e-3)
    end = hop(plain, Launch(origin, [0.0, 0.0, speed]), surface, 86400.0, gravity="exact")
    assert end.status[0] == "settled"
    # A rebound of e**n v rises (e**n v)**2 / 2 g; the first one below the height of rest is the end.
    rebounds = math.floor(math.log(math.sqrt(2.0 * push * 1e-3) / speed) / math.log(restitution))
    assert end.bounce_count[0] == rebounds
    # Gravity weakens by some thousandths over the 0.09 m that the first flight rises.
    expected = 2.0 * speed / push * (1.0 - restitution ** (rebounds + 1)) / (1.0 - restitution)
    assert end.time[0] == pytest.approx(expected, rel=5e-3)
    assert end.latitude[0] == pytest.approx(math.degrees(math.atan2(100.0, math.hypot(3.0, 2.0))), abs=0.1)


def test_journeys_end_in_each_way(plain):
    start, up = np.array([3.0, 2.0, 100.0]), np.array([0.0, 0.0, 1.0])

    def unknown(hit: Impacts, random: np.random.Generator) -> Rebounds:
        nothing = np.zeros(len(hit.speed), dtype=bool)
        return Rebounds(np.full((len(hit.speed), 3), np.nan), hit.spin, nothing, ~nothing)

    assert hop(plain, Launch(start, 0.01 * up), unknown, 1e5, gravity="exact").status[0] == "outside"
    assert hop(plain, Launch(start, 0.01 * up), HardSurface(1.0), 1e3, gravity="exact").status[0] == "flying"
    assert hop(plain, Launch(start, 1.0 * up), HardSurface(1.0), 1e5, gravity="exact").status[0] == "escaped"
    limited = hop(plain, Launch(start, 0.002 * up), HardSurface(1.0), 1e5, gravity="exact", bounce_limit=3)
    assert (limited.status[0], limited.bounce_count[0]) == ("bouncing", 3)


def test_a_launch_has_one_value_for_all_landers_or_one_for_each(plain):
    place = np.array([[3.0, 2.0, 100.0], [-3.0, 1.0, 100.0]])
    with pytest.raises(ValueError, match=r"launch: mass has shape \(3,\) for 2 landers; it must be \(\)"):
        hop(plain, Launch(place, [0.0, 0.0, 0.01], mass=[1e10, 2e10, 3e10]), HardSurface(0.5), 1e3)
    told: list[float] = []
    nobody = hop(plain, Launch(place[:0], place[:0]), HardSurface(0.5), 1e3, gravity="exact", progress=told.append)
    assert (len(nobody.status), told) == (0, [1.0])


def test_the_frame_of_an_impact_and_the_spin_are_carried(plain):
    """A bounce that turns by a right angle to the left of the way it came, and gives a spin about the normal."""

    def aside(hit: Impacts, random: np.random.Generator) -> Rebounds:
        along = hit.speed * np.sin(hit.incidence)
        up = hit.speed * np.cos(hit.incidence)
        spin = np.tile([0.0, 0.0, 0.5], (len(along), 1))
        none = np.zeros(len(along), dtype=bool)
        return Rebounds(np.stack([0.0 * along, along, up], axis=1), spin, none, none)

    start = np.array([-1.0, 0.3, 100.0])
    end = hop(plain, Launch(start, [0.01, 0.0, 0.01]), aside, 1e5, gravity="exact", bounce_limit=1)
    first = hop(plain, Launch(start, [0.01, 0.0, 0.01]), aside, 1e5, gravity="exact", bounce_limit=0)
    assert first.position[0, 0] > start[0] + 0.5
    assert abs(first.position[0, 1] - start[1]) < 0.1
    assert end.position[0, 1] > first.position[0, 1] + 0.5
    assert end.spin[0] == pytest.approx([0.0, 0.0, 0.5])
    again = hop(plain, Launch(start, [0.01, 0.0, 0.01]), aside, 1e5, gravity="exact", bounce_limit=1)
    assert np.array_equal(again.position, end.position)


def test_a_bounce_is_told_which_lander_it_is(plain):
    """The second of three lands and stays; the others bounce once more, and each keeps the last impact it had."""
    seen = []

    def only_the_second_stays(hit: Impacts, random: np.random.Generator) -> Rebounds:
        seen.append(hit.lander.tolist())
        up = np.stack([0.0 * hit.speed, 0.0 * hit.speed, 0.5 * hit.speed], axis=1)
        return Rebounds(up, hit.spin, hit.lander == 1, np.zeros(len(hit.speed), dtype=bool))

    start, up = np.array([[3.0, 2.0, 100.0], [-3.0, 1.0, 100.0], [0.0, 4.0, 100.0]]), np.array([0.0, 0.0, 4e-3])
    end = hop(plain, Launch(start, up), only_the_second_stays, 1e5, gravity="exact", bounce_limit=1)
    assert seen == [[0, 1, 2]]
    assert end.status.tolist() == ["bouncing", "settled", "bouncing"]
    assert end.impact_speed == pytest.approx([2e-3, 4e-3, 2e-3], rel=5e-3)
    assert (end.incidence < 0.1).all()
    away = hop(plain, Launch(start[0], 250.0 * up), only_the_second_stays, 1e5, gravity="exact")
    assert away.status[0] == "escaped"
    assert np.isnan(away.impact_speed[0])


def test_a_lander_that_only_its_own_motion_holds_down_slides_until_it_leaves_the_ground():
    """Westward along the equator of Didymos it stays down, though the ground there throws off what lies on it."""
    body = didymos(partner=False)
    origin, axes = body.local_frame(0.0, 0.0, 270.0)
    assert axes[2] @ body.effective_acceleration(origin) > 0.0
    launch = Launch(origin, 0.15 * axes[0])
    stuck = hop(body, launch, HardSurface(0.6), 1e5, gravity="exact")
    assert (stuck.status[0], stuck.slid_length[0]) == ("lofted", 0.0)
    assert 5 < stuck.bounce_count[0] < 100
    # Friction takes the motion that holds it down, and the spin throws it off.
    short = hop(body, launch, HardSurface(0.6), 4000.0, friction=0.1, gravity="exact")
    assert short.status[0] == "sliding"
    assert short.slid_time[0] > 3000.0
    end = hop(body, launch, HardSurface(0.6), 1e5, friction=0.6, gravity="exact")
    assert end.status[0] == "flying"
    assert end.slid_time[0] > 1000.0
    assert end.path_length[0] > 100.0


def test_flights_that_are_noted_lead_from_bounce_to_bounce_and_change_nothing():
    """Made again one by one, they end to the last bit where the next begins; the ends of journeys stay the same."""
    body = didymos(partner=False)
    origin, axes = body.local_frame([40.0, 0.0, 50.0], [0.0, 10.0, 90.0])
    launch = Launch(origin, 0.1 * axes[:, 2] + 0.05 * axes[:, 0], time=[5.0, 6.0, 7.0], mass=[5e11, 5.2e11, 5.4e11])
    settings = {"friction": 0.6, "gravity": "exact"}
    noted = hop(body, launch, HardSurface(0.7), 2e4, arc_landers=2, **settings)
    plain = hop(body, launch, HardSurface(0.7), 2e4, **settings)
    for name in ("status", "time", "position", "spin", "bounce_count", "path_length", "slid_length", "impact_speed"):
        assert np.array_equal(getattr(noted, name), getattr(plain, name), equal_nan=name == "impact_speed"), name
    arcs = noted.arcs
    assert len(plain.arcs.lander) == 0
    assert sorted(set(arcs.lander.tolist())) == [0, 1]
    assert (np.diff(arcs.lander) >= 0).all()
    again = fly(*(body, arcs.position, arcs.velocity, 2e4 - arcs.begin), gravity="exact", start_time=arcs.clock,
        mass=arcs.mass, spin_period=arcs.spin_period)  # fmt: skip
    assert np.array_equal(arcs.begin + again.time, arcs.end)
    follows = (arcs.lander[1:] == arcs.lander[:-1]) & (arcs.begin[1:] == arcs.end[:-1])
    assert follows.sum() > 3
    assert np.array_equal(again.position[:-1][follows], arcs.position[1:][follows])
    assert np.array_equal(arcs.clock, np.array([5.0, 6.0])[arcs.lander] + arcs.begin)
    assert (arcs.end[np.searchsorted(arcs.lander, [0, 1], side="right") - 1] <= noted.time[:2]).all()


def test_between_flights_a_lander_may_slide():
    """What is captured on steep ground begins its first flight after it has slid off the ground."""
    body = didymos(partner=False)
    origin, axes = body.local_frame(0.0, 0.0, 270.0)
    end = hop(body, Launch(origin, 0.15 * axes[0]), HardSurface(0.6), 1e5, friction=0.6, gravity="exact", arc_landers=1)
    gaps = end.arcs.begin[1:] - end.arcs.end[:-1]
    assert (gaps >= 0.0).all()
    assert gaps.sum() + end.arcs.begin[0] == pytest.approx(end.slid_time[0])


@pytest.mark.parametrize("friction", [-1.0, math.nan])
def test_a_friction_below_0_is_refused(plain, friction):
    with pytest.raises(ValueError, match=r"friction is .* at least 0"):
        hop(plain, Launch([0.0, 0.0, 1.0], [0.0, 0.0, 0.0]), HardSurface(1.0), 1.0, friction=friction)


def even(lower: float, upper: float) -> np.ndarray:
    """Quantiles of a uniform law, the same in all of 2 by 1 cells."""
    return np.tile(np.interp(LEVELS, [0.0, 1.0], [lower, upper]), (2, 1, 1))


TABLE = RestitutionTable(
    np.array([0.0, 0.1, 0.2]), np.array([0.0, 90.0]),
    {"normal_restitution": even(0.2, 0.6) * [[[1.0]], [[0.5]]], "tangential_restitution": even(0.5, 0.9),
     "azimuth_deg": even(-30.0, 30.0), "friction": even(0.1, 0.3)},
    np.array([[0.8], [0.0]]), np.array([[0.0], [0.25]]), np.array([[400], [300]]), np.array([[12], [10]]),
    rest_height=0.0,
)  # fmt: skip


def alike_impacts(speed: float, count: int = 20_000) -> Impacts:
    every = np.ones(count)
    return Impacts(speed * every, np.radians(60.0) * every, np.zeros((count, 3)), -1e-4 * every, np.arange(count))


def test_draws_have_the_quantiles_and_the_correlation_of_their_cell() -> None:
    found = TABLE(alike_impacts(0.05), np.random.default_rng(1))
    normal = found.velocity[:, 2] / (0.05 * np.cos(np.radians(60.0)))
    along = np.hypot(found.velocity[:, 0], found.velocity[:, 1]) / (0.05 * np.sin(np.radians(60.0)))
    # A uniform law over 0.4 has this deviation; four standard errors of the mean.
    luck = 4 * 0.4 / np.sqrt(12 * 20_000)
    assert normal.mean() == pytest.approx(0.4, abs=luck)
    assert along.mean() == pytest.approx(0.7, abs=luck)
    # Uniform scores of normal ones that correlate by 0.8: 6/pi asin(0.4).
    assert np.corrcoef(normal, along)[0, 1] == pytest.approx(6 / np.pi * np.arcsin(0.4), abs=0.02)
    assert np.abs(np.degrees(np.arctan2(found.velocity[:, 1], found.velocity[:, 0]))).max() <= 30.0
    assert not found.captured.any()


def test_an_impact_beyond_the_table_is_that_of_the_next_cell_and_some_stay() -> None:
    found = TABLE(alike_impacts(5.0), np.random.default_rng(2))
    assert found.captured.mean() == pytest.approx(0.25, abs=4 * np.sqrt(0.25 * 0.75 / 20_000))
    assert (found.velocity[:, 2] / (5.0 * np.cos(np.radians(60.0)))).max() <= 0.3
    assert cells(TABLE.speed, np.array([-1.0, 0.0, 0.1, 0.2, 9.0])).tolist() == [0, 0, 1, 1, 1]


def test_a_rebound_that_hardly_rises_is_the_end() -> None:
    assert dataclasses.replace(TABLE, rest_height=1.0)(alike_impacts(1e-3), np.random.default_rng(3)).captured.all()


def test_a_table_is_read_as_it_was_written(tmp_path: Path) -> None:
    TABLE.save(tmp_path / "table.csv")
    read = RestitutionTable.read(tmp_path / "table.csv", rest_height=0.0)
    one, other = (table(alike_impacts(0.05, 50), np.random.default_rng(4)).velocity for table in (TABLE, read))
    assert np.array_equal(one, other)
    assert (read.runs.tolist(), read.captured.tolist()) == ([[12], [10]], [[0.0], [0.25]])
    assert (tmp_path / "table.csv").read_text().startswith("speed_from [m/s],speed_to [m/s],incidence_from_deg,")


PULL = 1e-4  # m/s2


@dataclass(frozen=True)
class Slab(Body):
    """A cube whose gravity is the same everywhere and leans by slope [rad] toward +x on its upper face."""

    slope: float = 0.0

    def effective_acceleration(self, points, *, mass=None, spin_period=None, time=0.0):
        """The same [m/s2] at all points [m], [..., 3]."""
        return np.broadcast_to(PULL * np.array([math.sin(self.slope), 0.0, -math.cos(self.slope)]), points.shape).copy()


def slab(slope: float, edge: float = 2000.0) -> Slab:
    return Slab(Shape(cube_vertices(edge), CUBE_FACES), mass=1e10, spin_period=math.inf, slope=slope)


def sphere(frequency: int = 12, spin_period: float = math.inf) -> Body:
    """A radius of 100 m, 1e10 kg."""
    directions, faces = sphere_mesh(frequency)
    return Body(Shape(100.0 * directions, faces), mass=1e10, spin_period=spin_period)


def slid(body: Body, position, velocity, friction: float, duration: float = 1e6, *, rolls: bool = False) -> Slides:
    place = np.array([position], dtype=float)
    one = [np.array([value]) for value in (friction, body.mass, body.spin_period, 0.0)]
    ground = OnGround(body, body.shape.nearest(place)[1], *one, rolls)
    return slide(ground, place, np.array([velocity], dtype=float), np.array([duration]))


@pytest.mark.parametrize("rolls", [False, True])
@pytest.mark.parametrize(("slope", "friction"), [(0.0, 0.5), (0.2, 0.5), (-0.2, 0.5)])
def test_a_block_stops_after_its_speed_squared_over_twice_what_brakes_it(slope, friction, rolls):
    """v^2 / 2 g (mu cos s - sin s), for a ball that rolls by its turning more; uphill for a slope below 0."""
    speed, inertia = 0.05, 1.0 + ROLLING_INERTIA if rolls else 1.0
    end = slid(slab(slope), [-300.0, 40.0, 1000.0], [speed, 0.0, 0.0], friction, rolls=rolls)
    braking = PULL * (friction * math.cos(slope) - math.sin(slope)) / inertia
    assert end.rests[0]
    assert end.length[0] == pytest.approx(speed**2 / (2.0 * braking), rel=1e-9)
    assert end.time[0] == pytest.approx(speed / braking, rel=1e-9)
    assert end.position[0] == pytest.approx([-300.0 + end.length[0], 40.0, 1000.0], abs=1e-6)
    assert not end.velocity.any()


def test_a_block_on_a_slope_steeper_than_its_friction_never_stops():
    """tan s > mu: from rest it goes g (sin s - mu cos s) t^2 / 2 until the time is over; below that it does not go."""
    slope, friction, time = 0.5, 0.5, 1000.0
    assert math.tan(slope) > friction
    end = slid(slab(slope), [-300.0, 40.0, 1000.0], [0.0, 0.0, 0.0], friction, time)
    assert (end.rests[0], end.leaves[0], end.time[0]) == (False, False, pytest.approx(time))
    assert end.length[0] == pytest.approx(0.5 * PULL * (math.sin(slope) - friction * math.cos(slope)) * time**2)
    held = slid(slab(slope), [-300.0, 40.0, 1000.0], [0.0, 0.0, 0.0], 0.55, time)
    assert (held.rests[0], held.length[0], held.time[0]) == (True, 0.0, 0.0)


def test_a_block_that_stops_uphill_of_a_steep_slope_comes_back_down():
    """v^2 / 2 g (mu cos s + sin s) up, and from there down from rest."""
    slope, friction, speed, time = -0.2, 0.1, 0.05, 8000.0
    end = slid(slab(slope), [-300.0, 40.0, 1000.0], [speed, 0.0, 0.0], friction, time)
    up, down = (PULL * (math.sin(0.2) + sign * friction * math.cos(0.2)) for sign in (1.0, -1.0))
    height, back = 0.5 * speed**2 / up, 0.5 * down * (time - speed / up) ** 2
    assert end.velocity[0] == pytest.approx([-down * (time - speed / up), 0.0, 0.0])
    assert end.position[0] == pytest.approx([-300.0 + height - back, 40.0, 1000.0])
    assert (end.rests[0], end.leaves[0]) == (False, False)


def test_a_block_across_a_slope_ends_downhill_where_its_equations_end():
    """Against an integration in small steps of v' = g sin s e_x - mu g cos s v / |v|."""
    slope, friction, speed, step = 0.3, 0.5, 0.05, 0.1
    position, velocity = np.zeros(2), np.array([0.0, speed])
    down, grip = np.array([PULL * math.sin(slope), 0.0]), friction * PULL * math.cos(slope)
    while np.linalg.norm(velocity) > grip * step:
        middle = velocity + 0.5 * step * (down - grip * velocity / np.linalg.norm(velocity))
        position += step * middle
        velocity += step * (down - grip * middle / np.linalg.norm(middle))
    end = slid(slab(slope), [-300.0, 40.0, 1000.0], [0.0, speed, 0.0], friction)
    assert end.rests[0]
    # A step turns the velocity by a tenth: by the rule of the middle some thousandths are lost.
    assert end.position[0, :2] - [-300.0, 40.0] == pytest.approx(position, rel=5e-3)


def test_a_block_on_a_sphere_goes_as_far_as_its_weight_lets_it():
    """d(v^2)/ds = -2 mu (g - v^2 / r) on a sphere that does not turn: r ln(g r / (g r - v^2)) / 2 mu."""
    body, friction = sphere(), 0.3
    limit = body.gravitational_parameter / 100.0
    for share in (0.2, 0.7):
        expected = -100.0 / (2.0 * friction) * math.log(1.0 - share**2)
        ways = []
        for latitude, heading in ((10.0, 90.0), (20.0, 30.0), (-35.0, 200.0), (50.0, 310.0)):
            origin, axes = body.local_frame(latitude, 11.0, heading)
            end = slid(body, origin, share * math.sqrt(limit) * axes[0], friction)
            assert end.rests[0]
            ways.append(end.length[0])
        # Of 1152 facets; of 18432 it is right to a thousandth, so the rest is the shape's.
        assert np.mean(ways) == pytest.approx(expected, rel=0.04)


def test_what_is_faster_than_a_grazing_orbit_leaves_the_ground_at_an_edge():
    body = sphere()
    origin, axes = body.local_frame(10.0, 11.0, 90.0)
    circular = math.sqrt(body.gravitational_parameter / 100.0)
    end = slid(body, origin, 1.2 * circular * axes[0], 0.3)
    assert (end.rests[0], end.leaves[0]) == (False, True)
    assert end.length[0] < 10.0
    assert body.shape.height(end.position[0]) == pytest.approx(0.0, abs=1e-9)


def test_at_the_equator_of_a_fast_body_a_lander_lifts_off_and_elsewhere_it_rests():
    """Where spin^2 r is above g; infinite friction asks nothing else."""
    rate = math.sqrt(sphere().gravitational_parameter / 100.0**3)
    for ratio, lofted in ((0.97, False), (1.03, True)):
        body = sphere(spin_period=2.0 * math.pi / (ratio * rate))
        origin, _ = body.local_frame(0.0, 11.0)
        end = hop(body, Launch(origin, [0.0] * 3, captured=True), HardSurface(0.6), 1e4, gravity="exact")
        assert (end.status[0], end.time[0]) == ("lofted" if lofted else "settled", 0.0)
    body = sphere(spin_period=2.0 * math.pi / (1.03 * rate))
    polar, _ = body.local_frame(85.0, 11.0)
    still = hop(body, Launch(polar, [0.0] * 3, captured=True), HardSurface(0.6), 1e4, friction=0.6, gravity="exact")
    assert still.status[0] == "settled"


def test_a_lander_rests_in_the_trough_between_facets_that_are_both_too_steep():
    vertices, faces = sphere_mesh(4)
    # A belt drawn in: northern facets slope down to it, and so do the southern ones.
    radius = np.where(np.abs(vertices[:, 2]) < 1e-9, 60.0, 100.0)
    body = Body(Shape(radius[:, None] * vertices, faces), mass=1e10, spin_period=math.inf)
    origin, _ = body.local_frame(math.degrees(math.atan2(6.0, 60.0)), 12.0)
    end = slid(body, origin, np.zeros(3), 0.3, 1e7)
    assert end.rests[0]
    assert 1.0 < end.length[0] < 100.0
    assert abs(end.position[0, 2]) < 10.0 * NEAR


def test_a_ball_that_grazes_hard_ground_slides_and_the_way_is_told():
    """Captured with its horizontal velocity: the journey is longer by the slide, in time and along the ground."""
    body = Body(Shape(cube_vertices(200.0), CUBE_FACES), mass=2e10, spin_period=math.inf)
    origin = np.array([3.0, 2.0, 100.0])
    push, speed = -float(body.acceleration(origin)[2]), 0.01
    launch = Launch(origin, [speed, 0.0, 1e-3])
    ground = HardSurface(0.0, 1.0, friction=0.0)
    stuck, end = (hop(body, launch, ground, 1e5, friction=mu, gravity="exact") for mu in (math.inf, 0.4))
    assert (stuck.status[0], end.status[0]) == ("settled", "settled")
    assert (stuck.slid_length[0], stuck.slid_time[0]) == (0.0, 0.0)
    # Away from the middle gravity leans back by a hundredth a metre: it brakes and presses less.
    assert end.slid_length[0] == pytest.approx(speed**2 / (2.0 * 0.4 * push), rel=0.1)
    assert end.time[0] - stuck.time[0] == pytest.approx(end.slid_time[0])
    assert end.position[0] - stuck.position[0] == pytest.approx([end.slid_length[0], 0.0, 0.0], abs=5e-3)
    with pytest.raises(ValueError, match="a captured lander is above the ground"):
        hop(body, Launch(2.0 * origin, [0.0] * 3, captured=True), ground, 1e5)


COUNT = 20_000
# Of the largest distance between a law and so many draws of it, beyond which one in a hundred lies.
FARTHEST = 1.63 / math.sqrt(COUNT)
ELASTIC = HardSurface(1.0, 1.0, 0.0, 0.0)


def gradients(roughness_deg: float, incidence_deg: float) -> np.ndarray:
    """Gradients of the ground that is met, along the way and to its left, [count, 2]; up is z, the way along x."""
    angle = math.radians(incidence_deg)
    velocity = np.tile([0.3 * math.sin(angle), 0.0, -0.3 * math.cos(angle)], (COUNT, 1))
    up = np.tile([0.0, 0.0, 1.0], (COUNT, 1))
    normal = met_normals(velocity, up, math.radians(roughness_deg), np.random.default_rng(1).random((COUNT, 2)))
    assert np.abs(np.linalg.norm(normal, axis=1) - 1.0).max() < 1e-12
    assert (incidence_on(velocity, normal) < 0.5 * math.pi).all()
    found: np.ndarray = -normal[:, :2] / normal[:, 2:]
    return found


@pytest.mark.parametrize("roughness_deg", [8.0, 40.0])
def test_straight_down_the_slope_is_that_of_two_normal_components(roughness_deg: float) -> None:
    found = gradients(roughness_deg, 0.0)
    steepest = np.hypot(*found.T)
    square = math.tan(math.radians(roughness_deg)) ** 2
    assert stats.kstest(steepest, lambda t: 1.0 - np.exp(-(t**2) / square)).statistic < FARTHEST
    assert stats.kstest(np.arctan2(found[:, 1], found[:, 0]), stats.uniform(-math.pi, 2 * math.pi).cdf).statistic < (
        FARTHEST
    )
    assert np.mean(steepest**2) == pytest.approx(square, rel=4.0 / math.sqrt(COUNT))


def test_ground_that_rises_along_the_way_is_met_more_often() -> None:
    """A lander sees ground in proportion to its area across the way: the mean rise is the variance times tan(i)."""
    found, variance = gradients(10.0, 45.0), 0.5 * math.tan(math.radians(10.0)) ** 2
    error = math.sqrt(variance / COUNT)
    assert found[:, 0].mean() == pytest.approx(variance, abs=4.0 * error)
    assert variance > 10.0 * error
    assert found[:, 1].mean() == pytest.approx(0.0, abs=4.0 * error)


@pytest.mark.parametrize("incidence_deg", [30.0, 75.0, 89.0])
def test_ground_that_faces_away_is_not_met(incidence_deg: float) -> None:
    std, steep = math.tan(math.radians(35.0)) / math.sqrt(2.0), math.tan(math.radians(incidence_deg))

    def density(p: float) -> float:
        return max(1.0 + steep * p, 0.0) * math.exp(-0.5 * (p / std) ** 2)

    limits = np.linspace(-1.0 / steep, 2.5, 9)[1:-1].tolist()
    whole = integrate.quad(density, -1.0 / steep, 12.0 * std)[0]
    found = gradients(35.0, incidence_deg)[:, 0]
    assert found.min() >= -1.0 / steep - 1e-9
    for limit in limits:
        share = integrate.quad(density, -1.0 / steep, limit)[0] / whole
        assert np.mean(found < limit) == pytest.approx(share, abs=4.0 * 0.5 / math.sqrt(COUNT))


def test_the_frame_of_the_way_does_not_matter() -> None:
    """Turned with way and normal, the ground that is met turns likewise."""
    turn = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
    turn *= np.linalg.det(turn)
    velocity, up = np.array([[0.03, 0.01, -0.05]]), np.array([[0.0, 0.0, 1.0]])
    uniforms = np.array([[0.7, 0.2]])
    plain = met_normals(velocity, up, 0.5, uniforms)
    assert met_normals(velocity @ turn.T, up @ turn.T, 0.5, uniforms) == pytest.approx(plain @ turn.T, abs=1e-12)


def incoming(count: int, incidence_deg: float) -> Impacts:
    spin = np.tile([0.1, -0.2, 0.3], (count, 1))
    angle = np.full(count, math.radians(incidence_deg))
    return Impacts(np.full(count, 0.05), angle, spin, np.full(count, -5e-5), np.arange(count))


def test_an_elastic_bounce_is_mirrored_by_the_ground_that_is_met() -> None:
    """Straight down on a slope a lander leaves at twice the slope from the vertical, and uphill of nowhere."""
    roughness = math.radians(5.0)
    left = RoughGround(ELASTIC, roughness)(incoming(COUNT, 0.0), np.random.default_rng(2))
    assert np.linalg.norm(left.velocity, axis=1) == pytest.approx(np.full(COUNT, 0.05), rel=1e-12)
    assert left.spin == pytest.approx(incoming(COUNT, 0.0).spin, abs=1e-12)
    zenith = np.arccos(left.velocity[:, 2] / 0.05)
    square = math.tan(roughness) ** 2
    assert stats.kstest(zenith, lambda angle: 1.0 - np.exp(-(np.tan(0.5 * angle) ** 2) / square)).statistic < FARTHEST
    assert not (left.captured | left.outside).any()


def test_rough_ground_turns_landers_back() -> None:
    """Of landers that come in flat, ground that rises before them sends some back along their way."""
    smooth, rough = (
        RoughGround(ELASTIC, math.radians(angle))(incoming(2000, 70.0), np.random.default_rng(2))
        for angle in (0.01, 40)
    )
    assert smooth.velocity[:, 0] == pytest.approx(np.full(2000, 0.05 * math.sin(math.radians(70.0))), rel=0.01)
    assert 0.1 < np.mean(rough.velocity[:, 0] < 0.0) < 0.9
    assert (rough.velocity[:, 2] > 0.0).all()


def test_what_a_bounce_holds_stays_held() -> None:
    left = RoughGround(HardSurface(0.0, 1.0, 0.0, 0.01), 0.3)(incoming(500, 20.0), np.random.default_rng(2))
    assert left.captured.all()


def test_roughness_out_of_range_is_refused() -> None:
    one = np.array([[0.0, 0.0, -1.0]])
    with pytest.raises(ValueError, match="roughness"):
        met_normals(one, -one, 0.5 * math.pi, np.array([[0.5, 0.5]]))
