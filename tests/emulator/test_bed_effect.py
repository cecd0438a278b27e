"""What runs on one bed have in common: its size from runs, and what some of them say of the next."""

import numpy as np
import pytest

from lithobrake.emulator.density import BedEffect
from lithobrake.emulator.law import smoothing

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
    assert first.mean == pytest.approx(second.mean)
    assert first.covariance == pytest.approx(second.covariance)
    left = [np.trace(one.covariance[0]) for one in (after(), after(blurred), after(part), after(whole), first)]
    assert left == sorted(left, reverse=True)


@pytest.mark.parametrize("bed", [np.arange(6), np.zeros(6, dtype=np.int64)])
def test_runs_that_show_no_bed_are_refused(bed: np.ndarray) -> None:
    with pytest.raises(ValueError, match="no bed of the emulator has two runs with outputs"):
        BedEffect.of_groups(np.ones((6, 1)), np.ones(6), bed)
