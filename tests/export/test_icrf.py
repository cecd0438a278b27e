"""Journeys as OEM, SPK, AEM and CZML, against the states that were delivered and NAIF's routines."""

import json
import warnings
from collections.abc import Sequence
from datetime import datetime
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.export import write_attitudes, write_czml, write_ephemerides, write_spk
from lithobrake.export.czml import SHOWN
from lithobrake.results import StudyResults, Table
from lithobrake.vocabulary.quantities import ORIENTATION, ORIENTATION_OUT

from ..smallbody.kernels import LSK
from .delivered import ATTITUDE, EPOCH, RATES, delivered_states

DIMORPHOS, LANDER = 120065803, -1_000_003


def test_a_message_gives_back_the_states_that_were_delivered(delivered: StudyResults, tmp_path: Path) -> None:
    oem = pytest.importorskip("oem")
    write_ephemerides(delivered, tmp_path, [3], frame="icrf")
    first = oem.OrbitEphemerisMessage.open(tmp_path / "flight_3.oem").segments[0]
    assert (first.metadata["REF_FRAME"], first.metadata["CENTER_NAME"]) == ("ICRF", "DIMORPHOS")
    state = next(iter(first.states))
    assert state.epoch.isot == "2027-04-20T12:05:00.000000"
    found = 1e3 * np.array([*state.position, *state.velocity])
    assert found == pytest.approx(delivered_states()[3, 1:7], rel=1e-9, abs=1e-9)


def test_a_message_along_icrf_delivers_the_next_study(delivered: StudyResults, tmp_path: Path) -> None:
    """What is written is what is read: the states of the first flight as those of a delivery."""
    from lithobrake.study.delivered_states import read_states

    write_ephemerides(delivered, tmp_path, [3], frame="icrf")
    read = read_states(tmp_path / "flight_3.oem", "icrf", EPOCH, ["DIMORPHOS"])
    assert read.time[0] == 300.0
    assert np.concatenate([read.position[0], read.velocity[0]]) == pytest.approx(delivered_states()[3, 1:7], abs=1e-9)


@pytest.fixture
def furnished(delivered: StudyResults, tmp_path: Path):  # type: ignore[no-untyped-def]
    """NAIF's routines with what was written, and leap seconds."""
    spice = pytest.importorskip("spiceypy")
    pytest.importorskip("erfa")
    written = write_spk(delivered, tmp_path, [3], step=20.0)
    (tmp_path / "leap.tls").write_text(LSK)
    kernels = [str(path) for path in (*written, tmp_path / "leap.tls")]
    for kernel in kernels:
        spice.furnsh(kernel)
    yield spice
    for kernel in kernels:
        spice.unload(kernel)


def test_spice_reads_the_states_that_were_delivered(furnished) -> None:  # type: ignore[no-untyped-def]
    start = furnished.str2et("2027-04-20T12:05:00") + 1e-3
    found = 1e3 * np.array(furnished.spkgeo(LANDER, start, "J2000", DIMORPHOS)[0])
    given = delivered_states()[3, 1:7]
    # Times of SPICE are known to some microseconds; a millisecond later it is 30 um farther.
    assert found[:3] == pytest.approx(given[:3] + 1e-3 * given[3:], abs=2e-6)
    assert found[3:] == pytest.approx(given[3:], abs=1e-7)
    assert furnished.bodn2c("SAMPLE_3") == LANDER


def test_spice_turns_them_into_the_axes_of_the_body(furnished, delivered: StudyResults) -> None:  # type: ignore[no-untyped-def]
    """The constants that go with the flights take ICRF to where the journey's table has the first touchdown."""
    arcs, touchdowns = delivered.arcs, delivered.touchdowns
    flight = arcs.where((arcs["sample"] == 3) & (arcs["arc"] == 0))
    end = furnished.str2et("2027-04-20T12:05:00") - float(flight["begin_s"][0])
    found = 1e3 * np.array(furnished.spkezr("SAMPLE_3", end - 1e-3, "DIMORPHOS_FIXED", "NONE", "DIMORPHOS")[0])
    row = int(np.flatnonzero((touchdowns["journey"] == 3) & (touchdowns["touchdown"] == 0))[0])
    place, velocity = (np.array([touchdowns[f"{of}_{axis}"][row] for axis in "xyz"]) for of in ("position", "velocity"))
    assert found[:3] == pytest.approx(place - 1e-3 * velocity, abs=1e-5)
    assert found[3:] == pytest.approx(velocity, abs=1e-6)


def test_between_states_an_ephemeris_of_spice_is_the_flight(furnished, delivered: StudyResults) -> None:  # type: ignore[no-untyped-def]
    """Half a step after a state, against Hermite's polynomial of one step from exact states would be 1e-6 m."""
    from lithobrake.export.flown import Flown
    from lithobrake.export.frames import Frame

    axes = Frame.of(delivered, "icrf", None)
    first = axes.timed(delivered, Flown.of(delivered).journeys(delivered, [3]))._rows(np.array([0])).at(410.0)
    state = axes.states(first, 410.0, first.position, first.velocity)[0]
    found = 1e3 * np.array(furnished.spkgeo(LANDER, furnished.str2et("2027-04-20T12:11:50"), "J2000", DIMORPHOS)[0])
    assert found == pytest.approx(state, abs=1e-5)


