"""Mass properties, rounding and refusals of shapes."""

import math

import numpy as np
import pytest

from lithobrake.dem import Box, ConvexHull, Sphere
from lithobrake.dem.bodies.shape import ROUNDING_FRACTION, equivalent_radius


def test_box_is_exact():
    box = Box((1.0, 2.0, 3.0))
    assert box.volume == pytest.approx(6.0, rel=1e-12)
    assert np.allclose(box.centroid, 0.0, atol=1e-15)
    assert np.allclose(box.inertia_per_density, np.diag([6.5, 5.0, 2.5]), rtol=1e-12, atol=1e-12)
    assert len(box.polyhedron.face_normals) == 6
    assert len(box.polyhedron.edges) == 12


def test_tetrahedron_is_exact():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]) + 5.0
    hull = ConvexHull(corners)
    assert hull.volume == pytest.approx(1 / 6, rel=1e-12)
    assert np.allclose(hull.centroid, 5.25, rtol=1e-12)
    # Integral of y^2 + z^2 about the centroid: 2 (1/60 - 1/6 / 16); products: 1/120 - 1/96.
    expected = np.full((3, 3), 1 / 480) + np.diag([2 * (1 / 60 - 1 / 96) - 1 / 480] * 3)
    assert np.allclose(hull.inertia_per_density, expected, rtol=1e-9)


def test_mass_properties_agree_with_sampling():
    generator = np.random.default_rng(0)
    hull = ConvexHull(generator.normal(size=(14, 3)))
    low, high = hull.vertices.min(axis=0), hull.vertices.max(axis=0)
    points = generator.uniform(low, high, size=(400_000, 3))
    inside = (points @ hull.polyhedron.face_normals.T <= hull.polyhedron.face_offsets).all(axis=1)
    assert hull.volume == pytest.approx(np.prod(high - low) * inside.mean(), rel=0.02)
    assert np.allclose(hull.centroid, points[inside].mean(axis=0), atol=0.03)


def test_rounding_moves_every_face_of_a_box_inward():
    box = Box((1.0, 2.0, 3.0))
    assert box.rounding == pytest.approx(ROUNDING_FRACTION * 0.5)
    assert np.allclose(np.abs(box.core).max(axis=0), np.array([0.5, 1.0, 1.5]) - box.rounding)


def test_size_scales_to_the_last_bit():
    cloud = np.random.default_rng(1).normal(size=(14, 3))
    small, large = ConvexHull(cloud), ConvexHull(8.0 * cloud)
    assert np.array_equal(8.0 * small.core, large.core)
    assert 8.0 * small.rounding == large.rounding
    assert 8.0 * equivalent_radius(small) == equivalent_radius(large)
    assert np.array_equal(8.0**5 * small.inertia_per_density, large.inertia_per_density)


@pytest.mark.parametrize(
    ("points", "word"),
    [
        (np.zeros((5, 3)), "no volume"),
        (np.eye(3), "at least 4"),
        (np.random.default_rng(0).normal(size=(10, 3)) * [1, 1, 0], "no volume"),
        (np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, np.nan]]), "finite"),
        (np.zeros((4, 2)), "3 coordinates"),
    ],
)
def test_degenerate_clouds_are_refused(points, word):
    with pytest.raises(ValueError, match=word):
        ConvexHull(points)


@pytest.mark.parametrize("radius", [0.0, -1.0, math.nan, math.inf])
def test_spheres_without_a_radius_are_refused(radius):
    with pytest.raises(ValueError, match="Sphere radius"):
        Sphere(radius)


def test_boxes_without_lengths_are_refused():
    with pytest.raises(ValueError, match="Box lengths"):
        Box((1.0, 0.0, 1.0))
