"""The acceleration of a touchdown where it is, as its bed has it."""

import math

import numpy as np
import pytest

from lithobrake.pipeline.design.arrivals import STEEPEST_DEG, ground_inputs
from lithobrake.pipeline.design.soils import felt
from lithobrake.smallbody import Body, Partner, Shape, didymos, dimorphos, fly
from lithobrake.study.touchdown_model import acceleration

from ...smallbody.meshes import sphere_mesh


@pytest.mark.parametrize("azimuth_deg", [0.0, 73.0, 291.0])
@pytest.mark.parametrize("local", [(2e-6, -5e-6, -4e-5), (-3e-6, 1e-6, 2e-5), (0.0, 0.0, -1e-4)])
def test_the_bed_has_the_acceleration_turned_by_the_azimuth(local: tuple[float, ...], azimuth_deg: float) -> None:
    row = ground_inputs(local, azimuth_deg, friction=0.6)
    of_bed = acceleration(row, row["surface.gravity"])
    c, s = math.cos(math.radians(azimuth_deg)), math.sin(math.radians(azimuth_deg))
    turned = (c * local[0] - s * local[1], s * local[0] + c * local[1], local[2])
    assert of_bed == pytest.approx(turned, rel=1e-12, abs=1e-20)


def test_no_bed_is_steeper_than_soil_lies() -> None:
    steep = ground_inputs((1e-4, 0.0, -1e-4), 0.0, friction=0.6)
    assert steep["surface.slope_deg"] == pytest.approx(STEEPEST_DEG)
    assert steep["surface.gravity"] == pytest.approx(math.sqrt(2.0) * 1e-4)
    assert ground_inputs((1e-4, 0.0, -1e-4), 0.0, friction=0.2)["surface.slope_deg"] == pytest.approx(
        math.degrees(math.atan(0.5))
    )


def two_balls() -> Body:
    """A binary of two balls, of the sizes and masses of Dimorphos and Didymos: no oblateness pulls at either centre."""
    vertices, faces = sphere_mesh(12)
    inner, outer = dimorphos(), didymos()
    partner = Body(Shape(390.0 * vertices, faces), mass=outer.mass, spin_period=outer.spin_period)
    shape, period = Shape(75.0 * vertices, faces), inner.spin_period
    return Body(shape, mass=inner.mass, spin_period=period, partner=Partner(partner, period))


def test_what_is_felt_at_rest_is_how_a_slow_flight_begins() -> None:
    """A lander thrown up slowly goes back to the ground under the acceleration that one at rest feels, tide and all."""
    body = two_balls()
    point = body.shape.surface_point(20.0, -40.0)[None]
    up = body.shape.normals[body.shape.locate(20.0, -40.0)[1]]
    speed, time = 2e-4, np.array([1000.0])
    here = felt(body, point, time, np.array([body.mass]), np.array([body.spin_period]))[0]
    alone = body.effective_acceleration(point)[0]
    tide = np.linalg.norm(here - alone)
    assert 0.01 < tide / np.linalg.norm(alone) < 0.2
    flight = fly(body, point, speed * up[None], 100.0, start_time=time)
    change = (flight.velocity[0] - speed * up) / flight.time[0]
    # Until it is down again only Coriolis' acceleration comes in, and what the facets of the partner are no ball.
    assert np.linalg.norm(change - here) < 2.0 * speed * body.spin_rate + 0.01 * tide


def test_a_body_alone_has_no_tide() -> None:
    body = dimorphos(partner=False)
    point = body.shape.surface_point(20.0, -40.0)[None]
    here = felt(body, point, np.zeros(1), np.array([body.mass]), np.array([body.spin_period]))
    assert (here == body.effective_acceleration(point)).all()
