"""Scores of predictions of a landing against what was observed, with intervals over the predicted sample."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from lithobrake.analysis.confidence import t_quantile
from lithobrake.analysis.share_estimate import share_estimate
from lithobrake.geometry.attitude import directions
from lithobrake.scoring.observed_landing import ENDS, NUMBERS, ObservedLanding
from lithobrake.scoring.predicted_landings import UNKNOWN, PredictedLandings
from lithobrake.scoring.proper_scores import crps, energy_score, log_score, probability_below
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import percent
from lithobrake.vocabulary.quantities import SIDES

LOGARITHMIC, CRPS, ENERGY = "logarithmic", "CRPS", "energy"
# Groups are left out in so many parts at most, for the error of a score.
PARTS = 60
ONE_GROUP = "all predicted landings are of one bed, which tells nothing of others"
# Of fewer landings there is no distribution; all pairs of more take more memory than a laptop has.
FEWEST, MOST = 2, 5000
Score = Callable[[Floats], float]


@dataclass(frozen=True)
class LandingScore:
    """One score of one prediction.

    kind: LOGARITHMIC [bits], CRPS [the quantity's unit] or ENERGY [m]; score: with its interval over
    groups; sample_count: landings that it stands on; below: place of the observation in the predictive distribution
    of a number, from 0 to 1; None for what has none.
    """

    prediction: str
    quantity: str
    kind: str
    unit: str
    score: Estimate
    sample_count: int
    below: float | None = None


def scores(prediction: PredictedLandings, observed: ObservedLanding) -> list[LandingScore]:
    """Score a prediction: its end, and what else was observed among the predicted landings that ended so.

    The interval of the end holds whatever became of landings of unknown end. A quantity that was not observed, or of
    which fewer than FEWEST predicted landings have a value, is left out.
    Raises ValueError for more than MOST landings.
    """
    if len(prediction) > MOST:
        raise ValueError(
            f"{prediction.name} has {len(prediction)} landings; allowed: at most {MOST}; give a random part of them"
        )
    same = prediction.where(prediction.end == observed.end)
    found = [_end_score(prediction, observed.end)]
    for quantity, has in _known(same, observed):
        if has.sum() >= FEWEST:
            found.append(_quantity_score(quantity, same.where(has), observed))
    return found


def even_score(kinds: int) -> float:
    """The logarithmic score [bits] of equal probabilities of so many kinds of outcome."""
    return float(np.log2(kinds))


def _end_score(prediction: PredictedLandings, end: str) -> LandingScore:
    """That of how the landing ended."""
    known = ~np.isin(prediction.end, UNKNOWN)
    hits = np.where(known, (prediction.end == end).astype(np.float64), np.nan)
    estimate = _logarithmic(prediction, hits, len(ENDS))
    return LandingScore(prediction.name, "end", LOGARITHMIC, "bit", estimate, int(known.sum()))


def _known(same: PredictedLandings, observed: ObservedLanding) -> Iterator[tuple[str, np.ndarray]]:
    """What was observed besides the end, and which of the predicted landings have it."""
    for name in observed.numbers:
        yield name, np.isfinite(same.numbers[name])
    if observed.place is not None:
        yield "place", np.isfinite(same.direction.sum(axis=1))
    if observed.face is not None:
        yield "face", np.asarray(same.face != "", dtype=np.bool_)


def _quantity_score(quantity: str, sample: PredictedLandings, observed: ObservedLanding) -> LandingScore:
    """The score of one quantity for landings that have it."""
    below = None
    if quantity == "face":
        assert observed.face is not None
        kind, unit = LOGARITHMIC, "bit"
        estimate = _logarithmic(sample, _face_hits(sample.face, observed.face), len(SIDES))
    elif quantity == "place":
        assert observed.place is not None
        there = observed.place
        kind, unit = ENERGY, "m"
        place = there.radius * directions(there.latitude_deg, there.longitude_deg)
        estimate = _with_interval(sample, energy_score(there.radius * sample.direction, place, there.error).of)
    else:
        measured, values = observed.numbers[quantity], sample.numbers[quantity]
        kind, unit = CRPS, NUMBERS[quantity]
        estimate = _with_interval(sample, crps(values, measured.value, measured.error).of)
        below = probability_below(values, measured.value, measured.error, sample.weight)
    return LandingScore(sample.name, quantity, kind, unit, estimate, len(sample), below)


def _logarithmic(sample: PredictedLandings, hits: Floats, kinds: int) -> Estimate:
    """The logarithmic score of hits, NaN where it is unknown, by the interval of their share; it may have no upper end,
    where no landing hits.
    """
    known = np.isfinite(hits)
    value = log_score(hits[known], kinds, sample.weight[known])
    share = share_estimate(hits, sample.group, weights=sample.weight).share
    if share.bounds is None:
        return Estimate(value, None, None, why_missing=share.why_missing)
    low, high = (math.log2(1.0 / bound) if bound > 0.0 else math.inf for bound in reversed(share.bounds))
    return Estimate(value, min(low, value), None if math.isinf(high) else max(high, value))


def _face_hits(faces: np.ndarray, observed: str) -> Floats:
    """Which landings show the observed side; a box whose opposite faces are alike names its axis: either is half."""
    found: Floats = (faces == observed) + 0.5 * (faces == observed[-1])
    return found


def _with_interval(sample: PredictedLandings, score: Score) -> Estimate:
    """A score with its interval from those of the sample without each part of its groups, with Student's t.

    Source: [Efron-1993], chapter 11 (jackknife).
    """
    value = score(sample.weight)
    groups = np.unique(sample.group, return_inverse=True)[1]
    parts = groups % PARTS
    count = int(parts.max()) + 1
    if groups.max() == 0:
        return Estimate(value, None, None, why_missing=ONE_GROUP)
    without = np.array([score(np.where(parts == part, 0.0, sample.weight)) for part in range(count)])
    error = math.sqrt((count - 1) / count * float(np.square(without - without.mean()).sum()))
    reach = t_quantile(count - 1) * error
    return Estimate(value, max(value - reach, 0.0), value + reach)


def score_lines(found: Sequence[LandingScore]) -> list[str]:
    """The scores as lines of a table, a block for each quantity; lower is better."""
    lines: list[str] = []
    for quantity in dict.fromkeys(one.quantity for one in found):
        rows = [one for one in found if one.quantity == quantity]
        unit = f" [{rows[0].unit}]" if rows[0].unit else ""
        lines.append(f"{quantity}: {rows[0].kind} score{unit}, lower is better")
        lines += [f"  {_row(one)}" for one in rows]
        if rows[0].kind == LOGARITHMIC:
            kinds = len(ENDS) if quantity == "end" else len(SIDES)
            lines.append(f"  {even_score(kinds):.3g}  equal probabilities of {kinds}")
    return lines


def _row(one: LandingScore) -> str:
    said = f"{one.score.value:.3g}{_bounds(one.score)}  {one.prediction}, {one.sample_count} landings"
    return said if one.below is None else f"{said}; {percent(one.below)} of the prediction is below the observation"


def _bounds(score: Estimate) -> str:
    if score.lower is None:
        return f" (no interval: {score.why_missing})"
    return f" (at least {score.lower:.3g})" if score.upper is None else f" ({score.lower:.3g} to {score.upper:.3g})"
