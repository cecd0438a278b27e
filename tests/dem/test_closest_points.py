"""Distances of convex cores against brute force; mass properties, rounding and refusals of shapes."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import ConvexHull as Quickhull

from lithobrake.dem import Box, ConvexHull, Sphere
from lithobrake.dem.bodies.rigid_body import AT_CENTRE
from lithobrake.dem.bodies.shape import ROUNDING_FRACTION, equivalent_radius
from lithobrake.dem.narrow_phase.feature_distance import edge_to_edge, point_to_core
from lithobrake.dem.narrow_phase.gjk import ITERATIONS, PENETRATING, triangle_weights, weighted
from lithobrake.dem.narrow_phase.penetration import find_closest_points
from lithobrake.dem.narrow_phase.scratch import scratch_for
from lithobrake.dem.stepping.engine import cores_of, rotation_matrices

# The hard pairs and the check of benchmarks/fuzz_distance.py.
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from distance_pairs import FAMILIES, library
from fuzz_distance import check, solids


def signed_distance(first, second):
    """Distance of the origin to the envelope of all differences, negative inside: minus the shortest way out."""
    difference = (second[:, None] - first[None]).reshape(-1, 3)
    hull = Quickhull(difference)
    depth = -hull.equations[:, 3]
    if depth.min() >= 0.0:
        return -depth.min()
    points = (np.array(triangle_weights(*map(tuple, difference[s]))) @ difference[s] for s in hull.simplices)
    return min(np.linalg.norm(point) for point in points)


@pytest.mark.parametrize("stretch", [1.0, 1e-3])
def test_distance_of_random_pairs(stretch):
    generator = np.random.default_rng(4)
    simplex, turned, relative, _ = scratch_for(120, 16)
    seen = {}
    for trial in range(150):
        first = ConvexHull(generator.normal(size=(14, 3)) * [0.05, 0.05, 0.05 * stretch])
        second = Box((0.37, 0.23, 0.1)) if trial % 3 == 0 else ConvexHull(generator.normal(size=(8, 3)) * 0.05)
        cores = cores_of([(first, AT_CENTRE), (second, AT_CENTRE)])
        turns = generator.normal(size=(2, 4))
        rotation = rotation_matrices(turns / np.linalg.norm(turns, axis=1)[:, None])
        apart = generator.normal(size=3)
        apart *= generator.uniform(0, 0.3) / np.linalg.norm(apart)
        found, count, _ = find_closest_points(
            cores, simplex, turned, relative, (0, 1), rotation, (0, 1), tuple(apart), np.inf
        )
        expected = signed_distance(first.core @ rotation[0].T, second.core @ rotation[1].T + apart)
        if found == PENETRATING:
            assert expected < 1e-10
        else:
            ends = (np.array(weighted(a, simplex.weight, count)) for a in (simplex.on_first, simplex.on_second))
            assert np.linalg.norm(next(ends) - next(ends)) == pytest.approx(expected, abs=1e-10)
        seen[found] = seen.get(found, 0) + 1
    assert min(seen.values()) > 20


@pytest.fixture(scope="module")
def shapes():
    return library(np.random.default_rng(7), 10)


@pytest.fixture(scope="module")
def meshes(shapes):
    return solids(shapes)


@pytest.mark.parametrize("family", FAMILIES)
def test_distances_are_those_of_brute_force(shapes, meshes, family):
    result = check(shapes, meshes, family, 7, 400)
    assert result.pairs > 0.9 * 400
    assert result.not_finite == 0
    assert result.distance < 1e-9
    assert result.points < 1e-9
    # Round-off moves the points by the root of what it moves the distance.
    assert result.normal < 1e-6
    assert result.steps_most < ITERATIONS


def test_point_to_core_is_the_distance_of_a_point():
    generator = np.random.default_rng(3)
    hull = ConvexHull(generator.normal(size=(14, 3)))
    cores = cores_of([(hull, AT_CENTRE)])
    for point in generator.normal(size=(300, 3)) * 1.5:
        distance, normal, near, _ = point_to_core(cores, 0, tuple(point), np.inf)
        expected = signed_distance(hull.core, point[None])
        assert near
        if expected > 0.0:
            assert np.linalg.norm(normal) == pytest.approx(1.0)
            assert distance == pytest.approx(expected, abs=1e-12)
        else:
            # Inside, the depth below the nearest face, made smooth by the depths below the others.
            depths = -(Quickhull(hull.core).equations @ [*point, 1.0])
            depths = np.unique(depths.round(12))
            assert distance == pytest.approx(-((depths**-8.0).sum() ** -0.125), rel=1e-9)
            assert expected <= distance < 0.6 * expected


def test_edges_meet_at_their_closest_points():
    generator = np.random.default_rng(6)
    share = np.linspace(0, 1, 201)
    for _ in range(50):
        a, along, b, across = generator.normal(size=(4, 3))
        here, there = (np.array(p) for p in edge_to_edge(tuple(a), tuple(along), tuple(b), tuple(across)))
        grid = (a + share[:, None] * along)[:, None] - (b + share[:, None] * across)[None]
        assert np.linalg.norm(here - there) <= np.linalg.norm(grid, axis=2).min() + 1e-12
        assert np.linalg.norm(here - there) == pytest.approx(np.linalg.norm(grid, axis=2).min(), abs=0.03)


def test_parallel_edges_meet_amid_their_overlap():
    here, there = edge_to_edge((0.0, 0, 0), (1.0, 0, 0), (0.5, 0, 1), (1.0, 0, 0))
    assert here == pytest.approx((0.75, 0, 0))
    assert there == pytest.approx((0.75, 0, 1))


def test_box_is_exact():
    box = Box((1.0, 2.0, 3.0))
    assert box.volume == pytest.approx(6.0, rel=1e-12)
    assert np.allclose(box.centroid, 0.0, atol=1e-15)
    assert np.allclose(box.inertia_per_density, np.diag([6.5, 5.0, 2.5]), rtol=1e-12, atol=1e-12)
    assert (len(box.polyhedron.face_normals), len(box.polyhedron.edges)) == (6, 12)


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


@pytest.mark.parametrize(("points", "word"), [
    (np.zeros((5, 3)), "no volume"),
    (np.eye(3), "at least 4"),
    (np.random.default_rng(0).normal(size=(10, 3)) * [1, 1, 0], "no volume"),
    (np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, np.nan]]), "finite"),
    (np.zeros((4, 2)), "3 coordinates"),
])  # fmt: skip
def test_degenerate_clouds_are_refused(points, word):
    with pytest.raises(ValueError, match=word):
        ConvexHull(points)


@pytest.mark.parametrize("radius", [0.0, -1.0, math.nan, math.inf])
def test_spheres_without_a_radius_are_refused(radius):
    with pytest.raises(ValueError, match=r"Sphere\.radius"):
        Sphere(radius)


def test_boxes_without_lengths_are_refused():
    with pytest.raises(ValueError, match=r"Box\.lengths"):
        Box((1.0, 0.0, 1.0))
