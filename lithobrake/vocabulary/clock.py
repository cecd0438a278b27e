"""The one clock: dates of calendars as instants of atomic time, with leap seconds, and the time of SPICE.

Source: [IERS-2026] (leap seconds), [CCSDS-2009] (texts of epochs), [NAIF-2022] (TDB, and UTC before 1972)
"""

import math
import re
from bisect import bisect_right
from calendar import isleap, monthrange
from dataclasses import dataclass
from datetime import date, timedelta
from typing import Self

from lithobrake.vocabulary.plain_text import show

# TAI - UTC [s] from the beginning of each of these days on; the last second of the day before is 23:59:60. Valid until
# 28 June 2027, by Bulletin C 72 of July 2026; later dates count without a further one, as in SPICE.
LEAP_SECONDS = {
    "1972-01-01": 10, "1972-07-01": 11, "1973-01-01": 12, "1974-01-01": 13, "1975-01-01": 14, "1976-01-01": 15,
    "1977-01-01": 16, "1978-01-01": 17, "1979-01-01": 18, "1980-01-01": 19, "1981-07-01": 20, "1982-07-01": 21,
    "1983-07-01": 22, "1985-07-01": 23, "1988-01-01": 24, "1990-01-01": 25, "1991-01-01": 26, "1992-07-01": 27,
    "1993-07-01": 28, "1994-07-01": 29, "1996-01-01": 30, "1997-07-01": 31, "1999-01-01": 32, "2006-01-01": 33,
    "2009-01-01": 34, "2012-07-01": 35, "2015-07-01": 36, "2017-01-01": 37,
}  # fmt: skip
# TAI - UTC before 1972 [s], as SPICE counts it: UTC had no whole leap seconds then.
EARLIEST_OFFSET = 9
# Time systems of texts, and what is taken off their count to have TAI [s]; TDB is near TT.
SYSTEMS = {"UTC": 0.0, "TAI": 0.0, "GPS": -19.0, "TT": 32.184, "TDB": 32.184}
YEARS = (1900, 2999)
# What a message says of a text after what is wrong.
ALLOWED = f"a date and time of the years {YEARS[0]} to {YEARS[1]} such as 2026-11-22T12:00:00 or 2026-326T12:00:00"
# TDB - TT = K sin(E), E = M + EB sin(M), M = M0 + M1 TT: constants of NAIF's leapseconds kernels.
K, EB, M0, M1 = 1.657e-3, 1.671e-2, 6.239996, 1.99096871e-7
_FORM = re.compile(
    r"(?P<year>\d{4})-(?:(?P<month>\d\d)-(?P<day>\d\d)|(?P<number>\d{3}))"
    r"(?:[T ](?P<hour>\d\d):(?P<minute>\d\d)(?::(?P<second>\d\d)(?:[.,](?P<part>\d+))?)?"
    r"(?P<zone>Z|(?P<sign>[+-])(?P<hours>\d\d):?(?P<minutes>\d\d))?)?(?: (?P<system>[A-Z][A-Z0-9]*))?",
    re.ASCII,
)
_PARTS = ("year", "month", "day", "number", "hour", "minute", "second", "hours", "minutes")
_PICO = 10**12
_DAY = 86_400
# Noon of the first day of 2000, from which TAI counts.
_FIRST, _NOON = date(2000, 1, 1), _DAY // 2
_STEP_DAYS = [(date.fromisoformat(day) - _FIRST).days for day in LEAP_SECONDS]
_OFFSETS = [EARLIEST_OFFSET, *LEAP_SECONDS.values()]
_STEPS = [(day * _DAY - _NOON + offset) * _PICO for day, offset in zip(_STEP_DAYS, LEAP_SECONDS.values(), strict=True)]
# What a time may lead to [ps]: the years 4 to 8995, inside of those that texts have.
_REACH = -1997 * 365 * _DAY * _PICO, 7000 * 365 * _DAY * _PICO


