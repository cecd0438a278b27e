"""What a file of states is, in which axes and about which centre they are, and what they stand for."""

import bz2
import gzip
import lzma
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.files.file_kinds import FileKind, file_kind
from lithobrake.study.delivered_states import names_of_body, read_states
from lithobrake.study.impact_sections import SiteSection
from lithobrake.study.state_paths import DeliveredStates, StateSegment, orbiter_path, path_warning, paths, useable

TITLES = "time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s"
META = "META_START\nOBJECT_NAME = A\nCENTER_NAME = RYUGU\nREF_FRAME = ICRF\nTIME_SYSTEM = UTC\nMETA_STOP\n"
STATE = "2027-04-20T12:00:00 0 0.2 0 0 -5e-5 0\n"
OEM = f"CCSDS_OEM_VERS = 2.0\n{META}{STATE}"
PLY = "ply\nformat ascii 1.0\nend_header\n"
STL = "solid rock\nfacet normal 0 0 1\nouter loop\n"

KINDS: list[tuple[bytes, FileKind | None]] = [
    (OEM.encode(), FileKind.OEM),
    (f"\ufeff{OEM}".encode(), FileKind.OEM),
    (f"CREATION_DATE = 2027-01-01T00:00:00\n{META}{STATE}".encode(), FileKind.BARE_OEM),
    (b"CCSDS_OPM_VERS = 2.0\nX = 1 [km]\n", FileKind.OPM),
    (b"OBJECT_NAME = A\nX = 1\nX_DOT = 2\n", FileKind.OPM),
    (b"CCSDS_OCM_VERS = 3.0\nTRAJ_START\n", FileKind.OCM),
    (b"CCSDS_AEM_VERS = 1.0\nMETA_START\n", FileKind.AEM),
    (b"META_START\nREF_FRAME_A = ICRF\nMETA_STOP\n", FileKind.AEM),
    (b"CCSDS_XYZ_VERS = 1.0\n", FileKind.MESSAGE),
    (b'<?xml version="1.0"?>\n<oem id="CCSDS_OEM_VERS" version="2.0">', FileKind.XML_OEM),
    (b'<?xml version="1.0"?>\n<ndm><oem id="CCSDS_OEM_VERS">', FileKind.XML_OEM),
    (b"<ndm>\n<opm>", FileKind.XML_MESSAGE),
    (b"<kml>", FileKind.XML),
    (b"stk.v.11.0\nBEGIN Ephemeris\n", FileKind.STK_EPHEMERIS),
    (b"stk.v.11.0\nBEGIN Attitude\n", FileKind.STK_ATTITUDE),
    (b"KPL/PCK\n\\begindata\n", FileKind.TEXT_KERNEL),
    (b"Constants of a body\n\n\\begindata\nBODY1_PM = ( 0 1 0 )\n", FileKind.TEXT_KERNEL),
    (b"DAF/SPK \x02\x00", FileKind.BINARY_KERNEL),
    (b"DAS/DSK \x02\x00", FileKind.SHAPE_KERNEL),
    (b"# made by a tool\n\nv 1 0 0\n", FileKind.OBJ),
    (PLY.encode(), FileKind.PLY),
    (STL.encode(), FileKind.STL),
    (b"solid".ljust(80) + (1).to_bytes(4, "little") + bytes(50), FileKind.STL),
    (b'{"states": []}', FileKind.JSON),
    (b"PK\x03\x04....", FileKind.ARCHIVE),
    *((one.compress(b"CCSDS_OEM_VERS = 2.0\n"), FileKind.ARCHIVE) for one in (bz2, gzip, lzma)),
    (lzma.compress(b"CCSDS_OEM_VERS = 2.0\n", format=lzma.FORMAT_ALONE), FileKind.ARCHIVE),
    (f"{TITLES}\n0,0,200,0,0,0,0\n".encode("utf-16"), FileKind.UTF16),
    (f"{TITLES}\n0,0,200,0,0,0,0\n".encode(), None),
    (b"4 4\n1 0.1 0.2 0.3\n", None),
    (b"", None),
]


@pytest.mark.parametrize(("content", "kind"), KINDS, ids=[str(kind) + str(n) for n, (_, kind) in enumerate(KINDS)])
def test_a_file_is_recognised_by_its_content(content: bytes, kind: FileKind | None, tmp_path: Path) -> None:
    path = tmp_path / "file.csv"
    path.write_bytes(content)
    assert file_kind(path) is kind
    if kind not in (None, FileKind.OEM):
        with pytest.raises(
            ValueError, match="states are read from an OEM as keyword = value text, or from a CSV"
        ) as error:
            read_states(path, "icrf", None, ("RYUGU",))
        assert str(error.value).startswith(f"file.csv is {kind}; ")


