"""Bounces on hard ground, and on ground whose restitution is drawn from a table."""

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

from lithobrake.smallbody import HardSurface, Impacts, RestitutionTable
from lithobrake.smallbody.bounce import LEVELS, cells


def impacts(speed: float, incidence: float, outward: float = -1e-4) -> Impacts:
    return Impacts(np.array([speed]), np.array([incidence]), np.zeros((1, 3)), np.array([outward]), np.arange(1))


def test_hard_surface_limits_the_tangential_impulse_by_friction():
    random = np.random.default_rng(0)
    steep = HardSurface(0.6, 0.5, friction=0.3)(impacts(0.2, 0.2), random)
    down, along = 0.2 * math.cos(0.2), 0.2 * math.sin(0.2)
    # Steep: friction could stop more than is lost; half of the horizontal speed is kept.
    assert steep.velocity[0] == pytest.approx([0.5 * along, 0.0, 0.6 * down])
    flat = HardSurface(0.6, 0.5, friction=0.3)(impacts(0.2, 1.4), random)
    down, along = 0.2 * math.cos(1.4), 0.2 * math.sin(1.4)
    # Flat: it slides, and loses friction times the normal impulse.
    assert flat.velocity[0] == pytest.approx([along - 0.3 * 1.6 * down, 0.0, 0.6 * down])
    assert not steep.captured[0]
    assert HardSurface(0.6)(impacts(1e-4, 0.0), random).captured[0]
    assert not HardSurface(0.6)(impacts(1e-4, 0.0, outward=1e-5), random).captured[0]
    with pytest.raises(ValueError, match="normal_restitution is"):
        HardSurface(1.2)


def even(lower: float, upper: float) -> np.ndarray:
    """Quantiles of a uniform law, the same in all of 2 by 1 cells."""
    return np.tile(np.interp(LEVELS, [0.0, 1.0], [lower, upper]), (2, 1, 1))


TABLE = RestitutionTable(
    np.array([0.0, 0.1, 0.2]), np.array([0.0, 90.0]),
    {"normal_restitution": even(0.2, 0.6) * [[[1.0]], [[0.5]]], "tangential_restitution": even(0.5, 0.9),
     "azimuth_deg": even(-30.0, 30.0), "friction": even(0.1, 0.3)},
    np.array([[0.8], [0.0]]), np.array([[0.0], [0.25]]), np.array([[400], [300]]), np.array([[12], [10]]),
    rest_height=0.0,
)  # fmt: skip


def alike_impacts(speed: float, count: int = 20_000) -> Impacts:
    every = np.ones(count)
    return Impacts(speed * every, np.radians(60.0) * every, np.zeros((count, 3)), -1e-4 * every, np.arange(count))


def test_draws_have_the_quantiles_and_the_correlation_of_their_cell() -> None:
    found = TABLE(alike_impacts(0.05), np.random.default_rng(1))
    normal = found.velocity[:, 2] / (0.05 * np.cos(np.radians(60.0)))
    along = np.hypot(found.velocity[:, 0], found.velocity[:, 1]) / (0.05 * np.sin(np.radians(60.0)))
    # A uniform law over 0.4 has this deviation; four standard errors of the mean.
    luck = 4 * 0.4 / np.sqrt(12 * 20_000)
    assert normal.mean() == pytest.approx(0.4, abs=luck)
    assert along.mean() == pytest.approx(0.7, abs=luck)
    # Uniform scores of normal ones that correlate by 0.8: 6/pi asin(0.4).
    assert np.corrcoef(normal, along)[0, 1] == pytest.approx(6 / np.pi * np.arcsin(0.4), abs=0.02)
    assert np.abs(np.degrees(np.arctan2(found.velocity[:, 1], found.velocity[:, 0]))).max() <= 30.0
    assert not found.captured.any()


def test_an_impact_beyond_the_table_is_that_of_the_next_cell_and_some_stay() -> None:
    found = TABLE(alike_impacts(5.0), np.random.default_rng(2))
    assert found.captured.mean() == pytest.approx(0.25, abs=4 * np.sqrt(0.25 * 0.75 / 20_000))
    assert (found.velocity[:, 2] / (5.0 * np.cos(np.radians(60.0)))).max() <= 0.3
    assert cells(TABLE.speed, np.array([-1.0, 0.0, 0.1, 0.2, 9.0])).tolist() == [0, 0, 1, 1, 1]


def test_a_rebound_that_hardly_rises_is_the_end() -> None:
    assert dataclasses.replace(TABLE, rest_height=1.0)(alike_impacts(1e-3), np.random.default_rng(3)).captured.all()


def test_a_table_is_read_as_it_was_written(tmp_path: Path) -> None:
    TABLE.save(tmp_path / "table.csv")
    read = RestitutionTable.read(tmp_path / "table.csv", rest_height=0.0)
    one, other = (table(alike_impacts(0.05, 50), np.random.default_rng(4)).velocity for table in (TABLE, read))
    assert np.array_equal(one, other)
    assert (read.runs.tolist(), read.captured.tolist()) == ([[12], [10]], [[0.0], [0.25]])
    assert (tmp_path / "table.csv").read_text().startswith("speed_from [m/s],speed_to [m/s],incidence_from_deg,")
