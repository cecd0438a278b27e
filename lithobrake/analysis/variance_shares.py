"""Where the scatter of an output comes from: soil, arrival, attitude, bed, chaos, and everything else."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis import confidence
from lithobrake.analysis.control_variate import chaos_variance, regression_terms
from lithobrake.chaos.basis import checked_points
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.training_data import one_thread
from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.estimate import Estimate

# More terms than this for each run leave too little of the runs to tell scatter by.
TERMS_PER_RUN = 1 / 3
# A scatter within beds that is less than this part of the whole is rounding.
ROUNDING = 1e-12
BOTH = "terms of first and second degree"


@dataclass(frozen=True)
class VarianceShares:
    """Shares of the total variance of one output over the input distributions, beds, impact points and attitudes.

    Each part lies within its interval and within [0, 1]. Soil, arrival, attitude, bed, place and chaos add up to 1,
    place being what the others leave (0 where they leave nothing). `unbiased` has the parts before they are cut: free
    of bias, below 0 by chance where there is nothing, and with the sum 1 exactly.

    variance              the whole [unit of the output, squared]
    soil, soil_by_input   at least so much: terms of first and second degree of soil inputs, with products among them;
                          terms of one soil input alone. What the soil does in another form, as waves or products of
                          three, is part of place
    arrival               the same of all terms in which another input takes part; None where there is none
    attitude              at least so much: the given terms of the attitude; None where none were given, or the runs are
                          too few for them
    bed                   what landings on one bed have in common
    place                 everything else: impact point, lack of fit and interactions, less chaos where it is known
    chaos                 what twins differ in; None without twins
    unbiased              values before the cut, by the names of the parts
    terms                 of which degree the terms are that the runs could bear, in words
    """

    variance: float
    soil: Estimate
    soil_by_input: dict[str, Estimate]
    arrival: Estimate | None
    attitude: Estimate | None
    bed: Estimate
    place: Estimate
    chaos: Estimate | None
    unbiased: dict[str, float]
    terms: str

    @property
    def soil_doubled(self) -> Estimate:
        """At least so much would be the soil's with input distributions twice as wide, everything else as it is.

        Terms of first degree have four times the variance then, those of higher degree more; each distribution is
        widened on its own scale, that of the logarithm where it has one.
        """
        return self.soil.on_scale(lambda share: 4.0 * share / (1.0 + 3.0 * share))


class _Part(NamedTuple):
    """A share of the variance, free of bias and not cut, with its bounds, not cut either, and its bounds to print."""

    value: float
    lower: float
    upper: float
    printed: confidence.Bounds

    @classmethod
    def of(cls, value: float, half: float) -> "_Part":
        """A share with half its interval; a share outside [0, 1] has the bounds to print of that end.

        Evenly spread runs have less scatter in their coefficients than is taken off, and no bound should say that there
        is surely nothing.
        """
        nearest = min(max(value, 0.0), 1.0)
        return cls(value, value - half, value + half, (nearest - half, nearest + half))

    def estimate(self) -> Estimate:
        """The share to print, within its bounds and within [0, 1]."""
        value = min(max(self.value, 0.0), 1.0)
        return Estimate(value, min(max(self.printed[0], 0.0), value), max(min(self.printed[1], 1.0), value))


class _Terms(NamedTuple):
    """Terms to regress on: matrix [run_count, term_count], by part which of them make it up [term_count], in words."""

    matrix: Array
    groups: dict[str, np.ndarray]
    words: str


class _Regression(NamedTuple):
    """Least squares on terms: squares [term_count] of coefficients freed of scatter, and the variance of residuals."""

    squares: Array
    scatter: float


@one_thread()
def variance_shares(
    inputs: Mapping[str, Distribution],
    x: ArrayLike,
    y: ArrayLike,
    bed: ArrayLike,
    *,
    soil: Collection[str],
    attitude: ArrayLike | None = None,
    twins: ArrayLike | None = None,
) -> VarianceShares | None:
    """Split the variance of an output y [run_count] (NaN: none) of runs at x [run_count, input_count] on beds.

    soil: names of the inputs that are soil. attitude [run_count, term_count]: terms of the attitude, of mean 0,
    variance 1 and no correlation over its law. twins [pair_count]: differences of the output between twins. None where
    the runs cannot tell: one bed, runs all alike or alike on each bed, or fewer than three runs for each input.
    Intervals: of terms by leaving out one bed after another, of the bed by F, of chaos by chi-square, of the rest from
    those of the others.
    Source: [Searle-1992], section 3.6 (analysis of variance); [Sudret-2008], Eq 36 (squares of coefficients).
    """
    of_all = confidence.answers("y", y)
    points = _checked_points(inputs, x, of_all, soil)
    known = np.isfinite(of_all)
    values, beds = confidence.answered_runs(of_all, bed)
    points = points[known]
    if len(values) < 2 or beds.max() == 0 or np.ptp(values) == 0.0:
        return None
    used = _affordable(inputs, points, soil, _checked_attitude(attitude, known))
    if used is None or len(values) - int(beds.max()) - 2 - used.matrix.shape[1] < 1:
        return None
    found = _regression(used.matrix, values)
    components = confidence.bed_components(values, beds, used.matrix)
    if components.within <= ROUNDING * float(np.var(values)):
        return None
    explained = float(found.squares.sum())
    total = explained + components.bed_variance + components.within
    of_terms = _left_out(used.matrix, values, beds, np.array(list(used.groups.values())), found, total)
    parts = dict(zip(used.groups, of_terms, strict=True)) | {"bed": _of_beds(components, 1.0 - explained / total)}
    if twins is not None:
        parts["chaos"] = _of_chaos(chaos_variance(twins), total)
    return _printed(total, parts, [name for name in inputs if name in soil], used.words)


def _printed(total: float, parts: dict[str, _Part], soil: Collection[str], words: str) -> VarianceShares:
    """Parts by name, those of single soil inputs among them, as they are printed, with what they leave."""
    by_input = {name: parts.pop(name).estimate() for name in soil}
    printed = {name: part.estimate() for name, part in parts.items()}
    rest = _remainder(list(parts.values()))
    return VarianceShares(
        total,
        printed["soil"],
        by_input,
        printed.get("arrival"),
        printed.get("attitude"),
        printed["bed"],
        _completing(rest, list(printed.values())),
        printed.get("chaos"),
        {name: part.value for name, part in parts.items()} | {"place": rest.value},
        words,
    )


def _checked_points(inputs: Mapping[str, Distribution], x: ArrayLike, y: Array, soil: Collection[str]) -> Array:
    """Points [run_count, input_count] inside the law of the inputs. Raises ValueError for others, and for no inputs."""
    points = checked_points(inputs, x)
    if y.shape != (len(points),):
        raise ValueError(f"y has shape {y.shape}; allowed: one number for each of the {len(points)} runs of x")
    if isinstance(soil, str) or not set(soil) <= set(inputs):
        raise ValueError(f"soil is {soil!r}; allowed: some of the inputs {', '.join(inputs)}")
    return points


def _checked_attitude(attitude: ArrayLike | None, known: np.ndarray) -> Array:
    """Terms of the attitude of the runs that are known, [known_count, term_count]. Raises ValueError for others."""
    if attitude is None:
        return np.empty((int(known.sum()), 0))
    terms = np.asarray(attitude, dtype=float)
    if terms.ndim != 2 or len(terms) != len(known) or not np.isfinite(terms).all():
        raise ValueError(
            f"attitude has shape {terms.shape}; allowed: finite numbers [run_count, term_count], a row for each of the "
            f"{len(known)} runs of x"
        )
    return terms[known]


def _affordable(
    inputs: Mapping[str, Distribution], points: Array, soil: Collection[str], attitude: Array
) -> _Terms | None:
    """The terms that the runs can bear; None where not even linear ones.

    Of second degree all, or squares alone, or none; where there are still too many, the attitude goes unseen.
    """
    terms, indices = regression_terms(inputs, points)
    degree, squares = indices.sum(axis=1), (indices > 0).sum(axis=1) == 1
    choices = ((degree > 0, BOTH), (squares, f"{BOTH}, without products"), (degree == 1, "terms of first degree"))
    for extra in (attitude, attitude[:, :0]):
        for used, words in choices:
            count = int(used.sum()) + extra.shape[1]
            if count <= TERMS_PER_RUN * len(points):
                groups = _groups(inputs, indices[used], soil, extra.shape[1])
                return _Terms(np.hstack([terms[:, used], extra]), groups, words)
    return None


def _groups(
    inputs: Mapping[str, Distribution], indices: Labels, soil: Collection[str], attitude_count: int
) -> dict[str, np.ndarray]:
    """Which terms make up each part: soil, each soil input by its name, arrival and attitude where there are any.

    [term_count], those of the attitude last.
    """
    is_soil = np.array([name in soil for name in inputs])
    of_soil = (indices[:, ~is_soil] == 0).all(axis=1)
    alone = (indices > 0).sum(axis=1) == 1
    groups = {"soil": of_soil}
    groups |= {name: alone & (indices[:, k] > 0) for k, name in enumerate(inputs) if is_soil[k]}
    groups |= {} if is_soil.all() else {"arrival": ~of_soil}
    groups = {name: np.append(group, np.zeros(attitude_count, dtype=bool)) for name, group in groups.items()}
    if attitude_count:
        groups["attitude"] = np.arange(len(indices) + attitude_count) >= len(indices)
    return groups


def _regression(terms: Array, y: Array) -> _Regression:
    """Scatter adds its variance to each squared coefficient; it is taken off. Source: [Searle-1992], section 3.5."""
    orthogonal, triangle = np.linalg.qr(np.column_stack([np.ones(len(y)), terms]))
    inverse = np.linalg.inv(triangle)
    projected = orthogonal.T @ y
    residuals = y - orthogonal @ projected
    scatter = float(residuals @ residuals) / (len(y) - len(projected))
    squares = (inverse @ projected) ** 2 - scatter * np.sum(inverse**2, axis=1)
    return _Regression(squares[1:], scatter)


def _left_out(
    terms: Array, y: Array, beds: Labels, groups: np.ndarray, found: _Regression, total: float
) -> list[_Part]:
    """Shares of groups [group_count, term_count] of terms, with intervals from leaving out each bed in turn.

    Source: [Davison-1997], section 2.7 (jackknife), beds as units.
    """
    rows = []
    for number in range(beds.max() + 1):
        left = _regression(terms[beds != number], y[beds != number])
        rows.append(groups @ left.squares / (left.squares.sum() + left.scatter))
    count = len(rows)
    half = confidence.t_quantile(count - 1) * np.sqrt((count - 1) * np.var(rows, axis=0))
    shares = groups @ found.squares / total
    return [_Part.of(s, h) for s, h in zip(shares.tolist(), half.tolist(), strict=True)]


def _of_beds(components: confidence.BedComponents, rest: float) -> _Part:
    """Share of the beds in the whole, of which inputs leave a rest.

    Beds that differ less than chance has it have the upper bound to print of beds that differ as chance has it: else an
    estimate below 0 could pass for certainty that there is nothing.
    """
    tails = [0.5 + side * confidence.LEVEL for side in (-0.5, 0.5)]
    variances = [components.bed_variance, *(components.variance_at(tail, cut=False) for tail in tails)]
    variances.append(components.positive.variance_at(tails[1]))
    value, lower, upper, most = (rest * components.correlation_at(one) for one in variances)
    return _Part(value, lower, upper, (lower, most))


def _of_chaos(chaos: Estimate, total: float) -> _Part:
    """Share of chaos in the whole; one above 1 has the bounds to print of 1: chi-square intervals scale with values."""
    assert chaos.bounds is not None
    value, bounds = chaos.value / total, (chaos.bounds[0] / total, chaos.bounds[1] / total)
    excess = max(value, 1.0)
    return _Part(value, *bounds, (bounds[0] / excess, bounds[1] / excess))


def _remainder(parts: list[_Part]) -> _Part:
    """What parts leave of 1, its bounds from theirs, and outside [0, 1] those to print of the nearest end.

    Twins may show more than the whole variance; that is no certainty that nothing else has a part in it.
    Source: [Zou-2008] (recovered variances).
    """
    share = 1.0 - sum(part.value for part in parts)
    down = np.sqrt(sum((part.upper - part.value) ** 2 for part in parts))
    up = np.sqrt(sum((part.value - part.lower) ** 2 for part in parts))
    nearest = min(max(share, 0.0), 1.0)
    return _Part(share, share - float(down), share + float(up), (nearest - float(down), nearest + float(up)))


def _completing(rest: _Part, others: list[Estimate]) -> Estimate:
    """The remainder to print: what the others, as printed, leave of 1; its interval holds it."""
    value = min(max(1.0 - sum(one.value for one in others), 0.0), 1.0)
    lower, upper = (min(max(bound, 0.0), 1.0) for bound in rest.printed)
    return Estimate(value, min(lower, value), max(upper, value))
