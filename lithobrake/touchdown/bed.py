"""A settled bed of grains, its file, and its surface as a vertical ray sees it."""

import itertools
import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem import ConvexHull, Material, World, folded, pair_law, period_of, rotation_matrices
from lithobrake.files.atomic import atomic_path
from lithobrake.files.reading import reading
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.field_errors import FieldError
from lithobrake.vocabulary.quantities import describe

RAYS_PER_DIAMETER = 4
FORMAT_VERSION = 2
# A bed ends at the walls of a box, or goes on with its own image on every side.
SIDES = ("walls", "periodic")
# Friction of the floor under grains on a slope without walls, at least, over the tangent of the slope.
# On such a floor grains settle and hold down to a friction of 0.4 of the tangent; studies that go lower are refused.
HOLDING = 2.0
SCALARS = (
    "width", "gravity", "density", "young_modulus", "poisson_ratio", "seed", "surface_height", "surface_top",
    "solid_fraction", "coordination_number",
)  # fmt: skip


def rotation_matrix(quaternion: Floats) -> Floats:
    """Return the rotation matrix [3, 3], body to world, of a unit quaternion w, x, y, z."""
    return rotation_matrices(quaternion[None])[0]


def height_map(
    grains: list[ConvexHull], position: Floats, orientation: Floats, width: tuple[float, float],
    period: tuple[float, float] | None = None,
) -> Floats:  # fmt: skip
    """Return the height [m] of the topmost grain over a regular grid of the bed, 0 where only the floor is seen.

    period [m]: after which the ground repeats; None in a box.
    """
    spacing = np.mean([2.0 * grain.bounding_radius for grain in grains]) / RAYS_PER_DIAMETER
    axes = [(np.arange(n := max(1, round(w / spacing))) + 0.5) * w / n - 0.5 * w for w in width]
    x, y = np.meshgrid(*axes, indexing="ij")
    return np.maximum(heights_at(x, y, grains, position, orientation, period), 0.0)


def heights_at(
    x: Floats, y: Floats, grains: list[ConvexHull], position: Floats, orientation: Floats,
    period: tuple[float, float] | None = None,
) -> Floats:  # fmt: skip
    """Return the height [m] of the topmost grain at places x, y [m] of any one shape, minus infinity where none is.

    period [m]: after which the ground repeats; None in a box.
    """
    heights = np.full_like(x, -np.inf)
    for grain, place, turn in zip(grains, position, orientation, strict=True):
        way = folded(np.stack([x - place[0], y - place[1]], axis=-1), period_of(period))
        near = way[..., 0] ** 2 + way[..., 1] ** 2 <= grain.bounding_radius**2
        if near.any():
            heights[near] = np.maximum(heights[near], place[2] + _top(grain, turn, *way[near].T))
    return heights


def _top(grain: ConvexHull, turn: Floats, x: Floats, y: Floats) -> Floats:
    """Return how far above the centroid vertical rays at x, y [m] from it leave a grain; minus infinity: they miss."""
    normals = grain.polyhedron.face_normals @ rotation_matrix(turn).T
    offsets = grain.polyhedron.face_offsets - grain.polyhedron.face_normals @ grain.centroid
    rest = offsets[:, None] - normals[:, :1] * x - normals[:, 1:2] * y
    # Upright faces bound the ray from the side, and neither from above nor below: they are looked at apart.
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = rest / normals[:, 2:]
    top = np.where(normals[:, 2:] > 0.0, crossing, np.inf).min(axis=0)
    bottom = np.where(normals[:, 2:] < 0.0, crossing, -np.inf).max(axis=0)
    beside = ((normals[:, 2:] == 0.0) & (rest < 0.0)).any(axis=0)
    found: Floats = np.where((top >= bottom) & ~beside, top, -np.inf)
    return found


