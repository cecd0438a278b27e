"""The chances of the outcomes at given inputs: a ridge logistic regression that knows rare classes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.vocabulary.arrays import Array

# Inverse penalties of the slopes, from none to hardly any penalty; the first is as good as no inputs.
INVERSE_PENALTIES = (1e-6, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0)
# Half an event for each class keeps chances of rare classes from 0 and 1. Source: [Firth-1993].
HALF_EVENT = 0.5


@dataclass(frozen=True)
class OutcomeClasses:
    """intercepts [class_count] and slopes [class_count, input_count] of the logits, in standardised inputs.

    never: chances of the classes that no run met [class_count], 0 for the others, whose logits they do not enter.
    """

    intercepts: Array
    slopes: Array
    never: Array

    def chances(self, linear: Array) -> Array:
        """Chances of the classes [point_count, class_count] at standardised inputs [point_count, input_count]."""
        logits = self.intercepts + linear @ self.slopes.T
        logits[:, self.never > 0.0] = -np.inf
        shares = np.exp(logits - logits.max(axis=1, keepdims=True))
        return self.never + (1.0 - self.never.sum()) * shares / shares.sum(axis=1, keepdims=True)


def fit_classes(
    linear: Array, outcome: NDArray[np.int64], class_count: int, inverse_penalty: float, weights: Array
) -> OutcomeClasses:
    """Fit the chances to runs: standardised inputs [run_count, input_count], outcome and weights [run_count].

    A class that no run met has the chance .5 / (run_count + 1) everywhere. Source: [Heinze-2002].
    """
    counts = np.bincount(outcome, minlength=class_count)
    met, total = np.nonzero(counts)[0], weights.sum()
    never = np.where(counts > 0, 0.0, HALF_EVENT / (total + 1.0))
    intercepts, slopes = np.zeros(class_count), np.zeros((class_count, linear.shape[1]))
    if len(met) > 1:
        from sklearn.linear_model import LogisticRegression

        # Half events at the middle of the inputs pull on the chances, and on no slope.
        points = np.vstack([linear, np.zeros((len(met), linear.shape[1]))])
        counted = np.append(weights, np.full(len(met), HALF_EVENT))
        regression = LogisticRegression(C=inverse_penalty, max_iter=1000, tol=1e-8)
        regression.fit(points, np.append(outcome, met), sample_weight=counted)
        # Of two classes scikit-learn gives the logit of the second alone.
        first = 1 if len(met) == 2 else 0
        intercepts[met[first:]], slopes[met[first:]] = regression.intercept_, regression.coef_
    return OutcomeClasses(intercepts, slopes, never)


def best_inverse_penalty(linear: Array, outcome: NDArray[np.int64], class_count: int, fold: NDArray[np.int64]) -> float:
    """Inverse penalty of least log loss on folds that were left out; fold [run_count] numbers them from 0."""
    if len(np.unique(outcome)) == 1:
        return INVERSE_PENALTIES[0]
    losses = []
    for inverse_penalty in INVERSE_PENALTIES:
        loss = 0.0
        for number in range(int(fold.max()) + 1):
            kept = fold != number
            classes = fit_classes(linear[kept], outcome[kept], class_count, inverse_penalty, np.ones(kept.sum()))
            chances = classes.chances(linear[~kept])
            loss -= float(np.log(chances[np.arange(len(chances)), outcome[~kept]]).sum())
        losses.append(loss)
    return INVERSE_PENALTIES[int(np.argmin(losses))]
