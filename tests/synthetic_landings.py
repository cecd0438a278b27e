"""Landings whose laws are known: five soil inputs, a place of two branches, beds, capture and a rim.

A stand-in for hundreds of real landings, to test statistics against the truth. The soil explains 0.06 of the variance
of the rebound speed (`WEAK`) or, with three times the effect and with scale and shape that change with it, 0.34
(`STRONG`); `NO_SOIL` has no effect of the soil at all. Units: m/s, rad, rad/s.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from scipy import optimize, special

from lithobrake.chaos import Distribution, LogUniform, Uniform, sobol_sequence

INPUTS: dict[str, Distribution] = {"friction": Uniform(0.3, 0.9), "restitution": Uniform(0.3, 0.9),
    "young_modulus": LogUniform(1e6, 1e8), "rolling_resistance": Uniform(0.0, 0.3),
    "density": Uniform(1500.0, 3000.0)}  # fmt: skip
OUTPUT_NAMES = ("speed_out", "elevation_out", "azimuth_out", "spin_out")
OUTCOMES = ("clear", "captured", "left_sideways")
# No lander leaves faster [m/s], or at an elevation outside 0 to this [rad].
SPEED_LIMIT, ELEVATION_LIMIT = 0.4, 0.5 * np.pi
# Standard deviations by place and bed of logit(speed / limit), logit(elevation / limit) and log(spin).
SPREADS = np.array([0.5, 0.9, 0.6])
CENTRES = special.logit(np.array([0.075 / SPEED_LIMIT, np.radians(33.0) / ELEVATION_LIMIT]))


@dataclass(frozen=True)
class Landings:
    """outcome [n]; y [n, 4], NaN where the lander did not leave clear; left [n, 4], what it would be without a rim
    (NaN only where it was captured).
    """

    outcome: np.ndarray
    y: np.ndarray
    left: np.ndarray


@dataclass(frozen=True)
class Truth:
    """One law of landings. soil: scale of its effect. rho: bed's share of the variance of logit(speed) at one soil.

    capture: share of landers that stay. skewness: of each branch of the place. branch_gap: distance of the two
    branches [standard deviations of one]; 0 makes them one, and the place's skewness the given one. rim: who leaves
    over it, so that nothing is known of them: nobody, anyone, the fast and flat, or the fast; rim_share: share of the
    landers that are not captured which do, where there is a rim. rim_returns: whether these return as others of their
    speed and elevation do, or none of them does.
    """

    soil: float = 1.0
    rho: float = 0.05
    capture: float = 0.04
    rim: Literal["none", "random", "fast_flat", "fast"] = "none"
    rim_share: float = 0.1
    rim_returns: bool = True
    skewness: float = 1.0
    branch_gap: float = 1.8

    def draw(self, x: np.ndarray, bed_effects: np.ndarray, rng: np.random.Generator) -> Landings:
        """Draw a landing at each x [n, 5] on a bed of each effect [n], standard normal over beds."""
        left = self._leaving(x, bed_effects, rng)
        captured = rng.random(len(x)) < self._capture_chance(x)
        over_the_rim = ~captured & (rng.random(len(x)) < self._rim_chance(left))
        outcome = np.where(captured, "captured", np.where(over_the_rim, "left_sideways", "clear"))
        left[captured] = np.nan
        return Landings(outcome, np.where((outcome == "clear")[:, None], left, np.nan), left)

    def study(self, run_count: int, bed_count: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Give x [n, 5], y [n, 4], outcome [n] and bed [n]: a Sobol sequence of soils on beds of equal counts."""
        rng = np.random.default_rng([seed, run_count, bed_count])
        x = sobol_sequence(INPUTS, run_count, seed=int(rng.integers(2**31)))
        blocks = -(-run_count // bed_count)
        bed = np.concatenate([rng.permutation(bed_count) for _ in range(blocks)])[:run_count]
        landings = self.draw(x, rng.standard_normal(bed_count)[bed], rng)
        return x, landings.y, landings.outcome, bed

    def conditional(self, x: np.ndarray, count: int, seed: int = 0) -> np.ndarray:
        """Draw outputs [count, 4] of landers that leave at one soil x [5], each on a bed of its own, without a rim."""
        rng = np.random.default_rng(seed)
        return self._leaving(np.tile(x, (count, 1)), rng.standard_normal(count), rng)

    def _leaving(self, x: np.ndarray, bed_effects: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Outputs [n, 4] of landers that leave, had none been captured."""
        u, root = _germs(x), np.sqrt(3.0)
        first = self._place(special.expit(-1.0 + 0.4 * self.soil * root * u[:, 0]), rng)
        second = 0.6 * rng.standard_normal(len(x)) - 0.8 * first
        scale = np.exp(self.soil * 0.08 * root * (0.8 * u[:, 1] + 0.6 * u[:, 2]))
        speed = np.sqrt(self.rho) * bed_effects + np.sqrt(1.0 - self.rho) * first
        elevation = -np.sqrt(self.rho) * bed_effects + np.sqrt(1.0 - self.rho) * second
        means = self.soil * 0.26 * np.column_stack(_soil_effects(u))
        a, b = CENTRES[:, None] + SPREADS[:2, None] * (means.T + scale * np.stack([speed, elevation]))
        spin = 0.7 * (a - CENTRES[0]) / SPREADS[0] + 0.7 * rng.standard_normal(len(x))
        return np.column_stack(
            [SPEED_LIMIT * special.expit(a), ELEVATION_LIMIT * special.expit(b), self._azimuth(u, rng),
                np.exp(SPREADS[2] * spin)]
        )  # fmt: skip

    def _place(self, second_branch: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Draw the latent of the place [n], mean 0 and variance 1 whatever the chances of the second branch [n]."""
        if self.skewness == 0.0:
            within = rng.standard_normal(len(second_branch))
        else:
            shape = 4.0 / self.skewness**2
            within = (rng.gamma(shape, size=len(second_branch)) - shape) / np.sqrt(shape)
        in_second = rng.random(len(second_branch)) < second_branch
        gap = self.branch_gap * (in_second - second_branch)
        return (within + gap) / np.sqrt(1.0 + self.branch_gap**2 * second_branch * (1.0 - second_branch))

    def _azimuth(self, u: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Draw azimuths [n]: three in ten uniform, the others wide around forward."""
        forward = 0.7 * rng.standard_normal(len(u)) + 0.1 * self.soil * u[:, 3]
        return np.angle(np.exp(1j * np.where(rng.random(len(u)) < 0.3, rng.uniform(-np.pi, np.pi, len(u)), forward)))

    def _capture_chance(self, x: np.ndarray) -> np.ndarray:
        """Chance of capture [n], of which the mean over the soils is `capture`."""
        if self.capture == 0.0:
            return np.zeros(len(x))
        slope = -0.6 * self.soil
        return special.expit(_capture_offset(self.capture, slope) + slope * _germs(x)[:, 1])

    def _rim_chance(self, left: np.ndarray) -> np.ndarray:
        """Chance of leaving over the rim [n]: of anyone, or of the fast and flat alone."""
        if self.rim == "none":
            return np.zeros(len(left))
        if self.rim == "random":
            return np.full(len(left), self.rim_share)
        return special.expit(_rim_score(self, left) - _rim_offset(self))


def returns(y: np.ndarray, outcome: np.ndarray) -> np.ndarray:
    """Chance of returning [n], smooth in speed and elevation y [n, 4]: 1 where captured, NaN where y is unknown."""
    chance = special.expit(1.0 - 21.0 * (y[:, 0] - 0.082) - 0.6 * (y[:, 1] - 0.6))
    return np.where(np.asarray(outcome) == "captured", 1.0, chance)


@lru_cache
def exact_share(truth: Truth, count: int = 1_000_000, seed: int = 20_261_122) -> float:
    """Mean chance of returning over all soils, beds and places, rim or not, from so many draws."""
    rng = np.random.default_rng(seed)
    landings = truth.draw(random_soils(count, rng), rng.standard_normal(count), rng)
    chance = returns(landings.left, landings.outcome)
    return float((chance if truth.rim_returns else chance * (landings.outcome != "left_sideways")).mean())


def random_soils(count: int, rng: np.random.Generator) -> np.ndarray:
    """Draw independent soils [count, 5]."""
    return np.column_stack([entry.ppf(rng.random(count)) for entry in INPUTS.values()])


def _germs(x: np.ndarray) -> np.ndarray:
    """Soils as numbers from -1 to 1 [n, 5]."""
    return np.column_stack([entry.germ(x[:, k]) for k, entry in enumerate(INPUTS.values())])


def _soil_effects(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means [n] of the coordinates of speed and elevation, each of mean 0 and variance 1 over the soils."""
    linear, curved = np.sqrt(3.0) * u, 0.5 * np.sqrt(5.0) * (3.0 * u**2 - 1.0)
    speed = 0.75 * linear[:, 0] + 0.4 * linear[:, 1] + 0.35 * curved[:, 0] + 0.35 * linear[:, 0] * linear[:, 2]
    elevation = -0.8 * linear[:, 1] + 0.4 * linear[:, 0] + 0.3 * curved[:, 1] + 0.3 * linear[:, 3]
    return speed / np.sqrt(0.9675), elevation / np.sqrt(0.98)


def _rim_score(truth: Truth, left: np.ndarray) -> np.ndarray:
    """How likely landers are to leave over the rim [n], by how fast, and how flat, they leave."""
    if truth.rim == "fast":
        return 30.0 * left[:, 0] / 0.08
    return 8.0 * (left[:, 0] / 0.08 - left[:, 1] / 0.6)


@lru_cache
def _capture_offset(share: float, slope: float) -> float:
    """Offset of the logit of capture that makes the mean over a uniform germ the share, by Gauss-Legendre."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    return float(
        optimize.brentq(lambda offset: 0.5 * weights @ special.expit(offset + slope * nodes) - share, -50.0, 50.0)
    )


@lru_cache
def _rim_offset(truth: Truth) -> float:
    """Offset that makes the mean chance of leaving over the rim its share, from a quarter of a million draws."""
    rng = np.random.default_rng(1)
    score = _rim_score(truth, truth._leaving(random_soils(250_000, rng), rng.standard_normal(250_000), rng))
    return float(
        optimize.brentq(lambda offset: special.expit(score - offset).mean() - truth.rim_share, score.min(), score.max())
    )


NO_SOIL, WEAK, STRONG = Truth(soil=0.0), Truth(soil=1.0), Truth(soil=3.0)
