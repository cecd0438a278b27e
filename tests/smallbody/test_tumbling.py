"""Torque-free rotation against an integrator, against what it keeps, and where it is known in closed form."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lithobrake.geometry.attitude import rotation_matrices
from lithobrake.smallbody import tumble

EPS = np.finfo(float).eps
KINDS = {"any": (0.3, 0.7, 0.9), "oblate": (0.6, 0.6, 1.0), "prolate": (0.2, 1.0, 1.0), "ball": (0.4, 0.4, 0.4)}


def skewed(moments: tuple[float, float, float], random: np.random.Generator) -> np.ndarray:
    """An inertia with these principal moments about axes of any direction."""
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
    return axes @ np.diag(moments) @ axes.T


def starts(count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Attitudes and spins by chance."""
    attitude = random.normal(size=(count, 4))
    return attitude / np.linalg.norm(attitude, axis=1)[:, None], random.normal(size=(count, 3))


def error(found: np.ndarray, exact: np.ndarray) -> float:
    """Largest difference of two lists of attitudes; a quaternion and its negative are one attitude."""
    return float(np.minimum(np.abs(found - exact).max(axis=1), np.abs(found + exact).max(axis=1)).max())


def integrated(inertia: np.ndarray, attitude: np.ndarray, spin: np.ndarray, duration: float) -> tuple[np.ndarray, ...]:
    """Attitude and spin of one body by DOP853: the quaternion alone, under an angular momentum that stays."""
    start = rotation_matrices(attitude[None])[0]
    momentum, inverse = start @ inertia @ start.T @ spin, np.linalg.inv(inertia)

    def rate(_: float, q: np.ndarray) -> np.ndarray:
        x, y, z = inverse @ rotation_matrices(q[None])[0].T @ momentum
        return 0.5 * np.array([[0, -x, -y, -z], [x, 0, z, -y], [y, -z, 0, x], [z, y, -x, 0]]) @ q

    q = solve_ivp(rate, (0.0, duration), attitude, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    turn = rotation_matrices(q[None])[0]
    return q / np.linalg.norm(q), turn @ inverse @ turn.T @ momentum


@pytest.mark.parametrize("kind", KINDS)
def test_it_turns_as_an_integrator_has_it(kind: str) -> None:
    random = np.random.default_rng(0)
    inertia = 1e-3 * skewed(KINDS[kind], random)
    attitude, spin = starts(8, random)
    duration = random.uniform(-20.0, 20.0, 8)
    found = tumble(inertia, attitude, spin, duration)
    for one in range(8):
        exact = integrated(inertia, attitude[one], spin[one], duration[one])
        # DOP853 at these tolerances loses some 1e-11 on the way.
        assert error(found[0][one : one + 1], exact[0][None]) < 1e-10
        assert found[1][one] == pytest.approx(exact[1], abs=1e-10)


def test_both_ways_of_circling_are_met() -> None:
    """About the axis of the largest moment and about that of the smallest, in either sense."""
    moments = np.array(KINDS["any"])
    level, upright = np.array([[1.0, 0.1, 0.2]]), np.array([[0.2, 0.1, 1.0]])
    for spin in (level, upright, -level, -upright):
        found = tumble(np.diag(moments), [[1.0, 0.0, 0.0, 0.0]], spin, [7.0])
        exact = integrated(np.diag(moments), np.array([1.0, 0.0, 0.0, 0.0]), spin[0], 7.0)
        assert error(found[0], exact[0][None]) < 1e-11
        assert found[1][0] == pytest.approx(exact[1], abs=1e-11)


@pytest.mark.parametrize("kind", KINDS)
def test_twelve_hours_keep_momentum_and_energy_and_come_back(kind: str) -> None:
    random = np.random.default_rng(1)
    inertia = skewed(KINDS[kind], random)
    attitude, spin = starts(200, random)
    spin *= 5.0 / np.linalg.norm(spin, axis=1)[:, None]
    first, second = random.uniform(0.0, 21_600.0, (2, 200))

    def kept(attitude: np.ndarray, spin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        turn = rotation_matrices(attitude)
        momentum = np.einsum("nij,jk,nlk,nl->ni", turn, inertia, turn, spin)
        return momentum, np.einsum("ni,ni->n", momentum, spin)

    halfway = tumble(inertia, attitude, spin, first)
    parts, whole = tumble(inertia, *halfway, second), tumble(inertia, attitude, spin, first + second)
    # A rounding of each of the 2e5 radians, times what a spin near the separatrix makes of it.
    assert error(parts[0], whole[0]) < 2e5 * EPS * 200.0
    assert error(tumble(inertia, *whole, -first - second)[0], attitude) < 2e5 * EPS * 200.0
    (before, energy), (after, energy_after) = kept(attitude, spin), kept(*whole)
    assert np.abs(after - before).max() < 50.0 * EPS * np.linalg.norm(before, axis=1).max()
    assert energy_after == pytest.approx(energy, rel=50.0 * EPS)
    assert np.linalg.norm(whole[0], axis=1) == pytest.approx(1.0, abs=4.0 * EPS)


@pytest.mark.parametrize("kind", KINDS)
def test_no_time_and_no_spin_change_nothing(kind: str) -> None:
    random = np.random.default_rng(2)
    inertia = skewed(KINDS[kind], random)
    attitude, spin = starts(50, random)
    same = tumble(inertia, attitude, spin, np.zeros(50))
    assert error(same[0], attitude) < 20.0 * EPS
    assert same[1] == pytest.approx(spin, abs=50.0 * EPS)
    resting = tumble(inertia, attitude, np.zeros((50, 3)), np.full(50, 1e4))
    assert error(resting[0], attitude) < 20.0 * EPS
    assert not resting[1].any()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("rate", [5.0, -5.0])
def test_a_spin_about_a_principal_axis_stays(kind: str, axis: int, rate: float) -> None:
    """Even about the middle one, where nothing disturbs it."""
    spin, half = np.zeros((1, 3)), 0.5 * rate * 43_200.0
    spin[0, axis] = rate
    turned, after = tumble(np.diag(KINDS[kind]), [[1.0, 0.0, 0.0, 0.0]], spin, [43_200.0])
    exact = np.zeros((1, 4))
    exact[0, 0], exact[0, 1 + axis] = np.cos(half), np.sin(half)
    assert error(turned, exact) < 2.0 * abs(half) * EPS
    assert after == pytest.approx(spin, abs=20.0 * EPS)


def test_a_spin_about_the_middle_axis_turns_over() -> None:
    """The middle component of a body without symmetry goes from one sense to the other and back in one period."""
    from scipy.special import ellipkm1

    tilt = 1e-6
    # 1, 2, 3 kg m2: the excess over the separatrix is 2 tilt^2, and the rate 1 / sqrt(3).
    spin = np.array([[0.0, 1.0, tilt]])
    complement = tilt**2 * 3.0 * 2.0 / (tilt**2 * 6.0 + 2.0)
    half_period = 2.0 * ellipkm1(complement) / np.sqrt((2.0 + 6.0 * tilt**2) / 6.0)
    turned, after = tumble(np.diag([1.0, 2.0, 3.0]), [[1.0, 0.0, 0.0, 0.0]], spin, [half_period])
    in_body = rotation_matrices(turned)[0].T @ after[0]
    assert in_body == pytest.approx([0.0, -1.0, tilt], abs=1e-9)


def test_on_the_separatrix_a_spin_ends_about_the_middle_axis() -> None:
    """1.5, 3 and 4 kg m2, angular momenta of 1 and 2 along the outer axes: on it to the last bit."""
    moments, attitude = np.array([1.5, 3.0, 4.0]), np.array([[1.0, 0.0, 0.0, 0.0]])
    spin = np.array([[1.0, 0.0, 2.0]]) / moments
    turned, after = tumble(np.diag(moments), attitude, spin, [3.0])
    exact = integrated(np.diag(moments), attitude[0], spin[0], 3.0)
    assert error(turned, exact[0][None]) < 1e-11
    assert after[0] == pytest.approx(exact[1], abs=1e-11)
    turned, after = tumble(np.diag(moments), attitude, spin, [1e4])
    assert np.abs(rotation_matrices(turned)[0].T @ after[0]) == pytest.approx([0.0, np.sqrt(5.0) / 3.0, 0.0], abs=1e-14)


@pytest.mark.parametrize("scale", [1e-200, 1e-6, 1e100])
def test_no_scale_of_spin_or_inertia_matters(scale: float) -> None:
    attitude, spin = starts(5, np.random.default_rng(4))
    inertia = np.diag(KINDS["any"])
    plain = tumble(inertia, attitude, spin, np.full(5, 3.0))
    scaled = tumble(1e-9 * inertia, attitude, scale * spin, np.full(5, 3.0 / scale))
    assert error(scaled[0], plain[0]) < 100.0 * EPS
    assert scaled[1] / scale == pytest.approx(plain[1], abs=100.0 * EPS)


@pytest.mark.parametrize("kind", KINDS)
def test_a_body_turns_the_same_whoever_turns_beside_it(kind: str) -> None:
    random = np.random.default_rng(5)
    inertia, state = skewed(KINDS[kind], random), (*starts(300, random), random.uniform(0.0, 4e4, 300))
    together = tumble(inertia, *state)
    for _ in range(60):
        few = random.choice(300, random.integers(1, 9))
        for one, all_of_them in zip(tumble(inertia, *(part[few] for part in state)), together, strict=True):
            assert (one == all_of_them[few]).all()


def test_what_no_body_has_is_refused() -> None:
    state = ([[1.0, 0.0, 0.0, 0.0]], [[0.0, 0.0, 1.0]], [1.0])
    for inertia, words in (
        (np.eye(2), "shape"), (np.zeros((3, 3)), "is 0"), (np.diag([1.0, 1.0, -1.0]), "moment"),
        (np.eye(3) + np.eye(3, k=1), "symmetric"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=words):
            tumble(inertia, *state)
    for wrong in (([1.0, 0.0, 0.0, 0.0], *state[1:]), ([[0.0] * 4], *state[1:]), (*state[:2], [np.inf])):
        with pytest.raises(ValueError, match="attitude"):
            tumble(np.eye(3), *wrong)
    empty = tumble(np.eye(3), np.zeros((0, 4)), np.zeros((0, 3)), np.zeros(0))
    assert [one.shape for one in empty] == [(0, 4), (0, 3)]
