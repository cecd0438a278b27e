"""Closed surfaces: their volume, and whether they go round the origin."""

import numpy as np
import pytest

from lithobrake.geometry.mesh import closed_faces, holds_origin, mass_properties, volume_of

CUBE = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
FACES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]),
        *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)
OCTAHEDRON = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])


def test_a_volume_has_the_sign_of_its_facets() -> None:
    assert volume_of(CUBE, FACES) == pytest.approx(1.0, rel=1e-14)
    assert volume_of(CUBE, FACES[:, ::-1]) == pytest.approx(-1.0, rel=1e-14)
    assert volume_of(np.concatenate([CUBE, [[1e12] * 3]]), FACES) == volume_of(CUBE, FACES)
    assert volume_of(CUBE + 7.0, FACES) == pytest.approx(mass_properties(CUBE + 7.0, FACES)[0], rel=1e-12)


@pytest.mark.parametrize(
    ("shift", "inside"), [(0.0, True), (0.4999, True), (0.5001, False), (3.0, False), (1e6, False)]
)
def test_a_surface_goes_round_the_origin_or_not(shift: float, inside: bool) -> None:
    for direction in np.eye(3):
        assert holds_origin(CUBE + shift * direction, FACES) == inside


def test_a_flat_body_has_no_volume() -> None:
    with pytest.raises(ValueError, match="flat, it encloses"):
        closed_faces(np.vstack([np.eye(3), -np.eye(3)]) * [1.0, 1.0, 1e-12], OCTAHEDRON, "plate")
