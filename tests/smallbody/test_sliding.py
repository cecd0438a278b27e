"""Landers that move along the ground, and ground that is rough at their scale."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from scipy import integrate, stats

from lithobrake.smallbody import Body, HardSurface, Impacts, Launch, RoughGround, Shape, hop, incidence_on, met_normals
from lithobrake.smallbody.sliding import NEAR, ROLLING_INERTIA, OnGround, Slides, slide

from .meshes import CUBE_FACES, cube_vertices, sphere_mesh

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
    """One lander."""
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


def impacts(count: int, incidence_deg: float) -> Impacts:
    spin = np.tile([0.1, -0.2, 0.3], (count, 1))
    angle = np.full(count, math.radians(incidence_deg))
    return Impacts(np.full(count, 0.05), angle, spin, np.full(count, -5e-5), np.arange(count))


def test_an_elastic_bounce_is_mirrored_by_the_ground_that_is_met() -> None:
    """Straight down on a slope a lander leaves at twice the slope from the vertical, and uphill of nowhere."""
    roughness = math.radians(5.0)
    left = RoughGround(ELASTIC, roughness)(impacts(COUNT, 0.0), np.random.default_rng(2))
    assert np.linalg.norm(left.velocity, axis=1) == pytest.approx(np.full(COUNT, 0.05), rel=1e-12)
    assert left.spin == pytest.approx(impacts(COUNT, 0.0).spin, abs=1e-12)
    zenith = np.arccos(left.velocity[:, 2] / 0.05)
    square = math.tan(roughness) ** 2
    law = stats.kstest(zenith, lambda angle: 1.0 - np.exp(-(np.tan(0.5 * angle) ** 2) / square))
    assert law.statistic < FARTHEST
    assert not (left.captured | left.outside).any()


def test_rough_ground_turns_landers_back() -> None:
    """Of landers that come in flat, ground that rises before them sends some back along their way."""
    smooth, rough = (
        RoughGround(ELASTIC, math.radians(angle))(impacts(2000, 70.0), np.random.default_rng(2)) for angle in (0.01, 40)
    )
    assert smooth.velocity[:, 0] == pytest.approx(np.full(2000, 0.05 * math.sin(math.radians(70.0))), rel=0.01)
    assert 0.1 < np.mean(rough.velocity[:, 0] < 0.0) < 0.9
    assert (rough.velocity[:, 2] > 0.0).all()


def test_what_a_bounce_holds_stays_held() -> None:
    left = RoughGround(HardSurface(0.0, 1.0, 0.0, 0.01), 0.3)(impacts(500, 20.0), np.random.default_rng(2))
    assert left.captured.all()


def test_roughness_out_of_range_is_refused() -> None:
    one = np.array([[0.0, 0.0, -1.0]])
    with pytest.raises(ValueError, match="roughness"):
        met_normals(one, -one, 0.5 * math.pi, np.array([[0.5, 0.5]]))
