"""Which landings meet a limit state, and rare ones against probabilities in closed form and OpenTURNS."""

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from lithobrake.analysis import subset_simulation
from lithobrake.analysis.subset_simulation import FAR, NEAR, limit_state_margin, limit_state_met
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.outcomes import FATES

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from reliability_coverage import LIMIT_STATES, openturns_subset
from subset_with_chance import EXACT
from subset_with_chance import one as with_chance

NAN = np.nan
# Four landings: fast and gone, slow and down again, captured, and one of which nobody knows.
LANDINGS = {
    "speed_out": [0.2, 0.05, NAN, NAN], "peak_acceleration": [30.0, 60.0, 70.0, NAN], "captured": [0.0, 0.0, 1.0, NAN],
    "returns": [0.0, 1.0, 1.0, NAN], "escaped": [1.0, 0.0, 0.0, NAN],
}  # fmt: skip
MET: list[tuple[str, list[float]]] = [
    ("speed_out > 0.1", [1, 0, 0, NAN]),
    # What is captured has no speed, so it is neither above nor below any.
    ("speed_out <= 0.1", [0, 1, 0, NAN]),
    ("not speed_out > 0.1", [0, 1, 1, NAN]),
    ("peak_acceleration > 50", [0, 1, 1, NAN]),
    ("returns == false", [1, 0, 0, NAN]),
    ("returns != true", [1, 0, 0, NAN]),
    ("not returns", [1, 0, 0, NAN]),
    ("captured or 0.01 < speed_out < 1e-1", [0, 1, 1, NAN]),
    ("(escaped or captured) and peak_acceleration > 50", [0, 0, 1, NAN]),
    ("speed_out > -1 and not returns", [1, 0, 0, NAN]),
]
# How far the same landings are from meeting conditions, speeds counted in 0.1 m/s and accelerations in 10 m/s2.
SCALE = {"speed_out": 0.1, "peak_acceleration": 10.0}
MARGINS: list[tuple[str, list[float]]] = [
    ("speed_out > 0.1", [-1.0, 0.5, FAR, FAR]), ("not speed_out > 0.1", [1.0, -0.5, -FAR, FAR]),
    ("0.05 < speed_out <= 0.3", [-1.0, NEAR, FAR, FAR]),
    ("speed_out > 0.1 and peak_acceleration > 50", [2.0, 0.5, FAR, FAR]),
    ("speed_out > 0.3 or peak_acceleration > 50", [1.0, -1.0, -2.0, FAR]),
    ("speed_out > 0.1 and not captured", [-1.0, 0.5, FAR, FAR]), ("0 < 0.1 < speed_out", [-1.0, 0.5, FAR, FAR]),
]  # fmt: skip


@pytest.mark.parametrize(("text", "margins"), MARGINS)
def test_a_margin_says_how_far_a_landing_is_from_meeting_it(text: str, margins: list[float]) -> None:
    values = {name: np.array(numbers) for name, numbers in LANDINGS.items()}
    found = limit_state_margin(LimitState.of(text), values, SCALE)
    assert found == pytest.approx(np.array(margins), rel=1e-12)
    assert np.array_equal(found <= 0.0, limit_state_met(LimitState.of(text), values) == 1.0)


@pytest.mark.parametrize(("text", "expected"), MET)
def test_landings_meet_a_condition_or_not_or_nobody_knows(text: str, expected: list[float]) -> None:
    values = {name: np.array(value) for name, value in LANDINGS.items()}
    assert limit_state_met(LimitState.of(text), values).tolist() == pytest.approx(expected, nan_ok=True)


def test_what_is_known_decides_where_it_can() -> None:
    unknown = {name: np.array([NAN]) for name in FATES} | {"speed_out": np.array([0.2])}
    assert limit_state_met(LimitState.of("speed_out > 0.1 or returns"), unknown).tolist() == [1.0]
    assert limit_state_met(LimitState.of("speed_out < 0.1 and returns"), unknown).tolist() == [0.0]
    assert np.isnan(limit_state_met(LimitState.of("speed_out > 0.1 and returns"), unknown)).all()


