"""Which fit of a stochastic model has the best law on published cases, with and without repeated runs.

    python benchmarks/stochastic_cases.py [--studies 5]

fits a bimodal model and geometric Brownian motion ([Zhu-2023]) to that many Latin hypercubes of 480 points, and of 60
points with 8 runs each; benchmarks/results/stochastic_cases.csv has the mean over 200 points of W2**2 between law and
emulated law, over the variance of the output, and beside it in .json how it was made.
"""

from collections.abc import Callable, Mapping

import numpy as np
from harness import RESULTS, Row, command_line, origin, rounded, write_document, write_rows

from lithobrake import emulator
from lithobrake.chaos import Distribution, Uniform, fit_stochastic, latin_hypercube

TABLE = RESULTS / "stochastic_cases.csv"
RUNS, REPEATS, POINTS, DRAWS = 480, 8, 200, 4000
LEVELS = (np.arange(1000) + 0.5) / 1000
Model = Callable[[np.ndarray, np.random.Generator], np.ndarray]


def bimodal(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Draw one output at each x [count, 1], from two branches that cross."""
    branch = np.where(random.random(len(x)) < 0.4, 1.0, -1.0) * 0.8 * (5.0 * x[:, 0] - 2.5)
    return 4.0 * np.sin(np.pi * x[:, 0]) ** 2 + branch + 0.8 * random.standard_normal(len(x))


def brownian(x: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Draw one output at each drift and volatility x [count, 2]: log-normal."""
    return np.exp(x[:, 0] - 0.5 * x[:, 1] ** 2 + x[:, 1] * random.standard_normal(len(x)))


CASES: dict[str, tuple[Model, Mapping[str, Distribution], float | None]] = {
    "bimodal": (bimodal, {"x": Uniform(0.0, 1.0)}, None),
    "brownian": (brownian, {"drift": Uniform(0.0, 0.1), "volatility": Uniform(0.1, 0.4)}, 0.0),
}


def row(case: str, repeats: int, seed: int) -> Row:
    """Errors of all fits to one design."""
    model, inputs, lower = CASES[case]
    x = np.repeat(latin_hypercube(inputs, RUNS // repeats, seed=seed), repeats, axis=0)
    y = model(x, np.random.default_rng(seed))
    points = latin_hypercube(inputs, POINTS, seed=999)
    truth = model(np.repeat(points, DRAWS, axis=0), np.random.default_rng(998)).reshape(POINTS, DRAWS)

    def error(draws: np.ndarray) -> float:
        gaps = np.quantile(draws, LEVELS, axis=1) - np.quantile(truth, LEVELS, axis=1)
        return float(np.mean(gaps**2) / truth.var())

    found: Row = {
        "case": case, "repeats": repeats, "seed": seed,
        "emulator": error(emulator.fit(inputs, x, y[:, None], lower=lower).sample(points, DRAWS)[:, :, 0]),
        "expansion": error(emulator.fit_stochastic_expansion(inputs, x, y, lower=lower).sample(points, DRAWS)),
        "any_run": error(np.broadcast_to(np.random.default_rng(997).choice(y, DRAWS), truth.shape)),
        "mean_and_scatter": "",
    }  # fmt: skip
    if repeats > 1:
        draws = fit_stochastic(inputs, x, y).sample(np.repeat(points, DRAWS, axis=0), seed=996)
        found["mean_and_scatter"] = error(draws.reshape(truth.shape))
    return rounded(found)


def main() -> None:
    """Make all rows and write them."""
    studies = command_line(__doc__, studies=5).parse_args().studies
    begin = origin(f"benchmarks/stochastic_cases.py --studies {studies}")
    rows = [row(case, repeats, seed) for case in CASES for repeats in (1, REPEATS) for seed in range(studies)]
    write_rows(TABLE, rows[0], rows)
    write_document(TABLE.with_suffix(".json"), begin)


if __name__ == "__main__":
    main()
