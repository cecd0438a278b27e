"""Where the hulls of a motion are at an instant, and how fast."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.geometry.attitude import rotation_matrices

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from lithobrake.results.moving_bodies import MovingBodies

    Floats = NDArray[np.float64]
    Faces = NDArray[np.int64]


def placed(bodies: "MovingBodies", frame: int) -> "Floats":
    """Return all vertices at a frame [m], one hull after the other, shape [vertex_count, 3]."""
    turn, place = rotation_matrices(bodies.orientation[frame]), bodies.position[frame]
    return np.concatenate([hull @ turn[body].T + place[body] for body, hull in enumerate(bodies.vertices)])


def triangles(bodies: "MovingBodies") -> "tuple[Faces, Faces]":
    """Return all triangles, counted over all vertices as `placed` has them, [face_count, 3], and the body of each."""
    counts = [len(hull) for hull in bodies.vertices]
    start = np.concatenate([[0], np.cumsum(counts)[:-1]])
    faces = np.concatenate([hull + first for hull, first in zip(bodies.faces, start, strict=True)])
    return faces, np.repeat(np.arange(len(counts)), [len(hull) for hull in bodies.faces])


def body_speeds(bodies: "MovingBodies") -> "Floats":
    """Return the mean speed [m/s] of each body since the frame before, of the first frame that of the second.

    Shape [frame_count, body_count]; 0 where there is one frame.
    """
    if len(bodies.time) < 2:
        return np.zeros(bodies.position.shape[:2])
    way = np.linalg.norm(np.diff(bodies.position, axis=0), axis=2)
    passed = np.diff(bodies.time)[:, None]
    speed = np.divide(way, passed, out=np.zeros_like(way), where=passed > 0.0)
    return np.concatenate([speed[:1], speed])
