"""Gravity tables on disk: made again where damaged, and in memory alone where they cannot be kept."""

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lithobrake.compilation.disk_cache import DiskCache
from lithobrake.smallbody import Shape, gravity_table_build
from lithobrake.smallbody.gravity_table_build import gravity_table_of

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


@pytest.mark.parametrize(
    "spoil",
    [
        lambda whole: whole[:-500], lambda whole: b"", lambda whole: whole[:300] + b"?" + whole[301:],
        lambda whole: with_objects(),
    ],
    ids=["truncated", "empty", "one byte", "objects"],
)  # fmt: skip
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