def test_the_remedy_of_another_kind_is_its_own(tmp_path: Path) -> None:
    path = tmp_path / "states"
    for content, remedy in (
        (META, "write CCSDS_OEM_VERS = 2.0 as its first line"),
        ("X_DOT = 1", "[delivery.release]"),
    ):
        path.write_text(content)
        with pytest.raises(ValueError, match="states are read") as error:
            read_states(path, "icrf", None, ("RYUGU",))
        assert remedy in str(error.value)


@pytest.mark.parametrize("separator", [",", ";", "\t", "; "])
def test_a_table_has_one_of_three_separators(separator: str, tmp_path: Path) -> None:
    path = tmp_path / "states.csv"
    path.write_text(f"{TITLES}\n0,1.5,200,0,0,-0.05,0\n".replace(",", separator))
    found = read_states(path, "body_fixed", None, ())
    assert (found.position.tolist(), found.velocity[0, 1]) == ([[1.5, 200.0, 0.0]], -0.05)


# Of a study of Ryugu: what a message may say of axes and centre.
ALLOWED = [
    ("icrf", "EME2000", "RYUGU"), ("icrf", "icrf3", "162173 RYUGU"), ("body_fixed", "RYUGU_FIXED", "Ryugu"),
    ("body_fixed", "IAU_RYUGU", "(162173) Ryugu"), ("body_fixed", "Ryugu Body-Fixed", "2162173"),
]  # fmt: skip
REFUSED = [
    ("icrf", "RYUGU_FIXED", "RYUGU", "REF_FRAME"), ("icrf", "ECLIPJ2000", "RYUGU", "REF_FRAME"),
    ("body_fixed", "ECLIPJ2000", "RYUGU", "REF_FRAME"), ("body_fixed", "RTN", "RYUGU", "REF_FRAME"),
    ("body_fixed", "IAU_EROS", "RYUGU", "REF_FRAME"), ("body_fixed", "LVLH", "RYUGU", "REF_FRAME"),
    ("body_fixed", "ICRF", "RYUGU", 'of a delivery write delivery.frame = "icrf"'),
    ("icrf", "ICRF", "EARTH", "CENTER_NAME"), ("icrf", "ICRF", "RYUGU BARYCENTER", "CENTER_NAME"),
]  # fmt: skip


def named(path: Path, frame: str, centre: str) -> Path:
    path.write_text(OEM.replace("FRAME = ICRF", f"FRAME = {frame}").replace("RYUGU", centre, 1))
    return path


def test_axes_and_centres_are_accepted_by_what_is_known(tmp_path: Path) -> None:
    names = names_of_body(SiteSection(body="shape.obj", name="Ryugu", kernel_body="2162173"))
    assert names == ["RYUGU", "2162173"]
    for kind, frame, centre in ALLOWED:
        assert len(read_states(named(tmp_path / "a.oem", frame, centre), kind, None, names).time) == 1
    for kind, frame, centre, words in REFUSED:
        with pytest.raises(ValueError, match=r"a\.oem, line 8: (REF_FRAME|CENTER_NAME) is") as error:
            read_states(named(tmp_path / "a.oem", frame, centre), kind, None, names)
        assert words in str(error.value)


def test_a_mesh_without_a_name_has_that_of_its_file() -> None:
    assert names_of_body(SiteSection(body="models/ryugu.obj")) == ["RYUGU"]
    assert names_of_body(SiteSection(body="dimorphos")) == ["DIMORPHOS", "120065803"]


def states(
    times: list[float], segment: list[int] | None = None, *segments: StateSegment, **more: Any
) -> DeliveredStates:
    """States at 1 cm/s along x whose places are 40 m apart, or as given: of landers that have nothing in common."""
    count = len(times)
    apart = 40.0 * np.random.default_rng(2).standard_normal((count, 3))
    velocity = np.tile([0.01, 0.0, 0.0], (count, 1))
    given = {"position": apart, "velocity": velocity} | more
    return DeliveredStates(
        [f"line {row}" for row in range(count)], np.array(times), **given,
        segment=None if segment is None else np.array(segment), segments=segments or (StateSegment(),),
    )  # fmt: skip


def along(times: list[float]) -> dict[str, Any]:
    """States of a body that falls along x."""
    t = np.array(times)[:, None]
    return {"position": (0.5 * 1e-4 * t**2 + 0.02 * t) * [1.0, 0.0, 0.0] + [0.0, 100.0, 0.0],
            "velocity": (1e-4 * t + 0.02) * [1.0, 0.0, 0.0]}  # fmt: skip


