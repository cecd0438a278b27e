"""Intervals of shares from draws of refits, against beds whose law is known."""

import numpy as np
import pytest

from lithobrake.analysis import refit_interval


@pytest.mark.parametrize("scatter", [1.0, 4.0])
@pytest.mark.parametrize("draws", [20, 100, 500])
def test_the_interval_holds_the_truth_at_least_about_as_often_as_it_says(draws: int, scatter: float) -> None:
    """Beds of shares of their own; refits draw beds with replacement, and events from the mean of those."""
    rng, held, studies = np.random.default_rng(1), 0, 400
    for _ in range(studies):
        beds = rng.beta(60.0 / scatter, 40.0 / scatter, 12)
        refits = beds[rng.integers(12, size=(50, 12))].mean(axis=1)
        found = refit_interval(rng.binomial(draws, refits), np.full(50, draws), 12)
        held += found.lower < 0.6 < found.upper
    # Three standard deviations of the luck of so many studies; few draws tell less, and make it wide.
    assert held / studies > 0.9 - 0.045


def test_refits_that_agree_to_the_last_draw_leave_the_chance_of_draws_alone() -> None:
    found = refit_interval(np.full(50, 50), np.full(50, 100), 12)
    assert found.value == 0.5
    assert found.upper - found.value == pytest.approx(1.7959 * 0.5 / np.sqrt(5000), rel=1e-3)


def test_what_no_draw_or_every_draw_met_is_bounded_by_the_beds() -> None:
    none = refit_interval(np.zeros(50), np.full(50, 100), 12)
    assert (none.value, none.lower) == (0.0, 0.0)
    assert none.upper == pytest.approx(1.0 - 0.1 ** (1.0 / 12.0))
    every = refit_interval(np.full(50, 100), np.full(50, 100), 12)
    assert (every.value, every.upper) == (1.0, 1.0)
    assert every.lower == pytest.approx(0.1 ** (1.0 / 12.0))


def test_what_one_draw_met_has_no_wider_bounds_than_what_none_met() -> None:
    one = np.zeros(50)
    one[7] = 1.0
    none, rare = (refit_interval(counts, np.full(50, 40), 60) for counts in (np.zeros(50), one))
    assert 0.0 < rare.lower < rare.value < rare.upper <= none.upper
    sure = refit_interval(40.0 - one, np.full(50, 40), 60)
    assert sure.lower == pytest.approx(1.0 - rare.upper)


@pytest.mark.parametrize(("counts", "totals", "beds"), [([1], [5], 12), ([1, 2], [5, 1], 12), ([1, 2], [5, 5], 1)])
def test_one_of_anything_gives_no_interval(counts: list[int], totals: list[int], beds: int) -> None:
    with pytest.raises(ValueError, match="give at least two of each"):
        refit_interval(counts, totals, beds)
