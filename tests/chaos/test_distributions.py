"""Quantiles against SciPy's distributions, germs and back, names, and refusal of wrong parameters."""

from dataclasses import fields

import numpy as np
import pytest
from scipy import stats

from lithobrake import chaos
from lithobrake.chaos import (
    Beta,
    Empirical,
    Exponential,
    Gamma,
    LogNormal,
    LogUniform,
    Normal,
    TruncatedNormal,
    Uniform,
    distribution,
)
from lithobrake.chaos.basis import outside_count
from lithobrake.chaos.distribution_registry import KINDS
from lithobrake.study.quantity import DISTRIBUTIONS

PAIRS = [
    (Uniform(2.0, 5.0), stats.uniform(2.0, 3.0)),
    (LogUniform(1e-3, 1e4), stats.loguniform(1e-3, 1e4)),
    (Normal(-2.0, 0.5), stats.norm(-2.0, 0.5)),
    (LogNormal(1.0, 0.3), stats.lognorm(0.3, scale=np.exp(1.0))),
    (TruncatedNormal(1.0, 2.0, 0.0, 9.0), stats.truncnorm(-0.5, 4.0, 1.0, 2.0)),
    (TruncatedNormal(0.0, 1.0, 8.0, np.inf), stats.truncnorm(8.0, np.inf)),
    (TruncatedNormal(0.0, 1.0, -np.inf, -8.0), stats.truncnorm(-np.inf, -8.0)),
    (Beta(2.0, 5.0, -1.0, 3.0), stats.beta(2.0, 5.0, -1.0, 4.0)),
    (Gamma(3.0, 0.2), stats.gamma(3.0, scale=0.2)),
    (Exponential(4.0), stats.expon(scale=0.25)),
]
U = np.array([1e-6, 0.01, 0.3, 0.5, 0.77, 0.999, 1.0 - 1e-9])


@pytest.mark.parametrize(("entry", "oracle"), PAIRS, ids=lambda one: getattr(one, "kind", ""))
def test_quantiles_match_scipy(entry, oracle):
    assert np.allclose(entry.ppf(U), oracle.ppf(U), rtol=1e-9, atol=1e-12)
    assert entry.median == pytest.approx(oracle.median(), rel=1e-9)
    assert np.array_equal(entry.sample(U), entry.ppf(U))


@pytest.mark.parametrize(
    ("mean", "lower", "upper"),
    [(0.5, 0.1, 0.9), (1.8, 0.1, 0.9), (-0.8, 0.1, 0.9), (0.9, 0.1, np.inf), (0.2, 0.1, 0.9)],
)
def test_probabilities_of_a_truncated_normal_are_those_of_its_quantiles(mean, lower, upper):
    """Also where the mean is 90 standard deviations beyond a limit, and at its limits."""
    entry = TruncatedNormal(mean, 0.01, lower, upper)
    assert np.allclose(entry.cdf(entry.ppf(U)), U, rtol=1e-6, atol=1e-9)
    assert entry.cdf(np.array([lower, upper])).tolist() == [0.0, 1.0]


@pytest.mark.parametrize("entry", [pair[0] for pair in PAIRS], ids=lambda one: one.kind)
def test_germ_and_back_and_slope(entry):
    x = entry.ppf(U)
    assert np.allclose(entry.physical(entry.germ(x)), x, rtol=1e-12)
    step = 1e-6 * np.abs(x[1:5])
    difference = (entry.germ(x[1:5] + step) - entry.germ(x[1:5] - step)) / (2.0 * step)
    assert np.allclose(entry.germ_derivative(x[1:5]), difference, rtol=1e-5)


@pytest.mark.parametrize("entry", [pair[0] for pair in PAIRS] + [Empirical([3.0, 1.0, 2.0])], ids=lambda one: one.kind)
def test_name_and_parameters_give_it_back(entry):
    content = entry.to_json()
    assert distribution(content.pop("kind"), **content) == entry


def test_limits_become_exactly_plus_and_minus_one():
    for entry in (Uniform(0.2, 0.9), LogUniform(1e6, 1e8), Beta(2.0, 3.0, 0.1, 0.7)):
        assert list(entry.germ(np.array(entry.support))) == [-1.0, 1.0]
        assert tuple(entry.physical(np.array([-1.0, 1.0]))) == entry.support


