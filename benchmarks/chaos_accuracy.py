"""Error of the default fit against the number of runs, beside the design of [Landings-PCE] and a Gaussian process.

Prints a table of medians over seeds of rRMSE (error at 2000 noise-free test points over the spread of the truth).
Usage: python benchmarks/chaos_accuracy.py [--seeds 10] [--counts 50,100,250,450] [--cases smooth,kinked,...]
"""

from collections.abc import Callable

import numpy as np
from harness import command_line

from lithobrake.chaos import Uniform, fit, smolyak, sobol_sequence
from lithobrake.chaos.basis import germs_of
from lithobrake.chaos.covariance import RadialMatern
from lithobrake.chaos.gaussian_process import fit_process
from lithobrake.chaos.training_data import checked_training

INPUTS = {f"x{k}": Uniform(0.0, 1.0) for k in range(1, 6)}
NOISE_SHARE = 0.15
Model = Callable[[np.ndarray], np.ndarray]


def smooth(x: np.ndarray) -> np.ndarray:
    """Source: Friedman, 1991, "Multivariate adaptive regression splines", Eq 61."""
    return 10.0 * np.sin(np.pi * x[:, 0] * x[:, 1]) + 20.0 * (x[:, 2] - 0.5) ** 2 + 10.0 * x[:, 3] + 5.0 * x[:, 4]


def kinked(x: np.ndarray) -> np.ndarray:
    """A friction limit: the smaller of what sticks and what slides, in an oblique direction of three inputs."""
    stick, slide = 0.3 + 0.7 * x[:, 0], 0.2 + 0.6 * x[:, 1] + 0.3 * x[:, 2]
    return np.minimum(stick, slide) * (1.0 - 0.4 * x[:, 3]) + 0.1 * x[:, 4]


CASES: dict[str, tuple[Model, float]] = {
    "smooth": (smooth, 0.0),
    "kinked": (kinked, 0.0),
    "noisy": (smooth, NOISE_SHARE),
    "kinked and noisy": (kinked, NOISE_SHARE),
}


def errors_of_case(model: Model, noise: float, count: int, seed: int) -> tuple[float, float, float, float]:
    """rRMSE of the default, of the process alone, of the 241 runs of [Landings-PCE]; and the default's own estimate."""
    test = sobol_sequence(INPUTS, 2000, seed=1000 + seed)
    truth = model(test)
    spread = float(truth.std())
    generator = np.random.default_rng(seed)

    def runs(x: np.ndarray) -> np.ndarray:
        return model(x) + noise * spread * generator.normal(size=len(x))

    def share(values: np.ndarray) -> float:
        return float(np.sqrt(np.mean((values - truth) ** 2)) / spread)

    grid = smolyak(INPUTS, level=3)
    paper = share(fit(INPUTS, grid, runs(grid), degree=3, method="ols")(test))
    x = sobol_sequence(INPUTS, count, seed=seed)
    y = runs(x)
    default = fit(INPUTS, x, y)
    process = fit_process(checked_training(INPUTS, x, y), 0, RadialMatern)
    alone = share(process.predict(germs_of(INPUTS, test)))
    return share(default(test)), alone, paper, float(default.report["rrmse_estimate"][0])


def main() -> None:
    options = command_line(__doc__, seeds=10, counts="50,100,250,450", cases=",".join(CASES)).parse_args()
    print("| truth | runs | default | Gaussian process | paper, 241 runs | default / paper | its own estimate |")
    print("|---|---|---|---|---|---|---|")
    for name, (model, noise) in ((name, CASES[name]) for name in options.cases.split(",")):
        for count in (int(one) for one in options.counts.split(",")):
            rows = [errors_of_case(model, noise, count, seed) for seed in range(options.seeds)]
            default, alone, paper, estimate = np.median(np.array(rows), axis=0)
            ratio = default / paper
            print(
                f"| {name} | {count} | {default:.4g} | {alone:.4g} | {paper:.4g} | {ratio:.3g} | {estimate:.4g} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