@dataclass(frozen=True, kw_only=True)
class ContactModel:
    """Options of the contact law, see `dem.World`, and how contacts are stepped in a landing.

    A landing always has the tangential dashpot.
    steps_per_contact: in each ("local", see World.run_locally), or in the shortest that the impact can make.
    stepping: "local", steps of its own for each contact, or "global", the same for all.
    resolved_speed: collisions slower than this share of the lander take fewer steps, in proportion, but at least five.
    held_speed: grains that touch something stand still while they are slower than half of this share of the lander and
    farther from it than `smallest_bed` keeps clear, or, where an impact is over or it is too slow to leave,
    slower than CALM_AT_REST times the share, until a blow makes them as fast as the share; 0: none do. Only with local
    steps.
    """

    shear_modulus_rule: str = "mindlin"
    damping_mass: str = "contact"
    pair_rule: str = "smaller"
    steps_per_contact: float = 25.0
    stepping: str = "local"
    resolved_speed: float = 0.3
    held_speed: float = 0.0

    def __post_init__(self) -> None:
        if self.stepping not in ("global", "local"):
            raise FieldError("ContactModel.stepping", self.stepping, 'are "global" and "local"')
        if not 0.0 <= self.resolved_speed <= 1.0:
            raise FieldError("ContactModel.resolved_speed", self.resolved_speed, "is 0 <= value <= 1")
        if not 0.0 <= self.held_speed < 1.0:
            raise FieldError("ContactModel.held_speed", self.held_speed, "is 0 <= value < 1")
        if self.held_speed > 0.0 and self.stepping != "local":
            raise FieldError(
                "ContactModel.held_speed", self.held_speed, f'with stepping "{self.stepping}" is 0', "change either"
            )

    def world(self, gravity: tuple[float, float, float], period: tuple[float, float] | None = None) -> World:
        """Return an empty world under these options; period [m]: see World."""
        return World(
            gravity,
            shear_modulus_rule=self.shear_modulus_rule,
            damping_mass=self.damping_mass,
            pair_rule=self.pair_rule,
            period=period,
        )


