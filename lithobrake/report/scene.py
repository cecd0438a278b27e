"""Moving bodies as a study keeps them: reads the pictures' part of a bed or landing file."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lithobrake.report.hulls import Hull
from lithobrake.report.style import GRAIN, LANDER

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Scene:
    """Bodies and their frames: time [s], shape [frame]; position [m], shape [frame, body, 3]; orientation (w, x, y, z),
    shape [frame, body, 4]; the file's attributes; the settling history by name, empty for a landing.
    """

    bodies: tuple[Hull, ...]
    time: Array
    position: Array
    orientation: Array
    attributes: dict[str, object]
    history: dict[str, Array]


def read_scene(path: Path, has_lander: bool) -> Scene:
    """Read a bed (`beds/bed_0.h5`) or a landing (`landing.h5`), in which the lander is the last body.

    Raises ValueError when the file holds no frames.
    """
    import h5py

    with h5py.File(path, "r") as file:
        if "frames" not in file:
            raise ValueError(f"{path} has no group 'frames': it was written without pictures; make it again")
        vertices, faces = file["vertices"][:], file["faces"][:].astype(np.int64)
        vertex_start, face_start = file["vertex_start"][:], file["face_start"][:]
        frames = {name: file[f"frames/{name}"][:] for name in ("time", "position", "orientation")}
        history = {name: data[:] for name, data in file["history"].items()} if "history" in file else {}
        attributes = {name: _plain(value) for name, value in file.attrs.items()}
    count = len(vertex_start) - 1
    bodies = tuple(
        _body(
            vertices[vertex_start[k] : vertex_start[k + 1]],
            faces[face_start[k] : face_start[k + 1]],
            LANDER if has_lander and k == count - 1 else GRAIN,
        )
        for k in range(count)
    )
    return Scene(bodies, frames["time"], frames["position"], frames["orientation"], attributes, history)


def _body(vertices: Array, faces: NDArray[np.int64], colour: str) -> Hull:
    """A body about its centroid, which is what its position in the file means."""
    corners = vertices[faces]
    middle = vertices.mean(axis=0)
    # Pyramids from an inner point to the faces; signs do not matter for a convex body seen from inside.
    volumes = np.abs(
        np.einsum("fk,fk->f", corners[:, 0] - middle, np.cross(corners[:, 1] - middle, corners[:, 2] - middle))
    )
    centres = (corners.sum(axis=1) + middle) / 4
    centroid = np.average(centres, axis=0, weights=volumes)
    return Hull(vertices - centroid, faces, colour)


def _plain(value: object) -> object:
    """An HDF5 attribute as an ordinary Python value."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value
