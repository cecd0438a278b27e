"""Fewer facets for the gravity of a shape that has millions: each point of gravity sums over all of them."""

import importlib

import numpy as np
from numpy.typing import NDArray

from lithobrake.geometry.mesh import mass_properties

INSTALL = 'pip install "lithobrake[thin]"'


def thinned(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], facet_count: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices [m] and facets, facet_count or a few more, of the same volume and centroid.

    Edges whose ends move the surface least are drawn together, one after the other. Source: [Garland-1997]
    Raises ImportError, with how to install it, where the package that does so is absent.
    """
    try:
        simplification = importlib.import_module("fast_simplification")
    except ImportError as error:
        raise ImportError(f"fast-simplification, which thins a mesh, is not installed: {INSTALL}") from error
    # It takes arrays that it may write to, and corners of 32 bits.
    fewer, corners = simplification.simplify(
        np.array(vertices, order="C"), np.array(faces, dtype=np.int32, order="C"), target_count=facet_count
    )
    found, index = np.array(fewer, dtype=np.float64), np.array(corners, dtype=np.int64)
    volume, centroid, _ = mass_properties(vertices, faces)
    lost, moved, _ = mass_properties(found, index)
    return (found - moved) * (volume / lost) ** (1.0 / 3.0) + centroid, index