@dataclass(frozen=True, eq=False)
class Bed:
    """Grains at rest on a floor at z = 0: in a box that is open at the top, or on ground that repeats.

    sides "walls": inner walls at +-width/2. sides "periodic": ground that repeats after each width, with the centroids
    of its grains within +-width/2; those of `frames` may have gone farther.

    frames holds "time" [s, frame_count], "position" [m, frame_count, grain_count, 3] and "orientation"
    [frame_count, grain_count, 4] of the pouring; history holds "time", "kinetic_ratio", "unbalanced_force", "gravity".
    """

    grains: list[ConvexHull]
    position: Floats  # m, [grain_count, 3]
    orientation: Floats  # [grain_count, 4]
    diameter: Floats  # m, [grain_count], of the spheres of equal volume
    width: tuple[float, float]  # m, along x and y
    gravity: tuple[float, float, float]  # m/s2, that it settled under
    density: float  # kg/m3
    young_modulus: float  # Pa, of the grains at rest, and poisson_ratio
    poisson_ratio: float
    seed: int
    surface_height: float  # m, mean over the box
    surface_top: float  # m, highest point of a grain
    solid_fraction: float
    coordination_number: float
    sides: str = "walls"
    boulder_count: int = 0  # of `grains`, the first ones
    frames: dict[str, Floats] = field(default_factory=dict)
    history: dict[str, Floats] = field(default_factory=dict)

    @property
    def grain_diameter(self) -> float:
        """Mean diameter of the grains but for the boulders [m]."""
        return float(self.diameter[self.boulder_count :].mean())

    @cached_property
    def elastic_energy_per_modulus(self) -> float:
        """Elastic energy of its contacts as they overlap, over the effective Young's modulus that they have [m3]."""
        # At given overlaps elastic energy is in proportion to the modulus, so one assembly of the bed serves every soil
        # it is landed with.
        unit = Material(young_modulus=1.0, poisson_ratio=0.0, restitution=1.0, friction=0.0, density=self.density)
        elastic = self.world(unit, self.gravity, ContactModel()).energy()["elastic"]
        return elastic / pair_law(unit, unit).young_modulus

    @property
    def period(self) -> tuple[float, float] | None:
        """Lengths after which the ground repeats along x and y [m]; None in a box."""
        return self.width if self.sides == "periodic" else None

    def boulder_height(self, x: Floats, y: Floats) -> Floats:
        """Height [m] of the boulders as they lie at places x, y [m] of any one shape; minus infinity beside them."""
        first = slice(self.boulder_count)
        lying = self.grains[first], self.position[first], self.orientation[first]
        return heights_at(x, y, *lying, self.period)

    def world(
        self, material: Material, gravity: tuple[float, float, float], contact: ContactModel,
        tilted: tuple[float, float, float] | None = None,
    ) -> World:  # fmt: skip
        """Return a world with these grains at rest, of a material, on a floor and in a box of the same material.

        tilted: see boxed_world.
        """
        body = self.grains, self.position, self.orientation, self.width
        return boxed_world(*body, material, gravity, contact, self.sides, tilted)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the bed to an HDF5 file, whole or not at all."""
        import h5py

        with atomic_path(path) as draft, h5py.File(draft, "w") as file:
            write_hulls(file, self.grains)
            for name in ("position", "orientation", "diameter"):
                file[name] = getattr(self, name)
            for group in ("frames", "history"):
                for name, values in getattr(self, group).items():
                    file[f"{group}/{name}"] = values
            describe(file)
            file.attrs["format"], file.attrs["format_version"] = "lithobrake bed", FORMAT_VERSION
            for name in (*SCALARS, "sides", "boulder_count"):
                file.attrs[name] = getattr(self, name)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> "Bed":
        """Read a bed. Raises ValueError where the file is damaged, or not one that this version reads."""
        import h5py

        with reading(path, "pour it again"), h5py.File(path, "r") as file:
            if file.attrs.get("format") != "lithobrake bed" or file.attrs["format_version"] > FORMAT_VERSION:
                raise ValueError(f"it is not a bed of format_version up to {FORMAT_VERSION}")
            lacking = [name for name in SCALARS if name not in file.attrs]
            if lacking:
                raise ValueError(f"it does not say what its {lacking[0]} is, as older beds do not")
            scalars = {name: plain(file.attrs[name]) for name in SCALARS}
            # A bed of version 1 has walls.
            scalars["sides"] = str(file.attrs.get("sides", "walls"))
            scalars["boulder_count"] = int(file.attrs.get("boulder_count", 0))
            groups: dict[str, Any] = {g: {n: file[g][n][()] for n in file.get(g, {})} for g in ("frames", "history")}
            arrays: dict[str, Any] = {name: file[name][()] for name in ("position", "orientation", "diameter")}
            return Bed(grains=read_hulls(file), **arrays, **groups, **scalars)


def plain(value: Any) -> Any:
    return tuple(float(v) for v in value) if np.ndim(value) else value.item()


class Surface(Protocol):
    """What is drawn of a body: vertices [m], [count, 3], and triangles, counter-clockwise from outside, [count, 3]."""

    @property
    def vertices(self) -> Floats: ...
    @property
    def triangles(self) -> NDArray[np.int64]: ...


def write_hulls(file: Any, hulls: Sequence[Surface]) -> None:
    """Write vertices [m, about the centre of mass] and triangles of hulls, one after the other."""
    file["vertices"] = np.concatenate([hull.vertices for hull in hulls])
    file["vertex_start"] = np.cumsum([0, *(len(hull.vertices) for hull in hulls)])
    file["faces"] = np.concatenate([hull.triangles for hull in hulls])
    file["face_start"] = np.cumsum([0, *(len(hull.triangles) for hull in hulls)])


def read_hulls(file: Any) -> list[ConvexHull]:
    vertices, start = file["vertices"][()], file["vertex_start"][()]
    return [ConvexHull(vertices[a:b]) for a, b in itertools.pairwise(start)]


def boxed_world(
    grains: list[ConvexHull], position: Floats, orientation: Floats, width: tuple[float, float], material: Material,
    gravity: tuple[float, float, float], contact: ContactModel, sides: str = "walls",
    tilted: tuple[float, float, float] | None = None,
) -> World:  # fmt: skip
    """Return a world of grains at rest on a floor, in an open box or repeating after each width, see Bed.

    The floor stops everything, the walls only the grains. Without walls the floor is rough enough to hold the grains on
    a slope. tilted: the gravity [m/s2] that it has to hold them under, where that is not the one they rest under.
    """
    world = contact.world(gravity, width if sides == "periodic" else None)
    numbers = world.add_bodies(grains, material, position, orientation)
    along, aside, out = gravity if tilted is None else tilted
    slope = math.hypot(along, aside) / abs(out) if out != 0.0 else 0.0
    # On level ground the floor keeps the material of the grains, and so their bits; between walls the box holds them.
    holds = sides == "walls" or slope == 0.0
    floor = material if holds else replace(material, friction=max(material.friction, HOLDING * slope), rough=True)
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), floor)
    if sides == "periodic":
        return world
    for axis in (0, 1):
        for sign in (-1.0, 1.0):
            point, normal = np.zeros(3), np.zeros(3)
            point[axis], normal[axis] = 0.5 * sign * width[axis], -sign
            # The lander meets no wall: one that crosses the rim has left the bed, which the judge has to see.
            world.add_plane(tuple(point), tuple(normal), material, bodies=numbers)
    return world
