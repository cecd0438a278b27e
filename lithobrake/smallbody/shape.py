"""The surface of a small body."""

import os
import warnings
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.geometry.mesh import closed_faces, mass_properties, thinned
from lithobrake.geometry.mesh_files import read_mesh
from lithobrake.geometry.mesh_units import labelled_mesh
from lithobrake.smallbody.attraction import Gravity
from lithobrake.smallbody.facet_grid import Grid, cones, heights, near_heights, outermost_hit, pseudonormals
from lithobrake.smallbody.gravity_table import LEVELS, GravityTable
from lithobrake.smallbody.gravity_table_build import TableError, gravity_table_of
from lithobrake.smallbody.multipole import RADII, Multipole
from lithobrake.smallbody.polyhedron_gravity import PolyhedronTerms
from lithobrake.vocabulary.given_numbers import numbers

FEWEST_FACETS = 100
OFF_CENTRE = 1e-3  # of the radius: how far the centre of mass may lie from the origin without a word


class Shape:
    """A closed surface of triangles in the body-fixed frame, kept as given: nothing is moved or turned.

    vertices     [m], shape [vertex_count, 3]
    faces        vertex indices, counter-clockwise from outside, shape [facet_count, 3]
    volume       [m3]
    centroid     of the volume [m], shape [3]
    inertia_per_density   about the centroid [m5], shape [3, 3]
    gravity_facets   how many facets gravity is summed over; a shape that has more is thinned for that, keeping volume
                     and centroid, and stays as it is for the ground; None: all

    Raises ValueError for a mesh that is open, non-manifold, degenerate or in pieces; warns where it turns facets
    outward. It does not look for facets that intersect.
    """

    def __init__(
        self, vertices: ArrayLike, faces: ArrayLike, *, name: str = "shape", gravity_facets: int | None = None
    ) -> None:
        if gravity_facets is not None and gravity_facets < FEWEST_FACETS:
            raise ValueError(f"{name}: gravity_facets is {gravity_facets}; it must be {FEWEST_FACETS} or more.")
        self.name, self.gravity_facets = name, gravity_facets
        self.vertices = np.ascontiguousarray(numbers(f"{name}: vertices", vertices))
        given = np.asarray(faces)
        if not np.issubdtype(given.dtype, np.integer):
            raise ValueError(f"{name}: faces have the type {given.dtype}; give vertex indices as integers.")
        faces = closed_faces(self.vertices, given.astype(np.int64), name)
        # Vertices that no facet uses are not of the body.
        used, index = np.unique(faces, return_inverse=True)
        self.vertices, self.faces = self.vertices[used], np.ascontiguousarray(index.reshape(faces.shape))
        self.volume, self.centroid, self.inertia_per_density = mass_properties(self.vertices, self.faces)
        # Moments, grids and tables are made from these once, and would be wrong after a change.
        self.vertices.flags.writeable = self.faces.flags.writeable = False

    @classmethod
    def read(
        cls, path: str | os.PathLike[str], unit: str | None = None, *, gravity_facets: int | None = None
    ) -> "Shape":
        """Read a mesh: .obj, .stl, plates or Gaskell's quadrilaterals (.tab, .txt, .icq), or a shape kernel (.bds).

        The path may also be that of the mesh's label of PDS4 (.xml), beside it under its name.
        unit: of its lengths (m, km, cm, mm); absent: what its header or the label beside it says, else m. An archive's
        file that does not say it is refused, as is a unit that the file contradicts.
        Warns where the centre of mass is off the origin by more than a thousandth of the radius; nothing is moved.
        """
        vertices, faces = read_mesh(labelled_mesh(Path(path)), unit)
        shape = cls(vertices, faces, name=os.fspath(path), gravity_facets=gravity_facets)
        offset = float(np.linalg.norm(shape.centroid))
        if offset > OFF_CENTRE * shape.radius:
            place = ", ".join(f"{length:.4g}" for length in shape.centroid)
            warnings.warn(
                f"{shape.name}: the centre of mass lies at ({place}) m, {offset:.3g} m off the origin, about which the "
                "body turns; nothing was moved. Move the vertices if that is not meant.",
                stacklevel=2,
            )
        return shape

    @cached_property
    def polyhedron(self) -> PolyhedronTerms:
        """The arrays of the gravity kernels."""
        return PolyhedronTerms.of(self.vertices, self.faces)

    @cached_property
    def attracting(self) -> "Shape":
        """What gravity is summed over: this shape, or one with gravity_facets in its place."""
        if self.gravity_facets is None or len(self.faces) <= self.gravity_facets:
            return self
        return Shape(*thinned(self.vertices, self.faces, self.gravity_facets), name=f"{self.name}, thinned")

    @cached_property
    def multipole(self) -> Multipole:
        """Moments of the shape, and the distance beyond which they give its gravity."""
        return Multipole.of(self.polyhedron, self.centroid)

    @property
    def gravity(self) -> Gravity:
        """What the gravity kernels read."""
        return Gravity(self.attracting.polyhedron, self.attracting.multipole, GravityTable.empty())

    def gravity_at(self, points: NDArray[np.float64]) -> Gravity:
        """What the gravity kernels read for these points [m], shape [count, 3].

        Moments take most of a second, and are not computed for points that are all nearer than any series is used.
        """
        part = self.attracting
        if "multipole" in vars(part):
            return self.gravity
        reach = RADII[0] * np.linalg.norm(part.vertices - part.centroid, axis=1).max()
        if (np.linalg.norm(points - part.centroid, axis=1) >= reach).any():
            return self.gravity
        return Gravity(part.polyhedron, Multipole.unused(part.centroid), GravityTable.empty())

    @property
    def tabled_gravity(self) -> Gravity:
        """The same with the table, which covers all but the farthest points."""
        return Gravity(self.attracting.polyhedron, self.attracting.multipole, self._table[0])

    @property
    def distant_gravity(self) -> Gravity:
        """The same for a body that flights rarely approach: from a coarser table, built in a tenth of the time."""
        return Gravity(self.attracting.polyhedron, self.attracting.multipole, self._coarse_table[0])

    @property
    def table_error(self) -> TableError:
        """Error of the table against the sum over the facets."""
        return self._table[1]

    @cached_property
    def _table(self) -> tuple[GravityTable, TableError]:
        return gravity_table_of(self.attracting.polyhedron, self.attracting.multipole, self.volume, LEVELS)

    @cached_property
    def _coarse_table(self) -> tuple[GravityTable, TableError]:
        return gravity_table_of(self.attracting.polyhedron, self.attracting.multipole, self.volume, LEVELS[2:])

    @cached_property
    def corners(self) -> NDArray[np.float64]:
        """Vertices of each facet [m], shape [facet_count, 3, 3]."""
        return np.ascontiguousarray(self.vertices[self.faces])

    @property
    def normals(self) -> NDArray[np.float64]:
        """Outward unit normals of the facets, shape [facet_count, 3]."""
        return self.polyhedron.facet_terms[:, :3]

    @cached_property
    def inward(self) -> NDArray[np.float64]:
        """Unit vectors in the facets, square to their edges 01, 12 and 20 and inward, shape [facet_count, 3, 3]."""
        inward = np.cross(self.normals[:, None], np.roll(self.corners, -1, axis=1) - self.corners)
        return inward / np.linalg.norm(inward, axis=2, keepdims=True)

    @cached_property
    def facet_sizes(self) -> NDArray[np.float64]:
        """Edges of squares twice as large as the facets [m], shape [facet_count]."""
        corner = self.corners
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        edge: NDArray[np.float64] = np.sqrt(np.linalg.norm(normal, axis=1))
        return edge

    @cached_property
    def pseudonormals(self) -> NDArray[np.float64]:
        """Outward directions of the facets' edges and corners, shape [facet_count, 7, 3]."""
        return pseudonormals(self.vertices, self.faces, self.normals)

    @cached_property
    def cones(self) -> NDArray[np.float64]:
        """Cones from the origin around the facets: axes, and cosines of their half angles, shape [facet_count, 4]."""
        return cones(self.corners)

    @cached_property
    def neighbours(self) -> NDArray[np.int64]:
        """Facets across the edges 01, 12 and 20 of each facet, shape [facet_count, 3]."""
        forth = self.faces * len(self.vertices) + self.faces[:, [1, 2, 0]]
        back = self.faces[:, [1, 2, 0]] * len(self.vertices) + self.faces
        # The facet beyond runs along the common edge the other way.
        order = np.argsort(forth, axis=None)
        found: NDArray[np.int64] = order[np.searchsorted(forth.reshape(-1), back, sorter=order)] // 3
        return found

    @cached_property
    def grid(self) -> Grid:
        """The facets sorted into cells."""
        return Grid.of(self.vertices, self.faces)

    @property
    def radius(self) -> float:
        """Distance of the farthest vertex from the origin [m]."""
        return float(np.linalg.norm(self.vertices, axis=1).max())

    def latitude_longitude(self, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Planetocentric latitude and east longitude in (-180, 180] [deg] of body-fixed points [m], shape [..., 3]."""
        p = checked_points(self.name, points)
        # No arc sine, which loses half of its digits towards the poles.
        latitude = np.degrees(np.arctan2(p[..., 2], np.hypot(p[..., 0], p[..., 1])))
        longitude = np.degrees(np.arctan2(p[..., 1], p[..., 0]))
        return latitude, np.where(longitude == -180.0, 180.0, longitude)

    def surface_point(
        self, latitude_deg: ArrayLike, longitude_deg: ArrayLike, height: ArrayLike = 0.0
    ) -> NDArray[np.float64]:
        """Outermost point of the surface in a direction from the origin, body-fixed [m], shape [..., 3].

        height   moves it along the radius [m]
        Raises ValueError where the direction does not meet the surface (the origin lies outside the body).
        """
        ground = self.locate(latitude_deg, longitude_deg)[0]
        above = numbers("height", height)
        if not np.isfinite(above).all():
            raise ValueError(f"height is {height!r} m; it must be finite.")
        ratio = above / np.linalg.norm(ground, axis=-1)
        return ground + np.asarray(ratio)[..., None] * ground

    def locate(
        self, latitude_deg: ArrayLike, longitude_deg: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """As surface_point, with the index of the facet, shape [...], that the point lies on."""
        latitude, longitude = np.broadcast_arrays(np.radians(latitude_deg), np.radians(longitude_deg))
        if not (np.isfinite(longitude).all() and (np.abs(latitude) <= 0.5 * np.pi).all()):
            raise ValueError(
                f"latitude_deg {latitude_deg!r} and longitude_deg {longitude_deg!r}: latitude must lie in -90 to 90, "
                "longitude must be finite."
            )
        across = np.cos(latitude)
        direction = np.stack([across * np.cos(longitude), across * np.sin(longitude), np.sin(latitude)], axis=-1)
        rays = np.ascontiguousarray(direction.reshape(-1, 3))
        distance, facet = np.empty(len(rays)), np.empty(len(rays), dtype=np.int64)
        outermost_hit(self.corners, self.cones, rays, distance, facet)
        if (facet < 0).any():
            raise ValueError(
                f"{self.name}: no surface at latitude_deg {latitude_deg!r}, longitude_deg {longitude_deg!r}; "
                "the frame's origin lies outside the body, move the vertices."
            )
        return (rays * distance[:, None]).reshape(direction.shape), facet.reshape(latitude.shape)

    def surface_normal(self, latitude_deg: ArrayLike, longitude_deg: ArrayLike) -> NDArray[np.float64]:
        """Outward unit normal of the facet at surface_point, shape [..., 3]."""
        normal: NDArray[np.float64] = self.normals[self.locate(latitude_deg, longitude_deg)[1]]
        return normal

    def height(self, points: ArrayLike) -> NDArray[np.float64]:
        """Distance to the surface [m], negative inside, of body-fixed points [m], shape [..., 3]."""
        return self.nearest(points)[0]

    def nearest(self, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Signed distance to the surface [m] and nearest facet of body-fixed points [m], shape [..., 3]."""
        p = np.ascontiguousarray(checked_points(self.name, points))
        rows, height, facet = p.reshape(-1, 3), np.empty(p.size // 3), np.empty(p.size // 3, dtype=np.int64)
        near_heights(self.grid, self.corners, self.pseudonormals, rows, height, facet)
        # Within a cell of the surface the grid has the nearest facet; all are looked at for what is farther.
        if len(far := np.flatnonzero(facet < 0)):
            distant = np.full(len(far), np.nan), np.full(len(far), -1)
            heights(self.corners, self.pseudonormals, rows[far], *distant)
            height[far], facet[far] = distant
        return height.reshape(p.shape[:-1]), facet.reshape(p.shape[:-1])

    def contains(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Whether body-fixed points [m], shape [..., 3], lie inside, and not on a facet, by the solid angle around them
        that the surface fills.
        """
        p = checked_points(self.name, points)
        rows = p.reshape(-1, 3)
        # What is farther from the origin than all vertices, as most of what flies about a partner, needs no sum.
        inside = np.linalg.norm(rows, axis=1) <= self.radius
        # Halfway between 2 pi on a facet and 4 pi inside, far above the rounding of the sum.
        inside[inside] = self.polyhedron.field(rows[inside])[:, 4] > 3.0 * np.pi
        return inside.reshape(p.shape[:-1])


def checked_points(name: str, points: ArrayLike) -> NDArray[np.float64]:
    """Points [..., 3] about the body of a name. Raises ValueError for what is none."""
    found = numbers("points", points)
    if found.shape[-1:] != (3,):
        raise ValueError(f"{name}: points have shape {found.shape}; the last axis must hold x, y, z.")
    return found


def delivered_directions(
    shape: Shape,
    latitude_deg: NDArray[np.float64],
    longitude_deg: NDArray[np.float64],
    north: NDArray[np.float64],
    east: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Directions from the centre, shape [count, 3], in which places lie that an error [m] moved north and east."""
    latitude, longitude = np.radians(latitude_deg), np.radians(longitude_deg)
    sine, cosine, along, across = np.sin(latitude), np.cos(latitude), np.cos(longitude), np.sin(longitude)
    up = np.stack([cosine * along, cosine * across, sine], axis=1)
    northward = np.stack([-sine * along, -sine * across, cosine], axis=1)
    eastward = np.stack([-across, along, np.zeros_like(along)], axis=1)
    way = np.hypot(north, east)
    turn = way / np.linalg.norm(shape.surface_point(latitude_deg, longitude_deg), axis=1)
    # Errors of 0 have no direction: the caller leaves these places out.
    ahead = (north / way)[:, None] * northward + (east / way)[:, None] * eastward
    there: NDArray[np.float64] = np.cos(turn)[:, None] * up + np.sin(turn)[:, None] * ahead
    return there
