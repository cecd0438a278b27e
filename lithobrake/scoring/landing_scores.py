"""Scores of predictions of a landing against what was observed, with intervals over the predicted sample."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from lithobrake.scoring.observed_landing import ENDS, NUMBERS, ObservedLanding, Place
from lithobrake.scoring.predicted_landings import UNKNOWN, PredictedLandings
from lithobrake.scoring.proper_scores import (
    crps,
    effective_number,
    energy_score,
    log_score,
    probability_below,
)
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.estimate import LEVEL, Estimate
from lithobrake.vocabulary.quantities import SIDES

LOGARITHMIC, CRPS, ENERGY = "logarithmic", "CRPS", "energy"
# Resamples of the groups for an interval, and their seed.
RESAMPLES, SEED = 400, 0
# Of fewer landings there is no distribution; all pairs of more take more memory than a laptop has.
FEWEST, MOST = 2, 5000
Score = Callable[[Floats], float]


@dataclass(frozen=True)
class LandingScore:
    """One score of one prediction.

    kind: LOGARITHMIC [bits], CRPS [the quantity's unit] or ENERGY [m]; score: with the interval over resampled groups;
    sample_count: landings that it stands on; below: place of the observation in the predictive distribution of a
    number, from 0 to 1; None for what has none.
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

    Landings of unknown end count for and against the end: its interval reaches from all of them ending as observed to
    none. A quantity that was not observed, or of which fewer than FEWEST predicted landings have a value, is left out.
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
    unknown, hits = np.isin(prediction.end, UNKNOWN), prediction.end == end
    known = prediction.where(~unknown)
    # Where all are known both ways are the sample itself.
    lower = _interval(prediction, _logarithmic(hits | unknown, len(ENDS), prediction.weight))[0]
    upper = _interval(prediction, _logarithmic(hits, len(ENDS), prediction.weight))[1]
    value = log_score(hits[~unknown], len(ENDS), known.weight)
    return LandingScore(prediction.name, "end", LOGARITHMIC, "bit", Estimate(value, lower, upper), len(known))


def _known(same: PredictedLandings, observed: ObservedLanding) -> Iterator[tuple[str, np.ndarray]]:
    """What was observed besides the end, and which of the predicted landings have it."""
    for name in observed.numbers:
        yield name, np.isfinite(same.numbers[name])
    if observed.place is not None:
        yield "place", np.isfinite(same.direction.sum(axis=1))
    if observed.face is not None:
        yield "face", np.array([face != "" for face in same.face], dtype=np.bool_)


def _quantity_score(quantity: str, sample: PredictedLandings, observed: ObservedLanding) -> LandingScore:
    """The score of one quantity for landings that have it."""
    below = None
    if quantity == "face":
        assert observed.face is not None
        kind, unit = LOGARITHMIC, "bit"
        score = _logarithmic(_face_hits(sample.face, observed.face), len(SIDES), sample.weight)
    elif quantity == "place":
        assert observed.place is not None
        radius, error = observed.place.radius, observed.place.error
        kind, unit = ENERGY, "m"
        score = energy_score(radius * sample.direction, radius * _direction(observed.place), error).of
    else:
        measured, values = observed.numbers[quantity], sample.numbers[quantity]
        kind, unit, score = CRPS, NUMBERS[quantity], crps(values, measured.value, measured.error).of
        below = probability_below(values, measured.value, measured.error, sample.weight)
    estimate = Estimate(score(sample.weight), *_interval(sample, score))
    return LandingScore(sample.name, quantity, kind, unit, estimate, len(sample), below)


def _logarithmic(hits: np.ndarray, kinds: int, weight: Floats) -> Score:
    """The logarithmic score by weights; a resample stands for as many landings as the sample."""
    total = effective_number(weight)
    return lambda weights: log_score(hits, kinds, weights, total)


def _face_hits(faces: np.ndarray, observed: str) -> Floats:
    """Which landings show the observed side; a box whose opposite faces are alike names its axis: either is half."""
    found: Floats = (faces == observed) + 0.5 * (faces == observed[-1])
    return found


def _interval(sample: PredictedLandings, score: Score) -> tuple[float, float]:
    """Interval of a score over samples of as many groups, drawn with replacement."""
    generator, group_count = np.random.default_rng(SEED), int(sample.group.max()) + 1
    there = np.unique(sample.group)
    found: list[float] = []
    while len(found) < RESAMPLES:
        drawn = np.bincount(generator.choice(there, size=len(there)), minlength=group_count)
        weights = sample.weight * drawn[sample.group]
        # All that weigh something may be left out of one sample.
        if weights.sum() > 0.0:
            found.append(score(weights))
    lower, upper = np.quantile(found, [0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL])
    return float(lower), float(upper)


def _direction(place: Place) -> Floats:
    latitude, longitude = np.radians([place.latitude_deg, place.longitude_deg])
    return np.array([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)])


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
    score = one.score
    said = f"{score.value:.3g} ({score.lower:.3g} to {score.upper:.3g})  {one.prediction}, {one.sample_count} landings"
    return said if one.below is None else f"{said}; {one.below:.0%} of the prediction is below the observation"
