"""How every figure looks: colours that colour-blind readers tell apart, one type size, names and units of outputs."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
from numpy.typing import NDArray

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
}


@dataclass(frozen=True)
class Output:
    """An output as a figure shows it: symbol, words, unit, and the factor from SI to that unit."""

    symbol: str
    words: str
    unit: str
    factor: float

    @property
    def label(self) -> str:
        """Axis label with the unit."""
        return f"{self.words} {self.symbol} [{self.unit}]"


OUTPUTS = {
    "speed_out": Output("$V^+$", "outgoing speed", "m/s", 1.0),
    "elevation_out": Output(r"$\theta^+$", "elevation", "deg", 180.0 / np.pi),
    "spin_out": Output(r"$\omega^+$", "spin", "rad/s", 1.0),
    "velocity_out_x": Output("$V^+_x$", "velocity along", "m/s", 1.0),
    "velocity_out_y": Output("$V^+_y$", "velocity across", "m/s", 1.0),
    "velocity_out_z": Output("$V^+_z$", "velocity up", "m/s", 1.0),
}
# The three outputs of [Landings-PCE], in its order.
PAPER_OUTPUTS = ("speed_out", "elevation_out", "spin_out")

INPUT_LABELS = {
    "grain.young_modulus": "Young's modulus $E$, grains [Pa]",
    "grain.poisson_ratio": r"Poisson's ratio $\nu$, grains",
    "grain.restitution": "restitution $e$, grains",
    "grain.friction": r"friction $\mu$, grains",
    "grain.rolling_friction": "rolling friction, grains",
    "grain.spinning_friction": "spinning friction, grains",
    "grain.cohesion_force": "cohesion, grains [N]",
    "grain.surface_energy": "surface energy, grains [J/m$^2$]",
    "grain.density": r"density $\rho$, grains [kg/m$^3$]",
    "lander.young_modulus": "Young's modulus $E$, lander [Pa]",
    "lander.poisson_ratio": r"Poisson's ratio $\nu$, lander",
    "lander.restitution": "restitution $e$, lander",
    "lander.friction": r"friction $\mu$, lander",
    "lander.rolling_friction": "rolling friction, lander",
    "lander.spinning_friction": "spinning friction, lander",
    "lander.cohesion_force": "cohesion, lander [N]",
    "lander.surface_energy": "surface energy, lander [J/m$^2$]",
    "lander.mass": "mass of the lander [kg]",
    "lander.diameter": "diameter of the lander [m]",
    "impact.speed": "impact speed [m/s]",
    "impact.incidence_deg": "incidence [deg]",
    "impact.azimuth_deg": "azimuth [deg]",
    "impact.place.x": "place x [m]",
    "impact.place.y": "place y [m]",
    "impact.spin_x": "spin about x [rad/s]",
    "impact.spin_y": "spin about y [rad/s]",
    "impact.spin_z": "spin about z [rad/s]",
    "surface.gravity": "gravity [m/s$^2$]",
    "surface.slope_deg": "slope [deg]",
    "surface.slope_azimuth_deg": "azimuth of the slope [deg]",
}


def output(name: str) -> Output:
    """How an output is shown; one that has no entry keeps its own name and SI value."""
    return OUTPUTS.get(name, Output(name, "", "SI", 1.0))


def input_label(name: str, with_unit: bool = True) -> str:
    """How a design input is shown; one that has no entry keeps its dotted key in words."""
    label = INPUT_LABELS.get(name)
    if label is None:
        words = name.removeprefix("solver.inputs.").replace("_", " ").replace(".", ": ")
        label = f"{words.removesuffix(' deg')} [deg]" if words.endswith(" deg") else words
    return label if with_unit else label.split(" [")[0]


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
