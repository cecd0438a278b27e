"""The chances of the outcomes at given inputs: a ridge logistic regression that knows rare classes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.multi_index import Indices
from lithobrake.emulator.ridge_ladder import Rung, TermTable, fading_rung
from lithobrake.vocabulary.arrays import Array

# Inverse penalties of the slopes, from none to hardly any penalty; the first is as good as no inputs.
INVERSE_PENALTIES = (1e-6, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0)
# Half an event for each class keeps chances of rare classes from 0 and 1. Source: [Firth-1993].
HALF_EVENT = 0.5


@dataclass(frozen=True)
class ClassChoice:
    """Inverse penalty of the slopes, and the rung whose factors the terms have; None: linear terms alone."""

    inverse_penalty: float
    rung: Rung | None

    def factors(self, indices: Indices) -> Array:
        """Factor of each term [term_count], at most 1; 0 leaves it out."""
        if self.rung is None:
            return (indices.sum(axis=1) == 1).astype(float)
        factors = self.rung.factors(indices)
        return np.asarray(factors / factors.max())


@dataclass(frozen=True)
class OutcomeClasses:
    """intercepts [class_count] and slopes [class_count, term_count] of the logits, of terms but the constant.

    never: chances of the classes that no run met [class_count], 0 for the others, whose logits they do not enter.
    """

    intercepts: Array
    slopes: Array
    never: Array

    def chances(self, matrix: Array) -> Array:
        """Chances of the classes [point_count, class_count] at terms [point_count, term_count]."""
        logits = self.intercepts + matrix @ self.slopes.T
        logits[:, self.never > 0.0] = -np.inf
        shares = np.exp(logits - logits.max(axis=1, keepdims=True))
        return self.never + (1.0 - self.never.sum()) * shares / shares.sum(axis=1, keepdims=True)


def fit_classes(
    matrix: Array, factors: Array, outcome: NDArray[np.int64], class_count: int, inverse_penalty: float, weights: Array
) -> OutcomeClasses:
    """Fit the chances to runs: terms [run_count, term_count] with their factors, outcome and weights [run_count].

    A class that no run met has the chance 0.5 / (run_count + 1) everywhere. Source: [Heinze-2002].
    """
    counts = np.bincount(outcome, minlength=class_count)
    met, total = np.nonzero(counts)[0], weights.sum()
    never = np.where(counts > 0, 0.0, HALF_EVENT / (total + 1.0))
    intercepts, slopes = np.zeros(class_count), np.zeros((class_count, matrix.shape[1]))
    if len(met) > 1:
        from sklearn.linear_model import LogisticRegression

        kept = np.nonzero(factors)[0]
        # Half events where all terms are 0 pull on the chances, and on no slope.
        points = np.vstack([matrix[:, kept] * factors[kept], np.zeros((len(met), len(kept)))])
        counted = np.append(weights, np.full(len(met), HALF_EVENT))
        regression = LogisticRegression(C=inverse_penalty, max_iter=1000, tol=1e-6)
        regression.fit(points, np.append(outcome, met), sample_weight=counted)
        # Of two classes scikit-learn gives the logit of the second alone.
        first = 1 if len(met) == 2 else 0
        intercepts[met[first:]] = regression.intercept_
        slopes[np.ix_(met[first:], kept)] = regression.coef_ * factors[kept]
    return OutcomeClasses(intercepts, slopes, never)


def best_class_choice(
    indices: Indices, matrix: Array, outcome: NDArray[np.int64], output_outcome: int, class_count: int,
    fold: NDArray[np.int64],
) -> ClassChoice:  # fmt: skip
    """Terms and inverse penalty of least log loss on folds that were left out; fold [run_count] numbers them from 0.

    Terms fade as those of the chance of outputs do, learnt without the fold.
    """
    if len(np.unique(outcome)) == 1:
        return ClassChoice(INVERSE_PENALTIES[0], None)
    bent = (False, True) if (outcome != output_outcome).any() and (outcome == output_outcome).any() else (False,)
    losses = np.zeros((len(bent), len(INVERSE_PENALTIES)))
    for number in range(int(fold.max()) + 1):
        kept = fold != number
        rest, test, ones = matrix[kept], matrix[~kept], np.ones(kept.sum())
        for row, bends in enumerate(bent):
            rung = _rung(indices, rest, outcome[kept] == output_outcome) if bends else None
            factors = ClassChoice(0.0, rung).factors(indices)
            for column, inverse_penalty in enumerate(INVERSE_PENALTIES):
                classes = fit_classes(rest, factors, outcome[kept], class_count, inverse_penalty, ones)
                own = classes.chances(test)[np.arange(len(test)), outcome[~kept]]
                losses[row, column] -= float(np.log(own).sum())
    row, column = map(int, np.unravel_index(int(np.argmin(losses)), losses.shape))
    rung = _rung(indices, matrix, outcome == output_outcome) if bent[row] else None
    return ClassChoice(INVERSE_PENALTIES[column], rung)


def _rung(indices: Indices, matrix: Array, there: NDArray[np.bool_]) -> Rung:
    """How terms fade in the chance of outputs."""
    rung = fading_rung(TermTable(indices, matrix, np.ones(len(matrix))), there.astype(float))
    return rung if rung is not None else Rung((1.0,) * indices.shape[1], (0.0,) * indices.shape[1], 1, 0.0)