def entries(table: Table, names: Sequence[str], row: int) -> np.ndarray:
    """Some numbers of a row."""
    return np.array([table[name][row] for name in names])


def attitudes(path: Path) -> list[tuple[str, np.ndarray, list[str], np.ndarray]]:
    """Of each segment the frame, quaternions x, y, z, w, and what is said; its times [s] since the epoch."""
    message = pytest.importorskip("ccsds_ndm").Aem.from_file(str(path), "kvn")
    found = []
    for segment in message.segments:
        segment.validate()
        assert segment.metadata.ref_frame_b == "SC_BODY_1"
        times = np.array([np.datetime64(one, "us") for one in segment.data.attitude_states_epochs])
        seconds = (times - np.datetime64(EPOCH, "us")) / np.timedelta64(1, "s")
        meta = segment.metadata
        found.append((meta.ref_frame_a, np.array(segment.data.attitude_states_numpy), list(meta.comment), seconds))
    return found


def test_the_attitude_that_was_delivered_is_passed_on(delivered: StudyResults, tmp_path: Path) -> None:
    """Carried to the first touchdown by the study, and from there back to its state by the message; and so its rate."""
    (path,) = write_attitudes(delivered, tmp_path, [3], frame="icrf")
    frame, quaternions, _, time = attitudes(path)[0]
    assert frame == "ICRF"
    assert time[0] == pytest.approx(300.0, abs=1e-6)
    first, second = Rotation.from_quat(quaternions[:2])
    assert (ATTITUDE.inv() * first).magnitude() < 1e-7
    # The turn of the lander about its own axes in a step, over which a rate changes little.
    turn = (first.inv() * second).as_rotvec() / (time[1] - time[0])
    assert turn == pytest.approx(RATES, abs=3e-4)


def test_a_lander_at_rest_turns_with_the_body(delivered: StudyResults, tmp_path: Path, furnished) -> None:  # type: ignore[no-untyped-def]
    """Body-fixed as the table of journeys has it; along ICRF as NAIF's routines turn that."""
    names = ("fixed", "icrf")
    known = Rotation.from_quat([delivered.journeys[f"attitude_{part}"][3] for part in "wxyz"], scalar_first=True)
    for name in names:
        (path,) = write_attitudes(delivered, tmp_path, [3], frame=name)
        frame, quaternions, said, time = attitudes(path)[-1]
        assert said == ["Sample 3: rest, over a turn of the body."]
        there = len(time) // 3
        into = np.eye(3)
        if name == "icrf":
            into = furnished.pxform("DIMORPHOS_FIXED", "J2000", furnished.str2et(EPOCH) + time[there])
        expected = Rotation.from_matrix(into) * known
        assert (expected.inv() * Rotation.from_quat(quaternions[there])).magnitude() < 1e-7, frame


def test_each_flight_begins_turned_as_the_touchdown_left_the_lander_and_ends_as_the_next_finds_it(
    delivered: StudyResults, tmp_path: Path
) -> None:
    """What a touchdown was given is the attitude at the end of the flight before, in the frame of its bed."""
    from lithobrake.smallbody import Shape
    from lithobrake.smallbody.hopping import impact_frame

    (path,) = write_attitudes(delivered, tmp_path, [3], frame="fixed")
    parts, shape = attitudes(path), Shape(*delivered.body_shape)
    table = delivered.touchdowns.where(delivered.touchdowns["journey"] == 3)
    assert len(parts) == table.row_count + 1 > 2
    for number in range(table.row_count):
        place, velocity = (
            entries(table, [f"{of}_{axis}" for axis in "xyz"], number) for of in ("position", "velocity")
        )
        axes = Rotation.from_matrix(impact_frame(velocity[None], shape.normals[[shape.nearest(place)[1]]])[0].T)
        bed = axes * Rotation.from_euler("z", -table["impact.azimuth_deg"][number], degrees=True)
        given = bed * Rotation.from_quat(entries(table, ORIENTATION, number), scalar_first=True)
        assert (given.inv() * Rotation.from_quat(parts[number][1][-1])).magnitude() < 1e-6
        if number + 1 < table.row_count:
            left = axes * Rotation.from_quat(entries(table, ORIENTATION_OUT, number), scalar_first=True)
            assert (left.inv() * Rotation.from_quat(parts[number + 1][1][0])).magnitude() < 1e-9


@pytest.mark.parametrize(("wrong", "words"), [
    ({"frame": "icrf", "epoch": EPOCH}, "leave epoch out"),
    ({"frame": "icrf", "samples": [99]}, "sample 99 has no flight"),
])  # fmt: skip
def test_contradictions_are_refused(
    delivered: StudyResults, tmp_path: Path, wrong: dict[str, object], words: str
) -> None:
    with pytest.raises(ValueError, match=words):
        write_ephemerides(delivered, tmp_path, **wrong)  # type: ignore[arg-type]


