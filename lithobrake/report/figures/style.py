"""How every figure looks: colours that colour-blind readers tell apart, one type size, names and units of outputs."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
from numpy.typing import NDArray

from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, SampleOutcome
from lithobrake.vocabulary.quantities import TOUCHDOWN

INK = "#1c2733"
QUIET = "#66717d"
RULE = "#c9ced4"
GRAIN = "#c9b699"
LANDER = "#3f83c8"
TRAINING = "#2f6fb0"
TEST = "#e2a13b"
TEST_ALL = "#8b8f96"
SITE = "#c8442b"
# Okabe and Ito's set in an order that keeps neighbours apart; grey is left to the interactions.
INPUT_COLOURS = (
    "#2f6fb0",
    "#e69f00",
    "#1f9e78",
    "#c8553d",
    "#a8659a",
    "#6fb7e0",
    "#d9cb3f",
    "#7a5c3e",
    "#31465a",
    "#98b06f",
)
INTERACTIONS = "#d5d8dc"
# One fate, one colour, on every page: how a touchdown, a flight or a journey may end.
FATE_COLOURS: dict[str, str] = {
    FlightStatus.IMPACT: "#2f6fb0",
    FlightStatus.FLYING: "#8b8f96",
    FlightStatus.ESCAPED: "#e69f00",
    FlightStatus.PARTNER: "#a8659a",
    SampleOutcome.CAPTURED: "#98b06f",
    SampleOutcome.LEFT_SIDEWAYS: "#c8553d",
    SampleOutcome.TIME_LIMIT: "#d9cb3f",
    SampleOutcome.OUTSIDE: "#7a5c3e",
    JourneyStatus.SETTLED: "#1f9e78",
    JourneyStatus.LOFTED: "#31465a",
    JourneyStatus.SLIDING: "#6fb7e0",
    JourneyStatus.BOUNCING: "#f3c9b5",
}

# Any: the names of the settings are a type of their own in some versions of matplotlib and plain words in others.
STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.edgecolor": QUIET,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": False,
    "axes.axisbelow": True,
    "grid.color": "#e6e9ec",
    "grid.linewidth": 0.6,
    "xtick.color": QUIET,
    "ytick.color": QUIET,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "text.color": INK,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "figure.dpi": 100,
    "savefig.dpi": 170,
    "mathtext.fontset": "dejavusans",
    # Names inside an SVG file are made of this and the content, not of chance.
    "svg.hashsalt": "lithobrake",
}


@dataclass(frozen=True)
class Output:
    """An output as the page shows it: symbol in a figure and in a sentence, words, unit, and the factor from SI."""

    symbol: str
    sign: str
    words: str
    unit: str
    factor: float

    @property
    def label(self) -> str:
        """Axis label with the unit."""
        return f"{self.words} {self.symbol} [{self.unit}]".strip()

    @property
    def row(self) -> str:
        """Title of a row."""
        return f"{self.words} {self.sign}".strip()


# In a figure, and in a sentence.
SYMBOLS = {
    "speed_out": ("$V^+$", "V+"),
    "elevation_out": (r"$\theta^+$", "theta+"),
    "spin_out": (r"$\omega^+$", "omega+"),
    "velocity_out_x": ("$V^+_x$", ""),
    "velocity_out_y": ("$V^+_y$", ""),
    "velocity_out_z": ("$V^+_z$", ""),
}
# The three outputs of [Landings-PCE], in its order.
PAPER_OUTPUTS = ("speed_out", "elevation_out", "spin_out")

INPUT_LABELS = {
    "grain.young_modulus": "Young's modulus $E$, grains",
    "grain.poisson_ratio": r"Poisson's ratio $\nu$, grains",
    "grain.restitution": "restitution $e$, grains",
    "grain.friction": r"friction $\mu$, grains",
    "grain.rolling_friction": "rolling friction, grains",
    "grain.spinning_friction": "spinning friction, grains",
    "grain.cohesion_force": "cohesion, grains",
    "grain.surface_energy": "surface energy, grains",
    "grain.density": r"density $\rho$, grains",
    "lander.young_modulus": "Young's modulus $E$, lander",
    "lander.poisson_ratio": r"Poisson's ratio $\nu$, lander",
    "lander.restitution": "restitution $e$, lander",
    "lander.friction": r"friction $\mu$, lander",
    "lander.rolling_friction": "rolling friction, lander",
    "lander.spinning_friction": "spinning friction, lander",
    "lander.cohesion_force": "cohesion, lander",
    "lander.surface_energy": "surface energy, lander",
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
    "surface.gravity": "gravity",
    "surface.slope_deg": "slope",
    "surface.slope_azimuth_deg": "azimuth of the slope",
}


def output(name: str) -> Output:
    """How an output is shown, angles in degrees; one that is not known keeps its own name and SI value."""
    if name not in TOUCHDOWN:
        return Output("", "", name, "SI", 1.0)
    known, (symbol, sign) = TOUCHDOWN[name], SYMBOLS.get(name, ("", ""))
    unit, factor = ("deg", 180.0 / np.pi) if known.units == "rad" else (known.units, 1.0)
    return Output(symbol, sign, known.title or name, unit, factor)


def input_label(name: str, unit: str = "") -> str:
    """How a design input is shown, with its unit if it has one; without an entry it keeps its dotted key in words."""
    words = name.removeprefix("solver.inputs.").replace("_", " ").replace(".", ": ")
    label = INPUT_LABELS.get(name, words.removesuffix(" deg"))
    shown = re.sub(r"(\d)", r"$^\1$", unit)
    return f"{label} [{shown}]" if shown else label


def input_colours(names: tuple[str, ...]) -> dict[str, str]:
    """One colour an input, the same in every figure of the page."""
    return {name: INPUT_COLOURS[index % len(INPUT_COLOURS)] for index, name in enumerate(names)}


def shade(colour: str, light: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colour times light, shape [count, 3]; light above 1 moves towards white instead of clipping to a flat patch."""
    base = np.array(matplotlib.colors.to_rgb(colour))
    dark = base[None, :] * np.minimum(light, 1.0)[:, None]
    glow = np.clip(light - 1.0, 0.0, 1.0)[:, None]
    result: NDArray[np.float64] = np.clip(dark + (1.0 - dark) * glow, 0.0, 1.0)
    return result


@contextmanager
def figure_style() -> Iterator[None]:
    """Apply the look while a figure is made; the caller's own settings of matplotlib stay untouched."""
    with matplotlib.rc_context(STYLE):
        yield
