"""Stochastic expansions: laws that are known come back, densities and draws are of one law, bad input is refused."""

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import integrate, stats

from lithobrake import emulator
from lithobrake.chaos import Uniform
from lithobrake.emulator.latent_likelihood import problem_of
from lithobrake.emulator.latent_terms import latent_terms

RUNS = 300
ONE_INPUT = {"x": Uniform(-1.0, 1.0)}
# Volatilities above those of the published example, where a normal is hardly wrong.
MARKET = {"drift": Uniform(0.0, 0.1), "volatility": Uniform(0.2, 0.9)}


def line(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """A law of the model's own class: mean 1 + x, standard deviation 0.5 + 0.2 x."""
    return 1.0 + x[:, 0] + (0.5 + 0.2 * x[:, 0]) * z


def branching(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Two branches, the nearer to each other the smaller x, each with its own scatter."""
    return (1.5 + 0.5 * x[:, 0]) * np.sign(z) + 0.4 * stats.norm.ppf(np.modf(2.0 * stats.norm.cdf(z))[0])


def price(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Geometric Brownian motion after a unit of time. Source: [Zhu-2023] (first example)."""
    return np.exp(x[:, 0] - 0.5 * x[:, 1] ** 2 + x[:, 1] * z)


def runs_of(inputs: dict[str, Any], law: Any, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Runs x [RUNS, input_count], y [RUNS] of a law."""
    rng = np.random.default_rng(seed)
    x = np.column_stack([entry.ppf(rng.random(RUNS)) for entry in inputs.values()])
    return x, law(x, rng.standard_normal(RUNS))


def bounded_runs(seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Runs whose output lies between 0 and 0.4."""
    x, y = runs_of(ONE_INPUT, line, seed)
    return x, 0.4 / (1.0 + np.exp(-y))


CHOSEN: dict[str, Any] = {"degree": 1, "latent": "normal"}
# Arguments of the fits of models that several tests look at.
FITS: dict[str, tuple[Any, Any, dict[str, Any]]] = {
    "line": (ONE_INPUT, runs_of(ONE_INPUT, line), {}),
    "bounded": (ONE_INPUT, bounded_runs(), {"lower": 0.0, "upper": 0.4, **CHOSEN}),
    "positive": (MARKET, runs_of(MARKET, price), {"lower": 0.0, **CHOSEN}),
    "branching": (ONE_INPUT, runs_of(ONE_INPUT, branching), {}),
}
POINTS = {name: np.atleast_2d([0.3] if name != "positive" else [0.05, 0.6]) for name in FITS}


@cache
def fitted(name: str) -> emulator.StochasticExpansion:
    inputs, runs, given = FITS[name]
    return emulator.fit_stochastic_expansion(inputs, *runs, **given)


@pytest.mark.parametrize("place", [-0.8, 0.0, 0.8])
def test_a_law_of_its_own_class_is_found(place: float) -> None:
    spread = 0.5 + 0.2 * place
    # Of a law that is a line over x, the standard error at x in units of the spread; four of them are allowed.
    error = 4.0 * spread * np.sqrt((1.0 + 3.0 * place**2) / RUNS)
    draws = fitted("line").sample([[place]], 100_000)[0]
    assert abs(fitted("line").mean([[place]])[0] - (1.0 + place)) < error
    assert abs(draws.std() - spread) < error / np.sqrt(2.0)
    for level in (0.05, 0.5, 0.95):
        exact = stats.norm.ppf(level, 1.0 + place, spread)
        of_quantile = np.sqrt(level * (1.0 - level)) / stats.norm.pdf(stats.norm.ppf(level))
        assert abs(fitted("line").quantile([[place]], [level])[0, 0] - exact) < error * of_quantile


@pytest.mark.parametrize(
    ("inputs", "law", "places"),
    [(MARKET, price, [[0.05, 0.4], [0.05, 0.6], [0.05, 0.8]]), (ONE_INPUT, branching, [[-0.8], [0.0], [0.8]])],
)
def test_it_is_nearer_than_a_normal_with_the_right_mean_and_spread(inputs: Any, law: Any, places: Any) -> None:
    levels = (np.arange(2000) + 0.5) / 2000
    model = emulator.fit_stochastic_expansion(inputs, *runs_of(inputs, law, seed=1))
    errors, errors_of_normal = [], []
    for place in np.array(places):
        many = law(np.tile(place, (200_000, 1)), stats.norm.ppf((np.arange(200_000) + 0.5) / 200_000))
        exact = np.quantile(many, levels)
        normal = stats.norm.ppf(levels, many.mean(), many.std())
        errors.append(((model.quantile([place], levels)[0] - exact) ** 2).mean() / many.var())
        errors_of_normal.append(((normal - exact) ** 2).mean() / many.var())
    assert np.mean(errors) < np.mean(errors_of_normal)


@pytest.mark.parametrize("name", FITS)
def test_density_quantiles_and_draws_are_of_one_law(name: str) -> None:
    model, x = fitted(name), POINTS[name]
    low, high = model.quantile(x, [1e-9, 1.0 - 1e-9])[0]
    y = np.linspace(low, high, 20_001)
    density = model.density(x, y)[0]
    assert integrate.trapezoid(density, y) == pytest.approx(1.0, abs=1e-5)
    assert integrate.trapezoid(y * density, y) == pytest.approx(model.mean(x)[0], rel=1e-4)
    levels = [0.001, 0.3, 0.5, 0.99]
    np.testing.assert_allclose(model.cdf(x, model.quantile(x, levels)), [levels], rtol=1e-8)
    draws = model.sample(x, 4000, seed=2)[0]
    assert stats.kstest(draws, lambda values: model.cdf(x, values)[0]).pvalue > 0.01


@pytest.mark.parametrize("name", FITS)
def test_the_likelihood_is_that_of_the_density(name: str) -> None:
    model = fitted(name)
    densities = model.density(model.runs.x, model.runs.y)[:, 0]
    assert model.log_likelihood == pytest.approx(np.log(densities).sum(), rel=1e-9)


def test_two_branches_are_two_peaks() -> None:
    density = fitted("branching").density([[0.8]], [-1.9, 0.0, 1.9])[0]
    assert density[1] < 0.5 * min(density[0], density[2])


def test_bounds_are_never_crossed() -> None:
    corners = [[-1.0], [1.0]]
    draws, tails = fitted("bounded").sample(corners, 100_000), fitted("bounded").quantile(corners, [1e-15, 1.0 - 1e-15])
    for values in (draws, tails):
        assert 0.0 < values.min() < values.max() < 0.4
    assert fitted("positive").sample([[0.0, 0.9]], 100_000).min() > 0.0
    np.testing.assert_array_equal(fitted("bounded").density([[0.0]], [-1.0, 0.0, 0.4, 9.0]), np.zeros((1, 4)))
    np.testing.assert_allclose(fitted("bounded").cdf([[0.0]], [-1, 0.0, 0.4, 9.0]), [[0.0, 0.0, 1.0, 1.0]], rtol=1e-14)
    assert fitted("bounded").density([[0.0]], [1e-310]) == 0.0


def test_bounds_that_follow_the_inputs_are_asked_for() -> None:
    x, y = bounded_runs()
    limit = 0.4 + 0.1 * x
    model = emulator.fit_stochastic_expansion(ONE_INPUT, x, y * limit[:, 0] / 0.4, lower=0.0, upper=limit, **CHOSEN)
    np.testing.assert_allclose(
        model.quantile([[0.5]], [0.5], upper=0.45) / 0.45, fitted("bounded").quantile([[0.5]], 0.5) / 0.4
    )
    with pytest.raises(ValueError, match="upper is missing"):
        model.density([[0.5]], [0.1])


@pytest.mark.parametrize("latent", ["normal", "uniform"])
def test_the_gradient_is_that_of_the_loss(latent: str) -> None:
    problem = problem_of(
        fitted("positive").runs, latent_terms(MARKET, 2, latent), np.random.default_rng(1).random(RUNS)
    )
    at, step = 0.3 * np.random.default_rng(0).standard_normal(problem.factors.shape[1]), 1e-5
    differences = [
        (problem.loss(at + step * one, 0.4)[0] - problem.loss(at - step * one, 0.4)[0]) / (2.0 * step)
        for one in np.eye(len(at))
    ]
    # Rounding of the loss over the step, and the third derivative times its square.
    np.testing.assert_allclose(problem.loss(at, 0.4)[1], differences, atol=1e-8)


def test_degree_and_latent_variable_are_chosen_by_groups_left_out() -> None:
    x, _ = runs_of(ONE_INPUT, line)
    assert fitted("line").degree >= 1
    flat = np.random.default_rng(3).random(RUNS)
    tried = {
        (degree, latent): emulator.fit_stochastic_expansion(ONE_INPUT, x, flat, degree=degree, latent=latent).held_out
        for degree in (0, 1, 2, 3)
        for latent in ("normal", "uniform")
    }
    chosen = emulator.fit_stochastic_expansion(ONE_INPUT, x, flat)
    assert chosen.held_out == tried[chosen.degree, chosen.latent] == max(tried.values())


def test_of_degree_zero_are_no_inputs() -> None:
    model = emulator.fit_stochastic_expansion(ONE_INPUT, *runs_of(ONE_INPUT, line), degree=0, latent="normal")
    quantiles = model.quantile([[-1.0], [1.0]], [0.1, 0.9])
    np.testing.assert_array_equal(quantiles[0], quantiles[1])


def test_runs_without_an_output_are_left_out() -> None:
    x, y = runs_of(ONE_INPUT, line)
    there = np.arange(RUNS) % 7 != 3
    first = emulator.fit_stochastic_expansion(ONE_INPUT, x, np.where(there, y, np.nan), **CHOSEN)
    second = emulator.fit_stochastic_expansion(ONE_INPUT, x[there], y[there], **CHOSEN)
    np.testing.assert_array_equal(first.sample([[0.1]], 9), second.sample([[0.1]], 9))


def test_refits_scatter_as_the_mean_is_uncertain() -> None:
    means = [refit.mean([[0.0]])[0] for refit in fitted("line").refits(40)]
    # The standard error of 40 refits' own standard deviation is 11 %.
    assert np.std(means) == pytest.approx(0.5 / np.sqrt(RUNS), rel=0.35)
    np.testing.assert_allclose(
        fitted("line").reweighted(np.ones(RUNS)).mean([[0.0]]), fitted("line").mean([[0.0]]), atol=1e-3
    )


@pytest.mark.parametrize("name", FITS)
def test_a_saved_expansion_comes_back_bit_for_bit(tmp_path: Path, name: str) -> None:
    model = fitted(name)
    model.save(tmp_path / "law.json")
    again = emulator.load_stochastic_expansion(tmp_path / "law.json")
    np.testing.assert_array_equal(again.sample(POINTS[name], 50, seed=3), model.sample(POINTS[name], 50, seed=3))
    np.testing.assert_array_equal(again.quantile(POINTS[name], 0.9), model.quantile(POINTS[name], 0.9))
    assert (again.log_likelihood, again.held_out) == (model.log_likelihood, model.held_out)


@pytest.mark.parametrize(
    ("key", "value"),
    [("latent", "gamma"), ("noise", 0.0), ("coefficients", [1.0]), ("multi_indices", [[0, 9]]), ("riders", ["y"])],
)
def test_a_damaged_file_is_refused(tmp_path: Path, key: str, value: object) -> None:
    path = tmp_path / "law.json"
    fitted("line").save(path)
    path.write_text(json.dumps({**json.loads(path.read_text()), key: value}))
    with pytest.raises(ValueError, match=r"law\.json"):
        emulator.load_stochastic_expansion(path)


@pytest.mark.parametrize(("change", "words"), [
    ({"y": np.zeros((RUNS, 2))}, r"y has shape \(300, 2\), but must be \[run_count\]"),
    ({"y": np.full(RUNS, 7.0)}, "y does not scatter"),
    ({"y": np.zeros(3)}, "y has shape"),
    ({"lower": 1.0}, "y is"),
    ({"degree": 6}, "degree is 6, but must be a whole number from 0 to 5"),
    ({"degree": 1.5}, "degree is 1.5"),
    ({"latent": "gamma"}, "latent is 'gamma', but must be one of normal, uniform"),
    ({"groups": np.zeros(RUNS)}, "groups hold one group"),
    ({"x": np.full((RUNS, 1), 2.0)}, "300 of 300 points outside"),
])  # fmt: skip
def test_what_does_not_fit_together_is_refused_in_a_sentence(change: dict[str, Any], words: str) -> None:
    x, y = runs_of(ONE_INPUT, line)
    with pytest.raises(ValueError, match=words):
        emulator.fit_stochastic_expansion(ONE_INPUT, **{"x": x, "y": y, **change})


def test_a_degree_of_too_many_terms_is_refused() -> None:
    x, y = runs_of(ONE_INPUT, line)
    with pytest.raises(ValueError, match="degree is 3, which has 10 terms and needs 5 runs for each"):
        emulator.fit_stochastic_expansion(ONE_INPUT, x[:40], y[:40], degree=3)


def test_questions_that_have_no_answer_are_refused() -> None:
    with pytest.raises(ValueError, match=r"levels are \[0.5, 1.0\]"):
        fitted("line").quantile([[0.0]], [0.5, 1.0])
    with pytest.raises(ValueError, match=r"y has shape \(3, 1\), but must be \[value_count\] or \[2, value_count\]"):
        fitted("line").density([[0.0], [0.1]], [[1.0], [2.0], [3.0]])
    with pytest.raises(ValueError, match="1 of 1 points outside"):
        fitted("line").mean([[2.0]])
    for weights in (np.ones(3), np.zeros(RUNS), np.full(RUNS, -1.0), np.full(RUNS, np.nan)):
        with pytest.raises(ValueError, match=r"weights (have shape|count 0 runs)"):
            fitted("line").reweighted(weights)
    with pytest.raises(ValueError, match="count is 0"):
        fitted("line").sample([[0.0]], 0)
