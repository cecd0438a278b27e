"""Light on the faces of painted bodies: a sun with soft shadows, a weak light from the other side, and the sky."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Array = NDArray[np.float64]

SUN = np.array([-0.45, -0.35, 0.82])
# A weak light from the other side keeps the form of what the sun does not reach.
FILL = np.array([0.8, -0.5, 0.2])
AMBIENT = 0.56


def light_on_faces(
    centres: Array,
    normals: Array,
    owners: NDArray[np.int64],
    position: Array,
    radius: Array,
    surface_height: float | None,
) -> Array:
    """Brightness of each face, 1 for one that faces the sun, shape [face].

    centres [m] and unit normals of the faces, shape [face, 3]; owners: the body of each, shape [face]; position [m],
    shape [body, 3], and radius [m], shape [body], of the bodies; surface_height [m]: below it the sky is narrower.
    """
    sun = np.clip(normals @ (SUN / np.linalg.norm(SUN)), 0.0, None) * sunlight(centres, owners, position, radius)
    sky = 0.80 + 0.20 * normals[:, 2]
    if surface_height is not None:
        depth = (surface_height - centres[:, 2]) / max(surface_height, 1e-30)
        sky = sky * np.where(depth > 0, 1.0 - 0.35 * np.clip(depth, 0.0, 1.0), 1.0)
    fill = np.clip(normals @ (FILL / np.linalg.norm(FILL)), 0.0, None)
    # A few per cent of tint, fixed by the body's number, keeps neighbours of one colour apart.
    tint = 1.0 + 0.09 * np.sin(2.399963 * owners)
    light: Array = (AMBIENT * sky + 0.16 * fill + 0.60 * sun) * tint
    return light


def sunlight(centres: Array, owners: NDArray[np.int64], position: Array, radius: Array) -> Array:
    """Share of the sun that each face sees, shape [face], with each other body taken as a ball of its radius [m]."""
    sun = SUN / np.linalg.norm(SUN)
    across = np.linalg.svd(sun[None, :])[2][1:]
    flat_faces, flat_bodies = centres @ across.T, position @ across.T
    height_faces, height_bodies = centres @ sun, position @ sun
    light = np.ones(len(centres))
    tree = cKDTree(flat_faces)
    for body, near in enumerate(tree.query_ball_point(flat_bodies, 1.15 * radius)):
        faces = np.array(near, dtype=int)
        faces = faces[(owners[faces] != body) & (height_faces[faces] < height_bodies[body])]
        reach = np.linalg.norm(flat_faces[faces] - flat_bodies[body], axis=1) / radius[body]
        # A soft rim from .65 to 1.15 radii stands for what the ball leaves out of the true outline.
        cover = np.clip((1.15 - reach) / 0.5, 0.0, 1.0)
        np.minimum.at(light, faces, 1.0 - cover)
    return light
