"""Attitudes as unit quaternions w, x, y, z, the frames that they lead to, and angles between places on a ball."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from lithobrake.geometry.bed_limits import alike
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.quantities import IMPACT_AZIMUTH, ORIENTATION, ORIENTATION_OUT, SPIN, SPIN_OUT

UPRIGHT, LEAN, ALONG, FACING, HEADING = "upright", "lean", "along", "facing", "heading"
# The smallest and the largest value of each term.
RANGES = {UPRIGHT: (0.0, 1.0), LEAN: (-1.0, 1.0), ALONG: (-1.0, 1.0), FACING: (-1.0, 1.0), HEADING: (-1.0, 1.0)}
CUBE_RANGES = {UPRIGHT: (1.0 / 3.0, 1.0), LEAN: (-0.3, 0.3), ALONG: (-0.5, 0.5)}
# A law whose terms vary by less than this, squared, has no such term.
LEAST_VARIANCE = 1e-9


def uniform_attitude(first: float, second: float, third: float) -> np.ndarray:
    """Return the attitude of three uniform numbers; even numbers give attitudes that are even over all rotations.

    Source: [Shoemake-1992].
    """
    near, far = math.sqrt(1.0 - first), math.sqrt(first)
    one, other = 2.0 * math.pi * second, 2.0 * math.pi * third
    return np.array([far * math.cos(other), near * math.sin(one), near * math.cos(one), far * math.sin(other)])


def pointed(orientation: np.ndarray, half_angle: float, distance: float, direction: float) -> np.ndarray:
    """Return an attitude whose z axis points elsewhere within a cone about where it should, by two uniform numbers.

    half_angle: of the cone [rad]. Even numbers give directions that are even over the cap that the cone cuts out of the
    sphere. The body turns there about an axis across its z axis, so that a closing cone leaves the attitude as it is:
    who holds an axis to within degrees holds the roll about it, too.
    """
    cosine = 1.0 - distance * (1.0 - math.cos(half_angle))
    turn = 2.0 * math.pi * direction
    half = math.sqrt(0.5 * (1.0 - cosine))
    w, x, y, z = orientation / np.linalg.norm(orientation)
    # Of the body, so it is taken first: the product of the attitude and the error.
    a, b, c = math.sqrt(0.5 * (1.0 + cosine)), half * math.cos(turn), half * math.sin(turn)
    return np.array([w * a - x * b - y * c, w * b + x * a - z * c, w * c + y * a + z * b, x * c - y * b + z * a])


def rotation_matrices(quaternions: np.ndarray) -> np.ndarray:
    """Rotation matrices, shape [count, 3, 3], of unit quaternions (w, x, y, z), shape [count, 4]."""
    w, x, y, z = quaternions.T / np.linalg.norm(quaternions, axis=1)
    return np.stack(
        [
            np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], axis=-1),
            np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], axis=-1),
            np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=-1),
        ],
        axis=1,
    )


def quaternion_products(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Hamilton's products of quaternions w, x, y, z, [count, 4]: the second turn, then the first."""
    w, v, s, u = first[:, :1], first[:, 1:], second[:, :1], second[:, 1:]
    scalar = w * s - np.sum(v * u, axis=1, keepdims=True)
    return np.concatenate([scalar, w * u + s * v + np.cross(v, u)], axis=1)


