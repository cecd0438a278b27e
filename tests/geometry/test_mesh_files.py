"""Closed surfaces, meshes of archives, and attitudes: laws by chance, and terms that symmetry leaves."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import kstest, qmc

from lithobrake.geometry.attitude import AttitudeTerms, orthonormal, pointed, seen_from_lander, uniform_attitude
from lithobrake.geometry.mesh import closed_faces, holds_origin, mass_properties, volume_of
from lithobrake.geometry.mesh_files import read_mesh
from lithobrake.geometry.mesh_units import labelled_mesh, product_id
from lithobrake.smallbody import Shape

OCTAHEDRON = "\n".join(
    [
        *("v 1 0 0", "v -1 0 0", "v 0 1 0", "v 0 -1 0", "v 0 0 1", "v 0 0 -1"),
        *("f 1 3 5", "f 3 2 5", "f 2 4 5", "f 4 1 5", "f 3 1 6", "f 2 3 6", "f 4 2 6", "f 1 4 6"),
    ]
)
PDS4_LABEL = "<Field_Character><name>x</name><unit>km</unit></Field_Character>"
PDS3_LABEL = 'OBJECT = COLUMN\n  NAME = "VERTEX LOCATION ONE"\n  UNIT = "KILOMETER"\nEND_OBJECT = COLUMN\n'


def mesh(folder: Path, header: str = "", label: str = "", ending: str = ".xml") -> Path:
    """An octahedron with corners at a distance of 1, with a header and a label beside it."""
    path = folder / "rock.obj"
    path.write_text(f"{header}{OCTAHEDRON}\n")
    if label:
        path.with_suffix(ending).write_text(label)
    return path


@pytest.mark.parametrize(("header", "label", "ending", "length"), [
    ("", "", "", 1.0),
    ("# Blender v2.9 OBJ File: ''\n", "", "", 1.0),
    ("# Units: km\n", "", "", 1e3),
    ("# PRODUCT_VERSION = 3\n#\n# The units are kilometers.\n", "", "", 1e3),
    ("# vertices in meters\n", "", "", 1.0),
    ("# File units = millimetres\n", "", "", 1e-3),
    ("# UNITS: MM\n", "", "", 1e-3),
    ("# 1 unit = 1 km\n", "", "", 1e3),
    ("# all lengths are in km\n", "", "", 1e3),
    ("# x [km] y [km] z [km]\n", "", "", 1e3),
    ("mtllib rock.mtl\n\n# units: km\n", "", "", 1e3),
    ("# GSD = 0.25\n", PDS4_LABEL, ".xml", 1e3),
    ("", PDS3_LABEL, ".lbl", 1e3),
])  # fmt: skip
def test_the_unit_is_that_of_header_or_label(
    tmp_path: Path, header: str, label: str, ending: str, length: float
) -> None:
    vertices, _ = read_mesh(mesh(tmp_path, header, label, ending))
    assert vertices.max() == length


@pytest.mark.parametrize(("header", "label", "unit", "words"), [
    ("# GSD = TBD\n", "", None, "do not state the unit"),
    ("", "<Product_Observational/>", None, "do not state the unit"),
    ("# Units: km\n", "", "m", "says km, and unit is 'm'"),
    ("# Units: km\n", "<unit>m</unit>", None, "name km, m"),
    ("", "", "inch", "allowed are m, km, cm, mm"),
    ("# Units: feet\n", "", None, "gives lengths in feet; allowed are m, km, cm, mm"),
    ("# the units are Feet\n", "", "m", "gives lengths in feet"),
    ("# units = inches\n", "", None, "gives lengths in inches"),
    ("# units: in\n", "", "m", "gives lengths in in;"),
    ("# unit: mi\n", "", None, "gives lengths in miles"),
    ("# unit: \u00b5m\n", "", None, "gives lengths in um"),
    ("# unit: \u03bcm\n", "", None, "gives lengths in um"),
    ("# length_unit: ft\n", "", None, "gives lengths in feet"),
    ("# LENGTH_UNIT = FT\n", "", None, "gives lengths in feet"),
    ("# unit_length = furlongs\n", "", None, "gives lengths in furlongs"),
    ("\ufeff# units: km\n", "", "m", "says km, and unit is 'm'"),
    ("# vertices in furlongs\n", "", None, "gives lengths in furlongs"),
    ("# UNIT: AU\n", "", "km", "gives lengths in au"),
    ("# unit: au\n", "", None, "gives lengths in au"),
    ("# units: Mm\n", "", None, "gives lengths in Mm"),
    ("# units: parasangs\n", "", None, "gives lengths in parasangs"),
    ("# units: 0.3 m\n", "", None, "gives lengths in 0.3"),
    ("# units: km/s\n", "", "km", "gives lengths in km/s"),
    ("", "<unit>AU</unit>", None, "gives lengths in au"),
])  # fmt: skip
def test_a_unit_is_never_guessed(tmp_path: Path, header: str, label: str, unit: str | None, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        read_mesh(mesh(tmp_path, header, label), unit)


def test_a_unit_that_is_given_answers_a_silent_header(tmp_path: Path) -> None:
    assert read_mesh(mesh(tmp_path, "# GSD = TBD\n"), "km")[0].max() == 1e3


def test_a_unit_in_the_title_of_an_stl_file_is_read(tmp_path: Path) -> None:
    (tmp_path / "rock.stl").write_text("solid rock UNITS=feet\nfacet\nvertex 0 0 0\n")
    with pytest.raises(ValueError, match="gives lengths in feet"):
        read_mesh(tmp_path / "rock.stl", "m")


def plate_table(vertices: list[str], plates: list[str]) -> str:
    return "\n".join([str(len(vertices)), *vertices, str(len(plates)), *plates]) + "\n"


NUMBERED = [[f"{number} {line[2:]}" for number, line in enumerate(
    (line for line in OCTAHEDRON.splitlines() if line[0] == kind), 1)] for kind in "vf"]  # fmt: skip


def test_the_vertices_of_a_plate_table_have_their_numbers(tmp_path: Path) -> None:
    vertices, plates = NUMBERED
    path = tmp_path / "rock.tab"
    path.write_text(plate_table(vertices, plates))
    wanted = read_mesh(path)
    assert volume_of(*wanted) == pytest.approx(4.0 / 3.0)
    for order in ([1, 0, 2, 3, 4, 5], [5, 3, 1, 0, 2, 4]):
        path.write_text(plate_table([vertices[i] for i in order], plates[::-1]))
        assert all(np.array_equal(found, expected) for found, expected in zip(read_mesh(path), wanted, strict=True))
    path.write_text(plate_table([line[2:] for line in vertices], [line[2:] for line in plates]))
    assert np.array_equal(read_mesh(path)[0], wanted[0])


@pytest.mark.parametrize(("line", "words"), [
    ("5 0 0 -1", "vertices are not numbered from 1 to 6: 6 is missing"),
    ("7 0 0 -1", "vertices are not numbered from 1 to 6: 6 is missing"),
    ("0 0 0 -1", "6 is missing"),
    ("0 0 -1", "lines of vertices have 3, 4 entries"),
    ("6 0 0 -1 1", "lines of vertices have 4, 5 entries"),
    ("six 0 0 -1", "invalid literal"),
])  # fmt: skip
def test_a_plate_table_with_gaps_between_its_numbers_is_refused(tmp_path: Path, line: str, words: str) -> None:
    vertices, plates = NUMBERED
    (tmp_path / "rock.tab").write_text(plate_table([*vertices[:-1], line], plates))
    with pytest.raises(ValueError, match=words):
        read_mesh(tmp_path / "rock.tab")


SQUARE = "v 0 0 0\nv 2 0 0\nv {x} 1 0\nv 0 2 0\nv 0 0 1\n"
FANS = "f 1 4 5\nf 1 5 2\nf 2 5 3\nf 3 5 4\n"


@pytest.mark.parametrize(("name", "text", "words"), [
    ("rock.obj", "ply\nformat ascii 1.0\n", "rock.obj is a PLY mesh; meshes are read from OBJ"),
    ("rock.tab", "CCSDS_OEM_VERS = 2.0\n", r"rock.tab is an Orbit Ephemeris Message \(OEM\); meshes are read"),
    ("rock.dat", OCTAHEDRON, "rock.dat is an OBJ mesh, which its ending does not say; allowed: .obj"),
    ("rock.obj", "solid rock\nfacet normal 0 0 1\n", "rock.obj is an STL mesh.*; allowed: .stl; rename it"),
    ("rock.xyz", "1 2 3\n", "the ending '.xyz' is not read"),
    ("rock.obj", OCTAHEDRON.translate(str.maketrans("123456", "012345", "")).replace("v 0", "v 1"),
     "its facets count from 0, to 5 of 6 vertices; allowed: from 1"),
    ("rock.tab", plate_table([line[2:] for line in NUMBERED[0]], ["0 2 4", "2 1 4", "1 3 4", "3 0 5"]),
     "its facets count from 0, to 5 of 6 vertices"),
    ("dart.obj", f"{SQUARE.format(x=0.5)}{FANS}f 4 3 2 1\n", "line 10 has a facet of 4 corners that is not convex"),
    ("bow.obj", f"{SQUARE.format(x=2)}{FANS}f 1 3 2 4\n", "line 10 has a facet of 4 corners that is not convex"),
])  # fmt: skip
def test_a_mesh_that_is_none_is_told_why(tmp_path: Path, name: str, text: str, words: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(ValueError, match=words):
        read_mesh(tmp_path / name)


def test_a_convex_facet_is_cut_into_a_fan(tmp_path: Path) -> None:
    (tmp_path / "pyramid.obj").write_text(f"{SQUARE.format(x=1.5)}{FANS}f 4 3 2 1\n")
    vertices, faces = read_mesh(tmp_path / "pyramid.obj")
    # A third of the height times the base, 2 x 1 / 2 + 1.5 x 2 / 2 by its two triangles at the origin.
    assert abs(volume_of(vertices, closed_faces(vertices, faces, "pyramid"))) == pytest.approx(2.5 / 3.0)


def gaskell_cube(size: int) -> np.ndarray:
    """Vertices of a cube as the format has them, [6, J, I, 3], from the corners that its faces share."""
    corners = {
        "a": (-1, -1, 1), "b": (1, -1, 1), "c": (1, 1, 1), "d": (-1, 1, 1),
        "e": (-1, -1, -1), "f": (1, -1, -1), "g": (1, 1, -1), "h": (-1, 1, -1),
    }  # fmt: skip
    # Corners (0, 0), (Q, 0), (0, Q), (Q, Q) of each face.
    faces = ("adbc", "bcfg", "abef", "dahe", "cdgh", "fgeh")
    step = np.linspace(0.0, 1.0, size + 1)
    i, j = step[None, :, None], step[:, None, None]
    grids = []
    for face in faces:
        zero, right, down, both = (np.array(corners[name], dtype=float) for name in face)
        grids.append((1 - i) * (1 - j) * zero + i * (1 - j) * right + (1 - i) * j * down + i * j * both)
    return np.array(grids)


@pytest.mark.parametrize("ending", ["icq", "tab", "txt"])
def test_quadrilaterals_close_to_a_body_that_faces_outward(tmp_path: Path, ending: str) -> None:
    grid = gaskell_cube(4)
    lines = ["4", *(f"{x:.9f} {y:.9f} {z:.9f}" for x, y, z in grid.reshape(-1, 3))]
    (tmp_path / f"cube.{ending}").write_text("\n".join(lines) + "\n")
    vertices, faces = read_mesh(tmp_path / f"cube.{ending}", "km")
    # Of 6 (Q + 1)^2 labelled vertices 6 Q^2 + 2 are independent.
    assert (len(vertices), len(faces)) == (6 * 4**2 + 2, 12 * 4**2)
    assert np.array_equal(closed_faces(vertices, faces, "cube"), faces)
    assert volume_of(vertices, faces) == pytest.approx(8e9)


def test_a_shape_kernel_is_read_in_kilometres(tmp_path: Path) -> None:
    write_kernel(pytest.importorskip("spiceypy"), tmp_path / "rock.bds", 1)
    vertices, faces = read_mesh(tmp_path / "rock.bds")
    assert vertices.max() == 1e3
    assert volume_of(vertices, faces) == pytest.approx(4.0 / 3.0 * 1e9)
    with pytest.raises(ValueError, match="says km"):
        read_mesh(tmp_path / "rock.bds", "m")


def test_kernels_that_are_no_single_shape_are_refused(tmp_path: Path) -> None:
    write_kernel(pytest.importorskip("spiceypy"), tmp_path / "two.bds", 2)
    with pytest.raises(ValueError, match="2 segments"):
        read_mesh(tmp_path / "two.bds")
    (tmp_path / "text.bds").write_text("no kernel\n" * 200)
    with pytest.raises(ValueError, match="not a kernel that SPICE opens"):
        read_mesh(tmp_path / "text.bds")


def test_a_damaged_shape_kernel_is_refused_and_ends_no_process(tmp_path: Path) -> None:
    """SPICE aborts the process that reads one of zeros."""
    write_kernel(pytest.importorskip("spiceypy"), tmp_path / "rock.bds", 1)
    whole = (tmp_path / "rock.bds").read_bytes()
    random = np.random.default_rng(1)
    flipped = bytearray(whole)
    for place in random.integers(8, 4000, 300):
        flipped[place] = random.integers(256)
    damaged = [b"DAS/DSK " + bytes(4000), whole[:1500], whole[:3000], bytes(flipped)]
    for number, content in enumerate(damaged):
        path = tmp_path / f"damaged{number}.bds"
        path.write_bytes(content)
        with pytest.raises(ValueError, match=f"{path}: (not a kernel that SPICE|a kernel without plates|.* cannot be)"):
            read_mesh(path)


def write_kernel(spice: object, path: Path, segments: int) -> None:
    """An octahedron with corners at 1 km, in so many segments."""
    vertices = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float)
    plates = np.array(
        [[int(word) for word in line.split()[1:]] for line in OCTAHEDRON.splitlines() if line[0] == "f"], dtype=np.int32
    )
    handle = spice.dskopn(str(path), "test", 0)  # type: ignore[attr-defined]
    index = spice.dskmi2(vertices, plates, 0.5, 1, 10000, 10000, 10000, True, 1000000)  # type: ignore[attr-defined]
    bounds = (-np.pi, np.pi, -np.pi / 2, np.pi / 2, 0.0, 2.0)
    for _ in range(segments):
        spice.dskw02(  # type: ignore[attr-defined]
            handle, 120065803, 1, 1, "J2000", 1, np.zeros(10), *bounds, -1e9, 1e9, vertices, plates, *index
        )
    spice.dskcls(handle, True)  # type: ignore[attr-defined]


PRODUCT = """<Product_Observational xmlns="http://pds.nasa.gov/pds4/pds/v1"><Identification_Area>
  <logical_identifier> urn:nasa:pds:rocks:data:rock </logical_identifier>
  <version_id>3.0</version_id>
  <Modification_History><version_id>1.0</version_id></Modification_History></Identification_Area>
  <File_Area_Observational><File><file_name>{file}</file_name></File>
  <Field_Character><unit>km</unit></Field_Character></File_Area_Observational></Product_Observational>
