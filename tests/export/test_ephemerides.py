"""Ephemerides and journeys (OEM, SPK, AEM, CZML) as the field's readers and NAIF's routines read them."""

import json
import warnings
from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lithobrake.export import ExportOptions, ephemerides, export_study
from lithobrake.export import attitudes as attitude_messages
from lithobrake.export.czml import SHOWN
from lithobrake.export.flown import Flown
from lithobrake.export.oem import Frame, Segment, epoch_texts, write_oem
from lithobrake.results import StudyResults, Table
from lithobrake.study.delivered_states import read_states
from lithobrake.vocabulary.callbacks import silent
from lithobrake.vocabulary.clock import Epoch
from lithobrake.vocabulary.plain_text import program_name
from lithobrake.vocabulary.quantities import ORIENTATION, ORIENTATION_OUT

from ..smallbody.kernels import LSK
from .delivered import ATTITUDE, EPOCH, RATES, delivered_states

oem = pytest.importorskip("oem")


def states(segment: object) -> np.ndarray:
    """Positions [m] and velocities [m/s] of a segment, [count, 6]."""
    return np.array([[*state.position, *state.velocity] for state in segment.states]) * 1e3  # type: ignore[attr-defined]


def written(results: StudyResults, folder: Path, kind: str, samples: Sequence[int] = (), **chosen: Any) -> list[Path]:
    """The files of one kind, in the place of those that are there."""
    return export_study(results, folder, [kind], ExportOptions(samples=samples, replaces=True, **chosen))


def seconds(segment: object, epoch: str) -> np.ndarray:
    """Times of a segment since an epoch [s]."""
    start = np.datetime64(epoch, "us")
    times = [np.datetime64(state.epoch.datetime, "us") for state in segment.states]  # type: ignore[attr-defined]
    return (np.array(times) - start) / np.timedelta64(1, "s")


@pytest.fixture
def no_mean(monkeypatch: pytest.MonkeyPatch) -> None:
    """Chosen flights are written alone."""
    monkeypatch.setattr(ephemerides, "FEWEST", 1000)


@pytest.mark.usefixtures("no_mean")
@pytest.mark.parametrize("frame", ["inertial", "fixed"])
def test_a_chosen_flight_ends_where_the_study_says(results: StudyResults, tmp_path: Path, frame: str) -> None:
    sample, epoch = int(results.flights["sample"][3]), "2026-11-22T12:00:00"
    written(results, tmp_path, "oem", [sample], frame=frame, epoch=epoch, step=1000.0)
    (flight,) = oem.OrbitEphemerisMessage.open(tmp_path / f"flight_{sample}.oem").segments
    assert (flight.metadata["OBJECT_NAME"], flight.metadata["CENTER_NAME"]) == (f"SAMPLE_{sample}", "DIMORPHOS")
    assert flight.metadata["REF_FRAME"] == f"DIMORPHOS_{frame.upper()}"
    end = seconds(flight, epoch)[-1]
    assert end == pytest.approx(results.flights["time_s"][3], abs=1e-6)
    x, y, z = states(flight)[-1, :3]
    turned = 2.0 * np.pi * end / results.flights["site_spin_period"][3] if frame == "inertial" else 0.0
    longitude = np.degrees((np.arctan2(y, x) - turned + np.pi) % (2.0 * np.pi) - np.pi)
    assert np.degrees(np.arctan2(z, np.hypot(x, y))) == pytest.approx(results.flights["latitude_deg"][3], abs=1e-9)
    assert longitude == pytest.approx(results.flights["longitude_deg"][3], abs=1e-6)


@pytest.mark.usefixtures("no_mean")
def test_velocities_are_those_of_the_positions(results: StudyResults, tmp_path: Path) -> None:
    """In both frames; a difference over 2 h is wrong by h^2 / 6 times the change of acceleration, some 2e-8 m/s3."""
    sample = int(results.flights["sample"][np.argmin(results.flights["time_s"])])
    for frame in ("inertial", "fixed"):
        written(results, tmp_path, "oem", [sample], frame=frame, step=20.0)
        state = states(oem.OrbitEphemerisMessage.open(tmp_path / f"flight_{sample}.oem").segments[-1])[:-1]
        slope = (state[2:, :3] - state[:-2, :3]) / 40.0
        assert slope == pytest.approx(state[1:-1, 3:], abs=3e-6)


