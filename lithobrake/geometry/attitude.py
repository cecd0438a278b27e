"""Attitudes, as unit quaternions w, x, y, z that turn a body into place: by chance, multiplied, and as matrices."""

import math

import numpy as np


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
