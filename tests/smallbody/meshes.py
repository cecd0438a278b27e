"""Meshes that several tests of small bodies use."""

import numpy as np

CUBE_FACES = np.array(
    [
        *([0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4]),
        *([1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]),
    ]
)


def cube_vertices(edge: float = 1.0) -> np.ndarray:
    """Corners of a cube around the origin [m]."""
    half = 0.5 * edge
    lower = [[-half, -half], [half, -half], [half, half], [-half, half]]
    return np.array([[x, y, z] for z in (-half, half) for x, y in lower])


def sphere_mesh(frequency: int) -> tuple[np.ndarray, np.ndarray]:
    """Unit directions and facets of an octahedron whose faces are cut into frequency**2 triangles."""
    corners = np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float)
    octants = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]]
    places: dict[tuple[float, ...], int] = {}
    faces = []
    for a, b, c in octants:
        index = {}
        for i in range(frequency + 1):
            for j in range(frequency + 1 - i):
                p = corners[a] * (frequency - i - j) + corners[b] * i + corners[c] * j
                index[i, j] = places.setdefault(tuple(p + 0.0), len(places))
        for i in range(frequency):
            for j in range(frequency - i):
                faces.append([index[i, j], index[i + 1, j], index[i, j + 1]])
                if i + j < frequency - 1:
                    faces.append([index[i + 1, j], index[i + 1, j + 1], index[i, j + 1]])
    points = np.array(list(places))
    return points / np.linalg.norm(points, axis=1)[:, None], np.array(faces)
