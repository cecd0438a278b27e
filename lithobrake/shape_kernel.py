"""Plates of the shape kernels (DSK) of SPICE, by NAIF's own routines."""

import importlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

INSTALL = 'pip install "lithobrake[spice]"'
PLATE_MODEL = 2  # data type of a segment


def spice() -> Any:
    """The package spiceypy. Raises ImportError, with how to install it, where it is absent."""
    try:
        return importlib.import_module("spiceypy")
    except ImportError as error:
        raise ImportError(f"spiceypy, which reads the kernels of SPICE, is not installed: {INSTALL}") from error


def read_shape_kernel(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices [km], shape [vertex_count, 3], and faces, [facet_count, 3], of a kernel with one plate model.

    Raises ValueError for a file that is none, or has several segments.
    """
    kernels = spice()
    try:
        handle = kernels.dasopr(str(path))
    except kernels.exceptions.SpiceyError as error:
        raise ValueError(f"{path}: not a kernel that SPICE opens ({error.short}); give a shape kernel.") from error
    try:
        return _plates(kernels, handle, path)
    except (kernels.exceptions.SpiceyError, kernels.exceptions.NotFoundError) as error:
        raise ValueError(f"{path}: a kernel without plates ({error}); give a shape kernel (.bds).") from error
    finally:
        kernels.dascls(handle)


def _plates(kernels: Any, handle: int, path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
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
    vertices = kernels.dskv02(handle, segment, 1, vertex_count)
    plates = kernels.dskp02(handle, segment, 1, plate_count)
    return np.array(vertices, dtype=np.float64), np.array(plates, dtype=np.int64) - 1