"""


def test_a_label_names_its_product_and_its_mesh(tmp_path: Path) -> None:
    path = mesh(tmp_path, label=PRODUCT.format(file="rock.obj"))
    label = path.with_suffix(".xml")
    assert product_id(path) == "urn:nasa:pds:rocks:data:rock::3.0"
    assert labelled_mesh(label) == labelled_mesh(path) == path
    assert Shape.read(label).radius == 1e3
    label.write_text(PDS4_LABEL)
    assert product_id(path) is None
    label.unlink()
    assert product_id(path) is None
    assert labelled_mesh(label) == label


@pytest.mark.parametrize("file", ["other.obj", "rock.stl", "../rock.obj"])
def test_a_label_of_another_file_is_no_mesh(tmp_path: Path, file: str) -> None:
    """What is not beside it under its name may be in another unit than the label says."""
    label = mesh(tmp_path, label=PRODUCT.format(file=file)).with_suffix(".xml")
    with pytest.raises(ValueError, match=f"this label names {file}; allowed: one file beside it that is named rock"):
        labelled_mesh(label)


@pytest.mark.parametrize(
    "header", ["# length_unit: km\n", "# LengthUnits: km\n", "# unit_length = km\n", "# units: km\n"]
)
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_a_unit_is_found_by_each_name_and_behind_a_byte_order_mark(tmp_path: Path, header: str, mark: str) -> None:
    (tmp_path / "rock.obj").write_text(f"{mark}{header}\n{OCTAHEDRON}", encoding="utf-8")
    assert read_mesh(tmp_path / "rock.obj")[0].max() == 1000.0


@pytest.mark.parametrize("name", ["rock.obj", "rock.tab"])
def test_a_byte_order_mark_hides_no_vertex(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("\ufeff" + OCTAHEDRON, encoding="utf-8")
    assert volume_of(*read_mesh(tmp_path / name)) == pytest.approx(4.0 / 3.0)


UNIT_CUBE = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
FACES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]),
        *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)
OCTANTS = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])


def test_a_volume_has_the_sign_of_its_facets() -> None:
    assert volume_of(UNIT_CUBE, FACES) == pytest.approx(1.0, rel=1e-14)
    assert volume_of(UNIT_CUBE, FACES[:, ::-1]) == pytest.approx(-1.0, rel=1e-14)
    assert volume_of(np.concatenate([UNIT_CUBE, [[1e12] * 3]]), FACES) == volume_of(UNIT_CUBE, FACES)
    assert volume_of(UNIT_CUBE + 7.0, FACES) == pytest.approx(mass_properties(UNIT_CUBE + 7.0, FACES)[0], rel=1e-12)


@pytest.mark.parametrize(("shift", "inside"), [(0, True), (0.4999, True), (0.5001, False), (3.0, False), (1e6, False)])
def test_a_surface_goes_round_the_origin_or_not(shift: float, inside: bool) -> None:
    for direction in np.eye(3):
        assert holds_origin(UNIT_CUBE + shift * direction, FACES) == inside


def test_a_surface_through_the_origin_does_not_go_round_it() -> None:
    """Whichever way its facets are turned: of slanted ones rounding leaves the origin above or below."""
    turns = np.linalg.qr(np.random.default_rng(0).normal(size=(40, 3, 3)))[0]
    on_facets = UNIT_CUBE + np.array([0.5, 0.1, 0.2])
    assert not any(holds_origin(on_facets @ turn, FACES) for turn in turns)


def test_a_flat_body_has_no_volume() -> None:
    with pytest.raises(ValueError, match="flat, it encloses"):
        closed_faces(np.vstack([np.eye(3), -np.eye(3)]) * [1.0, 1.0, 1e-12], OCTANTS, "plate")


# Independent draws, so that the Kolmogorov test's probabilities hold; the seed is fixed.
UNIFORM = np.random.default_rng(5).random((4000, 3))


def rotations(quaternions: list[np.ndarray]) -> Rotation:
    return Rotation.from_quat(np.array(quaternions), scalar_first=True)


def test_attitudes_are_even_over_all_rotations() -> None:
    found = [uniform_attitude(*row) for row in UNIFORM]
    assert np.linalg.norm(found, axis=1) == pytest.approx(1.0, abs=1e-12)
    # Where any axis points is even over the sphere, so each coordinate is even between -1 and 1 (Archimedes); and the
    # angle of a rotation has the density (1 - cos) / pi.
    turned = rotations(found).as_matrix()
    for row in range(3):
        for column in range(3):
            assert kstest(turned[:, row, column], "uniform", args=(-1.0, 2.0)).pvalue > 1e-3
    assert kstest(rotations(found).magnitude(), lambda a: (a - np.sin(a)) / math.pi).pvalue > 1e-3


def test_a_sequence_of_attitudes_fills_the_rotations_more_evenly_than_chance() -> None:
    even = qmc.Sobol(3, rng=np.random.default_rng(1)).random(1024)
    mean = rotations([uniform_attitude(*row) for row in even]).as_matrix().mean(axis=0)
    # Each entry has mean 0 and variance 1/3: independent draws would be off by 0.018.
    assert np.abs(mean).max() < 0.006


@pytest.mark.parametrize("half_angle", [0.1, 1.0, math.pi])
def test_an_error_of_pointing_is_even_over_its_cone(half_angle: float) -> None:
    given = np.array([0.5, -0.3, 0.8, 0.2])
    nominal = Rotation.from_quat(given, scalar_first=True)
    found = rotations([pointed(given, half_angle, *row[:2]) for row in UNIFORM])
    # Seen from the lander as it should stand, its z axis lies evenly over the cap about z.
    axis = (nominal.inv() * found).apply([0.0, 0.0, 1.0])
    cap = 1.0 - math.cos(half_angle)
    assert kstest(axis[:, 2], "uniform", args=(1.0 - cap, cap)).pvalue > 1e-3
    assert kstest(np.arctan2(axis[:, 1], axis[:, 0]), "uniform", args=(-math.pi, 2.0 * math.pi)).pvalue > 1e-3
    # Without a roll: the way from the one attitude to the other is as long as that of the axis.
    assert (nominal.inv() * found).magnitude() == pytest.approx(np.arccos(axis[:, 2]), abs=1e-7)


def test_a_closing_cone_leaves_the_attitude() -> None:
    given = np.array([0.5, -0.5, 0.5, 0.5])
    assert pointed(given, 1e-9, 0.7, 0.2) == pytest.approx(given, abs=1e-9)


PRISM, BOX, CUBE = (AttitudeTerms.of_box(np.array(edges)) for edges in ([0.1, 0.1, 0.2], [0.3, 0.2, 0.1], [0.1] * 3))
MESH = AttitudeTerms.of_body(np.array([[2.0, 0.1, 0.0], [0.1, 3.0, 0.2], [0.0, 0.2, 4.0]]))
LANDERS = pytest.mark.parametrize("terms", [PRISM, BOX, CUBE, MESH])
HALF_TURNS = [Rotation.from_rotvec(np.pi * axis) for axis in np.eye(3)]


def ways(rotations: Rotation) -> tuple[np.ndarray, np.ndarray]:
    """Normal and travel seen from landers that are turned so, with the travel along x."""
    into_bed = rotations.as_matrix()
    return into_bed[:, 2], into_bed[:, 0]


def test_normal_and_travel_are_those_of_the_bed() -> None:
    turned = Rotation.random(5, rng=0)
    azimuth = np.linspace(0.0, 6.0, 5)
    normal, travel = seen_from_lander(np.roll(turned.as_quat(), 1, axis=1), azimuth)
    assert turned.apply(normal) == pytest.approx(np.tile([0.0, 0.0, 1.0], (5, 1)))
    assert turned.apply(travel) == pytest.approx(np.column_stack([np.cos(azimuth), np.sin(azimuth), np.zeros(5)]))


@pytest.mark.parametrize(("terms", "count"), [(PRISM, 3), (BOX, 6), (CUBE, 3), (MESH, 12)])
def test_as_many_terms_as_symmetry_leaves(terms: AttitudeTerms, count: int) -> None:
    assert terms.at(*ways(Rotation.random(4, rng=1))).shape == (4, count)
    assert len(terms.ranges) == count


@pytest.mark.parametrize(("terms", "symmetries"), [
    (BOX, HALF_TURNS),
    (PRISM, [*HALF_TURNS, Rotation.from_rotvec([0.0, 0.0, 0.5 * np.pi])]),
    (CUBE, [Rotation.from_rotvec(0.5 * np.pi * axis) for axis in np.eye(3)]),
])  # fmt: skip
def test_symmetries_of_the_lander_change_no_term(terms: AttitudeTerms, symmetries: list[Rotation]) -> None:
    attitudes = Rotation.random(50, rng=2)
    for symmetry in symmetries:
        assert terms.at(*ways(attitudes * symmetry)) == pytest.approx(terms.at(*ways(attitudes)), abs=1e-12)


def test_a_mesh_is_not_taken_as_symmetric() -> None:
    attitudes = Rotation.random(50, rng=3)
    for symmetry in HALF_TURNS:
        assert np.abs(MESH.at(*ways(attitudes * symmetry)) - MESH.at(*ways(attitudes))).max() > 0.5


@pytest.mark.parametrize("terms", [PRISM, BOX, CUBE])
def test_the_mirror_image_of_an_arrival_has_the_same_terms(terms: AttitudeTerms) -> None:
    normal, travel = ways(Rotation.random(20, rng=4))
    mirror = np.array([-1.0, 1.0, 1.0])
    assert terms.at(normal * mirror, travel * mirror) == pytest.approx(terms.at(normal, travel))


@LANDERS
def test_the_law_over_all_attitudes_is_that_of_many(terms: AttitudeTerms) -> None:
    found = terms.at(*ways(Rotation.random(40_000, rng=5)))
    mean, covariance = terms.uniform_law
    assert found.mean(axis=0) == pytest.approx(mean, abs=0.015)
    assert np.cov(found.T) == pytest.approx(covariance, abs=0.015)
    ends = np.array(list(terms.ranges.values()))
    assert (found >= ends[:, 0] - 1e-12).all()
    assert (found <= ends[:, 1] + 1e-12).all()
    # Many attitudes come near the ends, so that the ranges are not too wide.
    assert (np.ptp(found, axis=0) > 0.9 * np.ptp(ends, axis=1)).all()


@LANDERS
def test_orthonormal_terms_have_no_correlation(terms: AttitudeTerms) -> None:
    found = orthonormal(terms.at(*ways(Rotation.random(40_000, rng=6))), terms.uniform_law)
    assert found.shape[1] == len(terms.ranges)
    assert np.cov(found.T) == pytest.approx(np.eye(found.shape[1]), abs=0.04)


def test_what_does_not_vary_drops_out() -> None:
    normal, travel = ways(Rotation.from_rotvec(np.column_stack([np.zeros((9, 2)), np.linspace(0.0, 3.0, 9)])))
    found = BOX.at(normal, travel)
    own = found - found.mean(axis=0)
    # Upright boxes that come from all sides: how far an axis leans is 0 throughout.
    assert orthonormal(found, (found.mean(axis=0), own.T @ own / 9)).shape == (9, 1)
    assert orthonormal(found[:1], (found[0], np.zeros((6, 6)))).shape == (1, 0)


def test_a_box_that_is_loaded_unevenly_is_no_prism() -> None:
    edges, inertia = np.array([0.1, 0.1, 0.2]), np.array([1.0, 2.0, 2.5])
    assert len(AttitudeTerms.of_box(edges, inertia).ranges) == 6
    assert AttitudeTerms.of_box(edges).names == ("z",)
