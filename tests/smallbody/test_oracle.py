"""Gravity against the polyhedral-gravity library of ESA (GPL-3): an oracle here, never imported by the package."""

import numpy as np
import pytest

from lithobrake.smallbody import Body, Shape, didymos

from .meshes import CUBE_FACES, cube_vertices

oracle = pytest.importorskip("polyhedral_gravity", reason="polyhedral-gravity is not installed (extra: oracle)")


def asked(body: Body, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Potential and acceleration of the library."""
    polyhedron = oracle.Polyhedron(polyhedral_source=(body.shape.vertices, body.shape.faces), density=body.density,
        normal_orientation=oracle.NormalOrientation.OUTWARDS,
        integrity_check=oracle.PolyhedronIntegrity.DISABLE)  # fmt: skip
    answers = oracle.evaluate(polyhedron, points, parallel=False)
    potential, acceleration = (np.array([answer[i] for answer in answers]) for i in range(2))
    return potential, acceleration


def bodies() -> list[Body]:
    return [Body(Shape(cube_vertices(100.0) + 20.0, CUBE_FACES), mass=2e9, spin_period=1e4), didymos(partner=False)]


@pytest.mark.parametrize("body", bodies(), ids=lambda body: body.name)
def test_near_and_inside(body):
    random = np.random.default_rng(0)
    points = random.normal(size=(150, 3))
    points *= (body.shape.radius * random.uniform(0.3, 3.0, 150) / np.linalg.norm(points, axis=1))[:, None]
    potential, acceleration = asked(body, points)
    assert body.potential(points) == pytest.approx(potential, rel=1e-10)
    ours = body.acceleration(points)
    assert (np.linalg.norm(ours - acceleration, axis=1) < 1e-10 * np.linalg.norm(acceleration, axis=1)).all()


def test_real_shape(shapes):
    body = Body(Shape.read(shapes / "didymos_radar2020_1996.obj"), mass=5.32e11, spin_period=8136.0)
    points = np.random.default_rng(1).normal(size=(60, 3)) * 500.0
    potential, acceleration = asked(body, points)
    assert body.potential(points) == pytest.approx(potential, rel=1e-10)
    ours = body.acceleration(points)
    assert (np.linalg.norm(ours - acceleration, axis=1) < 1e-10 * np.linalg.norm(acceleration, axis=1)).all()
