"""Inputs that depend on each other: their law, what each explains of an output, and how runs show it."""

import math
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy import linalg, special, stats

from lithobrake.chaos.design import from_uniforms, sobol_sequence
from lithobrake.chaos.distributions import Distribution, Normal
from lithobrake.chaos.numerical_distributions import checked_inputs
from lithobrake.chaos.storage import inputs_to_json
from lithobrake.chaos.surrogate import Surrogate
from lithobrake.chaos.training_data import one_thread
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.constants import LEAST_PROBABILITY
from lithobrake.vocabulary.given_numbers import numbers, random_numbers, sample_count

# Every set of players is sampled, and there are two to the power of their number.
MOST_PLAYERS = 10
SHAPLEY_SAMPLES = 20_000
# The chance to call any pair of independent inputs dependent, and the rank correlation below which none is.
FALSE_ALARM, WEAK = 1e-3, 0.1


class GaussianCopula:
    """Inputs with given distributions and Spearman rank correlations [input_count, input_count].

    `fit` takes its points like any others. The expansion's own moments and indices are those of independent inputs;
    those of dependent ones are moments of its values at many dependent points, and `shapley_effects`.
    Raises ValueError unless the matrix is symmetric with ones on its diagonal and can be that of a Gaussian copula.
    Source: [Nataf-1962]; [Lebrun-2009]; r = 2 sin(pi rho / 6), [Kruskal-1958], for the normal correlation.
    """

    def __init__(self, inputs: Mapping[str, Distribution], rank_correlation: ArrayLike) -> None:
        self.inputs = checked_inputs(inputs)
        matrix = numbers("rank_correlation", rank_correlation)
        size = len(self.inputs)
        if matrix.shape != (size, size) or not np.allclose(matrix, matrix.T, rtol=0.0, atol=1e-12):
            raise ValueError(f"rank_correlation has shape {matrix.shape}, but must be symmetric, [{size}, {size}]")
        if not np.all(np.diag(matrix) == 1.0) or np.abs(matrix).max() > 1.0:
            raise ValueError("rank_correlation must have ones on its diagonal and nothing outside -1 to 1")
        normal = 2.0 * np.sin(np.pi * matrix / 6.0)
        # 2 sin(pi / 6) is 1 only up to rounding.
        np.fill_diagonal(normal, 1.0)
        smallest = float(np.linalg.eigvalsh(normal)[0])
        if smallest <= 1e-10:
            raise ValueError(
                f"rank_correlation gives normals whose correlation matrix has the eigenvalue {smallest:.3g}, but all "
                "must be above 0: weaken the correlations that contradict each other"
            )
        self.normal_correlation = normal
        self._factor = np.linalg.cholesky(normal)

    @one_thread()
    def sobol_sequence(self, count: int, *, seed: int = 0) -> Array:
        """Dependent points from a scrambled Sobol sequence, physical units, [count, input_count]."""
        independent = {name: Normal(0.0, 1.0) for name in self.inputs}
        return self.points(sobol_sequence(independent, count, seed=seed) @ self._factor.T)

    def points(self, normal: Array) -> Array:
        """Points in physical units from normal ones of this correlation, each [count, input_count]."""
        return from_uniforms(self.inputs, special.ndtr(normal))

    def drawn_again(self, normal: Array, kept: Sequence[int], fresh: Array) -> Array:
        """Normal points [count, input_count] that keep the columns named, the others drawn given these.

        fresh: independent standard normals [count, input_count].
        """
        others = [column for column in range(len(self.inputs)) if column not in kept]
        matrix, again = self.normal_correlation, normal.copy()
        between = matrix[np.ix_(others, kept)]
        slopes = np.linalg.solve(matrix[np.ix_(kept, kept)], between.T).T
        factor = np.linalg.cholesky(matrix[np.ix_(others, others)] - slopes @ between.T)
        again[:, others] = normal[:, kept] @ slopes.T + fresh[:, others] @ factor.T
        return again

    def dependent(self, points: ArrayLike) -> Array:
        """Dependent points from independent ones of the same inputs, both physical, [count, input_count].

        Each column follows from those up to it, the first stays as it is, and a row from that row alone.
        """
        independent = numbers("points", points)
        normal = self._normal(independent)
        # Not by a matrix product, whose rounding depends on how many rows there are.
        together = np.stack([(normal * row).sum(axis=1) for row in self._factor], axis=1)
        found = self.points(together)
        found[:, 0] = independent[:, 0]
        return found

    def independent(self, points: ArrayLike) -> Array:
        """The independent points that dependent ones came from by `dependent`, both physical, [count, input_count]."""
        given = numbers("points", points)
        together = self._normal(given)
        normal = linalg.solve_triangular(self._factor, together.T, lower=True).T
        found = self.points(normal)
        found[:, 0] = given[:, 0]
        return found

    def _normal(self, points: Array) -> Array:
        """Standard normals by input of points in physical units, each [count, input_count]."""
        uniforms = [entry.cdf(points[:, k]) for k, entry in enumerate(self.inputs.values())]
        return np.asarray(special.ndtri(np.clip(np.column_stack(uniforms), LEAST_PROBABILITY, 1.0 - LEAST_PROBABILITY)))


class ShapleyEffects(NamedTuple):
    """Shares of the variance, whose sum is 1, or 0 where nothing varies.

    names: of inputs and groups; share, error: of each for each output, and the standard error of sampling,
    [name_count, output_count] ([name_count] for a one-dimensional y).
    """

    names: list[str]
    share: Array
    error: Array


