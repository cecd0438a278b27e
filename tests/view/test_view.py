"""Motions and journeys in files of other programs and in a browser."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from lithobrake.report.figures.map_frames import track_map
from lithobrake.report.figures.style import figure_style
from lithobrake.results import JourneyMotion, JourneyTrack, MovingBodies, TouchdownFacts
from lithobrake.view import contact_sheet, film, journey_film, write_journey, write_motion, write_vtkhdf
from lithobrake.view.drawn_motion import body_speeds, placed
from lithobrake.view.motion_files import SIZE, map_picture

from ..report.browser import browser_page, needs_browser

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
        assert (root.attrs["Type"], root["Steps"].attrs["NSteps"]) == (b"PolyData", 3)
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


PHONE, LAPTOP = 390, 1280
ROW: dict[str, Any] = {"journey": 7, "end": "at_rest", "body": "dimorphos", "time_s": 5000.0,
    "latitude_deg": 12.0, "longitude_deg": -178.0, "distance": 9.0, "contacts": 4,
    "face": "-z", "tilt_deg": 12.34, "reason": ""}  # fmt: skip


def track(**changes: Any) -> JourneyTrack:
    """Three touchdowns across the half turn of longitude; changes: of the row of the journey."""
    touchdowns = (
        TouchdownFacts(0, 0.0, 10.0, 0.1, 20.0, "clear", 0.05, 10.0, 179.0, "dimorphos", 80.0),
        TouchdownFacts(1, 1000.0, 1020.0, 0.06, 40.0, "clear", 0.03, 11.0, -179.5, "dimorphos", 80.0),
        TouchdownFacts(2, 4000.0, 5000.0, 0.03, 60.0, "captured", None, 11.5, -179.0, "dimorphos", 80.0),
    )
    sphere = 80.0 * np.vstack([np.eye(3), -np.eye(3)])
    return JourneyTrack({**ROW, **changes}, touchdowns, (10.0, 178.0), 80.0, sphere, 0.0, "didymos")


def bodies(way: float) -> MovingBodies:
    """Two grains on ground that repeats, and a lander that goes so far along x [m] in three frames."""
    position = np.zeros((3, 3, 3))
    position[:, :2, :2] = [[-0.3, 0.0], [0.3, 0.1]]
    position[:, 2] = np.linspace([0.0, 0.0, 0.3], [way, 0.0, 0.3], 3)
    orientation = np.zeros((3, 3, 4))
    orientation[:, :, 0] = 1.0
    facts = {"format": "lithobrake landing", "sides": "periodic", "width": [1.0, 1.0]}
    return MovingBodies((0.1 * TETRAHEDRON,) * 3, (FACES,) * 3, np.arange(3.0), position, orientation, facts, {})


def arc(latitude: float, other: float, across: float) -> float:
    """Angle [rad] between two latitudes whose longitudes differ by so much [deg], by the law of cosines."""
    one, two, turn = np.radians([latitude, other, across])
    return float(np.arccos(np.sin(one) * np.sin(two) + np.cos(one) * np.cos(two) * np.cos(turn)))


@pytest.fixture
def journey_motion() -> JourneyMotion:
    return JourneyMotion(track(), [bodies(0.2), bodies(0.3), bodies(9.0)])


def test_lines_tell_every_touchdown_and_the_end() -> None:
    *_, first, second, third, end = track().lines()
    # Over a ball of 80 m from one impact to the next.
    ways = [f"{80.0 * one:.3g}" for one in (arc(10.0, 11.0, 1.5), arc(11.0, 11.5, 0.5))]
    assert first.split() == ["0", "0", "s", "0.1", "20", "0.05", "10", ways[0]]
    assert second.split() == ["1", "16.7", "min", "0.06", "40", "0.03", "20", ways[1]]
    assert third.split() == ["2", "66.7", "min", "0.03", "60", "at", "rest", "1000"]
    assert end == (
        "At rest 83.3 min after delivery, after 4 contacts in 3 touchdowns, at latitude 12.000 and longitude -178.000 "
        "deg, 9 m from the aim point; side -z is down, tilted by 12.3 deg."
    )


def test_a_lander_that_escapes_has_no_place_and_its_last_line_says_so() -> None:
    gone = track(end="escaped", **dict.fromkeys(("latitude_deg", "longitude_deg", "distance", "face", "tilt_deg"), ""))
    gone = replace(gone, touchdowns=gone.touchdowns[:2])
    assert gone.lines()[-2].endswith("escaped")
    assert gone.lines()[-1] == "Escaped 83.3 min after delivery, after 4 contacts in 2 touchdowns."


def test_a_journey_that_failed_says_why() -> None:
    failed = track(end="failed", reason="ValueError: through the floor", latitude_deg=np.nan, face="")
    assert failed.end_words.endswith("in 3 touchdowns: ValueError: through the floor.")


@pytest.mark.parametrize("shown", [None, 0, 1])
def test_the_map_joins_impacts_across_the_half_turn(shown: int | None) -> None:
    with figure_style():
        (line, dots, *_) = track_map(track(), shown).axes[0].lines
    # Metres east of the aim point at longitude 178: by the radius and the parallels.
    turns = zip((10.0, 11.0, 11.5, float(ROW["latitude_deg"])), (1.0, 2.5, 3.0, 4.0), strict=True)
    whole = [80.0 * np.cos(np.radians(latitude)) * np.radians(turn) for latitude, turn in turns]
    assert line.get_xdata() == pytest.approx(whole if shown is None else whole[: shown + 1], rel=2e-3)
    assert dots.get_xdata() == pytest.approx(whole[:3] if shown is None else whole[: shown + 1], rel=2e-3)


def test_a_sheet_has_a_strip_for_each_touchdown(journey_motion: JourneyMotion, tmp_path: Path) -> None:
    from PIL import Image

    heights = []
    for count in (1, 2):
        (path,) = write_journey(
            JourneyMotion(journey_motion.track, journey_motion.bodies[:count]), tmp_path / f"{count}.png"
        )
        with Image.open(path) as opened:
            heights.append(opened.height)
            assert np.asarray(opened)[-200:].std() > 5.0
    assert heights[1] > 1.1 * heights[0]


def test_paraview_gets_a_file_a_touchdown(journey_motion: JourneyMotion, tmp_path: Path) -> None:
    paths = write_journey(journey_motion, tmp_path / "lander.vtkhdf")
    assert [path.name for path in paths] == [f"lander_{number}.vtkhdf" for number in range(3)]
    with h5py.File(paths[0]) as near, h5py.File(paths[2]) as far:
        # The images of the ground along the way of the lander.
        assert len(far["VTKHDF/CellData/body"]) > len(near["VTKHDF/CellData/body"])


def test_a_picture_of_the_map_is_as_large_as_the_film() -> None:
    for shown in (None, 0):
        assert map_picture(track(), shown).shape == (SIZE[1], SIZE[0], 3)


def test_a_film_has_every_touchdown_with_a_map_before_it(journey_motion: JourneyMotion, tmp_path: Path) -> None:
    pytest.importorskip("pyvista", reason="PyVista, which draws the film, is not installed")
    from PIL import Image

    path = tmp_path / "film.webp"
    told: list[float] = []
    motion = JourneyMotion(journey_motion.track, journey_motion.bodies[:1])
    journey_film(motion, path, 40.0, lambda done, what: told.append(done))
    assert (told, told[-1]) == (sorted(told), 1.0)
    with Image.open(path) as opened:
        assert opened.size == SIZE
        # Pictures that do not differ from the one before may be kept once.
        assert 4 < opened.n_frames <= len(told)


def test_other_kinds_are_refused(journey_motion: JourneyMotion, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"allowed: a name that ends in \.html, \.mp4, \.webp, \.png, \.vtkhdf"):
        write_journey(journey_motion, tmp_path / "journey.h5")
    with pytest.raises(ValueError, match="the film lasts"):
        journey_film(journey_motion, tmp_path / "journey.mp4", 0.0)
    with pytest.raises(ValueError, match=r"allowed: a name that ends in \.mp4 or \.webp"):
        film(journey_motion.bodies[0], tmp_path / "journey.gif")


@needs_browser
def test_the_page_shows_the_touchdown_that_is_chosen(journey_motion: JourneyMotion, tmp_path: Path) -> None:
    (path,) = write_journey(journey_motion, tmp_path / "journey.html")
    with browser_page(tmp_path) as page:
        page.open(path, PHONE)
        assert page.value("touchdowns3d.view.then(Boolean)") is True
        for width in (PHONE, LAPTOP):
            page.screen(width)
            assert page.value("document.documentElement.scrollWidth") == width
        assert page.value("document.querySelectorAll('tbody tr').length") == 3
        assert page.value("document.querySelectorAll('#touchdowns-3d p option').length") == 3
        choose = "(() => { const one = document.querySelector('#touchdowns-3d select'); one.value = 'touchdown-%d';"
        choose += "one.dispatchEvent(new Event('change')); return touchdowns3d.view.then((view) => "
        choose += "[view.scene.bodyCount, view.lander()[0], Boolean(view.follows)]); })()"
        near, far = page.value(choose % 0), page.value(choose % 2)
        assert near[0] < far[0]
        assert [near[2], far[2]] == [False, True]
        assert page.value("document.querySelectorAll('#touchdowns-3d canvas').length") == 1
        assert page.complaints == []
        assert page.requests == [path.as_uri()]
