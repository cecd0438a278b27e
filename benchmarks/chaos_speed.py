"""Time to build, evaluate and read an expansion of 56 terms, 3 inputs, 3 outputs from 441 runs, on one thread.

Beside the package, with and without Numba, stand a plain vectorised NumPy reference and, where installed, openturns and
chaospy. CPU time, the median of several repeats, and its ratio to the reference. The other libraries evaluate at most a
million points. Usage: OMP_NUM_THREADS=1 python benchmarks/chaos_speed.py [--points 10000000]
"""

import argparse
import time
from collections.abc import Callable
from importlib.util import find_spec

import numpy as np

from lithobrake.chaos import Surrogate, Uniform, evaluation, fit, multi_index_set, smolyak, sobol_sequence

INPUTS = {name: Uniform(-1.0, 1.0) for name in "abc"}
DEGREE = 5
OTHERS_POINTS = 1_000_000
# Name, and CPU time to build [s], to evaluate one point [s], to read first and total indices [s].
Row = tuple[str, float, float, float]


def seconds(work: Callable[[], object], repeats: int) -> float:
    """Median CPU time of several calls [s]."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return float(np.median(times))


def model(x: np.ndarray) -> np.ndarray:
    """Three smooth outputs."""
    return np.column_stack([np.exp(x[:, 0] * x[:, 1]), np.sin(x[:, 2] + x[:, 0]), 1.0 / (3.0 + x[:, 1] + x[:, 2])])


def reference_matrix(x: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """All terms at all points at once, as one would write it by hand."""
    scale = np.sqrt(2.0 * np.arange(DEGREE + 1) + 1.0)
    matrix = np.ones((len(x), len(indices)))
    for k in range(x.shape[1]):
        matrix *= (np.polynomial.legendre.legvander(x[:, k], DEGREE) * scale)[:, indices[:, k]]
    return matrix


def reference_row(x: np.ndarray, y: np.ndarray, points: np.ndarray) -> Row:
    """Plain NumPy."""
    indices = multi_index_set(3, DEGREE)

    def build() -> np.ndarray:
        return np.asarray(np.linalg.lstsq(reference_matrix(x, indices), y, rcond=None)[0])

    coefficients = build()

    def evaluate() -> list[np.ndarray]:
        # In blocks, as one matrix of all points would not fit into memory.
        blocks = range(0, len(points), 8192)
        return [reference_matrix(points[start : start + 8192], indices) @ coefficients for start in blocks]

    def read() -> np.ndarray:
        squares = coefficients[1:] ** 2
        active = (indices[1:] > 0).T
        return np.stack([active @ squares, (active & (active.sum(axis=0) == 1)) @ squares]) / squares.sum(axis=0)

    return "NumPy reference", seconds(build, 200), seconds(evaluate, 5) / len(points), seconds(read, 500)


def own_row(x: np.ndarray, y: np.ndarray, points: np.ndarray) -> Row:
    """This package, as it is."""
    surrogate: Surrogate = fit(INPUTS, x, y, degree=DEGREE, method="ols")
    surrogate(points[:100_000])

    def read() -> tuple[object, object]:
        return surrogate.sobol_first, surrogate.sobol_total

    def build() -> Surrogate:
        return fit(INPUTS, x, y, degree=DEGREE, method="ols")

    evaluate = seconds(lambda: surrogate(points), 5) / len(points)
    return "lithobrake.chaos", seconds(build, 200), evaluate, seconds(read, 500)


def plain_row(x: np.ndarray, y: np.ndarray, points: np.ndarray) -> Row:
    """This package where Numba is missing."""
    compiled = evaluation.compiled_loop
    evaluation.compiled_loop = lambda: None
    try:
        return "lithobrake.chaos without Numba", *own_row(x, y, points)[1:]
    finally:
        evaluation.compiled_loop = compiled


def chaospy_row(x: np.ndarray, y: np.ndarray, points: np.ndarray) -> Row:
    """chaospy."""
    import chaospy

    joint = chaospy.J(*(chaospy.Uniform(-1.0, 1.0) for _ in range(3)))
    basis = chaospy.generate_expansion(DEGREE, joint, normed=True)
    model = chaospy.fit_regression(basis, x.T, y)
    build = seconds(lambda: chaospy.fit_regression(basis, x.T, y), 3)
    read = seconds(lambda: (chaospy.Sens_m(model, joint), chaospy.Sens_t(model, joint)), 1)
    return "chaospy", build, seconds(lambda: model(*points.T), 3) / len(points), read


def openturns_row(x: np.ndarray, y: np.ndarray, points: np.ndarray) -> Row:
    """openturns."""
    import openturns

    joint = openturns.JointDistribution([openturns.Uniform(-1.0, 1.0)] * 3)
    families = [openturns.LegendreFactory()] * 3
    basis = openturns.OrthogonalProductPolynomialFactory(families, openturns.LinearEnumerateFunction(3))
    strategy = openturns.FixedStrategy(basis, len(multi_index_set(3, DEGREE)))
    inputs, outputs, many = (openturns.Sample(array) for array in (x, y, points))

    def build() -> object:
        algorithm = openturns.FunctionalChaosAlgorithm(
            inputs, outputs, joint, strategy, openturns.LeastSquaresStrategy()
        )
        algorithm.run()
        return algorithm.getResult()

    result = build()
    function = result.getMetaModel()  # type: ignore[attr-defined]

    def read() -> list[float]:
        indices = openturns.FunctionalChaosSobolIndices(result)
        pairs = [(i, output) for i in range(3) for output in range(3)]
        return [f(i, output) for i, output in pairs for f in (indices.getSobolIndex, indices.getSobolTotalIndex)]

    return "openturns", seconds(build, 5), seconds(lambda: function(many), 3) / len(points), seconds(read, 5)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=10_000_000)
    options = parser.parse_args()
    x = smolyak(INPUTS, level=5)
    y, points = model(x), np.ascontiguousarray(sobol_sequence(INPUTS, options.points))
    rows = [row(x, y, points) for row in (reference_row, own_row, plain_row)]
    rows += [row(x, y, points[:OTHERS_POINTS]) for name, row in OTHERS.items() if find_spec(name) is not None]
    print(
        "| | build [ms] | ratio | evaluate [million points/s] | ratio of times | Sobol first and total [ms] | ratio |"
    )
    print("|---|---|---|---|---|---|---|")
    for name, *times in rows:
        build, evaluate, read = (f"{one / first:.3g}" for one, first in zip(times, rows[0][1:], strict=True))
        print(
            f"| {name} | {1e3 * times[0]:.3g} | {build} | {1e-6 / times[1]:.3g} | {evaluate} "
            f"| {1e3 * times[2]:.3g} | {read} |"
        )
    for name in OTHERS:
        if find_spec(name) is None:
            print(f"{name} is not installed, so it is not in the table.")


OTHERS: dict[str, Callable[[np.ndarray, np.ndarray, np.ndarray], Row]] = {
    "openturns": openturns_row,
    "chaospy": chaospy_row,
}

if __name__ == "__main__":
    main()