SEEDS = 40


@pytest.mark.parametrize("name", LIMIT_STATES)
def test_probabilities_of_closed_form_are_met_and_their_bounds_hold(name: str) -> None:
    margin, dimension, exact = LIMIT_STATES[name]
    found = [subset_simulation(margin, dimension, points_per_level=500, seed=seed) for seed in range(SEEDS)]
    told = np.mean([one.coefficient_of_variation for one in found])
    mean = np.mean([one.probability.value for one in found])
    assert mean == pytest.approx(exact, rel=3.0 * told / np.sqrt(SEEDS))
    # A nominal 90 % interval holds in 0.75 to 1 of forty (three standard deviations).
    assert np.mean([one.probability.lower <= exact <= one.probability.upper for one in found]) >= 0.75
    for one in found:
        assert (margin(one.failing) <= 0.0).all()
        assert one.thresholds[-1] == 0.0
        assert (np.diff(one.thresholds) < 0.0).all()
        # Of each level but the first the seeds are known.
        assert one.evaluation_count <= 500 * len(one.thresholds) - 20 * (len(one.thresholds) - 1)


def test_openturns_agrees() -> None:
    pytest.importorskip("openturns", reason="openturns is not installed")
    margin, dimension, exact = LIMIT_STATES["linear, 2 inputs"]
    ours = [subset_simulation(margin, dimension, seed=seed).probability.value for seed in range(16)]
    theirs = [openturns_subset(margin, dimension, 1000, seed)[0] for seed in range(3)]
    # Each scatters by about a quarter.
    assert np.mean(ours) == pytest.approx(np.mean(theirs), rel=3.0 * 0.27 * np.sqrt(1.0 / 16.0 + 1.0 / 3.0))
    assert np.mean(ours) == pytest.approx(exact, rel=3.0 * 0.27 / np.sqrt(16.0))


def test_kept_inputs_stay_along_a_chain() -> None:
    """Beds that jump: the margin depends on which of twelve a landing is on, drawn at the start of each chain."""
    beds = np.linspace(-0.4, 0.4, 12)

    def margin(points: np.ndarray) -> np.ndarray:
        bed = np.minimum((12.0 * stats.norm.cdf(points[:, 0])).astype(int), 11)
        return 3.0 - beds[bed] - points[:, 1]

    exact = stats.norm.sf(3.0 - beds).mean()
    found = [subset_simulation(margin, 2, kept=[0], points_per_level=500, seed=seed) for seed in range(SEEDS)]
    told = np.mean([one.coefficient_of_variation for one in found])
    assert np.mean([one.probability.value for one in found]) == pytest.approx(exact, rel=3.0 * told / np.sqrt(SEEDS))


@pytest.mark.parametrize(
    ("noise_share", "bed_share", "bed_count"),
    [(0.75, 0.0, 1), (0.0, 0.2, 12)],
    ids=["chance that is no input", "beds that differ"],
)
def test_bounds_hold_where_chains_share_chance(noise_share: float, bed_share: float, bed_count: int) -> None:
    found = [with_chance(noise_share, bed_share, bed_count, 500, seed) for seed in range(SEEDS)]
    # Bounds from the correlation within chains alone held 0.6 of both.
    assert np.mean([each.probability.lower <= EXACT <= each.probability.upper for each in found]) >= 0.75


def test_shares_of_levels_make_the_probability_and_origins_count_those_that_led_to_it() -> None:
    margin, dimension, _ = LIMIT_STATES["linear, 2 inputs"]
    found = subset_simulation(margin, dimension, points_per_level=500)
    assert len(found.shares) == len(found.thresholds)
    assert found.probability.value == pytest.approx(np.prod(found.shares))
    assert 1.0 <= found.origins <= 50.0
    # The first of two groups has all that fails.
    kept = {"kept": [0], "groups": lambda points: points[:, 0] > 0.0}
    halves = subset_simulation(lambda points: np.where(points[:, 0] > 0.0, 2.0 - points[:, 1], 9.0), 2, **kept)
    assert (halves.origins, halves.coefficient_of_variation) == (1.0, pytest.approx(1.0, abs=0.1))


