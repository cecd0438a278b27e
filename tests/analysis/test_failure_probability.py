"""Probability of a limit state, from the runs or the emulator; the inputs that make failures, found where they do."""

import numpy as np
import pytest
from scipy import stats

from lithobrake import emulator
from lithobrake.analysis import (
    drawn_counts,
    drawn_failures,
    failure_inputs,
    failure_probability,
    refit_interval,
    share_estimate,
    unseen_limit,
    upper_limit,
)
from lithobrake.analysis.failure_probability import OrderedInput
from lithobrake.chaos import LogUniform, Normal, Uniform, sobol_sequence

BED = np.arange(240) % 24
# Draws of fifty refits: two hundred of each, of which so many meet the limit state.
TOTALS = np.full(50, 200)
COUNTS = np.arange(50) % 5


def failing(count: int) -> np.ndarray:
    """So many of 240 runs that fail, on different beds."""
    return (np.arange(240) < count).astype(float)


def test_the_runs_tell_what_at_least_a_fiftieth_of_them_meets() -> None:
    found, runs = failure_probability(failing(24), BED, drawn=(COUNTS, TOTALS)), share_estimate(failing(24), BED)
    assert (found.source, found.by_runs.share.why_missing) == ("runs", None)
    assert found.probability == runs.share
    assert found.by_emulator == refit_interval(COUNTS, TOTALS, 24, 240)


