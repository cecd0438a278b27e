"""The default fit: known truths, published functions and a campaign as they are; honest estimates, recognised noise."""

import numpy as np
import pytest

from lithobrake.chaos import (
    Empirical,
    Exponential,
    LogNormal,
    LogUniform,
    Normal,
    Uniform,
    fit,
    joint_scatter,
    latin_hypercube,
    smolyak,
    sobol_sequence,
)
from lithobrake.chaos import sobol_sequence as sobol

FIVE = {f"x{k}": Uniform(0.0, 1.0) for k in range(5)}


def friedman(x):
    """Five inputs matter, whatever more there are do not. Source: Friedman, 1991, Eq 61."""
    return 10.0 * np.sin(np.pi * x[:, 0] * x[:, 1]) + 20.0 * (x[:, 2] - 0.5) ** 2 + 10.0 * x[:, 3] + 5.0 * x[:, 4]


def kinked(x):
    return np.minimum(0.3 + 0.7 * x[:, 0], 0.2 + 0.6 * x[:, 1] + 0.3 * x[:, 2]) * (1.0 - 0.4 * x[:, 3]) + 0.1 * x[:, 4]


def share(surrogate, truth):
    test = sobol(FIVE, 1000, seed=99)
    return surrogate.score(test, truth(test))["y"]["rrmse"]


@pytest.fixture(scope="module")
def paper():
    x = smolyak(FIVE, 3)
    return {f: share(fit(FIVE, x, f(x), degree=3, method="ols"), f) for f in (friedman, kinked)}


@pytest.mark.parametrize(("truth", "limit"), [(friedman, 1.0), (kinked, 0.7)])
def test_hundred_runs_beat_the_papers_241(paper, truth, limit):
    x = sobol(FIVE, 100, seed=1)
    surrogate = fit(FIVE, x, truth(x))
    error = share(surrogate, truth)
    assert error < limit * paper[truth]
    # The estimate is honest: neither flattering nor useless.
    assert 0.5 < surrogate.report["rrmse_estimate"][0] / error < 2.5
    # The challenger is reported beside it and does not win by more than a fifth.
    spread = np.std(truth(x))
    assert surrogate.report["rrmse_estimate"][0] <= 1.2 * surrogate.report["challenger"]["rmse_estimate"]["y"] / spread


def test_noise_is_recognised_and_not_chased():
    x = sobol(FIVE, 150, seed=2)
    spread = np.std(friedman(x))
    y = friedman(x) + 0.2 * spread * np.random.default_rng(5).normal(size=150)
    surrogate = fit(FIVE, x, y)
    assert surrogate.report["outputs"]["y"]["noise_std"] == pytest.approx(0.2 * spread, rel=0.35)
    assert share(surrogate, friedman) < 0.15
    answer = surrogate.runs_needed(0.05)["y"]
    assert answer["more_runs"] is None
    assert "no number of runs" in answer["sentence"]
    assert surrogate.runs_needed(0.9)["y"]["more_runs"] == 0
    assert surrogate.runs_needed(0.99 * answer["now"])["y"]["more_runs"] > 0
    with pytest.raises(ValueError, match="target"):
        surrogate.runs_needed(0.0)


def test_a_model_without_scatter_is_given_none_above_its_error():
    x = sobol(FIVE, 60, seed=4)
    entry = fit(FIVE, x, x[:, 0] - 2.0 * x[:, 1]).report["outputs"]["y"]
    assert 0.0 < entry["rmse_estimate"] < 1e-12
    assert (entry["noise_std"], entry["noise_from"]) == (entry["rmse_estimate"], "expected error, below the nugget")


def test_repeated_runs_give_the_scatter():
    x = np.repeat(sobol(FIVE, 60, seed=4), 3, axis=0)
    scatter = np.random.default_rng(1).normal(size=len(x))
    surrogate = fit(FIVE, x, np.column_stack([x[:, 0] + 0.1 * scatter, x[:, 1]]), degree=1)
    entries = list(surrogate.report["outputs"].values())
    assert (entries[0]["noise_std"], entries[1]["noise_std"]) == (pytest.approx(0.1, rel=0.15), 0.0)
    assert "120 degrees of freedom" in entries[0]["noise_from"]


