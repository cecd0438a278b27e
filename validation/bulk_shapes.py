"""Corners of the five Platonic solids, about their centres."""

import itertools

import numpy as np

GOLD = 0.5 * (1.0 + 5.0**0.5)
SIGNS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))


def cyclic(a: float, b: float) -> np.ndarray:
    """Points (0, +-a, +-b) and their cyclic turns."""
    points = [np.roll([0.0, i * a, j * b], k) for i in (-1, 1) for j in (-1, 1) for k in range(3)]
    return np.array(points)


PLATONIC = {
    "tetrahedron": SIGNS[np.prod(SIGNS, axis=1) > 0],
    "cube": SIGNS,
    "octahedron": np.vstack([np.eye(3), -np.eye(3)]),
    "dodecahedron": np.vstack([SIGNS, cyclic(1.0 / GOLD, GOLD)]),
    "icosahedron": cyclic(1.0, GOLD),
}
