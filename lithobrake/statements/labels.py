"""Inputs, outputs, outcomes and bodies as figures, tables and sentences name them."""

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lithobrake.vocabulary.material import PROPERTIES, SURFACE_PROPERTIES
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd, JourneyStatus, SampleOutcome, TouchdownOutcome
from lithobrake.vocabulary.quantities import TOUCHDOWN

if TYPE_CHECKING:
    from lithobrake.results.run_results import VarianceParts

FAILED = "failed"
RETURNS = "returns"

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
    **{f"grain.{name}": f"{known.label}, grains" for name, known in PROPERTIES.items()},
    **{f"lander.{name}": f"{PROPERTIES[name].label}, lander" for name in SURFACE_PROPERTIES},
    "lander.mass": "mass of the lander",
    "lander.diameter": "diameter of the lander",
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
    "aim.sides": "side down",
    "surface.gravity": "gravity",
    "surface.slope_deg": "slope",
    "surface.slope_azimuth_deg": "azimuth of the slope",
}
FIELD_WORDS = {"young_modulus": "Young's modulus", "poisson_ratio": "Poisson's ratio"}
WHOLE_WORDS = {"impact.speed": "impact speed"}
# How a run ended, beside a number.
RUN_WORDS = {outcome.value: outcome.label for outcome in TouchdownOutcome} | {FAILED: FAILED}
# How a journey ended, as short as it has to be in a legend.
END_WORDS: dict[str, str] = {end.value: end.label for end in JourneyEnd}
# What became of a landing after its first bounce, in a table.
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
# What became of a lander after all bounces, in a table.
JOURNEY_WORDS: dict[str, str] = {
    JourneyStatus.SETTLED: "at rest",
    JourneyStatus.LOFTED: "captured, then lifted off by rotation",
    JourneyStatus.OUTSIDE: "unknown outcome: impact outside the training range of the {model}, or unphysical rebound",
    "outside_too_slow": "(of these: impact slower than in any run)",
    JourneyStatus.SLIDING: "still sliding after {limit}",
    JourneyStatus.BOUNCING: "still bouncing after a thousand bounces",
    JourneyStatus.FLYING: "not at rest after {limit}",
    JourneyStatus.ESCAPED: JourneyStatus.ESCAPED.label,
    JourneyStatus.PARTNER: "on the partner",
    "slid": "(of all: slid along the ground at some time)",
}
# Beside a bar; other words of OUTCOME_WORDS are short enough.
SHORT_OUTCOME_WORDS: dict[str, str] = {
    FlightStatus.IMPACT: "impact within {limit}",
    FlightStatus.FLYING: "flying after {limit}",
    FlightStatus.PARTNER: "on the partner",
}
SHORT_JOURNEY_WORDS: dict[str, str] = {
    JourneyStatus.SETTLED: "at rest",
    JourneyStatus.LOFTED: "lifted off again",
    JourneyStatus.OUTSIDE: "unknown outcome",
    JourneyStatus.SLIDING: "still sliding",
    JourneyStatus.BOUNCING: "still bouncing",
    JourneyStatus.FLYING: "not at rest, {limit}",
    JourneyStatus.ESCAPED: JourneyStatus.ESCAPED.label,
    JourneyStatus.PARTNER: "on the partner",
}
GROUND_WORDS = {"soil": "soil", "hard": "hard ground", "equivalent": "hard ground like the soil"}
BODIES = {"didymos": "Didymos", "dimorphos": "Dimorphos"}


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


def output_words(name: str) -> str:
    """An output, or the return fraction, in words."""
    return "return fraction" if name == RETURNS else output(name).words


# The parts of a variance, in the order of its bar.
PART_WORDS = {
    "soil": "soil, at least", "arrival": "delivery, at least", "attitude": "attitude, at least", "bed": "bed",
    "place": "everything else", "chaos": "chaos",
}  # fmt: skip
# What everything else holds, where there is room for it.
REMAINDER = "impact point, interactions"


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
