"""What an emulator makes of laws that bend, branch or scatter as they like, against what they are."""

import numpy as np
import pytest
from scipy import special

from lithobrake import emulator
from lithobrake.chaos import Uniform, latin_hypercube

COUNT = 300


def inputs_of(count: int) -> dict[str, Uniform]:
    """So many inputs between -1 and 1."""
    return {f"x{k}": Uniform(-1.0, 1.0) for k in range(count)}


def test_the_odds_of_two_branches_are_followed() -> None:
    inputs, random = inputs_of(3), np.random.default_rng(0)
    x = latin_hypercube(inputs, COUNT, seed=0)
    upper = random.random(COUNT) < special.expit(3.0 * x[:, 0])
    model = emulator.fit(inputs, x, np.where(upper, 1.5, -1.5) + 0.3 * random.standard_normal(COUNT))
    places = np.array([-0.8, -0.3, 0.3, 0.8])
    drawn = model.sample(np.column_stack([places, np.zeros((4, 2))]), 4000)[:, :, 0]
    # Some forty runs lie as near as rows are drawn from: their odds are good to 0.08.
    np.testing.assert_allclose((drawn > 0.0).mean(axis=1), special.expit(3.0 * places), atol=0.16)
    # Little lies between the branches, which are ten deviations apart: rows of places nearby are shifted by the mean.
    assert (np.abs(drawn) < 0.5).mean() < 0.1


def test_a_bump_of_the_scatter_is_followed() -> None:
    inputs, random = inputs_of(3), np.random.default_rng(0)
    x = latin_hypercube(inputs, COUNT, seed=1)
    scale = 0.15 + np.exp(-((x[:, 0] / 0.3) ** 2))
    model = emulator.fit(inputs, x, scale * random.standard_normal(COUNT))
    near, far = model.sample([[0.0, 0.0, 0.0], [0.8, 0.0, 0.0]], 4000)[:, :, 0].std(axis=1)
    # 1.15 and 0.15; a logarithm that is linear makes both one.
    assert 0.85 < near < 1.5
    assert 0.10 < far < 0.25


def test_two_of_twelve_inputs_are_followed() -> None:
    inputs, random = inputs_of(12), np.random.default_rng(0)
    x, fresh = latin_hypercube(inputs, COUNT, seed=2), latin_hypercube(inputs, 200, seed=3)

    def law(points: np.ndarray) -> np.ndarray:
        return np.asarray(np.sin(2.5 * points[:, 0]) + 1.5 * points[:, 1] ** 2)

    model = emulator.fit(inputs, x, law(x) + 0.2 * random.standard_normal(COUNT))
    error = model.sample(fresh, 500)[:, :, 0].mean(axis=1) - law(fresh)
    # Ten terms that count leave 0.2 sqrt(10 / 300) = 0.04; of the square alone 0.45 would be left.
    assert np.sqrt(np.mean(error**2)) < 0.08


def test_a_smooth_solver_without_scatter_is_reproduced() -> None:
    inputs = inputs_of(3)
    x, fresh = latin_hypercube(inputs, COUNT, seed=4), latin_hypercube(inputs, 200, seed=5)

    def law(points: np.ndarray) -> np.ndarray:
        return np.asarray(np.sin(3.0 * points[:, 0]) + points[:, 1] ** 2 * points[:, 2])

    model = emulator.fit(inputs, x, law(x))
    drawn = model.sample(fresh, 50)[:, :, 0]
    assert np.sqrt(np.mean((drawn - law(fresh)[:, None]) ** 2)) < 1e-3 * law(fresh).std()


def test_branches_that_cross_are_as_near_as_a_published_expansion_makes_them() -> None:
    """The bimodal case of [Zhu-2023], 400 runs: the published expansion of degree 5 has 0.020 (0.010 to 0.038)."""
    inputs = {"x": Uniform(0.0, 1.0)}

    def drawn(x: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
        half = 0.8 * (5.0 * x - 2.5)
        branch = np.where(random.random((len(x), count)) < 0.4, half, -half)
        return np.asarray(4.0 * np.sin(np.pi * x) ** 2 + branch + 0.8 * random.standard_normal((len(x), count)))

    errors, points = [], latin_hypercube(inputs, 100, seed=9)
    truth, levels = drawn(points, 2000, np.random.default_rng(8)), (np.arange(500) + 0.5) / 500
    for seed in range(4):
        x = latin_hypercube(inputs, 400, seed=seed)
        model = emulator.fit(inputs, x, drawn(x, 1, np.random.default_rng(seed)))
        found = model.sample(points, 2000)[:, :, 0]
        gaps = np.quantile(found, levels, axis=1) - np.quantile(truth, levels, axis=1)
        errors.append(np.mean(gaps**2) / truth.var())
    assert np.median(errors) < 0.03
    assert max(errors) < 0.04


@pytest.mark.parametrize(("centre", "distant"), [(10.0, (0,)), (1.0, ())])
def test_a_bound_that_is_far_bends_nothing(centre: float, distant: tuple[int, ...]) -> None:
    """A normal law far from its bound takes no logarithm; a lognormal one near it does."""
    inputs, random = inputs_of(1), np.random.default_rng(0)
    x = latin_hypercube(inputs, 200, seed=6)
    noise = random.standard_normal(200)
    y = centre + x[:, 0] + noise if distant else np.exp(x[:, 0] + noise)
    model = emulator.fit(inputs, x, y, lower=0.0)
    assert model.runs.distant == distant
    assert (model.sample(x, 2000) > 0.0).all()


def test_an_emulator_does_not_lose_to_its_runs() -> None:
    """On laws without inputs that count, chosen laws hardly pass the gate, and those that do cost little."""
    inputs, passed = inputs_of(4), 0
    for seed in range(6):
        random = np.random.default_rng(seed)
        x = latin_hypercube(inputs, 100, seed=seed)
        passed += emulator.fit(inputs, x, random.gamma(2.0, size=100)).follows_inputs
    # By luck a gain is above its error in 16 of 100; more than two of six with probability 0.06.
    assert passed <= 2
