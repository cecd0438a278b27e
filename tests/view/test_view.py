"""A motion as a file for ParaView and as a film: what is in them, read back by the libraries of their fields."""

from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from lithobrake.results import MovingBodies
from lithobrake.view import contact_sheet, film, write_motion, write_vtkhdf
from lithobrake.view.motion import body_speeds, placed

TETRAHEDRON = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]) - 0.25
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


@pytest.fixture
def motion() -> MovingBodies:
    """Two tetrahedra at three instants: one at rest, one that moves along x and has turned about z at the end."""
    time = np.array([0.0, 1.0, 3.0])
    position = np.zeros((3, 2, 3))
    position[:, 1, 0] = [2.0, 3.0, 7.0]
    orientation = np.zeros((3, 2, 4))
    orientation[:, :, 0] = 1.0
    orientation[2, 1] = [np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]
    return MovingBodies((TETRAHEDRON, TETRAHEDRON), (FACES, FACES), time, position, orientation, {}, {})


def test_places_and_speeds_follow_from_the_frames(motion: MovingBodies) -> None:
    np.testing.assert_allclose(body_speeds(motion), [[0.0, 1.0], [0.0, 1.0], [0.0, 2.0]])
    np.testing.assert_allclose(placed(motion, 1)[4:] - TETRAHEDRON, np.tile([3.0, 0.0, 0.0], (4, 1)))
    # A quarter turn about z takes x to y.
    np.testing.assert_allclose(placed(motion, 2)[5], [7.25, 0.75, -0.25])


def test_the_file_holds_the_triangles_once_and_all_instants(motion: MovingBodies, tmp_path: Path) -> None:
    path = tmp_path / "motion.vtkhdf"
    write_motion(motion, path)
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        assert root.attrs["Type"] == b"PolyData"
        assert root["Steps"].attrs["NSteps"] == 3
        assert root["Points"].shape == (24, 3)
        assert root["Polygons/Connectivity"].shape == (24,)
        np.testing.assert_array_equal(root["Steps/PointOffsets"], [0, 8, 16])
        np.testing.assert_array_equal(root["CellData/speed"][-4:], [2.0, 2.0, 2.0, 2.0])


def test_forces_are_there_where_they_were_kept(motion: MovingBodies, tmp_path: Path) -> None:
    for force in (None, np.array([[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]])):
        write_vtkhdf(replace(motion, force=force), tmp_path / "motion.vtkhdf")
        with h5py.File(tmp_path / "motion.vtkhdf") as file:
            data, offsets = file["VTKHDF/CellData"], file["VTKHDF/Steps/CellDataOffsets"]
            assert set(data) == set(offsets) == {"body", "speed"} | ({"force"} if force is not None else set())
            if force is not None:
                np.testing.assert_array_equal(data["force"][:], np.repeat(force.ravel(), 4))
                np.testing.assert_array_equal(offsets["force"][:], [0, 8, 16])


def test_vtk_reads_what_was_written(motion: MovingBodies, tmp_path: Path) -> None:
    motion = replace(motion, force=np.array([[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]]))
    io = pytest.importorskip("vtkmodules.vtkIOHDF", reason="VTK, which reads the file back, is not installed")
    path = tmp_path / "motion.vtkhdf"
    write_vtkhdf(motion, path)
    reader = io.vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == 3
    for step in range(3):
        reader.SetStep(step)
        reader.Update()
        read = reader.GetOutput()
        points = np.array([read.GetPoint(k) for k in range(read.GetNumberOfPoints())])
        np.testing.assert_allclose(points, placed(motion, step), atol=1e-6)
        cells = [[read.GetCell(c).GetPointId(k) for k in range(3)] for c in range(read.GetNumberOfCells())]
        np.testing.assert_array_equal(cells, np.concatenate([FACES, FACES + 4]))
        speed = read.GetCellData().GetArray("speed")
        np.testing.assert_allclose([speed.GetValue(c) for c in range(8)], np.repeat(body_speeds(motion)[step], 4))
        force = read.GetCellData().GetArray("force")
        assert [force.GetValue(c) for c in range(8)] == np.repeat(motion.force[step], 4).tolist()


@pytest.mark.parametrize("kind", [".mp4", ".webp"])
def test_a_film_shows_what_moves(kind: str, motion: MovingBodies, tmp_path: Path) -> None:
    pytest.importorskip("pyvista", reason="PyVista, which draws the film, is not installed")
    path = tmp_path / f"film{kind}"
    film(motion, path, seconds=1.0)
    if kind == ".mp4":
        ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="imageio-ffmpeg, which writes MP4, is not installed")
        frames = ffmpeg.read_frames(str(path))
        size = next(frames)["size"]
        pictures = [np.frombuffer(frame, np.uint8).reshape(size[1], size[0], 3).astype(float) for frame in frames]
    else:
        from PIL import Image

        with Image.open(path) as opened:
            pictures = []
            for k in range(opened.n_frames):
                opened.seek(k)
                pictures.append(np.asarray(opened.convert("RGB"), dtype=float))
    assert len(pictures) == 3
    assert pictures[0].shape == (640, 960, 3)
    assert np.abs(pictures[-1] - pictures[0]).max() > 50.0


def test_other_kinds_and_durations_are_refused(motion: MovingBodies, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"allowed: a name that ends in \.vtkhdf, \.mp4, \.webp"):
        write_motion(motion, tmp_path / "motion.avi")
    with pytest.raises(ValueError, match=r"the film lasts 0\.0 s; allowed: a finite time above 0 s"):
        film(motion, tmp_path / "motion.mp4", seconds=0.0)


def test_a_contact_sheet_has_one_picture_for_each_instant(motion: MovingBodies, tmp_path: Path) -> None:
    from PIL import Image

    landing = replace(motion, attributes={"format": "lithobrake landing", "width": [8.0, 8.0]})
    for count in (1, 3):
        contact_sheet(landing, tmp_path / f"{count}.png", picture_count=count)
    one, three = (Image.open(tmp_path / f"{count}.png") for count in (1, 3))
    # Two columns, so three pictures take two rows.
    assert one.width == three.width
    pixels = np.asarray(three.convert("RGB")).astype(float)
    assert pixels[: three.height // 2].std() > 5.0 < pixels[three.height // 2 :].std()


def test_what_is_no_landing_has_no_contact_sheet(motion: MovingBodies, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="is no landing, and a contact sheet shows one"):
        write_motion(motion, tmp_path / "bed.png")
    assert not (tmp_path / "bed.png").exists()
