"""Inputs, outputs, outcomes and bodies by name, and numbers with intervals, as figures and sentences have them."""

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.known_bodies import PLANETS, printed_name
from lithobrake.vocabulary.material_properties import PROPERTIES, SURFACE_PROPERTIES
from lithobrake.vocabulary.number_words import at_level, interval_digits, number, percent, span
from lithobrake.vocabulary.outcomes import (
    RETURNS,
    FlightStatus,
    JourneyEnd,
    SampleOutcome,
    TouchdownOutcome,
)
from lithobrake.vocabulary.quantities import ERRORS, GROUND_KIND, GROUND_SIZE, TOUCHDOWN

if TYPE_CHECKING:
    from lithobrake.results.dispersion import RestRegion
    from lithobrake.results.run_results import VarianceParts
    from lithobrake.results.site_results import SiteResults

FAILED = "failed"

# In a figure.
SYMBOLS = {
    "speed_out": "$V^+$",
    "elevation_out": r"$\theta^+$",
    "spin_out": r"$\omega^+$",
    "velocity_out_x": "$V^+_x$",
    "velocity_out_y": "$V^+_y$",
    "velocity_out_z": "$V^+_z$",
}
# The three outputs of [Landings-PCE], in its order.
PAPER_OUTPUTS = ("speed_out", "elevation_out", "spin_out")
# An input of a part of the lander.
PART_KEY = r"lander\.part\.(?P<part>[\w-]+)\.(?P<key>\w+)"
# A number of a region with a soil of its own.
REGION_KEY = r"soil\.(?P<name>[\w-]+)\.(?P<key>grain\.\w+)"
INPUT_LABELS = {
    GROUND_SIZE: "mean diameter, grains",
    GROUND_KIND: "kind of ground",
    **{f"grain.{name}": f"{known.label}, grains" for name, known in PROPERTIES.items()},
    **{f"lander.{name}": f"{PROPERTIES[name].label}, lander" for name in SURFACE_PROPERTIES},
    "lander.mass": "mass of the lander",
    "lander.diameter": "diameter of the lander",
    ERRORS: "factor of all delivery errors",
    "impact.speed": "impact speed",
    "impact.incidence_deg": "incidence",
    "impact.azimuth_deg": "azimuth",
    "impact.place.x": "place x",
    "impact.place.y": "place y",
    "impact.spin_x": "spin about x",
    "impact.spin_y": "spin about y",
    "impact.spin_z": "spin about z",
    "site.latitude_deg": "latitude",
    "site.longitude_deg": "longitude",
    "site.heading_deg": "heading",
    "delivery.speed": "impact speed",
    "delivery.incidence_deg": "incidence",
    "delivery.latitude_deg": "latitude",
    "delivery.longitude_deg": "longitude",
    "delivery.heading_deg": "heading",
    **{
        f"delivery.{kind}offset_{way}": f"{words} {way}"
        for kind, words in (("", "offset"), ("velocity_", "velocity offset"))
        for way in ("up", "north", "east")
    },
    "aim.sides": "side down",
    "surface.gravity": "gravity",
    "surface.slope_deg": "slope",
    "surface.slope_azimuth_deg": "azimuth of the slope",
    "surface.rotation_x": "rotation of the ground about x",
    "surface.rotation_y": "rotation of the ground about y",
    "surface.rotation_z": "rotation of the ground about z",
}
FIELD_WORDS = {"young_modulus": "Young's modulus", "poisson_ratio": "Poisson's ratio"}
WHOLE_WORDS = {"impact.speed": "impact speed", GROUND_SIZE: "grain size", GROUND_KIND: "kind of ground"}
# How a run ended, beside a number.
RUN_WORDS = {outcome.value: outcome.label for outcome in TouchdownOutcome} | {FAILED: FAILED}
# How a journey ended, as short as it has to be in a legend.
END_WORDS: dict[str, str] = {end.value: end.label for end in JourneyEnd}
# What became of a landing after the first touchdown, in a table.
OUTCOME_WORDS: dict[str, str] = {
    FlightStatus.IMPACT: "impact the surface again within {limit}",
    FlightStatus.FLYING: "still flying after {limit}",
    FlightStatus.ESCAPED: FlightStatus.ESCAPED.label,
    FlightStatus.PARTNER: "impact the partner within {limit}",
    **{outcome: outcome.label for outcome in SampleOutcome if outcome != SampleOutcome.CLEAR},
    FAILED: FAILED,
    RETURNS: "return fraction (impact again, or captured where the ground holds them)",
    "missing": "unknown outcome",
}
# Beside a bar; other words of OUTCOME_WORDS are short enough.
SHORT_OUTCOME_WORDS: dict[str, str] = {
    FlightStatus.IMPACT: "impact within {limit}",
    FlightStatus.FLYING: "flying after {limit}",
    FlightStatus.PARTNER: "on the partner",
}
# Ground on which landers are followed beside that of the study.
GROUND_WORDS = {
    "hard": "hard ground", "equivalent": "hard ground like the soil", "expansion": "soil by the expansion",
}  # fmt: skip
BODIES = {"didymos": "Didymos", "dimorphos": "Dimorphos"}
# A partner that the study file gives no name.
NAMELESS = "partner"
# The parts of a variance, in the order of its bar.
PART_WORDS = {
    "soil": "soil, at least", "arrival": "delivery, at least", "attitude": "attitude, at least", "bed": "bed",
    "place": "everything else", "chaos": "chaos",
}  # fmt: skip
# What everything else holds, where there is room for it.
REMAINDER = "impact point, interactions"


