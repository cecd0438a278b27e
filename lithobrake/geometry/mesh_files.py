"""Reading triangles from mesh files, with the unit that a header or a label states."""

import os
import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lithobrake.files.file_kinds import FileKind, file_kind
from lithobrake.geometry.mesh_units import UNITS, mesh_unit

Mesh = tuple[NDArray[np.float64], NDArray[np.int64]]
# Of an area that is none but for the digits of its corners.
ROUNDING = 1e-9


def read_mesh(path: str | os.PathLike[str], unit: str | None = None) -> Mesh:
    """Vertices [m], shape [vertex_count, 3], and faces, shape [facet_count, 3], of a file whose ending READERS has.

    unit: of its lengths; absent: what its header or label says, else m. Raises ValueError as mesh_unit does, and for a
    file of another kind, an unknown ending, and a line or length that is not of the format.
    """
    path = Path(path)
    if not path.is_file():
        raise ValueError(f"{path}: no such file.")
    ending = path.suffix.lower()
    _refuse_kind(path, ending)
    if ending not in READERS:
        raise ValueError(f"{path}: the ending {path.suffix!r} is not read; convert to one of {', '.join(READERS)}.")
    length = UNITS[mesh_unit(path, unit)]
    vertices, faces = READERS[ending](path)
    return vertices * length, faces


def _refuse_kind(path: Path, ending: str) -> None:
    """Raise ValueError for a file whose content is not what its ending stands for."""
    kind = file_kind(path)
    endings = ENDINGS.get(kind, ()) if kind else READERS
    if kind and not endings:
        raise ValueError(
            f"{path} is {kind}; meshes are read from OBJ, STL, PDS plates, ICQ and shape kernels: convert."
        )
    if kind and ending not in endings:
        raise ValueError(f"{path} is {kind}, which its ending does not say; allowed: {', '.join(endings)}; rename it.")


def _read_obj(path: Path) -> Mesh:
    """Wavefront OBJ: `v` and `f` lines; a polygon is cut into a fan of triangles from its first corner."""
    vertices: list[list[float]] = []
    faces: list[list[int]] = []
    polygons: list[tuple[int, list[int]]] = []
    for number, line in enumerate(path.read_text(encoding="utf-8-sig", errors="replace").splitlines(), 1):
        words = line.split()
        if not words or words[0].lower() not in ("v", "f"):
            continue
        try:
            if words[0].lower() == "v":
                vertices.append([float(word) for word in words[1:4]])
                continue
            given = np.array([int(word.split("/")[0]) for word in words[1:]], dtype=np.int64).tolist()
        except (ValueError, OverflowError) as error:
            raise ValueError(f"{path}: line {number}, {line.strip()!r} is not a vertex or a facet.") from error
        # Negative numbers count back from the newest vertex; zero names none and is refused with the others later.
        corners = [len(vertices) + corner if corner < 0 else corner - 1 for corner in given]
        if len(corners) < 3:
            raise ValueError(f"{path}: line {number}, {line.strip()!r} has fewer than three corners.")
        if len(corners) > 3:
            polygons.append((number, corners))
        faces += [[corners[0], corners[i], corners[i + 1]] for i in range(1, len(corners) - 1)]
    if any(len(vertex) != 3 for vertex in vertices):
        raise ValueError(f"{path}: a vertex has fewer than three coordinates.")
    found, triangles = np.array(vertices, dtype=np.float64).reshape(-1, 3), _triangles(faces)
    _refuse_counted_from_0(path, triangles, len(found))
    _refuse_folded(path, found, polygons)
    return found, triangles


def _triangles(faces: list[list[int]]) -> NDArray[np.int64]:
    return np.array(faces, dtype=np.int64).reshape(-1, 3)


def _refuse_counted_from_0(path: Path, faces: NDArray[np.int64], count: int) -> None:
    """Raise ValueError for facets, made to count from 0, that did so before."""
    if len(faces) and faces.min() == -1 and faces.max() < count - 1:
        raise ValueError(
            f"{path}: its facets count from 0, to {faces.max() + 1} of {count} vertices; allowed: from 1; add 1 to "
            "each of their numbers."
        )


def _refuse_folded(path: Path, vertices: NDArray[np.float64], polygons: list[tuple[int, list[int]]]) -> None:
    """Raise ValueError for a polygon of which a fan of triangles would not cover just the inside.

    polygons: line and corners of each. One triangle that faces the other way than the polygon lies outside of it.
    """
    for number, corners in polygons:
        if not 0 <= min(corners) <= max(corners) < len(vertices):
            continue
        ways = vertices[corners[1:]] - vertices[corners[0]]
        doubled = np.cross(ways[:-1], ways[1:])
        along = doubled @ doubled.sum(axis=0)
        if along.min() < -ROUNDING * np.abs(along).max():
            raise ValueError(
                f"{path}: line {number} has a facet of {len(corners)} corners that is not convex; allowed: convex "
                "facets, which are cut into triangles from their first corner; cut it into triangles."
            )


