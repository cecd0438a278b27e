"""Laws of attitudes drawn by chance, beside what they have to be."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import kstest, qmc

from lithobrake.geometry.attitude import pointed, uniform_attitude

# Independent draws, so that the Kolmogorov test's probabilities hold; the seed is fixed.
UNIFORM = np.random.default_rng(5).random((4000, 3))


def rotations(quaternions: list[np.ndarray]) -> Rotation:
    return Rotation.from_quat(np.array(quaternions), scalar_first=True)


def test_attitudes_are_even_over_all_rotations() -> None:
    found = [uniform_attitude(*row) for row in UNIFORM]
    assert np.linalg.norm(found, axis=1) == pytest.approx(1.0, abs=1e-12)
    # Where any axis points is even over the sphere, so each coordinate is even between -1 and 1 (Archimedes); and the
    # angle of a rotation has the density (1 - cos) / pi.
    turned = rotations(found).as_matrix()
    for row in range(3):
        for column in range(3):
            assert kstest(turned[:, row, column], "uniform", args=(-1.0, 2.0)).pvalue > 1e-3
    assert kstest(rotations(found).magnitude(), lambda a: (a - np.sin(a)) / math.pi).pvalue > 1e-3


def test_a_sequence_of_attitudes_fills_the_rotations_more_evenly_than_chance() -> None:
    even = qmc.Sobol(3, rng=np.random.default_rng(1)).random(1024)
    mean = rotations([uniform_attitude(*row) for row in even]).as_matrix().mean(axis=0)
    # Each entry has mean 0 and variance 1/3: independent draws would be off by 0.018.
    assert np.abs(mean).max() < 0.006


@pytest.mark.parametrize("half_angle", [0.1, 1.0, math.pi])
def test_an_error_of_pointing_is_even_over_its_cone(half_angle: float) -> None:
    given = np.array([0.5, -0.3, 0.8, 0.2])
    nominal = Rotation.from_quat(given, scalar_first=True)
    found = rotations([pointed(given, half_angle, *row[:2]) for row in UNIFORM])
    # Seen from the lander as it should stand, its z axis lies evenly over the cap about z.
    axis = (nominal.inv() * found).apply([0.0, 0.0, 1.0])
    cap = 1.0 - math.cos(half_angle)
    assert kstest(axis[:, 2], "uniform", args=(1.0 - cap, cap)).pvalue > 1e-3
    assert kstest(np.arctan2(axis[:, 1], axis[:, 0]), "uniform", args=(-math.pi, 2.0 * math.pi)).pvalue > 1e-3
    # Without a roll: the way from the one attitude to the other is as long as that of the axis.
    assert (nominal.inv() * found).magnitude() == pytest.approx(np.arccos(axis[:, 2]), abs=1e-7)


def test_a_closing_cone_leaves_the_attitude() -> None:
    given = np.array([0.5, -0.5, 0.5, 0.5])
    assert pointed(given, 1e-9, 0.7, 0.2) == pytest.approx(given, abs=1e-9)
