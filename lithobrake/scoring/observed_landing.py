"""What was observed of a landing: read from a file, or one of the archive of past landings."""

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

from lithobrake.files.reading import read_text
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.plain_text import closest, show
from lithobrake.vocabulary.quantities import SIDES

ARCHIVE = "past_landings.toml"
# Numbers that are scored, with their units; each has a column of this name in a prediction.
NUMBERS = {"time_s": "s", "contacts": "", "distance": "m", "path_length": "m", "speed_ratio": ""}
ENDS = tuple(end.value for end in JourneyEnd if end is not JourneyEnd.FAILED)
PLACE = ("latitude_deg", "longitude_deg", "radius", "error")
KEYS = ("title", "source", "end", "face", "place", *NUMBERS)
_LARGEST_ERROR = 1e9


@dataclass(frozen=True)
class Measured:
    """A measurement and the standard deviation of its error, in the unit of its quantity."""

    value: float
    error: float


@dataclass(frozen=True)
class Place:
    """A place of rest: latitude and longitude (eastward, body-fixed) [deg], as a direction from the centre.

    radius [m]: of the ball on which distances between directions are measured; error [m]: standard deviation along each
    axis.
    """

    latitude_deg: float
    longitude_deg: float
    radius: float
    error: float


@dataclass(frozen=True)
class ObservedLanding:
    """Observed end of a landing; unobserved quantities are None.

    end: one of ENDS; numbers: by the names of NUMBERS; face: side of the lander that faces the ground, by its own axes;
    source: where the numbers are published.
    """

    title: str
    source: str
    end: str
    numbers: Mapping[str, Measured]
    place: Place | None = None
    face: str | None = None


def read_observation(path: Path) -> ObservedLanding:
    """Read an observation (TOML). Raises ValueError, with file and key, for what is not one."""
    return observation_of(_tables(read_text(path), str(path)), str(path))


def past_landing(name: str) -> ObservedLanding:
    """A landing of the archive by its name. Raises ValueError with the names that there are."""
    tables = archive()
    if name not in tables:
        near = closest(name, tables)
        raise ValueError(f"{show(name)} is no landing of the archive{near}; allowed: {', '.join(tables)}; name one")
    return observation_of(tables[name]["observed"], f"{ARCHIVE}, {name}")


def archive() -> dict[str, dict[str, Any]]:
    """The past landings by name: lander, body, date, approach and what was observed, as the file has them."""
    return _tables(files("lithobrake.scoring").joinpath(ARCHIVE).read_text(encoding="utf-8"), ARCHIVE)


def observation_of(table: Mapping[str, Any], where: str) -> ObservedLanding:
    """An observation out of a table. Raises ValueError with the key of what is wrong; where: the file."""
    for key in table:
        if key not in KEYS:
            near = closest(key, KEYS)
            raise ValueError(f"{where}: {show(key)} is no key{near}; allowed: {', '.join(KEYS)}; take it out")
    end = _word(table, "end", ENDS, where)
    if end is None:
        raise ValueError(f"{where}: end is missing; allowed: {', '.join(ENDS)}; say how the landing ended")
    place = None if "place" not in table else _place(table["place"], f"{where}: place")
    numbers = {name: _measured(table[name], name, where) for name in NUMBERS if name in table}
    title, source = (str(table.get(key, "")) for key in ("title", "source"))
    return ObservedLanding(title, source, end, numbers, place, _word(table, "face", SIDES, where))


def _tables(text: str, where: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"{where} is no TOML ({error}); mend that line") from error


def _word(table: Mapping[str, Any], key: str, allowed: tuple[str, ...], where: str) -> str | None:
    word = table.get(key)
    if word is not None and word not in allowed:
        raise ValueError(f"{where}: {key} is {show(word)}; allowed: {', '.join(allowed)}; change it")
    return word


def _measured(given: Any, name: str, where: str) -> Measured:
    """A number alone, or a table of value and error."""
    table = given if isinstance(given, dict) else {"value": given}
    if "value" not in table or not set(table) <= {"value", "error"}:
        raise ValueError(
            f"{where}: {name} is {show(given)}; allowed: a number, or {{ value = 663.0, error = 1.0 }} with the "
            "standard deviation of its error; write it so"
        )
    value = _number(table["value"], f"{where}: {name}", 0.0)
    return Measured(value, _number(table.get("error", 0.0), f"{where}: {name}.error", 0.0))


def _place(given: Any, where: str) -> Place:
    if not isinstance(given, dict) or set(given) != set(PLACE):
        raise ValueError(
            f"{where} is {show(given)}; allowed: a table of {', '.join(PLACE)} [deg, deg, m, m]; write all four"
        )
    least = {"latitude_deg": -90.0, "longitude_deg": -360.0, "radius": 0.0, "error": 0.0}
    most = {"latitude_deg": 90.0, "longitude_deg": 360.0}
    values = {key: _number(given[key], f"{where}.{key}", least[key], most.get(key, _LARGEST_ERROR)) for key in PLACE}
    if values["radius"] == 0.0:
        raise ValueError(f"{where}.radius is 0 m; allowed: above 0; give the mean radius of the body")
    return Place(**values)


def _number(value: Any, where: str, least: float, most: float = _LARGEST_ERROR) -> float:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if not is_number or not least <= value <= most or not math.isfinite(value):
        raise ValueError(f"{where} is {show(value)}; allowed: a number from {least:g} to {most:g}; change it")
    return float(value)
