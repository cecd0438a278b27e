"""Time to build, evaluate and read an expansion of 56 terms, 3 inputs, 3 outputs from 441 runs, on one thread.

Beside the package, with and without Numba, stand a plain vectorised NumPy reference and, where installed, openturns and
chaospy. CPU time: the median of several rounds, and the median over rounds of its ratio to the reference. In a round
all take their turn, so that other work on the machine meets them alike. The other libraries evaluate a million points.
Usage: OMP_NUM_THREADS=1 python benchmarks/chaos_speed.py [--points 10000000] [--rounds 5] [--alone]
"""

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec

import numpy as np
from harness import command_line, timed

from lithobrake.chaos import Surrogate, Uniform, evaluation, fit, multi_index_set, smolyak, sobol_sequence

INPUTS = {name: Uniform(-1.0, 1.0) for name in "abc"}
DEGREE = 5
OTHERS_POINTS = 1_000_000
Work = Callable[[], object]
# Repeats within a round of building, evaluating, and reading first and total indices: the short ones often.
REPEATS = (30, 1, 100)


@dataclass(frozen=True)
class Contender:
    """What is timed: to build, to evaluate at `point_count` points, and to read the indices."""

    build: Work
    evaluate: Work
    read: Work
    point_count: int


def times(one: Contender) -> np.ndarray:
    """CPU time [s] to build, to evaluate a point and to read, [3]; the median of the repeats of one round."""
    result = []
    for work, repeats in zip((one.build, one.evaluate, one.read), REPEATS, strict=True):
        spent = []
        # One call that takes long says enough.
        while len(spent) < repeats and sum(spent) < 1.0:
            spent.append(timed(work)[1])
        result.append(float(np.median(spent)))
    return np.array(result) / [1.0, one.point_count, 1.0]


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


def reference(x: np.ndarray, y: np.ndarray, points: np.ndarray) -> Contender:
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

    return Contender(build, evaluate, read, len(points))


def own(x: np.ndarray, y: np.ndarray, points: np.ndarray) -> Contender:
    """This package, as it is."""
    surrogate: Surrogate = fit(INPUTS, x, y, degree=DEGREE, method="ols")
    surrogate(points[:100_000])

    def read() -> tuple[object, object]:
        return surrogate.sobol_first, surrogate.sobol_total

    def build() -> Surrogate:
        return fit(INPUTS, x, y, degree=DEGREE, method="ols")

    return Contender(build, lambda: surrogate(points), read, len(points))


def plain(x: np.ndarray, y: np.ndarray, points: np.ndarray) -> Contender:
    """This package where Numba is missing."""
    compiled = own(x, y, points)

    def evaluate() -> object:
        loop = evaluation.compiled_loop
        evaluation.compiled_loop = lambda: None
        try:
            return compiled.evaluate()
        finally:
            evaluation.compiled_loop = loop

    return Contender(compiled.build, evaluate, compiled.read, len(points))


def with_chaospy(x: np.ndarray, y: np.ndarray, points: np.ndarray) -> Contender:
    import chaospy

    joint = chaospy.J(*(chaospy.Uniform(-1.0, 1.0) for _ in range(3)))
    basis = chaospy.generate_expansion(DEGREE, joint, normed=True)
    model = chaospy.fit_regression(basis, x.T, y)
    few = points[:OTHERS_POINTS]
    return Contender(
        lambda: chaospy.fit_regression(basis, x.T, y),
        lambda: model(*few.T),
        lambda: (chaospy.Sens_m(model, joint), chaospy.Sens_t(model, joint)),
        len(few),
    )


def with_openturns(x: np.ndarray, y: np.ndarray, points: np.ndarray) -> Contender:
    import openturns

    joint = openturns.JointDistribution([openturns.Uniform(-1.0, 1.0)] * 3)
    families = [openturns.LegendreFactory()] * 3
    basis = openturns.OrthogonalProductPolynomialFactory(families, openturns.LinearEnumerateFunction(3))
    strategy = openturns.FixedStrategy(basis, len(multi_index_set(3, DEGREE)))
    inputs, outputs, many = (openturns.Sample(array) for array in (x, y, points[:OTHERS_POINTS]))

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

    return Contender(build, lambda: function(many), read, len(points[:OTHERS_POINTS]))


def main() -> None:
    parser = command_line(__doc__, points=10_000_000, rounds=5)
    parser.add_argument("--alone", action="store_true", help="without the other libraries, whose memory slows all")
    options = parser.parse_args()
    x = smolyak(INPUTS, level=5)
    y, points = model(x), np.ascontiguousarray(sobol_sequence(INPUTS, options.points))
    present = [name for name in OTHERS if not options.alone and find_spec(name) is not None]
    makers = {name: make for name, make in MAKERS.items() if name not in OTHERS or name in present}
    contenders = [make(x, y, points) for make in makers.values()]
    rounds = np.array([[times(one) for one in contenders] for _ in range(options.rounds)])
    medians, ratios = np.median(rounds, axis=0), np.median(rounds / rounds[:, :1], axis=0)
    print(
        "| | build [ms] | ratio | evaluate [million points/s] | ratio of times | Sobol first and total [ms] | ratio |"
    )
    print("|---|---|---|---|---|---|---|")
    for name, (build, evaluate, read), ratio in zip(makers, medians, ratios, strict=True):
        print(
            f"| {name} | {1e3 * build:.3g} | {ratio[0]:.3g} | {1e-6 / evaluate:.3g} | {ratio[1]:.3g} "
            f"| {1e3 * read:.3g} | {ratio[2]:.3g} |"
        )
    for name in OTHERS:
        if name not in present and not options.alone:
            print(f"{name} is not installed, so it is not in the table.")


OTHERS = ("openturns", "chaospy")
MAKERS: dict[str, Callable[[np.ndarray, np.ndarray, np.ndarray], Contender]] = {
    "NumPy reference": reference,
    "lithobrake.chaos": own,
    "lithobrake.chaos without Numba": plain,
    "openturns": with_openturns,
    "chaospy": with_chaospy,
}

if __name__ == "__main__":
    main()
