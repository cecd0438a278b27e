"""Location and scale: ridges that walk from no inputs to all of them, and one that learns how its terms fade."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import groupby, product

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, optimize

from lithobrake.chaos.basis import Indices
from lithobrake.vocabulary.array_types import Array

# Logarithms of amplitudes, fades and penalty in units of the number of runs: first values and bounds. The likelihood of
# a smooth law and that of one that bends have peaks of their own, so fades start at two.
AMPLITUDE, AMPLITUDES = -1.0, (-5.0, 2.0)
FADES_FIRST, FADES = (-0.9, -0.1), (-4.0, 0.2)
PENALTY, FADING_PENALTIES = -5.0, (-23.0, 2.0)
STEPS = 60
# Change of the evidence at which a search ends.
TOLERANCE = 1e-2
REFUSED = 1e10
# Of a rung that walks: the deviation of a square beside that of a linear term. Finer steps gave the same errors.
FADE = 0.4
# Penalties in units of the number of runs: of a term of an orthonormal basis 1 / (1 + penalty) is left.
PENALTIES = (1e-5, 1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0)
# With more inputs than this a ridge that walks has no products and squares: of thirty inputs there are 465, for each of
# as many sets of inputs, which takes minutes and tells more than any runs do.
MOST_OF_SECOND_DEGREE = 12
# Rungs of less weight are left out of the average.
LEAST_WEIGHT = 0.005
# Of a learnt rung an input takes no part if less than this is left of each of its terms.
LEAST_LEFT = 0.1
# Of a run, what a fit has to leave of it for its residual to be inflated in full.
LEAST_FREE = 0.05


@dataclass(frozen=True)
class _Sums:
    """Sums of squares of centred terms [term_count, term_count], with the target, and of the target, of count runs."""

    gram: Array
    moments: Array
    total: float
    count: float


def exponents(indices: Indices) -> Array:
    """Powers of amplitudes and of fades in the deviation of each term, [term_count, 2 * input_count]."""
    return np.hstack([indices > 0, np.maximum(indices - 1, 0)]).astype(float)


def learnt(indices: Indices, sums: _Sums) -> tuple[float, Array]:
    """Evidence, the logarithm of the marginal likelihood over that of no inputs, and logarithms of amplitudes, fades
    and penalty [2 * input_count + 1].
    """
    inputs = indices.shape[1]
    search = partial(
        optimize.minimize, _loss, args=(exponents(indices), sums), jac=True, method="L-BFGS-B",
        bounds=[*[AMPLITUDES] * inputs, *[FADES] * inputs, FADING_PENALTIES],
        options={"maxiter": STEPS, "ftol": TOLERANCE / sums.count},
    )  # fmt: skip
    found = [search(np.array([*[AMPLITUDE] * inputs, *[fade] * inputs, PENALTY])) for fade in FADES_FIRST]
    best = min(found, key=lambda one: float(one.fun))
    return -float(best.fun), np.asarray(best.x)


def _loss(vector: Array, powers: Array, sums: _Sums) -> tuple[float, Array]:
    """Negative evidence and its gradient; the deviation of the scatter is that of most evidence."""
    factors, ridge = np.exp(powers @ vector[:-1]), sums.count * np.exp(vector[-1])
    scaled = factors[:, None] * sums.gram * factors
    np.einsum("ii->i", scaled)[:] += ridge
    # LAPACK itself: what SciPy checks around it takes as long as the matrix, and the search asks thousands of times.
    lower, failed = linalg.lapack.dpotrf(scaled, lower=1, overwrite_a=1)
    if failed:
        # The search steps back from parameters for which rounding makes the matrix indefinite.
        return REFUSED, np.zeros_like(vector)
    weighted = factors * sums.moments
    slopes = linalg.lapack.dpotrs(lower, weighted, lower=1)[0]
    # Rounding may leave nothing, or less, of outputs without scatter.
    unexplained = max(1.0 - float(weighted @ slopes) / sums.total, 1e-12)
    value = 0.5 * (sums.count - 1.0) * np.log(unexplained)
    value += np.log(lower.diagonal()).sum() - 0.5 * len(factors) * np.log(ridge)
    diagonal = linalg.lapack.dpotri(lower, lower=1, overwrite_c=1)[0].diagonal()
    by_factor = 1.0 - ridge * diagonal - ridge * slopes**2 * (sums.count - 1.0) / (unexplained * sums.total)
    # The penalty is one over the square of a factor that all terms have.
    return float(value), np.append(powers.T @ by_factor, -0.5 * by_factor.sum())


@dataclass(frozen=True)
class Rung:
    """A ridge: amplitude of each input, 0 where it is left out, and fade by each further degree [input_count], total
    degree, penalty, and weight in the average of a ladder.
    """

    amplitudes: tuple[float, ...]
    fades: tuple[float, ...]
    degree: int
    penalty: float
    weight: float = 1.0

    def factors(self, indices: Indices) -> Array:
        """Factor of each term [term_count]; 0 leaves it out."""
        return factors_of([self], indices)[0]


def factors_of(rungs: Sequence[Rung], indices: Indices) -> Array:
    """Factors of the terms of each rung [rung_count, term_count]; 0 leaves a term out."""
    amplitudes, fades = (np.array([getattr(one, name) for one in rungs])[:, None] for name in ("amplitudes", "fades"))
    # Terms are many and powers are few: each power is taken once.
    powers = np.arange(indices.max(initial=1) + 1)[:, None]
    table = np.where(powers > 0, amplitudes * fades ** np.maximum(powers - 1, 0), 1.0)
    factors = table[:, indices, np.arange(indices.shape[1])].prod(axis=2)
    return np.asarray(factors * (indices.sum(axis=1) <= np.array([one.degree for one in rungs])[:, None]))


# What of an average is not there is no inputs at all.
Ladder = tuple[Rung, ...]


class TermTable:
    """Terms at runs that count as often as weights say: matrix [count, term_count], the constant left out."""

    def __init__(self, indices: Indices, matrix: Array, weights: Array) -> None:
        self.indices, self.matrix, self.weights, self.total = indices, matrix, weights, float(weights.sum())
        self.centre = weights @ matrix / self.total
        self.centred = matrix - self.centre
        # By columns, as LAPACK has its matrices, which else would be copied.
        self.gram = np.asfortranarray(self.centred.T @ (weights[:, None] * self.centred))

    def of(self, chosen: NDArray[np.bool_]) -> "TermTable":
        """That of some of the runs, chosen [count]."""
        return TermTable(self.indices, self.matrix[chosen], self.weights[chosen])

    def sums(self, target: Array) -> _Sums:
        """The sums of squares of which ridges on a target [count] are made."""
        y = target - self.weights @ target / self.total
        weighted = self.weights * y
        return _Sums(self.gram, self.centred.T @ weighted, float(y @ weighted), self.total)

    def at(self, coefficients: Array) -> Array:
        """What coefficients [1 + term_count] of an expansion give at the runs [count]."""
        return np.asarray(coefficients[0] + self.matrix @ coefficients[1:])


def best_ladder(design: TermTable, target: Array, *, fades: bool = True, doubt: bool = False) -> Ladder:
    """Rungs and their weights for a target [count].

    Inputs are added one at a time, the one of most evidence first; all rungs on the way enter the average, and so does
    one with amplitudes and fades of most evidence, if fades is true. doubt: no inputs are as likely as all rungs
    together, before the runs are seen, and not as each.
    """
    sums = design.sums(target)
    if sums.total <= 1e-24 * sums.count * float(np.abs(target).max()) ** 2:
        return ()
    rungs = _walked(design.indices, sums)
    if fades:
        evidence, faded = _fading(design.indices, sums)
        rungs.append((evidence, lambda: faded))
    return _averaged(rungs, len(rungs) if doubt else 1)


def fading_rung(design: TermTable, target: Array) -> Rung | None:
    """The rung of learnt amplitudes and fades; None where the target [count] is constant or no input counts."""
    sums = design.sums(target)
    if sums.total <= 0.0:
        return None
    rung = _fading(design.indices, sums)[1]
    return rung if any(rung.amplitudes) else None


def _walked(indices: Indices, sums: _Sums) -> list[tuple[float, Callable[[], Rung]]]:
    """Evidences over that of no inputs of rungs on growing sets of inputs, and what makes each rung: few are kept."""
    rungs: list[tuple[float, Callable[[], Rung]]] = []
    count = indices.shape[1]
    used, left = np.zeros(count, dtype=bool), list(range(count))
    while left:
        sets = used | np.eye(count, dtype=bool)[left]
        degrees = (1, 2) if used.sum() < MOST_OF_SECOND_DEGREE else (1,)
        evidences = np.stack([_evidences(indices, sets, degree, sums) for degree in degrees], axis=1)
        places = product(sets, degrees, PENALTIES)
        rungs += [(one, partial(_rung, *place)) for one, place in zip(evidences.ravel().tolist(), places, strict=True)]
        used[left.pop(int(np.argmax(evidences.max(axis=(1, 2)))))] = True
    return rungs


def _rung(inputs: NDArray[np.bool_], degree: int, penalty: float) -> Rung:
    """The rung on a set of inputs [input_count]."""
    return Rung(tuple((FADE * inputs).tolist()), (FADE,) * len(inputs), degree, penalty * FADE**2)


def _evidences(indices: Indices, sets: NDArray[np.bool_], degree: int, sums: _Sums) -> Array:
    """Evidence, the logarithm of the marginal likelihood over that of no inputs, of rungs on sets of inputs
    [set_count, input_count], for each penalty, [set_count, penalty_count].
    """
    total = indices.sum(axis=1)
    factors = FADE ** (total - 1.0)
    gram, moments = factors[:, None] * sums.gram * factors, factors * sums.moments
    kept = (total <= degree) & ~(~sets @ (indices > 0).T)
    ridges = sums.count * np.array(PENALTIES)[:, None]
    sizes, evidences = kept.sum(axis=1), np.empty((len(sets), len(PENALTIES)))
    # Sets of as many terms are one call: the matrices are small, and calls are what takes time.
    for size in np.unique(sizes).tolist():
        alike = sizes == size
        terms = np.nonzero(kept[alike])[1].reshape(-1, size)
        values, vectors = np.linalg.eigh(gram[terms[:, :, None], terms[:, None]])
        squares = (vectors.transpose(0, 2, 1) @ moments[terms][:, :, None])[:, None, :, 0] ** 2
        values = np.maximum(values, 0.0)[:, None]
        unexplained = np.maximum(1.0 - (squares / (values + ridges)).sum(axis=2) / sums.total, 1e-12)
        # Of a normal law whose scatter is unknown, with the constant integrated out: so count - 1.
        logarithms = np.log1p(values / ridges).sum(axis=2)
        evidences[alike] = -0.5 * ((sums.count - 1.0) * np.log(unexplained) + logarithms)
    return evidences


def _fading(indices: Indices, sums: _Sums) -> tuple[float, Rung]:
    """The rung of most evidence, less what its parameters would gain by luck. Source: [Schwarz-1978]."""
    inputs = indices.shape[1]
    evidence, logarithms = learnt(indices, sums)
    amplitudes, fades = np.exp(logarithms[:inputs]), np.exp(logarithms[inputs:-1])
    squares = np.exp(2.0 * exponents(indices) @ logarithms[:-1] - logarithms[-1])
    kept = np.max((indices > 0) * squares[:, None], axis=0) > LEAST_LEFT
    cost = 0.5 * np.log(sums.count) * (1.0 + 2.0 * kept.sum())
    degree = int(indices.sum(axis=1).max())
    rung = Rung(tuple((amplitudes * kept).tolist()), tuple(fades.tolist()), degree, float(np.exp(logarithms[-1])))
    return evidence - float(cost), rung


def _averaged(rungs: list[tuple[float, Callable[[], Rung]]], alone: float) -> Ladder:
    """Rungs weighted by their evidence; those of little weight and no inputs at all take part in the sum alone.

    alone: weight of no inputs beside that of a rung of the same evidence.
    """
    evidences = np.array([evidence for evidence, _ in rungs])
    most = max(0.0, float(evidences.max()))
    weights = np.exp(evidences - most)
    weights /= weights.sum() + alone * np.exp(-most)
    kept = weights >= LEAST_WEIGHT
    share = weights.sum() / weights[kept].sum() if kept.any() else 1.0
    return tuple(
        replace(rung(), weight=float(weight * share))
        for (_, rung), weight, keep in zip(rungs, weights, kept, strict=True)
        if keep
    )


class Smoother:
    """The average of the ridges of a ladder, which is one linear smoother: of any target, at one cost."""

    def __init__(self, design: TermTable, ladder: Ladder) -> None:
        self.design = design
        # What the ridges have in common is the inverse that takes moments to slopes.
        self.inverse = np.zeros_like(design.gram)
        # Rungs that differ in their penalty alone have their eigenvectors in common.
        alike = [
            list(rungs) for _, rungs in groupby(ladder, key=lambda rung: (rung.amplitudes, rung.fades, rung.degree))
        ]
        factors = factors_of([rungs[0] for rungs in alike], design.indices) if alike else ()
        for rungs, scale in zip(alike, factors, strict=True):
            kept = np.nonzero(scale)[0]
            block, scaled = np.ix_(kept, kept), scale[kept]
            values, vectors = np.linalg.eigh(scaled[:, None] * design.gram[block] * scaled)
            weights, penalties = np.array([(rung.weight, rung.penalty) for rung in rungs]).T[:, :, None]
            damped = (weights / (np.maximum(values, 0.0) + penalties * design.total)).sum(axis=0)
            self.inverse[block] += scaled[:, None] * ((vectors * damped) @ vectors.T) * scaled

    def coefficients(self, target: Array) -> Array:
        """Coefficients of a target [count], the constant first, [1 + term_count]."""
        design = self.design
        mean = design.weights @ target / design.total
        slopes = self.inverse @ (design.centred.T @ (design.weights * (target - mean)))
        return np.append(mean - design.centre @ slopes, slopes)

    def left_out(self, target: Array) -> Array:
        """Residuals of a target [count] at each run by the fit without it, or without one of its copies, [count]."""
        design = self.design
        fitted = design.at(self.coefficients(target))
        leverage = 1.0 / design.total + ((design.centred @ self.inverse) * design.centred).sum(axis=1)
        # A run that its fit passes through has no residual to inflate.
        return (target - fitted) / np.maximum(1.0 - leverage, LEAST_FREE)
