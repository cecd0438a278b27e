"""Stochastic models whose laws are known, for comparisons of emulators: eight of them, and six published ones.

Inputs of the eight are uniform between -1 and 1; runs come in groups of ten that share a normal effect. Each law says
what it is, so that another program can be measured against it.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lithobrake.chaos import Distribution, Normal, Uniform, latin_hypercube

GROUP_SIZE = 10
# Of an output's own deviation: what the runs of a group share.
GROUP_EFFECT = 0.1
HESTON_STEPS = 250
# Of the epidemic.
PEOPLE = 2000.0
PATIENTS: dict[str, Distribution] = {"susceptible": Uniform(1200.0, 1800.0), "infected": Uniform(20.0, 200.0)}
Sampled = Callable[[np.ndarray, np.random.Generator], np.ndarray]


@dataclass(frozen=True)
class Case:
    """A model: outputs at x [count, input_count], [count, output_count]; capture: chance [count] of having none.

    shared: deviation of what a group shares, by its unit. lower: bound of all outputs; none where infinite.
    """

    inputs: dict[str, Distribution]
    outputs: Sampled
    shared: float = 0.0
    capture: Callable[[np.ndarray], np.ndarray] | None = None
    lower: float = -np.inf

    def study(self, count: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Runs at a Latin hypercube: x, y [count, output_count] with NaN where captured, and group [count]."""
        x, random = latin_hypercube(self.inputs, count, seed=seed), np.random.default_rng([seed, count])
        group = random.permutation(np.arange(count) // GROUP_SIZE) if self.shared else np.arange(count)
        y = self.outputs(x, random)
        y += self.shared * random.standard_normal((count, y.shape[1]))[group]
        if self.capture is not None:
            y[random.random(count) < self.capture(x)] = np.nan
        return x, y, group

    def conditional(self, x: np.ndarray, count: int, seed: int) -> np.ndarray:
        """Outputs of runs that have some, each of a group of its own, [point_count, count, output_count]."""
        random = np.random.default_rng([seed, 1])
        y = self.outputs(np.repeat(x, count, axis=0), random)
        y += self.shared * random.standard_normal(y.shape)
        return y.reshape(len(x), count, -1)


def two_branches(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Branches at +-1.5, the upper one by the odds exp(3 x0): 0.5 x1 +- 1.5 + 0.3 N."""
    upper = random.random(len(x)) < 1.0 / (1.0 + np.exp(-3.0 * x[:, 0]))
    return (0.5 * x[:, 1] + np.where(upper, 1.5, -1.5) + 0.3 * random.standard_normal(len(x)))[:, None]


def growing_scatter(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """A gamma law of two degrees, of which the deviation grows: x0 + 0.5 x1 + 0.5 exp(0.8 x2) G."""
    gamma = (random.gamma(2.0, size=len(x)) - 2.0) / np.sqrt(2.0)
    return (x[:, 0] + 0.5 * x[:, 1] + 0.5 * np.exp(0.8 * x[:, 2]) * gamma)[:, None]


def scatter_bump(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """0.3 x1 + (0.15 + exp(-(x0 / 0.3)**2)) N."""
    scale = 0.15 + np.exp(-((x[:, 0] / 0.3) ** 2))
    return (0.3 * x[:, 1] + scale * random.standard_normal(len(x)))[:, None]


def waves(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Sin(4 x0) cos(2 x1) + 0.1 N, the outputs of what a ring does not capture."""
    return (np.sin(4.0 * x[:, 0]) * np.cos(2.0 * x[:, 1]) + 0.1 * random.standard_normal(len(x)))[:, None]


def ring(x: np.ndarray) -> np.ndarray:
    """Chance of capture: 1 from 0.45 to 0.8 of the distance of x0 and x1 from the middle, 0 elsewhere, soft edges."""
    distance = np.hypot(x[:, 0], x[:, 1])
    return 1.0 / (1.0 + np.exp(-(0.175 - np.abs(distance - 0.625)) / 0.03))


def kinks(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """|x0| + 0.7 where x1 > 0.2, + 0.5 max(x2, 0) + 0.2 N."""
    mean = np.abs(x[:, 0]) + 0.7 * (x[:, 1] > 0.2) + 0.5 * np.maximum(x[:, 2], 0.0)
    return (mean + 0.2 * random.standard_normal(len(x)))[:, None]


def turning_correlation(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """0.3 x1 + e1, e2, 0.3 x2 + e3 of unit normals, where e1 and e2 are correlated by 0.95 sin(pi x0 / 2)."""
    first, second, third = random.standard_normal((3, len(x)))
    correlation = 0.95 * np.sin(0.5 * np.pi * x[:, 0])
    second = correlation * first + np.sqrt(1.0 - correlation**2) * second
    return np.column_stack([0.3 * x[:, 1] + first, second, 0.3 * x[:, 2] + third])


def smooth(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Sin(3 x0) + 1.5 x1**2 x2 + exp(x0 x1) + 0.02 N."""
    mean = np.sin(3.0 * x[:, 0]) + 1.5 * x[:, 1] ** 2 * x[:, 2] + np.exp(x[:, 0] * x[:, 1])
    return (mean + 0.02 * random.standard_normal(len(x)))[:, None]


def two_of_twelve(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Sin(2.5 x0) + 1.5 x1**2 + 0.2 N; ten inputs do nothing."""
    return (np.sin(2.5 * x[:, 0]) + 1.5 * x[:, 1] ** 2 + 0.2 * random.standard_normal(len(x)))[:, None]


def bimodal(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Two normal branches that cross, [Zhu-2023]."""
    half = np.where(random.random(len(x)) < 0.4, 1.0, -1.0) * 0.8 * (5.0 * x[:, 0] - 2.5)
    return (4.0 * np.sin(np.pi * x[:, 0]) ** 2 + half + 0.8 * random.standard_normal(len(x)))[:, None]


def brownian(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Geometric Brownian motion at drift and volatility x, [Zhu-2023]: log-normal."""
    return np.exp(x[:, 0] - 0.5 * x[:, 1] ** 2 + x[:, 1] * random.standard_normal(len(x)))[:, None]


def heston(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Price after a year by the model of Heston from the price 1, [Luethen-2023]: Euler steps of a log price whose
    variance is cut at zero; 250 steps where the published runs have 10 000.
    """
    drift, reversion, mean, volatility, correlation, variance = x.T.copy()
    log_price, step = np.zeros(len(x)), 1.0 / HESTON_STEPS
    for _ in range(HESTON_STEPS):
        first, second = random.standard_normal((2, len(x)))
        positive = np.maximum(variance, 0.0)
        root = np.sqrt(positive * step)
        log_price += (drift - 0.5 * positive) * step + root * first
        second = correlation * first + np.sqrt(1.0 - correlation**2) * second
        variance = variance + reversion * (mean - positive) * step + volatility * root * second
    return np.exp(log_price)[:, None]


def borehole(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Flow through a borehole of known radius, upper head and conductivity; five quantities are unknown,
    [Luethen-2023].
    """
    radius, head, conductivity = x.T
    reach = np.exp(7.71 + 1.0056 * random.standard_normal(len(x)))
    upper, lower = random.uniform(63070.0, 115600.0, len(x)), random.uniform(63.1, 116.0, len(x))
    below, length = random.uniform(700.0, 820.0, len(x)), random.uniform(1120.0, 1680.0, len(x))
    ratio = np.log(reach / radius)
    resistance = ratio * (1.0 + 2.0 * length * upper / (ratio * radius**2 * conductivity) + upper / lower)
    return (2.0 * np.pi * upper * (head - below) / resistance)[:, None]


def newly_infected(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """How many of 2000 are infected after the start of an epidemic, as in UQLab's StochasticSIR: susceptible, infected,
    rates of infection and of recovery. From one infection to the next the recoveries have a geometric law.
    """
    susceptible, infected = np.round(x[:, 0]), np.round(x[:, 1])
    total, active = np.zeros(len(x)), np.arange(len(x))
    while len(active):
        rate = x[active, 2] * susceptible[active]
        recoveries = np.floor(random.standard_exponential(len(active)) / np.log1p(rate / (x[active, 3] * PEOPLE)))
        active, recoveries = active[recoveries < infected[active]], recoveries[recoveries < infected[active]]
        infected[active] += 1.0 - recoveries
        susceptible[active] -= 1.0
        total[active] += 1.0
        active = active[susceptible[active] > 0.0]
    return total[:, None]


def infected_at_known_rates(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """The same of susceptible and infected at rates of 0.5."""
    return newly_infected(np.column_stack([x, np.full((len(x), 2), 0.5)]), random)


def _unit(count: int) -> dict[str, Distribution]:
    return {f"x{k}": Uniform(-1.0, 1.0) for k in range(count)}


TRUTHS = {
    "two branches": Case(_unit(3), two_branches, GROUP_EFFECT * 0.3),
    "growing scatter": Case(_unit(4), growing_scatter, GROUP_EFFECT * 0.5),
    "scatter with a bump": Case(_unit(3), scatter_bump, GROUP_EFFECT * 0.5),
    "capture in a ring": Case(_unit(3), waves, GROUP_EFFECT * 0.1, ring),
    "kinks and steps": Case(_unit(4), kinks, GROUP_EFFECT * 0.2),
    "correlation turns": Case(_unit(3), turning_correlation, GROUP_EFFECT),
    "near-deterministic": Case(_unit(3), smooth, GROUP_EFFECT * 0.02),
    "two of twelve inputs": Case(_unit(12), two_of_twelve, GROUP_EFFECT * 0.2),
}
PUBLISHED = {
    "bimodal": Case({"x": Uniform(0.0, 1.0)}, bimodal),
    "brownian": Case({"drift": Uniform(0.0, 0.1), "volatility": Uniform(0.1, 0.4)}, brownian, lower=0.0),
    "heston": Case(
        {
            "drift": Uniform(0.0, 0.1),
            "reversion": Uniform(0.3, 2.0),
            "mean": Uniform(0.02, 0.07),
            "volatility": Uniform(0.2, 0.4),
            "correlation": Uniform(-1.0, -0.5),
            "variance": Uniform(0.02, 0.07),
        },
        heston,
        lower=0.0,
    ),
    "borehole": Case(
        {
            "radius": Normal(0.1, 0.0161812),
            "head": Uniform(990.0, 1110.0),
            "conductivity": Uniform(9855.0, 12045.0),
        },
        borehole,
        lower=0.0,
    ),
    "SIR": Case(PATIENTS, infected_at_known_rates),
    "SIR, four inputs": Case(
        PATIENTS | {"infection": Uniform(0.5, 0.75), "recovery": Uniform(0.5, 0.75)}, newly_infected
    ),
}
