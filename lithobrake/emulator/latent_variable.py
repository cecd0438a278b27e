"""Terms of a stochastic expansion in its latent variable, their coefficients of most likelihood, and their choice."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, special

from lithobrake.chaos.basis import Indices, basis_matrix, multi_index_set
from lithobrake.chaos.distributions import Distribution, Normal
from lithobrake.emulator.training_runs import TrainingRuns
from lithobrake.emulator.validation import folds_of, mean_by_groups
from lithobrake.vocabulary.array_types import Array

# The latent variable is normal, or it has the values -1 and 1: two branches.
NORMAL, BRANCHES = "normal", "branches"
LATENTS = (NORMAL, BRANCHES)
LATENT = Normal(0.0, 1.0)
# Nodes of the Gauss rule that integrates over a normal latent variable. They lie pi / sqrt(count) apart, and no more
# than so many times the share that the noise has of the scatter, or single nodes would be peaks of the density.
LEAST_NODES, NODES = 20, 100
NODE_DISTANCE = 1.2
# Of the logarithms of the odds, over the number of runs: keeps those of branches that are certain finite.
ODDS_PENALTY = 0.5
# Nodes of less weight than this cost time and change no digit that counts.
LEAST_NODE_WEIGHT = 1e-9
# Cubic in the latent variable: enough for skewness and two branches.
LATENT_DEGREE = 3
# Of the largest output: less scatter about the mean is rounding.
LEAST_SCATTER = 1e-9
# Relative change of the mean logarithm of the density at which a climb ends, and one that is only scored.
TOLERANCE, OF_SCORED = 1e-7, 1e-5
MOST_STEPS = 300
HIGHEST_DEGREE = 5
# With fewer runs to a term, likelihood would follow single runs: such degrees are not looked at.
RUNS_PER_TERM = 10
# Noise as shares of the scatter about the mean, from nearly all of it down to where single runs become peaks.
NOISE_SHARES = (0.95, 0.85, 0.7, 0.55, 0.4, 0.3, 0.2)
# Of the noise of two branches towards that of most likelihood, at each share.
NOISE_STEPS = 3
FOLDS = 5


@dataclass(frozen=True)
class LatentTerms:
    """Multi-indices [term_count, input_count + 1], the powers of the latent variable last; latent: "normal" or
    "branches".

    odds [odds_count, input_count]: multi-indices of the logarithm of the odds of the upper of two branches; none where
    the latent variable is normal. Parameters are coefficients of the terms, and after them those of the odds.
    """

    inputs: dict[str, Distribution]
    latent: str
    indices: Indices
    odds: Indices

    @property
    def degree(self) -> int:
        return int(self.indices[:, :-1].sum(axis=1).max())

    @property
    def parameter_count(self) -> int:
        return len(self.indices) + len(self.odds)

    @property
    def follows_inputs(self) -> bool:
        return self.degree > 0 or len(self.odds) > 1

    def factors(self, points: Array) -> Array:
        """What each parameter is multiplied by at points in physical units, shape [point_count, parameter_count]."""
        return np.ascontiguousarray(basis_matrix(self.inputs, np.vstack([self.indices[:, :-1], self.odds]), points))

    @cached_property
    def of_power(self) -> Array:
        """Which power of the latent variable each term has, 1 at its place [term_count, power_count]."""
        return np.eye(len(self.rule()[0]))[self.indices[:, -1]]

    def rule(self, nodes: int = NODES) -> tuple[Array, Array]:
        """Polynomials of the latent variable at the nodes [power_count, node_count], and logarithms of their weights
        [node_count]; nodes: how many of a normal latent variable.
        """
        return _rule(self.latent, nodes)

    def log_weights(self, factors: Array, parameters: Array, nodes: int = NODES) -> Array:
        """Logarithms of the weights of the nodes at points of these factors, [point_count or 1, node_count]."""
        if not len(self.odds):
            return self.rule(nodes)[1][None]
        logit = factors[:, len(self.indices) :] @ parameters[len(self.indices) :]
        return -np.logaddexp(0.0, logit[:, None] * [1.0, -1.0])

    def by_power(self, factors: Array, parameters: Array) -> Array:
        """Coefficients of the powers of the latent variable at points of these factors, [point_count, power_count]."""
        terms = len(self.indices)
        return factors[:, :terms] @ (parameters[:terms, None] * self.of_power)

    def drawn(self, factors: Array, parameters: Array, count: int, random: np.random.Generator) -> Array:
        """What terms give at so many values of the latent variable that are drawn, [point_count, count]."""
        uniforms = random.random((len(factors), count))
        if self.latent == BRANCHES:
            upper = uniforms < np.exp(self.log_weights(factors, parameters)[:, 1:])
            polynomials = np.stack([np.ones(upper.shape), np.where(upper, 1.0, -1.0)])
        else:
            polynomials = LATENT.recurrence(LATENT_DEGREE).values(special.ndtri(uniforms.ravel()))
            polynomials = polynomials.reshape(-1, *uniforms.shape)
        return np.einsum("pk,kpc->pc", self.by_power(factors, parameters), polynomials)


@cache
def _rule(latent: str, nodes: int) -> tuple[Array, Array]:
    if latent == BRANCHES:
        return np.array([[1.0, 1.0], [-1.0, 1.0]]), np.log(np.full(2, 0.5))
    places, weights = LATENT.gauss(nodes)
    kept = weights > LEAST_NODE_WEIGHT
    return LATENT.recurrence(LATENT_DEGREE).values(places[kept]), np.log(weights[kept] / weights[kept].sum())


def nodes_of(noise_share: float) -> int:
    """How many nodes of a normal latent variable a noise asks for that is this share of the scatter."""
    return int(np.clip(np.ceil((np.pi / (NODE_DISTANCE * noise_share)) ** 2), LEAST_NODES, NODES))


def latent_terms(inputs: Mapping[str, Distribution], degree: int, latent: str, odds_degree: int = 0) -> LatentTerms:
    """Terms of the inputs up to a total degree, of the latent variable up to the third, and their products.

    Products have the same total degree, but at least two: else the scatter could not change with the inputs. Two
    branches have a distance that is linear in the inputs, and odds of odds_degree. Of degree 0 are no inputs at all.
    """
    highest = [int(min(degree, entry.highest_degree)) for entry in inputs.values()]
    of_latent, together = (1, 2) if latent == BRANCHES else (LATENT_DEGREE, max(degree, 2))
    indices = multi_index_set(len(inputs) + 1, max(degree, of_latent), max_degrees=[*highest, of_latent])
    of_inputs, power = indices[:, :-1].sum(axis=1), indices[:, -1]
    mixed = (of_inputs > 0) & (power > 0)
    kept = (of_inputs <= degree) & (~mixed | (of_inputs + power <= together))
    odds = multi_index_set(len(inputs), odds_degree)[: None if latent == BRANCHES else 0]
    return LatentTerms(dict(inputs), latent, indices[kept], odds)


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

    def log_densities(self, parameters: Array, noise: float, nodes: int = NODES) -> tuple[Array, Array, Array]:
        """Logarithm of the density of each target [run_count], share of each node in it [run_count, node_count], and
        how far the target is from each, over the noise. noise: standard deviation beside the expansion; nodes: as in
        `LatentTerms.rule`.
        """
        means = self.terms.by_power(self.factors, parameters) @ self.terms.rule(nodes)[0]
        away = (self.target[:, None] - means) / noise
        exponents = self.terms.log_weights(self.factors, parameters, nodes) - 0.5 * away**2
        # The largest exponent is taken out, or with little noise all of them would underflow.
        most = exponents.max(axis=1, keepdims=True)
        shares = np.exp(exponents - most)
        sums = shares.sum(axis=1, keepdims=True)
        logarithms = (most + np.log(sums))[:, 0] - np.log(noise) - 0.5 * np.log(2.0 * np.pi)
        return logarithms, shares / sums, away

    def loss(self, parameters: Array, noise: float, nodes: int = NODES) -> tuple[float, Array]:
        """Negative mean logarithm of the density with the penalty of the odds, and its gradient [parameter_count]."""
        logarithms, shares, away = self.log_densities(parameters, noise, nodes)
        terms, total = len(self.terms.indices), self.weights.sum()
        share, odds = self.weights / total, parameters[terms:]
        by_power = (share / noise)[:, None] * ((shares * away) @ self.terms.rule(nodes)[0].T)
        value = float(share @ logarithms)
        gradient = ((self.factors[:, :terms].T @ by_power) * self.terms.of_power).sum(axis=1)
        if len(odds):
            upper = np.exp(self.terms.log_weights(self.factors, parameters)[:, 1])
            of_odds = (share * (shares[:, 1] - upper)) @ self.factors[:, terms:] - ODDS_PENALTY / total * odds
            value -= 0.5 * ODDS_PENALTY / total * float(odds @ odds)
            gradient = np.concatenate([gradient, of_odds])
        return -value, -gradient

    def climbed(self, start: Array, noise: float, tolerance: float = TOLERANCE) -> Array:
        """Parameters of most likelihood that are reached from a start, [parameter_count]."""
        options = {"maxiter": MOST_STEPS, "maxcor": 20, "ftol": tolerance}
        arguments = (noise, nodes_of(noise / self.scatter))
        found = optimize.minimize(self.loss, start, arguments, method="L-BFGS-B", jac=True, options=options)
        return np.asarray(found.x)

    def path(self, noise_shares: Sequence[float], tolerance: float = TOLERANCE) -> Iterator[tuple[float, Array]]:
        """Noise and parameters for each share of the scatter about the mean, from the largest share on."""
        (mean, _), scatter = self._mean_fit, self.scatter
        indices, none = self.terms.indices, np.zeros(len(self.terms.odds))
        alone = np.append((indices[:, :-1] == 0).all(axis=1) & (indices[:, -1] == 1), none)
        found: list[Array] = []
        for share in noise_shares:
            noise = share * scatter
            # A line in the latent variable has all scatter that the noise leaves; without it the gradient is zero.
            starts = [mean + scatter * np.sqrt(1.0 - share**2) * alone, *found]
            # What was followed may have gone up the lesser of two peaks, which the likelihood shows at less noise.
            peaks = [self.climbed(start, noise, tolerance) for start in starts]
            found = [min(peaks, key=lambda one: self.loss(one, noise)[0])]
            yield self._settled(noise, found[0], tolerance) if self.terms.latent == BRANCHES else (noise, found[0])

    def _settled(self, noise: float, parameters: Array, tolerance: float) -> tuple[float, Array]:
        """Noise and parameters nearer to those of most likelihood, which two branches of one noise have; beside a
        normal latent variable less noise is always likelier, until it follows single runs.
        """
        for _ in range(NOISE_STEPS):
            _, shares, away = self.log_densities(parameters, noise)
            noise *= float(np.sqrt(self.weights @ (shares * away**2).sum(axis=1) / self.weights.sum()))
            parameters = self.climbed(parameters, noise, tolerance)
        return noise, parameters

    @property
    def scatters(self) -> bool:
        """Whether the target scatters about its mean; else it has no density."""
        return self._mean_fit[1] > LEAST_SCATTER * float(np.abs(self.target).max())

    @property
    def scatter(self) -> float:
        """Standard deviation about the mean; of some runs alone nothing but rounding may be left of it."""
        return max(self._mean_fit[1], LEAST_SCATTER * float(np.abs(self.target).max()))

    @cached_property
    def _mean_fit(self) -> tuple[Array, float]:
        """Least-squares parameters of the terms without the latent variable, 0 for others, and the scatter left."""
        without = np.append(self.terms.indices[:, -1] == 0, np.zeros(len(self.terms.odds), dtype=bool))
        root = np.sqrt(self.weights)
        coefficients = np.zeros(len(without))
        matrix = root[:, None] * self.factors[:, without]
        coefficients[without] = np.linalg.lstsq(matrix, root * self.target, rcond=None)[0]
        residual = self.target - self.factors @ coefficients
        return coefficients, float(np.sqrt(self.weights @ residual**2 / self.weights.sum()))


@dataclass(frozen=True)
class HeldOut:
    """Terms, how many shares of the noise are gone down for the best, and of runs whose group is left out logarithm of
    the density [run_count], and folds: which runs [run_count] with noise and parameters of the fit without them.
    """

    terms: LatentTerms
    share_count: int
    logarithms: Array
    folds: tuple[tuple[NDArray[np.bool_], float, Array], ...] = ()


def best_terms(runs: TrainingRuns) -> HeldOut | None:
    """Terms that groups left out choose: of those that the best does not beat by more than a standard error, the one
    of the fewest parameters. None where the output does not scatter.
    """
    group = runs.group[runs.has_outputs]
    tried: list[HeldOut] = []
    for latent in LATENTS:
        tried += _of_growing_degree(runs, latent, group)
    if not tried:
        return None
    branched = max((one for one in tried if one.terms.latent == BRANCHES), key=lambda one: one.logarithms.mean())
    tried += _kept(runs, [latent_terms(runs.inputs, branched.terms.degree, BRANCHES, 1)], group)
    # Of many that are tried, the best is so by luck too.
    best = max(tried, key=lambda one: one.logarithms.mean())
    close = []
    for one in tried:
        gain, error = mean_by_groups(best.logarithms - one.logarithms, group)
        if gain <= error:
            close.append(one)
    fewest = min(one.terms.parameter_count for one in close)
    alike = [one for one in close if one.terms.parameter_count == fewest]
    return max(alike, key=lambda one: one.logarithms.mean())


def _of_growing_degree(runs: TrainingRuns, latent: str, group: NDArray[np.int64]) -> list[HeldOut]:
    """All degrees from 0 up to where two in a row did not help: of an even law every other one is no use."""
    found: list[HeldOut] = []
    for degree in range(HIGHEST_DEGREE + 1):
        means = [float(one.logarithms.mean()) for one in found]
        if len(means) > 2 and max(means) > max(means[-2:]):
            break
        found += _kept(runs, [latent_terms(runs.inputs, degree, latent)], group)
    return found


def _kept(runs: TrainingRuns, candidates: Sequence[LatentTerms], group: NDArray[np.int64]) -> list[HeldOut]:
    """Those of which the runs support the terms, scored; no inputs always are: that is the law to fall back on."""
    ones = np.ones(len(runs.x))
    few = [one for one in candidates if one.degree == 0 or RUNS_PER_TERM * one.parameter_count <= len(runs.y)]
    found = [_held_out(LatentProblem.of_runs(runs, terms, ones), group) for terms in few]
    return [one for one in found if one is not None]


def _held_out(problem: LatentProblem, group: NDArray[np.int64]) -> HeldOut | None:
    """Follow the noise down until runs in groups left out are foretold worse than before; None where the target, or
    what a fold leaves of it, does not scatter.
    """
    fold = folds_of(group, FOLDS)
    tests = [fold == number for number in range(int(fold.max()) + 1)]
    rests = [problem.of(~test) for test in tests]
    if not all(one.scatters for one in (problem, *rests)):
        return None
    best = HeldOut(problem.terms, 0, np.full(len(group), -np.inf))
    # All folds go down together, so that what single runs make of a little noise need not be found.
    for count, steps in enumerate(zip(*(rest.path(NOISE_SHARES, OF_SCORED) for rest in rests), strict=True), 1):
        logarithms = np.empty(len(group))
        folds = tuple((test, *step) for test, step in zip(tests, steps, strict=True))
        for test, noise, parameters in folds:
            logarithms[test] = problem.of(test).log_densities(parameters, noise)[0]
        if logarithms.mean() <= best.logarithms.mean():
            break
        best = HeldOut(problem.terms, count, logarithms, folds)
    return best