@dataclass(frozen=True)
class AttitudeTerms:
    """The terms of a lander's attitude.

    axes: [axis_count, 3], fixed to the lander, names: one letter or number for each. has_sides: whether the two ends
    of an axis differ, as those of a mesh may. is_cube: the terms are sums over three axes that are alike, of fourth
    degree.
    """

    axes: Array
    names: tuple[str, ...]
    has_sides: bool = False
    is_cube: bool = False

    @classmethod
    def of_box(cls, edges: Array, inertia: Array | None = None) -> "AttitudeTerms":
        """Those of a box of these edges [3], with moments of inertia [3] about its axes where it is not homogeneous."""
        pairs = [edges] if inertia is None else [edges, inertia]
        paired = [axis for axis in range(3) if all(alike(one[axis - 2], one[axis - 1]) for one in pairs)]
        if len(paired) == 3:
            return cls(np.eye(3), ("x", "y", "z"), is_cube=True)
        # A prism has one axis of its own; of any other box the terms of the third axis follow from those of two.
        chosen = paired or [int(np.argmax(edges)), int(np.argmin(edges))]
        return cls(np.eye(3)[chosen], tuple("xyz"[axis] for axis in chosen))

    @classmethod
    def of_body(cls, inertia: Array) -> "AttitudeTerms":
        """Those of a body without symmetry, about its principal axes; inertia: [3, 3]."""
        axes = np.linalg.eigh(inertia)[1].T
        # Which way an axis points is of no consequence, but should not change from machine to machine.
        largest = np.take_along_axis(axes, np.abs(axes).argmax(axis=1)[:, None], axis=1)
        return cls(axes * np.sign(largest), ("1", "2", "3"), has_sides=True)

    @cached_property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """Smallest and largest value of each term, by its name."""
        if self.is_cube:
            return dict(CUBE_RANGES)
        upright = self.names[: 2 if self.has_sides else None]
        found = {f"{term}_{name}": RANGES[term] for name in upright for term in (UPRIGHT, LEAN, ALONG)}
        sides = self.names if self.has_sides else ()
        return found | {f"{term}_{name}": RANGES[term] for term in (FACING, HEADING) for name in sides}

    def at(self, normal: Array, travel: Array) -> Array:
        """The terms [count, term_count] of normals and directions of travel [count, 3], seen from the lander."""
        n, t, b = (way @ self.axes.T for way in (normal, travel, np.cross(normal, travel)))
        if self.is_cube:
            fourth = (n**4, n**3 * t, n**2 * (t**2 - b**2))
            return np.column_stack([one.sum(axis=1) for one in fourth])
        second = [(n[:, k] ** 2, 2.0 * n[:, k] * t[:, k], t[:, k] ** 2 - b[:, k] ** 2) for k in range(len(self.names))]
        if not self.has_sides:
            return np.column_stack([one for three in second for one in three])
        return np.column_stack([*(one for three in second[:2] for one in three), n, t])

    @cached_property
    def uniform_law(self) -> tuple[Array, Array]:
        """Mean [term_count] and covariance [term_count, term_count] over attitudes that are uniform over rotations.

        By a product rule that is exact for them: products of two terms are of eighth degree.
        """
        # Six Gauss nodes are exact up to degree 11 along the axis, twelve turns for waves up to the eleventh.
        nodes, weights = np.polynomial.legendre.leggauss(6)
        turns = np.arange(12) * (2.0 * np.pi / 12)
        cosine, turn, roll = (one.ravel() for one in np.meshgrid(nodes, turns, turns, indexing="ij"))
        sine = np.sqrt(1.0 - cosine**2)
        normal = np.column_stack([sine * np.cos(turn), sine * np.sin(turn), cosine])
        east = np.column_stack([-np.sin(turn), np.cos(turn), np.zeros(len(turn))])
        travel = np.cos(roll)[:, None] * east + np.sin(roll)[:, None] * np.cross(normal, east)
        weight = np.repeat(weights, 144) / (2.0 * 144)
        terms = self.at(normal, travel)
        mean = weight @ terms
        return mean, (terms - mean).T * weight @ (terms - mean)


def seen_from_lander(orientation: Array, azimuth: Array) -> tuple[Array, Array]:
    """Normal of the ground and direction of travel, both [count, 3], seen from the lander.

    orientation: quaternions w, x, y, z [count, 4] that turn the lander into the bed, whose normal is z; azimuth: of the
    travel in the bed [rad], [count].
    """
    into_bed = rotation_matrices(orientation)
    travel = np.cos(azimuth)[:, None] * into_bed[:, 0] + np.sin(azimuth)[:, None] * into_bed[:, 1]
    return into_bed[:, 2], travel


