"""Laws of attitudes drawn by chance, and terms of an attitude that the symmetry of a lander leaves."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import kstest, qmc

from lithobrake.geometry.attitude import pointed, uniform_attitude
from lithobrake.geometry.attitude_terms import AttitudeTerms, orthonormal, seen_from_lander

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


PRISM, BOX, CUBE = (AttitudeTerms.of_box(np.array(edges)) for edges in ([0.1, 0.1, 0.2], [0.3, 0.2, 0.1], [0.1] * 3))
MESH = AttitudeTerms.of_body(np.array([[2.0, 0.1, 0.0], [0.1, 3.0, 0.2], [0.0, 0.2, 4.0]]))
LANDERS = pytest.mark.parametrize("terms", [PRISM, BOX, CUBE, MESH])
HALF_TURNS = [Rotation.from_rotvec(np.pi * axis) for axis in np.eye(3)]


def ways(rotations: Rotation) -> tuple[np.ndarray, np.ndarray]:
    """Normal and travel seen from landers that are turned so, with the travel along x."""
    into_bed = rotations.as_matrix()
    return into_bed[:, 2], into_bed[:, 0]


def test_normal_and_travel_are_those_of_the_bed() -> None:
    turned = Rotation.random(5, rng=0)
    azimuth = np.linspace(0.0, 6.0, 5)
    normal, travel = seen_from_lander(np.roll(turned.as_quat(), 1, axis=1), azimuth)
    assert turned.apply(normal) == pytest.approx(np.tile([0.0, 0.0, 1.0], (5, 1)))
    assert turned.apply(travel) == pytest.approx(np.column_stack([np.cos(azimuth), np.sin(azimuth), np.zeros(5)]))


@pytest.mark.parametrize(("terms", "count"), [(PRISM, 3), (BOX, 6), (CUBE, 3), (MESH, 12)])
def test_as_many_terms_as_symmetry_leaves(terms: AttitudeTerms, count: int) -> None:
    assert terms.at(*ways(Rotation.random(4, rng=1))).shape == (4, count)
    assert len(terms.ranges) == count


@pytest.mark.parametrize(("terms", "symmetries"), [
    (BOX, HALF_TURNS),
    (PRISM, [*HALF_TURNS, Rotation.from_rotvec([0.0, 0.0, 0.5 * np.pi])]),
    (CUBE, [Rotation.from_rotvec(0.5 * np.pi * axis) for axis in np.eye(3)]),
])  # fmt: skip
def test_symmetries_of_the_lander_change_no_term(terms: AttitudeTerms, symmetries: list[Rotation]) -> None:
    attitudes = Rotation.random(50, rng=2)
    for symmetry in symmetries:
        assert terms.at(*ways(attitudes * symmetry)) == pytest.approx(terms.at(*ways(attitudes)), abs=1e-12)


def test_a_mesh_is_not_taken_as_symmetric() -> None:
    attitudes = Rotation.random(50, rng=3)
    for symmetry in HALF_TURNS:
        assert np.abs(MESH.at(*ways(attitudes * symmetry)) - MESH.at(*ways(attitudes))).max() > 0.5


@pytest.mark.parametrize("terms", [PRISM, BOX, CUBE])
def test_the_mirror_image_of_an_arrival_has_the_same_terms(terms: AttitudeTerms) -> None:
    normal, travel = ways(Rotation.random(20, rng=4))
    mirror = np.array([-1.0, 1.0, 1.0])
    assert terms.at(normal * mirror, travel * mirror) == pytest.approx(terms.at(normal, travel))


@LANDERS
def test_the_law_over_all_attitudes_is_that_of_many(terms: AttitudeTerms) -> None:
    found = terms.at(*ways(Rotation.random(40_000, rng=5)))
    mean, covariance = terms.uniform_law
    assert found.mean(axis=0) == pytest.approx(mean, abs=0.015)
    assert np.cov(found.T) == pytest.approx(covariance, abs=0.015)
    ends = np.array(list(terms.ranges.values()))
    assert (found >= ends[:, 0] - 1e-12).all()
    assert (found <= ends[:, 1] + 1e-12).all()
    # Many attitudes come near the ends, so that the ranges are not too wide.
    assert (np.ptp(found, axis=0) > 0.9 * np.ptp(ends, axis=1)).all()


@LANDERS
def test_orthonormal_terms_have_no_correlation(terms: AttitudeTerms) -> None:
    found = orthonormal(terms.at(*ways(Rotation.random(40_000, rng=6))), terms.uniform_law)
    assert found.shape[1] == len(terms.ranges)
    assert np.cov(found.T) == pytest.approx(np.eye(found.shape[1]), abs=0.04)


def test_what_does_not_vary_drops_out() -> None:
    normal, travel = ways(Rotation.from_rotvec(np.column_stack([np.zeros((9, 2)), np.linspace(0.0, 3.0, 9)])))
    found = BOX.at(normal, travel)
    own = found - found.mean(axis=0)
    # Upright boxes that come from all sides: how far an axis leans is 0 throughout.
    assert orthonormal(found, (found.mean(axis=0), own.T @ own / 9)).shape == (9, 1)
    assert orthonormal(found[:1], (found[0], np.zeros((6, 6)))).shape == (1, 0)


def test_a_box_that_is_loaded_unevenly_is_no_prism() -> None:
    edges, inertia = np.array([0.1, 0.1, 0.2]), np.array([1.0, 2.0, 2.5])
    assert len(AttitudeTerms.of_box(edges, inertia).ranges) == 6
    assert AttitudeTerms.of_box(edges).names == ("z",)
