"""Forty epochs with the times that SPICE gives them; as a program it writes spice_epochs.csv.

python -m tests.vocabulary.spice_epochs
"""

import csv
import importlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

TABLE = Path(__file__).with_suffix(".csv")
# Before and in 1972, about leap seconds, now, by the day of the year, with fractions, far ahead, in other systems.
TEXTS = """
1900-01-01T00:00:00 1930-06-15T18:30:00.5 1950-01-01T00:00:00 1958-001T12:00:00 1969-07-20T20:17:40 1970-01-01T00:00:00
1971-12-31T23:59:59.999999 1972-01-01T00:00:00 1972-06-30T23:59:59 1972-06-30T23:59:60 1972-07-01T00:00:00
1977-183T06:00:00 1998-12-31T23:59:60.25 1999-01-01T00:00:00 2000-01-01T00:00:00 2000-01-01T11:58:55.816
2000-01-01T12:00:00 2000-366T12:00:00 2005-12-31T23:59:60.999999 2012-182T23:59:60 2015-06-30T23:59:60.5
2016-12-31T23:59:50 2016-12-31T23:59:59.999999 2016-366T23:59:60 2016-12-31T23:59:60.999999 2017-01-01T00:00:00
2026-11-22T12:00:00 2027-01-20T12:00:00 2027-04-20T12:00:00.123456 2027-110T12:00:00 2027-07-20T12:00 2027-10-20
2028-366T00:00:00 2100-02-28T23:59:59.5 2400-02-29T01:02:03.000004 2999-12-31T23:59:59.999999
2027-04-20T12:00:00+02:00 2027-04-20T12:00:00_TDB 2027-04-20T12:00:00_TT 2000-01-01T12:00:00_TDB
"""
EPOCHS = TEXTS.split()
# A kernel of leap seconds with the constants of naif0012.tls.
HEAD = """KPL/LSK
\\begindata
DELTET/DELTA_T_A = 32.184
DELTET/K = 1.657D-3
DELTET/EB = 1.671D-2
DELTET/M = ( 6.239996D0 1.99096871D-7 )
"""
MONTHS = {1: "JAN", 7: "JUL"}


def leap_seconds() -> list[tuple[int, int, int]]:
    """Year, month and TAI - UTC [s] of the table that ERFA has of the IERS, from 1972 on."""
    table = importlib.import_module("erfa").leap_seconds.get()
    return [(int(year), int(month), int(offset)) for year, month, offset in table if year >= 1972]


@contextmanager
def spice_with_leap_seconds() -> Iterator[Any]:
    """NAIF's routines with these leap seconds alone."""
    spice = importlib.import_module("spiceypy")
    with TemporaryDirectory() as folder:
        path = Path(folder, "leap.tls")
        rows = [f"{offset}, @{year}-{MONTHS[month]}-1" for year, month, offset in leap_seconds()]
        path.write_text(f"{HEAD}DELTET/DELTA_AT = ( {chr(10).join(rows)} )\n\\begintext\n")
        spice.furnsh(str(path))
        try:
            yield spice
        finally:
            spice.unload(str(path))


def spice_time(spice: Any, text: str) -> float:
    """What SPICE makes of an epoch, whose system and zone it writes in its own way [s]."""
    words = text.replace("_TT", " TDT").replace("_", " ").replace("+02:00", " UTC+2")
    # With a word after it, SPICE has a blank between date and time.
    return float(spice.str2et(words.replace("T", " ", 1) if " " in words else words))


def stored() -> dict[str, float]:
    with TABLE.open(newline="", encoding="utf-8") as file:
        return {row["epoch"]: float(row["ephemeris_time_s"]) for row in csv.DictReader(file)}


if __name__ == "__main__":
    with TABLE.open("w", newline="", encoding="utf-8") as file, spice_with_leap_seconds() as spice:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("epoch", "ephemeris_time_s"))
        rows.writerows((text, repr(spice_time(spice, text))) for text in EPOCHS)
