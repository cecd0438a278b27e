"""Where the scatter of an output comes from: soil, arrival, attitude, bed, chaos, and everything else."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis import confidence
from lithobrake.analysis.control_variate import chaos_variance
from lithobrake.analysis.missing_runs import Limits, filled, lost_runs, none_bounds
from lithobrake.analysis.variance_terms import (
    ROUNDING,
    Regression,
    affordable_terms,
    checked_attitude,
    filled_shares,
    regression,
)
from lithobrake.chaos.basis import checked_points
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.training_data import one_thread
from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.estimate import Estimate


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

    @property
    def _known(self) -> dict[str, Estimate]:
        """The parts that are known, by their names, without those of single soil inputs."""
        found = {name: getattr(self, name) for name in ("soil", "arrival", "attitude", "bed", "place", "chaos")}
        return {name: one for name, one in found.items() if one is not None}

    def _with(self, changed: Callable[[str, Estimate], Estimate]) -> "VarianceShares":
        by_input = {name: changed(name, one) for name, one in self.soil_by_input.items()}
        parts: dict[str, Any] = {name: changed(name, one) for name, one in self._known.items()}
        return replace(self, soil_by_input=by_input, **parts)

    def without_bounds(self, why: str) -> "VarianceShares":
        """The same parts without intervals, for a reason."""
        return self._with(lambda name, one: replace(one, lower=None, upper=None, why_missing=why))

    def over(self, others: Sequence[tuple[float, Mapping[str, float]]]) -> "VarianceShares":
        """The same with intervals that hold the parts of others, each a variance and its shares, not cut, by name.

        As far beyond the others as the intervals reach beyond the parts themselves.
        """

        def widened(name: str, one: Estimate) -> Estimate:
            if name == "chaos":
                found = [min(one.value * self.variance / total, 1.0) for total, _ in others]
            elif name == "place":
                found = [1.0 - sum(shares[part] for part in self._known if part in shares) for _, shares in others]
                found = [rest - (0.0 if self.chaos is None else self.chaos.value * self.variance / total)
                         for rest, (total, _) in zip(found, others, strict=True)]  # fmt: skip
            else:
                found = [shares[name] for _, shares in others if name in shares]
            cut = [min(max(share, 0.0), 1.0) for share in (*found, one.value)]
            assert one.bounds is not None
            lower, upper = min(cut) - (one.value - one.bounds[0]), max(cut) + (one.bounds[1] - one.value)
            return replace(one, lower=max(lower, 0.0), upper=min(upper, 1.0))

        return self._with(widened)


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
    missing: ArrayLike | None = None,
    limits: Limits | None = None,
) -> VarianceShares | None:
    """Split the variance of an output y [run_count] (NaN: none) of runs at x [run_count, input_count] on beds.

    soil: names of the inputs that are soil. attitude [run_count, term_count]: terms of the attitude, of mean 0,
    variance 1 and no correlation over its law. twins [pair_count]: differences of the output between twins. None where
    the runs cannot tell: one bed, runs all alike or alike on each bed, or fewer than three runs for each input.
    missing [run_count]: whether it is not known what became of a run, so that it may have the output or not; limits:
    least and most that a run may have, each a number or [run_count]. Bounds of a part reach to its smallest and its
    largest share over missing runs that have all the least, all the most, or of both what adds to or takes from one of
    the parts; without limits there are none.
    Intervals: of terms by leaving out one bed after another, of the bed by F, of chaos by chi-square, of the rest from
    those of the others.
    Source: [Searle-1992], section 3.6 (analysis of variance); [Sudret-2008], Eq 36 (squares of coefficients).
    """
    of_all = confidence.answers("y", y)
    points = _checked_points(inputs, x, of_all, soil)
    lost = lost_runs(missing, of_all)
    found = _of_known(inputs, points, of_all, bed, soil, attitude, twins)
    if found is None or not lost.any():
        return found
    if limits is None:
        return found.without_bounds(none_bounds(lost, "the variance"))
    fills = list(filled_shares(inputs, points, of_all, bed, soil, attitude, filled(of_all, lost, limits)))
    return found.over([one for one in fills if one is not None])


def _of_known(
    inputs: Mapping[str, Distribution], points: Array, of_all: Array, bed: ArrayLike, soil: Collection[str],
    attitude: ArrayLike | None, twins: ArrayLike | None,
) -> VarianceShares | None:  # fmt: skip
    """The parts of the variance of the runs that have the output."""
    known = np.isfinite(of_all)
    values, beds = confidence.answered_runs(of_all, bed)
    points = points[known]
    if len(values) < 2 or beds.max() == 0 or np.ptp(values) == 0.0:
        return None
    used = affordable_terms(inputs, points, soil, checked_attitude(attitude, known))
    if used is None or len(values) - int(beds.max()) - 2 - used.matrix.shape[1] < 1:
        return None
    found = regression(used.matrix, values)
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


def _left_out(terms: Array, y: Array, beds: Labels, groups: np.ndarray, found: Regression, total: float) -> list[_Part]:
    """Shares of groups [group_count, term_count] of terms, with intervals from leaving out each bed in turn.

    Source: [Davison-1997], section 2.7 (jackknife), beds as units.
    """
    rows = []
    for number in range(beds.max() + 1):
        others = beds != number
        # What varies on one bed alone, as a rare event, has no parts without it.
        if np.ptp(y[others]) == 0.0:
            rows.append(np.zeros(len(groups)))
            continue
        left = regression(terms[others], y[others])
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
