"""The default fit beside the Gaussian processes of scikit-learn, on eleven truths of five uniform inputs.

Prints a table of medians over seeds of rRMSE (error at 2000 noise-free points over the spread of the truth): default,
radial Matern 5/2 and Gaussian covariance with a length an input and a nugget, 241 runs of [Landings-PCE]; and the ratio
of the default to the better process. Usage: python benchmarks/chaos_processes.py [--seeds 3] [--counts 50,100]
"""

import warnings

import numpy as np
from chaos_accuracy import Model, kinked, smooth
from harness import command_line
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, Matern, WhiteKernel

from lithobrake.chaos import Uniform, fit, smolyak, sobol_sequence

INPUTS = {f"x{k}": Uniform(0.0, 1.0) for k in range(5)}
LENGTHS = (1e-2, 1e3)
# Families of Genz, 1984, "Testing multidimensional integration routines", and others like them; two that jump or slip.
TRUTHS: dict[str, Model] = {
    "Friedman": smooth,
    "oscillatory": lambda x: np.cos(0.6 * np.pi + x @ [1.5, 1.0, 2.0, 0.7, 1.2]),
    "corner peak": lambda x: (1.0 + x @ [0.5, 1.0, 0.2, 0.8, 0.3]) ** -3,
    "Gaussian peak": lambda x: np.exp(-((x - 0.4) ** 2) @ [4.0, 2.0, 6.0, 1.0, 3.0]),
    "products": lambda x: np.exp(x[:, 0] * x[:, 1]) + x[:, 2] * np.sin(3.0 * x[:, 3]) + 0.3 * x[:, 4] ** 3,
    "friction limit": kinked,
    "sum of kinks": lambda x: np.abs(x - 0.45) @ [1.0, 0.8, 0.6, 0.4, 0.2],
    "Sobol G": lambda x: np.prod(1.0 + (np.abs(4.0 * x - 2.0) - 1.0) / [1.0, 2.0, 5.5, 10.0, 100.0], axis=1),
    "continuous": lambda x: np.exp(-np.abs(x - 0.4) @ [1.5, 1.0, 0.7, 2.0, 0.5]),
    "stick or slip": lambda x: (
        np.minimum(x[:, 0], 0.6 * x[:, 1] + 0.2) * (1.0 + x[:, 2]) + 0.3 * x[:, 3] ** 2 + 0.2 * x[:, 4]
    ),
    "jump": lambda x: 0.5 * (x[:, 0] + 0.5 * x[:, 1] > 0.8) + x[:, 2] + 0.5 * x[:, 3] * x[:, 4],
}


def process(kernel: RBF, x: np.ndarray, y: np.ndarray, test: np.ndarray) -> np.ndarray:
    """Prediction of a process with this covariance, learnt by maximum likelihood from one start."""
    shift, scale = y.mean(), y.std()
    covariance = ConstantKernel(1.0, (1e-3, 1e4)) * kernel + WhiteKernel(1e-3, (1e-9, 1.0))
    learnt = GaussianProcessRegressor(covariance, random_state=0).fit(2.0 * x - 1.0, (y - shift) / scale)
    return shift + scale * np.asarray(learnt.predict(2.0 * test - 1.0))


def errors(truth: Model, noise: float, count: int, seed: int) -> list[float]:
    """rRMSE of the default, of both processes, and of the design of [Landings-PCE]."""
    test = sobol_sequence(INPUTS, 2000, seed=77)
    exact = truth(test)
    spread, generator = exact.std(), np.random.default_rng(seed)
    x, grid = sobol_sequence(INPUTS, count, seed=seed), smolyak(INPUTS, 3)
    y, on_grid = (truth(one) + noise * spread * generator.normal(size=len(one)) for one in (x, grid))
    predictions = [
        fit(INPUTS, x, y)(test),
        process(Matern([1.0] * 5, LENGTHS, nu=2.5), x, y, test),
        process(RBF([1.0] * 5, LENGTHS), x, y, test),
        fit(INPUTS, grid, on_grid, degree=3)(test),
    ]
    return [float(np.sqrt(np.mean((one - exact) ** 2)) / spread) for one in predictions]


def main() -> None:
    options = command_line(__doc__, seeds=3, counts="50,100").parse_args()
    # Of lengths at their limits: harmless here.
    warnings.filterwarnings("ignore", module="sklearn")
    print("| truth | scatter | runs | default | Matern | Gaussian | paper, 241 runs | default / better process |")
    print("|---|---|---|---|---|---|---|---|")
    for name, truth in TRUTHS.items():
        for noise in (0.0, 0.15):
            for count in (int(one) for one in options.counts.split(",")):
                rows = [errors(truth, noise, count, seed) for seed in range(options.seeds)]
                default, matern, gaussian, paper = np.median(np.array(rows), axis=0)
                print(
                    f"| {name} | {noise:g} | {count} | {default:.3g} | {matern:.3g} | {gaussian:.3g} | {paper:.3g} "
                    f"| {default / min(matern, gaussian):.2f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