@pytest.mark.parametrize("method", ["lars", "omp"])
def test_sparse_methods_find_a_sparse_polynomial(method):
    inputs = {"a": Normal(0.0, 1.0), "b": Uniform(-1.0, 1.0), "c": LogUniform(1.0, 10.0), "d": Exponential(1.0)}
    x = latin_hypercube(inputs, 60, seed=0)
    y = 1.0 + x[:, 0] * x[:, 1] + 0.3 * np.log(x[:, 2]) ** 3 + 0.2 * x[:, 3]
    surrogate = fit(inputs, x, y, method=method)
    test = latin_hypercube(inputs, 500, seed=1)
    truth = 1.0 + test[:, 0] * test[:, 1] + 0.3 * np.log(test[:, 2]) ** 3 + 0.2 * test[:, 3]
    assert surrogate.score(test, truth)["y"]["rrmse"] < 1e-6
    assert surrogate.term_count < 30


def test_selection_on_pure_noise_promises_nothing():
    x = sobol(FIVE, 80, seed=6)
    y = np.random.default_rng(2).normal(size=80)
    for method in ("lars", "omp", None):
        assert fit(FIVE, x, y, method=method).report["rrmse_estimate"][0] > 0.85


def test_default_works_on_every_kind_of_input_and_on_a_grid():
    inputs = {"a": Normal(0.0, 1.0), "b": Empirical(np.random.default_rng(0).gamma(2.0, size=30)),
        "c": Exponential(2.0)}  # fmt: skip
    x = sobol(inputs, 60, seed=3)
    y = np.column_stack([np.tanh(x[:, 0]) + x[:, 1], x[:, 2] ** 2, np.full(60, 3.0)])
    surrogate = fit(inputs, x, y, output_names=["p", "q", "constant"])
    assert surrogate.report["rrmse_estimate"][0] < 0.1
    assert surrogate.variance[2] == 0.0
    grid = smolyak(FIVE, 2)
    assert share(fit(FIVE, grid, friedman(grid)), friedman) < 0.5


def test_exact_polynomial_is_found_exactly():
    x = sobol(FIVE, 60, seed=1)
    assert share(fit(FIVE, x, x[:, 0] ** 2 * x[:, 1] - x[:, 3]), lambda t: t[:, 0] ** 2 * t[:, 1] - t[:, 3]) < 1e-10


def test_few_points_are_no_obstacle():
    for count in (1, 2, 3, 6):
        x = sobol(FIVE, count, seed=1)
        assert np.all(np.isfinite(fit(FIVE, x, x[:, 0])(x)))


def test_same_data_same_bits():
    x = sobol(FIVE, 30, seed=1)
    assert np.array_equal(fit(FIVE, x, kinked(x)).coefficients, fit(FIVE, x, kinked(x)).coefficients)


def test_estimate_sees_long_tails():
    inputs = {"a": Normal(0.0, 1.0), "b": Normal(0.0, 1.0)}
    test = sobol(inputs, 2000, seed=9)
    ratios = []
    for seed in range(2):
        x = sobol(inputs, 50, seed=seed)
        for truth in (
            lambda t: np.abs(t[:, 0]) + np.exp(0.5 * t[:, 1]),
            lambda t: np.tanh(t[:, 0]) * t[:, 1] + np.cos(t[:, 1]),
        ):
            surrogate = fit(inputs, x, truth(x))
            error = surrogate.score(test, truth(test))["y"]["rmse"]
            assert error < 0.3 * np.std(truth(test))
            ratios.append(surrogate.report["outputs"]["y"]["rmse_estimate"] / error)
    # Errors sit where no run stands, so single fits may be off; the typical one is neither flattered nor scared off.
    assert 0.5 < np.median(ratios) < 2.5
    assert min(ratios) > 0.3


BOREHOLE = {"radius": Normal(0.1, 0.0161812), "influence": LogNormal(7.71, 1.0056),
    "upper_transmissivity": Uniform(63070.0, 115600.0), "upper_head": Uniform(990.0, 1110.0),
    "lower_transmissivity": Uniform(63.1, 116.0), "lower_head": Uniform(700.0, 820.0),
    "length": Uniform(1120.0, 1680.0), "conductivity": Uniform(9855.0, 12045.0)}  # fmt: skip
