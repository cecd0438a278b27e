"""The parts of an emulator: coordinates of outputs, rows of scatter, beds, outcomes and scores."""

import sys

import numpy as np
import pytest
from scipy import special, stats

from lithobrake.chaos import Uniform, sobol_sequence
from lithobrake.emulator.density import BedEffect
from lithobrake.emulator.law import (
    INVERSE_PENALTIES,
    OutcomeClasses,
    best_class_choice,
    drawn_rows,
    fit_classes,
    row_weights,
    smoothed,
    smoothing,
)
from lithobrake.emulator.mean_law import candidate_terms
from lithobrake.emulator.training_runs import from_coordinate, to_coordinate, with_slope
from lithobrake.emulator.validation import crps, energy_scores, pit

LOWER = np.array([0.0, -1.0, -np.inf, -np.inf])
UPPER = np.array([0.4, np.inf, 2.0, np.inf])


def test_coordinates_and_outputs_are_each_others_inverse() -> None:
    y = np.array([[0.1, 3.0, -5.0, 7.0], [0.39, -0.999, 1.999, -7.0]])
    coordinate = to_coordinate(y, LOWER, UPPER)
    np.testing.assert_allclose(from_coordinate(coordinate, LOWER, UPPER), y, rtol=1e-12)
    np.testing.assert_allclose(coordinate[0], [np.log(0.1 / 0.3), np.log(4.0), -np.log(7.0), 7.0])


def test_larger_coordinates_are_larger_outputs() -> None:
    assert (np.diff(from_coordinate(np.linspace(-5.0, 5.0, 50)[:, None], LOWER, UPPER), axis=0) > 0.0).all()


def test_no_coordinate_reaches_a_bound() -> None:
    y = from_coordinate(np.array([[-1e6], [-40.0], [40.0], [1e6]]), LOWER, UPPER)
    assert ((y > LOWER) & (y < UPPER)).all()
    assert np.isfinite(y).all()


def test_slopes_are_derivatives_of_coordinates() -> None:
    y, step = np.array([[0.1, 3.0, -5.0, 7.0], [0.39, -0.5, 1.5, -7.0]]), 1e-5
    coordinate, slope = with_slope(y, LOWER, UPPER)
    np.testing.assert_array_equal(coordinate, to_coordinate(y, LOWER, UPPER))
    difference = (to_coordinate(y + step, LOWER, UPPER) - to_coordinate(y - step, LOWER, UPPER)) / (2.0 * step)
    np.testing.assert_allclose(slope, difference, rtol=1e-5)


def test_beyond_a_bound_coordinates_are_infinite_and_slopes_zero() -> None:
    y = np.array([[-9.0] * 4, [9.0] * 4])
    coordinate, slope = with_slope(y, LOWER, UPPER)
    beyond = (y <= LOWER) | (y >= UPPER)
    np.testing.assert_array_equal(coordinate[beyond], [-np.inf, -np.inf, np.inf, np.inf])
    assert (slope[beyond] == 0.0).all()
    assert np.isfinite(coordinate[~beyond]).all()


def test_near_rows_are_drawn_more_often() -> None:
    rows = np.array([[-1.0], [0.0], [1.0]])
    chances = row_weights(np.array([[-1.0], [1.0], [50.0]]), rows, np.ones(3), [0.5 * np.sqrt(2.0)])
    np.testing.assert_allclose(chances.sum(axis=1), 1.0)
    assert (np.diff(chances[0]) < 0.0).all()
    assert (np.diff(chances[1]) > 0.0).all()
    assert chances[2].argmax() == 2
    np.testing.assert_allclose(row_weights(rows, rows, np.array([1.0, 0.0, 3.0]), np.inf), [[0.25, 0.0, 0.75]] * 3)


def test_rows_are_drawn_by_their_chances() -> None:
    chances = np.array([[0.2, 0.0, 0.8], [0.0, 1.0, 0.0], [0.5, 0.5, 0.0]])
    row = drawn_rows(chances, 20_000, np.random.default_rng(0))
    for found, expected in zip(row, chances, strict=True):
        np.testing.assert_allclose(np.bincount(found, minlength=3) / 20_000, expected, atol=0.015)


def test_smoothing_keeps_mean_variance_correlation_and_most_of_the_skewness() -> None:
    random = np.random.default_rng(1)
    first = random.exponential(size=300)
    rows = np.column_stack([first, first + random.standard_normal(300)])
    rows = (rows - rows.mean(axis=0)) / rows.std(axis=0)
    size, root = smoothing(rows, np.ones(300))
    drawn = smoothed(rows[random.integers(300, size=200_000)], size, root, random)
    assert len(np.unique(drawn[:, 0])) == 200_000
    np.testing.assert_allclose(drawn.mean(axis=0), 0.0, atol=0.01)
    np.testing.assert_allclose(np.cov(drawn.T), np.cov(rows.T, ddof=0), atol=0.02)
    assert stats.skew(drawn[:, 0]) > 0.85 * stats.skew(rows[:, 0])


SHARES = np.array([0.3, 0.0])


