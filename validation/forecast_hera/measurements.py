"""Measurements that replace assumptions of the forecast: the quantities, and the file that holds them.

A measurement is a value with one standard deviation, which stands for a normal law within the allowed range, or weights
of branches.
"""

import datetime
import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from branches import LANDERS

from lithobrake.files.reading import read_text
from lithobrake.vocabulary.plain_text import closest, show

# Force on a contact of stones of 0.2 m for each pascal of bulk cohesion by Rumpf's formula, as in priors.md [N/Pa].
CONTACT_FORCE = 0.03
# Measurements that landers were simulated with, in a copy beside them.
DRAWN = "drawn.toml"
KEYS = ("quantity", "value", "error", "unit", "weights", "lander", "date", "source")
SUM_ERROR = 1e-6  # of weights


@dataclass(frozen=True)
class Quantity:
    """What a measurement replaces.

    words: in a table; unit, lower and upper: of a value; key: of the study file; column: of landers.csv, None where all
    landers have one value; factor: that times a value gives the study file's; names: the branches that weights are of.
    of_lander: each lander has its own; of_soil: hard ground has none.
    """

    words: str
    unit: str = ""
    lower: float = 0.0
    upper: float = 1.0
    key: str = ""
    column: str | None = None
    factor: float = 1.0
    names: tuple[str, ...] = ()
    of_lander: bool = False
    of_soil: bool = False


QUANTITIES = {
    "dimorphos_mass": Quantity("mass of Dimorphos", "kg", 1e9, 1e10, "site.mass", "mass_kg"),
    "dimorphos_length_x": Quantity("length along the axis to Didymos", "m", 100.0, 300.0, "site.extents.0"),
    "dimorphos_length_y": Quantity("length along the orbit", "m", 100.0, 300.0, "site.extents.1"),
    "dimorphos_length_z": Quantity("length along the pole", "m", 50.0, 300.0, "site.extents.2"),
    "boulder_slope": Quantity(
        "cumulative slope of the boulder sizes", "1", 0.5, 6.0, "bed.diameter.cumulative_exponent", of_soil=True
    ),
    "boulder_smallest": Quantity("smallest boulder", "m", 0.05, 0.24, "bed.diameter.lower", of_soil=True),
    "grain_friction": Quantity(
        "friction of the grains", "1", 0.05, 1.2, "grain.friction", "grain_friction", of_soil=True
    ),
    "cohesion": Quantity(
        "bulk cohesion", "Pa", 1e-4, 10.0, "grain.cohesion_force", "grain_cohesion_n", CONTACT_FORCE, of_soil=True
    ),
    "lander_mass": Quantity(
        "mass of the lander", "kg", 5.0, 15.0, "lander.mass", "lander_mass", of_lander=True
    ),
    "arrival_speed": Quantity(
        "speed of a controlled arrival", "m/s", 0.005, 0.5, "delivery.speed", "speed", of_lander=True
    ),
    "arrival_angle": Quantity(
        "angle of a controlled arrival from the vertical", "deg", 0.0, 85.0, "delivery.incidence_deg",
        "incidence_deg", of_lander=True,
    ),
    # Of landers of unknown ground alone (assumptions.py); names: of the kinds of the preset.
    "ground": Quantity("ground of Dimorphos", names=("gravel", "stones", "rock"), of_soil=True),
    "rotation": Quantity("rotation of Dimorphos", names=("small libration", "large libration", "rolling")),
    "descent": Quantity("descent at small libration", names=("at the surface", "ballistic"), of_lander=True),
    "aim": Quantity("end of the long axis aimed at", names=("near end", "far end"), of_lander=True),
    # Recorded with the others; no input of the landings follows from it.
    "thermal_inertia": Quantity("thermal inertia", "J m-2 K-1 s-1/2", 1.0, 3000.0),
}  # fmt: skip


@dataclass(frozen=True)
class Measurement:
    """A measurement: value and error in the unit of its quantity, or weights by branch; lander: "" for both."""

    quantity: str
    date: datetime.date
    source: str
    value: float = math.nan
    error: float = math.nan
    weights: Mapping[str, float] | None = None
    lander: str = ""

    @property
    def of(self) -> Quantity:
        return QUANTITIES[self.quantity]

    @property
    def is_used(self) -> bool:
        """Whether an input of the landings follows from it."""
        return bool(self.of.key) or self.weights is not None

    @property
    def law(self) -> dict[str, Any]:
        """The normal law within the allowed range, as a study file has it."""
        factor = self.of.factor
        return {
            "distribution": "truncated_normal", "mean": factor * self.value, "std": factor * self.error,
            "lower": factor * self.of.lower, "upper": factor * self.of.upper,
        }  # fmt: skip

    @property
    def words(self) -> str:
        """What was measured, in a line."""
        name = f"{self.of.words}{f' ({self.lander.capitalize()})' if self.lander else ''}"
        if self.weights is not None:
            return f"{name}: {', '.join(f'{key} {100 * one:.3g} %' for key, one in self.weights.items() if one)}"
        unit = "" if self.of.unit == "1" else f" {self.of.unit}"
        size, power = (1e9, "e9") if self.value >= 1e9 else (1.0, "")
        return f"{name}: {self.value / size:.4g}{power} ± {self.error / size:.2g}{power}{unit}"


