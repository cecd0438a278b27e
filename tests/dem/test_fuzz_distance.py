"""Narrow phase against brute force on hard pairs, with the pairs and the check of `benchmarks/fuzz_distance.py`."""

import sys
from pathlib import Path

import numpy as np
import pytest

from lithobrake.dem.narrow_phase.gjk import ITERATIONS

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from distance_pairs import FAMILIES, library
from fuzz_distance import check, solids

PAIRS = 400


@pytest.fixture(scope="module")
def shapes():
    return library(np.random.default_rng(7), 10)


@pytest.fixture(scope="module")
def meshes(shapes):
    return solids(shapes)


@pytest.mark.parametrize("family", FAMILIES)
def test_distances_are_those_of_brute_force(shapes, meshes, family):
    result = check(shapes, meshes, family, 7, PAIRS)
    assert result.pairs > 0.9 * PAIRS
    assert result.not_finite == 0
    assert result.distance < 1e-9
    assert result.points < 1e-9
    # Round-off moves the points by the root of what it moves the distance.
    assert result.normal < 1e-6
    assert result.steps_most < ITERATIONS
