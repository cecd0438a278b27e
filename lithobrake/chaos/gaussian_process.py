"""Gaussian process with a nugget: learnt by likelihood, judged by leave-one-out, turned into an expansion."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cho_solve, cholesky, solve_triangular
from scipy.optimize import minimize

from lithobrake.chaos.basis import Indices, basis_matrix, germs_of, multi_index_set
from lithobrake.chaos.counts import term_count
from lithobrake.chaos.covariance import Covariance, PolynomialCovariance, ProductCovariance, RadialMatern
from lithobrake.chaos.design import sobol_sequence
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.training_data import Training
from lithobrake.vocabulary.array_types import Array

FAMILIES: tuple[type[Covariance], ...] = (PolynomialCovariance, ProductCovariance, RadialMatern)
# Parameters are learnt from at most so many points: a step costs their number cubed, and they are few.
LEARN_FROM = 256
ITERATIONS = 100
# The nugget, relative to the variance of the outputs: from rounding to everything.
LOG_NOISE = (-23.0, 1.0)
TERM_LIMIT = 12000
KEPT_LIMIT = 3000
# Terms are dropped while their sum of squares stays below this times the expected squared error.
DROPPED_FRACTION = 0.002


@dataclass(frozen=True)
class GaussianProcess:
    """A learnt Gaussian process of one output, standardised as (y - shift) / scale.

    theta: log parameters; noise: nugget variance, relative to scale**2; weights [count]: K**-1 y; factor: lower
    Cholesky factor of K [count, count]; germs of the points [input_count, count];
    leave_one_out [count]: error at each point predicted from the others (equal runs left out together), in the unit of
    the output.
    """

    covariance: Covariance
    theta: Array
    noise: float
    weights: Array
    factor: Array
    germs: Array
    leave_one_out: Array
    shift: float
    scale: float

    def predict(self, germs: Array) -> Array:
        """Mean at germs [input_count, count]; result [count]."""
        return self.shift + self.scale * (self.covariance.between(self.theta, germs, self.germs) @ self.weights)

    def expected_error(self, germs: Array) -> float:
        """Root-mean-square error expected at a new run, [unit of the output], scatter included.

        The larger of leave-one-out, which sees what the covariance does not, and the predicted variance averaged over
        germs [input_count, count] of fresh inputs, which sees the tails where no run stands.
        Source: [Rasmussen-2006], Eq 2.26.
        """
        cross = solve_triangular(self.factor, self.covariance.between(self.theta, self.germs, germs), lower=True)
        variance = np.maximum(self.covariance.variance(self.theta, germs) - (cross**2).sum(axis=0), 0.0)
        predicted = self.scale**2 * (float(variance.mean()) + self.noise)
        return float(np.sqrt(max(predicted, float(np.mean(self.leave_one_out**2)))))

    def coefficients(self, indices: Indices) -> Array:
        """Exact projection of the mean on orthonormal terms, [term_count]."""
        return self._projected(indices, self.weights)

    def refitted(self, indices: Indices, y: Array) -> Array:
        """The same with the parameters kept and other outputs y [count, any] at the same points, [term_count, any]."""
        return self._projected(indices, cho_solve((self.factor, True), (y - self.shift) / self.scale))

    def _projected(self, indices: Indices, weights: Array) -> Array:
        parts = self.scale * self.covariance.projection(self.theta, self.germs, indices, weights)
        parts[indices.sum(axis=1) == 0] += self.shift
        return parts


def families_for(inputs: Sequence[Distribution]) -> tuple[type[Covariance], ...]:
    """Covariances to try: where no input is bounded, the polynomial one would be the Gaussian one again."""
    return FAMILIES if any(entry.bounded for entry in inputs) else FAMILIES[1:]


def highest_degrees(inputs: Sequence[Distribution]) -> list[int]:
    """Highest degree of each input that a projected process uses: more for fewer inputs, less for few samples."""
    cap = {1: 40, 2: 30, 3: 20}.get(len(inputs), 14)
    while cap > 1 and term_count(len(inputs), cap) > TERM_LIMIT:
        cap -= 1
    return [int(min(cap, entry.highest_degree)) for entry in inputs]


def fit_process(training: Training, output: int, family: type[Covariance]) -> GaussianProcess:
    """Learn one output by maximum likelihood.

    Source: [Rasmussen-2006], Eqs 5.8, 5.9 (likelihood) and 5.12 (leave-one-out in closed form).
    """
    entries = list(training.inputs.values())
    covariance = family(entries, highest_degrees(entries))
    germs, y = germs_of(training.inputs, training.x), training.y[:, output]
    shift, scale = float(y.mean()), float(y.std())
    z = (y - shift) / scale
    theta, noise = _most_likely(covariance, *_learning_set(germs, z))
    lower, noise = _factor(covariance.between(theta, germs, germs), noise)
    weights = cho_solve((lower, True), z)
    inverse = cho_solve((lower, True), np.eye(len(z)))
    errors = weights / np.diag(inverse)
    for rows in training.groups:
        # Equal runs are left out together, or each would be predicted by its twins.
        errors[rows] = np.linalg.solve(inverse[np.ix_(rows, rows)], weights[rows])
    return GaussianProcess(covariance, theta, noise, weights, lower, germs, scale * errors, shift, scale)


def _factor(matrix: Array, noise: float) -> tuple[Array, float]:
    """Cholesky factor of matrix plus nugget, with the smallest nugget from `noise` on that rounding allows."""
    while True:
        try:
            return cholesky(matrix + noise * np.eye(len(matrix)), lower=True), noise
        except LinAlgError:
            # A smooth covariance of near points is singular to rounding; tenfold steps end at the trace at the latest.
            noise *= 10.0
            if noise > np.trace(matrix):
                raise


def _learning_set(germs: Array, z: Array) -> tuple[Array, Array]:
    if len(z) <= LEARN_FROM:
        return germs, z
    # A seed of its own, so that the same runs give the same parameters.
    chosen = np.sort(np.random.default_rng(0).permutation(len(z))[:LEARN_FROM])
    return germs[:, chosen], z[chosen]


def _most_likely(covariance: Covariance, germs: Array, z: Array) -> tuple[Array, float]:
    """Parameters and nugget of the highest likelihood, from one start (a second one hardly ever wins)."""
    first, bounds = covariance.start()

    def target(vector: Array) -> tuple[float, Array]:
        return _negative_likelihood(covariance, vector, germs, z)

    found = minimize(
        target,
        np.append(first, -4.0),
        jac=True,
        method="L-BFGS-B",
        bounds=[*bounds, LOG_NOISE],
        options={"maxiter": ITERATIONS},
    )
    return found.x[:-1], float(np.exp(found.x[-1]))


def _negative_likelihood(covariance: Covariance, vector: Array, germs: Array, z: Array) -> tuple[float, Array]:
    matrix, gradient = covariance.with_gradient(vector[:-1], germs)
    noise = np.exp(vector[-1])
    noisy = matrix.copy()
    noisy[np.diag_indices_from(noisy)] += noise
    try:
        lower = cholesky(noisy, lower=True)
    except LinAlgError:
        # The search steps back from parameters for which rounding makes the matrix indefinite.
        return 1e10, np.zeros_like(vector)
    inverse = cho_solve((lower, True), np.eye(len(z)))
    weights = inverse @ z
    derivatives = 0.5 * (inverse - np.outer(weights, weights))
    value = 0.5 * float(z @ weights) + float(np.log(np.diag(lower)).sum())
    return value, np.append(gradient(derivatives), noise * np.trace(derivatives))


def fresh_germs(inputs: dict[str, Distribution]) -> tuple[Array, Array]:
    """500 fixed Sobol points, in physical units [500, input_count] and as germs [input_count, 500]."""
    points = sobol_sequence(inputs, 500, seed=1)
    return points, germs_of(inputs, points)


def expansion_of(process: GaussianProcess, inputs: dict[str, Distribution]) -> tuple[Indices, Array, float]:
    """Terms [term_count, input_count], coefficients [term_count] and the root-mean-square error of cutting the rest.

    The error is measured against the process itself at 500 Sobol points, in the unit of the output.
    """
    degrees = process.covariance.degrees
    indices = multi_index_set(len(degrees), max(degrees), max_degrees=degrees)
    coefficients = process.coefficients(indices)
    order = np.argsort(-np.where(indices.sum(axis=1) == 0, np.inf, coefficients**2), kind="stable")
    # Summed up from the smallest term, as beside the largest ones the small ones would be lost; the constant stays
    # whatever its size.
    tail = np.cumsum(coefficients[order][::-1] ** 2)[::-1]
    allowed = DROPPED_FRACTION * float(np.mean(process.leave_one_out**2))
    kept = np.sort(order[: max(1, min(KEPT_LIMIT, int(np.sum(tail > allowed))))])
    points, germs = fresh_germs(inputs)
    difference = basis_matrix(inputs, indices[kept], points) @ coefficients[kept]
    difference -= process.predict(germs)
    return indices[kept], coefficients[kept], float(np.sqrt(np.mean(difference**2)))
