"""Shapes that several tests use."""

from pathlib import Path

import pytest

from lithobrake.smallbody import Body, Shape

from .meshes import CUBE_FACES, cube_vertices, sphere_mesh


@pytest.fixture(scope="session")
def cube() -> Shape:
    return Shape(cube_vertices(), CUBE_FACES)


@pytest.fixture(scope="session")
def ball() -> Body:
    """A sphere of 100 m and 1e10 kg in 1152 facets, turning in 3 h."""
    directions, faces = sphere_mesh(12)
    return Body(Shape(100.0 * directions, faces), mass=1e10, spin_period=3 * 3600.0)


@pytest.fixture(scope="session")
def shapes() -> Path:
    """The folder of real shape models."""
    folder = Path(__file__).parents[2].parent / "shared" / "shapes"
    if not folder.is_dir():
        pytest.skip(f"no shape models: {folder} is not there")
    return folder
