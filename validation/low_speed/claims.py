"""What the sources of the low-speed cases say, and from where to where our number agrees: set before the first run.

Sources: [Thuillet-2021] (abstract, caption of Fig 8), [Brisset-2018] (abstract), [Wen-2025] (abstract),
[ORourke-2020] (abstract), [Negrut-2026] (the program and its comments), [Sinkage-2012] (abstract), [Brisset-2020]
(abstract, first half), [Harmon-2023] (abstract).
"""

import math
from typing import NamedTuple

ANY = math.inf


class Claim(NamedTuple):
    """A quantity of a source, in its words as short as they go; it agrees from low to high, ends included."""

    case: str
    key: str
    quantity: str
    measured: str
    low: float
    high: float

    @property
    def tolerance(self) -> str:
        """Where it agrees, in words."""
        if self.low == -ANY:
            return f"at most {self.high:g}"
        return f"at least {self.low:g}" if self.high == ANY else f"{self.low:g} to {self.high:g}"


# The least that counts as more: our numbers have five digits.
MORE = 1e-5
HALF = 0.5

CLAIMS = (
    # MASCOT on beds of 30 cm: speed out over speed in. Means and standard deviations over the same places and
    # attitudes. Noise: largest difference from the mean of landings that start 0.1 um apart.
    Claim("mascot", "noise", "change of the speed ratio by noise", "up to 0.1", -ANY, 0.1),
    Claim("mascot", "surface_mean", "boulder at the surface: mean speed ratio less that of grains", "above 0", MORE,
          ANY),
    Claim("mascot", "below_mean", "boulder below: mean speed ratio less that of grains", "above 0", MORE, ANY),
    Claim("mascot", "nearer", "mean speed ratio, boulder at the surface less below", "above 0", MORE, ANY),
    Claim("mascot", "surface_scatter", "boulder at the surface: scatter less that of grains", "above 0", MORE, ANY),
    Claim("mascot", "slope", "mean speed ratio on a slope of 20 deg less on level ground", "0", -0.1, 0.1),
    # A 2 cm ball, one soil for all gravities. Fractions of drops.
    Claim("gravities", "reduced_rebounds", "1e-2 g, 5 to 100 cm/s: fraction that rebounds", "0", -ANY, HALF - MORE),
    Claim("gravities", "reduced_ejecta", "1e-2 g, 100 cm/s: fraction with ejecta", "most", HALF + MORE, ANY),
    Claim("gravities", "micro_rebounds", "1e-5 g, 5 cm/s: fraction that rebounds", "rebounds seen", HALF, ANY),
    Claim("gravities", "micro_quiet", "1e-5 g, 5 cm/s: fraction with ejecta", "0 below 10 cm/s", -ANY, HALF - MORE),
    Claim("gravities", "micro_ejecta", "1e-5 g, 20 and 100 cm/s: fraction with ejecta", "ejecta from 10 cm/s",
          HALF + MORE, ANY),
    Claim("gravities", "ejecta_speed", "mean ejecta speed at 100 cm/s, 1e-5 g over 1e-2 g", "somewhat below 1",
          0.3, 1.0 - MORE),
    # A rigid shell, half full of grains, on a hard plane. Energy: of the common centre of mass.
    Claim("shell", "lost", "energy lost in the first bounce, flexible shell with grains", "above 0.9", 0.9, ANY),
    Claim("shell", "against_empty", "rebound speed, with grains over empty rigid shell", "far below 1", -ANY, 0.5),
    Claim("shell", "filling", "range of the loss over filling / over speed, friction or restitution of grains",
          "above 1: filling dominates", 1.0 + MORE, ANY),
    # Philae's top side into ice of a porosity of 75 %. Strength: cohesion at which the dent is 0.25 m deep.
    Claim("philae", "strength", "strength that stops Philae after 0.25 m [Pa]", "below 12", -ANY, 12.0),
    Claim("philae", "time", "time in which the dent is made [s]", "about 3", 2.25, 3.75),
    # A plate of 0.35 m pressed to 60 mm. The exponent is that of lunar soil simulants.
    Claim("plate", "exponent", "exponent of pressure over sinkage, 5 to 60 mm", "0.698 to 1.123", 0.698, 1.123),
    Claim("plate", "closed_form", "pressure at 60 mm without cohesion / bearing capacity of the closed form", "1",
          0.5, 2.0),
    Claim("plate", "cohesion", "pressure at 60 mm, cohesion 200 m/s2 / without", "above 1", 1.0 + MORE, ANY),
    Claim("plate", "looser", "solid fraction, poured with cohesion less poured without", "below 0", -ANY, -MORE),
    Claim("plate", "weaker", "pressure at 60 mm, poured with cohesion / poured without, both pressed with", "below 1",
          -ANY, 1.0 - MORE),
    # A ball on irregular grains of centimetres and of millimetres, along the normal. It rolls where it moves along the
    # surface by more than a quarter of its diameter and does not bounce. "Frequent" is read as one in five. That
    # bouncing is frequent is counted among the experiments.
    Claim("coarse", "rolls", "fraction of balls that roll along the surface", "frequent", 0.2, ANY),
    # A footpad on ice. The ground bears it where it comes no deeper than half its diameter; it lands where it also
    # stands at last, no more than half its diameter away. Slopes: both sinterings, three pads, two beds.
    Claim("footpad", "unsintered", "no sintering, level: fraction of pads that the ground bears",
          "some sintering needed", -ANY, HALF - MORE),
    Claim("footpad", "sintered", "some sintering, level: fraction of pads that the ground bears", "it bears them",
          HALF + MORE, ANY),
    Claim("footpad", "bounce", "rebound speed on level ground, much less some sintering [m/s]", "above 0", MORE, ANY),
    Claim("footpad", "safe", "15 deg: fraction that lands", "safest up to 15 deg", 0.9, ANY),
    Claim("footpad", "steep", "20 deg: fraction that lands", "in certain conditions", MORE, 1.0 - MORE),
    Claim("footpad", "hemisphere", "mean slip on slopes, hemisphere less the better of cone and disk [m]", "below 0",
          -ANY, -MORE),
)  # fmt: skip


def claims_of(case: str) -> list[Claim]:
    """Return the claims of a case, in their order."""
    return [claim for claim in CLAIMS if claim.case == case]