OTL = {"b1": Uniform(50.0, 150.0), "b2": Uniform(25.0, 70.0), "f": Uniform(0.5, 3.0), "c1": Uniform(1.2, 2.5),
    "c2": Uniform(0.25, 1.2), "beta": Uniform(50.0, 300.0)}  # fmt: skip
PISTON = {"mass": Uniform(30.0, 60.0), "area": Uniform(0.005, 0.020), "volume": Uniform(0.002, 0.010),
    "spring": Uniform(1000.0, 5000.0), "pressure": Uniform(90000.0, 110000.0), "ambient": Uniform(290.0, 296.0),
    "filling": Uniform(340.0, 360.0)}  # fmt: skip
WING = {"area": Uniform(150.0, 200.0), "fuel": Uniform(220.0, 300.0), "aspect": Uniform(6.0, 10.0),
    "sweep_deg": Uniform(-10.0, 10.0), "pressure": Uniform(16.0, 45.0), "taper": Uniform(0.5, 1.0),
    "thickness": Uniform(0.08, 0.18), "load": Uniform(2.5, 6.0), "gross": Uniform(1700.0, 2500.0),
    "paint": Uniform(0.025, 0.08)}  # fmt: skip
FRIEDMAN = {f"x{k}": Uniform(0.0, 1.0) for k in range(1, 11)}


def borehole(x):
    """Source: Harper and Gupta, 1983."""
    radius, influence, tu, hu, tl, hl, length, conductivity = x.T
    logarithm = np.log(influence / radius)
    return (
        2.0 * np.pi * tu * (hu - hl)
        / (logarithm * (1.0 + 2.0 * length * tu / (logarithm * radius**2 * conductivity) + tu / tl))
    )  # fmt: skip


def otl(x):
    """Output transformerless push-pull circuit. Source: Ben-Ari and Steinberg, 2007."""
    b1, b2, f, c1, c2, beta = x.T
    base, load = 12.0 * b2 / (b1 + b2), beta * (c2 + 9.0)
    return (base + 0.74) * load / (load + f) + 11.35 * f / (load + f) + 0.74 * f * load / ((load + f) * c1)


def piston(x):
    """Cycle time of a piston. Source: Kenett and Zacks, 1998."""
    mass, area, volume, spring, pressure, ambient, filling = x.T
    force = pressure * area + 19.62 * mass - spring * volume / area
    stroke = area / (2.0 * spring) * (np.sqrt(force**2 + 4.0 * spring * pressure * volume * ambient / filling) - force)
    return 2.0 * np.pi * np.sqrt(mass / (spring + area**2 * pressure * volume * ambient / (filling * stroke**2)))


def wing_weight(x):
    """Weight of a light aircraft's wing [lb]. Source: Forrester, Sobester and Keane, 2008, Eq 1.20."""
    area, fuel, aspect, sweep_deg, pressure, taper, thickness, load, gross, paint = x.T
    cosine = np.cos(np.deg2rad(sweep_deg))
    return (
        0.036 * area**0.758 * fuel**0.0035 * (aspect / cosine**2) ** 0.6 * pressure**0.006 * taper**0.04
        * (100.0 * thickness / cosine) ** -0.3 * (load * gross) ** 0.49
        + area * paint
    )  # fmt: skip


# Errors measured over seeds 1 to 3 stay below half of these limits.
@pytest.mark.parametrize(("inputs", "model", "count", "limit"), [
    (BOREHOLE, borehole, 100, 0.02),
    (OTL, otl, 80, 0.01),
    (PISTON, piston, 100, 0.15),
    (WING, wing_weight, 100, 0.02),
    (FRIEDMAN, friedman, 120, 0.05),
], ids=["borehole", "otl", "piston", "wing weight", "friedman"])  # fmt: skip
def test_default_on_few_runs(inputs, model, count, limit):
    x, test = sobol_sequence(inputs, count, seed=1), sobol_sequence(inputs, 1000, seed=9)
    surrogate = fit(inputs, x, model(x))
    score = surrogate.score(test, model(test))["y"]
    assert score["rrmse"] < limit
    assert score["q2"] == pytest.approx(1.0 - score["rrmse"] ** 2)
    assert 0.3 < surrogate.report["rrmse_estimate"][0] / score["rrmse"] < 3.0


