"""Ways along the ground against closed forms, and where landers rest or leave it."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

from lithobrake.smallbody import Body, Shape
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
        end = slid(body, origin, [0.0] * 3, math.inf)
        assert (end.leaves[0], end.rests[0], end.time[0], end.velocity.any()) == (lofted, not lofted, 0.0, False)
    body = sphere(spin_period=2.0 * math.pi / (1.03 * rate))
    polar, _ = body.local_frame(85.0, 11.0)
    assert slid(body, polar, [0.0] * 3, 0.6).rests[0]


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