def test_icrf_without_a_pole_and_attitudes_without_journeys_are_refused(results: StudyResults, tmp_path: Path) -> None:
    sample = int(results.flights["sample"][0])
    with pytest.raises(ValueError, match=r"has no site\.pole_right_ascension_deg"):
        write_ephemerides(results, tmp_path, [sample], frame="icrf", epoch=EPOCH)
    with pytest.raises(ValueError, match=r"has no site\.pole_right_ascension_deg"):
        write_spk(results, tmp_path, [sample], epoch=EPOCH)
    with pytest.raises(ValueError, match="follows no journeys of landings"):
        write_attitudes(results, tmp_path, [sample])
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def packets(delivered: StudyResults, tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    """All landers of the study, after the library has read the document."""
    czml3 = pytest.importorskip("czml3")
    path = tmp_path_factory.mktemp("czml") / "landers.czml"
    write_czml(delivered, path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        document = czml3.Document.load(path)
    found: list[dict[str, Any]] = json.loads(document.dumps())
    assert len(found) == len(json.loads(path.read_text()))
    return found


def seconds(text: str) -> float:
    return (datetime.fromisoformat(text) - datetime.fromisoformat(f"{EPOCH}+00:00")).total_seconds()


def at(parts: list[dict[str, Any]], name: str, time: float, count: int) -> np.ndarray:
    """The sample of a property nearest to a time [s] in the last interval that holds it."""
    part = [one for one in parts if seconds(one["interval"].split("/")[0]) <= time + 1e-5][-1]
    values = np.array(part[name])
    if len(values) == count:
        return values
    table = values.reshape(-1, count + 1)
    row = int(np.argmin(np.abs(table[:, 0] - time)))
    assert table[row, 0] == pytest.approx(time, abs=1e-5)
    assert part["epoch"] == f"{EPOCH}.000000Z"
    return table[row, 1:]


def test_each_lander_is_where_and_as_the_tables_have_it(delivered: StudyResults, packets: list[dict[str, Any]]) -> None:
    """Seven come to rest; the model of one fails in its second touchdown, of which nothing is shown."""
    arcs, journeys = delivered.arcs, delivered.journeys
    assert (journeys["end"] == "at_rest").sum() == 7
    assert [one["id"] for one in packets[2:]] == [f"SAMPLE_{number}" for number in range(8)]
    for number, packet in enumerate(packets[2:]):
        own = arcs.where(arcs["sample"] == number)
        # Each lander is delivered a hundred seconds after the one before.
        shift = 100.0 * number - own["begin_s"][0]
        for row in range(own.row_count):
            place = [own[f"position_{axis}"][row] for axis in "xyz"]
            assert at(packet["position"], "cartesian", own["begin_s"][row] + shift, 3) == pytest.approx(place, abs=1e-9)
        if journeys["end"][number] != "at_rest":
            continue
        end = journeys["time_s"][number] + shift
        rest = [journeys[f"position_{axis}"][number] for axis in "xyz"]
        assert at(packet["position"], "cartesian", end, 3).tolist() == rest
        known = Rotation.from_quat([journeys[f"attitude_{part}"][number] for part in "wxyz"], scalar_first=True)
        found = Rotation.from_quat(at(packet["orientation"], "unitQuaternion", end, 4))
        assert (known.inv() * found).magnitude() < 1e-9


def test_intervals_follow_each_other_and_clock_and_colour_are_those_of_the_study(packets: list[dict[str, Any]]) -> None:
    clock = packets[0]["clock"]
    begin, end = (seconds(one) for one in clock["interval"].split("/"))
    assert (begin, clock["currentTime"]) == (0.0, f"{EPOCH}.000000Z")
    assert clock["multiplier"] == pytest.approx((end - begin) / 60.0)
    for packet in packets[2:]:
        ways = [[seconds(one) for one in part["interval"].split("/")] for part in packet["position"]]
        assert all(before[1] == after[0] for before, after in pairwise(ways))
        rests = packet["name"].endswith(": at rest")
        assert (ways[-1][1] == pytest.approx(end, abs=1e-5)) == rests
        assert packet["point"]["color"]["rgba"] == [42, 168, 132, 255] if rests else [178, 58, 46, 255]
        assert all(part["referenceFrame"] == "FIXED" for part in packet["position"])


def test_the_body_has_its_extents(packets: list[dict[str, Any]]) -> None:
    assert packets[1]["ellipsoid"]["radii"]["cartesian"] == pytest.approx([88.5, 87.0, 58.0])


def test_flights_of_samples_are_shown_without_attitude(results: StudyResults, tmp_path: Path) -> None:
    pytest.importorskip("czml3")
    write_czml(results, tmp_path / "flights.czml")
    found = json.loads((tmp_path / "flights.czml").read_text())
    assert len(found) == 2 + min(SHOWN, 16)
    assert all("orientation" not in one for one in found[2:])
    assert {one["name"].split(": ")[1] for one in found[2:]} == {"impact"}
