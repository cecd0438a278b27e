"""Landing ellipses of made-up places."""

import math

import numpy as np
import pytest

from lithobrake.analysis import dispersion_ellipses


def test_a_normal_cloud_gives_its_own_axes() -> None:
    """Spreads of 2 and 0.5 deg along and across a heading of 30 deg, at latitude 50, across the date line."""
    random = np.random.default_rng(0)
    along, across = 2.0 * random.normal(size=20_000), 0.5 * random.normal(size=20_000)
    c, s = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))
    north, east = c * along - s * across, s * along + c * across
    longitude = 180.0 + east / np.cos(np.radians(50.0))
    found = dispersion_ellipses(50.0 + north, np.where(longitude > 180.0, longitude - 360.0, longitude))
    assert found.latitude_deg == pytest.approx(50.0, abs=0.1)
    assert abs(found.longitude_deg) == pytest.approx(180.0, abs=0.1)
    assert found.heading_deg == pytest.approx(30.0, abs=2.0)
    # A normal cloud has a share of 1 - exp(-k**2 / 2) within k spreads.
    for share, axes in found.semi_axes_deg.items():
        k = math.sqrt(-2.0 * math.log(1.0 - share))
        assert axes == pytest.approx((2.0 * k, 0.5 * k), rel=0.05)


def test_a_heading_wraps_at_half_a_turn() -> None:
    random = np.random.default_rng(1)
    found = dispersion_ellipses(random.normal(size=500), 10.0 + 0.1 * random.normal(size=500))
    assert min(found.heading_deg, 180.0 - found.heading_deg) < 3.0


def test_an_ellipse_that_would_reach_round_half_the_body_is_left_out() -> None:
    random = np.random.default_rng(2)
    near, far = 5.0 * random.normal(size=(900, 2)), np.column_stack([np.zeros(100), np.linspace(-170.0, 170.0, 100)])
    found = dispersion_ellipses(*np.concatenate([near, far]).T, (0.5, 0.99))
    assert list(found.semi_axes_deg) == [0.5]


def test_few_places_and_places_all_around_have_no_ellipse() -> None:
    assert dispersion_ellipses([1.0] * 5, [2.0] * 5) is None
    around = np.linspace(-180.0, 170.0, 36)
    assert dispersion_ellipses(np.zeros(36), around) is None
    assert dispersion_ellipses([10.0] * 20, [20.0] * 20) is None
    with pytest.raises(ValueError, match="between 0 and 1"):
        dispersion_ellipses([1.0] * 20, [2.0] * 20, (0.5, 1.0))