A, B = StateSegment("A"), StateSegment("B")
PATH = StateSegment("A", is_path=True)
FALL = [0.0, 60.0, 120.0, 180.0]
# What states stand for: times, segments, and the paths that they lie on.
STAND_FOR: dict[str, tuple[DeliveredStates, list[int]]] = {
    "landers at one time": (states([0.0] * 4), [0, 1, 2, 3]),
    "landers one after the other": (states(FALL), [0, 1, 2, 3]),
    "one path in a table": (states(FALL, **along(FALL)), [0, 0, 0, 0]),
    "one path, backward": (states(FALL[::-1], **along(FALL[::-1])), [0, 1, 2, 3]),
    "two by chance on one line": (states(FALL[:2], **along(FALL[:2])), [0, 1]),
    "a segment to be interpolated": (states(FALL, [0] * 4, PATH), [0, 0, 0, 0]),
    "a segment without a word": (states(FALL, [0] * 4, A), [0, 1, 2, 3]),
    "a lander a segment": (states(FALL, [0, 0, 1, 1], PATH, StateSegment("B", is_path=True)), [0, 0, 1, 1]),
    "one object with a gap": (states(FALL, [0, 0, 1, 1], PATH, PATH), [0, 0, 0, 0]),
    "one name for two landers": (states([0.0, 60.0, 0.0, 60.0], [0, 0, 1, 1], PATH, PATH), [0, 0, 1, 1]),
}


@pytest.mark.parametrize(("given", "wanted"), STAND_FOR.values(), ids=STAND_FOR)
def test_states_on_one_path_are_one_delivery(given: DeliveredStates, wanted: list[int]) -> None:
    assert paths(given).tolist() == wanted
    warning = path_warning(given)
    count = len(set(wanted))
    if count == 4 or (count == 2 and len(wanted) == 2):
        assert warning is None
    else:
        assert f"the 4 landers stand for {count} deliver" in (warning or "")


def test_states_beyond_the_useable_time_are_no_landers() -> None:
    found = useable(states(FALL, [0, 0, 1, 1], StateSegment("A", end=30.0), StateSegment("B", begin=180.0)))
    assert (found.source, found.time.tolist()) == (["line 0", "line 3"], [0.0, 180.0])


WEIGHTS: dict[str, tuple[DeliveredStates, list[float], list[float]]] = {
    "half the time to either side": (states([0.0, 10.0, 40.0]), [0.0, 10.0, 40.0], [5 / 40, 20 / 40, 15 / 40]),
    "in time, whatever the order": (states([40.0, 0.0, 10.0]), [0.0, 10.0, 40.0], [5 / 40, 20 / 40, 15 / 40]),
    "a gap counts for none": (
        states([0.0, 10.0, 1000.0, 1010.0], [0, 0, 1, 1], A, A), [0.0, 10.0, 1000.0, 1010.0], [0.25] * 4),
    "segments that meet": (states([0.0, 10.0, 10.0, 20.0], [0, 0, 1, 1], A, A), [0.0, 10.0, 10.0, 20.0], [0.25] * 4),
    "within the useable time": (
        states([0.0, 10.0, 20.0, 30.0], [0] * 4, StateSegment("A", begin=8.0, end=20.0)), [0.0, 10.0, 20.0, 30.0],
        [0.0, 7 / 12, 5 / 12, 0.0]),
    "segments cut to their useable times": (
        states([0.0, 20.0, 10.0, 30.0], [0, 0, 1, 1], StateSegment("A", end=15.0), StateSegment("A", begin=15.0)),
        [0.0, 20.0, 10.0, 30.0], [10 / 30, 5 / 30, 5 / 30, 10 / 30]),
}  # fmt: skip


@pytest.mark.parametrize(("given", "time", "weight"), WEIGHTS.values(), ids=WEIGHTS)
def test_states_of_an_orbiter_stand_for_parts_of_its_time(
    given: DeliveredStates, time: list[float], weight: list[float]
) -> None:
    found, parts = orbiter_path(given)
    assert found.time.tolist() == time
    assert parts == pytest.approx(weight, abs=1e-15)


@pytest.mark.parametrize(("given", "words"), [
    (states([0.0, 0.0]), r"are all at 0 s \(2 of them\); allowed: states at two times or more"),
    (states([7.0]), r"are all at 7 s \(1 of them\)"),
    (states([0.0, 10.0, 9.0, 20.0], [0, 0, 1, 1], A, A), "two segments at one time .line 1 and line 2."),
    (states([0.0, 10.0], [0, 1], A, B), "are of A and B; allowed: those of one object"),
])  # fmt: skip
def test_states_that_are_no_path_of_an_orbiter_are_refused(given: DeliveredStates, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        orbiter_path(given)
