"""Pictures of rigid convex bodies, painted from far to near, and the light on their faces."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from lithobrake.geometry.attitude import rotation_matrices
from lithobrake.report.figures.style import GRAIN, LANDER, shade
from lithobrake.results import MovingBodies
from lithobrake.results.motions import with_images
from lithobrake.vocabulary.array_types import Array, Integers

# Directions as the viewer has them: to the right, towards the viewer, up. The sun stands at the upper left, whatever
# the camera's azimuth; a weak light from the lower right keeps the form of what the sun does not reach.
SUN = np.array([-0.52, 0.18, 0.83])
FILL = np.array([0.45, 0.82, 0.2])
AMBIENT = 0.56
# A body this many times larger than the middle one is cut up before it is painted.
LARGE = 1.5


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


@dataclass(frozen=True)
class Hull:
    """A body of one convex part or more: vertices [m], shape [vertex, 3], about the point that its position is of;
    faces, shape [face, 3], counter-clockwise from outside; its colour.
    """

    vertices: Array
    faces: Integers
    colour: str


@dataclass(frozen=True)
class Camera:
    """A perspective camera: where it looks [m], from which azimuth and elevation [deg], from how far [m]."""

    target: tuple[float, float, float]
    azimuth_deg: float
    elevation_deg: float
    distance: float

    def axes(self) -> Array:
        """Rows: right, up and towards the viewer, unit vectors, shape [3, 3]."""
        azimuth, elevation = np.radians([self.azimuth_deg, self.elevation_deg])
        toward = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
        right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
        return np.stack([right, np.cross(toward, right), toward])

    def project(self, points: Array) -> tuple[Array, Array]:
        """Picture plane coordinates [m at the target], shape [..., 2], and nearness [m], shape [...]."""
        seen = (points - np.array(self.target)) @ self.axes().T
        scale = self.distance / (self.distance - seen[..., 2])
        return seen[..., :2] * scale[..., None], seen[..., 2]


def subdivide(triangles: Array, longest: float) -> Array:
    """Cut triangles, shape [count, 3, 3], in four until no edge is longer than `longest` [m]."""
    edges = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
    large = edges > longest
    if not large.any():
        return triangles
    a, b, c = np.moveaxis(triangles[large], 1, 0)
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    pieces = [np.stack(corners, axis=1) for corners in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    return np.concatenate([triangles[~large], subdivide(np.concatenate(pieces), longest)])


def world_triangles(bodies: Sequence[Hull], position: Array, orientation: Array) -> tuple[Array, NDArray[np.int64]]:
    """Faces of all bodies in the world, shape [face, 3, 3] [m], wound outwards, and the body each belongs to."""
    turns = rotation_matrices(orientation)
    large = _is_large(bodies)
    longest = 1.3 * float(np.median([np.linalg.norm(body.vertices, axis=1).max() for body in bodies]))
    pieces, owners = [], []
    for index, body in enumerate(bodies):
        corners = body.vertices[body.faces]
        if large[index]:
            corners = subdivide(corners, longest)
        pieces.append(corners @ turns[index].T + position[index])
        owners.append(np.full(len(corners), index))
    return np.concatenate(pieces), np.concatenate(owners)


def paint(
    axes: Axes,
    bodies: Sequence[Hull],
    position: Array,
    orientation: Array,
    camera: Camera,
    surface_height: float | None = None,
) -> None:
    """Paint the bodies at position [m], shape [body, 3], orientation (w, x, y, z), shape [body, 4], onto flat axes.

    `surface_height` [m]: what lies below it sees less sky; absent, all bodies see the same.
    """
    triangles, owners = world_triangles(bodies, position, orientation)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    to_eye = np.array(camera.target) + camera.distance * camera.axes()[2] - triangles.mean(axis=1)
    seen = np.flatnonzero(np.einsum("fk,fk->f", normals, to_eye) > 0)
    order = seen[np.argsort(-np.linalg.norm(to_eye[seen], axis=1), kind="stable")]
    triangles, owners, normals = triangles[order], owners[order], normals[order]

    # Of a lander with booms most corners are near its middle: the median leaves the tips out of its shadow.
    radius = np.array([0.85 * np.median(np.linalg.norm(body.vertices, axis=1)) for body in bodies])
    light = light_on_faces(
        triangles.mean(axis=1), normals, owners, position, radius, camera.azimuth_deg, surface_height
    )
    colours = np.empty((len(triangles), 3))
    palette = np.array([body.colour for body in bodies])[owners]
    for colour in np.unique(palette):
        colours[palette == colour] = shade(str(colour), light[palette == colour])
    # The edge closes the hairline that antialiasing leaves between two faces; a little darker it sets grains apart, but
    # on a face that was cut up it would show the cuts.
    edges = colours * np.where(_is_large(bodies), 1.0, 0.84)[owners][:, None]
    # One array of triangles is drawn much faster than a list of polygons, and not all versions declare it.
    stack: Any = camera.project(triangles)[0]
    axes.add_collection(PolyCollection(stack, facecolors=colours, edgecolors=edges, linewidths=0.3, rasterized=True))


def _is_large(bodies: Sequence[Hull]) -> NDArray[np.bool_]:
    """Which bodies are large beside the middle one, shape [body]."""
    sizes = np.array([np.linalg.norm(body.vertices, axis=1).max() for body in bodies])
    large: NDArray[np.bool_] = sizes > LARGE * np.median(sizes)
    return large


def frame_axes(axes: Axes, x_range: tuple[float, float], y_range: tuple[float, float]) -> None:
    """Set the part of the picture plane [m] that is shown, to scale, without axes."""
    axes.set_xlim(*x_range)
    axes.set_ylim(*y_range)
    axes.set_aspect("equal")
    axes.set_axis_off()


def draw_box(axes: Axes, width: tuple[float, float] | None, height: float, camera: Camera, front: bool) -> None:
    """Draw the edges of the open box (walls at +-width/2, floor at z = 0), if there is one; front: those nearer than
    its middle.
    """
    if width is None:
        return
    x, y = width[0] / 2, width[1] / 2
    corners = np.array([(sx * x, sy * y, z) for z in (0.0, height) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    edges = (
        [(k, (k + 1) % 4) for k in range(4)]
        + [(4 + k, 4 + (k + 1) % 4) for k in range(4)]
        + [(k, k + 4) for k in range(4)]
    )
    nearness = corners @ camera.axes()[2] * 0 + corners[:, :2] @ camera.axes()[2][:2]
    flat, _ = camera.project(corners)
    for a, b in edges:
        if (nearness[a] + nearness[b] > 1e-9 * x) == front:
            axes.plot(
                *flat[[a, b]].T,
                color="#55606b",
                linewidth=0.8,
                alpha=0.9,
                solid_capstyle="round",
                zorder=3 if front else 0,
            )


@dataclass(frozen=True)
class Scene:
    """Bodies as they are drawn, and how they moved.

    box: width of the box that they lie in [m], None on ground that repeats.
    """

    bodies: tuple[Hull, ...]
    moving: MovingBodies
    box: tuple[float, float] | None

    @property
    def ground(self) -> Array:
        """Least and largest x and y of the ground [m], shape [2, 2]: of the box, or of the bodies in the last frame."""
        if self.box is not None:
            return np.array([[-0.5], [0.5]]) * self.box
        place = self.moving.position[-1, :, :2]
        return np.array([place.min(axis=0), place.max(axis=0)])


def scene(moving: MovingBodies, has_lander: bool) -> Scene:
    """The bodies of a bed, or of a landing, in which the lander is the last and grains stand with their images."""
    moving = with_images(moving)
    last = len(moving.vertices) - 1
    bodies = tuple(
        Hull(vertices, faces, LANDER if has_lander and number == last else GRAIN)
        for number, (vertices, faces) in enumerate(zip(moving.vertices, moving.faces, strict=True))
    )
    along, across = moving.attributes.get("width", (0.0, 0.0))
    return Scene(bodies, moving, None if moving.attributes.get("sides") == "periodic" else (along, across))
