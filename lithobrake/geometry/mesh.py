"""What makes a list of triangles the closed surface of one body, what that body weighs, and where its inside is."""

import warnings

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, connected_components

from lithobrake.vocabulary.extra_library import extra_library

Vertices = NDArray[np.float64]
Faces = NDArray[np.int64]

# Height of a triangle over its longest edge, below which it has no usable normal; of a body, over its extent.
FLATTEST = 1e-10
# A triple product is known to this part of the lengths that it is made of.
ROUNDING = 16.0 * 2.0**-52


def closed_faces(vertices: Vertices, faces: Faces, where: str) -> Faces:
    """Faces of a closed surface, all counter-clockwise seen from outside; a wrong orientation is mended with a warning.

    vertices [m], shape [vertex_count, 3]; faces: vertex indices, shape [facet_count, 3]; `where` names the mesh in
    errors. Raises ValueError for a mesh that is degenerate, open, non-manifold, in several pieces, or has no volume.
    """
    refuse_malformed(vertices, faces, where)
    _refuse_degenerate(vertices, faces, where)
    edges, owner = _edges(faces)
    neighbours = _refuse_open(edges, owner, faces, where)
    _refuse_pieces(neighbours, where)
    faces, turned = _agree(faces, neighbours)
    _refuse_pinched(faces, where)
    volume, extent = volume_of(vertices, faces), float(np.ptp(vertices[faces].reshape(-1, 3), axis=0).max())
    if not abs(volume) > FLATTEST * extent**3:
        raise ValueError(f"{where}: flat, it encloses {volume:g} m3 over {extent:g} m; give a body with a volume.")
    if volume < 0.0:
        faces, turned = faces[:, ::-1].copy(), len(faces) - turned
    if turned:
        kind = "all facets" if turned == len(faces) else f"{turned} of {len(faces)} facets"
        warnings.warn(f"{where}: {kind} faced inwards and were turned to face outwards.", stacklevel=3)
    return faces


def volume_of(vertices: Vertices, faces: Faces) -> float:
    """Volume inside a closed surface [m3], negative where its facets face inwards."""
    # A vertex that no facet uses may lie so far off that nothing is left of the digits.
    corner = vertices[faces] - vertices[np.unique(faces)].mean(axis=0)
    return float(np.einsum("fi,fi->", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])) / 6.0)


def mass_properties(vertices: Vertices, faces: Faces) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
    """Volume [m3], centroid [m] and inertia per density about the centroid [m5], shape [3, 3].

    Tetrahedra from the mean of the vertices. Source: [Tonon-2004], in its covariance form.
    """
    base = vertices.mean(axis=0)
    corner = vertices[faces] - base
    six = np.einsum("fi,fi->f", corner[:, 0], np.cross(corner[:, 1], corner[:, 2]))
    volume = six.sum() / 6.0
    total = corner.sum(axis=1)
    centroid = (six[:, None] * total).sum(axis=0) / 24.0 / volume
    products = np.einsum("f,fci,fcj->ij", six, corner, corner) + np.einsum("f,fi,fj->ij", six, total, total)
    covariance = products / 120.0 - volume * np.outer(centroid, centroid)
    inertia = np.trace(covariance) * np.eye(3) - covariance
    return float(volume), centroid + base, 0.5 * (inertia + inertia.T)


def holds_origin(vertices: Vertices, faces: Faces) -> bool:
    """Tell whether a closed surface goes round the origin, not through it: whether it fills the sky seen from there.

    Source: [Van-Oosterom-1983].
    """
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    length_a, length_b, length_c = (np.linalg.norm(corner, axis=1) for corner in (a, b, c))
    triple = np.einsum("fi,fi->f", a, np.cross(b, c))
    base = length_a * length_b * length_c
    base += (a * b).sum(axis=1) * length_c + (b * c).sum(axis=1) * length_a + (c * a).sum(axis=1) * length_b
    # A facet through the origin fills no part of the sky; rounding leaves it some height over its plane.
    through = np.abs(triple) <= ROUNDING * length_a * length_b * length_c
    filled = np.where(through, 0.0, 2.0 * np.arctan2(triple, base))
    return bool(abs(filled.sum()) > 3.0 * np.pi)


def refuse_malformed(vertices: Vertices, faces: Faces, where: str) -> None:
    """Raise ValueError unless these are 4 or more triangles between finite vertices; arguments as of closed_faces."""
    if vertices.ndim != 2 or vertices.shape[1] != 3 or faces.ndim != 2 or faces.shape[1] != 3:
        raise ValueError(
            f"{where}: vertices have shape {vertices.shape} and faces {faces.shape}; give [count, 3] for both."
        )
    if len(faces) < 4:
        raise ValueError(f"{where}: {len(faces)} facets cannot enclose a volume; a closed mesh has 4 or more.")
    if not np.isfinite(vertices).all():
        vertex = int(np.flatnonzero(~np.isfinite(vertices).all(axis=1))[0])
        raise ValueError(f"{where}: vertex {vertex + 1} is {vertices[vertex]}; every coordinate must be finite.")
    wrong = (faces < 0) | (faces >= len(vertices))
    if wrong.any():
        facet = int(np.flatnonzero(wrong.any(axis=1))[0])
        raise ValueError(
            f"{where}: facet {facet + 1} names vertices {(faces[facet] + 1).tolist()}; there are 1 to {len(vertices)}."
        )


