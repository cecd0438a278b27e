"""Moving bodies of a study as the page draws them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.report.figures.hulls import Hull
from lithobrake.report.figures.style import GRAIN, LANDER
from lithobrake.results import MovingBodies

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Scene:
    """Bodies as they are drawn, each about its centroid, and how they moved."""

    bodies: tuple[Hull, ...]
    moving: MovingBodies


def scene(moving: MovingBodies, has_lander: bool) -> Scene:
    """The bodies of a bed, or of a landing, in which the lander is the last."""
    last = len(moving.vertices) - 1
    bodies = tuple(
        _body(vertices, faces, LANDER if has_lander and number == last else GRAIN)
        for number, (vertices, faces) in enumerate(zip(moving.vertices, moving.faces, strict=True))
    )
    return Scene(bodies, moving)


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