def test_the_emulator_tells_what_is_rarer_and_rules_out_no_more_than_so_many_beds() -> None:
    found, runs = failure_probability(failing(2), BED, drawn=(COUNTS // 4, TOTALS)), share_estimate(failing(2), BED)
    of_emulator = refit_interval(COUNTS // 4, TOTALS, 24, 240)
    assert (found.source, found.probability.value) == ("emulator", of_emulator.value)
    assert upper_limit(240, 0.9) < found.tail_limit == unseen_limit(BED) < upper_limit(24, 0.9)
    # Two of 240 runs leave no less open than none of them.
    assert of_emulator.upper == pytest.approx(found.tail_limit)
    assert runs.share.upper == found.tail_limit == found.probability.upper
    assert found.probability.lower == of_emulator.lower
    none = failure_probability(failing(0), BED, drawn=(COUNTS // 4, TOTALS))
    assert none.probability.upper == none.tail_limit == none.by_runs.share.upper
    # A study of 240 beds may rule out more than its runs do one by one.
    assert failure_probability(failing(2), np.arange(240), drawn=(np.arange(50) % 3 + 2, TOTALS)).tail_limit < 0.01


@pytest.mark.parametrize("rare", [True, False])
def test_runs_without_an_outcome_may_all_or_none_meet_the_limit_state(rare: bool) -> None:
    met = failing(2)
    met[100:112] = np.nan
    drawn = (COUNTS // 4, TOTALS)
    if not rare:
        met, drawn = 1.0 - met, (TOTALS - COUNTS // 4, TOTALS)
    found = failure_probability(met, BED, drawn=drawn)
    assert found.by_runs.missing == 0.05
    assert found.source == "emulator"
    # Twelve of 240 may, beside a sampling error.
    assert found.probability.upper - found.probability.lower > 0.05 + 0.01
    assert found.probability.lower <= 0.95 * found.by_emulator.lower
    assert found.probability.upper >= 0.95 * found.by_emulator.upper + 0.05


def test_what_nearly_always_happens_is_as_rare_the_other_way_round() -> None:
    rare = failure_probability(failing(2), BED, drawn=(COUNTS // 4, TOTALS))
    sure = failure_probability(1.0 - failing(2), BED, drawn=(TOTALS - COUNTS // 4, TOTALS))
    assert sure.source == "emulator"
    expected = [1.0 - bound for bound in (rare.probability.upper, rare.probability.lower)]
    assert [sure.probability.lower, sure.probability.upper] == pytest.approx(expected, abs=1e-12)


def test_without_an_emulator_the_runs_tell_all() -> None:
    found = failure_probability(failing(0), BED)
    assert (found.source, found.probability.value, found.probability.lower, found.by_emulator) == (
        "runs",
        0.0,
        0.0,
        None,
    )
    assert found.probability.upper == unseen_limit(BED)


def test_one_bed_has_no_interval_whatever_an_emulator_says() -> None:
    found = failure_probability(failing(2), np.zeros(240), drawn=(COUNTS, TOTALS))
    assert (found.probability.lower, found.probability.upper, found.source) == (None, None, "runs")
    assert found.by_emulator is None
    assert found.by_runs.share.why_missing.startswith("all runs landed on one bed")


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
    found = refit_interval(counts, totals, 24)
    assert found.lower < (model.sample(x, 100) > 2.5).mean() < found.upper
    again, _ = drawn_failures(model, lambda draws: draws.y[:, :, 0] > 2.5, sample_count=20_000, refit_count=20)
    assert counts.tolist() == again.tolist()


INPUTS = {"friction": Uniform(0.2, 0.8), "young_modulus": LogUniform(1e6, 1e8)}


def test_the_input_that_makes_failures_is_found_and_the_other_not() -> None:
    x, random = sobol_sequence(INPUTS, 240, seed=2), np.random.default_rng(3)
    failing = (x[:, 0] + 0.1 * random.standard_normal(240) > 0.65).astype(float)
    found = failure_inputs(INPUTS, x, failing, BED)
    assert (found["friction"].found, found["young_modulus"].found) == (True, False)
    grid = np.linspace(0.2, 0.8, 10_001)
    chance = stats.norm.cdf((grid - 0.65) / 0.1)
    among_failing = np.cumsum(chance) / chance.sum()
    exact = np.max(np.abs(among_failing - INPUTS["friction"].cdf(grid)))
    # About seventy runs fail: their distribution function is within 0.1 of its law in nine of ten studies.
    assert found["friction"].distance.value == pytest.approx(exact, abs=0.1)
    assert found["friction"].distance.lower < exact < found["friction"].distance.upper
    assert found["friction"].median == pytest.approx(grid[np.searchsorted(among_failing, 0.5)], abs=0.03)
    assert found["friction"].median_of_all == pytest.approx(0.5)
    assert found["young_modulus"].median_of_all == pytest.approx(1e7)


def test_the_distance_is_kolmogorovs() -> None:
    values = np.random.default_rng(4).beta(2.0, 2.0, 50)
    column = OrderedInput.of(Uniform(0.0, 1.0), values)
    expected = stats.ks_1samp(values, stats.uniform().cdf).statistic
    assert column.distance(np.ones((1, 50)))[0] == pytest.approx(expected, rel=1e-12)


def test_where_no_input_does_anything_nine_of_ten_studies_find_none() -> None:
    studies = []
    for seed in range(60):
        x, random = sobol_sequence(INPUTS, 120, seed=seed), np.random.default_rng(seed)
        failing = (random.random(120) < 0.15).astype(float)
        studies.append(any(one.found for one in failure_inputs(INPUTS, x, failing, np.arange(120) % 12).values()))
    # Six are expected; a binomial number of sixty is above 12 once in two hundred times.
    assert np.sum(studies) <= 12


def test_runs_of_which_nobody_knows_and_studies_without_failure_say_nothing() -> None:
    x = sobol_sequence(INPUTS, 240, seed=2)
    failing = np.where(x[:, 0] > 0.7, 1.0, 0.0)
    unknown = np.where(np.arange(240) < 40, np.nan, failing)
    alone = failure_inputs(INPUTS, x[40:], failing[40:], BED[40:])
    assert failure_inputs(INPUTS, x, unknown, BED)["friction"].distance.value == alone["friction"].distance.value
    assert failure_inputs(INPUTS, x, np.zeros(240), BED) == {}