def test_empirical_quantiles_are_its_samples():
    entry = Empirical([5.0, 1.0, 3.0])
    assert entry.ppf(np.array([0.0, 0.1, 0.5, 0.9, 1.0])).tolist() == [1.0, 1.0, 3.0, 5.0, 5.0]


@pytest.mark.parametrize(
    "make",
    [
        lambda: Uniform(1.0, 1.0), lambda: Uniform(2.0, 1.0), lambda: Uniform(float("nan"), 1.0),
        lambda: Uniform("low", 1.0), lambda: Uniform(0.0, float("inf")), lambda: LogUniform(0.0, 1.0),
        lambda: Normal(0.0, 0.0), lambda: Normal(0.0, -1.0), lambda: LogNormal(0.0, 0.0),
        lambda: TruncatedNormal(0.0, 1.0, 2.0, 1.0), lambda: TruncatedNormal(0.0, -1.0, 0.0, 1.0),
        lambda: TruncatedNormal(1e300, 1.0, 0.1, 0.9), lambda: TruncatedNormal(50.0, 0.01, 0.1, 0.9),
        lambda: TruncatedNormal(0.5, 5e-324, 0.1, 0.9), lambda: TruncatedNormal(0.5, 1e300, 0.1, 0.9),
        lambda: TruncatedNormal(0.5, 0.1, -1e308, 1e308), lambda: Beta(0.0, 1.0, 0.0, 1.0), lambda: Gamma(-1.0, 1.0),
        lambda: Gamma(1.0, 0.0), lambda: Exponential(0.0), lambda: Empirical([]), lambda: Empirical([1.0, 1.0]),
        lambda: Empirical([1.0, float("nan")]), lambda: distribution("triangular", lower=0.0),
        lambda: distribution("uniform", lower=0.0), lambda: distribution("uniform", lower=0.0, upper=1.0, mode=0.5),
    ],
)  # fmt: skip
def test_wrong_parameters_are_refused_in_one_sentence(make):
    with pytest.raises(ValueError, match=r"^[^\n]+$"):
        make()


@pytest.mark.parametrize("samples", [["rough", "smooth"], [1j, 2.0]])
def test_samples_that_are_no_numbers_are_refused_as_choices(samples):
    with pytest.raises(ValueError, match="discrete choices are not supported"):
        Empirical(samples)
    with pytest.raises(ValueError, match="discrete choices are not supported"):
        distribution("choice", values=samples)


def test_all_distributions_are_public_and_known_to_study_files():
    parameters = {kind: tuple(field.name for field in fields(entry)) for kind, entry in KINDS.items()}
    # Samples do not stand in a study file.
    assert parameters.pop("empirical") == ("samples",)
    assert parameters == DISTRIBUTIONS
    assert {entry.__name__ for entry in KINDS.values()} <= set(dir(chaos))


@pytest.mark.parametrize("entry", [LogUniform(1e-6, 1e8), LogNormal(0.0, 1.0)])
def test_what_has_no_logarithm_is_outside_however_wide_the_support(entry):
    assert outside_count({"a": entry}, np.array([[-1e-5], [0.0], [1.0]]))[0] == 2


@pytest.mark.parametrize(
    "entry",
    [
        Uniform(1.0, 2.0), LogUniform(1.0, 100.0), Normal(1.0, 2.0), LogNormal(0.0, 1.0),
        TruncatedNormal(0.0, 1.0, -1.0, 3.0), TruncatedNormal(0.0, 1.0, 6.0, 9.0),
        TruncatedNormal(0.0, 1.0, -np.inf, 1.0), TruncatedNormal(0.0, 1.0, -1.0, np.inf),
        TruncatedNormal(0.0, 1.0, -9.0, -7.0), Beta(2.0, 3.0, -1.0, 1.0), Gamma(2.0, 3.0), Exponential(2.0),
    ],
    ids=lambda entry: f"{entry.kind} {entry.support}",
)  # fmt: skip
def test_probability_of_a_quantile_is_the_probability(entry):
    u = np.array([0.001, 0.2, 0.5, 0.9, 0.999])
    assert np.allclose(entry.cdf(entry.ppf(u)), u, rtol=1e-9)


def test_probability_of_samples_is_their_rank():
    assert Empirical([1.0, 2.0, 3.0, 4.0]).cdf(np.array([1.0, 4.0])).tolist() == [0.125, 0.875]
