"""What a landing follows from, and what it comes to."""

import math
import os
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem import ConvexHull, Material, Shape, Sphere
from lithobrake.files.atomic import atomic_path
from lithobrake.touchdown.bed import Bed, ContactModel, write_hulls
from lithobrake.touchdown.lander import Lander
from lithobrake.vocabulary.array_types import Floats, Vector
from lithobrake.vocabulary.field_errors import FieldError
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import ORIENTATION_OUT, OVER_RIM, SPIN_OUT, describe

LEAVING = (
    "speed_out", "elevation_out", "azimuth_out", "spin_out", "velocity_out_x", "velocity_out_y", "velocity_out_z",
    *SPIN_OUT, *ORIENTATION_OUT, OVER_RIM,
)  # fmt: skip
OUTPUTS = (*LEAVING, "contact_duration", "penetration", "peak_acceleration", "energy_lost")
SPHERE_PICTURE_POINTS = 200


@dataclass(frozen=True, kw_only=True)
class Landing:
    """What a landing follows from, beside the bed and the lander. The frame is the bed's, z out of the mean surface.

    Raises ValueError for values outside their ranges.
    """

    grain: Material
    speed: float  # m/s
    incidence: float  # rad, of the velocity from the inward normal
    azimuth: float  # rad, of the horizontal velocity, from +x toward +y
    place: tuple[float, float]  # m, where the lander's centre of mass starts, along x and y
    orientation: tuple[float, float, float, float]  # w, x, y, z
    spin: Vector  # rad/s, along the world's axes
    gravity: Vector  # m/s2
    time_limit: float  # s, simulated, after the lander was released
    # m: the lander is followed until it rests, or leaves for a hop that rises higher over the ground. None: it is
    # followed until it leaves the ground or is captured.
    hop_height: float | None = None
    rotation: Vector = (0.0, 0.0, 0.0)  # rad/s, of the ground, against which velocity and spin are
    contact: ContactModel = field(default_factory=ContactModel)

    def __post_init__(self) -> None:
        for name, fine, allowed in (
            ("speed", 0.0 < self.speed < math.inf, "is a finite value above 0 m/s"),
            ("incidence", 0.0 <= self.incidence < 0.5 * math.pi, "is 0 <= value < pi/2 rad"),
            ("azimuth", math.isfinite(self.azimuth), "is a finite angle"),
            ("gravity", all(math.isfinite(g) for g in self.gravity), "are three finite numbers"),
            ("rotation", all(math.isfinite(w) for w in self.rotation), "are three finite numbers"),
            ("spin", all(math.isfinite(w) for w in self.spin), "are three finite numbers"),
            ("orientation", 0.0 < math.hypot(*self.orientation) < math.inf, "are four finite numbers, not all zero"),
            ("time_limit", 0.0 < self.time_limit < math.inf, "is a finite value above 0 s"),
            ("hop_height", self.hop_height is None or 0.0 < self.hop_height < math.inf, "is a finite height above 0 m"),
        ):
            if not fine:
                raise FieldError(f"Landing.{name}", getattr(self, name), allowed)

    @property
    def velocity(self) -> Floats:
        """Velocity of the lander at the start [m/s]."""
        horizontal = self.speed * math.sin(self.incidence)
        return np.array(
            [
                horizontal * math.cos(self.azimuth),
                horizontal * math.sin(self.azimuth),
                -self.speed * math.cos(self.incidence),
            ]
        )