@dataclass(frozen=True, order=True)
class Epoch:
    """An instant.

    tai   atomic time since 2000-01-01T12:00:00 TAI, a whole number of picoseconds
    """

    tai: int

    @classmethod
    def of(cls, text: str, system: str = "UTC") -> Self:
        """The instant of a date, 2027-04-20, or date and time, 2027-04-20T12:00:00 or 2027-110T12:00:00.25.

        After it may stand Z, an offset of UTC, +02:00, or a blank and a time system, TDB; system: of a text without
        one. Raises ValueError, with what is wrong after the name of the text, for a day, hour or second that there is
        not, and for years out of range.
        """
        found = _FORM.fullmatch(text) if isinstance(text, str) else None
        if found is None:
            raise ValueError(f"is {show(text)}; allowed: {ALLOWED}")
        parts = {name: int(found[name]) for name in _PARTS if found[name]}
        system = found["system"] or system
        if system not in SYSTEMS:
            raise ValueError(f"is {show(text)}, in the time system {system}; allowed: {', '.join(SYSTEMS)}")
        slip = _slip(parts) or ("an offset goes with UTC alone" if found["sign"] and system != "UTC" else None)
        if slip:
            raise ValueError(f"is {show(text)}, and {slip}; allowed: {ALLOWED}")
        day, minute = _day_and_minute(parts, -1 if found["sign"] == "-" else 1)
        second, of_leap = parts.get("second", 0), minute == _DAY // 60 - 1 and day + 1 in _STEP_DAYS
        if second == 60 and not (system == "UTC" and of_leap):
            raise ValueError(f"is {show(text)}, and no leap second was then; allowed there: seconds 00 to 59")
        part = int((found["part"] or "0")[:12].ljust(12, "0"))
        return cls(_tai((day * _DAY - _NOON + 60 * minute + second) * _PICO + part, day, system))

    def since(self, other: "Epoch") -> float:
        """The time from another instant to this one [s]."""
        return (self.tai - other.tai) / _PICO

    def after(self, time: float) -> "Epoch":
        """The instant so much later [s]. Raises ValueError for a time that leads out of the calendar."""
        later = self.tai + round(time * _PICO) if math.isfinite(time) and abs(time) < 1e12 else math.inf
        if not _REACH[0] < later < _REACH[1]:
            raise ValueError(f"the time is {time:g} s after {self.text(0)}; allowed: one that stays in the calendar")
        return Epoch(int(later))

    def text(self, digits: int = 6) -> str:
        """Date and time in UTC, with so many digits of the second, up to 12, to which it is rounded."""
        unit = 10 ** (12 - digits)
        tai = (2 * self.tai + unit) // (2 * unit) * unit
        later = bisect_right(_STEPS, tai)
        is_leap = later < len(_STEPS) and tai >= _STEPS[later] - _PICO
        count, part = divmod(tai - (_OFFSETS[later] + is_leap) * _PICO, _PICO)
        day, second = divmod(count + _NOON, _DAY)
        minute, second = divmod(second, 60)
        fraction = f".{part // unit:0{digits}d}" if digits else ""
        clock = f"{minute // 60:02d}:{minute % 60:02d}:{second + is_leap:02d}"
        return f"{_FIRST + timedelta(days=day)}T{clock}{fraction}"

    @property
    def ephemeris_time(self) -> float:
        """Time of SPICE: TDB since J2000 [s], as its str2et gives it."""
        time = (self.tai + round(SYSTEMS["TT"] * _PICO)) / _PICO
        return time + _periodic(time)


def named_system(text: str) -> str | None:
    """The time system that the text of an epoch ends with; None where it leaves that open."""
    found = _FORM.fullmatch(text)
    return None if found is None else found["system"] or ("UTC" if found["zone"] else None)


def _slip(parts: dict[str, int]) -> str | None:
    """What no calendar or clock has; None where all is well."""
    year, month = parts["year"], parts.get("month", 1)
    if not YEARS[0] <= year <= YEARS[1]:
        return f"the year is {year}"
    if not 1 <= month <= 12:
        return f"the month is {month:02d} of 12"
    days = monthrange(year, month)[1]
    if not 1 <= parts.get("day", 1) <= days:
        return f"{year}-{month:02d} has the days 01 to {days}"
    if not 1 <= parts.get("number", 1) <= 365 + isleap(year):
        return f"{year} has the days 001 to {365 + isleap(year)}"
    for name, most in (("hour", 23), ("minute", 59), ("second", 60), ("hours", 23), ("minutes", 59)):
        if parts.get(name, 0) > most:
            return f"the {name if name in ('hour', 'minute', 'second') else 'offset'} {parts[name]} is above {most}"
    return None


def _day_and_minute(parts: dict[str, int], sign: int) -> tuple[int, int]:
    """Days since the first of 2000, and the minute of that day, both without the offset of the zone."""
    days = (date(parts["year"], parts.get("month", 1), parts.get("day", 1)) - _FIRST).days + parts.get("number", 1) - 1
    shift = sign * (60 * parts.get("hours", 0) + parts.get("minutes", 0))
    turn, minute = divmod(60 * parts.get("hour", 0) + parts.get("minute", 0) - shift, _DAY // 60)
    return days + turn, minute


def _tai(count: int, day: int, system: str) -> int:
    """TAI [ps] of a count in a time system [ps], which is on a day since the first of 2000."""
    if system == "UTC":
        return count + _OFFSETS[bisect_right(_STEP_DAYS, day)] * _PICO
    periodic = _periodic_of_tdb(count / _PICO) if system == "TDB" else 0.0
    return count - round((SYSTEMS[system] + periodic) * _PICO)


def _periodic(time: float) -> float:
    """TDB - TT [s] at a time TT since J2000 [s]."""
    anomaly = M0 + M1 * time
    return K * math.sin(anomaly + EB * math.sin(anomaly))


def _periodic_of_tdb(time: float) -> float:
    """The same at a time TDB [s]; each round is nearer by the factor K M1."""
    found = 0.0
    for _ in range(3):
        found = _periodic(time - found)
    return found
