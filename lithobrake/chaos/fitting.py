"""The one entry, from runs to an expansion, and the default way of fitting."""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.chaos import degree_selection
from lithobrake.chaos.basis import multi_index_set, points_of
from lithobrake.chaos.dependence import dependent_inputs
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.gaussian_process import GaussianProcess, expansion_of, families_for, fit_process, fresh_germs
from lithobrake.chaos.scores import replicates, with_noise
from lithobrake.chaos.sparse_regression import is_structured, solve_sparse
from lithobrake.chaos.storage import data_hash
from lithobrake.chaos.surrogate import Surrogate
from lithobrake.chaos.training_data import Training, checked_training, one_thread
from lithobrake.vocabulary.array_types import Array

# A process costs the cube of the number of points; with more of them least squares is accurate enough.
PROCESS_LIMIT = 2000
PROCESS_FROM = 5
MARGIN, MARGIN_IN_TAILS = 0.95, 0.3
# The sum of squared polynomials up to this degree is 121 at the ends of a uniform input, 2900 for a normal one cut
# at three standard deviations.
TAIL_DEGREE, TAIL_GROWTH, TAIL_DISTANCE = 10, 2000.0, 3.0
CHALLENGER = "gaussian process with nugget, radial Matern 5/2"
METHODS = ("ols", "lars", "omp", "gaussian_process")


def _as_solution(process: GaussianProcess, training: Training) -> degree_selection.Solution:
    indices, coefficients, cut = expansion_of(process, training.inputs)
    # The error of cutting the projection adds to that of the process.
    expected = float(np.hypot(process.expected_error(fresh_germs(training.inputs)[1]), cut))
    facts = {"noise_std": process.scale * float(np.sqrt(process.noise)), "covariance": process.covariance.name}
    return degree_selection.Solution(
        "gaussian_process", indices, coefficients, expected, "leave-one-out and predicted variance", facts
    )


def _constant(training: Training, output: int) -> bool:
    return bool(np.ptp(training.y[:, output]) == 0.0)


def process_solution(training: Training, output: int) -> degree_selection.Solution:
    if training.count < PROCESS_FROM or training.count > PROCESS_LIMIT:
        raise ValueError(
            f"{training.count} points are given, but gaussian_process takes {PROCESS_FROM} to {PROCESS_LIMIT}: use ols"
        )
    if _constant(training, output):
        return degree_selection.ols_by_degree(training)[0][output]
    candidates = [
        _as_solution(fit_process(training, output, family), training)
        for family in families_for(list(training.inputs.values()))
    ]
    return min(candidates, key=lambda one: one.expected_error)


def has_long_tails(entry: Distribution) -> bool:
    """Whether the ends of an input are so rare that polynomials fitted to few runs are free to grow there."""
    if not entry.bounded:
        return True
    table = entry.recurrence(int(min(TAIL_DEGREE, entry.highest_degree))).values(entry.germ(np.array(entry.support)))
    # Of samples that sum is at most their number, so for them the distance from the mean in standard deviations tells.
    far = np.isfinite(entry.highest_degree) and float(np.abs(table[1]).max()) > TAIL_DISTANCE
    return bool(far) or float((table**2).sum(axis=0).max()) > TAIL_GROWTH


def _preferred(candidates: list[degree_selection.Solution], margin: float) -> degree_selection.Solution:
    """The smallest expected error; but least squares and the pursuit must beat a process by a margin.

    Where scatter makes many candidates nearly equal the smallest estimate is partly luck, and the processes, which
    shrink what the data do not support, lose least by it; the more so in long tails, of which no estimate knows much.
    """
    processes = [one for one in candidates if one.method == "gaussian_process"]
    best = min(candidates, key=lambda one: one.expected_error)
    if not processes:
        return best
    process = min(processes, key=lambda one: one.expected_error)
    return best if best.expected_error < margin * process.expected_error else process


def best_solutions(
    training: Training, progress: Callable[[int, int], None]
) -> tuple[list[degree_selection.Solution], dict[str, Any]]:
    """The best solution of each output, and for the report all candidates and the challenger, scored alike.

    Candidates are least squares of every degree that the points determine and the projections of the processes, scored
    by leave-one-out, which is honest for both (few parameters are learnt from many points), and by what they predict
    where no run stands; and orthogonal matching pursuit, scored by folds over its whole path. On a grid, where folds
    extrapolate, the pursuit does not take part.
    """
    ladder = degree_selection.ols_by_degree(training)
    grid = is_structured(training.x)
    # The likelihood of a process has no place for weights.
    use_processes = PROCESS_FROM <= training.count <= PROCESS_LIMIT and training.weights is None
    margin = MARGIN_IN_TAILS if any(has_long_tails(entry) for entry in training.inputs.values()) else MARGIN
    chosen: list[degree_selection.Solution] = []
    table: dict[str, dict[str, float]] = {}
    challenger: dict[str, float | None] = {}
    for output in degree_selection.with_progress(range(len(training.output_names)), progress):
        name = training.output_names[output]
        scores = {f"ols degree {degree}": row[output] for degree, row in enumerate(ladder)}
        challenger[name] = None
        if use_processes and not _constant(training, output):
            for family in families_for(list(training.inputs.values())):
                process = fit_process(training, output, family)
                scores[f"gaussian_process {family.name}"] = _as_solution(process, training)
                if family.name == "matern":
                    challenger[name] = process.expected_error(fresh_germs(training.inputs)[1])
            if not grid:
                scores["omp"] = solve_sparse(training, output, "omp", degree=None, q_norm=None)
        best = _preferred(list(scores.values()), margin)
        scatter = [one for one in scores.values() if "noise_std" in one.facts]
        if scatter and "noise_std" not in best.facts:
            # The nugget of the best process tells the scatter whichever expansion is taken.
            likeliest = min(scatter, key=lambda one: one.expected_error)
            best = replace(best, facts={**best.facts, "noise_std": likeliest.facts["noise_std"]})
        chosen.append(best)
        table[name] = {label: one.expected_error for label, one in scores.items()}
    return chosen, {"candidates": table, "challenger": {"model": CHALLENGER, "rmse_estimate": challenger}}


