"""Some synthetic studies a setting: the intervals hold the truth as often as they say, as far as so many can tell.

Two hundred studies a setting, and more settings: `benchmarks/estimate_coverage.py`, from which the studies come.
"""

import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import estimate_coverage
from estimate_coverage import (
    Row,
    Truth,
    flights,
    like_missing,
    missing,
    no_event,
    side_runs,
    summed,
    table,
)

STUDIES = 16
# Of so many nominal 90 % intervals: 2.5 standard deviations of the share that holds.
LEAST = 0.9 - 2.5 * np.sqrt(0.09 / STUDIES)
HELD = (
    *("share", "next bed", "mean", "quantile 0.05", "quantile 0.5", "quantile 0.95"),
    *("bed share", "soil share"),
)


def check(found: dict[str, Row]) -> None:
    """A nominal 90 % interval holds as often as so many studies tell."""
    assert {name: row["held"] for name, row in found.items() if name in HELD and not LEAST <= row["held"] <= 1.0} == {}
    # Half a point of share, and two standard errors of so many studies, whose deviation is 0.6 of a half width.
    assert abs(found["share"]["bias"]) < 0.005 + 2.0 * 0.6 / np.sqrt(STUDIES) * found["share"]["half_width"]


@pytest.fixture(scope="module", autouse=True)
def truths() -> Iterator[None]:
    """Truths from fewer draws than in the benchmark: their standard errors are less than a tenth of a half width."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(estimate_coverage, "exact_share", partial(estimate_coverage.exact_share, count=100_000))
        patch.setattr(estimate_coverage, "DRAW_COUNT", 50_000)
        yield


@pytest.mark.parametrize(("runs", "beds", "rho"), [(144, 12, 0.0), (144, 12, 0.2), (240, 24, 0.05)])
def test_intervals_hold_the_truth(runs: int, beds: int, rho: float) -> None:
    check(table(Truth(rho=rho), runs, beds, STUDIES))


@pytest.mark.parametrize(("lost", "most"), [
    (Truth(rim="random", rim_share=0.1), 1.0),
    (Truth(rim="fast", rim_share=0.03), 1.0),
    # None of the lost returns: the truth is an end of what may be, and the interval is not wider than it says.
    (Truth(rim="fast", rim_share=0.1, rim_returns=False), 0.98),
])  # fmt: skip
def test_the_interval_holds_the_truth_whatever_the_lost_landings_do(lost: Truth, most: float) -> None:
    studies = [missing(lost, seed) for seed in range(STUDIES)]
    assert LEAST <= summed(studies, "share")["held"] <= most
    if lost.rim == "fast":
        assert summed(studies, "share, those with an outcome alone")["held"] < 0.75


def test_landings_like_the_lost_ones_take_most_of_the_bias_off_the_estimate() -> None:
    studies = [like_missing(Truth(rim="fast", rim_share=0.2), seed) for seed in range(10)]
    plain, like = (summed(studies, f"share, half of the rim known{words}") for words in ("", " and like the other"))
    assert plain["bias"] > 0.015
    assert abs(like["bias"]) < 0.3 * plain["bias"]
    assert like["held"] >= 0.9


@pytest.mark.parametrize("soil", [0.0, 2.7])
def test_the_share_of_the_soil_is_free_of_bias(soil: float) -> None:
    found = table(Truth(soil=soil), 240, 24, STUDIES)
    assert abs(found["soil share"]["bias"]) < 0.02
    if soil == 0.0:
        assert found["inputs not found"]["held"] >= 0.9


def test_ten_times_the_flights_hardly_change_the_interval() -> None:
    assert np.mean([flights(Truth(), seed, systematic=True) for seed in range(10)]) == pytest.approx(1.0, abs=0.03)


def test_side_runs_hold_the_truth() -> None:
    found = [side_runs(Truth(), 20, seed) for seed in range(STUDIES)]
    for name in found[0]:
        assert LEAST <= summed(found, name)["held"] <= 1.0, name


@pytest.mark.parametrize("runs", [20, 60, 300])
def test_a_rare_capture_is_not_ruled_out(runs: int) -> None:
    assert no_event(runs, 200) >= 0.9
