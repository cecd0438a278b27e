"""Terms of a stochastic expansion in its latent variable, their coefficients of most likelihood, and their choice."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy import optimize

from lithobrake.chaos.basis import Indices, basis_matrix, multi_index_set
from lithobrake.chaos.distributions import Distribution, Normal, Uniform
from lithobrake.emulator.training_runs import TrainingRuns
from lithobrake.emulator.validation import folds_of, mean_by_groups
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import whole_number

# Distributions that the latent variable may have, and nodes of the Gauss rule that integrates over it: as fine as the
# noise asks for, which else would show single nodes as peaks of the density.
LATENTS: dict[str, tuple[Distribution, int]] = {"normal": (Normal(0.0, 1.0), 100), "uniform": (Uniform(-1.0, 1.0), 50)}
# Nodes of less weight than this cost time and change no digit that counts.
LEAST_NODE_WEIGHT = 1e-9
# Cubic in the latent variable: enough for skewness and two branches.
LATENT_DEGREE = 3
# Relative change of the mean logarithm of the density at which a climb ends.
TOLERANCE = 1e-7
MOST_STEPS = 300
HIGHEST_DEGREE = 5
# With fewer runs to a term, likelihood would follow single runs: such degrees are not looked at.
RUNS_PER_TERM = 5
# Noise as shares of the scatter about the mean, from nearly all of it down to where single runs become peaks.
NOISE_SHARES = (0.95, 0.85, 0.7, 0.55, 0.4, 0.3, 0.2)
FOLDS = 5


@dataclass(frozen=True)
class LatentTerms:
    """Multi-indices [term_count, input_count + 1], the powers of the latent variable last; latent: its distribution."""

    inputs: dict[str, Distribution]
    latent: str
    indices: Indices

    @property
    def degree(self) -> int:
        return int(self.indices[:, :-1].sum(axis=1).max())

    def factors(self, points: Array) -> Array:
        """What each term has of the inputs at points in physical units, shape [point_count, term_count]."""
        return np.ascontiguousarray(basis_matrix(self.inputs, self.indices[:, :-1], points))

    @cached_property
    def of_power(self) -> Array:
        """Which power of the latent variable each term has, 1 at its place [term_count, power_count]."""
        return np.eye(LATENT_DEGREE + 1)[self.indices[:, -1]]

    @cached_property
    def rule(self) -> tuple[Array, Array]:
        """Polynomials of the latent variable at the nodes [power_count, node_count], and their weights [node_count]."""
        distribution, count = LATENTS[self.latent]
        nodes, weights = distribution.gauss(count)
        kept = weights > LEAST_NODE_WEIGHT
        return self.polynomials(nodes[kept]), weights[kept] / weights[kept].sum()

    def polynomials(self, germs: Array) -> Array:
        """Polynomials of the latent variable at its values [value_count], shape [power_count, value_count]."""
        return LATENTS[self.latent][0].recurrence(LATENT_DEGREE).values(germs)

    def branches(self, factors: Array, coefficients: Array) -> Array:
        """Coefficients of the powers of the latent variable at points of these factors, [point_count, power_count]."""
        return (factors * coefficients) @ self.of_power

    def drawn(self, count: int, random: np.random.Generator) -> Array:
        """Polynomials at so many values of the latent variable that are drawn, [power_count, count]."""
        distribution = LATENTS[self.latent][0]
        return self.polynomials(distribution.germ(distribution.ppf(random.random(count))))


def latent_terms(inputs: Mapping[str, Distribution], degree: int, latent: str) -> LatentTerms:
    """Terms of the inputs up to a total degree, of the latent variable up to the third, and their products.

    Products have the same total degree, but at least two: else the scatter could not change with the inputs. Of degree
    0 are no inputs at all.
    """
    highest = [int(min(degree, entry.highest_degree)) for entry in inputs.values()]
    largest = max(degree, LATENT_DEGREE)
    indices = multi_index_set(len(inputs) + 1, largest, max_degrees=[*highest, LATENT_DEGREE])
    of_inputs, power = indices[:, :-1].sum(axis=1), indices[:, -1]
    mixed = (of_inputs > 0) & (power > 0)
    kept = (of_inputs <= degree) & (~mixed | (of_inputs + power <= max(degree, 2)))
    return LatentTerms(dict(inputs), latent, indices[kept])


@dataclass(frozen=True)
class LatentProblem:
    """Runs to fit: factors [run_count, term_count] of the terms, target [run_count], and how often each run counts,
    weights [run_count].
    """

    terms: LatentTerms
    factors: Array
    target: Array
    weights: Array

    @classmethod
    def of_runs(cls, runs: TrainingRuns, terms: LatentTerms, weights: Array) -> "LatentProblem":
        """That of the runs with outputs; weights: how often each of all runs counts [run_count]."""
        there = runs.has_outputs
        return cls(terms, terms.factors(runs.x[there]), runs.coordinates[:, 0], weights[there])

    def of(self, chosen: NDArray[np.bool_]) -> "LatentProblem":
        """The problem of some of the runs alone, chosen [run_count]."""
        return LatentProblem(self.terms, self.factors[chosen], self.target[chosen], self.weights[chosen])

    def log_densities(self, coefficients: Array, noise: float) -> tuple[Array, Array]:
        """Logarithm of the density of each target [run_count], and its derivative by what the expansion is at each
        node [run_count, node_count]. noise: standard deviation beside the expansion.
        """
        polynomials, node_weights = self.terms.rule
        away = (self.target[:, None] - self.terms.branches(self.factors, coefficients) @ polynomials) / noise
        exponents = np.log(node_weights) - 0.5 * away**2
        # The largest exponent is taken out, or with little noise all of them would underflow.
        most = exponents.max(axis=1, keepdims=True)
        shares = np.exp(exponents - most)
        sums = shares.sum(axis=1, keepdims=True)
        logarithms = (most + np.log(sums))[:, 0] - np.log(noise) - 0.5 * np.log(2.0 * np.pi)
        return logarithms, shares / sums * away / noise

    def loss(self, coefficients: Array, noise: float) -> tuple[float, Array]:
        """Negative mean logarithm of the density, and its gradient [term_count]."""
        logarithms, slopes = self.log_densities(coefficients, noise)
        share = self.weights / self.weights.sum()
        by_power = (share[:, None] * slopes) @ self.terms.rule[0].T
        gradient = (self.factors * (by_power @ self.terms.of_power.T)).sum(axis=0)
        return -float(share @ logarithms), -gradient

    def climbed(self, start: Array, noise: float) -> Array:
        """Coefficients [term_count] of most likelihood that are reached from a start."""
        options = {"maxiter": MOST_STEPS, "maxcor": 20, "ftol": TOLERANCE}
        found = optimize.minimize(self.loss, start, (noise,), method="L-BFGS-B", jac=True, options=options)
        return np.asarray(found.x)

    def path(self, noise_shares: Sequence[float]) -> Iterator[tuple[float, Array]]:
        """Noise and coefficients for each share of the scatter about the mean, from the largest share on."""
        mean, scatter = self._mean_fit()
        alone = (self.terms.indices[:, :-1] == 0).all(axis=1) & (self.terms.indices[:, -1] == 1)
        found: list[Array] = []
        for share in noise_shares:
            noise = share * scatter
            # A line in the latent variable has all scatter that the noise leaves; without it the gradient is zero.
            starts = [mean + scatter * np.sqrt(1.0 - share**2) * alone, *found]
            # What was followed may have gone up the lesser of two peaks, which the likelihood shows at less noise.
            found = [min((self.climbed(start, noise) for start in starts), key=lambda one: self.loss(one, noise)[0])]
            yield noise, found[0]

    def _mean_fit(self) -> tuple[Array, float]:
        """Least-squares coefficients of the terms without the latent variable [term_count], and the scatter left."""
        without = self.terms.indices[:, -1] == 0
        root = np.sqrt(self.weights)
        coefficients = np.zeros(len(without))
        matrix = root[:, None] * self.factors[:, without]
        coefficients[without] = np.linalg.lstsq(matrix, root * self.target, rcond=None)[0]
        residual = self.target - self.factors @ coefficients
        scatter = float(np.sqrt(self.weights @ residual**2 / self.weights.sum()))
        if scatter <= 1e-9 * float(np.abs(self.target).max()):
            raise ValueError(
                "y does not scatter about a polynomial of the inputs, so it has no density: use lithobrake.chaos.fit"
            )
        return coefficients, scatter


def most_likely(runs: TrainingRuns, degree: int | None, latent: str | None) -> tuple[LatentTerms, float, Array, float]:
    """Terms that groups left out choose, noise and coefficients of most likelihood, and what they are worth: mean
    logarithm of the density of a run left out. degree, latent: None chooses these too.
    """
    weights, group = np.ones(len(runs.x)), runs.group[runs.has_outputs]
    problems = [LatentProblem.of_runs(runs, terms, weights) for terms in _candidates(runs, degree, latent)]
    chosen = _simplest([_held_out(problem, group) for problem in problems], group)
    shares = NOISE_SHARES[: chosen.share_count]
    noise, coefficients = list(LatentProblem.of_runs(runs, chosen.terms, weights).path(shares))[-1]
    return chosen.terms, noise, coefficients, float(chosen.logarithms.mean())


@dataclass(frozen=True)
class _HeldOut:
    """Terms, how many shares of the noise are gone down for the best, and logarithm of the density of each run where
    its group is left out [run_count].
    """

    terms: LatentTerms
    share_count: int
    logarithms: Array


def _simplest(tried: list[_HeldOut], group: NDArray[np.int64]) -> _HeldOut:
    """Of those that the best does not beat by more than a standard error, the one of the fewest terms.

    Of many that are tried, the best is so by luck too.
    """
    best = max(tried, key=lambda one: one.logarithms.mean())
    close = []
    for one in tried:
        gain, error = mean_by_groups(best.logarithms - one.logarithms, group)
        if gain <= error:
            close.append(one)
    fewest = min(len(one.terms.indices) for one in close)
    return max((one for one in close if len(one.terms.indices) == fewest), key=lambda one: one.logarithms.mean())


def _candidates(runs: TrainingRuns, degree: int | None, latent: str | None) -> list[LatentTerms]:
    """Terms of all degrees and latent variables that may be chosen; raises ValueError for a degree of too many."""
    degrees = range(HIGHEST_DEGREE + 1) if degree is None else [whole_number("degree", degree, 0, HIGHEST_DEGREE)]
    if latent is not None and latent not in LATENTS:
        raise ValueError(f"latent is {latent!r}, but must be one of {', '.join(LATENTS)}, or None to choose")
    latents = LATENTS if latent is None else (latent,)
    found = [latent_terms(runs.inputs, one, law) for one, law in product(degrees, latents)]
    # No inputs are always a candidate: that is the law to fall back on.
    kept = [one for one in found if one.degree == 0 or RUNS_PER_TERM * len(one.indices) <= len(runs.y)]
    if not kept:
        raise ValueError(
            f"degree is {degree}, which has {len(found[0].indices)} terms and needs {RUNS_PER_TERM} runs for each, but "
            f"{len(runs.y)} runs have an output: lower it, or make more runs"
        )
    return kept


def _held_out(problem: LatentProblem, group: NDArray[np.int64]) -> _HeldOut:
    """Follow the noise down until runs in groups left out are foretold worse than before."""
    fold = folds_of(group, FOLDS)
    tests = [fold == number for number in range(int(fold.max()) + 1)]
    best = _HeldOut(problem.terms, 0, np.full(len(group), -np.inf))
    # All folds go down together, so that what single runs make of a little noise need not be found.
    for count, steps in enumerate(zip(*(problem.of(~test).path(NOISE_SHARES) for test in tests), strict=True), 1):
        logarithms = np.empty(len(group))
        for test, (noise, coefficients) in zip(tests, steps, strict=True):
            logarithms[test] = problem.of(test).log_densities(coefficients, noise)[0]
        if logarithms.mean() <= best.logarithms.mean():
            break
        best = _HeldOut(problem.terms, count, logarithms)
    return best