def _read_stl(path: Path) -> Mesh:
    """STL, binary or text. Corners with the same coordinates become one vertex."""
    data = path.read_bytes()
    corners = _stl_binary(data)
    if corners is None:
        corners = _stl_text(path, data)
    if not len(corners):
        raise ValueError(
            f"{path}: has no facets: neither 'vertex' lines of a text STL nor the length of a binary one; export anew."
        )
    # Adding 0.0 turns -0.0 into 0.0, which would else be two coordinates.
    vertices, index = np.unique(corners.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
    return vertices, index.reshape(-1, 3).astype(np.int64)


def _stl_binary(data: bytes) -> NDArray[np.float64] | None:
    """Corners, shape [facet_count, 3, 3], or None where the length does not fit the count in the header."""
    if len(data) < 84:
        return None
    (count,) = struct.unpack_from("<I", data, 80)
    if len(data) != 84 + 50 * count:
        return None
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    facets = np.frombuffer(data, dtype=record, offset=84)
    return np.asarray(facets["corners"], dtype=np.float64)


def _stl_text(path: Path, data: bytes) -> NDArray[np.float64]:
    words = data.decode("ascii", errors="replace").split()
    if not words or words[0] != "solid":
        raise ValueError(f"{path}: neither a text STL (starts with 'solid') nor a binary one of the length it states.")
    places = [i for i, word in enumerate(words) if word == "vertex"]
    try:
        values = [[float(word) for word in words[i + 1 : i + 4]] for i in places]
        return np.array(values, dtype=np.float64).reshape(-1, 3, 3)
    except ValueError as error:
        raise ValueError(f"{path}: its 'vertex' lines do not come in threes of three numbers.") from error


def _read_plates(path: Path) -> Mesh:
    """Plate model of the Planetary Data System, in either of its two layouts, or quadrilaterals (_quadrilaterals).

    One has lines `v x y z` and `f i j k` as OBJ has. The other has the number of vertices (perhaps also of plates) on
    its first line, then a line a vertex, the number of plates if it was not given, and a line a plate with vertices
    counted from 1; each of these lines may begin with its own number, by which they are then ordered.
    """
    rows = [
        line.replace(",", " ").split() for line in path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    ]
    rows = [row for row in rows if row]
    rows = [row for row in rows if not row[0].startswith("#")]
    if rows and rows[0][0].lower() == "v":
        return _read_obj(path)
    if rows and len(rows[0]) == 1 and rows[0][0].isdecimal() and len(rows) == 6 * (int(rows[0][0]) + 1) ** 2 + 1:
        return _quadrilaterals(path, int(rows[0][0]), rows[1:])
    layout = "give the number of vertices, a line a vertex, the number of plates, a line a plate"
    try:
        counts = [int(word) for word in rows[0]]
        vertices = np.array(_in_order(rows[1 : counts[0] + 1], "vertices"), dtype=np.float64)
        next_row = counts[0] + 1
        if len(counts) == 1:
            counts.append(int(rows[next_row][0]))
            next_row += 1
        plates = np.array(_in_order(rows[next_row : next_row + counts[1]], "plates"), dtype=np.int64) - 1
    except IndexError as error:
        raise ValueError(f"{path}: not a plate model, it ends after {len(rows)} lines; {layout}.") from error
    except (ValueError, OverflowError) as error:
        raise ValueError(f"{path}: not a plate model, {error}; {layout}.") from error
    if (len(vertices), len(plates)) != tuple(counts[:2]) or len(rows) != next_row + counts[1]:
        raise ValueError(f"{path}: {len(rows)} lines do not fit {counts[0]} vertices and {counts[1]} plates.")
    _refuse_counted_from_0(path, plates.reshape(-1, 3), len(vertices))
    return vertices.reshape(-1, 3), plates.reshape(-1, 3)


def _in_order(rows: list[list[str]], what: str) -> list[list[str]]:
    """The last three entries of rows, by the numbers from 1 on that all of them begin with, or none.

    Raises ValueError for rows of other lengths, and numbers of which one is missing or there twice.
    """
    lengths = {len(row) for row in rows}
    if lengths != {4}:
        if lengths - {3}:
            raise ValueError(f"lines of {what} have {', '.join(map(str, sorted(lengths)))} entries, not 3, or 4 each")
        return rows
    numbered = {int(row[0]): row[1:] for row in rows}
    lacking = next((number for number in range(1, len(rows) + 1) if number not in numbered), None)
    if lacking is not None:
        raise ValueError(
            f"the {len(rows)} lines of {what} are not numbered from 1 to {len(rows)}: {lacking} is missing"
        )
    return [numbered[number] for number in range(1, len(rows) + 1)]


def _quadrilaterals(path: Path, size: int, rows: list[list[str]]) -> Mesh:
    """Implicitly connected quadrilaterals: six faces of a cube, each a grid of (size + 1)**2 vertices.

    Vertex I of row J of a face comes after I - 1 of the same row; a facet has the corners (I, J), (I, J + 1),
    (I + 1, J + 1), (I + 1, J), counter-clockwise from outside. Faces share the vertices of their edges.
    Source: [Gaskell-2008]
    """
    try:
        grid = np.array(rows, dtype=np.float64).reshape(6, size + 1, size + 1, 3)
    except ValueError as error:
        raise ValueError(f"{path}: not {6 * (size + 1) ** 2} vertices of three numbers each ({error}).") from error
    vertices, index = np.unique(grid.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
    corner = index.reshape(6, size + 1, size + 1).astype(np.int64)
    a, b, c, d = corner[:, :-1, :-1], corner[:, 1:, :-1], corner[:, 1:, 1:], corner[:, :-1, 1:]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    # The last plates of some models have shrunk to a line, where two of their corners are one vertex.
    return vertices, faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]


def _read_kernel(path: Path) -> Mesh:
    from lithobrake.geometry.naif_kernels import read_shape_kernel

    return read_shape_kernel(path)


READERS = {
    ".obj": _read_obj,
    ".stl": _read_stl,
    **dict.fromkeys((".tab", ".txt", ".icq"), _read_plates),
    **dict.fromkeys((".bds", ".dsk"), _read_kernel),
}
# The endings of files that are known by their content.
ENDINGS = {
    FileKind.OBJ: (".obj", ".tab", ".txt", ".icq"),
    FileKind.STL: (".stl",),
    FileKind.SHAPE_KERNEL: (".bds", ".dsk"),
}
