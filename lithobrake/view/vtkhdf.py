"""Moving bodies as a VTKHDF file: ParaView opens it and plays it.

One file of type PolyData, version 2.1, whose triangles stand there once and whose points, speeds and forces
stand there for each instant.

Source: [Kitware-2026].
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.files.atomic import atomic_path
from lithobrake.results.ground_images import with_images
from lithobrake.view.motion import body_speeds, placed, triangles

if TYPE_CHECKING:
    from lithobrake.results.moving_bodies import MovingBodies

VERSION = (2, 1)
EMPTY = ("Vertices", "Lines", "Strips")


def write_vtkhdf(bodies: "MovingBodies", path: str | Path) -> None:
    """Write bodies and their motion: points [m], and for each triangle the number and the speed [m/s] of its body.

    Where forces were kept also the size of the sum of contact forces on it [N].

    The lander of a landing is the body with the last number. On ground that repeats grains stand there with their
    images around its way.
    """
    import h5py

    bodies = with_images(bodies)
    faces, owner = triangles(bodies)
    frames, points = len(bodies.time), sum(len(hull) for hull in bodies.vertices)
    with atomic_path(path) as draft, h5py.File(draft, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = VERSION
        root.attrs.create("Type", b"PolyData", dtype="S8")
        root["NumberOfPoints"] = np.full(frames, points)
        _write_packed(root, "Points", np.concatenate([placed(bodies, frame) for frame in range(frames)]))
        _write_triangles(root, faces, frames)
        data = root.create_group("CellData")
        data["body"] = owner.astype(np.int32)
        _write_packed(data, "speed", body_speeds(bodies)[:, owner].ravel())
        if bodies.force is not None:
            _write_packed(data, "force", bodies.force[:, owner].ravel())
        _write_steps(root, bodies.time, points, len(faces))


def _write_packed(group: Any, name: str, values: np.ndarray) -> None:
    """Write single precision, compressed: most bodies rest, and a file is a quarter as large."""
    group.create_dataset(name, data=values.astype(np.float32), compression="gzip", shuffle=True)


def _write_triangles(root: Any, faces: np.ndarray, frames: int) -> None:
    """Write the triangles, which every instant points at, and the kinds of cells that there are none of."""
    for name in EMPTY:
        group = root.create_group(name)
        for count in ("NumberOfCells", "NumberOfConnectivityIds"):
            group[count] = np.zeros(frames, np.int64)
        group["Connectivity"], group["Offsets"] = np.zeros(0, np.int64), np.zeros(frames, np.int64)
    group = root.create_group("Polygons")
    group["NumberOfCells"] = np.full(frames, len(faces))
    group["NumberOfConnectivityIds"] = np.full(frames, faces.size)
    group["Connectivity"], group["Offsets"] = faces.ravel().astype(np.int64), np.arange(len(faces) + 1) * 3


def _write_steps(root: Any, time: np.ndarray, points: int, cells: int) -> None:
    """Write where the data of each instant begin."""
    frames = len(time)
    steps, each = root.create_group("Steps"), np.arange(frames)
    steps.attrs["NSteps"] = frames
    steps["Values"] = time
    steps["PartOffsets"], steps["NumberOfParts"] = each, np.ones(frames, np.int64)
    steps["PointOffsets"] = each * points
    steps["CellOffsets"] = np.zeros((frames, 4), np.int64)
    steps["ConnectivityIdOffsets"] = np.zeros((frames, 4), np.int64)
    offsets = steps.create_group("CellDataOffsets")
    for name in root["CellData"]:
        offsets[name] = np.zeros(frames, np.int64) if name == "body" else each * cells
