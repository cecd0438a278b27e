"""The face of an emulator: what it is given, what it draws, what it refuses, its file; and the laws of one output."""

import json
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import integrate, stats

from lithobrake import emulator
from lithobrake.chaos import Uniform
from lithobrake.emulator import latent_variable
from lithobrake.emulator.latent_variable import NOISE_SHARES, LatentProblem, latent_terms, nodes_of

from ..pipeline.few_terms import few_terms
from ..quick_studies import quick_studies

INPUTS = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}
COUNT = 120


def runs(seed: int = 0) -> dict[str, Any]:
    """Arguments of `fit`: a speed below 1 + a, a spin, the run's number as a rider; one run in eight has stopped."""
    rng = np.random.default_rng(seed)
    x = rng.random((COUNT, 2))
    limit = 1.0 + x[:, 0]
    speed = limit / (1.0 + np.exp(-(2.0 * x[:, 1] - 1.0 + rng.gamma(2.0, 0.4, COUNT))))
    y = np.column_stack([speed, rng.exponential(size=COUNT), np.arange(COUNT)])
    outcome = np.where(rng.random(COUNT) < 0.125, "stopped", "left")
    y[outcome == "stopped"] = np.nan
    upper = np.column_stack([limit, np.full((COUNT, 2), np.inf)])
    return {
        "x": x, "y": y, "groups": np.arange(COUNT) % 12, "outcome": outcome, "lower": [0.0, 0.0, -np.inf],
        "upper": upper, "riders": [2], "output_names": ("speed", "spin", "run"),
    }  # fmt: skip


@cache
def fitted() -> emulator.Emulator:
    with quick_studies(), few_terms():
        return emulator.fit(INPUTS, **runs())


X = np.random.default_rng(5).random((40, 2))
UPPER = np.column_stack([1.0 + X[:, 0], np.full((40, 2), np.inf)])


def test_draws_have_their_shape_and_come_again() -> None:
    first, again = (fitted().sample(X, 100, seed=3, upper=UPPER) for _ in range(2))
    assert first.shape == (40, 100, 3)
    np.testing.assert_array_equal(first, again)
    assert (fitted().sample(X, 100, seed=4, upper=UPPER) != first).any()
    assert fitted().sample(X[:0], 5, upper=UPPER[:0]).shape == (0, 5, 3)


def test_outputs_are_there_where_the_outcome_has_them() -> None:
    draws = fitted().draw(X, 500, upper=UPPER)
    stopped = draws.outcome == fitted().outcome_names.index("stopped")
    assert np.isnan(draws.y[stopped]).all()
    assert not np.isnan(draws.y[~stopped]).any()
    assert (draws.row[stopped] == -1).all()
    chances = fitted().outcome_probability(X)[:, fitted().outcome_names.index("stopped")]
    # Five standard deviations of 20 000 draws.
    assert abs(stopped.mean() - chances.mean()) < 5.0 * np.sqrt(0.125 * 0.875 / stopped.size)


def test_it_shows_itself_in_a_notebook() -> None:
    shown = fitted()._repr_html_()
    assert fitted().statement in shown
    stopped = int((runs()["outcome"] == "stopped").sum())
    assert f"<td>stopped</td><td>{stopped}</td>" in shown
    skill, covered = fitted().scores.crps_skill[0], fitted().scores.band_90[0]
    assert f"<td>speed</td><td>{skill:.4g}</td><td>{covered:.4g}</td>" in shown


def test_riders_come_unchanged_with_their_row() -> None:
    draws = fitted().draw(X, 200, upper=UPPER)
    there = draws.row >= 0
    np.testing.assert_array_equal(draws.y[there][:, 2], draws.row[there])


def test_no_draw_leaves_bounds_that_follow_the_inputs() -> None:
    speed, spin = np.moveaxis(fitted().sample(X, 25_000, upper=UPPER)[:, :, :2], 2, 0)
    assert np.nanmin(speed) > 0.0
    assert (np.nanmax(speed, axis=1) < UPPER[:, 0]).all()
    assert np.nanmin(spin) > 0.0


