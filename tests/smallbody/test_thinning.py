"""A shape with fewer facets for gravity, and the ground of the whole one."""

import numpy as np
import pytest

from lithobrake.smallbody import Body, Shape, fly

from .meshes import sphere_mesh

pytest.importorskip("fast_simplification")


def bumpy(gravity_facets: int | None = None) -> Shape:
    """A body of 8192 facets with hills of 3 %, some 800 m across."""
    directions, faces = sphere_mesh(32)
    hills = 1.0 + 0.03 * np.sin(9.0 * directions[:, :1]) * np.cos(7.0 * directions[:, 1:2])
    return Shape(directions * [400.0, 380.0, 300.0] * hills, faces, gravity_facets=gravity_facets)


def test_the_ground_stays_and_mass_and_centre_do_too() -> None:
    whole, shape = bumpy(), bumpy(1000)
    few = shape.attracting
    assert 1000 <= len(few.faces) < 1100
    assert np.array_equal(shape.vertices, whole.vertices)
    assert few.volume == pytest.approx(whole.volume, rel=1e-12)
    assert few.centroid == pytest.approx(whole.centroid, abs=1e-9)
    assert whole.attracting is whole
    assert bumpy(10_000).attracting.faces.shape == whole.faces.shape


def test_gravity_is_that_of_the_whole_within_what_the_surface_moves() -> None:
    """A surface that moves by a part of the radius changes gravity by about that part; far away by its square."""
    whole, thin = (Body(bumpy(facets), mass=3e11, spin_period=1e4) for facets in (None, 1000))
    ground = whole.shape.vertices[::97]
    moved = np.abs(thin.shape.attracting.height(ground)).max() / 300.0
    assert 0.0 < moved < 0.01
    for points, error in ((ground, 3.0 * moved), (3.0 * ground, moved)):
        exact, found = whole.acceleration(points), thin.acceleration(points)
        off = np.linalg.norm(found - exact, axis=1) / np.linalg.norm(exact, axis=1)
        assert 0.0 < off.max() < error


def test_flights_meet_the_ground_of_the_whole() -> None:
    body = Body(bumpy(1000), mass=3e11, spin_period=1e5)
    start = body.shape.surface_point(20.0, 40.0, 5.0)
    flights = fly(body, start, [0.0, 0.0, 0.0], 3600.0)
    assert flights.status[0] == "impact"
    assert body.shape.height(flights.position)[0] == pytest.approx(0.0, abs=1e-6)
    assert abs(body.shape.attracting.height(flights.position)[0]) > 1e-3


def test_too_few_facets_are_refused() -> None:
    with pytest.raises(ValueError, match="gravity_facets is 99; it must be 100 or more"):
        bumpy(99)
