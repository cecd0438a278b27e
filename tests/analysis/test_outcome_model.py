"""The chances of the outcomes, learnt from runs."""

import numpy as np
import pytest

from lithobrake.analysis import LEVEL, OutcomeModel, sample_inputs, unseen_limit, upper_limit
from lithobrake.chaos import LogUniform, Uniform

INPUTS = {"young_modulus": LogUniform(1e6, 1e8), "restitution": Uniform(0.2, 0.9)}
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


@pytest.mark.parametrize("count", [20, 60, 300])
def test_the_upper_limit_of_what_no_run_had(count: int) -> None:
    """With this probability one draw in twenty of so many runs has no event at all."""
    limit = upper_limit(count)
    assert (1.0 - limit) ** count == pytest.approx(0.05)
    assert limit == pytest.approx(3.0 / count, rel=0.1)
    assert upper_limit(0) == 1.0


def test_the_unit_of_what_no_run_had_is_the_bed() -> None:
    bed = np.repeat(["a", "b", "c"], 40)
    assert (1.0 - unseen_limit(bed)) ** 3 == pytest.approx(1.0 - LEVEL)
    assert unseen_limit([]) == 1.0


@pytest.mark.parametrize("bed", [None, "abc", 3, [np.nan, 1.0], [None, None], [[1, 2], [3, 4]]])
def test_what_is_no_label_for_each_run_has_no_limit(bed: object) -> None:
    with pytest.raises(ValueError, match=r"bed h(as shape|old)"):
        unseen_limit(bed)  # type: ignore[arg-type]


def test_more_units_than_a_float_counts_are_refused() -> None:
    with pytest.raises(ValueError, match="must be a whole number from 0 to 9007199254740992"):
        upper_limit(10**400)
