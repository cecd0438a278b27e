"""The ground that landers meet where it is rough: its slopes, and how often they are met."""

import math

import numpy as np
import pytest
from scipy import integrate, stats

from lithobrake.smallbody import incidence_on, met_normals

COUNT = 20_000
# Of the largest distance between a law and so many draws of it, beyond which one in a hundred lies.
FARTHEST = 1.63 / math.sqrt(COUNT)


def gradients(roughness_deg: float, incidence_deg: float) -> np.ndarray:
    """Gradients of the ground that is met, along the way and to its left, [count, 2]; up is z, the way along x."""
    angle = math.radians(incidence_deg)
    velocity = np.tile([0.3 * math.sin(angle), 0.0, -0.3 * math.cos(angle)], (COUNT, 1))
    up = np.tile([0.0, 0.0, 1.0], (COUNT, 1))
    normal = met_normals(velocity, up, math.radians(roughness_deg), np.random.default_rng(1).random((COUNT, 2)))
    assert np.abs(np.linalg.norm(normal, axis=1) - 1.0).max() < 1e-12
    assert (incidence_on(velocity, normal) < 0.5 * math.pi).all()
    found: np.ndarray = -normal[:, :2] / normal[:, 2:]
    return found


@pytest.mark.parametrize("roughness_deg", [8.0, 40.0])
def test_straight_down_the_slope_is_that_of_two_normal_components(roughness_deg: float) -> None:
    found = gradients(roughness_deg, 0.0)
    steepest = np.hypot(*found.T)
    square = math.tan(math.radians(roughness_deg)) ** 2
    assert stats.kstest(steepest, lambda t: 1.0 - np.exp(-(t**2) / square)).statistic < FARTHEST
    assert stats.kstest(np.arctan2(found[:, 1], found[:, 0]), stats.uniform(-math.pi, 2 * math.pi).cdf).statistic < (
        FARTHEST
    )
    assert np.mean(steepest**2) == pytest.approx(square, rel=4.0 / math.sqrt(COUNT))


def test_ground_that_rises_along_the_way_is_met_more_often() -> None:
    """A lander sees ground in proportion to its area across the way: the mean rise is the variance times tan(i)."""
    found, variance = gradients(10.0, 45.0), 0.5 * math.tan(math.radians(10.0)) ** 2
    error = math.sqrt(variance / COUNT)
    assert found[:, 0].mean() == pytest.approx(variance, abs=4.0 * error)
    assert variance > 10.0 * error
    assert found[:, 1].mean() == pytest.approx(0.0, abs=4.0 * error)


@pytest.mark.parametrize("incidence_deg", [30.0, 75.0, 89.0])
def test_ground_that_faces_away_is_not_met(incidence_deg: float) -> None:
    std, steep = math.tan(math.radians(35.0)) / math.sqrt(2.0), math.tan(math.radians(incidence_deg))

    def density(p: float) -> float:
        return max(1.0 + steep * p, 0.0) * math.exp(-0.5 * (p / std) ** 2)

    limits = np.linspace(-1.0 / steep, 2.5, 9)[1:-1].tolist()
    whole = integrate.quad(density, -1.0 / steep, 12.0 * std)[0]
    found = gradients(35.0, incidence_deg)[:, 0]
    assert found.min() >= -1.0 / steep - 1e-9
    for limit in limits:
        share = integrate.quad(density, -1.0 / steep, limit)[0] / whole
        assert np.mean(found < limit) == pytest.approx(share, abs=4.0 * 0.5 / math.sqrt(COUNT))


def test_the_frame_of_the_way_does_not_matter() -> None:
    """Turned with way and normal, the ground that is met turns likewise."""
    turn = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
    turn *= np.linalg.det(turn)
    velocity, up = np.array([[0.03, 0.01, -0.05]]), np.array([[0.0, 0.0, 1.0]])
    uniforms = np.array([[0.7, 0.2]])
    plain = met_normals(velocity, up, 0.5, uniforms)
    assert met_normals(velocity @ turn.T, up @ turn.T, 0.5, uniforms) == pytest.approx(plain @ turn.T, abs=1e-12)


def test_roughness_out_of_range_is_refused() -> None:
    one = np.array([[0.0, 0.0, -1.0]])
    with pytest.raises(ValueError, match="roughness"):
        met_normals(one, -one, 0.5 * math.pi, np.array([[0.5, 0.5]]))
