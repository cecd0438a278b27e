"""The law of the coordinates at given inputs: location, scale, scatter, and chances of outcomes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.basis import Indices
from lithobrake.emulator.ridge_ladder import Ladder, Rung, Smoother, TermTable, best_ladder, fading_rung
from lithobrake.vocabulary.array_types import Array

# Added to a residual's size, as a share of the mean size: one that happens to be near zero says little of the scale,
# but its logarithm would weigh more than all others. Only where the search for the scale begins.
LOGARITHM_FLOOR = 0.15
# A residual counts as no more than this many mean sizes of its place.
LARGEST_SIZE = 4.0
SCALE_STEPS = 3
# Widths of a kernel that looks at all inputs, in units of the root mean square distance of two points, and of one that
# looks at a single input, in deviations of it.
BANDWIDTHS = (0.9, 0.65, 0.35, 0.2)
WIDTHS = (0.8, 0.4, 0.2)
# Of the normal rule for the smoothing; the rule itself would take a third off the skewness of a few hundred rows.
SMOOTHING_FACTOR = 0.5
# Inverse penalties of the slopes, from none to hardly any penalty; the first is as good as no inputs.
INVERSE_PENALTIES = (1e-6, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0)
# Half an event for each class keeps chances of rare classes from 0 and 1. Source: [Firth-1993].
HALF_EVENT = 0.5


@dataclass(frozen=True)
class Choices:
    """What is chosen once and kept in every refit: ladders [coordinate_count] of location and scale, and widths
    [input_count] of the kernel by which rows are drawn, in deviations of the standardised inputs.
    """

    location: tuple[Ladder, ...]
    scale: tuple[Ladder, ...]
    widths: tuple[float, ...]

    @property
    def follows_inputs(self) -> bool:
        return bool(np.isfinite(self.widths).any()) or any(self.location) or any(self.scale)


@dataclass(frozen=True)
class Law:
    """location, log_scale [1 + term_count, coordinate_count]; scale_limits [2, coordinate_count], least and greatest
    logarithm at the runs, beyond which no polynomial is trusted; rows, standardised residuals [row_count,
    coordinate_count], and how often each counts, weights [row_count].
    """

    location: Array
    log_scale: Array
    scale_limits: Array
    rows: Array
    weights: Array

    def at(self, matrix: Array) -> tuple[Array, Array]:
        """Location and scale [point_count, coordinate_count] at terms but the constant [point_count, term_count]."""
        log_scale = self.log_scale[0] + matrix @ self.log_scale[1:]
        return self.location[0] + matrix @ self.location[1:], np.exp(np.clip(log_scale, *self.scale_limits))


def rows_alone(coordinate_count: int, input_count: int) -> Choices:
    return Choices(((),) * coordinate_count, ((),) * coordinate_count, (np.inf,) * input_count)


def best_choices(design: TermTable, coordinates: Array, *, fades: bool = True) -> Choices:
    """Ladders of location and scale of coordinates [run_count, coordinate_count]; rows are drawn alike.

    fades: whether terms may fade as they are learnt to, which takes longest.
    """
    locations, scales = [], []
    for y in coordinates.T:
        location = best_ladder(design, y, fades=fades)
        scale = _best_scale(design, Smoother(design, location).left_out(y), fades)
        locations.append(location)
        scales.append(scale)
    return Choices(tuple(locations), tuple(scales), (np.inf,) * design.indices.shape[1])


def fit_law(design: TermTable, coordinates: Array, choices: Choices) -> Law:
    """Fit the law that was chosen to coordinates [run_count, coordinate_count]."""
    locations, scales, rows, weights = [], [], [], design.weights
    for y, location_ladder, scale_ladder in zip(coordinates.T, choices.location, choices.scale, strict=True):
        smoother = Smoother(design, location_ladder)
        residual = smoother.left_out(y)
        of_scale = Smoother(design, scale_ladder)
        scale = _scale_fit(design, of_scale, np.abs(residual))
        seen = _working(np.abs(residual), design.at(scale))
        # A run that has drawn the scale to itself must not make its own row smaller.
        row = residual / np.exp(seen - of_scale.left_out(seen))
        mean = weights @ row / weights.sum()
        spread = np.sqrt(weights @ (row - mean) ** 2 / weights.sum())
        # Coordinates that do not scatter at all keep rows of zeros.
        rows.append((row - mean) / (spread if spread > 0.0 else 1.0))
        scale[0] += np.log(spread) if spread > 0.0 else 0.0
        locations.append(smoother.coefficients(y))
        scales.append(scale)
    at_runs = np.array([design.at(one)[weights > 0.0] for one in scales])
    # Polynomials of the logarithm grow fast where no run stands, and the scale with their exponential.
    limits = np.array([at_runs.min(axis=1), at_runs.max(axis=1)])
    return Law(np.column_stack(locations), np.column_stack(scales), limits, np.column_stack(rows), weights)


def _best_scale(design: TermTable, residual: Array, fades: bool) -> Ladder:
    """Ladder of the scale of residuals [run_count]."""
    size = np.abs(residual)
    first = best_ladder(design, _log_sizes(size, design.weights), fades=False, doubt=True)
    logarithm = _scale_fit(design, Smoother(design, first), size)
    return best_ladder(design, _working(size, design.at(logarithm)), fades=fades, doubt=True)


def _scale_fit(design: TermTable, smoother: Smoother, size: Array) -> Array:
    """Coefficients [1 + term_count] of the logarithm of the mean size of residuals [run_count].

    From the regression of logarithms by steps of Newton on the likelihood of a mean that is multiplied, which tells
    twice as much of a normal residual. Source: [McCullagh-1989], section 2.5 (working response).
    """
    logarithm = smoother.coefficients(_log_sizes(size, design.weights))
    for _ in range(SCALE_STEPS):
        logarithm = smoother.coefficients(_working(size, design.at(logarithm)))
    return logarithm


def _working(size: Array, logarithm: Array) -> Array:
    """Logarithms of mean sizes with what single residuals [run_count] say of them."""
    return logarithm + np.minimum(size * np.exp(-logarithm), LARGEST_SIZE) - 1.0


def _log_sizes(size: Array, weights: Array) -> Array:
    """Logarithms of sizes of residuals [run_count], kept from running to minus infinity."""
    mean = weights @ size / weights.sum()
    return np.log(size + LOGARITHM_FLOOR * (mean if mean > 0.0 else 1.0))


def kernels(input_count: int) -> list[tuple[float, ...]]:
    """Widths [input_count] of the kernels that rows may be drawn by: first none, which draws from all rows alike."""
    # The root mean square distance of two independent points of variance 1 in each input.
    distance = float(np.sqrt(2.0 * input_count))
    found = [(np.inf,) * input_count, *((one * distance,) * input_count for one in BANDWIDTHS)]
    for width in WIDTHS:
        found += [tuple(width if k == own else np.inf for k in range(input_count)) for own in range(input_count)]
    return list(dict.fromkeys(found))


def row_weights(points: Array, row_points: Array, weights: Array, widths: Sequence[float]) -> Array:
    """Chance of each row at each point, [point_count, row_count], which sums to 1.

    points, row_points: standardised inputs [count, input_count]; weights: how often each row counts [row_count];
    widths [input_count] of the kernel, infinite for inputs that it does not look at.
    """
    used = np.isfinite(widths)
    if not used.any():
        return np.broadcast_to(weights / weights.sum(), (len(points), len(weights)))
    own, others = (table[:, used] / np.asarray(widths)[used] for table in (points, row_points))
    squares = (own**2).sum(axis=1)[:, None] + (others**2).sum(axis=1) - 2.0 * own @ others.T
    # The nearest row has the weight 1, so that a point far from all of them does not divide by zero.
    nearness = weights * np.exp(-0.5 * (squares - squares.min(axis=1, keepdims=True)))
    return nearness / nearness.sum(axis=1, keepdims=True)


def log_row_weights(points: Array, row_points: Array, weights: Array, widths: Sequence[float]) -> Array:
    """Logarithms of the chances of rows [point_count, row_count]; one row for all points where they are alike."""
    alike = points if np.isfinite(widths).any() else points[:1]
    return np.log(np.maximum(row_weights(alike, row_points, weights, widths), np.finfo(float).tiny))


def drawn_rows(chances: Array, count: int, random: np.random.Generator) -> NDArray[np.int64]:
    """Places of rows drawn by their chances [point_count, row_count], shape [point_count, count]."""
    ends = np.cumsum(chances, axis=1)
    ends /= ends[:, -1:]
    uniforms = random.random((len(chances), count))
    # One search for all points: each has its own unit of the axis.
    shift = np.arange(len(chances))[:, None]
    places = np.searchsorted((ends + shift).ravel(), (uniforms + shift).ravel(), side="right")
    found = places.reshape(uniforms.shape) - shift * chances.shape[1]
    return np.minimum(found, chances.shape[1] - 1)


def smoothing(rows: Array, weights: Array, factor: float = SMOOTHING_FACTOR) -> tuple[float, Array]:
    """Size of the smoothing and root of the covariance that it follows, [output_count, output_count].

    factor: of the normal rule.
    """
    # The number of equal weights that would scatter as much: rows that count twice add no detail.
    count, outputs = weights.sum() ** 2 / (weights**2).sum(), rows.shape[1]
    covariance = (rows * weights[:, None]).T @ rows / weights.sum()
    values, vectors = np.linalg.eigh(covariance)
    return factor * count ** (-1.0 / (outputs + 4)), vectors * np.sqrt(np.maximum(values, 0.0))


def smoothed(rows: Array, size: float, root: Array, random: np.random.Generator) -> Array:
    """Rows [..., output_count] with normal noise of this size added and the variance given back."""
    noise = random.standard_normal(rows.shape) @ root.T
    return (rows + size * noise) / np.sqrt(1.0 + size**2)


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
        # No regression can place a class that no run has met: it keeps its small chance everywhere, and the others
        # share the rest.
        logits[:, self.never > 0.0] = -np.inf
        shares = np.exp(logits - logits.max(axis=1, keepdims=True))
        return self.never + (1.0 - self.never.sum()) * shares / shares.sum(axis=1, keepdims=True)


def fit_classes(
    matrix: Array, factors: Array, outcome: NDArray[np.int64], class_count: int, inverse_penalty: float, weights: Array
) -> OutcomeClasses:
    """Fit the chances to runs: terms [run_count, term_count] with their factors, outcome and weights [run_count].

    A class that no run met has the chance 0.5 / (run_count + 1) everywhere. Source: [Heinze-2002].
    """
    return next(_classes_by_penalty(matrix, factors, outcome, class_count, (inverse_penalty,), weights))


def _classes_by_penalty(
    matrix: Array, factors: Array, outcome: NDArray[np.int64], class_count: int, inverse_penalties: Sequence[float],
    weights: Array,
) -> Iterator[OutcomeClasses]:  # fmt: skip
    """The fit of fit_classes at each inverse penalty; each search begins at the slopes of the one before."""
    counts = np.bincount(outcome, minlength=class_count)
    met, total = np.nonzero(counts)[0], weights.sum()
    never = np.where(counts > 0, 0.0, HALF_EVENT / (total + 1.0))
    intercepts, slopes = np.zeros(class_count), np.zeros((class_count, matrix.shape[1]))
    if len(met) < 2:
        yield from (OutcomeClasses(intercepts, slopes, never) for _ in inverse_penalties)
        return
    from sklearn.linear_model import LogisticRegression

    kept = np.nonzero(factors)[0]
    # Half events where all terms are 0 pull on the chances, and on no slope.
    points = np.vstack([matrix[:, kept] * factors[kept], np.zeros((len(met), len(kept)))])
    labels, counted = np.append(outcome, met), np.append(weights, np.full(len(met), HALF_EVENT))
    regression = LogisticRegression(max_iter=1000, tol=1e-6, warm_start=True)
    # Of two classes scikit-learn gives the logit of the second alone.
    first = 1 if len(met) == 2 else 0
    for inverse_penalty in inverse_penalties:
        regression.set_params(C=inverse_penalty).fit(points, labels, sample_weight=counted)
        own, bent = intercepts.copy(), slopes.copy()
        own[met[first:]] = regression.intercept_
        bent[np.ix_(met[first:], kept)] = regression.coef_ * factors[kept]
        yield OutcomeClasses(own, bent, never)


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
            found = _classes_by_penalty(rest, factors, outcome[kept], class_count, INVERSE_PENALTIES, ones)
            for column, classes in enumerate(found):
                own = classes.chances(test)[np.arange(len(test)), outcome[~kept]]
                losses[row, column] -= float(np.log(own).sum())
    row, column = map(int, np.unravel_index(int(np.argmin(losses)), losses.shape))
    rung = _rung(indices, matrix, outcome == output_outcome) if bent[row] else None
    return ClassChoice(INVERSE_PENALTIES[column], rung)


def _rung(indices: Indices, matrix: Array, there: NDArray[np.bool_]) -> Rung:
    rung = fading_rung(TermTable(indices, matrix, np.ones(len(matrix))), there.astype(float))
    return rung if rung is not None else Rung((1.0,) * indices.shape[1], (0.0,) * indices.shape[1], 1, 0.0)
