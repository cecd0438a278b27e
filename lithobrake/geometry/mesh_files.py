"""Reading triangles from mesh files, with the unit that a header or a label states."""

import codecs
import os
import re
import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

LABEL = ".xml"
# The version of the product follows its identifier; later ones are of its history.
_PRODUCT = re.compile(
    r"<logical_identifier>\s*([^<\s]+)\s*</logical_identifier>\s*<version_id>\s*([^<\s]+)\s*</version_id>"
)
_FILE = re.compile(r"<file_name>\s*([^<]*?)\s*</file_name>")


def product_id(mesh: Path) -> str | None:
    """Identifier and version of a product, as "urn:nasa:pds:bundle:collection:product::1.0"; None without a label."""
    label = mesh.with_suffix(LABEL)
    found = _PRODUCT.search(_text(label)) if label.is_file() else None
    return None if found is None else "::".join(found.groups())


def labelled_mesh(path: Path) -> Path:
    """The mesh that a label is of; any other path as it is. Raises ValueError for a label without such a file."""
    if path.suffix.lower() != LABEL or not path.is_file():
        return path
    named = [name for name in _FILE.findall(_text(path)) if Path(name).stem == path.stem and Path(name).name == name]
    if len(named) != 1 or not path.with_name(named[0]).is_file():
        raise ValueError(
            f"{path}: this label names {', '.join(_FILE.findall(_text(path))) or 'no file'}; allowed: one file beside "
            f"it that is named {path.stem}, with another ending; give the path of the mesh itself."
        )
    return path.with_name(named[0])


def _text(label: Path) -> str:
    return label.read_text(encoding="utf-8", errors="replace")


