"""Errors of an emulator's conditional law against the synthetic truth, in squared Wasserstein distances."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from lithobrake import emulator

from ..synthetic_landings import (
    ELEVATION_LIMIT,
    INPUTS,
    OUTCOMES,
    OUTPUT_NAMES,
    SPEED_LIMIT,
    Truth,
    random_soils,
    returns,
)

LOWER = (0.0, 0.0, -np.inf, 0.0)
UPPER = (SPEED_LIMIT, ELEVATION_LIMIT, np.inf, np.inf)
DIRECTIONS = np.random.default_rng(7).standard_normal((40, 5))
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1, keepdims=True)


@cache
def fitted(truth: Truth, run_count: int, bed_count: int, seed: int) -> emulator.Emulator:
    """An emulator of one synthetic study, fitted once for all tests that ask for it; the azimuth rides."""
    x, y, outcome, bed = truth.study(run_count, bed_count, seed)
    return emulator.fit(INPUTS, x, y, groups=bed, outcome=outcome, outcomes=OUTCOMES, lower=LOWER, upper=UPPER,
        riders=("azimuth_out",), output_names=OUTPUT_NAMES)  # fmt: skip


@dataclass(frozen=True)
class DrawnRuns:
    """The emulator to beat: one of the runs, whatever the inputs."""

    model: emulator.Emulator

    def sample(self, x: np.ndarray, count: int, seed: int = 0) -> np.ndarray:
        """Draw runs [point_count, count, output_count], NaN where the run has no outputs."""
        runs = self.model.runs
        y = np.full((len(runs.x), runs.y.shape[1]), np.nan)
        y[runs.has_outputs] = runs.y
        return y[np.random.default_rng(seed).integers(len(y), size=(len(x), count))]


def law_errors(
    truth: Truth, model: emulator.Emulator | DrawnRuns, point_count: int = 30, draw_count: int = 1500
) -> np.ndarray:
    """Errors [4] at soils that were not run: of speed, mean W2**2 / variance; of all outputs, sliced, each by its
    standard deviation; of the return fraction, root mean square [points]; of the marginal speed, W2 / deviation.
    """
    rng = np.random.default_rng(99)
    soils = random_soils(point_count, rng)
    drawn = model.sample(soils, 2 * draw_count, seed=1)
    many = random_soils(50_000, rng)
    everything = _embedded(truth._leaving(many, rng.standard_normal(len(many)), rng))
    spread = everything.std(axis=0)
    errors = []
    for k, soil in enumerate(soils):
        exact = truth.conditional(soil, draw_count, seed=k)
        # Captured landers have no outputs; twice as many draws leave enough.
        found = drawn[k][~np.isnan(drawn[k, :, 0])][:draw_count]
        shares = [returns(y, np.full(draw_count, "clear")).mean() for y in (found, exact)]
        first, second = _embedded(found) / spread, _embedded(exact) / spread
        sliced = _wasserstein(first @ DIRECTIONS.T, second @ DIRECTIONS.T).mean()
        errors.append([_wasserstein(first[:, 0], second[:, 0]), sliced, (shares[0] - shares[1]) ** 2])
    speed, joint, share = np.mean(errors, axis=0)
    marginal = model.sample(many[:20_000], 1, seed=2)[:, 0, 0]
    levels = (np.arange(2000) + 0.5) / 2000
    difference = np.nanquantile(marginal, levels) - np.quantile(everything[:, 0], levels)
    return np.array([speed, joint, 100.0 * np.sqrt(share), np.sqrt((difference**2).mean()) / spread[0]])


def _embedded(y: np.ndarray) -> np.ndarray:
    """Outputs [count, 5] in which an angle is its cosine and sine."""
    return np.column_stack([y[:, :2], np.cos(y[:, 2]), np.sin(y[:, 2]), y[:, 3]])


def _wasserstein(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Squared Wasserstein distance of two samples [count, ...] of one size."""
    return ((np.sort(first, axis=0) - np.sort(second, axis=0)) ** 2).mean(axis=0)
