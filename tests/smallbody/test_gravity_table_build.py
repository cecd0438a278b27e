"""Gravity tables on disk, and shapes with fewer facets for gravity."""

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lithobrake.compilation.disk_cache import DiskCache
from lithobrake.smallbody import Body, Shape, fly, gravity_table_build
from lithobrake.smallbody.gravity_table_build import gravity_table_of

from .meshes import sphere_mesh

# Coarse, for a table of some kilobytes.
LEVELS = ((0.25, 0.0), (1.0, 6.0))


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache in the place of the user's, for tables alone."""
    monkeypatch.setenv("LITHOBRAKE_CACHE", str(tmp_path))
    monkeypatch.setattr(gravity_table_build, "disk_cache", DiskCache)
    return tmp_path


def built(cube: Shape) -> tuple[np.ndarray, tuple[float, ...]]:
    table, error = gravity_table_of(cube.polyhedron, cube.multipole, cube.volume, LEVELS)
    return table.values, tuple(error)


def with_objects() -> bytes:
    """Arrays that run code when they are read."""
    file = io.BytesIO()
    np.savez(file, values=np.array([print], dtype=object))
    return file.getvalue()


@pytest.mark.parametrize("spoil", [
    lambda whole: whole[:-500], lambda whole: b"", lambda whole: whole[:300] + b"?" + whole[301:],
    lambda whole: with_objects(),
], ids=["truncated", "empty", "one byte", "objects"])  # fmt: skip
def test_damaged_table_is_made_again(cube, folder, caplog, spoil: Callable[[bytes], bytes]):
    values, error = built(cube)
    (file,) = folder.rglob("gravity-*")
    whole = file.read_bytes()
    file.write_bytes(spoil(whole))
    caplog.clear()
    again, error_again = built(cube)
    assert caplog.messages == [f"{file} is damaged, or was not written with this user's key: it is made again."]
    assert again.tobytes() == values.tobytes()
    assert error_again == error
    assert file.read_bytes() == whole
    read, error_read = built(cube)
    assert len(caplog.messages) == 1
    assert read.tobytes() == values.tobytes()
    assert error_read == error


def test_table_that_cannot_be_kept_is_made_in_memory(cube, folder, caplog):
    values, _ = built(cube)
    for path in folder.rglob("gravity-*"):
        path.unlink()
    (folder / "lithobrake" / "smallbody").rmdir()
    (folder / "lithobrake" / "smallbody").write_text("a file in the way")
    caplog.clear()
    again, _ = built(cube)
    (told,) = caplog.messages
    assert "gravity tables are made anew each time; set LITHOBRAKE_CACHE to a folder that is yours alone." in told
    assert again.tobytes() == values.tobytes()


def bumpy(gravity_facets: int | None = None) -> Shape:
    """A body of 8192 facets with hills of 3 %, some 800 m across."""
    pytest.importorskip("fast_simplification")
    directions, faces = sphere_mesh(32)
    hills = 1.0 + 0.03 * np.sin(9.0 * directions[:, :1]) * np.cos(7.0 * directions[:, 1:2])
    return Shape(directions * [400.0, 380.0, 300.0] * hills, faces, gravity_facets=gravity_facets)


def test_the_ground_stays_and_mass_and_centre_do_too() -> None:
    whole, shape = bumpy(), bumpy(1000)
    few = shape.attracting
    assert 1000 <= len(few.faces) < 1100
    assert np.array_equal(shape.vertices, whole.vertices)
    assert few.volume == pytest.approx(whole.volume, rel=1e-12)
    assert few.centroid == pytest.approx(whole.centroid, abs=1e-9)
    assert whole.attracting is whole
    assert bumpy(10_000).attracting.faces.shape == whole.faces.shape


def test_gravity_is_that_of_the_whole_within_what_the_surface_moves() -> None:
    """A surface that moves by a part of the radius changes gravity by about that part; far away by its square."""
    whole, thin = (Body(bumpy(facets), mass=3e11, spin_period=1e4) for facets in (None, 1000))
    ground = whole.shape.vertices[::97]
    moved = np.abs(thin.shape.attracting.height(ground)).max() / 300.0
    assert 0.0 < moved < 0.01
    for points, error in ((ground, 3.0 * moved), (3.0 * ground, moved)):
        exact, found = whole.acceleration(points), thin.acceleration(points)
        off = np.linalg.norm(found - exact, axis=1) / np.linalg.norm(exact, axis=1)
        assert 0.0 < off.max() < error


def test_flights_meet_the_ground_of_the_whole() -> None:
    body = Body(bumpy(1000), mass=3e11, spin_period=1e5)
    flights = fly(body, body.shape.surface_point(20.0, 40.0, 5.0), [0.0, 0.0, 0.0], 3600.0)
    assert flights.status[0] == "impact"
    assert body.shape.height(flights.position)[0] == pytest.approx(0.0, abs=1e-6)
    assert abs(body.shape.attracting.height(flights.position)[0]) > 1e-3


def test_too_few_facets_are_refused() -> None:
    with pytest.raises(ValueError, match="gravity_facets is 99; it must be 100 or more"):
        bumpy(99)
