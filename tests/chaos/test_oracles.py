"""Agreement with other programs on the same nodes, where they are installed."""

import numpy as np
import pytest

from lithobrake.chaos import Normal, Uniform, fit, multi_index_set, smolyak, smolyak_count, sobol_sequence

INPUTS = {"a": Uniform(-1.0, 3.0), "b": Normal(1.0, 0.5), "c": Uniform(0.0, 2.0)}


def model(x):
    return np.exp(0.3 * x[:, 0]) * np.sin(x[:, 1]) + x[:, 2] ** 3


@pytest.fixture(scope="module")
def fitted():
    x = sobol_sequence(INPUTS, 120)
    return x, model(x), fit(INPUTS, x, model(x), degree=4, method="ols")


def test_chaospy_gives_the_same_expansion(fitted):
    chaospy = pytest.importorskip("chaospy", reason="chaospy is not installed")
    x, y, surrogate = fitted
    joint = chaospy.J(chaospy.Uniform(-1.0, 3.0), chaospy.Normal(1.0, 0.5), chaospy.Uniform(0.0, 2.0))
    basis = chaospy.generate_expansion(4, joint, normed=True)
    theirs, coefficients = chaospy.fit_regression(basis, x.T, y, retall=1)
    assert len(basis) == surrogate.term_count
    # Terms are ordered differently; orthonormal coefficients are equal up to their order and sign.
    assert np.allclose(np.sort(np.abs(coefficients)), np.sort(np.abs(surrogate.coefficients)), atol=1e-10)
    assert surrogate.mean == pytest.approx(float(chaospy.E(theirs, joint)), rel=1e-10)
    assert surrogate.variance == pytest.approx(float(chaospy.Var(theirs, joint)), rel=1e-10)
    assert np.allclose(surrogate.sobol_first, chaospy.Sens_m(theirs, joint), atol=1e-10)
    assert np.allclose(surrogate.sobol_total, chaospy.Sens_t(theirs, joint), atol=1e-10)


def test_chaospy_gives_the_same_sparse_grid():
    chaospy = pytest.importorskip("chaospy", reason="chaospy is not installed")
    joint = chaospy.J(chaospy.Uniform(-1.0, 1.0), chaospy.Uniform(-1.0, 1.0), chaospy.Uniform(-1.0, 1.0))
    nodes, _ = chaospy.generate_quadrature(3, joint, rule="clenshaw_curtis", sparse=True, growth=True)
    ours = smolyak({name: Uniform(-1.0, 1.0) for name in "abc"}, 3)
    theirs = np.unique(np.round(nodes.T, 12), axis=0)
    assert len(theirs) == smolyak_count(3, 3)
    assert np.allclose(theirs, np.unique(np.round(ours, 12), axis=0), atol=1e-10)


def test_openturns_gives_the_same_coefficients(fitted):
    openturns = pytest.importorskip("openturns", reason="openturns is not installed")
    x, y, surrogate = fitted
    joint = openturns.JointDistribution(
        [openturns.Uniform(-1.0, 3.0), openturns.Normal(1.0, 0.5), openturns.Uniform(0.0, 2.0)]
    )
    enumeration = openturns.LinearEnumerateFunction(3)
    families = [openturns.StandardDistributionPolynomialFactory(joint.getMarginal(k)) for k in range(3)]
    basis = openturns.OrthogonalProductPolynomialFactory(families, enumeration)
    algorithm = openturns.FunctionalChaosAlgorithm(
        openturns.Sample(x.tolist()),
        openturns.Sample(y[:, None].tolist()),
        joint,
        openturns.FixedStrategy(basis, len(multi_index_set(3, 4))),
        openturns.LeastSquaresStrategy(),
    )
    algorithm.run()
    result = algorithm.getResult()
    theirs = {tuple(enumeration(index)): result.getCoefficients()[k, 0] for k, index in enumerate(result.getIndices())}
    assert len(theirs) == surrogate.term_count
    for index, value in zip(surrogate.multi_indices.tolist(), surrogate.coefficients, strict=True):
        assert value == pytest.approx(theirs[tuple(index)], abs=1e-10)
