"""Mean law, its indices and the test of inputs, against laws that are known."""

import numpy as np
import pytest

from lithobrake import emulator
from lithobrake.chaos import Normal, Uniform, sobol_sequence
from lithobrake.emulator.mean_law import found_inputs

INPUTS = {"a": Uniform(0.0, 2.0), "b": Normal(0.0, 1.0), "c": Uniform(-1.0, 1.0)}


def fitted(slope: float, noise: float, count: int, seed: int) -> emulator.Emulator:
    """An emulator of y = 1 + slope (a - 1 + b / 3 + b (a - 1)) + noise."""
    rng = np.random.default_rng(seed)
    x = sobol_sequence(INPUTS, count, seed=seed)
    law = 1.0 + slope * (x[:, 0] - 1.0 + x[:, 1] / 3.0 + x[:, 1] * (x[:, 0] - 1.0))
    return emulator.fit(INPUTS, x, law + noise * rng.standard_normal(count))


def test_indices_are_those_of_the_polynomial() -> None:
    found = fitted(slope=1.0, noise=0.0, count=200, seed=0).mean_law()
    # Variances of a, b / 3 and their product: 1/3, 1/9 and 1/3.
    assert found.mean[0] == pytest.approx(1.0, abs=1e-9)
    assert found.variance[0] == pytest.approx(7.0 / 9.0, rel=1e-6)
    np.testing.assert_allclose(found.sobol_first[:, 0], [3.0 / 7.0, 1.0 / 7.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(found.sobol_total[:, 0], [6.0 / 7.0, 4.0 / 7.0, 0.0], atol=1e-6)


@pytest.mark.parametrize("explained", [0.1, 0.3])
def test_the_share_of_the_inputs_is_freed_of_noise(explained: float) -> None:
    noise = np.sqrt(7.0 / 9.0 * (1.0 / explained - 1.0))
    shares = [fitted(1.0, noise, 240, seed).mean_law().share[0] for seed in range(10)]
    # Ten studies with a standard deviation of about 0.05 each.
    assert abs(np.mean(shares) - explained) < 2.0 * 0.05 / np.sqrt(10.0)


def test_inputs_are_found_where_they_count() -> None:
    assert fitted(slope=1.0, noise=1.0, count=200, seed=1).found_inputs() == {"a": True, "b": True, "c": False}


def test_without_effects_hardly_any_study_finds_one() -> None:
    # 90 % of studies find none; of 20, with probability 0.989, no more than 5 do. The test needs no emulator.
    found = []
    for seed in range(20):
        y = np.random.default_rng(seed).standard_normal((100, 1))
        found.append(found_inputs(INPUTS, sobol_sequence(INPUTS, 100, seed=seed), y, 0.9, seed=0).any())
    assert sum(found) <= 5


def test_a_level_must_be_a_probability() -> None:
    with pytest.raises(ValueError, match=r"level is 90"):
        fitted(1.0, 1.0, 60, 0).found_inputs(level=90)