def test_bounds_at_new_inputs_are_asked_for_only_where_they_differed() -> None:
    with pytest.raises(ValueError, match=r"upper is missing"):
        fitted().sample(X, 1)
    with pytest.raises(ValueError, match=r"upper must be finite for the same outputs"):
        fitted().sample(X, 1, upper=2.0)


def test_a_law_is_followed_and_said() -> None:
    medians = np.nanmedian(
        fitted().sample([[0.5, 0.1], [0.5, 0.9]], 4000, upper=[1.5, np.inf, np.inf])[:, :, 0], axis=1
    )
    assert medians[1] > medians[0] + 0.2
    assert fitted().follows_inputs
    assert "improve the energy score" in fitted().statement


def test_without_a_law_draws_are_runs() -> None:
    rng = np.random.default_rng(1)
    x, y = rng.random((150, 2)), rng.standard_normal(150)
    with quick_studies():
        model = emulator.fit(INPUTS, x, y)
    assert not model.follows_inputs
    assert "resampling the 150 runs" in model.statement
    drawn = model.sample([[0.1, 0.1], [0.9, 0.9]], 20_000)
    assert abs(drawn[0].mean() - drawn[1].mean()) < 5.0 * np.sqrt(2.0 / 20_000)
    assert abs(drawn.std() - y.std()) < 0.02


