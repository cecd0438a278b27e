"""What no run has met: limits beside closed forms, beside counts of drawn beds, and beside the intervals of few."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from lithobrake.analysis import LEVEL, share_estimate, unseen_limit, upper_limit
from lithobrake.analysis.unseen_event import even_limit
from lithobrake.vocabulary.constants import LARGEST_CORRELATION

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("count", [20, 60, 300])
def test_the_upper_limit_of_what_no_run_had(count: int) -> None:
    """With this probability one draw in twenty of so many runs has no event at all."""
    limit = upper_limit(count)
    assert (1.0 - limit) ** count == pytest.approx(0.05)
    assert limit == pytest.approx(3.0 / count, rel=0.1)
    assert upper_limit(0) == 1.0


def test_the_limit_of_independent_runs_is_that_of_runs_and_of_like_ones_that_of_beds() -> None:
    bed = np.repeat(["a", "b", "c"], 40)
    assert unseen_limit(bed, correlation=0.0) == pytest.approx(upper_limit(120, LEVEL))
    assert unseen_limit(bed, correlation=1.0) == pytest.approx(upper_limit(3, LEVEL))
    assert unseen_limit([]) == 1.0
    assert unseen_limit([0, 1, 2]) == pytest.approx(upper_limit(3, LEVEL))


@pytest.mark.parametrize(("beds", "runs"), [(24, 4), (12, 4), (8, 3), (12, 20)])
def test_at_a_correlation_of_a_half_the_chance_of_none_is_a_plain_product(beds: int, runs: int) -> None:
    """The parameters of the beta law then add up to 1, and the chance of none on a bed is that of (j - q) / j."""
    limit = unseen_limit(np.arange(beds * runs) % beds, correlation=0.5)
    assert math.prod((j - limit) / j for j in range(1, runs + 1)) ** beds == pytest.approx(0.1)
    assert even_limit(beds * runs, beds) == pytest.approx(limit)


@pytest.mark.parametrize("correlation", [0.07, 0.3, 0.5, 0.8])
def test_beds_of_a_beta_law_show_none_one_time_in_ten_at_the_limit(correlation: float) -> None:
    random, counts = np.random.default_rng(2), np.array([5, 4, 4, 2, 2, 1, 1, 1])
    limit = unseen_limit(np.repeat(np.arange(8), counts), correlation=correlation)
    size = 1.0 / correlation - 1.0
    of_beds = random.beta(limit * size, (1.0 - limit) * size, (40_000, 8))
    none = (random.binomial(counts, of_beds) == 0).all(axis=1).mean()
    assert none == pytest.approx(0.1, abs=4.0 * math.sqrt(0.09 / 40_000))


def test_the_limit_grows_with_the_correlation_and_falls_with_runs_and_beds() -> None:
    bed = np.arange(96) % 24
    limits = [unseen_limit(bed, correlation=one) for one in (0.0, 1e-6, 0.07, 0.3, 0.5, 0.999999, 1.0)]
    assert limits == sorted(limits)
    assert unseen_limit(bed[:48]) > unseen_limit(bed) > unseen_limit(np.arange(96))
    assert unseen_limit(bed) == pytest.approx(0.0453, abs=1e-4)


def test_runs_of_unequal_weight_count_as_fewer() -> None:
    bed, weights = np.arange(48) % 12, np.where(np.arange(48) < 24, 1.0, 1e-9)
    assert unseen_limit(bed, weights=np.full(48, 3.0)) == pytest.approx(unseen_limit(bed))
    # Half of the landings hardly count: as if half of the beds had not been there.
    assert unseen_limit(bed, weights=weights) == pytest.approx(unseen_limit(bed[bed < 6]))
    assert share_estimate(np.zeros(48), bed, weights=weights).share.upper == unseen_limit(bed, weights=weights)


@pytest.mark.parametrize(("beds", "runs"), [(8, 4), (12, 4), (24, 4), (30, 3), (24, 10), (12, 20)])
def test_more_landings_at_rest_never_make_the_lower_end_lower(beds: int, runs: int) -> None:
    bed = np.arange(beds * runs) % beds
    found = [share_estimate((np.arange(len(bed)) >= failed).astype(float), bed).share for failed in range(4)]
    assert found[0].lower == 1.0 - unseen_limit(bed)
    ends = [one.lower for one in found]
    assert ends == sorted(ends, reverse=True)
    assert [one.upper for one in found] == sorted((one.upper for one in found), reverse=True)


def test_a_hundredth_of_a_landing_says_no_more_than_none() -> None:
    bed, shares = np.arange(96) % 24, np.ones(96)
    shares[5] = 0.99
    nearly = share_estimate(shares, bed).share
    assert nearly.lower == share_estimate(np.ones(96), bed).share.lower
    assert nearly.value < nearly.upper < 1.0


def test_one_landing_that_differs_is_held_where_landings_are_independent() -> None:
    """An interval by its own error alone held 0.84 of the studies at three in a thousand."""
    random, truth, bed, held = np.random.default_rng(4), 0.0018, np.arange(96) % 24, 0
    for _ in range(1000):
        found = share_estimate((random.random(96) < truth).astype(float), bed).share
        held += found.lower <= truth <= found.upper
    assert held >= 880


def test_the_correlation_that_limits_hold_for_is_beyond_that_of_99_of_100_studies() -> None:
    found = json.loads((ROOT / "benchmarks" / "results" / "bed_correlation.json").read_text("utf-8"))["all"]
    assert found["quantile_0.99"] <= LARGEST_CORRELATION
    assert found["above_limit"] <= 0.01


@pytest.mark.parametrize("bed", [None, "abc", 3, [np.nan, 1.0], [None, None], [[1, 2], [3, 4]]])
def test_what_is_no_label_for_each_run_has_no_limit(bed: object) -> None:
    with pytest.raises(ValueError, match=r"bed h(as shape|old)"):
        unseen_limit(bed)  # type: ignore[arg-type]


def test_what_cannot_be_is_refused() -> None:
    with pytest.raises(ValueError, match="must be a whole number from 0 to 9007199254740992"):
        upper_limit(10**400)
    with pytest.raises(ValueError, match=r"weights have shape \(2,\); give one finite number above 0 for each of 3"):
        unseen_limit([0, 0, 1], weights=[1.0, 2.0])
    with pytest.raises(ValueError, match=r"correlation is 1.5"):
        unseen_limit([0, 0, 1], correlation=1.5)


@pytest.mark.parametrize("correlation", [1e-15, 1e-8])
def test_a_correlation_that_rounding_hides_is_none(correlation: float) -> None:
    runs = np.repeat(np.arange(12), 20)
    assert unseen_limit(runs, correlation=correlation) == pytest.approx(unseen_limit(runs, correlation=0.0), rel=1e-4)
    assert 0.0 < even_limit(2**40, 2**40 - 1) < 1e-10
