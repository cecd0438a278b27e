"""Probability of a limit state: from the runs where it is common, from the emulator where it is rare."""

import numpy as np
import pytest

from lithobrake import emulator
from lithobrake.analysis import (
    drawn_counts,
    drawn_failures,
    failure_probability,
    refit_interval,
    share_estimate,
    upper_limit,
)
from lithobrake.chaos import Normal, sobol_sequence

BED = np.arange(240) % 24
# Draws of fifty refits: two hundred of each, of which so many meet the limit state.
TOTALS = np.full(50, 200)
COUNTS = np.arange(50) % 5


def failing(count: int) -> np.ndarray:
    """So many of 240 runs that fail, on different beds."""
    return (np.arange(240) < count).astype(float)


def test_the_runs_tell_what_at_least_a_fiftieth_of_them_meets() -> None:
    found, runs = failure_probability(failing(24), BED, drawn=(COUNTS, TOTALS)), share_estimate(failing(24), BED)
    assert (found.source, found.why) == ("runs", None)
    assert (found.probability, found.lower, found.upper) == (runs.share, runs.lower, runs.upper)
    assert found.by_emulator == refit_interval(COUNTS, TOTALS, 24, 240)


def test_the_emulator_tells_what_is_rarer_within_the_limit_of_so_many_places() -> None:
    found = failure_probability(failing(2), BED, drawn=(COUNTS // 4, TOTALS))
    of_emulator = refit_interval(COUNTS // 4, TOTALS, 24, 240)
    assert (found.source, found.probability) == ("emulator", of_emulator.value)
    assert found.tail_limit == upper_limit(240, 0.9)
    assert found.probability < found.tail_limit
    # The emulator alone would rule out what 240 places cannot.
    assert of_emulator.upper < found.tail_limit == found.upper
    assert found.lower == of_emulator.lower


def test_what_nearly_always_happens_is_as_rare_the_other_way_round() -> None:
    rare = failure_probability(failing(2), BED, drawn=(COUNTS // 4, TOTALS))
    sure = failure_probability(1.0 - failing(2), BED, drawn=(TOTALS - COUNTS // 4, TOTALS))
    assert sure.source == "emulator"
    expected = [1.0 - bound for bound in (rare.upper, rare.lower)]
    assert [sure.lower, sure.upper] == pytest.approx(expected, abs=1e-12)


def test_without_an_emulator_the_runs_tell_all() -> None:
    found = failure_probability(failing(0), BED)
    assert (found.source, found.probability, found.lower, found.by_emulator) == ("runs", 0.0, 0.0, None)
    assert found.upper == upper_limit(24, 0.9)


def test_one_bed_has_no_interval_whatever_an_emulator_says() -> None:
    found = failure_probability(failing(2), np.zeros(240), drawn=(COUNTS, TOTALS))
    assert (found.lower, found.upper, found.source, found.by_emulator) == (None, None, "runs", None)
    assert found.summary()["why"].startswith("all runs came down on one bed")


def test_draws_of_which_nobody_knows_do_not_count() -> None:
    counts, totals = drawn_counts([1.0, 0.0, np.nan, 1.0], [0, 0, 1, 1], 3)
    assert (counts.tolist(), totals.tolist()) == ([1, 1, 0], [2, 1, 0])


def test_an_emulator_of_any_model_is_drawn_refit_by_refit() -> None:
    inputs, random = {"load": Normal(0.0, 1.0)}, np.random.default_rng(1)
    x = sobol_sequence(inputs, 240, seed=1)
    y = x[:, 0] + random.standard_normal(240)
    model = emulator.fit(inputs, x, y, groups=BED)
    counts, totals = drawn_failures(model, lambda draws: draws.y[:, :, 0] > 2.5, sample_count=20_000, refit_count=20)
    assert totals.tolist() == [1000] * 20
    found = refit_interval(counts, totals, 24, 240)
    assert found.lower < (model.sample(x, 100) > 2.5).mean() < found.upper
    again, _ = drawn_failures(model, lambda draws: draws.y[:, :, 0] > 2.5, sample_count=20_000, refit_count=20)
    assert counts.tolist() == again.tolist()
