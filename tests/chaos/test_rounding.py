"""An output that varies by rounding alone is constant, whatever its unit; one that varies by little more is not."""

import numpy as np
import pytest

from lithobrake.analysis import scatter_of, soil_total_effect, variance_shares
from lithobrake.analysis.confidence import answers
from lithobrake.chaos import Uniform, fit, sobol_sequence
from lithobrake.chaos.scores import score_of
from lithobrake.vocabulary.given_numbers import without_rounding

INPUTS = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}
X, BED = sobol_sequence(INPUTS, 96), np.arange(96) % 12
SCALES = (1e-80, 1e-12, 0.013, 1.0, -7.3e5, 1e60)
EPS = np.finfo(float).eps


def last_bits(scale: float, bits: int, seed: int = 0) -> np.ndarray:
    """Values that differ in their last bits alone."""
    return scale * (1.0 + EPS * np.random.default_rng(seed).integers(0, bits + 1, len(X)))


def of_scale(scale: float) -> np.ndarray:
    """Values at a ten-million-millionth of their mean, of which the first input makes nine parts of ten."""
    return scale * (1.0 + 1e-13 * (3.0 * X[:, 0] + X[:, 1]))


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("bits", [1, 4, 16])
def test_last_bits_have_no_variance_and_no_indices(scale: float, bits: int) -> None:
    values = last_bits(scale, bits)
    assert np.ptp(values) > 0.0
    found = fit(INPUTS, X, values)
    assert (found.variance, found.sobol_first[0], found.sobol_total[1]) == (0.0, 0.0, 0.0)
    assert found.mean == pytest.approx(scale, rel=1e-14)
    assert variance_shares(INPUTS, X, values, BED, soil=tuple(INPUTS)) is None
    assert scatter_of(values, BED) is None
    assert np.ptp(answers("values", values)) == 0.0
    with pytest.raises(ValueError, match="runs all alike"):
        soil_total_effect([0.1 * scale, 0.2 * scale], values)
    assert score_of(last_bits(scale, bits, 1), values)["rrmse"] == 0.0
    assert score_of(1.1 * values, values)["rrmse"] == np.inf


@pytest.mark.parametrize("scale", SCALES)
def test_what_is_small_beside_the_mean_is_told(scale: float) -> None:
    found = fit(INPUTS, X, of_scale(scale))
    # Each value is rounded to a thousandth of the spread.
    assert found.sobol_first[0] == pytest.approx(0.9, abs=2e-3)
    assert found.sobol_total[1] == pytest.approx(0.1, abs=2e-3)
    assert found.variance == pytest.approx(1e-26 * scale**2 * 10.0 / 12.0, rel=5e-3)
    assert scatter_of(of_scale(scale), BED) is not None


def test_a_missing_value_stays_missing_and_says_nothing_of_the_others() -> None:
    values = last_bits(3.0, 4)
    values[5] = np.nan
    found = without_rounding(values)
    assert np.isnan(found[5])
    assert np.nanmax(found) == np.nanmin(found)
    columns = without_rounding(np.column_stack([last_bits(3.0, 4), X[:, 0]]))
    assert (np.ptp(columns[:, 0]), columns[:, 1].tolist()) == (0.0, X[:, 0].tolist())
    assert len(without_rounding(np.array([]))) == 0
