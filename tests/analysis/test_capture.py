"""The chance of capture, learnt from runs."""

import numpy as np
import pytest

from lithobrake.analysis import CaptureModel, sample_inputs
from lithobrake.chaos import LogUniform, Uniform

INPUTS = {"young_modulus": LogUniform(1e6, 1e8), "restitution": Uniform(0.2, 0.9)}


def test_nobody_or_everybody_captured_needs_no_fit() -> None:
    x = sample_inputs(INPUTS, 10, seed=1)
    assert CaptureModel(INPUTS, x, np.zeros(10, bool)).probability(x).tolist() == [0.0] * 10
    assert CaptureModel(INPUTS, x, np.ones(10, bool)).probability(x).tolist() == [1.0] * 10


def test_a_boundary_in_one_input_is_found_and_the_share_is_right() -> None:
    runs = sample_inputs(INPUTS, 120, seed=1)
    truth = sample_inputs(INPUTS, 20_000, seed=2)
    model = CaptureModel(INPUTS, runs, runs[:, 1] < 0.4)
    guess = model.probability(truth)
    captured = truth[:, 1] < 0.4
    assert guess.mean() == pytest.approx(captured.mean(), abs=0.05)
    assert ((guess > 0.5) == captured).mean() > 0.93


def test_no_runs_are_refused() -> None:
    with pytest.raises(ValueError, match="one outcome for each"):
        CaptureModel(INPUTS, np.empty((0, 2)), np.empty(0, bool))
