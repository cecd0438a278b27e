"""First contacts in files: numbers in a row, and records of an accelerometer."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lithobrake.analysis import Observation
from lithobrake.pipeline.nowcast.contact_emulator import contact_bounds
from lithobrake.pipeline.nowcast.observed_contact import checked_contact, is_record, read_contact

BOUNDS = contact_bounds(["speed_out", "spin_out", "contact_duration", "peak_acceleration"])
PEAK, LENGTH, STEP = 2.0, 0.05, 0.001


def written(folder: Path, text: str) -> Path:
    path = folder / "contact.csv"
    path.write_text(text, encoding="utf-8")
    return path


def pulse(times: np.ndarray) -> str:
    """Half a sine of acceleration from 0.1 s on, and a spin that it changes."""
    inside = (times > 0.1) & (times < 0.1 + LENGTH)
    values = np.where(inside, PEAK * np.sin(np.pi * (times - 0.1) / LENGTH), 0.0)
    rates = np.where(times < 0.12, 1.0, 6.0)
    rows = zip(times.tolist(), values.tolist(), rates.tolist(), strict=True)
    samples = "\n".join(",".join([*map(repr, row), "clear"]) for row in rows)
    return f"time [s],acceleration [m/s2],angular_rate [deg/s],outcome\n{samples}"


def changed(change: Callable[[np.ndarray], np.ndarray]) -> str:
    """The record of 0.3 s with other accelerations; change: gives them for times [sample_count]."""
    times = np.round(np.arange(0.0, 0.3, STEP), 6)
    rows = zip(times.tolist(), change(times).tolist(), strict=True)
    return "time,acceleration,outcome\n" + "\n".join(f"{time!r},{value!r},clear" for time, value in rows)


def half_sine(times: np.ndarray, begin: float, length: float = LENGTH, peak: float = PEAK) -> np.ndarray:
    return np.where((times > begin) & (times < begin + length), peak * np.sin(np.pi * (times - begin) / length), 0.0)


def test_a_record_gives_the_numbers_of_its_pulse(tmp_path: Path) -> None:
    """The integral of half a sine is its peak times its length times 2 / pi."""
    path = written(tmp_path, pulse(np.arange(0.0, 0.3, STEP)))
    assert is_record(path)
    found = read_contact(path)
    assert found.outputs["peak_acceleration"] == pytest.approx(PEAK, rel=1e-3)
    assert found.outputs["speed_change"] == pytest.approx(PEAK * LENGTH * 2.0 / math.pi, rel=0.01)
    # Below the threshold of 5 % of the peak lie 0.032 of the length.
    assert found.outputs["contact_duration"] == pytest.approx(0.968 * LENGTH, abs=2.0 * STEP)
    assert found.outputs["spin_out"] == pytest.approx(math.radians(6.0))
    assert found.errors["contact_duration"] == pytest.approx(STEP)
    assert 0.0 < found.errors["peak_acceleration"] < 0.01 * PEAK


@pytest.mark.parametrize(("change", "words"), [
    (lambda text: "time,speed\n0,1\n1,2\n", "has no column acceleration; write the columns time and acceleration"),
    (lambda text: "\n".join(text.splitlines()[:4]), "has 3 samples; allowed: at least 5"),
    (lambda text: text.replace("0.125,", "0.01,"), "goes back in time in row 126; sort its rows"),
    (lambda text: "\n".join(text.splitlines()[:121] + text.splitlines()[131:]), r"has a gap of 0\.011 s at 0\.119 s"),
    (lambda text: text.replace("[m/s2]", "[m]"), r"has acceleration in the unit \[m\]; allowed: m/s2"),
    (lambda text: text.replace("0.125,", "0.125,x"), 'for acceleration in row 126; write a number'),
    (lambda text: text.replace("0.125,", "0.125,nan,1,clear\n0.1255,"), "has nan for acceleration in row 126; leave"),
    (lambda text: "time,acceleration,outcome\n" + "\n".join(f"{k},0,clear" for k in range(9)), "no acceleration above"),
    (lambda text: text.replace(",clear", ","), "has no outcome; say in a column outcome whether the lander left the"),
    (lambda text: text.replace("clear", "captured", 1), "has captured and clear; say in a column outcome"),
    (lambda text: text.replace("clear", "time_limit"), "has time_limit; say in a column outcome"),
])  # fmt: skip
def test_a_record_that_tells_no_contact_is_refused(change: object, words: str, tmp_path: Path) -> None:
    text = pulse(np.round(np.arange(0.0, 0.3, STEP), 6))
    with pytest.raises(ValueError, match=words):
        read_contact(written(tmp_path, change(text)))  # type: ignore[operator]


@pytest.mark.parametrize(("change", "words"), [
    # Another contact 0.06 s after the end of the first, which lasted 0.05 s.
    (lambda t: half_sine(t, 0.1) + half_sine(t, 0.21, peak=1.0), r"m/s2 at 0\.212 s, above 5 % of the peak and apart"),
    (lambda t: half_sine(t, 0.21) + half_sine(t, 0.1, peak=1.0), r"m/s2 at 0\.102 s, above 5 % of the peak and apart"),
    (lambda t: half_sine(t, 0.1) + 0.15 * (np.round(t / STEP) % 60 == 7), r"has 0\.15 m/s2 at 0\.007 s, above 5 %"),
    (lambda t: half_sine(t, 0.1) + 0.2, r"begins in contact, with 0\.2 m/s2 at 0 s"),
    (lambda t: half_sine(t + 0.125, 0.1), "begins in contact, with 2 m/s2 at 0 s"),
    (lambda t: half_sine(t, 0.274), r"ends in contact, with 2 m/s2 at 0\.299 s"),
])  # fmt: skip
def test_a_record_that_is_not_of_one_whole_contact_is_refused(
    change: Callable[[np.ndarray], np.ndarray], words: str, tmp_path: Path
) -> None:
    with pytest.raises(ValueError, match=words):
        read_contact(written(tmp_path, changed(change)))


def test_touches_close_together_are_one_contact(tmp_path: Path) -> None:
    """From 0.1 s to 0.15 s and, after a quiet 0.02 s, from 0.17 s to 0.19 s: 0.09 s, less what is below 5 %."""
    path = written(tmp_path, changed(lambda t: half_sine(t, 0.1) + half_sine(t, 0.17, 0.02)))
    found = read_contact(path)
    assert found.outputs["contact_duration"] == pytest.approx(0.09, abs=3.0 * STEP)
    assert found.outputs["speed_change"] == pytest.approx(PEAK * (LENGTH + 0.02) * 2.0 / math.pi, rel=0.02)
    assert found.errors["contact_duration"] == pytest.approx(STEP)


def test_a_record_of_a_captured_lander_says_so_and_has_no_spin_after_it(tmp_path: Path) -> None:
    found = read_contact(written(tmp_path, pulse(np.arange(0.0, 0.3, STEP)).replace("clear", "captured")))
    assert found.outcome == "captured"
    assert set(found.outputs) == {"contact_duration", "peak_acceleration", "speed_change"}
    checked_contact(found, BOUNDS, "seen.csv")


def test_a_gap_beside_the_contact_does_not_count(tmp_path: Path) -> None:
    lines = pulse(np.round(np.arange(0.0, 0.3, STEP), 6)).splitlines()
    assert read_contact(written(tmp_path, "\n".join(lines[:50] + lines[80:]))).outputs["contact_duration"] > 0.0


def test_numbers_in_a_row_are_a_contact_of_their_own(tmp_path: Path) -> None:
    path = written(tmp_path, "speed_change [cm/s],contact_duration [s],error:contact_duration\n9,0.05,0.01\n")
    assert not is_record(path)
    assert read_contact(path) == Observation(
        {"speed_change": 0.09, "contact_duration": 0.05}, {"contact_duration": 0.01}
    )
    with pytest.raises(ValueError, match="has 2 bounces; where the lander rests follows from its first"):
        read_contact(written(tmp_path, "speed_out\n0.1\n0.2\n"))


@pytest.mark.parametrize(("contact", "words"), [
    (Observation({"contact_duration": -0.1}), r"seen\.csv has -0\.1 for contact_duration; allowed: 0 or more; look at"),
    (Observation({"elevation_out": 2.0}), r"has 2 for elevation_out; allowed: 0 to 1\.571"),
    (Observation({"azimuth_out": 0.1}), "has azimuth_out; outputs that may be observed: speed_out, spin_out"),
    (Observation({"speed_out": math.nan}), "has nan for speed_out"),
    (Observation({"speed_out": 0.1}, {"speed_out": -1.0}), "has -1 for error:speed_out; allowed: 0 or more"),
    (Observation({"speed_out": 0.1}, {"spin_out": 1.0}), "has 1 for error:spin_out; allowed: 0 or more, of what was"),
    (Observation({"speed_out": 0.1}, outcome="captured"), "has the outcome captured and speed_out; allowed: contact"),
    (Observation({"contact_duration": 0.1}), "has contact_duration and no outcome; say in a column outcome whether"),
    (Observation({"speed_out": 0.1}, bed="a"), "has the bed a; a nowcast is of one contact; leave the column out"),
    (Observation({}), "has neither outputs nor an outcome; give at least one: speed_out"),
])  # fmt: skip
def test_what_cannot_be_observed_is_refused(contact: Observation, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        checked_contact(contact, BOUNDS, "seen.csv")


def test_an_error_of_zero_and_a_captured_lander_are_observed() -> None:
    checked_contact(Observation({"speed_out": 0.1}, {"speed_out": 0.0}), BOUNDS, "seen.csv")
    checked_contact(Observation({}, outcome="captured"), BOUNDS, "seen.csv")
