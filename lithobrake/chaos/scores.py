"""How well a model meets known outputs, and how far runs of equal inputs scatter."""

from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import finite_number, without_rounding

Score = dict[str, Any]


def absolute_percentage_error(predicted: Array, y: Array) -> Array:
    """APE = 100 |predicted - y| / |y| [%], elementwise; where y is 0 it is 0 for an exact prediction, else infinite.

    Source: [Landings-PCE], Eq 24 (with |y|, since an output may be negative).
    """
    error = np.abs(predicted - y)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(error == 0.0, 0.0, 100.0 * error / np.abs(y))


def varies(y: Array) -> bool:
    """Whether values [count] differ by more than rounding."""
    return bool(np.ptp(without_rounding(y)) > 0.0)


def score_of(predicted: Array, y: Array) -> Score:
    """Scores of one output from predicted and true values [count].

    ape [%] list; mape [%]; rmse [unit of the output]; std, that of y (population); rrmse = rmse / std;
    q2 = 1 - rrmse**2, the explained share of the variance. For constant y: rrmse 0 if exact to
    rounding, else infinite.
    """
    error = predicted - y
    ape = absolute_percentage_error(predicted, y)
    # By rounding the standard deviation of equal values need not be 0.
    rmse, std = float(np.sqrt(np.mean(error**2))), float(np.std(y)) if varies(y) else 0.0
    rrmse = rmse / std if std > 0.0 else (float("inf") if varies(np.append(predicted, y)) else 0.0)
    return {
        "mape": float(np.mean(ape)),
        "q2": 1.0 - rrmse**2,
        "rrmse": rrmse,
        "rmse": rmse,
        "std": std,
        "ape": ape.tolist(),
    }


@dataclass(frozen=True)
class Replicates:
    """Pooled scatter of runs with equal inputs: std [output_count], from `freedom` degrees of freedom.

    variances [group_count, output_count] of the groups with at least two runs; points [group_count, input_count];
    sizes [group_count]; correlation of the scatter between outputs [output_count, output_count]; deviations
    [run_count, output_count] of their runs from their means, widened to the spread of single runs.
    """

    std: Array
    freedom: int
    points: Array
    variances: Array
    sizes: NDArray[np.int64]
    correlation: Array
    deviations: Array


def equal_rows(x: Array) -> NDArray[np.int64]:
    """Group number of each row of x [count, input_count], [count]: equal rows have equal numbers."""
    order = np.lexsort(x.T[::-1])
    changes = (x[order[1:]] != x[order[:-1]]).any(axis=1)
    group = np.zeros(len(x), dtype=np.int64)
    group[order[1:]] = np.cumsum(changes)
    return group


def replicates(x: Array, y: Array) -> Replicates | None:
    """Find repeated rows of x [count, input_count] and pool the scatter of y [count, output_count]; None if no repeats.

    Source: [Montgomery-2012], pure error.
    """
    group = equal_rows(x)
    sizes = np.bincount(group).astype(np.int64)
    freedom = int((sizes - 1).sum())
    if freedom == 0:
        return None
    means = np.stack([np.bincount(group, weights=column) / sizes for column in y.T], axis=1)
    deviation = y - means[group]
    squares = np.stack([np.bincount(group, weights=column**2) for column in deviation.T], axis=1)
    several = sizes > 1
    widened = deviation * np.sqrt(sizes / np.maximum(sizes - 1, 1))[group][:, None]
    points = np.empty((len(sizes), x.shape[1]))
    points[group] = x
    pooled = np.sqrt(squares.sum(axis=0) / freedom)
    cross = deviation.T @ deviation / freedom
    scale = np.where(pooled > 0.0, pooled, 1.0)
    correlation = np.where(np.eye(len(scale)) > 0.0, 1.0, cross / np.outer(scale, scale))
    variances = squares[several] / (sizes[several] - 1)[:, None]
    return Replicates(pooled, freedom, points[several], variances, sizes[several], correlation, widened[several[group]])


def with_noise(report: dict[str, Any], pooled: Replicates | None) -> dict[str, Any]:
    """Add to a report the scatter of each output: of repeated points where there are, else the nugget of a process.

    The expected error holds the scatter, so a larger nugget is only the smallest that the process can do with.
    """
    if pooled is None:
        for entry in report["outputs"].values():
            entry["noise_from"] = "nugget of a Gaussian process" if "noise_std" in entry else None
            if entry.get("noise_std", 0.0) > entry["rmse_estimate"]:
                entry["noise_std"], entry["noise_from"] = entry["rmse_estimate"], "expected error, below the nugget"
        return report
    for k, entry in enumerate(report["outputs"].values()):
        entry["noise_std"] = float(pooled.std[k])
        entry["noise_from"] = f"repeated points, {pooled.freedom} degrees of freedom"
    return report


def runs_needed(report: dict[str, Any], target: float) -> dict[str, dict[str, Any]]:
    """How many more runs bring the error at a new run down to `target`, relative to the spread; by output name.

    floor: the part that is scatter, which no expansion removes; now: the expected error; more_runs: 0, a number, or
    None where none would help; sentence. The squared error above the floor is taken to fall as one over the number of
    runs: so it does where scatter is its cause; a smooth output needs fewer.
    Raises ValueError unless target is above 0, and for a report without error estimates.
    """
    finite_number("target", target, above=0.0)
    answers = {}
    for name, entry in report.get("outputs", {}).items():
        now = entry["rrmse_estimate"]
        if now is None:
            answers[name] = {"floor": 0.0, "now": 0.0, "more_runs": 0, "sentence": f"{name} does not vary."}
            continue
        spread = entry["rmse_estimate"] / now if now > 0.0 else 1.0
        # The scatter of a few repeats may come out above the expected error, of which it is a part.
        floor = min(float(entry.get("noise_std") or 0.0) / spread, now)
        answers[name] = {"floor": floor, "now": now, **_answer(name, now, floor, target, report["train_count"])}
    if not answers:
        raise ValueError("this expansion holds no error estimate, so runs_needed has nothing to go by: fit it anew")
    return answers


def _answer(name: str, now: float, floor: float, target: float, count: int) -> dict[str, Any]:
    if now <= target:
        return {"more_runs": 0, "sentence": f"{name} is at {now:.3g} and meets {target:.3g} already."}
    if target <= floor:
        text = f"{name} is at {now:.3g}, but its scatter alone is {floor:.3g}: no number of runs reaches {target:.3g}."
        return {"more_runs": None, "sentence": text}
    total = count * (now**2 - floor**2) / (target**2 - floor**2)
    more = max(1, ceil(total) - count)
    return {"more_runs": more, "sentence": f"{name} is at {now:.3g}: about {more} more runs would reach {target:.3g}."}