def test_a_gain_within_its_standard_error_is_no_law() -> None:
    """Chosen without the runs that it is scored on, a law is 4.5 +- 4.0 % better on the other runs."""
    models = []
    for seed in (3, 5):
        rng = np.random.default_rng(seed)
        x = rng.random((60, 2))
        y = 0.35 * x[:, 0] + 0.5 * rng.standard_normal(60)
        models.append(emulator.fit(INPUTS, x, y, groups=np.arange(60) // 5, form="rows"))
    luck, law = models
    assert (luck.follows_inputs, luck.scores.gain, luck.scores.gain_error) == (False, 0.0, 0.0)
    assert "The inputs do not improve the prediction" in luck.statement_on("beds")
    assert law.follows_inputs
    assert law.scores.gain > law.scores.gain_error > 0.0
    assert "improve the energy score by 4.5 % (standard error 4.0 %)" in law.statement


def test_refits_differ_by_whole_groups() -> None:
    refits = fitted().refits(30, seed=2)
    for refit in refits:
        by_group = refit.weights.reshape(-1, 12)
        assert (by_group == by_group[0]).all()
        assert refit.weights.sum() == COUNT
    assert 0.0 < np.std([refit.law.location[2, 0] for refit in refits]) < abs(fitted().law.location[2, 0])
    again = fitted().refits(30, seed=2)[-1]
    np.testing.assert_array_equal(again.sample(X, 3, upper=UPPER), refits[-1].sample(X, 3, upper=UPPER))


def test_a_refit_with_weights_of_one_is_the_fit() -> None:
    same = fitted().reweighted(np.ones(COUNT))
    np.testing.assert_array_equal(same.sample(X, 10, upper=UPPER), fitted().sample(X, 10, upper=UPPER))


def test_an_output_that_is_always_the_same_stays_so() -> None:
    model = emulator.fit(INPUTS, np.random.default_rng(0).random((30, 2)), np.full(30, 7.0))
    np.testing.assert_allclose(model.sample(X, 5), 7.0, rtol=1e-12)


@pytest.mark.parametrize(("weights", "words"), [
    (-np.ones(COUNT), "at least 0"),
    (np.full(COUNT, np.nan), "finite"),
    (np.ones(3), r"weights have shape \(3,\), but must be \[120\]"),
    (np.zeros(COUNT), "weights count 0 runs"),
    (np.full(COUNT, 1.0 / COUNT), "how often each run counts"),
    (np.ma.masked_array(np.ones(COUNT), mask=np.arange(COUNT) < 3), "3 masked values"),
    (["a"] * COUNT, "array of real numbers"),
])  # fmt: skip
def test_weights_that_count_no_runs_are_refused(weights: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        fitted().reweighted(weights)


def test_a_seed_that_is_none_is_refused() -> None:
    for call in (fitted().refits, lambda count, seed: fitted().sample(X, count, seed, upper=UPPER)):
        with pytest.raises(ValueError, match="seed is 'x', but must be a whole number"):
            call(2, "x")  # type: ignore[arg-type]


def test_masked_outputs_are_runs_without_outputs() -> None:
    x, y, hidden = runs()["x"], np.linspace(0.0, 1.0, COUNT), np.arange(COUNT) % 6 == 0
    with quick_studies():
        model = emulator.fit(INPUTS, x, np.ma.masked_array(np.where(hidden, 1e3, y), mask=hidden), form="rows")
    assert model.runs.has_outputs.tolist() == (~hidden).tolist()
    assert np.nanmax(model.sample(X, 50)) < 5.0


@pytest.mark.parametrize("bounds", [(-1e308, 1e308), (-1e90, 1e90), (-1e20, np.inf)])
def test_bounds_that_swallow_the_outputs_are_refused(bounds: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match="so far from its values"):
        emulator.fit(INPUTS, runs()["x"], np.linspace(0.0, 1.0, COUNT), lower=bounds[0], upper=bounds[1])


@pytest.mark.parametrize(("factor", "words"), [(1e300, "larger unit"), (1e-200, "smaller unit")])
def test_outputs_whose_squares_are_no_numbers_are_refused(factor: float, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        emulator.fit(INPUTS, runs()["x"], np.linspace(0.0, factor, COUNT))


@pytest.mark.parametrize(("change", "words"), [
    ({"x": np.ma.masked_array(runs()["x"], mask=runs()["x"] > 0.99)}, "x has .* masked values"),
    ({"groups": np.ma.masked_array(np.arange(COUNT), mask=np.arange(COUNT) < 2)}, "groups hold NaN or infinity, or"),
    ({"groups": np.zeros(COUNT)}, "groups hold one group"),
    ({"groups": np.full(COUNT, np.nan)}, "groups hold NaN or infinity"),
    ({"groups": np.zeros(3)}, "groups has shape"),
    ({"y": np.zeros((3, 3))}, "y has shape"),
    ({"outcome": np.full(COUNT, "left")}, "one outcome must have outputs in all its runs"),
    ({"outcomes": ("left", "lost")}, "outcome holds 'stopped'"),
    ({"upper": [0.5, np.inf, np.inf]}, "speed is"),
    ({"upper": np.ones((2, 2))}, "upper has shape"),
    ({"lower": 5.0, "upper": 1.0}, "lower must be less than upper"),
    ({"riders": ["mass"]}, "riders hold 'mass'"),
    ({"riders": [0, 1, 2]}, "all outputs are riders"),
    ({"output_names": ("speed", "spin")}, "output_names are"),
    ({"x": np.full((COUNT, 2), 2.0)}, "120 of 120 points outside"),
])  # fmt: skip
def test_what_does_not_fit_together_is_refused_in_a_sentence(change: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        emulator.fit(INPUTS, **{**runs(), **change})


def test_too_few_outputs_are_refused() -> None:
    y = np.full(COUNT, np.nan)
    y[:5] = np.arange(5)
    with pytest.raises(ValueError, match="5 runs have outputs"):
        emulator.fit(INPUTS, runs()["x"], y)


def test_part_of_a_row_missing_is_refused() -> None:
    y = runs()["y"]
    y[0, 0] = np.nan
    y[0, 1] = 1.0
    with pytest.raises(ValueError, match="each row of y"):
        emulator.fit(INPUTS, runs()["x"], y)


STORED_INPUTS = {"a": Uniform(0.0, 1.0), "b": Uniform(-1.0, 1.0)}


@cache
def stored_emulator(bounds_follow_inputs: bool = False) -> emulator.Emulator:
    """An emulator with all there is: bounds, a rider, an outcome without outputs and one that never was."""
    rng = np.random.default_rng(0)
    x = np.column_stack([rng.random(90), rng.uniform(-1.0, 1.0, 90)])
    limit = 1.0 + x[:, 0] if bounds_follow_inputs else np.full(90, 2.0)
    speed = limit / (1.0 + np.exp(-(x[:, 0] + 0.5 * rng.standard_normal(90))))
    y = np.column_stack([speed, rng.normal(size=90), rng.integers(5, size=90)])
    outcome = np.where(rng.random(90) < 0.1, "stuck", "free")
    y[outcome == "stuck"] = np.nan
    upper = np.column_stack([limit, np.full((90, 2), np.inf)])
    with quick_studies(), few_terms():
        return emulator.fit(STORED_INPUTS, x, y, groups=np.arange(90) % 9, outcome=outcome,
            outcomes=("free", "stuck", "lost"), lower=[0.0, -np.inf, -np.inf], upper=upper, riders=("label",),
            output_names=("speed", "spin", "label"))  # fmt: skip


@pytest.mark.parametrize("bounds_follow_inputs", [False, True])
def test_a_saved_emulator_comes_back_bit_for_bit(tmp_path: Path, bounds_follow_inputs: bool) -> None:
    model = stored_emulator(bounds_follow_inputs)
    model.save(tmp_path / "model.json")
    again = emulator.load(tmp_path / "model.json")
    x, upper = model.runs.x[:20], np.full((20, 3), [2.5, np.inf, np.inf]) if bounds_follow_inputs else None
    np.testing.assert_array_equal(model.sample(x, 50, seed=3, upper=upper), again.sample(x, 50, seed=3, upper=upper))
    np.testing.assert_array_equal(model.outcome_probability(x), again.outcome_probability(x))
    first, second = model.refits(2, seed=1)[1], again.refits(2, seed=1)[1]
    np.testing.assert_array_equal(first.sample(x, 5, upper=upper), second.sample(x, 5, upper=upper))
    assert again.statement == model.statement
    assert again.found_inputs() == model.found_inputs()
    again.save(tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == (tmp_path / "model.json").read_bytes()


def test_the_file_is_plain_json_that_says_what_it_is(tmp_path: Path) -> None:
    stored_emulator().save(tmp_path / "model.json")

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    content = json.loads((tmp_path / "model.json").read_text(), parse_constant=refuse)
    assert (content["format"], content["format_version"]) == ("lithobrake emulator", 1)
    assert (content["output_names"], content["upper"]) == (["speed", "spin", "label"], [[2.0, None, None]])


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


def crossing(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Two branches that cross in the middle, each with its own scatter."""
    return 2.0 * x[:, 0] * np.sign(z) + 0.3 * stats.norm.ppf(np.modf(2.0 * stats.norm.cdf(z))[0])


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


FORM: dict[str, Any] = {"form": "expansion"}
# Arguments of the fits of models that several tests look at; the last draws rows.
FITS: dict[str, tuple[Any, Any, dict[str, Any]]] = {
    "line": (ONE_INPUT, runs_of(ONE_INPUT, line), FORM),
    "bounded": (ONE_INPUT, bounded_runs(), {"lower": 0.0, "upper": 0.4, **FORM}),
    "positive": (MARKET, runs_of(MARKET, price), {"lower": 0.0, **FORM}),
    "branching": (ONE_INPUT, runs_of(ONE_INPUT, branching), FORM),
    "crossing": (ONE_INPUT, runs_of(ONE_INPUT, crossing), {}),
    "rows": (ONE_INPUT, bounded_runs(1), {"lower": 0.0, "upper": 0.4, "form": "rows"}),
}
POINTS = {name: np.atleast_2d([0.3] if name != "positive" else [0.05, 0.6]) for name in FITS}


@cache
def expand(name: str) -> emulator.Emulator:
    inputs, runs, given = FITS[name]
    with quick_studies(), few_terms(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(latent_variable, "FOLDS", 2)
        # One degree above those of the laws.
        patch.setattr(latent_variable, "HIGHEST_DEGREE", 2)
        return emulator.fit(inputs, *runs, **given)


@pytest.mark.parametrize("place", [-0.8, 0.0, 0.8])
def test_a_law_of_its_own_class_is_found(place: float) -> None:
    spread = 0.5 + 0.2 * place
    # Of a law that is a line over x, the standard error at x in units of the spread; four of them are allowed.
    error = 4.0 * spread * np.sqrt((1.0 + 3.0 * place**2) / RUNS)
    draws, law = expand("line").sample([[place]], 50_000)[0, :, 0], expand("line").output_law([[place]])
    assert abs(law.mean[0] - (1.0 + place)) < error
    assert abs(draws.std() - spread) < error / np.sqrt(2.0)
    for level in (0.05, 0.5, 0.95):
        exact = stats.norm.ppf(level, 1.0 + place, spread)
        of_quantile = np.sqrt(level * (1.0 - level)) / stats.norm.pdf(stats.norm.ppf(level))
        assert abs(law.quantile([level])[0, 0] - exact) < error * of_quantile


@pytest.mark.parametrize(
    ("name", "law", "places"),
    [("positive", price, [[0.05, 0.4], [0.05, 0.6], [0.05, 0.8]]), ("branching", branching, [[-0.8], [0.0], [0.8]])],
)
def test_it_is_nearer_than_a_normal_with_the_right_mean_and_spread(name: str, law: Any, places: Any) -> None:
    levels = (np.arange(2000) + 0.5) / 2000
    errors, errors_of_normal = [], []
    for place in np.array(places):
        many = law(np.tile(place, (20_000, 1)), stats.norm.ppf((np.arange(20_000) + 0.5) / 20_000))
        exact = np.quantile(many, levels)
        normal = stats.norm.ppf(levels, many.mean(), many.std())
        errors.append(((expand(name).output_law([place]).quantile(levels)[0] - exact) ** 2).mean() / many.var())
        errors_of_normal.append(((normal - exact) ** 2).mean() / many.var())
    assert np.mean(errors) < np.mean(errors_of_normal)


@pytest.mark.parametrize("name", FITS)
def test_density_quantiles_and_draws_are_of_one_law(name: str) -> None:
    model, law = expand(name), expand(name).output_law(POINTS[name])
    low, high = law.quantile([1e-9, 1.0 - 1e-9])[0]
    y = np.linspace(low, high, 20_001)
    density = law.density(y)[0]
    assert integrate.trapezoid(density, y) == pytest.approx(1.0, abs=1e-5)
    assert integrate.trapezoid(y * density, y) == pytest.approx(law.mean[0], rel=1e-4)
    levels = [0.001, 0.3, 0.5, 0.99]
    np.testing.assert_allclose(law.cdf(law.quantile(levels)), [levels], rtol=1e-8)
    assert stats.kstest(model.sample(POINTS[name], 4000, seed=2)[0, :, 0], lambda y: law.cdf(y)[0]).pvalue > 0.01


@pytest.mark.parametrize("name", ["bounded", "branching"])
def test_the_density_of_an_observed_run_is_that_of_the_law(name: str) -> None:
    model, x = expand(name), POINTS[name]
    y = model.sample(x, 1)[0, 0, 0]
    found = model.log_density({"y0": y}, x)[0]
    assert found == pytest.approx(np.log(model.output_law(x).density([y])[0, 0]), rel=1e-9)
    grid = np.linspace(y - 0.008, y + 0.008, 801)
    blurred = stats.norm.pdf(y, grid, 1e-3)
    # An error of a thousandth is so small that the slope of the coordinate is the same all over it.
    exact = integrate.trapezoid(blurred * model.output_law(x).density(grid)[0], grid)
    assert model.log_density({"y0": y}, x, errors={"y0": 1e-3})[0] == pytest.approx(np.log(exact), abs=0.02)


def test_two_branches_are_two_peaks() -> None:
    density = expand("branching").output_law([[0.8]]).density([-1.9, 0.0, 1.9])[0]
    assert density[1] < 0.5 * min(density[0], density[2])


def test_bounds_are_never_crossed() -> None:
    bounded, corners = expand("bounded"), [[-1.0], [1.0]]
    for values in (bounded.sample(corners, 50_000), bounded.output_law(corners).quantile([1e-15, 1.0 - 1e-15])):
        assert 0.0 < values.min() < values.max() < 0.4
    assert expand("positive").sample([[0.0, 0.9]], 50_000).min() > 0.0
    law = bounded.output_law([[0.0]])
    np.testing.assert_array_equal(law.density([-1.0, 0.0, 0.4, 9.0]), np.zeros((1, 4)))
    np.testing.assert_allclose(law.cdf([-1, 0.0, 0.4, 9.0]), [[0.0, 0.0, 1.0, 1.0]], rtol=1e-14)
    assert law.density([1e-310]) == 0.0


@pytest.mark.parametrize(("latent", "odds"), [("normal", 0), ("branches", 1)])
def test_the_gradient_is_that_of_the_loss(latent: str, odds: int) -> None:
    problem = LatentProblem.of_runs(
        expand("positive").runs, latent_terms(MARKET, 2, latent, odds), np.random.default_rng(1).random(RUNS)
    )
    at, step = 0.3 * np.random.default_rng(0).standard_normal(problem.factors.shape[1]), 1e-5
    differences = [
        (problem.loss(at + step * one, 0.4)[0] - problem.loss(at - step * one, 0.4)[0]) / (2.0 * step)
        for one in np.eye(len(at))
    ]
    # Rounding of the loss over the step, and the third derivative times its square.
    np.testing.assert_allclose(problem.loss(at, 0.4)[1], differences, atol=1e-8)


def test_nodes_are_as_fine_as_the_noise_asks_for() -> None:
    problem = LatentProblem.of_runs(expand("positive").runs, latent_terms(MARKET, 2, "normal"), np.ones(RUNS))
    for share, (noise, parameters) in zip(NOISE_SHARES, problem.path(NOISE_SHARES), strict=True):
        loss = problem.loss(parameters, noise, nodes_of(share))[0]
        # A likelihood of so much less, over all runs, would not decide between two degrees.
        assert loss == pytest.approx(problem.loss(parameters, noise, 400)[0], abs=0.5 / RUNS), share


def test_the_form_of_the_better_score_is_chosen_and_said() -> None:
    crossing = expand("crossing")
    assert crossing.expansion is not None
    assert crossing.expansion.terms.latent == "branches"
    assert "A stochastic expansion of degree" in crossing.statement
    assert crossing.scores.energy < crossing.scores.energy_of_rows
    assert 0.85 < crossing.scores.band_90[0] < 0.95
    assert (crossing.draw([[0.0]], 3).row == -1).all()
    assert (expand("rows").expansion, expand("rows").draw([[0.0]], 3).row.min() >= 0) == (None, True)


def test_whole_runs_are_drawn_where_nearness_tells_most() -> None:
    """Below the middle two outputs are equal, above it opposite: no location or scale of one of them changes."""
    random, x = np.random.default_rng(0), np.random.default_rng(1).uniform(-1.0, 1.0, (200, 1))
    first = random.standard_normal(200)
    y = np.column_stack([first, np.where(x[:, 0] < 0.0, first, -first) + 0.1 * random.standard_normal(200)])
    with quick_studies():
        model = emulator.fit(ONE_INPUT, x, y)
    assert "Samples are whole runs, the nearer the likelier" in model.statement
    drawn = model.draw([[-0.8], [0.8]], 2000)
    correlations = [np.corrcoef(one.T)[0, 1] for one in drawn.y]
    assert correlations[0] > 0.8 > -0.8 > correlations[1]
    assert drawn.row.min() >= 0


def test_refits_scatter_as_the_mean_is_uncertain() -> None:
    line = expand("line")
    means = [refit.output_law([[0.0]]).mean[0] for refit in line.refits(40)]
    # The standard error of 40 refits' own standard deviation is 11 %.
    assert np.std(means) == pytest.approx(0.5 / np.sqrt(RUNS), rel=0.35)
    again = line.reweighted(np.ones(RUNS))
    np.testing.assert_allclose(again.output_law([[0.0]]).mean, line.output_law([[0.0]]).mean, atol=1e-3)


@pytest.mark.parametrize("name", FITS)
def test_a_saved_law_of_one_output_comes_back_bit_for_bit(tmp_path: Path, name: str) -> None:
    model = expand(name)
    model.save(tmp_path / "law.json")
    again = emulator.load(tmp_path / "law.json")
    np.testing.assert_array_equal(again.sample(POINTS[name], 50, seed=3), model.sample(POINTS[name], 50, seed=3))
    quantiles = [one.output_law(POINTS[name]).quantile(0.9) for one in (again, model)]
    np.testing.assert_array_equal(*quantiles)
    assert again.statement == model.statement


@pytest.mark.parametrize(("make", "key", "value"), [
    (stored_emulator, "location", [[0.0]]), (stored_emulator, "rows", []), (stored_emulator, "outcome", [7] * 90),
    (stored_emulator, "riders", ["mass"]), (stored_emulator, "multi_indices", [[0, 1]]),
    *((partial(expand, "line"), *damage) for damage in (
        ("latent", "gamma"), ("noise", 0.0), ("parameters", [1.0]), ("multi_indices", [[0, 9]]),
    )),
])  # fmt: skip
def test_a_damaged_file_is_refused(tmp_path: Path, make: Any, key: str, value: object) -> None:
    path = tmp_path / "model.json"
    make().save(path)
    content = json.loads(path.read_text())
    (content if content["expansion"] is None else content["expansion"])[key] = value
    path.write_text(json.dumps(content))
    with pytest.raises(ValueError, match=r"model\.json"):
        emulator.load(path)


@pytest.mark.parametrize(("change", "words"), [
    ({"form": "gamma"}, "form is 'gamma'; allowed: rows, expansion, or None to choose"),
    ({"y": np.zeros((RUNS, 2))}, "form is 'expansion', which has one output and no riders, but outputs are y0, y1"),
    ({"y": np.full(RUNS, 7.0)}, "y does not scatter"),
])  # fmt: skip
def test_what_has_no_form_is_refused_in_a_sentence(change: dict[str, Any], words: str) -> None:
    x, y = runs_of(ONE_INPUT, line)
    with pytest.raises(ValueError, match=words):
        emulator.fit(ONE_INPUT, **{"x": x, "y": y, "form": "expansion", **change})


def test_questions_that_have_no_answer_are_refused() -> None:
    law = expand("line").output_law([[0.0], [0.1]])
    with pytest.raises(ValueError, match=r"levels are \[0.5, 1.0\]"):
        law.quantile([0.5, 1.0])
    with pytest.raises(ValueError, match=r"y has shape \(3, 1\), but must be \[value_count\] or \[2, value_count\]"):
        law.density([[1.0], [2.0], [3.0]])
    with pytest.raises(ValueError, match="1 of 1 points outside"):
        expand("line").output_law([[2.0]])
    with pytest.raises(ValueError, match="output is None; allowed: speed, spin"):
        stored_emulator().output_law([[0.5, 0.0]])
    for ask in (lambda: expand("line").kernels, lambda: expand("line").bed_effect):
        with pytest.raises(ValueError, match="has no rows to draw from: give fit form='rows'"):
            ask()
    with pytest.raises(ValueError, match="has no rows to draw from"):
        emulator.law_tables([expand("line")])
    for weights in (np.ones(3), np.zeros(RUNS), np.full(RUNS, -1.0), np.full(RUNS, np.nan)):
        with pytest.raises(ValueError, match=r"weights (have shape|count 0 runs)"):
            expand("line").reweighted(weights)