@dataclass(frozen=True, eq=False)
class Outcome:
    """How it ended, and its outputs: the keys OUTPUTS (SI); those of LEAVING are NaN unless the lander is clear.

    On ground that repeats there is "periods_travelled" too. orientation: of the lander at the end (w, x, y, z), in the
    bed's frame, however it ended.

    frames holds "time" [s, frame_count], "position" [m, frame_count, body_count, 3], "orientation", and "force", the
    size of the sum of the contact forces on each body [N, frame_count, body_count]; the last body is the lander.
    """

    status: TouchdownOutcome
    outputs: dict[str, float]
    simulated_time: float  # s
    orientation: tuple[float, ...]
    frames: dict[str, Floats] | None = None

    def save_frames(
        self, path: str | os.PathLike[str], bed: Bed, lander: Lander, landing: Landing, **notes: str
    ) -> None:  # fmt: skip
        """Write a recorded landing to an HDF5 file: hulls, the lander last, and where they were; notes: more to say."""
        import h5py

        if self.frames is None:
            raise ValueError("Outcome.save_frames needs a landing that was recorded: give land() a frame_count above 0")
        with atomic_path(path) as draft, h5py.File(draft, "w") as file:
            write_hulls(file, [*bed.grains, picture(lander)])
            for name, values in self.frames.items():
                file[f"frames/{name}"] = values
            file["position"], file["orientation"] = self.frames["position"][-1], self.frames["orientation"][-1]
            file["diameter"] = bed.diameter
            describe(file)
            file.attrs["format"], file.attrs["format_version"] = "lithobrake landing", 1
            file.attrs["status"], file.attrs["width"], file.attrs["sides"] = self.status.value, bed.width, bed.sides
            file.attrs["speed"], file.attrs["incidence"] = landing.speed, landing.incidence
            file.attrs.update(notes)


def outgoing(
    velocity: Floats, spin: Floats, orientation: Floats, azimuth: float, *, over_rim: bool
) -> dict[str, float]:
    """Return how the lander leaves, in the local frame: x along the incoming horizontal velocity, z out of the surface.

    velocity [m/s], spin [rad/s], orientation (w, x, y, z): in the frame of the bed, in which `azimuth` [rad] is that of
    the incoming velocity.
    """
    x, y, z = turned(velocity, -azimuth)
    horizontal = math.hypot(x, y)
    values = (
        math.hypot(horizontal, z), math.atan2(z, horizontal), math.atan2(y, x), float(np.linalg.norm(spin)), x, y, z,
        *turned(spin, -azimuth), *turned_attitude(orientation, -azimuth), float(over_rim),
    )  # fmt: skip
    return dict(zip(LEAVING, (float(value) for value in values), strict=True))


def turned(vector: Floats, angle: float) -> tuple[float, float, float]:
    """Return a vector turned about z by an angle [rad]."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * vector[0] - sine * vector[1], cosine * vector[1] + sine * vector[0], float(vector[2])


def turned_attitude(orientation: Floats, angle: float) -> tuple[float, float, float, float]:
    """Return a unit quaternion turned about z by an angle [rad]; of the two of that attitude the one with w >= 0."""
    cosine, sine = math.cos(0.5 * angle), math.sin(0.5 * angle)
    w, x, y, z = orientation
    found = (cosine * w - sine * z, cosine * x - sine * y, cosine * y + sine * x, cosine * z + sine * w)
    sign = -1.0 if found[0] < 0.0 else 1.0
    return sign * found[0], sign * found[1], sign * found[2], sign * found[3]


class Mesh(NamedTuple):
    """Surfaces of convex parts, one after the other."""

    vertices: Floats  # m, [vertex_count, 3]
    triangles: NDArray[np.int64]  # [triangle_count, 3], counter-clockwise from outside


def picture(lander: Lander) -> Mesh:
    """Return the surfaces of all parts of a lander, about its centre of mass."""
    hulls = [hull_about_centroid(part.shape) for part in lander.body.parts]
    vertices = [hull.vertices + np.array(part.offset) for hull, part in zip(hulls, lander.body.parts, strict=True)]
    starts = np.cumsum([0, *(len(hull.vertices) for hull in hulls)])
    triangles = [hull.triangles + start for hull, start in zip(hulls, starts[:-1], strict=True)]
    return Mesh(np.concatenate(vertices), np.concatenate(triangles))


def hull_about_centroid(shape: Shape) -> ConvexHull:
    if isinstance(shape, ConvexHull):
        return ConvexHull(shape.vertices - shape.centroid)
    assert isinstance(shape, Sphere)
    # Points of a golden spiral: even on the sphere, the same each time.
    k = np.arange(SPHERE_PICTURE_POINTS) + 0.5
    polar, turn = np.arccos(1.0 - 2.0 * k / SPHERE_PICTURE_POINTS), math.pi * (1.0 + math.sqrt(5.0)) * k
    points = np.stack([np.cos(turn) * np.sin(polar), np.sin(turn) * np.sin(polar), np.cos(polar)], axis=1)
    return ConvexHull(shape.radius * points)
