"""Plates of the shape kernels (DSK) of SPICE, by NAIF's own routines."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.geometry.kernel_process import read_apart, spice

PLATE_MODEL = 2  # data type of a segment
VERTEX_SIZE, PLATE_SIZE = 24, 12  # in a kernel [bytes]

Plates = tuple[NDArray[np.float64], NDArray[np.int64]]


def read_shape_kernel(path: Path) -> Plates:
    """Vertices [km], shape [vertex_count, 3], and faces, [facet_count, 3], of a kernel with one plate model.

    Raises ValueError for a file that is none, is damaged, or has several segments.
    """
    vertices, faces = read_apart(plates, str(path), kernels=[str(path)]).unpacked()
    return vertices, faces


def plates(path: str) -> Plates:
    """The same, in this process, which SPICE may end where the file is damaged."""
    kernels = spice()
    try:
        handle = kernels.dasopr(path)
    except kernels.exceptions.SpiceyError as error:
        raise ValueError(f"{path}: not a kernel that SPICE opens ({error.short}); give a shape kernel.") from error
    try:
        return _plates(kernels, handle, path)
    except (kernels.exceptions.SpiceyError, kernels.exceptions.NotFoundError) as error:
        words = getattr(error, "short", "") or type(error).__name__
        raise ValueError(f"{path}: a kernel without plates ({words}); give a shape kernel (.bds).") from error
    finally:
        kernels.dascls(handle)


def _plates(kernels: Any, handle: int, path: str) -> Plates:
    segment, count = kernels.dlabfs(handle), 1
    following = segment
    while True:
        try:
            following = kernels.dlafns(handle, following)
        except kernels.exceptions.NotFoundError:
            break
        count += 1
    kind = kernels.dskgd(handle, segment).dtype
    if count != 1 or kind != PLATE_MODEL:
        raise ValueError(
            f"{path}: {count} segments, the first of data type {kind}; allowed: one of type {PLATE_MODEL}, a plate "
            "model: split the kernel, or export the segment with NAIF's DSKEXP."
        )
    vertex_count, plate_count = kernels.dskz02(handle, segment)
    size = Path(path).stat().st_size
    if min(vertex_count, plate_count) < 1 or VERTEX_SIZE * vertex_count + PLATE_SIZE * plate_count > size:
        raise ValueError(
            f"{path}: {vertex_count} vertices and {plate_count} plates in {size} bytes cannot be; fetch it again."
        )
    vertices = kernels.dskv02(handle, segment, 1, vertex_count)
    faces = kernels.dskp02(handle, segment, 1, plate_count)
    return np.array(vertices, dtype=np.float64), np.array(faces, dtype=np.int64) - 1