def test_a_failure_that_is_common_takes_one_level() -> None:
    found = subset_simulation(lambda points: 0.5 - points[:, 0], 1, points_per_level=1000)
    assert (found.evaluation_count, found.thresholds.tolist()) == (1000, [0.0])
    assert found.probability.lower < stats.norm.sf(0.5) < found.probability.upper


@pytest.mark.parametrize(("exact", "levels"), [(0.07, 1), (0.03, 2)])
def test_levels_that_would_gain_nothing_are_not_made(exact: float, levels: int) -> None:
    """Of 1000 points 0.07 fail within 0.05 to 0.09, 0.03 within 0.01 to 0.05: three standard deviations and more."""
    found = subset_simulation(lambda points: stats.norm.isf(exact) - points[:, 0], 1, points_per_level=1000)
    assert len(found.thresholds) == levels


def test_a_failure_that_cannot_be_has_probability_0_and_says_that_it_was_not_reached() -> None:
    found = subset_simulation(lambda points: np.ones(len(points)), 2)
    assert (found.probability.value, found.probability.lower, found.reached) == (0.0, 0.0, False)


def test_few_levels_end_with_what_their_points_show_of_a_rarer_failure() -> None:
    margin, dimension, exact = LIMIT_STATES["linear, 2 inputs"]
    # Two levels end at 1e-2, of which a tenth fails.
    found = [subset_simulation(margin, dimension, most_levels=2, seed=seed) for seed in range(10)]
    assert {len(one.thresholds) for one in found} == {3}
    assert np.mean([one.probability.value for one in found]) == pytest.approx(exact, rel=3.0 * 0.27 / np.sqrt(10.0))
    never = subset_simulation(lambda points: 20.0 - points[:, 0], 2, most_levels=2)
    assert (never.probability.value, never.reached, never.probability.upper) == (0.0, False, pytest.approx(1e-2))


def test_the_same_seed_gives_the_same_bits() -> None:
    margin, dimension, _ = LIMIT_STATES["linear, 2 inputs"]
    first, again = (subset_simulation(margin, dimension, seed=3) for _ in range(2))
    assert first.probability.value == again.probability.value
    assert np.array_equal(first.failing, again.failing)


@pytest.mark.parametrize(("arguments", "words"), [
    ({"points_per_level": 25}, "points_per_level is 25; allowed: multiples of 10 from 20"),
    ({"points_per_level": 10}, "points_per_level is 10"),
    ({"most_levels": 0}, "most_levels is 0, but must be a whole number of at least 1"),
    ({"most_levels": -1}, "most_levels is -1"),
    ({"groups": lambda points: points[:, 1] * np.nan}, "groups hold NaN"),
    ({"groups": lambda points: points[:3, 1]}, "groups has shape"),
    ({"seed": "x"}, "seed is 'x'"),
    ({"kept": [0, 1]}, r"kept is \[0, 1\] of 2 inputs"),
])  # fmt: skip
def test_counts_that_cannot_be_are_refused(arguments: dict[str, object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        subset_simulation(lambda points: points[:, 0], 2, **arguments)


def test_a_count_may_be_a_whole_float() -> None:
    margin, dimension, _ = LIMIT_STATES["linear, 2 inputs"]
    of_float, of_int = (subset_simulation(margin, dimension, points_per_level=count) for count in (100.0, 100))
    assert of_float.probability.value == of_int.probability.value


def test_margins_that_are_no_numbers_are_refused() -> None:
    with pytest.raises(ValueError, match="margin gave shape"):
        subset_simulation(lambda points: np.full(len(points), np.nan), 2)