def _refuse_degenerate(vertices: Vertices, faces: Faces, where: str) -> None:
    corner = vertices[faces]
    sides = corner[:, [1, 2, 0]] - corner
    longest = np.linalg.norm(sides, axis=2).max(axis=1)
    doubled = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    flat = np.flatnonzero(doubled <= FLATTEST * longest**2)
    if len(flat):
        raise ValueError(
            f"{where}: degenerate, {len(flat)} of {len(faces)} facets have no area, the first is facet {flat[0] + 1} "
            f"(vertices {(faces[flat[0]] + 1).tolist()}); remove them or merge their vertices."
        )


def _edges(faces: Faces) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The three edges of each facet with their ends in rising order, and the facet that each belongs to."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.sort(edges, axis=1), np.tile(np.arange(len(faces)), 3)


def _refuse_open(edges: Faces, owner: NDArray[np.int64], faces: Faces, where: str) -> NDArray[np.int64]:
    """Pairs of facets that share an edge, shape [edge_count, 2]; raises unless each edge has exactly two."""
    order = np.lexsort(edges.T[::-1])
    ends, starts, counts = np.unique(edges[order], axis=0, return_index=True, return_counts=True)
    if (counts == 1).any():
        first = (ends[counts == 1][0] + 1).tolist()
        raise ValueError(
            f"{where}: open, {int((counts == 1).sum())} edges belong to one facet only, the first joins "
            f"vertices {first}; "
            "close the mesh and merge vertices that coincide."
        )
    if (counts > 2).any():
        first = (ends[counts > 2][0] + 1).tolist()
        raise ValueError(
            f"{where}: non-manifold, {int((counts > 2).sum())} edges belong to more than two facets, the first joins "
            f"vertices {first}; an edge of a closed surface belongs to exactly two."
        )
    pairs = owner[order][starts[:, None] + np.arange(2)]
    if len(np.unique(np.sort(faces, axis=1), axis=0)) < len(faces):
        raise ValueError(f"{where}: non-manifold, a facet is given twice; remove the copy.")
    return pairs


def _refuse_pieces(pairs: NDArray[np.int64], where: str) -> None:
    pieces, _ = connected_components(_graph(pairs), directed=False)
    if pieces > 1:
        raise ValueError(f"{where}: {pieces} separate closed pieces; a shape is one closed surface, keep one of them.")


def _graph(pairs: NDArray[np.int64]) -> coo_array:
    size = int(pairs.max()) + 1
    return coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(size, size))


def _agree(faces: Faces, pairs: NDArray[np.int64]) -> tuple[Faces, int]:
    """Turn facets until neighbours run along their common edge in opposite directions; gives how many were turned.

    Raises ValueError where that is impossible, on a surface with one side.
    """

    def same_way(mesh: Faces) -> NDArray[np.bool_]:
        first, second = mesh[pairs[:, 0]], mesh[pairs[:, 1]]
        ahead = np.stack([first, first[:, [1, 2, 0]]], axis=2)[:, :, None, :]
        other = np.stack([second, second[:, [1, 2, 0]]], axis=2)[:, None, :, :]
        result: NDArray[np.bool_] = (ahead == other).all(axis=3).any(axis=(1, 2))
        return result

    clash = same_way(faces)
    if not clash.any():
        return faces, 0
    order, parent = breadth_first_order(_graph(pairs).tocsr(), 0, directed=False)
    differs = {frozenset(pair): bool(c) for pair, c in zip(pairs.tolist(), clash.tolist(), strict=True)}
    turn = np.zeros(len(faces), dtype=bool)
    for facet in order[1:]:
        turn[facet] = turn[parent[facet]] ^ differs[frozenset((int(facet), int(parent[facet])))]
    faces = np.where(turn[:, None], faces[:, ::-1], faces)
    if same_way(faces).any():
        raise ValueError("non-manifold: the mesh has one side only, no orientation of its facets agrees.")
    return faces, int(turn.sum())


def _refuse_pinched(faces: Faces, where: str) -> None:
    """Raise where two parts of the surface touch in one vertex: its facets then form more than one fan."""
    count = len(faces)
    # A corner's facet is joined to the next around the vertex: out along one edge of it, in along another.
    out = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    into = np.concatenate([faces[:, [0, 2]], faces[:, [1, 0]], faces[:, [2, 1]]])
    size = int(faces.max()) + 1
    order_out, order_in = np.argsort(out @ [size, 1]), np.argsort(into @ [size, 1])
    graph = coo_array((np.ones(3 * count), (order_out, order_in)), shape=(3 * count, 3 * count))
    fans, _ = connected_components(graph, directed=False)
    if fans > len(np.unique(faces)):
        raise ValueError(f"{where}: non-manifold, parts of the surface touch in a single vertex; separate them.")


def thinned(vertices: Vertices, faces: Faces, facet_count: int) -> tuple[Vertices, Faces]:
    """Vertices [m] and facets, facet_count or a few more, of the same volume and centroid, for gravity.

    Edges whose ends move the surface least are drawn together, one after the other. Source: [Garland-1997]
    Raises ImportError, with how to install it, where the package that does so is absent.
    """
    simplification = extra_library("fast_simplification", "fast-simplification, which thins a mesh,", "thin")
    # It takes arrays that it may write to, and corners of 32 bits.
    fewer, corners = simplification.simplify(
        np.array(vertices, order="C"), np.array(faces, dtype=np.int32, order="C"), target_count=facet_count
    )
    found, index = np.array(fewer, dtype=np.float64), np.array(corners, dtype=np.int64)
    volume, centroid, _ = mass_properties(vertices, faces)
    lost, moved, _ = mass_properties(found, index)
    return (found - moved) * (volume / lost) ** (1.0 / 3.0) + centroid, index
