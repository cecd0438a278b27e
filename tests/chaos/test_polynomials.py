"""Orthonormality of every family, against quadratures that the code under test has no part in."""

import numpy as np
import pytest
from scipy import special

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
)

DEGREE = 20


def gram_error(table, weights):
    return np.abs((table * weights) @ table.T - np.eye(len(table))).max()


def reference(nodes, weights):
    return nodes, weights / weights.sum()


CASES = {
    "uniform": (Uniform(-3.0, 5.0), special.roots_legendre(60)),
    "log_uniform": (LogUniform(1e6, 1e8), special.roots_legendre(60)),
    "normal": (Normal(4.0, 0.1), special.roots_hermitenorm(60)),
    "log_normal": (LogNormal(0.0, 2.0), special.roots_hermitenorm(60)),
    "gamma": (Gamma(2.5, 3.0), special.roots_genlaguerre(60, 1.5)),
    "gamma_steep": (Gamma(0.5, 3.0), special.roots_genlaguerre(60, -0.5)),
    "gamma_narrow": (Gamma(50.0, 1.0), special.roots_genlaguerre(60, 49.0)),
    "exponential": (Exponential(0.2), special.roots_laguerre(60)),
    "beta": (Beta(2.0, 3.5, -1.0, 1.0), special.roots_jacobi(60, 2.5, 1.0)),
    "beta_arcsine": (Beta(0.5, 0.5), special.roots_jacobi(60, -0.5, -0.5)),
    "beta_narrow": (Beta(50.0, 50.0), special.roots_jacobi(60, 49.0, 49.0)),
    "beta_lopsided": (Beta(10.0, 0.7), special.roots_jacobi(60, -0.3, 9.0)),
    "beta_uniform": (Beta(1.0, 1.0), special.roots_legendre(60)),
}


@pytest.mark.parametrize("name", CASES)
def test_classical_families_are_orthonormal_to_degree_20(name):
    entry, rule = CASES[name]
    nodes, weights = reference(*rule)
    assert gram_error(entry.recurrence(DEGREE).values(nodes), weights) < 1e-12


@pytest.mark.parametrize(
    "limits", [(-1.0, 2.0), (-3.0, 3.0), (0.5, 4.0), (-np.inf, np.inf), (-1.0, np.inf), (8.0, np.inf), (20.0, 21.0)]
)
def test_truncated_normal_is_orthonormal_to_degree_20(limits):
    entry = TruncatedNormal(10.0, 2.0, *(10.0 + 2.0 * np.array(limits)))
    # The weight times the squared polynomial is negligible 22 standard deviations from the mean and, further out, from
    # the nearer limit.
    low, high = limits[0], min(limits[1], max(limits[0], 0.0) + 22.0)
    edges = np.linspace(max(low, -22.0), high, 46)[:, None]
    nodes, weights = special.roots_legendre(60)
    z = (0.5 * (edges[:-1] + edges[1:]) + 0.5 * (edges[1:] - edges[:-1]) * nodes).ravel()
    mode = min(max(0.0, low), high)
    nodes, weights = reference(
        entry.germ(10.0 + 2.0 * z), np.tile(weights, 45) * np.exp(-0.5 * (z - mode) * (z + mode))
    )
    assert gram_error(entry.recurrence(DEGREE).values(nodes), weights) < 1e-12


def test_empirical_is_orthonormal_over_its_samples():
    samples = np.random.default_rng(3).normal(size=800)
    table = Empirical(samples).recurrence(DEGREE).values(Empirical(samples).germ(samples))
    assert gram_error(table, np.full(800, 1.0 / 800)) < 1e-12


def test_empirical_refuses_a_degree_that_its_values_cannot_tell_apart():
    with pytest.raises(ValueError, match="distinct"):
        Empirical([1.0, 2.0, 2.0, 3.0]).recurrence(3)


def test_degrees_that_rounding_spoils_are_refused():
    entry = Empirical(np.random.default_rng(0).lognormal(0.0, 1.5, size=300))
    highest = int(entry.highest_degree)
    assert 5 < highest < 20
    table = entry.recurrence(highest).values(entry.germ(np.array(entry.samples)))
    assert gram_error(table, np.full(300, 1.0 / 300)) < 1e-8
    with pytest.raises(ValueError, match=f"up to degree {highest}"):
        entry.recurrence(highest + 1)


def test_slopes_are_derivatives():
    recurrence = Gamma(2.0, 1.0).recurrence(6)
    germ, step = np.linspace(0.2, 4.0, 9), 1e-6
    difference = (recurrence.values(germ + step) - recurrence.values(germ - step)) / (2.0 * step)
    assert np.allclose(recurrence.derivatives(germ), difference, rtol=1e-6, atol=1e-6)


def test_gauss_rule_matches_scipy():
    nodes, weights = Normal(0.0, 1.0).recurrence(12).gauss_rule()
    expected, expected_weights = reference(*special.roots_hermitenorm(12))
    assert np.allclose(nodes, expected, atol=1e-13)
    assert np.allclose(weights, expected_weights, rtol=1e-11)
