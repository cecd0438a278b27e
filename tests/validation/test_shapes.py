"""Slopes and potentials of the comparison of shapes, on a sphere that turns, and the meshes that it reads."""

import os
import pickle
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.smallbody import Body, Shape
from lithobrake.vocabulary.constants import GRAVITATIONAL_CONSTANT

from ..smallbody.meshes import sphere_mesh

FOLDER = Path(__file__).parents[2] / "validation" / "shapes"
RADIUS, DENSITY, SHARE = 250.0, 1200.0, 0.5


@pytest.fixture
def meshes(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What validation/shapes/meshes.py defines."""
    monkeypatch.syspath_prepend(str(FOLDER))
    return runpy.run_path(str(FOLDER / "meshes.py"))


def test_slopes_of_a_sphere_that_turns_are_those_of_the_closed_form(meshes: dict[str, Any]) -> None:
    """With k = w^2 R / g: tan(slope) = k sin cos / (1 - k cos^2), and the potential is -g R (1 + k/2 cos^2).

    Facets of a sphere of 18 432 are within a degree of its tangent planes.
    """
    directions, faces = sphere_mesh(48)
    shape = Shape(RADIUS * directions, faces)
    mass = DENSITY * shape.volume
    rate = np.sqrt(SHARE * GRAVITATIONAL_CONSTANT * mass / RADIUS**3)
    body = Body(shape, mass, float(2.0 * np.pi / rate))
    facets = meshes["facets_of"](body, 500)
    found = meshes["slopes_deg"](facets, facets.acceleration, body.spin_rate)
    latitude = np.arcsin(facets.centre[:, 2] / np.linalg.norm(facets.centre, axis=1))
    sine, cosine = np.sin(np.abs(latitude)), np.cos(latitude)
    wanted = np.degrees(np.arctan2(SHARE * sine * cosine, 1.0 - SHARE * cosine**2))
    assert np.abs(found - wanted).max() < 1.0
    assert found.max() > 15.0
    told = meshes["measures"](facets, body.spin_rate)
    potential = 1.0 + 0.5 * SHARE * cosine**2
    assert told["potential_spread"] == pytest.approx(
        np.sqrt(np.average((potential - np.average(potential, weights=facets.area)) ** 2, weights=facets.area))
        / np.average(potential, weights=facets.area), rel=0.02,
    )  # fmt: skip
    # Half the density at the same rate doubles k, and no sphere has a facet that faces its centre.
    half = np.degrees(np.arctan2(2.0 * SHARE * sine * cosine, 1.0 - 2.0 * SHARE * cosine**2))
    assert meshes["measures"](facets, body.spin_rate, 0.5)["mean_deg"] == pytest.approx(half.mean(), abs=0.5)
    assert told["facing_centre"] == 0.0


def test_a_pickle_that_asks_for_more_than_numbers_is_not_read(meshes: dict[str, Any], tmp_path: Path) -> None:
    class Calls:
        def __reduce__(self) -> Any:
            return os.getcwd, ()

    path = tmp_path / "mesh.pk"
    path.write_bytes(pickle.dumps([Calls(), []]))
    with pytest.raises(pickle.UnpicklingError, match=r"posix\.getcwd; allowed: lists of numbers"):
        meshes["read_shape"](path)


def test_a_step_of_smoothing_moves_a_vertex_half_the_way_to_its_neighbours(meshes: dict[str, Any]) -> None:
    """The corners of an octahedron come to half their distance: the mean of the four neighbours is the centre."""
    corners = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], dtype=float)
    faces = np.array([(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)])
    np.testing.assert_allclose(meshes["smoothed"](Shape(corners, faces)).vertices, 0.5 * corners, atol=1e-15)