def test_mean_and_covariance_are_those_of_the_flights_that_last(results: StudyResults, tmp_path: Path) -> None:
    written(results, tmp_path, "oem", epoch="2026-11-22T12:00:00+00:00", frame="fixed", step=100.0)
    (mean,) = oem.OrbitEphemerisMessage.open(tmp_path / "flight_mean.oem").segments
    covariances = list(mean.covariances)
    assert len(covariances) == len(list(mean.states))
    flown = Flown.of(results).at(900.0)
    assert 7 <= len(flown.sample) < 16
    # In one piece, where the file has nine: a step may be wrong by 3e-7 of the radius.
    cloud = np.concatenate([flown.position, flown.velocity], axis=1)
    assert states(mean)[9] == pytest.approx(cloud.mean(axis=0), abs=1e-4)
    assert covariances[9].matrix * 1e6 == pytest.approx(np.cov(cloud, rowvar=False), rel=1e-5, abs=1e-8)
    assert np.linalg.eigvalsh(covariances[9].matrix * 1e6).min() > 0.0
    time = seconds(mean, "2026-11-22T12:00:00")
    left = [int((results.flights["time_s"] > t).sum()) for t in (time[-1], time[-1] + 100.0)]
    assert left[0] >= 7 > left[1]


def test_a_file_without_an_epoch_says_so(results: StudyResults, tmp_path: Path) -> None:
    written(results, tmp_path, "oem", step=600.0)
    lines = (tmp_path / "flight_mean.oem").read_text().splitlines()
    comments = " ".join(line for line in lines if line.startswith("COMMENT"))
    assert "stands for no date" in comments
    assert "axes that DIMORPHOS_FIXED has at REF_FRAME_EPOCH" in comments.replace(" COMMENT", "")


