"""Light on the faces of painted bodies: a sun with soft shadows, a weak light from the other side, and the sky."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Array = NDArray[np.float64]

# Directions as the viewer has them: to the right, towards the viewer, up. The sun stands at the upper left, whatever
# the camera's azimuth; a weak light from the lower right keeps the form of what the sun does not reach.
SUN = np.array([-0.52, 0.18, 0.83])
FILL = np.array([0.45, 0.82, 0.2])
AMBIENT = 0.56


def light_on_faces(
    centres: Array,
    normals: Array,
    owners: NDArray[np.int64],
    position: Array,
    radius: Array,
    azimuth_deg: float,
    surface_height: float | None,
) -> Array:
    """Brightness of each face, 1 for one that faces the sun, shape [face].

    centres [m] and unit normals of the faces, shape [face, 3]; owners: the body of each, shape [face]; position [m],
    shape [body, 3], and radius [m], shape [body], of the bodies; azimuth_deg: of the viewer [deg]; surface_height [m]:
    below it the sky is narrower.
    """
    to_sun, to_fill = (direction(light, azimuth_deg) for light in (SUN, FILL))
    sun = np.clip(normals @ to_sun, 0.0, None) * sunlight(centres, owners, position, radius, to_sun)
    sky = 0.80 + 0.20 * normals[:, 2]
    if surface_height is not None:
        depth = (surface_height - centres[:, 2]) / max(surface_height, 1e-30)
        sky = sky * np.where(depth > 0, 1.0 - 0.35 * np.clip(depth, 0.0, 1.0), 1.0)
    fill = np.clip(normals @ to_fill, 0.0, None)
    # A few per cent of tint, fixed by the body's number, keeps neighbours of one colour apart.
    tint = 1.0 + 0.09 * np.sin(2.399963 * owners)
    light: Array = (AMBIENT * sky + 0.16 * fill + 0.60 * sun) * tint
    return light


def direction(seen: Array, azimuth_deg: float) -> Array:
    """Unit vector in the world of a direction as the viewer at an azimuth [deg] has it: right, towards, up."""
    azimuth = np.radians(azimuth_deg)
    right, toward = (
        np.array([-np.sin(azimuth), np.cos(azimuth), 0.0]),
        np.array([np.cos(azimuth), np.sin(azimuth), 0.0]),
    )
    world: Array = seen[0] * right + seen[1] * toward + seen[2] * np.array([0.0, 0.0, 1.0])
    return world / np.linalg.norm(world)


def sunlight(centres: Array, owners: NDArray[np.int64], position: Array, radius: Array, sun: Array) -> Array:
    """Share of the sun that each face sees, shape [face], with each other body taken as a ball of its radius [m]."""
    across = np.linalg.svd(sun[None, :])[2][1:]
    flat_faces, flat_bodies = centres @ across.T, position @ across.T
    height_faces, height_bodies = centres @ sun, position @ sun
    light = np.ones(len(centres))
    tree = cKDTree(flat_faces)
    for body, near in enumerate(tree.query_ball_point(flat_bodies, 1.15 * radius)):
        faces = np.array(near, dtype=int)
        faces = faces[(owners[faces] != body) & (height_faces[faces] < height_bodies[body])]
        reach = np.linalg.norm(flat_faces[faces] - flat_bodies[body], axis=1) / radius[body]
        # A soft rim from 0.65 to 1.15 radii stands for what the ball leaves out of the true outline.
        cover = np.clip((1.15 - reach) / 0.5, 0.0, 1.0)
        np.minimum.at(light, faces, 1.0 - cover)
    return light
