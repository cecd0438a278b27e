"""Outputs and inputs as figures, tables and sentences name them."""

import math
import re
from dataclasses import dataclass

from lithobrake.results.run_results import VarianceParts
from lithobrake.vocabulary.material import PROPERTIES, SURFACE_PROPERTIES
from lithobrake.vocabulary.quantities import TOUCHDOWN

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


# The parts of a variance, in the order of its bar.
PART_WORDS = {
    "soil": "soil, at least", "arrival": "delivery, at least", "attitude": "attitude, at least", "bed": "bed",
    "place": "everything else", "chaos": "chaos",
}  # fmt: skip
# What everything else holds, where there is room for it.
REMAINDER = "impact point, interactions"


def part_words(record: VarianceParts, name: str) -> str:
    """A part in words; without auxiliary runs chaos is within everything else."""
    with_chaos = name == "place" and record.chaos is None
    return f"{PART_WORDS[name]}, chaos" if with_chaos else PART_WORDS[name]


def long_part_words(record: VarianceParts, name: str) -> str:
    """A part in words, and what everything else holds."""
    words = part_words(record, name)
    if name != "place":
        return words
    return f"{PART_WORDS[name]} ({REMAINDER}{words.removeprefix(PART_WORDS[name])})"