@dataclass(frozen=True)
class Output:
    """An output as the page shows it: symbol in a figure, words, unit, and the factor from SI."""

    symbol: str
    words: str
    unit: str
    factor: float

    @property
    def label(self) -> str:
        """Axis label with the unit."""
        return f"{self.words} {self.symbol} [{self.unit}]".strip()


def output(name: str) -> Output:
    """How an output is shown, angles in degrees; one that is not known keeps its own name and SI value."""
    if name not in TOUCHDOWN:
        return Output("", name, "SI", 1.0)
    known = TOUCHDOWN[name]
    unit, factor = ("deg", 180.0 / math.pi) if known.units == "rad" else (known.units, 1.0)
    return Output(SYMBOLS.get(name, ""), known.title or name, unit, factor)


def input_label(name: str, unit: str = "") -> str:
    """How a design input is shown, with its unit if it has one; without an entry it keeps its dotted key in words."""
    if part := re.fullmatch(PART_KEY, name):
        own = INPUT_LABELS.get(f"lander.{part['key']}", part["key"].replace("_", " "))
        return f"{own.removesuffix(', lander')}, {part['part']}"
    if region := re.fullmatch(REGION_KEY, name):
        return f"{input_label(region['key']).removesuffix(', grains')}, {region['name']}"
    words = name.removeprefix("solver.inputs.").replace("_", " ").replace(".", ": ")
    label = INPUT_LABELS.get(name, words.removesuffix(" deg"))
    shown = re.sub(r"(\d)", r"$^\1$", unit)
    return f"{label} [{shown}]" if shown else label


def input_words(name: str) -> str:
    """An input in words, without unit: "restitution of the grains"."""
    if name in WHOLE_WORDS:
        return WHOLE_WORDS[name]
    section, _, field = name.partition(".")
    if part := re.fullmatch(PART_KEY, name):
        return f"{FIELD_WORDS.get(part['key'], part['key'].replace('_', ' '))} of {part['part']}"
    words = FIELD_WORDS.get(
        field, field.removeprefix("inputs.").removesuffix("_deg").replace("_", " ").replace(".", " ")
    )
    return words + {"grain": " of the grains", "lander": " of the lander", "impact": " at impact"}.get(section, "")


def partner_words(site: "SiteResults") -> str:
    """The other body of the binary by its name; the partner where it has none."""
    return "the partner" if site.partner in (None, NAMELESS) else printed_name(str(site.partner))


def end_words(site: "SiteResults") -> dict[str, str]:
    """As END_WORDS, with the partner by its name, as "at rest on Didymos", or "on Mars", where nothing is followed."""
    there = partner_words(site)
    return END_WORDS | {JourneyEnd.PARTNER: f"on {there}" if site.partner in PLANETS else f"at rest on {there}"}