UNITS = {"m": 1.0, "km": 1e3, "cm": 1e-2, "mm": 1e-3}
# Formats that fix their unit.
FIXED = {".bds": "km", ".dsk": "km"}
# Lengths by the words that name them, in small letters; those that UNITS lacks are recognised to be refused.
_WORDS = {
    **dict.fromkeys(("km", "kilometer", "kilometers", "kilometre", "kilometres"), "km"),
    **dict.fromkeys(("m", "meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("cm", "centimeter", "centimeters", "centimetre", "centimetres"), "cm"),
    **dict.fromkeys(("mm", "millimeter", "millimeters", "millimetre", "millimetres"), "mm"),
    **dict.fromkeys(("feet", "foot", "ft"), "feet"),
    **dict.fromkeys(("inches", "inch"), "inches"),
    **dict.fromkeys(("yards", "yard", "yd"), "yards"),
    **dict.fromkeys(("miles", "mile", "mi"), "miles"),
    **dict.fromkeys(("furlongs", "furlong"), "furlongs"),
    **dict.fromkeys(("au", "astronomical unit", "astronomical units"), "au"),
    **dict.fromkeys(("parsecs", "parsec", "pc"), "parsecs"),
    **dict.fromkeys(("dm", "decimeter", "decimeters", "decimetre", "decimetres"), "dm"),
    **dict.fromkeys(
        ("um", "\u00b5m", "\u03bcm", "micrometer", "micrometers", "micrometre", "micrometres", "microns"), "um"
    ),
    **dict.fromkeys(("nm", "nanometer", "nanometers", "nanometre", "nanometres"), "nm"),
    **dict.fromkeys(("megameter", "megameters", "megametre", "megametres"), "Mm"),
}
_NAMED = "|".join(sorted(_WORDS, key=len, reverse=True))
_LENGTHS = r"(?:vertices|vertex coordinates|coordinates|positions|lengths|distances|dimensions)"
# "units", "length_unit", "LengthUnits", "unit_length".
_UNIT = r"(?:\b|_|length)units?(?:_of)?(?:_lengths?)?\b"
# "units: km", "UNIT = KILOMETER", "the units are kilometers", "vertices in km", "all lengths are in km", "x [km]".
_STATED = re.compile(
    rf"(?:{_UNIT}\W*(?:1(?:\.0*)?\s+)?(?:(?:are|is|in|of|length|vertices|coordinates)\W+){{0,3}}"
    rf"|\b{_LENGTHS}\s+(?:(?:are|given)\s+)*in\s+|\b[xyz]\s*[\[(]\s*)"
    rf"({_NAMED})(?![\w/^*])",
    flags=re.IGNORECASE,
)
# Whatever a header names as the unit: "units: parasangs", "the unit is 0.3 m".
_ANY_STATED = re.compile(
    rf"{_UNIT}[ \t]*(?:[:=]|(?:are|is|in)\b)[ \t]*(?:(?:are|is|in|of|length)[ \t]+)*([^\s,;]+)", flags=re.IGNORECASE
)
# Labels of PDS4 name the unit of each field; those of PDS3 are found by the pattern above.
_FIELD = re.compile(rf"<unit>\s*({_NAMED})\s*</unit>", flags=re.IGNORECASE)
# Archives describe what they keep by keywords: "# GSD = 0.25", "# PRODUCT_VERSION: 3".
_KEYWORD = re.compile(r"^#\s*[A-Z][A-Z0-9_]+\s*[:=]", flags=re.MULTILINE)
# A line of a vertex, or of how many there are.
_VERTEX = re.compile(rb"\s*(?:[vV]\s|[-+.\d])")
TITLE_LENGTH = 80  # of a binary STL file


def mesh_unit(path: Path, unit: str | None) -> str:
    """The unit of a mesh: the one that is given, else what its header or label states, else metres.

    Raises ValueError for an unknown unit, given or stated, for one that the file contradicts, and where none is given
    and the file comes from an archive, by its label or by the keywords of its header, that does not state one: nothing
    is guessed then.
    """
    if unit is not None and unit not in UNITS:
        raise ValueError(f"unit is {unit!r}; allowed are {', '.join(UNITS)}.")
    stated, archived = _stated(path)
    strange = sorted(stated - set(UNITS))
    if strange and unit not in stated:
        raise ValueError(
            f"{path}: its header or label gives lengths in {' and '.join(strange)}; allowed are {', '.join(UNITS)}: "
            "convert the mesh, or correct what is said of it."
        )
    if unit is not None and stated and unit not in stated:
        words = " and ".join(sorted(stated))
        raise ValueError(f"{path}: its header or label says {words}, and unit is {unit!r}; give what it says, or none.")
    if unit is None and (len(stated) > 1 or (archived and not stated)):
        words = f"name {', '.join(sorted(stated))}" if stated else "do not state the unit of its lengths"
        raise ValueError(
            f"{path}: header and label {words}; look it up in the archive's document and give it as unit: "
            f"{', '.join(UNITS)}."
        )
    return unit or (stated.pop() if stated else "m")


def _stated(path: Path) -> tuple[set[str], bool]:
    """What header and label state as the unit, and whether there is a label, or a header with keywords.

    Where neither names a length, what else the header calls its unit.
    """
    if path.suffix.lower() in FIXED:
        return {FIXED[path.suffix.lower()]}, True
    # A label of PDS4 or PDS3 lies beside the mesh, under its name.
    labels = [place for ending in (".xml", ".lbl", ".LBL") if (place := path.with_suffix(ending)).is_file()]
    header = _header(path)
    texts = [header, *(label.read_text(encoding="utf-8", errors="replace") for label in labels)]
    found = {_length(word) for text in texts for word in (*_STATED.findall(text), *_FIELD.findall(text))}
    others = {word.strip("'\"()[]<>.") or "nothing" for word in _ANY_STATED.findall(header)}
    return found or others, bool(labels) or _KEYWORD.search(header) is not None


def _length(word: str) -> str:
    """The unit that a word names. Capitals make no difference but to Mm, which is no millimetre."""
    return word if word == "Mm" else _WORDS[word.lower()]


def _header(path: Path) -> str:
    """The lines that begin with # before the first vertex; of an STL file, which has none, its title."""
    with path.open("rb") as file:
        if path.suffix.lower() == ".stl":
            return file.read(TITLE_LENGTH).partition(b"\n")[0].decode("utf-8", errors="replace")
        lines = []
        for line in file:
            if _VERTEX.match(line):
                break
            text = line.removeprefix(codecs.BOM_UTF8).decode("utf-8", errors="replace")
            if text.lstrip().startswith("#"):
                lines.append(text)
    return "".join(lines)


Mesh = tuple[NDArray[np.float64], NDArray[np.int64]]


def read_mesh(path: str | os.PathLike[str], unit: str | None = None) -> Mesh:
    """Vertices [m], shape [vertex_count, 3], and faces, shape [facet_count, 3], of a file whose ending READERS has.

    unit: of its lengths; absent: what its header or label says, else m. Raises ValueError as mesh_unit does, and for an
    unknown ending and a line or length that is not of the format.
    """
    path = Path(path)
    if path.suffix.lower() not in READERS:
        raise ValueError(f"{path}: the ending {path.suffix!r} is not read; convert to one of {', '.join(READERS)}.")
    if not path.is_file():
        raise ValueError(f"{path}: no such file.")
    length = UNITS[mesh_unit(path, unit)]
    vertices, faces = READERS[path.suffix.lower()](path)
    return vertices * length, faces


def _read_obj(path: Path) -> Mesh:
    """Wavefront OBJ: `v` and `f` lines; a polygon is cut into a fan of triangles from its first corner."""
    vertices: list[list[float]] = []
    faces: list[list[int]] = []
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
        faces += [[corners[0], corners[i], corners[i + 1]] for i in range(1, len(corners) - 1)]
    if any(len(vertex) != 3 for vertex in vertices):
        raise ValueError(f"{path}: a vertex has fewer than three coordinates.")
    return np.array(vertices, dtype=np.float64).reshape(-1, 3), np.array(faces, dtype=np.int64).reshape(-1, 3)


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
