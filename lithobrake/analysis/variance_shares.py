"""Where the scatter of an output comes from: soil, arrival, bed, place and attitude, chaos."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.bed_components import bed_components
from lithobrake.analysis.confidence import Array, IntervalEstimate, Labels, answers, numbered_beds, t_quantile
from lithobrake.analysis.control_variate import regression_terms
from lithobrake.analysis.side_runs import chaos_variance
from lithobrake.chaos.threads import one_thread

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution

# More terms than this for each run leave too little of the runs to tell scatter by.
TERMS_PER_RUN = 1 / 3


@dataclass(frozen=True)
class VarianceShares:
    """Shares of the total variance of one output over the law of the inputs, beds, places and attitudes.

    They are free of bias and therefore not cut: where there is nothing one may be a little below 0. Soil, arrival,
    bed, place_and_attitude and chaos add up to 1; bounds lie within [0, 1].

    variance              the whole [unit of the output, squared]
    soil, soil_by_input   all terms of soil inputs, with interactions among them; terms of one soil input alone
    arrival               all terms in which another input takes part; None where there is none
    bed                   what landings on one bed have in common
    place_and_attitude    the rest: what inputs and bed do not decide, less chaos where it is known
    chaos                 what twins differ in; None without twins
    """

    variance: float
    soil: IntervalEstimate
    soil_by_input: dict[str, IntervalEstimate]
    arrival: IntervalEstimate | None
    bed: IntervalEstimate
    place_and_attitude: IntervalEstimate
    chaos: IntervalEstimate | None

    def summary(self) -> dict[str, Any]:
        """The shares as `summary.json` holds them: {"share", "lower", "upper"} of each part, or None."""

        def part(one: IntervalEstimate | None) -> dict[str, float] | None:
            return None if one is None else {"share": one.value, "lower": one.lower, "upper": one.upper}

        return {
            "soil": part(self.soil),
            "soil_by_input": {name: part(one) for name, one in self.soil_by_input.items()},
            "arrival": part(self.arrival),
            "bed": part(self.bed),
            "place_and_attitude": part(self.place_and_attitude),
            "chaos": part(self.chaos),
        }


class _Regression(NamedTuple):
    """Least squares on terms: squares [term_count] of coefficients freed of scatter, and the variance of residuals."""

    squares: Array
    scatter: float


@one_thread()
def variance_shares(
    inputs: Mapping[str, "Distribution"],
    x: ArrayLike,
    y: ArrayLike,
    bed: ArrayLike,
    *,
    soil: Collection[str],
    twins: ArrayLike | None = None,
) -> VarianceShares | None:
    """Split the variance of an output y [run_count] (NaN: none) of runs at x [run_count, input_count] on beds.

    soil: names of the inputs that are soil. twins [pair_count]: differences of the output between twins. None where
    the runs cannot tell: one bed, runs all alike, or fewer than three runs for each input. Intervals: of terms by
    leaving out one bed after another, of the bed by F, of chaos by chi-square, of the rest from those of the others.
    Source: [Searle-1992], section 3.6 (analysis of variance); [Sudret-2008], Eq 36 (squares of coefficients).
    """
    of_all = answers("y", y)
    points = _checked_points(inputs, x, of_all, soil)
    known = np.isfinite(of_all)
    points, values = points[known], of_all[known]
    beds = numbered_beds(numbered_beds(bed, len(of_all))[known], len(values))
    if len(values) < 2 or beds.max() == 0 or np.ptp(values) == 0.0:
        return None
    terms, indices = regression_terms(inputs, points)
    used = _affordable(indices, len(values))
    if used is None or len(values) - int(beds.max()) - 2 - used.sum() < 1:
        return None
    terms, indices = terms[:, used], indices[used]
    groups = _groups(inputs, indices, soil)
    found = _regression(terms, values)
    components = bed_components(values, beds, terms)
    explained = float(found.squares.sum())
    total = explained + components.bed_variance + components.within
    table = np.array(list(groups.values()))
    parts = dict(zip(groups, _left_out(terms, values, beds, table, found, total), strict=True))
    correlation, rest = components.correlation, 1.0 - explained / total
    on_bed = _within(correlation.value * rest, correlation.lower * rest, correlation.upper * rest)
    soil_part, arrival = parts.pop("soil"), parts.pop("arrival", None)
    chaos = None if twins is None else _over(chaos_variance(twins), total)
    place = _remainder([one for one in (soil_part, arrival, on_bed, chaos) if one is not None])
    return VarianceShares(total, soil_part, parts, arrival, on_bed, place, chaos)


def _checked_points(inputs: Mapping[str, "Distribution"], x: ArrayLike, y: Array, soil: Collection[str]) -> Array:
    """Points [run_count, input_count] inside the law of the inputs. Raises ValueError for others, and for no inputs."""
    from lithobrake.chaos.basis import checked_points

    points = checked_points(inputs, x)
    if y.shape != (len(points),):
        raise ValueError(f"y has shape {y.shape}; allowed: one number for each of the {len(points)} runs of x")
    if isinstance(soil, str) or not set(soil) <= set(inputs):
        raise ValueError(f"soil is {soil!r}; allowed: some of the inputs {', '.join(inputs)}")
    return points


def _affordable(indices: Labels, run_count: int) -> np.ndarray | None:
    """Which terms of second degree the runs can bear: all, squares alone, none; None where not even linear ones."""
    degree, squares = indices.sum(axis=1), (indices > 0).sum(axis=1) == 1
    for used in (degree > 0, squares, degree == 1):
        if used.sum() <= TERMS_PER_RUN * run_count:
            return used
    return None


def _groups(inputs: Mapping[str, "Distribution"], indices: Labels, soil: Collection[str]) -> dict[str, np.ndarray]:
    """Which terms [term_count] make up each part: soil, each soil input by its name, arrival where there is one."""
    is_soil = np.array([name in soil for name in inputs])
    of_soil = (indices[:, ~is_soil] == 0).all(axis=1)
    alone = (indices > 0).sum(axis=1) == 1
    groups = {"soil": of_soil}
    groups |= {name: alone & (indices[:, k] > 0) for k, name in enumerate(inputs) if is_soil[k]}
    return groups if is_soil.all() else groups | {"arrival": ~of_soil}


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
) -> list[IntervalEstimate]:
    """Shares of groups [group_count, term_count] of terms, with intervals from leaving out each bed in turn.

    A share that comes out below 0 counts as 0 for its upper bound: evenly spread runs have less scatter in their
    coefficients than is taken off, and no bound should say that there is surely nothing.
    Source: [Davison-1997], section 2.7 (jackknife), beds as units.
    """
    rows = []
    for number in range(beds.max() + 1):
        left = _regression(terms[beds != number], y[beds != number])
        rows.append(groups @ left.squares / (left.squares.sum() + left.scatter))
    count = len(rows)
    half = t_quantile(count - 1) * np.sqrt((count - 1) * np.var(rows, axis=0))
    shares = groups @ found.squares / total
    return [_within(s, s - h, max(s, 0.0) + h) for s, h in zip(shares.tolist(), half.tolist(), strict=True)]


def _remainder(parts: list[IntervalEstimate]) -> IntervalEstimate:
    """What parts leave of 1, its bounds from theirs. Source: [Zou-2008] (recovered variances)."""
    share = 1.0 - sum(part.value for part in parts)
    down = np.sqrt(sum((part.upper - part.value) ** 2 for part in parts))
    up = np.sqrt(sum((part.value - part.lower) ** 2 for part in parts))
    return _within(share, share - float(down), share + float(up))


def _over(variance: IntervalEstimate, total: float) -> IntervalEstimate:
    return _within(variance.value / total, variance.lower / total, variance.upper / total)


def _within(value: float, lower: float, upper: float) -> IntervalEstimate:
    """Bounds within [0, 1]; the value as it is."""
    return IntervalEstimate(value, min(max(lower, 0.0), 1.0), min(max(upper, 0.0), 1.0))
