"""Distances of convex cores against brute force over the difference set."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull as Quickhull

from lithobrake.dem import Box, ConvexHull
from lithobrake.dem.bodies.rigid_body import AT_CENTRE
from lithobrake.dem.narrow_phase.feature_distance import edge_to_edge, point_to_core
from lithobrake.dem.narrow_phase.gjk import PENETRATING, triangle_weights, weighted
from lithobrake.dem.narrow_phase.penetration import find_closest_points
from lithobrake.dem.narrow_phase.scratch import scratch_for
from lithobrake.dem.stepping.engine import cores_of, rotation_matrices


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