def runs(beds: int, of_bed: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows of two independent outputs of variance 1 with these shares of the bed, and the bed of each."""
    random, bed = np.random.default_rng(seed), np.repeat(np.arange(beds), of_bed)
    effects = np.sqrt(SHARES) * random.standard_normal((beds, 2))
    return effects[bed] + np.sqrt(1.0 - SHARES) * random.standard_normal((len(bed), 2)), bed


def test_the_covariance_of_beds_is_found_and_a_bed_that_counts_twice_is_two() -> None:
    rows, bed = runs(400, 5, 1)
    found = BedEffect.of_groups(rows, np.ones(len(rows)), bed).before
    # Standard error of a share of 0.3 from 400 beds of 5 runs: sqrt(2 / 400) * (0.3 + 0.7 / 5) = 0.031.
    assert np.abs(found - np.diag(SHARES)).max() < 3 * 0.031
    first, twice = rows[:1000], np.where(bed[:1000] < 100, 2.0, 1.0)
    copied = np.vstack([first, first[:500]]), np.concatenate([bed[:1000], bed[:500] + 400])
    weighted = BedEffect.of_groups(first, twice, bed[:1000]).before
    assert weighted == pytest.approx(BedEffect.of_groups(copied[0], np.ones(1500), copied[1]).before, abs=1e-12)


def test_runs_on_a_bed_predict_the_next_as_random_beds_do() -> None:
    share, seen = 0.3, [0.5, 1.5, -0.4]
    effect, root, sharp = BedEffect.unseen(np.array([[share]])), np.eye(1), np.zeros((1, 1))
    assert effect.spread.tolist() == [[[1.0]]]
    for value in seen:
        effect = effect.given(root, [0], np.array([[value]]) - effect.mean, sharp)
    factor = share / (1.0 - share + len(seen) * share)
    assert effect.mean[0, 0] == pytest.approx(factor * sum(seen))
    assert effect.covariance[0, 0, 0] == pytest.approx(factor * (1.0 - share))
    assert effect.spread[0, 0, 0] ** 2 == pytest.approx(1.0 - share + factor * (1.0 - share))


def test_outputs_that_were_not_seen_or_seen_with_errors_say_less_of_the_bed_in_any_order() -> None:
    rows, _ = runs(50, 4, 2)
    root = smoothing(rows, np.ones(len(rows)))[1]
    before = np.array([[0.4, 0.1], [0.1, 0.2]])
    whole = ([0, 1], np.array([[1.0, -0.5]]), np.zeros((1, 2)))
    part, blurred = ([1], np.array([[0.7]]), np.zeros((1, 1))), ([0], np.array([[0.2]]), np.array([[2.0]]))

    def after(*seen: tuple[list[int], np.ndarray, np.ndarray]) -> BedEffect:
        effect = BedEffect.unseen(before)
        for columns, values, blur in seen:
            effect = effect.given(root, columns, values - effect.mean @ root[columns].T, blur)
        return effect

    first, second = after(whole, part, blurred), after(blurred, part, whole)
    assert (first.mean, first.covariance) == (pytest.approx(second.mean), pytest.approx(second.covariance))
    left = [np.trace(one.covariance[0]) for one in (after(), after(blurred), after(part), after(whole), first)]
    assert left == sorted(left, reverse=True)


@pytest.mark.parametrize("bed", [np.arange(6), np.zeros(6, dtype=np.int64)])
def test_runs_that_show_no_bed_are_refused(bed: np.ndarray) -> None:
    with pytest.raises(ValueError, match="no bed of the emulator has two runs with outputs"):
        BedEffect.of_groups(np.ones((6, 1)), np.ones(6), bed)


COUNT = 300


def test_an_outcome_that_never_was_has_half_an_event() -> None:
    linear = np.random.default_rng(0).standard_normal((COUNT, 2))
    classes = fit_classes(linear, np.ones(2), np.zeros(COUNT, dtype=int), 2, INVERSE_PENALTIES[0], np.ones(COUNT))
    np.testing.assert_allclose(classes.chances(linear)[:, 1], 0.5 / (COUNT + 1))
    np.testing.assert_allclose(classes.chances(linear).sum(axis=1), 1.0)


@pytest.mark.parametrize("class_count", [2, 3, 4])
def test_chances_sum_to_one_and_are_near_the_shares(class_count: int) -> None:
    random = np.random.default_rng(1)
    linear = random.standard_normal((COUNT, 3))
    outcome = np.minimum(random.integers(0, 20, COUNT), min(class_count, 3) - 1)
    classes = fit_classes(linear, np.ones(3), outcome, class_count, INVERSE_PENALTIES[0], np.ones(COUNT))
    chances = classes.chances(linear)
    np.testing.assert_allclose(chances.sum(axis=1), 1.0)
    assert (chances > 0.0).all()
    # Half an event for each class that was met, and for one that was not.
    counts = np.bincount(outcome, minlength=class_count)
    met, never = counts > 0, (counts == 0).sum() * 0.5 / (COUNT + 1.0)
    expected = np.where(met, (1.0 - never) * (counts + 0.5) / (COUNT + 0.5 * met.sum()), 0.5 / (COUNT + 1.0))
    np.testing.assert_allclose(chances.mean(axis=0), expected, rtol=1e-3)


def fitted(matrix: np.ndarray, outcome: np.ndarray, indices: np.ndarray) -> OutcomeClasses:
    """Chances with what groups left out have chosen; outputs come with the outcome 0."""
    choice = best_class_choice(indices, matrix, outcome, 0, 2, np.arange(COUNT) % 5)
    return fit_classes(matrix, choice.factors(indices), outcome, 2, choice.inverse_penalty, np.ones(COUNT))


def test_a_slope_is_followed_and_noise_is_not() -> None:
    random = np.random.default_rng(2)
    linear, indices = random.standard_normal((COUNT, 2)), np.eye(2, dtype=int)
    steep = (random.random(COUNT) < special.expit(-1.0 + 1.5 * linear[:, 0])).astype(int)
    low, high = fitted(linear, steep, indices).chances(np.array([[-1.5, 0.0], [1.5, 0.0]]))[:, 1]
    assert low < 0.15 < 0.55 < high
    flat = (random.random(COUNT) < 0.04).astype(int)
    assert np.abs(fitted(linear, flat, indices).chances(linear)[:, 1] - 0.04).mean() < 0.02


def test_a_ring_is_followed() -> None:
    """What lies in a ring about the middle is captured: a linear logit is off by 0.46, as a constant is."""
    inputs = {"a": Uniform(-1.0, 1.0), "b": Uniform(-1.0, 1.0), "c": Uniform(-1.0, 1.0)}
    terms, fresh = candidate_terms(inputs), sobol_sequence(inputs, 500, seed=4)
    x = sobol_sequence(inputs, COUNT, seed=3)
    captured = (np.abs(np.hypot(x[:, 0], x[:, 1]) - 0.6) < 0.2).astype(int)
    chances = fitted(terms.matrix(x), captured, terms.indices).chances(terms.matrix(fresh))[:, 1]
    truth = np.abs(np.hypot(fresh[:, 0], fresh[:, 1]) - 0.6) < 0.2
    assert np.sqrt(np.mean((chances - truth) ** 2)) < 0.25


RANDOM = np.random.default_rng(4)
MEMBERS, WEIGHTS = RANDOM.standard_normal((40, 3)), RANDOM.dirichlet(np.ones(40), size=5)
OBSERVED = RANDOM.standard_normal((5, 3))


def test_energy_score_is_its_double_sum() -> None:
    scales = RANDOM.uniform(0.5, 2.0, (5, 3))
    scores = energy_scores(MEMBERS, np.stack([WEIGHTS, WEIGHTS[::-1]]), scales, OBSERVED)
    for case in range(5):
        points = scales[case] * MEMBERS
        distances = np.linalg.norm(points[:, None] - points, axis=2)
        for k, weight in enumerate((WEIGHTS[case], WEIGHTS[::-1][case])):
            near = weight @ np.linalg.norm(points - OBSERVED[case], axis=1)
            assert scores[k, case] == pytest.approx(near - 0.5 * weight @ distances @ weight)


def test_crps_is_the_energy_score_of_one_output() -> None:
    values = np.broadcast_to(MEMBERS[:, 0], (5, 40))
    expected = energy_scores(MEMBERS[:, :1], WEIGHTS[None], np.ones((5, 1)), OBSERVED[:, :1])[0]
    np.testing.assert_allclose(crps(values, WEIGHTS, OBSERVED[:, 0]), expected, rtol=1e-12)


def test_pit_is_the_weight_below() -> None:
    weights = np.array([[0.1, 0.2, 0.7]])
    values = np.array([[3.0, 1.0, 2.0]])
    for seen, expected in ((0.0, 0.0), (1.5, 0.2), (2.0, 0.55), (9.0, 1.0)):
        assert pit(values, weights, np.array([seen]))[0] == pytest.approx(expected)


def test_scores_of_equal_members_are_those_of_scoringrules(monkeypatch: pytest.MonkeyPatch) -> None:
    # Where there is Numba it compiles all of its scores as it is imported; those of NumPy are asked for.
    monkeypatch.setitem(sys.modules, "numba", None)
    sr = pytest.importorskip("scoringrules", reason="scoringrules is not installed")
    alike = np.full((5, 40), 1.0 / 40.0)
    values = np.broadcast_to(MEMBERS[:, 0], (5, 40))
    # "nrg" is the plain double sum; its other estimators are made fair to few members.
    theirs = sr.crps_ensemble(OBSERVED[:, 0], values, estimator="nrg", backend="numpy")
    np.testing.assert_allclose(crps(values, alike, OBSERVED[:, 0]), theirs, rtol=1e-10)
    joint = sr.es_ensemble(OBSERVED, np.broadcast_to(MEMBERS, (5, 40, 3)), estimator="nrg", backend="numpy")
    np.testing.assert_allclose(energy_scores(MEMBERS, alike[None], np.ones((5, 3)), OBSERVED)[0], joint, rtol=1e-10)
