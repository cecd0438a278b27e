"""The chances of the ways in which a touchdown may end, and intervals of shares that only the emulator gives."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import LEVEL, share_interval, t_quantile
from lithobrake.analysis.unseen_event import HALF_RUN, RunCounts, limit_of_runs
from lithobrake.chaos.basis import checked_points
from lithobrake.chaos.distributions import Distribution
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.given_numbers import numbers, whole_number

# Points whose probabilities are worked out at once: bounds the memory of the polynomial features.
_BLOCK = 65_536


class OutcomeModel:
    """Logistic regression on a quadratic in the inputs, each put on the scale of its distribution.

    The penalty of the regression keeps it finite when few runs, or all on one side of a plane, had an outcome. An
    outcome that no run had gets probability 0 everywhere; `upper_limit` bounds it.
    """

    def __init__(
        self, inputs: Mapping[str, Distribution], x: np.ndarray, outcomes: Sequence[str], names: Sequence[str]
    ) -> None:
        """Learn from runs: x [run_count, input_count] in physical units, outcomes [run_count], each one of the names.

        Raises ValueError for no run, or an outcome that is not among the names.
        """
        if len(x) != len(outcomes) or len(x) == 0:
            raise ValueError(
                f"{len(x)} points and {len(outcomes)} outcomes; give one outcome for each of at least one run"
            )
        unknown = sorted(set(outcomes) - set(names))
        if unknown:
            raise ValueError(f"the outcomes hold {unknown[0]}; allowed: {', '.join(names)}")
        self._inputs, self.names = dict(inputs), tuple(names)
        x = self._points(x)
        self._met = sorted({self.names.index(outcome) for outcome in outcomes})
        if len(self._met) > 1:
            from sklearn.linear_model import LogisticRegression
            from sklearn.pipeline import make_pipeline
            from sklearn.preprocessing import PolynomialFeatures

            self._regression = make_pipeline(
                PolynomialFeatures(2, include_bias=False), LogisticRegression(max_iter=10_000)
            )
            self._regression.fit(self._scaled(x), [self.names.index(outcome) for outcome in outcomes])

    def probability(self, x: np.ndarray) -> np.ndarray:
        """Probabilities at x [point_count, input_count], in physical units; shape [point_count, len(names)]."""
        x = self._points(x)
        table = np.zeros((len(x), len(self.names)))
        if len(self._met) == 1:
            table[:, self._met] = 1.0
            return table
        for start in range(0, len(x), _BLOCK):
            block = slice(start, start + _BLOCK)
            table[block, self._met] = self._regression.predict_proba(self._scaled(x[block]))
        return table

    def logits(self, x: np.ndarray) -> np.ndarray:
        """Logarithms of the probabilities but for a term that all outcomes share, shape [point_count, len(names)].

        They are quadratic in the germs; minus infinity for an outcome that no run had.
        """
        x = self._points(x)
        table = np.full((len(x), len(self.names)), -np.inf)
        table[:, self._met] = 0.0
        if len(self._met) > 1:
            decided = self._regression.decision_function(self._scaled(x))
            # Of two outcomes the regression tells the second alone.
            table[:, self._met if decided.ndim > 1 else self._met[1:]] = decided.reshape(len(x), -1)
        return table

    def draw(self, x: np.ndarray, random: np.random.Generator) -> np.ndarray:
        """An outcome for each point x [point_count, input_count], as its place among the names, shape [point_count]."""
        # The last one takes what rounding leaves of the whole.
        ends = np.cumsum(self.probability(x), axis=1)[:, :-1]
        return (random.random(len(x))[:, None] >= ends).sum(axis=1)

    def _points(self, x: np.ndarray) -> np.ndarray:
        return checked_points(self._inputs, x)

    def _scaled(self, x: np.ndarray) -> np.ndarray:
        columns = [distribution.germ(x[:, index]) for index, distribution in enumerate(self._inputs.values())]
        return np.column_stack(columns)


def refit_interval(
    counts: ArrayLike,
    totals: ArrayLike,
    bed_count: int,
    run_count: RunCounts | None = None,
    level: float = LEVEL,
) -> Estimate:
    """Fraction of emulator samples that meet an event, with its interval over beds that were not in the study.

    counts, totals [refit_count]: draws of each refit that have met it, and all of its draws, at least two. bed_count:
    beds that the emulator was fitted to. The scatter of the refits' shares, less what finite draws add, is the error of
    the fit. An event that no draw or every draw has met is bounded by what so many runs can say (`unseen_limit`), and
    one that few have met has no wider bounds than that, or than its error on the plain scale. run_count: runs that the
    emulator was fitted to, or those on each bed [bed_count], where they are known. An event that less than half of a
    run is expected to have met has the bounds of one that none has met at least: refits of so few runs do not scatter
    by what these have not shown. None: it is not known, and each bed counts as one run.
    Raises ValueError for fewer than two refits or beds, for a refit with fewer than two draws, and for counts that are
    no part of their totals.
    Source: [Sun-2011] (variance between, freed of that within); [Field-2007] (groups drawn whole).
    """
    met, drawn = numbers("counts", counts), numbers("totals", totals)
    if met.shape != drawn.shape or len(met) < 2 or whole_number("bed_count", bed_count, 0) < 2 or drawn.min() < 2:
        raise ValueError(
            f"{len(met)} refits to {bed_count} beds, the least with {drawn.min(initial=0):g} draws; give at least two "
            "of each"
        )
    if not ((met >= 0.0) & (met <= drawn)).all():
        raise ValueError("counts must lie between 0 and totals in every refit: draws that have met the event, of all")
    share, total = float(met.sum() / drawn.sum()), float(drawn.sum())
    limit = limit_of_runs(bed_count if run_count is None else run_count, bed_count, level)
    if share in (0.0, 1.0):
        return Estimate(share, share * (1.0 - limit), share + (1.0 - share) * limit, level)
    shares = met / drawn
    total_variance = float(shares.var(ddof=1))
    between = total_variance - float(np.mean(shares * (1.0 - shares) / (drawn - 1.0)))
    # What so few draws cannot tell from chance counts as its own standard error: without it bounds hold 0.77 to 0.86.
    between = max(between, total_variance * math.sqrt(2.0 / len(shares)))
    # Drawing B of B beds scatters by (B - 1) / B of what B beds scatter by.
    error = math.sqrt(between * bed_count / (bed_count - 1) + share * (1.0 - share) / total)
    half = t_quantile(bed_count - 1, level) * error
    lower, upper = share_interval(share, half)
    is_unseen = run_count is not None and min(share, 1.0 - share) * np.sum(run_count) < HALF_RUN
    # On the logit scale a few draws with the event could pass for anything.
    if share < 0.5:
        upper = min(upper, max(share + half, limit))
        return Estimate(share, lower, max(upper, limit) if is_unseen else upper, level)
    lower = max(lower, min(share - half, 1.0 - limit))
    return Estimate(share, min(lower, 1.0 - limit) if is_unseen else lower, upper, level)