@one_thread()
def fit(
    inputs: Mapping[str, Distribution],
    x: ArrayLike,
    y: ArrayLike,
    degree: int | None = None,
    method: str | None = None,
    *,
    q_norm: float | None = None,
    max_degrees: Sequence[int] | None = None,
    weights: ArrayLike | None = None,
    output_names: Sequence[str] | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Surrogate:
    """Fit an expansion to runs: x [count, input_count] physical units, y [count] or [count, output_count].

    degree: total degree; None chooses it by cross-validation. method: "ols" least squares; "lars", "omp" sparse;
    "gaussian_process" the projection of a process on the basis; None with a degree is "ols", None without a degree
    takes for each output whichever of least squares, pursuit and processes has the smallest estimated error.
    q_norm: hyperbolic index set, None is 1 (sparse methods without a degree choose). max_degrees: highest degree of
    each input, and weights: of the points [count], both for "ols". Rows of y that are all NaN are dropped and counted.
    progress: called with the number of outputs that are fitted, and that of all.
    Warns where inputs depend on each other in the runs, as moments and indices are those of independent ones.
    Raises ValueError for fewer points than terms, rank deficiency and data that `checked_training` refuses.
    Source: [Landings-PCE], Eqs 13 to 17.
    """
    if method is None and any(one is not None for one in (degree, q_norm, max_degrees, weights)):
        method = "ols"
    _check_request(degree, method, max_degrees, weights)
    training = checked_training(inputs, x, y, output_names=output_names, weights=weights)
    together = _told_together(training, np.unique(points_of(training.inputs, x), axis=0))
    outputs = degree_selection.with_progress(range(training.y.shape[1]), progress)
    extra: dict[str, Any] = {}
    if method is None:
        solutions, extra = best_solutions(training, progress)
    elif method == "ols":
        norm = 1.0 if q_norm is None else q_norm
        if degree is None:
            indices = degree_selection.best_terms(training, norm, max_degrees)
        else:
            indices = multi_index_set(len(inputs), degree, q_norm=norm, max_degrees=max_degrees)
        solutions = degree_selection.solve_ols(training, indices)
    elif method == "gaussian_process":
        solutions = [process_solution(training, k) for k in outputs]
    else:
        solutions = [solve_sparse(training, k, method, degree=degree, q_norm=q_norm) for k in outputs]
    return _assembled(training, solutions, extra | together)


def _told_together(training: Training, points: Array) -> dict[str, Any]:
    """For the report the pairs of inputs that depend on each other in the runs, with a warning where there are any.

    points [count, input_count]: those of all runs, missing ones too, each once.
    """
    pairs = [] if training.weights is not None else dependent_inputs(training.inputs, points)
    if pairs:
        worst = max(pairs, key=lambda pair: abs(pair[2]))
        warnings.warn(
            f"{worst[0]} and {worst[1]} depend on each other in the runs (rank correlation {worst[2]:.2f}), but "
            "moments and Sobol indices of an expansion are those of independent inputs: take shapley_effects, and "
            "moments of its values at dependent points",
            stacklevel=4,
        )
    return {"dependent_inputs": [list(pair) for pair in pairs]}


def _check_request(degree: Any, method: str | None, max_degrees: Any, weights: Any) -> None:
    if method is not None and method not in METHODS:
        raise ValueError(f"method is {method!r}, but must be one of {', '.join(METHODS)}")
    if method == "gaussian_process" and degree is not None:
        raise ValueError(f"degree is {degree}, but the method gaussian_process chooses its terms: leave degree out")
    if method != "ols" and (weights is not None or max_degrees is not None):
        raise ValueError(f"weights and max_degrees are for the method ols, but the method is {method}: leave them out")


def _assembled(training: Training, solutions: list[degree_selection.Solution], extra: dict[str, Any]) -> Surrogate:
    indices, coefficients = degree_selection.joined(solutions)
    report = {**degree_selection.summary(solutions, training.output_names, training.y), **extra}
    # Rounding would give a constant output a variance of 1e-32, and with it meaningless shares.
    constant = np.ptp(training.y, axis=0) == 0.0
    coefficients[:, constant] = np.where(indices.sum(axis=1) == 0, 1.0, 0.0)[:, None] * training.y[0, constant]
    pooled = replicates(training.x, training.y) if training.groups else None
    facts = {
        "degree": int(indices.sum(axis=1).max()),
        "train_count": training.count,
        "dropped_count": training.dropped_count,
        "data_hash": data_hash(training.x, training.y),
    }
    surrogate = Surrogate(
        training.inputs,
        indices,
        coefficients,
        output_names=training.output_names,
        one_dimensional=training.one_dimensional,
        report={**with_noise(report, pooled), **facts},
    )
    known = [one.residuals for one in solutions if one.residuals is not None]
    if len(known) == len(solutions):
        surrogate.residuals = np.column_stack(known)
    else:
        surrogate.residuals = training.y - surrogate.evaluated(training.x)
    return surrogate