@pytest.mark.parametrize(("wrong", "words"), [
    ({"samples": [10**6]}, "sample 1000000 has no flight"),
    ({"frame": "J2000"}, "allowed: inertial, fixed, icrf"),
    ({"epoch": "noon"}, "such as 2026-11-22T12:00:00"),
    ({"epoch": "9999-12-31T23:59:59"}, "of the years 1900 to 2999"),
    ({"epoch": "0001-01-01T00:00:00+05:00"}, "of the years 1900 to 2999"),
    ({"step": 0.0}, "the longest flight"),
])  # fmt: skip
def test_what_cannot_be_written_is_refused(results: StudyResults, tmp_path: Path, wrong: dict, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        written(results, tmp_path, "oem", **wrong)
    assert not list(tmp_path.iterdir())


def test_a_chosen_flight_is_written_where_too_few_fly_for_a_mean(
    delivered: StudyResults, tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All eight landers fly: a mean that needs nine is not made, and takes no flight with it."""
    monkeypatch.setattr(ephemerides, "FEWEST", 9)
    assert [path.name for path in written(delivered, tmp_path, "oem", [3], step=600.0)] == ["flight_3.oem"]
    assert [path.name for path in tmp_path.iterdir()] == ["flight_3.oem"]
    words = "8 landers have flights, and the covariance of their mean needs 9"
    assert caplog.messages == [f"flight_mean.oem is not written: {words}; raise journey.count for the mean."]
    with pytest.raises(ValueError, match=f"{words}; name single flights with --flight, or raise journey.count"):
        written(delivered, tmp_path, "oem")


def test_progress_reaches_its_end_and_large_files_are_announced(
    results: StudyResults, tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    sample = int(results.flights["sample"][0])
    told: list[tuple[float, str]] = []
    told_of = {"step": 200.0, "progress": lambda done, what: told.append((done, what))}
    written(results, tmp_path, "oem", [sample], **told_of)
    assert list(dict.fromkeys(what for _, what in told)) == ["mean of all flights", "flights of the chosen samples",
        "writing flight_mean.oem", f"writing flight_{sample}.oem"]  # fmt: skip
    assert all(0.0 <= done <= 1.0 for done, _ in told)
    assert caplog.messages == []
    monkeypatch.setattr(ephemerides, "LARGE", 1000.0)
    written(results, tmp_path, "oem", [sample], step=200.0)
    (said,) = caplog.messages
    assert said.endswith("a longer --step makes fewer.")
    size, expected = sum(path.stat().st_size for path in tmp_path.iterdir()), float(said.split()[-7])
    # Flights end one after the other, and the mean ends before the last of them does.
    assert 0.4 * expected < 1e-6 * size < 1.2 * expected


DIMORPHOS, LANDER = 120065803, -1_000_003


@pytest.mark.usefixtures("no_mean")
def test_a_message_gives_back_the_states_that_were_delivered(delivered: StudyResults, tmp_path: Path) -> None:
    oem = pytest.importorskip("oem")
    written(delivered, tmp_path, "oem", [3], frame="icrf", step=600.0)
    first = oem.OrbitEphemerisMessage.open(tmp_path / "flight_3.oem").segments[0]
    assert (first.metadata["REF_FRAME"], first.metadata["CENTER_NAME"]) == ("ICRF", "DIMORPHOS")
    state = next(iter(first.states))
    assert state.epoch.isot == "2027-04-20T12:05:00.000000"
    found = 1e3 * np.array([*state.position, *state.velocity])
    assert found == pytest.approx(delivered_states()[3, 1:7], rel=1e-9, abs=1e-9)


@pytest.mark.usefixtures("no_mean")
def test_a_message_along_icrf_delivers_the_next_study(delivered: StudyResults, tmp_path: Path) -> None:
    """What is written is what is read: the states of the first flight as those of a delivery."""
    written(delivered, tmp_path, "oem", [3], frame="icrf", step=600.0)
    read = read_states(tmp_path / "flight_3.oem", "icrf", EPOCH, ["DIMORPHOS"])
    assert read.time[0] == 300.0
    assert np.concatenate([read.position[0], read.velocity[0]]) == pytest.approx(delivered_states()[3, 1:7], abs=1e-9)


@pytest.fixture(scope="module")
def furnished(delivered: StudyResults, tmp_path_factory: pytest.TempPathFactory):  # type: ignore[no-untyped-def]
    """NAIF's routines with what was written, and leap seconds."""
    spice, folder = pytest.importorskip("spiceypy"), tmp_path_factory.mktemp("spk")
    files = written(delivered, folder, "spk", [3], step=20.0)
    (folder / "leap.tls").write_text(LSK)
    kernels = [str(path) for path in (*files, folder / "leap.tls")]
    for kernel in kernels:
        spice.furnsh(kernel)
    yield spice
    for kernel in kernels:
        spice.unload(kernel)


def test_spice_has_each_epoch_of_the_message_of_the_same_flights(furnished, delivered: StudyResults) -> None:  # type: ignore[no-untyped-def]
    """Both ends of each flight among them, whose times it turns into its own; a flight moves by 3e-8 m in 1 us."""
    axes = Frame.of(delivered, "icrf", None)
    flights = axes.timed(delivered, Flown.of(delivered).journeys(delivered, [3]))
    for segment in ephemerides.flight_segments(flights, axes, 20.0, silent)[3]:
        times = [furnished.str2et(text) for text in epoch_texts(axes.epoch, segment.time)]
        found = 1e3 * np.array([furnished.spkgeo(LANDER, time, "J2000", DIMORPHOS)[0] for time in times])
        assert found == pytest.approx(segment.state, abs=1e-6)


@pytest.mark.parametrize(("given", "name"), [
    ("67P Churyumov-Gerasimenko", "67P_CHURYUMOV_GERASI"),
    ("g_01960mm_spc_obj_dimo_0000n00000_v004", "G_01960MM_SPC_OBJ_DI"),
    ("433", "BODY_433"),
    ("小惑星", "BODY"),
    ("Ирина-2", "_2"),
])  # fmt: skip
def test_spice_takes_the_name_of_any_body(given: str, name: str, delivered: StudyResults, tmp_path: Path) -> None:
    spice = pytest.importorskip("spiceypy")
    axes = replace(Frame.of(delivered, "icrf", None), body=program_name(given))
    path = tmp_path / "body.tpc"
    path.write_text(ephemerides._constants(delivered, axes, 1_000_012, 4e4, [3]))
    spice.furnsh(str(path))
    found = spice.namfrm(f"{name}_FIXED"), spice.bodn2c(name), spice.bods2c(name)
    spice.unload(str(path))
    assert found == (1_400_012, 1_000_012, 1_000_012)


def test_a_message_counts_the_leap_second(tmp_path: Path) -> None:
    time, state = np.array([0.0, 10.5, 11.0, 59.9999996, 60.0]), np.ones((5, 6))
    start = Epoch.of("2016-12-31T23:59:50")
    write_oem(tmp_path / "a.oem", [Segment("LANDER", "ROCK", "ROCK_FIXED", time, state)], start)
    read = read_states(tmp_path / "a.oem", "body_fixed", None, ["ROCK"])
    assert read.time == pytest.approx(time, abs=5e-7)
    epochs = [line.split()[0] for line in (tmp_path / "a.oem").read_text().splitlines() if line.startswith("201")]
    assert epochs == ["2016-12-31T23:59:50.000000", "2016-12-31T23:59:60.500000", "2017-01-01T00:00:00.000000",
        "2017-01-01T00:00:49.000000", "2017-01-01T00:00:49.000000"]  # fmt: skip


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
    axes = Frame.of(delivered, "icrf", None)
    first = axes.timed(delivered, Flown.of(delivered).journeys(delivered, [3]))._rows(np.array([0])).at(410.0)
    state = axes.states(first, 410.0, first.position, first.velocity)[0]
    found = 1e3 * np.array(furnished.spkgeo(LANDER, furnished.str2et("2027-04-20T12:11:50"), "J2000", DIMORPHOS)[0])
    assert found == pytest.approx(state, abs=1e-5)


def entries(table: Table, names: Sequence[str], row: int) -> np.ndarray:
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
    (path,) = written(delivered, tmp_path, "aem", [3], frame="icrf", step=30.0)
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
        (path,) = written(delivered, tmp_path, "aem", [3], frame=name, step=300.0)
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
    from lithobrake.smallbody.bounce import impact_frame

    (path,) = written(delivered, tmp_path, "aem", [3], frame="fixed", step=300.0)
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
def test_contradictions_are_refused(delivered: StudyResults, tmp_path: Path, wrong: dict, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        written(delivered, tmp_path, "oem", **wrong)


def test_facets_of_journeys_are_refused_before_anything_is_written(delivered: StudyResults, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="leave facets out, or take geotiff or geojson"):
        export_study(delivered, tmp_path / "out", ["plates", "facets"])
    assert not (tmp_path / "out").exists()


def test_icrf_without_a_pole_and_attitudes_without_journeys_are_refused(results: StudyResults, tmp_path: Path) -> None:
    sample = int(results.flights["sample"][0])
    with pytest.raises(ValueError, match=r"has no site\.pole_right_ascension_deg"):
        written(results, tmp_path, "oem", [sample], frame="icrf", epoch=EPOCH)
    with pytest.raises(ValueError, match=r"has no site\.pole_right_ascension_deg"):
        written(results, tmp_path, "spk", [sample], epoch=EPOCH)
    with pytest.raises(ValueError, match="follows no journeys of landings"):
        written(results, tmp_path, "aem", [sample])
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def packets(delivered: StudyResults, tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    """All landers of the study, after the library has read the document."""
    czml3 = pytest.importorskip("czml3")
    with pytest.MonkeyPatch.context() as patch:
        # Between the ends of its flights, at which it is looked at, a lander is seldom shown.
        patch.setattr(attitude_messages, "STEP_ANGLE", np.radians(60.0))
        (path,) = written(delivered, tmp_path_factory.mktemp("czml"), "czml", step=600.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        document = czml3.Document.load(path)
    found: list[dict[str, Any]] = json.loads(document.dumps())
    assert len(found) == len(json.loads(path.read_text()))
    return found


def since_epoch(text: str) -> float:
    return (datetime.fromisoformat(text) - datetime.fromisoformat(f"{EPOCH}+00:00")).total_seconds()


def at(parts: list[dict[str, Any]], name: str, time: float, count: int) -> np.ndarray:
    """The sample of a property nearest to a time [s] in the last interval that holds it."""
    part = [one for one in parts if since_epoch(one["interval"].split("/")[0]) <= time + 1e-5][-1]
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
    begin, end = (since_epoch(one) for one in clock["interval"].split("/"))
    assert (begin, clock["currentTime"]) == (0.0, f"{EPOCH}.000000Z")
    assert clock["multiplier"] == pytest.approx((end - begin) / 60.0)
    for packet in packets[2:]:
        ways = [[since_epoch(one) for one in part["interval"].split("/")] for part in packet["position"]]
        assert all(before[1] == after[0] for before, after in pairwise(ways))
        rests = packet["name"].endswith(": at rest")
        assert (ways[-1][1] == pytest.approx(end, abs=1e-5)) == rests
        assert packet["point"]["color"]["rgba"] == [42, 168, 132, 255] if rests else [178, 58, 46, 255]
        assert all(part["referenceFrame"] == "FIXED" for part in packet["position"])


def test_the_body_has_its_extents(packets: list[dict[str, Any]]) -> None:
    assert packets[1]["ellipsoid"]["radii"]["cartesian"] == pytest.approx([88.5, 87.0, 58.0])


def test_flights_of_samples_are_shown_without_attitude(results: StudyResults, tmp_path: Path) -> None:
    pytest.importorskip("czml3")
    (path,) = written(results, tmp_path, "czml", step=600.0)
    found = json.loads(path.read_text())
    assert len(found) == 2 + min(SHOWN, 16)
    assert all("orientation" not in one for one in found[2:])
    assert {one["name"].split(": ")[1] for one in found[2:]} == {"impact"}