def orthonormal(terms: Array, law: tuple[Array, Array]) -> Array:
    """Combinations of terms [count, term_count] with mean 0, variance 1 and no correlation over a law.

    law: mean and covariance. What does not vary under it drops out, so there may be fewer than terms, or none.
    """
    mean, covariance = law
    variances, ways = np.linalg.eigh(covariance)
    varies = variances > LEAST_VARIANCE
    found: Array = (terms - mean) @ ways[:, varies] / np.sqrt(variances[varies])
    return found


def axes_in_icrf(pole_right_ascension_deg: float, pole_declination_deg: float, meridian: ArrayLike) -> np.ndarray:
    """The body's axes x, y, z along ICRF in rows, [..., 3, 3]: they turn components along ICRF into body-fixed ones.

    meridian: angle W of longitude 0 [rad], [...], from the node of the body's equator on that of ICRF, eastward.
    Source: [Archinal-2018], Fig 1.
    """
    right_ascension, declination = np.radians(pole_right_ascension_deg), np.radians(pole_declination_deg)
    node = np.array([-np.sin(right_ascension), np.cos(right_ascension), 0.0])
    pole = np.array(
        [
            np.cos(declination) * np.cos(right_ascension),
            np.cos(declination) * np.sin(right_ascension),
            np.sin(declination),
        ]
    )
    ahead = np.cross(pole, node)
    angle = np.asarray(meridian, dtype=np.float64)[..., None]
    x = np.cos(angle) * node + np.sin(angle) * ahead
    y = np.cos(angle) * ahead - np.sin(angle) * node
    return np.stack([x, y, np.broadcast_to(pole, x.shape)], axis=-2)


def attitude_of(outputs: Mapping[str, float], names: tuple[str, ...] = ORIENTATION_OUT) -> Rotation:
    """The attitude at the end of a touchdown, in its frame; none told: unturned."""
    w, x, y, z = (outputs.get(name, default) for name, default in zip(names, (1.0, 0.0, 0.0, 0.0), strict=True))
    return Rotation.from_quat([x, y, z, w])


def spin_of(outputs: Mapping[str, float]) -> np.ndarray:
    """The spin at the end of a touchdown [rad/s], in its frame, against the ground; none told: none."""
    return np.array([outputs.get(name, 0.0) for name in SPIN_OUT])


def quaternion(attitude: Rotation) -> tuple[float, float, float, float]:
    """An attitude as w, x, y, z."""
    # Of the two quaternions of an attitude the one with w >= 0, so that equal attitudes are equal numbers.
    x, y, z, w = attitude.as_quat(canonical=True).tolist()
    return w, x, y, z


def from_frame(axes: np.ndarray) -> Rotation:
    """The rotation that turns vectors of a frame with these axes in rows [3, 3] into those of the body."""
    return Rotation.from_matrix(axes.T)


def arriving(inputs: Mapping[str, float], axes: np.ndarray) -> tuple[Rotation, np.ndarray]:
    """Attitude of a lander as a touchdown begins, and its spin against the ground [rad/s], both fixed to the body.

    inputs: of the touchdown, in the frame of its bed; axes: of the touchdown in rows, [3, 3], body-fixed.
    """
    out_of_bed = from_frame(axes) * about_z(-math.radians(inputs[IMPACT_AZIMUTH]))
    return out_of_bed * attitude_of(inputs, ORIENTATION), out_of_bed.apply([inputs[name] for name in SPIN])


def about_z(angle: float) -> Rotation:
    """A rotation about z by an angle [rad]."""
    return Rotation.from_quat([0.0, 0.0, math.sin(0.5 * angle), math.cos(0.5 * angle)])


def directions(latitude_deg: ArrayLike, longitude_deg: ArrayLike) -> np.ndarray:
    """Unit vectors [..., 3] of planetocentric latitudes and east longitudes [deg], both [...]."""
    latitude, longitude = np.radians(latitude_deg), np.radians(longitude_deg)
    level = np.cos(latitude)
    return np.stack([level * np.cos(longitude), level * np.sin(longitude), np.sin(latitude)], axis=-1)


def angles(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Angles [rad], [...], between directions [..., 3]."""
    # The arctangent keeps the small angles that the arccosine loses.
    between: np.ndarray = np.arctan2(np.linalg.norm(np.cross(one, other), axis=-1), (one * other).sum(axis=-1))
    return between
