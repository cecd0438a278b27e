"""The synthetic landings have the shares, variances and skewness that they say."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import special, stats

from .synthetic_landings import (
    ELEVATION_LIMIT,
    NO_SOIL,
    SPEED_LIMIT,
    STRONG,
    WEAK,
    Landings,
    Truth,
    exact_share,
    random_soils,
    returns,
)

COUNT = 40_000


def drawn(truth: Truth, bed_count: int = COUNT) -> tuple[np.ndarray, np.ndarray, Landings]:
    """Soils, beds and landings, as many as COUNT."""
    rng = np.random.default_rng(5)
    x, bed = random_soils(COUNT, rng), np.arange(COUNT) % bed_count
    return x, bed, truth.draw(x, rng.standard_normal(bed_count)[bed], rng)


@pytest.mark.parametrize(
    ("truth", "speed", "elevation"), [(NO_SOIL, 0.0, 0.0), (WEAK, 0.057, 0.062), (STRONG, 0.335, 0.371)]
)
def test_the_soil_explains_what_it_should(truth: Truth, speed: float, elevation: float) -> None:
    # Two landings at each soil share the soil alone: their covariance is the variance that the soil explains.
    rng = np.random.default_rng(3)
    x = np.repeat(random_soils(COUNT, rng), 2, axis=0)
    y = replace(truth, capture=0.0).draw(x, rng.standard_normal(len(x)), rng).y.reshape(COUNT, 2, 4)
    for k, expected in ((0, speed), (1, elevation)):
        assert abs(np.corrcoef(y[:, 0, k], y[:, 1, k])[0, 1] - expected) < 4.0 / np.sqrt(COUNT)


@pytest.mark.parametrize("rho", [0.0, 0.05, 0.2])
def test_beds_share_what_they_should(rho: float) -> None:
    _, bed, landings = drawn(Truth(soil=0.0, rho=rho, capture=0.0), bed_count=COUNT // 2)
    pairs = special.logit(landings.y[np.argsort(bed), 0] / SPEED_LIMIT).reshape(-1, 2)
    assert abs(np.corrcoef(pairs.T)[0, 1] - rho) < 4.0 / np.sqrt(COUNT // 2)


@pytest.mark.parametrize("rim", ["none", "random", "fast_flat"])
def test_outcomes_have_their_shares(rim: str) -> None:
    _, _, landings = drawn(replace(STRONG, rim=rim))
    captured, over = (landings.outcome == one for one in ("captured", "left_sideways"))
    slack = 4.0 * np.sqrt(0.25 / COUNT)
    assert abs(captured.mean() - 0.04) < slack
    assert abs(over.sum() / (~captured).sum() - (Truth().rim_share if rim != "none" else 0.0)) < slack
    assert np.isnan(landings.y[captured | over]).all()
    assert np.isnan(landings.left[:, 0]).tolist() == captured.tolist()
    faster = landings.left[over, 0].mean() - np.nanmean(landings.y[:, 0]) if over.any() else 0.0
    assert (faster > 0.03) == (rim == "fast_flat")


def test_outputs_keep_their_bounds() -> None:
    _, _, landings = drawn(replace(STRONG, capture=0.0))
    speed, elevation, azimuth, spin = landings.y.T
    assert 0.0 < speed.min() < speed.max() < SPEED_LIMIT
    assert 0.0 < elevation.min() < elevation.max() < ELEVATION_LIMIT
    assert np.abs(azimuth).max() <= np.pi
    assert spin.min() > 0.0
    share = returns(landings.y, landings.outcome)
    assert 0.0 < share.min() < share.max() < 1.0


def test_one_branch_has_the_given_skewness() -> None:
    _, _, landings = drawn(Truth(soil=0.0, rho=0.0, capture=0.0, skewness=2.0, branch_gap=0.0))
    assert abs(stats.skew(special.logit(landings.y[:, 0] / SPEED_LIMIT)) - 2.0) < 0.15


def test_the_exact_share_is_that_of_all_landings() -> None:
    _, _, landings = drawn(replace(WEAK, rim="fast_flat"))
    exact = exact_share(WEAK, 200_000)
    assert abs(returns(landings.left, landings.outcome).mean() - exact) < 0.003
    # Those who are seen to leave clear are not a fair sample where the fast and flat are lost.
    assert np.nanmean(returns(landings.y, landings.outcome)) > exact + 0.02


def test_a_study_has_beds_of_equal_counts_and_comes_again() -> None:
    x, y, outcome, bed = WEAK.study(144, 12, seed=4)
    assert np.bincount(bed).tolist() == [12] * 12
    assert x.shape == (144, 5)
    assert np.isnan(y[outcome != "clear"]).all()
    assert not np.isnan(y[outcome == "clear"]).any()
    for first, again in zip((x, y, outcome, bed), WEAK.study(144, 12, seed=4), strict=True):
        np.testing.assert_array_equal(first, again)


def test_conditional_draws_are_those_of_their_soil() -> None:
    rng = np.random.default_rng(8)
    soil = random_soils(1, rng)[0]
    many = replace(STRONG, capture=0.0).draw(np.tile(soil, (COUNT, 1)), rng.standard_normal(COUNT), rng).y
    assert stats.ks_2samp(STRONG.conditional(soil, COUNT)[:, 0], many[:, 0]).pvalue > 0.001
