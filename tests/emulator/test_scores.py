"""Scores against their definitions."""

import numpy as np
import pytest

from lithobrake.emulator.validation import crps, energy_scores, pit

RANDOM = np.random.default_rng(4)
MEMBERS, WEIGHTS = RANDOM.standard_normal((40, 3)), RANDOM.dirichlet(np.ones(40), size=5)
OBSERVED = RANDOM.standard_normal((5, 3))


def test_energy_score_is_its_double_sum() -> None:
    scales = RANDOM.uniform(0.5, 2.0, (5, 3))
    scores = energy_scores(MEMBERS, np.stack([WEIGHTS, WEIGHTS[::-1]]), scales, OBSERVED)
    for case in range(5):
        points = scales[case] * MEMBERS
        distances = np.linalg.norm(points[:, None] - points, axis=2)
        for k, weight in enumerate((WEIGHTS[case], WEIGHTS[::-1][case])):
            near = weight @ np.linalg.norm(points - OBSERVED[case], axis=1)
            assert scores[k, case] == pytest.approx(near - 0.5 * weight @ distances @ weight)


def test_crps_is_the_energy_score_of_one_output() -> None:
    values = np.broadcast_to(MEMBERS[:, 0], (5, 40))
    expected = energy_scores(MEMBERS[:, :1], WEIGHTS[None], np.ones((5, 1)), OBSERVED[:, :1])[0]
    np.testing.assert_allclose(crps(values, WEIGHTS, OBSERVED[:, 0]), expected, rtol=1e-12)


def test_pit_is_the_weight_below() -> None:
    weights = np.array([[0.1, 0.2, 0.7]])
    values = np.array([[3.0, 1.0, 2.0]])
    for seen, expected in ((0.0, 0.0), (1.5, 0.2), (2.0, 0.55), (9.0, 1.0)):
        assert pit(values, weights, np.array([seen]))[0] == pytest.approx(expected)


def test_scores_of_equal_members_are_those_of_scoringrules() -> None:
    sr = pytest.importorskip("scoringrules", reason="scoringrules is not installed")
    alike = np.full((5, 40), 1.0 / 40.0)
    values = np.broadcast_to(MEMBERS[:, 0], (5, 40))
    # "nrg" is the plain double sum; its other estimators are made fair to few members.
    theirs = sr.crps_ensemble(OBSERVED[:, 0], values, estimator="nrg", backend="numpy")
    np.testing.assert_allclose(crps(values, alike, OBSERVED[:, 0]), theirs, rtol=1e-10)
    joint = sr.es_ensemble(OBSERVED, np.broadcast_to(MEMBERS, (5, 40, 3)), estimator="nrg", backend="numpy")
    ours = energy_scores(MEMBERS, alike[None], np.ones((5, 3)), OBSERVED)[0]
    np.testing.assert_allclose(ours, joint, rtol=1e-10)