def output_words(name: str) -> str:
    """An output, or the return fraction, in words."""
    return "return fraction" if name == RETURNS else output(name).words


def part_words(record: "VarianceParts", name: str) -> str:
    """A part in words; without auxiliary runs chaos is within everything else."""
    with_chaos = name == "place" and record.chaos is None
    return f"{PART_WORDS[name]}, chaos" if with_chaos else PART_WORDS[name]


def long_part_words(record: "VarianceParts", name: str) -> str:
    """A part in words, and what everything else holds."""
    words = part_words(record, name)
    if name != "place":
        return words
    return f"{PART_WORDS[name]} ({REMAINDER}{words.removeprefix(PART_WORDS[name])})"


def bracket(
    lower: float | None,
    upper: float | None,
    shown: Callable[[float], str] = number,
    joint: str = " to ",
    level: float | None = None,
) -> str:
    """The ends of an interval in brackets behind a blank, " (10 to 14)", or the one that is known; empty without any.

    shown: an end in words; level: the probability that the interval stands for, where it is to be named.
    """
    if lower is None and upper is None:
        return ""
    ends = [f"{words}{shown(end)}" for words, end in (("at least ", lower), ("at most ", upper)) if end is not None]
    if lower is not None and upper is not None:
        ends = [f"{shown(lower)}{joint}{shown(upper)}"]
    return f" ({'' if level is None else f'{at_level(level)} '}{ends[0]})"


def quantile(one: Estimate, size: float = 1.0) -> str:
    """A quantile with its interval in units of a size, "27 (23-32)", or with the known bound; "none" for none."""
    if not one.is_known:
        return "none"
    shown = one.on_scale(lambda value: value / size)
    return f"{two_digits(shown.value)}{bracket(shown.lower, shown.upper, two_digits, '-')}"


def two_digits(value: float) -> str:
    return number(value, 2)


def signed_points(one: Estimate) -> str:
    """A difference of shares in percentage points with its interval, "+3 (-1 to +7)"."""
    return f"{_point(one.value)}{bracket(one.lower, one.upper, _point)}"


def _point(share: float) -> str:
    return f"{100.0 * share:+.0f}"


def half_width(share: float) -> str:
    """Half the width of the interval of a share, "+- 3 %"."""
    return f"+- {percent(share)}"


def share_interval(one: Estimate) -> str:
    """The interval of a share with its level, "90 % interval 68-73 %"; empty where it has none."""
    return "" if one.bounds is None else f"{at_level(one.level)} {span(*one.bounds)}"


def bare_share(one: Estimate, alone: int = 0) -> str:
    """A share in per cent with the digits that its interval deserves, without the sign; alone: of one without any."""
    digits = alone if one.lower is None else interval_digits(one.lower, one.upper)
    return percent(one.value, digits).removesuffix(" %")


def spread(words: str, values: Iterable[float], unit: str, interval: str = "", digits: int = 3) -> str:
    """Median and middle nine tenths of a quantity; values: 5 %, median, 95 %; interval: of the median, in brackets."""
    low, middle, high = (number(value, digits) for value in values)
    return f"{words}: median {middle} {unit}{interval}; 5th to 95th percentile {low} to {high} {unit}."


def area(square_metres: float) -> str:
    """An area to two digits, "32 000 m2"."""
    rounded = float(f"{square_metres:.2g}")
    return f"{rounded:,.0f} m2".replace(",", " ") if rounded >= 10.0 else f"{rounded:g} m2"


def smallest_region(one: "RestRegion", of: str) -> str:
    """The area of the smallest region that holds a share of what it is of."""
    return f"the smallest region that holds {percent(one.share)} of {of} covers {area(one.area_m2)}"


def extent(one: "RestRegion") -> str:
    """How far apart the ends of a region are, and those of the largest of its islands."""
    words, islands = f"{two_digits(one.largest_extent_m)} m across", one.island_extents_m
    if len(islands) < 2:
        return words
    return f"{words} in {len(islands)} separate parts, the largest of which is {two_digits(islands[0])} m across"


def region(one: "RestRegion", of: str) -> str:
    """How large the smallest region is that holds a share of what it is of."""
    return f"{smallest_region(one, of)} and is {extent(one)}"