INPUTS = {"young_modulus": LogUniform(1e6, 1e8), "poisson_ratio": Uniform(0.1, 0.4),
    "grain_restitution": Uniform(0.3, 0.9), "lander_restitution": Uniform(0.3, 0.9),
    "friction": Uniform(0.2, 0.9)}  # fmt: skip
# First-order shares of the explained variance, and chaotic shares of all of it, as 320 landings of a sphere on one bed
# gave them with another engine:
# E, nu, e of the grains, e of the lander, mu for V+, theta+, omega+.
MAIN = np.array([[0.05, 0.0, 0.23, 0.29, 0.35], [0.33, 0.0, 0.10, 0.15, 0.0], [0.0, 0.0, 0.0, 0.08, 0.77]])
CHAOTIC = np.array([0.09, 0.18, 0.08])


def effects(x):
    """One effect an input, of mean 0 and variance 1: bent, saturating, or cut where friction stops sliding."""
    u = np.column_stack([entry.cdf(x[:, k]) for k, entry in enumerate(INPUTS.values())])
    shapes = [
        (np.tanh(3.0 * u[:, 0] - 1.0), lambda t: np.tanh(3.0 * t - 1.0)), (u[:, 1], lambda t: t),
        (u[:, 2] ** 2, lambda t: t**2), (np.sin(1.5 * u[:, 3]), lambda t: np.sin(1.5 * t)),
        (np.minimum(u[:, 4], 0.6), lambda t: np.minimum(t, 0.6)),
    ]  # fmt: skip
    middles = (np.arange(10_000) + 0.5) / 10_000
    return np.column_stack([(value - f(middles).mean()) / f(middles).std() for value, f in shapes])


def truth(x):
    """Three outputs of variance 1 - CHAOTIC: main effects, and products of two of them for what is left."""
    one = effects(x)
    pairs = (one[:, 0] * one[:, 4] + one[:, 2] * one[:, 3]) / np.sqrt(2.0)
    return (one @ np.sqrt(MAIN).T + pairs[:, None] * np.sqrt(1.0 - MAIN.sum(axis=1))) * np.sqrt(1.0 - CHAOTIC)


@pytest.fixture(scope="module")
def campaign():
    x = sobol_sequence(INPUTS, 250, seed=1)
    scatter = np.random.default_rng(1).normal(size=(250, 3)) * np.sqrt(CHAOTIC)
    y = truth(x) + scatter
    return x, y, fit(INPUTS, x, y, output_names=["speed", "elevation", "spin"])


def test_the_chaotic_share_is_recognised(campaign):
    _, _, surrogate = campaign
    found = np.array([entry["noise_std"] ** 2 for entry in surrogate.report["outputs"].values()])
    # Chi-square of about 220 degrees of freedom has a standard deviation of a tenth of its mean; three of them.
    assert np.allclose(found, CHAOTIC, rtol=0.3)


def test_it_is_not_chased(campaign):
    _, _, surrogate = campaign
    test = sobol_sequence(INPUTS, 2000, seed=9)
    error = np.sqrt(np.mean((surrogate(test) - truth(test)) ** 2, axis=0))
    # The truth is met within half of the scatter of one run, and the expected error is that of a new run.
    assert np.all(error < 0.5 * np.sqrt(CHAOTIC))
    expected = np.array([entry["rmse_estimate"] for entry in surrogate.report["outputs"].values()])
    assert np.allclose(expected, np.sqrt(error**2 + CHAOTIC), rtol=0.15)
    assert np.allclose(surrogate.sobol_first.T, MAIN, atol=0.06)


def test_more_runs_are_not_promised_to_help(campaign):
    _, _, surrogate = campaign
    answers = surrogate.runs_needed(0.2)
    assert all(one["more_runs"] is None for one in answers.values())
    assert answers["elevation"]["floor"] == pytest.approx(np.sqrt(0.18), rel=0.15)


def test_scatter_to_draw_from_has_the_size_of_the_chaos(campaign):
    x, y, surrogate = campaign
    assert np.allclose(joint_scatter(surrogate, x, y).std(axis=0), np.sqrt(CHAOTIC), rtol=0.15)