def read_measurements(path: Path) -> tuple[Measurement, ...]:
    """Those of a file. Raises ValueError, with file and number of the measurement, for what is not one."""
    try:
        tables = tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"{path} is no TOML ({error}); mend that line") from error
    given = tables.get("measurement", [])
    if set(tables) - {"measurement"} or not isinstance(given, list) or not all(isinstance(one, dict) for one in given):
        raise ValueError(f"{path} has {show(sorted(tables))}; allowed: tables [[measurement]] only; write them so")
    found: dict[tuple[str, str], Measurement] = {}
    for number, table in enumerate(given, 1):
        one = measurement_of(table, f"{path}, measurement {number}")
        # Two would have to be combined first, with their common errors.
        if (one.quantity, one.lander) in found:
            raise ValueError(f"{path}, measurement {number}: {one.quantity} is there twice; keep one of them")
        found[one.quantity, one.lander] = one
    return tuple(found.values())


def measurement_of(table: Mapping[str, Any], where: str) -> Measurement:
    for key in table:
        if key not in KEYS:
            raise ValueError(f"{where}: {show(key)} is no key{closest(key, KEYS)}; allowed: {', '.join(KEYS)}")
    name = table.get("quantity")
    if not isinstance(name, str) or name not in QUANTITIES:
        known = ", ".join(QUANTITIES)
        raise ValueError(f"{where}: quantity is {show(name)}{closest(name, QUANTITIES)}; allowed: {known}; name one")
    of, date, source = QUANTITIES[name], table.get("date"), table.get("source")
    if type(date) is not datetime.date:
        raise ValueError(f"{where}: date is {show(date)}; allowed: a date like 2027-01-20, without quotes; write it so")
    if not isinstance(source, str) or not source.strip():
        raise ValueError(f"{where}: source is {show(source)}; allowed: a text; say where the measurement is published")
    lander = _lander(table, of, f"{where}: {name}")
    if of.names:
        return Measurement(name, date, source, weights=_weights(table, of, f"{where}: {name}"), lander=lander)
    return Measurement(name, date, source, *_value(table, of, f"{where}: {name}"), lander=lander)


def _lander(table: Mapping[str, Any], of: Quantity, where: str) -> str:
    allowed = LANDERS if of.of_lander else ("",)
    lander = table.get("lander", "")
    if lander not in allowed:
        words = f"allowed: {', '.join(LANDERS)}; name one" if of.of_lander else "it is of no lander; take the key out"
        raise ValueError(f"{where} has lander {show(lander)}; {words}")
    return str(lander)


def _value(table: Mapping[str, Any], of: Quantity, where: str) -> tuple[float, float]:
    if "weights" in table:
        raise ValueError(f"{where} has weights; allowed: value and error; write these")
    if table.get("unit") != of.unit:
        raise ValueError(f"{where} has unit {show(table.get('unit'))}; allowed: {of.unit}; convert value and error")
    value, error = (table.get(key) for key in ("value", "error"))
    if not _is_number(value) or not of.lower <= value <= of.upper:
        raise ValueError(f"{where}.value is {show(value)}; allowed: {of.lower:g} to {of.upper:g} {of.unit}; change it")
    if not _is_number(error) or not 0.0 < error <= of.upper:
        raise ValueError(
            f"{where}.error is {show(error)}; allowed: above 0 and at most {of.upper:g} {of.unit}; give one standard "
            "deviation"
        )
    return float(value), float(error)


def _weights(table: Mapping[str, Any], of: Quantity, where: str) -> dict[str, float]:
    weights = table.get("weights")
    known = ", ".join(of.names)
    if {"value", "error", "unit"} & set(table) or not isinstance(weights, dict) or set(weights) != set(of.names):
        raise ValueError(f"{where} has weights {show(weights)}; allowed: weights of {known} alone; give each")
    if not all(_is_number(one) and 0.0 <= one <= 1.0 for one in weights.values()):
        raise ValueError(f"{where} has weights {show(weights)}; allowed: each from 0 to 1; change them")
    total = math.fsum(weights.values())
    if abs(total - 1.0) > SUM_ERROR:
        raise ValueError(f"{where} has weights with the sum {total:g}; allowed: a sum of 1; change them")
    return {name: float(weights[name]) for name in of.names}


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
