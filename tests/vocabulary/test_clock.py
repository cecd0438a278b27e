"""The one clock against SPICE and the leap seconds of ERFA, the calendar, and texts there and back."""

import importlib.util

import pytest

from lithobrake.vocabulary.clock import LEAP_SECONDS, Epoch

from .spice_epochs import EPOCHS, leap_seconds, spice_time, spice_with_leap_seconds, stored

BEFORE = Epoch.of("2016-12-31T23:59:50")


def test_forty_epochs_are_those_of_spice() -> None:
    table = stored()
    assert (list(table), len(table)) == (EPOCHS, 40)
    for text, time in table.items():
        found = Epoch.of(text.replace("_", " ")).ephemeris_time
        assert found == pytest.approx(time, rel=0.0, abs=1e-6), text


@pytest.mark.skipif(not all(map(importlib.util.find_spec, ("spiceypy", "erfa"))), reason="needs lithobrake[spice]")
def test_what_is_stored_is_what_spice_gives_by_the_leap_seconds_of_erfa() -> None:
    with spice_with_leap_seconds() as spice:
        assert {text: spice_time(spice, text) for text in EPOCHS} == pytest.approx(stored(), rel=0.0, abs=1e-6)
    assert {f"{year}-{month:02d}-01": offset for year, month, offset in leap_seconds()} == LEAP_SECONDS


@pytest.mark.parametrize(("text", "written"), [
    ("2016-12-31T23:59:60", "2016-12-31T23:59:60.000000"),
    ("2017-01-01T01:59:60.5+02:00", "2016-12-31T23:59:60.500000"),
    ("2016-12-31T14:29:60-09:30", "2016-12-31T23:59:60.000000"),
    ("2016-366T23:59:59.9999999", "2016-12-31T23:59:60.000000"),
    ("2016-12-31T23:59:60.9999996", "2017-01-01T00:00:00.000000"),
    ("2027-12-31T23:59:59.9999999Z", "2028-01-01T00:00:00.000000"),
    ("2027-04-20T12:00:59.9999994", "2027-04-20T12:00:59.999999"),
    ("2027-04-20T12:01:09.184 TT", "2027-04-20T12:00:00.000000"),
    ("2027-04-20T12:00:37 TAI", "2027-04-20T12:00:00.000000"),
    ("2027-04-20T12:00:18 GPS", "2027-04-20T12:00:00.000000"),
    ("2027-04-20T00:30:00.1234567890123456789+0100", "2027-04-19T23:30:00.123457"),
    ("2027-04-20T00:30:00+01:00", "2027-04-19T23:30:00.000000"),
    ("2027-04-20", "2027-04-20T00:00:00.000000"),
    ("2027-110 12:00", "2027-04-20T12:00:00.000000"),
])  # fmt: skip
def test_texts_are_read_and_written_in_utc(text: str, written: str) -> None:
    assert Epoch.of(text).text() == written
    assert Epoch.of(written).text() == written


def test_a_leap_second_lasts_a_second() -> None:
    assert [BEFORE.after(time).text(1)[11:] for time in (9.0, 10.0, 10.96, 11.0)] == [
        "23:59:59.0", "23:59:60.0", "00:00:00.0", "00:00:00.0",
    ]  # fmt: skip
    assert Epoch.of("2017-01-01T00:00:10").since(BEFORE) == 21.0
    assert Epoch.of("2017-01-01T00:00:10", "TAI").since(Epoch.of("2016-12-31T23:59:50", "TAI")) == 20.0


@pytest.mark.parametrize(("text", "words"), [
    ("2027-366T00:00:00", "2027 has the days 001 to 365"),
    ("2028-367T00:00:00", "2028 has the days 001 to 366"),
    ("2027-000T00:00:00", "2027 has the days 001 to 365"),
    ("2027-1T00:00:00", "allowed: a date and time of the years 1900 to 2999"),
    ("2027-02-29T00:00:00", "2027-02 has the days 01 to 28"),
    ("2027-13-01T00:00:00", "the month is 13 of 12"),
    ("2027-04-20T24:00:00", "the hour 24 is above 23"),
    ("2027-04-20T12:60:00", "the minute 60 is above 59"),
    ("2027-04-20T12:00:61", "the second 61 is above 60"),
    ("2027-06-30T23:59:60", "no leap second was then; allowed there: seconds 00 to 59"),
    ("2016-12-31T22:59:60", "no leap second was then"),
    ("2016-12-31T23:59:60 TAI", "no leap second was then"),
    ("2027-04-20T12:00:00+02:00 TDB", "an offset goes with UTC alone"),
    ("2027-04-20T12:00:00+24:00", "the offset 24 is above 23"),
    ("2027-04-20T12:00:00 UT1", "in the time system UT1; allowed: UTC, TAI, GPS, TT, TDB"),
    ("0001-01-01T00:00:00+05:00", "the year is 1; allowed: a date and time of the years 1900 to 2999"),
    ("٢٠٢٧-04-20", "allowed: a date and time"),
    (None, "is None; allowed: a date and time"),
    ("noon", "such as 2026-11-22T12:00:00 or 2026-326T12:00:00"),
])  # fmt: skip
def test_what_no_calendar_has_is_refused(text: str, words: str) -> None:
    with pytest.raises(ValueError, match=r"^is ") as refused:
        Epoch.of(text)
    assert words in str(refused.value)


@pytest.mark.parametrize("time", [float("nan"), float("inf"), 1e300, -1e300, 3e11])
def test_a_time_that_leads_out_of_the_calendar_is_refused(time: float) -> None:
    with pytest.raises(ValueError, match=r"the time is .* s after 2016-12-31T23:59:50; allowed: "):
        BEFORE.after(time)
