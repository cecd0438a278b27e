"""Loose, coarse and cohesive grains: what validation/experiments asks for, in small."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

EXPERIMENTS = Path(__file__).parents[2] / "validation" / "experiments"
BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(autouse=True)
def experiments_on_path(monkeypatch: pytest.MonkeyPatch) -> None:
    """The scripts of the experiments import each other by name, and those of the benchmarks."""
    monkeypatch.setattr(sys, "path", [str(EXPERIMENTS), str(BENCHMARKS), *sys.path])


def test_a_plate_is_slowed_more_by_denser_and_by_cohesive_grains(tmp_path: Path) -> None:
    """Loose grains let OSIRIS-REx's plate through, dense and cohesive ones stop it [Ballouz-2021]."""
    from plate_into_loose_grains import Soil, pressed_in

    loose = Soil(filled=0.35, grain=0.12, width=0.96, depth=0.6)
    depths = {}
    for name, soil in {
        "loose": loose, "dense": replace(loose, filled=0.55), "cohesive": replace(loose, cohesion=1000.0),
    }.items():  # fmt: skip
        row, path = pressed_in(soil, tmp_path)
        assert np.isfinite(path).all()
        depths[name] = path[:, 1].max()
        assert row["depth_1"] <= depths[name] + 1e-12
    # Between equal soils chance is a few hundredths.
    assert depths["cohesive"] < depths["loose"] / 2.0
    assert depths["dense"] < depths["loose"] / 2.0


def test_grains_are_put_where_none_touch(tmp_path: Path) -> None:
    from plate_into_loose_grains import Soil, bulk_density, put
    from scipy.spatial import cKDTree

    soil = Soil(filled=0.5, grain=0.1, width=0.7, depth=0.5)
    place, radius = put(soil)
    around = np.concatenate([place + np.array([0.7 * x, 0.7 * y, 0.0]) for x in (0, -1, 1) for y in (0, -1, 1)])
    pair = cKDTree(around).query_pairs(2.0 * radius.max(), output_type="ndarray")
    gap = np.linalg.norm(around[pair[:, 0]] - around[pair[:, 1]], axis=1) - np.tile(radius, 9)[pair].sum(axis=1)
    assert gap.min() > -1e-12
    assert bulk_density(radius, soil) / soil.material.density == pytest.approx(0.5, abs=0.01)


def test_grains_that_pull_on_each_other_lie_looser(monkeypatch: pytest.MonkeyPatch) -> None:
    """So beds take more volume where gravity is less [Keulen-2026]; without a pull they do not."""
    import packing_and_cohesion as packing

    monkeypatch.setattr(packing, "WIDTH", 4.0)
    monkeypatch.setattr(packing, "DEPTH", 5.0)
    kind = packing.KINDS["glass"]
    fraction = {}
    for pull in (0.0, 30.0):
        world, volumes = packing.filled(kind, pull, 1)
        fraction[pull] = packing.solid_fraction(world, volumes, kind)
    assert 0.5 < fraction[0.0] < 0.63
    assert fraction[30.0] < fraction[0.0] - 0.03


def test_what_has_a_row_is_not_run_again(tmp_path: Path) -> None:
    import packing_and_cohesion as packing

    (tmp_path / "rows.csv").write_text("kind,pull,seed\nglass,3,1\n")
    asked = list(packing.missing(["glass", "coarse basalt"], tmp_path / "rows.csv"))
    assert len(asked) == sum(len(kind.pulls) for kind in packing.KINDS.values()) * len(packing.SEEDS) - 1
    assert ("glass", 3.0, 1) not in asked


def test_a_force_that_stops_the_plate_is_its_energy_over_its_way() -> None:
    from plate_into_loose_grains import MASS, PLATE, mean_force

    depth = np.linspace(0.0, 0.3, 3001)
    way = np.stack([np.zeros_like(depth), depth, np.sqrt(0.01 - 0.02 * depth)], axis=1)
    assert 0.5 * PLATE < 0.3
    assert mean_force(way) == pytest.approx(0.01 * MASS, rel=1e-4)


def test_a_similar_drop_has_the_numbers_of_the_drop_it_stands_for() -> None:
    """Froude number, modulus over density v^2, and pull over density v^2 d are the true drop's."""
    from who_rebounds import DIAMETER, EARTH, KINDS

    kind = KINDS["lunar, 1e-2 g"]
    speed, gravity, stuff = kind.scaled(3.0)
    assert speed / np.sqrt(gravity * DIAMETER) == pytest.approx(3.0)
    true_speed = 3.0 * np.sqrt(EARTH * kind.share * DIAMETER)
    assert stuff.surface_energy / speed**2 == pytest.approx(kind.surface_energy / true_speed**2)
    assert stuff.young_modulus / (stuff.density * speed**2) >= kind.stiff * (1.0 - 1e-12)


def test_a_fast_ball_throws_grains_and_none_leaves_faster_than_a_pair(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Ejecta begin with speed [Brisset-2018]; a bed gives back less than the restitution of its grains."""
    import who_rebounds

    kind = replace(who_rebounds.KINDS["6 mm"], grain=0.007, width=0.042, depth=0.015)
    monkeypatch.setitem(who_rebounds.KINDS, "6 mm", kind)
    slow, fast = (who_rebounds.drop(tmp_path, "6 mm", froude, 0) for froude in (1.0, 30.0))
    assert slow["ejecta"] == 0
    assert fast["ejecta"] > 10
    assert all(0.0 <= row["upward_out"] < kind.material.restitution for row in (slow, fast))


def test_a_share_agrees_where_most_do_what_was_seen() -> None:
    from rebounds_part import RISEN, share_line

    rows = [{"rise": 2.0 * RISEN}] * 3 + [{"rise": 0.0}] * 7
    line = share_line("ball", "stays", 0.0, rows, "a row")
    assert line.agrees
    assert line.ours == "0.30 (0.11 to 0.60)"
    assert line.cells()[-1] == ""
    other = share_line("ball", "rebounds", 1.0, rows, "a row")
    assert not other.agrees
    assert other.cells()[-1] == "a row"
