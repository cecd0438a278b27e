"""The chances of the outcomes, learnt from runs; intervals of shares, of runs and from draws of refits."""

import numpy as np
import pytest

from lithobrake.analysis import (
    OutcomeModel,
    refit_interval,
    sample_inputs,
    wilson_interval,
)
from lithobrake.analysis.unseen_event import even_limit
from lithobrake.chaos import LogUniform, Uniform

INPUTS = {"young_modulus": LogUniform(1e6, 1e8), "restitution": Uniform(0.2, 0.9)}
LIMIT = even_limit(19, 9)
NAMES = ("clear", "captured", "left_sideways")


def test_where_all_runs_end_alike_nothing_is_fitted() -> None:
    x = sample_inputs(INPUTS, 10, seed=1)
    assert OutcomeModel(INPUTS, x, ["clear"] * 10, NAMES).probability(x).tolist() == [[1.0, 0.0, 0.0]] * 10
    model = OutcomeModel(INPUTS, x, ["captured"] * 10, NAMES)
    assert model.draw(x, np.random.default_rng(0)).tolist() == [1] * 10


def test_boundaries_between_three_outcomes_are_found_and_the_shares_are_right() -> None:
    def truth(x: np.ndarray) -> np.ndarray:
        return np.where(x[:, 1] < 0.4, 1, np.where(x[:, 0] > 3e7, 2, 0))

    runs, fresh = sample_inputs(INPUTS, 200, seed=1), sample_inputs(INPUTS, 20_000, seed=2)
    model = OutcomeModel(INPUTS, runs, [NAMES[index] for index in truth(runs)], NAMES)
    guess = model.probability(fresh)
    assert guess.sum(axis=1) == pytest.approx(np.ones(len(fresh)))
    shares = np.bincount(truth(fresh)) / len(fresh)
    assert guess.mean(axis=0) == pytest.approx(shares, abs=0.05)
    assert (guess.argmax(axis=1) == truth(fresh)).mean() > 0.9
    drawn = np.bincount(model.draw(fresh, np.random.default_rng(0)), minlength=3) / len(fresh)
    # Two standard deviations of a share counted in 20 000 draws are below 0.01.
    assert drawn == pytest.approx(guess.mean(axis=0), abs=0.01)


def test_no_runs_and_unknown_outcomes_are_refused() -> None:
    with pytest.raises(ValueError, match="one outcome for each"):
        OutcomeModel(INPUTS, np.empty((0, 2)), [], NAMES)
    with pytest.raises(ValueError, match="hold failed; allowed: clear"):
        OutcomeModel(INPUTS, sample_inputs(INPUTS, 2, seed=1), ["clear", "failed"], NAMES)


@pytest.mark.parametrize(("count", "total", "lower", "upper"), [
    # Newcombe 1998, Statistics in Medicine 17, 857, table I, method 3.
    (81, 263, 0.2553, 0.3662),
    (15, 148, 0.0624, 0.1605),
    (0, 20, 0.0, 0.1611),
    (1, 29, 0.0061, 0.1718),
])  # fmt: skip
def test_published_intervals(count: int, total: int, lower: float, upper: float) -> None:
    assert wilson_interval(count, total) == pytest.approx((lower, upper), abs=5e-5)


def test_interval_of_none_and_of_all() -> None:
    assert wilson_interval(0, 10)[0] == 0.0
    assert wilson_interval(10, 10)[1] == 1.0


def test_it_covers_the_truth_as_often_as_it_says() -> None:
    counts = np.random.default_rng(1).binomial(200, 0.3, size=2000)
    ends = [wilson_interval(int(count), 200) for count in counts]
    assert np.mean([low <= 0.3 <= high for low, high in ends]) == pytest.approx(0.95, abs=0.02)


def test_impossible_counts_are_refused() -> None:
    for count, total in ((1, 0), (-1, 5), (6, 5), (1.5, 2), (1, float("nan"))):
        with pytest.raises(ValueError, match=r"(count|total) is .* whole number"):
            wilson_interval(count, total)  # type: ignore[arg-type]
    for quantile in (-5.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match=r"quantile is .* of at least 0 and of at most 40"):
            wilson_interval(1, 2, quantile)


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


@pytest.mark.parametrize(("met", "lower", "upper"), [(9998, 1.0 - LIMIT, 1.0), (2, 0.0, LIMIT)])
def test_what_few_runs_could_not_show_is_bounded_by_their_beds(met: int, lower: float, upper: float) -> None:
    """A fit to 19 runs on 9 beds, all of which ended alike, gives another end 0.02 % and says no more than they do."""
    counts, totals = np.full(50, met // 50.0) + (np.arange(50) < met % 50), np.full(50, 200)
    few, many, plain = (refit_interval(counts, totals, 9, runs) for runs in (19, 19_000, None))
    assert (few.lower, few.upper) == pytest.approx((lower, upper), abs=1e-3)
    assert many == plain
    assert plain.upper - plain.lower < 0.1


def test_runs_that_crowd_on_few_beds_limit_less_than_even_ones() -> None:
    """20, 20 and ten times 2 of 60 runs: the product of (j - q) / j over the runs of each bed is 0.1 at 10.0 %."""
    none, totals = np.zeros(50), np.full(50, 100)
    found = refit_interval(none, totals, 12, [20, 20, *[2] * 10]).upper
    assert found == pytest.approx(0.100, abs=5e-4)
    each = [np.prod((np.arange(1, runs + 1) - found) / np.arange(1, runs + 1)) for runs in (20, 2)]
    assert each[0] ** 2 * each[1] ** 10 == pytest.approx(0.1)
    assert refit_interval(none, totals, 12, [5] * 12).upper == pytest.approx(refit_interval(none, totals, 12, 60).upper)


@pytest.mark.parametrize(("counts", "totals", "beds"), [([1], [5], 12), ([1, 2], [5, 1], 12), ([1, 2], [5, 5], 1)])
def test_one_of_anything_gives_no_interval(counts: list[int], totals: list[int], beds: int) -> None:
    with pytest.raises(ValueError, match="give at least two of each"):
        refit_interval(counts, totals, beds)
