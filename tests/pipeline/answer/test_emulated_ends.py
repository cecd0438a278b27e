"""Shares of ends narrowed by an emulator: synthetic journeys of known truth, by good and by poor predictions."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lithobrake.pipeline.answer import emulated_ends
from lithobrake.pipeline.answer.emulated_ends import EmulatedTable, Refits, _agrees, _narrowed
from lithobrake.pipeline.answer.journey_ends import JourneyTable, end_share
from lithobrake.pipeline.journeys.emulated_journeys import COPIES
from lithobrake.results.run_results import CountedShare
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.outcomes import JourneyEnd

from ..few_terms import REFITS

BEDS, JOURNEYS, FRESH, STUDIES = 24, 96, 2000, 120
REST, ESCAPED, PARTNER = JourneyEnd.AT_REST.value, JourneyEnd.ESCAPED.value, JourneyEnd.PARTNER.value
ENDS = np.array([REST, ESCAPED, PARTNER], dtype=object)


def chances(x: np.ndarray, slope: float, shift: np.ndarray | float = 0.0) -> np.ndarray:
    """Chances of the three ends, [count, 3], of soils x [count]."""
    away = 1.0 / (1.0 + np.exp(1.0 - slope * x - shift))
    return np.column_stack([1.0 - away, 0.7 * away, 0.3 * away])


def drawn(table: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """An end for each row of chances."""
    return ENDS[(random.random(len(table))[:, None] > np.cumsum(table, axis=1)[:, :2]).sum(axis=1)]


def emulated(journey: np.ndarray, refit: np.ndarray, end: np.ndarray) -> EmulatedTable:
    nothing = np.zeros(len(end), dtype=bool)
    return EmulatedTable(journey, refit, end, nothing, nothing.astype(int))


def study(
    slope: float, predicted: float, random: np.random.Generator
) -> tuple[JourneyTable, EmulatedTable, EmulatedTable]:
    """Journeys with effects of bed and soil, and what an emulator with another slope makes of their soils."""
    bed, x = np.arange(JOURNEYS) % BEDS, random.standard_normal(JOURNEYS)
    end = drawn(chances(x, slope, 0.4 * random.standard_normal(BEDS)[bed]), random)
    nothing = np.full(JOURNEYS, np.nan)
    table = JourneyTable(end, bed, {}, np.column_stack([nothing] * 3), np.full(JOURNEYS, ""))
    errors = 0.3 * random.standard_normal(REFITS)
    refit = np.arange(FRESH) % REFITS
    fresh = drawn(chances(random.standard_normal(FRESH), predicted, errors[refit]), random)
    which = np.repeat(np.arange(JOURNEYS), COPIES)
    own = random.integers(REFITS, size=len(which))
    again = drawn(chances(x[which], predicted, errors[own]), random)
    return table, emulated(np.arange(FRESH), refit, fresh), emulated(which, own, again)


def plain_shares(table: JourneyTable) -> dict[str, CountedShare]:
    """Shares of all ends, and the interval of that at rest: no other is asked for before it is narrowed."""
    counts = {end: int((table.end == end).sum()) for end in ENDS.tolist()}
    shares = {end: CountedShare(count, Estimate(count / JOURNEYS, None, None)) for end, count in counts.items()}
    return shares | {REST: end_share(table.end == REST, table.bed)}


@pytest.mark.parametrize(
    ("slope", "predicted", "narrows"),
    [(2.5, 2.0, True), (0.0, 1.0, False), (1.0, -1.0, False)],
    ids=["good emulator", "soil without effect", "wrong sign"],
)
def test_narrowed_shares_hold_the_truth(
    monkeypatch: pytest.MonkeyPatch, slope: float, predicted: float, narrows: bool
) -> None:
    # Studies of other tests have fewer.
    monkeypatch.setattr(emulated_ends, "COPIES", COPIES)
    random = np.random.default_rng(4)
    grid = random.standard_normal(200_000)
    truth = float(chances(grid, slope, 0.4 * random.standard_normal(len(grid))).mean(axis=0)[0])
    held, ratios, errors = [], [], []
    for _ in range(STUDIES):
        table, fresh, own = study(slope, predicted, random)
        plain = plain_shares(table)
        control, shares = _narrowed(table, plain, fresh, own)
        lower, upper = shares[REST].share.lower, shares[REST].share.upper
        assert upper is not None
        assert sum(one.share.value for one in shares.values()) == pytest.approx(1.0, abs=1e-12)
        held.append(lower <= truth <= upper)
        errors.append((shares[REST].share.value - truth, plain[REST].share.value - truth))
        ratios.append(control.half_width_with / control.half_width if control and control.is_used else 1.0)
    assert 0.85 <= np.mean(held) <= 0.97
    narrowed, plain_errors = np.std(errors, axis=0)
    if narrows:
        assert np.median(ratios) < 0.8
        assert narrowed < 0.9 * plain_errors
    else:
        assert np.mean(ratios) > 0.98
    # Three standard errors of the mean over the studies.
    assert abs(np.mean(errors, axis=0)[0]) < 3.0 * narrowed / np.sqrt(STUDIES)


def share(value: float, half: float) -> CountedShare:
    return CountedShare(0, Estimate(value, value - half, value + half))


def test_ends_agree_within_their_intervals_together() -> None:
    nothing = {end.value: share(0.0, 0.02) for end in JourneyEnd}
    landings = nothing | {REST: share(0.8, 0.06), ESCAPED: share(0.2, 0.06)}
    assert _agrees(landings, nothing | {REST: share(0.89, 0.08), ESCAPED: share(0.11, 0.08)})
    assert not _agrees(landings, nothing | {REST: share(0.91, 0.08), ESCAPED: share(0.09, 0.08)})
    assert _agrees(landings, nothing | {REST: CountedShare(0, Estimate(0.8, None, None))}) is None


def test_a_lander_is_one_case_of_an_event_however_often_it_touches_down(monkeypatch: pytest.MonkeyPatch) -> None:
    """60 journeys on 12 beds, none of which met it, leave 8.2 %: (1 - q) (2 - q) .. (5 - q) / 5! to the 12th is 0.1."""
    monkeypatch.setattr("lithobrake.pipeline.answer.emulated_ends.why_no_interval", lambda study: None)
    asked: Any = SimpleNamespace()
    numbers = {"touchdowns": np.full(60, 10.0)}
    table = JourneyTable(np.full(60, REST), np.arange(60) % 12, numbers, np.zeros((60, 3)), np.full(60, ""))
    nobody, refit = np.zeros(4 * REFITS, dtype=bool), np.arange(4 * REFITS) % REFITS
    found = Refits.of_journeys(asked, table).share(nobody, ~nobody, refit)
    assert found.upper == pytest.approx(0.0816, abs=5e-4)
    assert np.prod((np.arange(1, 6) - found.upper) / np.arange(1, 6)) ** 12 == pytest.approx(0.1)
