"""How well a model meets known outputs: percentage errors beside the explained share of the variance."""

from typing import Any

import numpy as np

from lithobrake.vocabulary.arrays import Array

Score = dict[str, Any]


def absolute_percentage_error(predicted: Array, y: Array) -> Array:
    """APE = 100 |predicted - y| / |y| [%], elementwise; where y is 0 it is 0 for an exact prediction, else infinite.

    Source: [Landings-PCE], Eq 24 (with |y|, since an output may be negative).
    """
    error = np.abs(predicted - y)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(error == 0.0, 0.0, 100.0 * error / np.abs(y))


def score_of(predicted: Array, y: Array) -> Score:
    """Scores of one output from predicted and true values [count].

    ape [%] list; mape [%]; rmse [unit of the output]; std, that of y (population); rrmse = rmse / std;
    q2 = 1 - rrmse**2, the explained share of the variance. For constant y: rrmse 0 if exact, else infinite.
    """
    error = predicted - y
    ape = absolute_percentage_error(predicted, y)
    rmse, std = float(np.sqrt(np.mean(error**2))), float(np.std(y)) if np.ptp(y) > 0.0 else 0.0
    rrmse = rmse / std if std > 0.0 else (0.0 if rmse == 0.0 else float("inf"))
    return {
        "mape": float(np.mean(ape)),
        "q2": 1.0 - rrmse**2,
        "rrmse": rrmse,
        "rmse": rmse,
        "std": std,
        "ape": ape.tolist(),
    }