@one_thread()
def shapley_effects(
    surrogate: Surrogate,
    copula: GaussianCopula,
    *,
    groups: Mapping[str, Sequence[str]] | None = None,
    count: int = SHAPLEY_SAMPLES,
    seed: int = 0,
) -> ShapleyEffects:
    """Share of the variance of an expansion that each input explains where inputs depend on each other.

    An input gets the mean, over all orders in which inputs may become known, of what it then explains: what two of them
    explain together is shared between them. Of independent inputs this is a value between the first-order and the total
    index. groups: name -> inputs that count as one, such as those of one covariance; the others stand alone. Every set
    of inputs is drawn `count` times with the rest given the set. Scatter about the expansion is left out.
    Raises ValueError for inputs of other names or laws, groups that share inputs, and more than 10 inputs and groups.
    Source: [Owen-2014]; [Song-2016].
    """
    if inputs_to_json(copula.inputs) != inputs_to_json(surrogate.inputs):
        raise ValueError(
            f"the copula has the inputs {', '.join(copula.inputs)}: give it those of the expansion, with their laws, "
            "in order"
        )
    players = _players(surrogate, groups or {})
    columns, random = list(players.values()), random_numbers(seed)
    size = sample_count("count", count, len(surrogate.inputs) + len(players) * len(surrogate.output_names), at_least=2)
    factor = np.linalg.cholesky(copula.normal_correlation)
    normal = random.standard_normal((size, len(factor))) @ factor.T
    values = _centred(surrogate, copula, normal)
    # What a set explains is the covariance of values that share it; its product of each sample is kept by player.
    products = np.zeros((len(players), *values.shape))
    for known in _sets(len(players)):
        kept = [column for player in known for column in columns[player]]
        if len(known) == len(players):
            explained = values**2
        else:
            again = copula.drawn_again(normal, kept, random.standard_normal((size, len(factor))))
            explained = values * _centred(surrogate, copula, again)
        for player in range(len(players)):
            products[player] += _weight(len(players), len(known), player in known) * explained
    return _shares(surrogate, list(players), products, values**2)


def _shares(surrogate: Surrogate, names: list[str], products: Array, squares: Array) -> ShapleyEffects:
    """From products [player_count, count, output_count] and squared deviations [count, output_count]."""
    variance = squares.mean(axis=0)
    scale = np.where(variance > 0.0, variance, 1.0)
    share = products.mean(axis=1) / scale
    error = (products - share[:, None] * squares).std(axis=1) / scale / math.sqrt(len(squares))
    return ShapleyEffects(names, surrogate.shaped(share), surrogate.shaped(error))


def _centred(surrogate: Surrogate, copula: GaussianCopula, normal: Array) -> Array:
    values = surrogate.evaluated(copula.points(normal))
    return np.asarray(values - values.mean(axis=0))


def _players(surrogate: Surrogate, groups: Mapping[str, Sequence[str]]) -> dict[str, list[int]]:
    """Columns of each input or group of inputs that counts as one, by its name."""
    columns = {name: surrogate.columns(members) for name, members in groups.items()}
    grouped = [column for members in columns.values() for column in members]
    alone = {name: [column] for column, name in enumerate(surrogate.input_names) if column not in grouped}
    if len(set(grouped)) < len(grouped) or not all(columns.values()) or set(alone) & set(columns):
        raise ValueError("groups must have names and inputs of their own, at least one input each")
    if len(alone) + len(columns) > MOST_PLAYERS:
        raise ValueError(
            f"there are {len(alone) + len(columns)} inputs and groups, but at most {MOST_PLAYERS} can be told apart: "
            "give groups of inputs"
        )
    return columns | alone


def _sets(count: int) -> list[tuple[int, ...]]:
    """All sets of players but the empty one, which explains nothing."""
    return [known for size in range(1, count + 1) for known in combinations(range(count), size)]


def _weight(count: int, size: int, member: bool) -> float:
    """Of what a set of this size explains, in the Shapley value of a player who is a member of it or is not."""
    if member:
        return 1.0 / (count * math.comb(count - 1, size - 1))
    return -1.0 / (count * math.comb(count - 1, size))


def dependent_inputs(inputs: Mapping[str, Distribution], x: Array) -> list[tuple[str, str, float]]:
    """Pairs of inputs whose values in the points x [count, input_count] go together, with their rank correlation.

    A pair counts if its correlation is at least 0.1 and would arise among independent inputs, in any pair, with a
    probability below 0.001. Dependence in which neither rises nor falls with the other is not seen.
    """
    names, count = list(inputs), len(x)
    pairs = list(combinations(range(len(names)), 2))
    if count < 5 or not pairs:
        return []
    ranks = stats.rankdata(x, axis=0)
    ranks -= ranks.mean(axis=0)
    size = np.sqrt((ranks**2).sum(axis=0))
    limit = math.tanh(special.ndtri(1.0 - 0.5 * FALSE_ALARM / len(pairs)) / math.sqrt(count - 3))
    found = []
    for first, second in pairs:
        if size[first] * size[second] > 0.0:
            correlation = float(ranks[:, first] @ ranks[:, second] / (size[first] * size[second]))
            if abs(correlation) > max(limit, WEAK):
                found.append((names[first], names[second], correlation))
    return found
