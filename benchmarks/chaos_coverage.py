"""How often the intervals of an expansion hold the truth, and how its expected error compares with the true one.

Prints a table. In each trial five uniform inputs are run anew (another Sobol sequence, other scatter) and fitted by the
default or by another method. Sobol indices: 90 % intervals of all first-order and total indices against those of the
truth (pick-freeze with 2**18 points, so to 0.001). Predictions: new runs, scatter included, within 1.645 expected
errors of the expansion. Scores: 90 % intervals from 50 test runs against the scores at 20 000.
Usage: python benchmarks/chaos_coverage.py [--trials 40]
"""

import numpy as np
from chaos_accuracy import INPUTS, Model, kinked, smooth
from harness import command_line
from scipy import stats

from lithobrake.analysis.confidence import LEVEL, normal_quantile
from lithobrake.chaos import fit, score_intervals, sobol_intervals, sobol_sequence

CASES: list[tuple[str, Model, float, int, str | None]] = [
    ("smooth", smooth, 0.0, 60, None),
    ("smooth", smooth, 0.15, 60, None),
    ("smooth", smooth, 0.3, 150, None),
    ("smooth", smooth, 0.3, 150, "ols"),
    ("smooth", smooth, 0.3, 150, "omp"),
    ("smooth", smooth, 0.5, 80, None),
    ("smooth", smooth, 1.0, 120, None),
    ("kinked", kinked, 0.0, 60, None),
    ("kinked", kinked, 0.15, 60, None),
    ("kinked", kinked, 0.3, 150, None),
    ("kinked", kinked, 0.3, 150, "ols"),
    ("kinked", kinked, 0.5, 80, None),
    ("kinked", kinked, 1.0, 120, None),
]


def true_indices(model: Model) -> np.ndarray:
    """First-order and total indices [2, input_count] of a model."""
    uniform = [stats.uniform()] * len(INPUTS)
    found = stats.sobol_indices(func=lambda x: model(x.T)[None], n=2**18, dists=uniform, rng=np.random.default_rng(0))
    return np.stack([found.first_order.ravel(), found.total_order.ravel()])


def trial(
    model: Model, noise: float, count: int, method: str | None, indices: np.ndarray, seed: int
) -> dict[str, np.ndarray]:
    """What held in one trial: arrays of truth values, and widths and the ratio of errors."""
    generator = np.random.default_rng([count, seed])
    many = sobol_sequence(INPUTS, 20_000, seed=1000 + seed)
    truth = model(many)
    spread = float(truth.std())
    scatter = noise * spread * generator.normal(size=len(many))
    x = sobol_sequence(INPUTS, count, seed=seed)
    y = model(x) + noise * spread * generator.normal(size=count)
    surrogate = fit(INPUTS, x, y, method=method)
    bounds = sobol_intervals(surrogate, x, y, count=300, level=LEVEL, seed=seed)
    low, high = np.stack([bounds["first"], bounds["total"]], axis=1)
    error = surrogate(many) - truth - scatter
    expected = surrogate.report["outputs"]["y"]["rmse_estimate"]
    exact = surrogate.score(many, truth + scatter)["y"]
    tested = score_intervals(surrogate, many[:50], (truth + scatter)[:50], count=500, level=LEVEL, seed=seed)["y"]
    scores = {key: tested[key][0] <= exact[key] <= tested[key][1] for key in ("mape", "q2")}
    return {
        "indices": (low <= indices + 1e-3) & (indices - 1e-3 <= high),
        "width": high - low,
        "prediction": np.abs(error) <= normal_quantile() * expected,
        "ratio": np.array(expected / np.sqrt(np.mean(error**2))),
        **{key: np.array(value) for key, value in scores.items()},
    }


def main() -> None:
    options = command_line(__doc__, trials=40).parse_args()
    exact = {model: true_indices(model) for model in (smooth, kinked)}
    print(
        "| truth | scatter | runs | fit | Sobol indices held [%] | least of them | mean width | predictions held [%] "
        "| MAPE, Q2 held [%] | expected / true error (10, 50, 90 %) |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|")
    for name, model, noise, count, method in CASES:
        rows = [trial(model, noise, count, method, exact[model], seed) for seed in range(options.trials)]
        held = np.mean([row["indices"] for row in rows], axis=0)
        width = np.mean([row["width"] for row in rows])
        prediction, mape, q2 = (100.0 * np.mean([row[key] for row in rows]) for key in ("prediction", "mape", "q2"))
        ratio = ", ".join(f"{one:.2f}" for one in np.quantile([row["ratio"] for row in rows], [0.1, 0.5, 0.9]))
        print(
            f"| {name} | {noise:g} | {count} | {method or 'default'} | {100 * held.mean():.0f} "
            f"| {100 * held.min():.0f} | {width:.3f} | {prediction:.0f} | {mape:.0f}, {q2:.0f} | {ratio} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
