"""Ephemerides as the field's reader reads them, against the flights of the study."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from lithobrake.export import ephemerides, write_ephemerides
from lithobrake.export.flown import Flown
from lithobrake.results import StudyResults

oem = pytest.importorskip("oem")


def states(segment: object) -> np.ndarray:
    """Positions [m] and velocities [m/s] of a segment, [count, 6]."""
    return np.array([[*state.position, *state.velocity] for state in segment.states]) * 1e3  # type: ignore[attr-defined]


def seconds(segment: object, epoch: str) -> np.ndarray:
    """Times of a segment since an epoch [s]."""
    start = np.datetime64(epoch, "us")
    times = [np.datetime64(state.epoch.datetime, "us") for state in segment.states]  # type: ignore[attr-defined]
    return (np.array(times) - start) / np.timedelta64(1, "s")


@pytest.mark.parametrize("frame", ["inertial", "fixed"])
def test_a_chosen_flight_ends_where_the_study_says(results: StudyResults, tmp_path: Path, frame: str) -> None:
    sample, epoch = int(results.flights["sample"][3]), "2026-11-22T12:00:00"
    write_ephemerides(results, tmp_path, samples=[sample], frame=frame, epoch=epoch)
    (flight,) = oem.OrbitEphemerisMessage.open(tmp_path / f"flight_{sample}.oem").segments
    assert flight.metadata["OBJECT_NAME"] == f"SAMPLE_{sample}"
    assert flight.metadata["CENTER_NAME"] == "DIMORPHOS"
    assert flight.metadata["REF_FRAME"] == f"DIMORPHOS_{frame.upper()}"
    end = seconds(flight, epoch)[-1]
    assert end == pytest.approx(results.flights["time_s"][3], abs=1e-6)
    x, y, z = states(flight)[-1, :3]
    turned = 2.0 * np.pi * end / results.flights["site_spin_period"][3] if frame == "inertial" else 0.0
    longitude = np.degrees((np.arctan2(y, x) - turned + np.pi) % (2.0 * np.pi) - np.pi)
    assert np.degrees(np.arctan2(z, np.hypot(x, y))) == pytest.approx(results.flights["latitude_deg"][3], abs=1e-9)
    assert longitude == pytest.approx(results.flights["longitude_deg"][3], abs=1e-6)


@pytest.mark.parametrize("frame", ["inertial", "fixed"])
def test_a_sample_has_a_segment_for_each_flight_of_its_bounces(
    bouncing: StudyResults, tmp_path: Path, frame: str
) -> None:
    """A flight begins where and when the one before it ends, whatever the axes; what changes is its velocity."""
    epoch = "2026-11-22T12:00:00"
    write_ephemerides(bouncing, tmp_path, samples=[0], frame=frame, epoch=epoch)
    segments = oem.OrbitEphemerisMessage.open(tmp_path / "flight_0.oem").segments
    of_sample = bouncing.arcs["sample"] == 0
    begin, end = (bouncing.arcs[name][of_sample] for name in ("begin_s", "end_s"))
    assert len(segments) == len(begin) > 3
    for segment, first, last in zip(segments, begin, end, strict=True):
        assert seconds(segment, epoch)[[0, -1]] == pytest.approx([first, last], abs=1e-6)
        assert segment.metadata["OBJECT_NAME"] == "SAMPLE_0"
    assert bouncing.rest["time_s"][0] == pytest.approx(end[-1], abs=1e-6)
    for before, after in pairwise(segments):
        left, right = states(before)[-1], states(after)[0]
        # Flights are made again in pieces of another body's median mass, and times have whole microseconds.
        assert right[:3] == pytest.approx(left[:3], abs=1e-6)
        assert np.linalg.norm(right[3:] - left[3:]) > 1e-4
    first = states(segments[0])
    assert np.linalg.norm(first[0, :3]) == pytest.approx(
        np.linalg.norm(Flown.of(bouncing).of_samples([0]).position), abs=1e-9
    )


def test_a_sample_whose_journey_is_not_noted_has_its_first_flight(bouncing: StudyResults, tmp_path: Path) -> None:
    """As has any of a folder that an earlier version made; samples that are asked for twice stand once."""
    assert sorted(set(bouncing.arcs["sample"].tolist())) == [0.0, 1.0, 2.0]
    write_ephemerides(bouncing, tmp_path, samples=[3, 3, 1])
    (segment,) = oem.OrbitEphemerisMessage.open(tmp_path / "flight_3.oem").segments
    row = int(np.flatnonzero(bouncing.flights["sample"] == 3)[0])
    assert seconds(segment, "2000-01-01T12:00:00")[-1] == pytest.approx(bouncing.flights["time_s"][row], abs=1e-6)
    assert "Flight 1 of 1 that are known of sample 3" in (tmp_path / "flight_3.oem").read_text()
    assert len(oem.OrbitEphemerisMessage.open(tmp_path / "flight_1.oem").segments) > 1


def test_velocities_are_those_of_the_positions(results: StudyResults, tmp_path: Path) -> None:
    """In both frames; a difference over 2 h is wrong by h^2 / 6 times the change of acceleration, some 2e-8 m/s3."""
    sample = int(results.flights["sample"][0])
    for frame in ("inertial", "fixed"):
        write_ephemerides(results, tmp_path, samples=[sample], frame=frame, step=20.0)
        state = states(oem.OrbitEphemerisMessage.open(tmp_path / f"flight_{sample}.oem").segments[-1])[:-1]
        slope = (state[2:, :3] - state[:-2, :3]) / 40.0
        assert slope == pytest.approx(state[1:-1, 3:], abs=3e-6)


def test_mean_and_covariance_are_those_of_the_flights_that_last(results: StudyResults, tmp_path: Path) -> None:
    write_ephemerides(results, tmp_path, epoch="2026-11-22T12:00:00+00:00", frame="fixed", step=100.0)
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
    write_ephemerides(results, tmp_path)
    comments = " ".join(
        line for line in (tmp_path / "flight_mean.oem").read_text().splitlines() if line.startswith("COMMENT")
    )
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
def test_what_cannot_be_written_is_refused(
    results: StudyResults, tmp_path: Path, wrong: dict[str, object], words: str
) -> None:
    with pytest.raises(ValueError, match=words):
        write_ephemerides(results, tmp_path, **wrong)  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())


def test_progress_reaches_its_end_and_large_files_are_announced(
    results: StudyResults, tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    sample = int(results.flights["sample"][0])
    told: list[tuple[float, str]] = []
    write_ephemerides(results, tmp_path, [sample], progress=lambda done, what: told.append((done, what)))
    assert list(dict.fromkeys(what for _, what in told)) == [
        "mean of all flights",
        "flights of the chosen samples",
        "writing flight_mean.oem",
        f"writing flight_{sample}.oem",
    ]
    assert all(0.0 <= done <= 1.0 for done, _ in told)
    assert caplog.messages == []
    monkeypatch.setattr(ephemerides, "LARGE", 1000.0)
    write_ephemerides(results, tmp_path, [sample])
    (said,) = caplog.messages
    assert said.endswith("a longer --step makes fewer.")
    size, expected = sum(path.stat().st_size for path in tmp_path.iterdir()), float(said.split()[-7])
    # Flights end one after the other, and the mean ends before the last of them does.
    assert 0.4 * expected < 1e-6 * size < 1.2 * expected
