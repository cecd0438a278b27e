"""Random points of inputs."""

import numpy as np
import pytest

from lithobrake.analysis import sample_inputs
from lithobrake.chaos import Normal, Uniform


def test_another_input_or_a_larger_count_leaves_the_draws_as_they_are() -> None:
    one = sample_inputs({"a": Uniform(0, 1)}, 100, seed=3)
    two = sample_inputs({"b": Normal(0, 1), "a": Uniform(0, 1)}, 200, seed=3)
    assert np.array_equal(one[:, 0], two[:100, 1])


def test_points_follow_their_distributions_independently() -> None:
    x = sample_inputs({"a": Uniform(2, 4), "b": Normal(1, 0.5)}, 20_000, seed=4)
    assert x.mean(axis=0) == pytest.approx([3, 1], abs=0.02)
    assert x.std(axis=0) == pytest.approx([2 / np.sqrt(12), 0.5], abs=0.01)
    assert abs(np.corrcoef(x.T)[0, 1]) < 0.02


def test_another_seed_gives_other_points() -> None:
    assert not np.array_equal(sample_inputs({"a": Uniform(0, 1)}, 5, 1), sample_inputs({"a": Uniform(0, 1)}, 5, 2))
