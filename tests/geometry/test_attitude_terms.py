"""Terms of an attitude: what the symmetry of a lander leaves as it is, and their law over all attitudes."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.geometry.attitude import AttitudeTerms, orthonormal, seen_from_lander

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


@pytest.mark.parametrize(
    ("terms", "symmetries"),
    [
        (BOX, HALF_TURNS),
        (PRISM, [*HALF_TURNS, Rotation.from_rotvec([0.0, 0.0, 0.5 * np.pi])]),
        (CUBE, [Rotation.from_rotvec(0.5 * np.pi * axis) for axis in np.eye(3)]),
    ],
)
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
